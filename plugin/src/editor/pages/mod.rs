//! The way of the sound, below it what belongs to its chosen part, and the line of sources.

mod bodies;
mod body;
pub(super) mod curves;
mod groups;
mod outlines;
pub(super) mod parts;
mod path;
mod rail;
mod scales;
pub(super) mod sections;
mod spot;
pub(super) mod tuning;
mod voices;
mod way;

use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Said};
use crate::editor::displays::scope;
use crate::editor::lamps;
use crate::editor::theme::layout::Layout;
use crate::editor::theme::{GAP, PADDING, PATH_HEIGHT, SMALL, TEXT, paint_panel};
use crate::editor::widgets::buttons::help_tab;
use crate::editor::widgets::text::{fitting, line};
use crate::link::Link;
use bodies::Bodies;
use body::BodyPart;
use egui::{Align2, Rect, Shape, Stroke, Ui, pos2, vec2};
use parts::Part;
use sections::ADDED;
use tuning::TuningPage;

/// Side of the button of the manual, and height of the line with the chosen part's name.
const HELP: f32 = 22.0;
const HEAD: f32 = 24.0;
/// Width from which on the sounding voices are beside the knobs, and the width of these.
const WIDE: f32 = 840.0;
const KNOBS: f32 = 364.0;
/// Least and greatest width of a picture beside the knobs.
const PICTURE: [f32; 2] = [110.0, 560.0];
/// Width and height of the notch that points to the chosen part.
const NOTCH: [f32; 2] = [14.0, 7.0];

/// A request of the user's.
pub(super) enum Request {
    Manual,
    /// Show this message.
    Say(Said),
}

/// The state of the pages.
pub(super) struct Pages {
    /// The chosen part of the sound's way.
    part: Part,
    body: BodyPart,
    tuning: TuningPage,
    /// What is drawn of the bodies, made again only when another sound is shown.
    bodies: Option<Bodies>,
}

impl Default for Pages {
    fn default() -> Self {
        Self { part: "Body", body: BodyPart::default(), tuning: TuningPage::default(), bodies: None }
    }
}

impl Pages {
    /// The page of the manual that explains what is shown.
    pub(super) fn topic(&self) -> &'static str {
        parts::topic(self.part)
    }

    /// Selects a part of the sound's way.
    pub(super) fn select(&mut self, part: Part) {
        self.part = part;
    }

    /// Ends the user's action, and releases the held keys.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.body.leave(controls);
        self.release(controls.params.link());
    }

    /// Releases the held keys.
    pub(super) fn release(&mut self, link: &Link) {
        self.body.release(link);
        self.tuning.grid.release(link);
    }

    /// Shows the way of the sound and its chosen part for the energies of the modes; `down` has one bit for each held key, `voices` is the
    /// number of sounding voices.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        layout: &Layout,
        shown: &Shown,
        (energies, down, voices): (&[f32], u128, u32),
        controls: &mut Controls,
    ) -> Option<Request> {
        let palette = controls.palette;
        let bodies = Bodies::of(self.bodies.take(), shown);
        let chosen = if self.part == "Body" { self.body.chosen() } else { self.part };
        let (clicked, middle) = if layout.path.height() > PATH_HEIGHT {
            way::show(ui, layout.path, chosen, (shown, &bodies), controls)
        } else {
            path::show(ui, layout.path, self.part, controls)
        };
        if let Some(part) = clicked {
            self.leave(controls);
            let is_body = matches!(part, "Body" | "Body 2" | "Joint");
            self.part = if is_body { "Body" } else { part };
            if is_body {
                self.body.turn_to(part);
            }
        }
        paint_panel(ui.painter(), layout.part, palette);
        paint_notch(ui, layout.part, middle, controls);
        let inside = layout.part.shrink(PADDING);
        let [head, area] = [inside.with_max_y(inside.top() + HEAD - 4.0), inside.with_min_y(inside.top() + HEAD)];
        let help = Rect::from_min_size(pos2(head.right() - HELP, head.top()), vec2(HELP, head.height()));
        let asks = help_tab(ui, help, self.topic(), controls);
        let head = self.title(ui, head.with_max_x(help.left() - GAP), bodies.second.is_some(), controls);
        let said = match self.part {
            "Body" => self.body.show(ui, [head, area], (shown, energies), controls).map(Err),
            "Tuning" => self.tuning.show(ui, area, shown, down, controls),
            part => {
                let mut left = area;
                if part == "Voices" && area.width() >= WIDE {
                    left = area.with_max_x(area.left() + KNOBS);
                    voices::show(ui.painter(), area.with_min_x(left.right() + 2.0 * GAP), voices, controls);
                }
                show_part(ui, left, part, (shown, &bodies), controls);
                None
            }
        };
        rail::show(ui, layout.rail, shown, controls);
        self.bodies = Some(bodies);
        said.map(Request::Say).or(asks.then_some(Request::Manual))
    }

    /// Shows the name of the chosen part, and what it does. Returns the place beside it.
    fn title(&self, ui: &Ui, rect: Rect, is_pair: bool, controls: &Controls) -> Rect {
        let palette = controls.palette;
        let name = match (self.part, self.body.chosen()) {
            ("Body", "Body") if is_pair => "Body 1",
            ("Body", chosen) => chosen,
            (part, _) => part,
        };
        let title = line(ui.painter(), rect, Align2::LEFT_CENTER, name, TEXT + 3.5, palette.text);
        let rest = rect.with_min_x(title.right() + 2.0 * GAP);
        let knobs = parts::groups(self.part);
        let moves = knobs.iter().flat_map(|(_, knobs)| knobs).any(|info| controls.own(info).is_some());
        // Beside the body are its tabs.
        let (words, colour) = match lamps::of(self.part) {
            _ if self.part == "Body" => (["", ""], palette.muted),
            _ if moves => ([ADDED, "added to each pad"], palette.accent_text),
            Some(lamp) => ([lamp.help, ""], palette.muted),
            None => ([parts::help(self.part), ""], palette.muted),
        };
        let words = fitting(ui.painter(), &words, SMALL, rest.width());
        line(ui.painter(), rest, Align2::LEFT_CENTER, words, SMALL, colour);
        rest
    }
}

