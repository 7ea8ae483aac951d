//! The body below the way of the sound: its pictures and its knobs, and what it is made of, under tabs.

use super::groups;
use super::parts::{self, Part};
use super::sections::ADDED;
use crate::editor::body::page::BodyPage;
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::displays::{Displays, PICTURES, Picture};
use crate::editor::theme::{GAP, SMALL};
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text::{line, width};
use crate::link::Link;
use egui::{Align2, Rect, Ui};

/// Width from which on pictures and knobs are side by side, and the share of the knobs.
const WIDE: f32 = 840.0;
const KNOBS: f32 = 0.46;
/// Least width of what is said beside the tabs.
const HEAD: f32 = 90.0;
/// Height of a line of words above the knobs.
const LINE: f32 = 14.0;
/// Space around the name of a tab.
const AROUND: f32 = 16.0;

/// What is shown of the body.
#[derive(Clone, Copy, PartialEq)]
enum View {
    /// The knobs alone, where there is no room for a picture beside them.
    Knobs,
    Picture(Picture),
    Model,
}

/// The state of the part.
pub(super) struct BodyPart {
    view: View,
    displays: Displays,
    model: BodyPage,
}

impl Default for BodyPart {
    fn default() -> Self {
        Self { view: View::Picture(Picture::Modes), displays: Displays::default(), model: BodyPage::default() }
    }
}

impl BodyPart {
    /// Ends what the user is doing.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.displays.cancel(controls);
        self.model.leave(controls);
        self.release(controls.params.link());
    }

    /// Releases the held keys.
    pub(super) fn release(&mut self, link: &Link) {
        self.displays.release(link);
        self.model.release(link);
    }

    /// The body, of two, or the joint whose numbers are shown.
    pub(super) fn chosen(&self) -> Part {
        if self.view == View::Model { self.model.chosen() } else { "Body" }
    }

    /// Turns to one of two bodies or the joint.
    pub(super) fn turn_to(&mut self, chosen: Part) {
        match (chosen, self.view) {
            ("Body", View::Model) => self.view = View::Picture(Picture::Modes),
            ("Body", _) => {}
            _ => self.view = View::Model,
        }
        self.model.turn_to(chosen);
    }

    /// Shows the tabs at the head, and the body below. Returns a message.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        [head, area]: [Rect; 2],
        (shown, energies): (&Shown, &[f32]),
        controls: &mut Controls,
    ) -> Option<String> {
        let is_wide = area.width() >= WIDE;
        if is_wide && self.view == View::Knobs {
            self.view = View::Picture(Picture::Modes);
        }
        let pictures = PICTURES.map(|(picture, name)| (View::Picture(picture), name));
        let knobs = (!is_wide).then_some((View::Knobs, "Knobs"));
        let mut left = head.left();
        for (view, name) in knobs.into_iter().chain(pictures).chain([(View::Model, "Model")]) {
            let place = head.with_min_x(left).with_max_x(left + width(ui.painter(), name, SMALL + 1.0) + AROUND);
            left = place.right();
            if tab(ui, place, name, view == self.view, controls.palette).clicked() && view != self.view {
                self.leave(controls);
                self.view = view;
            }
        }
        let mut head = head.with_min_x(left + GAP);
        let groups = parts::groups("Body");
        let about = (shown.patch(), shown.guide());
        let View::Picture(picture) = self.view else {
            if self.view == View::Model {
                return self.model.show(ui, area, shown, controls);
            }
            groups::show(ui, area, &groups, about, controls);
            return None;
        };
        let (mut message, mut at) = (None, area);
        if is_wide {
            let least = groups::least_width(&groups, area.height());
            let knobs = (KNOBS * area.width()).clamp(least, groups::width(&groups).max(least));
            let mut right = area.with_min_x(area.right() - knobs);
            at = area.with_max_x(right.left() - 2.0 * GAP);
            // Tabs may be wider than the picture.
            if at.right() - head.left() >= HEAD {
                head = head.with_max_x(at.right());
            }
            if groups.iter().flat_map(|(_, knobs)| knobs).any(|info| controls.own(info).is_some()) {
                let (words, below) = right.split_top_bottom_at_y(right.top() + LINE);
                line(ui.painter(), words, Align2::LEFT_CENTER, ADDED, SMALL, controls.palette.accent_text);
                right = below;
            }
            let strips = self.model.strips(ui, right, groups::least_height(&groups), shown, controls);
            (right, message) = (right.with_min_y(strips.0), strips.1);
            groups::show(ui, right, &groups, about, controls);
        }
        self.displays.show(ui, [head, at], picture, (shown, energies), controls);
        message
    }
}
