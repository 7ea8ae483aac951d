//! The way of the sound and the page of its selected part: sections of parameters, the body, the tuning.

pub(super) mod curves;
mod outlines;
pub(super) mod path;
mod scales;
pub(super) mod sections;
pub(super) mod tuning;
mod voices;

use crate::editor::body::page::BodyPage;
use crate::editor::controls::shown::{Shown, Subject};
use crate::editor::controls::{Controls, Said};
use crate::editor::lamps;
use crate::editor::theme::GAP;
use crate::editor::theme::layout::Layout;
use crate::editor::widgets::buttons::help_tab;
use crate::link::Link;
use egui::{Rect, Ui, Vec2, pos2, vec2};
use path::Part;
use sections::PAGES;
use sprung::params::PARAMS;
use sprung_picture::{Figure, small_figure};
use tuning::TuningPage;

/// The manual's page for each page, in their order.
const TOPICS: [&str; 6] = ["exciters", "bodies", "space", "tuning", "bodies", "tuning"];
/// Side of the button of the manual.
const HELP: f32 = 22.0;
/// Smallest width at which the voices fit beside the page's sections.
const WIDE: f32 = 840.0;
/// The width of the sections beside the voices.
const SECTIONS: f32 = 344.0;

/// A request of the user's.
pub(super) enum Request {
    Manual,
    /// Show this message.
    Say(Said),
}

/// The state of the pages.
pub(super) struct Pages {
    /// The selected part of the sound's way, and the size in which it was last scrolled to.
    part: Part,
    seen: Vec2,
    body: BodyPage,
    tuning: TuningPage,
    /// The picture of the body, read again only when another sound is shown.
    figure: Option<(Subject, Figure)>,
}

impl Default for Pages {
    fn default() -> Self {
        let (body, tuning) = (BodyPage::default(), TuningPage::default());
        Self { part: ("Mallet", 0), seen: Vec2::ZERO, body, tuning, figure: None }
    }
}

impl Pages {
    /// The page of the manual that explains the present page.
    pub(super) fn topic(&self) -> &'static str {
        TOPICS[self.part.1]
    }

    /// Selects a part of the sound's way.
    pub(super) fn select(&mut self, part: Part) {
        (self.part, self.seen) = (part, Vec2::ZERO);
    }

    /// Ends the user's action, and releases the held keys.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.body.leave(controls);
        controls.interaction.touched = None;
        self.release(controls.params.link());
    }

    /// Releases the held keys.
    pub(super) fn release(&mut self, link: &Link) {
        self.body.release(link);
        self.tuning.grid.release(link);
    }

    /// Shows the way of the sound and a page; `down` has one bit for each held key, `voices` is the number of sounding voices.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        layout: &Layout,
        shown: &Shown,
        (down, voices): (u128, u32),
        controls: &mut Controls,
    ) -> Option<Request> {
        let is_preset = shown.preset().is_some();
        if is_preset {
            self.follow(controls);
        }
        let of = || small_figure(&shown.patch().modes, shown.family(), shown.tags());
        let known = self.figure.take().filter(|(subject, _)| *subject == shown.subject());
        let (subject, figure) = known.unwrap_or_else(|| (shown.subject(), of()));
        let request = self.path(ui, layout.path, (is_preset, &figure), controls);
        let (rect, (part, page)) = (layout.sections, self.part);
        let said = match part {
            "Model" => self.body.show(ui, rect, shown, controls).map(Err),
            "Tuning" => self.tuning.show(ui, rect, shown, down, controls),
            _ => {
                let mut left = rect;
                if part == "Voices" && rect.width() >= WIDE {
                    left = rect.with_max_x(rect.left() + SECTIONS);
                    voices::show(ui.painter(), rect.with_min_x(left.right() + GAP), voices, controls);
                }
                let about = (shown.patch(), shown.guide(), is_preset, &figure);
                let is_new = std::mem::replace(&mut self.seen, rect.size()) != rect.size();
                sections::show(ui, left, PAGES[page], (part, is_new), about, controls);
                None
            }
        };
        self.figure = Some((subject, figure));
        said.map(Request::Say).or(request)
    }

    /// Selects the part that a knob has just switched off: it must not vanish under the hand that turns it down.
    fn follow(&mut self, controls: &mut Controls) {
        let touched = controls.interaction.touched.take().map(|index| PARAMS[index].section);
        let is_off = |section: &&str| lamps::of(section).is_some_and(|lamp| !lamp.is_on(controls));
        let here = touched.filter(|section| is_off(section) && sections::shows(self.part.1, section));
        self.part.0 = here.unwrap_or(self.part.0);
    }

    fn path(&mut self, ui: &Ui, rect: Rect, about: (bool, &Figure), controls: &mut Controls) -> Option<Request> {
        let way = rect.with_max_x(rect.right() - HELP);
        if let Some(part) = path::show(ui, way, self.part.0, about, controls) {
            self.leave(controls);
            self.select(part);
        }
        let help = Rect::from_min_size(pos2(way.right(), rect.top()), vec2(HELP, HELP));
        help_tab(ui, help, self.topic(), controls).then_some(Request::Manual)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::internals::text::PAGES;

    #[test]
    fn every_page_has_a_page_of_the_manual() {
        assert_eq!(path::names().count(), TOPICS.len());
        assert!(TOPICS.iter().all(|topic| PAGES.iter().any(|(name, _)| name == topic)));
    }
}