/// Paints the notch in the upper edge of a panel that points to the chosen part.
fn paint_notch(ui: &Ui, panel: Rect, middle: f32, controls: &Controls) {
    let (palette, [width, height]) = (controls.palette, NOTCH);
    let tip = pos2(middle, panel.top() - height);
    let foot = |side: f32| pos2(middle + side * width / 2.0, panel.top() + 1.0);
    let corners = vec![foot(-1.0), tip, foot(1.0)];
    ui.painter().add(Shape::convex_polygon(corners.clone(), palette.panel, Stroke::NONE));
    ui.painter().add(Shape::line(corners, Stroke::new(1.0, palette.outline)));
}

/// Shows the knobs of a part, and its picture at their left where there is room.
fn show_part(ui: &mut Ui, rect: Rect, part: Part, (shown, bodies): (&Shown, &Bodies), controls: &mut Controls) {
    let groups = parts::groups(part);
    let least = groups::least_width(&groups, rect.height());
    let room = rect.width() - least - 2.0 * GAP;
    let section = sections::sections(&[part]).next().filter(|section| sections::has_picture(section));
    let [narrowest, widest] = PICTURE;
    let mut knobs = rect;
    if let Some(section) = section.filter(|_| room >= narrowest) {
        let wide = (rect.width() - groups::width(&groups).max(least) - 2.0 * GAP).clamp(narrowest, widest);
        let mut at = rect.with_max_x(rect.left() + wide);
        knobs = rect.with_min_x(at.right() + 2.0 * GAP);
        if part == "Output" && wide > 2.0 * narrowest {
            scope::show(ui, at.with_min_x(at.left() + narrowest + GAP), controls);
            at = at.with_max_x(at.left() + narrowest);
        }
        let figure = &bodies.first.figure;
        curves::frame(ui.painter(), at, controls.palette, |place| {
            sections::picture(ui.painter(), place, section, figure, controls)
        });
    }
    groups::show(ui, knobs, &groups, (shown.patch(), shown.guide()), controls);
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::internals::text::PAGES;

    #[test]
    fn every_part_has_a_page_of_the_manual() {
        let parts = path::PATH.into_iter().flatten().copied().flatten();
        assert!(parts.map(|part| parts::topic(part)).all(|topic| PAGES.iter().any(|(name, _)| *name == topic)));
    }
}
