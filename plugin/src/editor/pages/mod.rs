//! The row of tabs and the page below it: sections of parameters, the body, the kit's keys, the tuning, the devices.

mod curves;
mod devices;
mod kit;
mod outlines;
mod sections;
pub(super) mod tuning;
mod voices;

use crate::editor::body::page::BodyPage;
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::keyboard::grid::KeyGrid;
use crate::editor::theme::layout::Layout;
use crate::editor::theme::{GAP, TEXT};
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text;
use crate::link::Link;
use egui::{Rect, Ui, pos2, vec2};
use nice_plug_core::context::PluginApi;
use tuning::TuningPage;

/// The pages after those with sections.
const OTHERS: [&str; 3] = ["Model", "Kit", "Tuning"];
/// The page after these; only the standalone program has it.
const DEVICES: &str = "Devices";
/// The manual's page for each page, in their order.
const TOPICS: [&str; 10] =
    ["exciters", "bodies", "modulation", "modulation", "space", "tuning", "bodies", "kits", "tuning", "window"];
/// Smallest width at which the voices fit beside the page's sections.
const WIDE: f32 = 840.0;
/// The width of the sections beside the voices.
const SECTIONS: f32 = 344.0;

/// A request of the user's.
pub(super) enum Request {
    Manual,
    /// Show this message.
    Say(String),
}

/// The state of the pages.
#[derive(Default)]
pub(super) struct Pages {
    page: usize,
    body: BodyPage,
    kit: KeyGrid,
    tuning: TuningPage,
}

/// The names of all pages.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    sections::pages().chain(OTHERS)
}

impl Pages {
    /// The page of the manual that explains the present page.
    pub(super) fn topic(&self) -> &'static str {
        TOPICS.get(self.page).copied().unwrap_or("window")
    }

    /// Ends the user's action, and releases the held keys.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.body.leave(controls);
        self.release(controls.params.link());
    }

    /// Releases the held keys.
    pub(super) fn release(&mut self, link: &Link) {
        self.body.release(link);
        self.kit.release(link);
        self.tuning.grid.release(link);
    }

    /// Shows tabs and page; `down` has one bit for each held key, `voices` is the number of sounding voices.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        layout: &Layout,
        shown: &Shown,
        (down, voices): (u128, u32),
        controls: &mut Controls,
    ) -> Option<Request> {
        let request = self.tabs(ui, layout.tabs, controls);
        let (rect, page) = (layout.sections, self.page);
        let rest = page.checked_sub(sections::pages().count());
        match rest {
            None => {
                let is_voices = sections::pages().nth(page) == Some("Voices");
                let (left, right) = if is_voices && rect.width() >= WIDE {
                    let left = rect.left() + SECTIONS;
                    (rect.with_max_x(left), Some(rect.with_min_x(left + GAP)))
                } else {
                    (rect, None)
                };
                let about = (shown.patch(), shown.guide(), shown.preset().is_some());
                sections::show(ui, left, page, about, controls);
                if let Some(right) = right {
                    voices::show(ui.painter(), right, voices, controls);
                }
                request
            }
            Some(0) => self.body.show(ui, rect, shown, controls).map(Request::Say).or(request),
            Some(1) => {
                kit::show(ui, rect, &mut self.kit, shown, down, controls);
                request
            }
            Some(3) => {
                devices::show(ui, rect, controls);
                request
            }
            Some(_) => self.tuning.show(ui, rect, shown, down, controls).map(Request::Say).or(request),
        }
    }

    fn tabs(&mut self, ui: &Ui, rect: Rect, controls: &mut Controls) -> Option<Request> {
        let mut left = rect.left();
        let gap = if rect.width() < 700.0 { GAP } else { 2.0 * GAP };
        let is_alone = controls.host.plugin_api() == PluginApi::Standalone;
        for (place, name) in names().chain(is_alone.then_some(DEVICES)).enumerate() {
            let width = text::width(ui.painter(), name, TEXT) + gap;
            let place_of_tab = Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height() - 2.0));
            left = place_of_tab.right() + GAP / 4.0;
            if tab(ui, place_of_tab, name, place == self.page, controls.palette).clicked() {
                self.leave(controls);
                self.page = place;
            }
        }
        let help = Rect::from_min_max(pos2(rect.right() - 24.0, rect.top()), rect.max - vec2(0.0, 2.0));
        let response = tab(ui, help, "?", false, controls.palette);
        if response.hovered() {
            *controls.hint =
                crate::editor::controls::Hint::new("Manual", format!("What this page does: {}", self.topic()));
        }
        response.clicked().then_some(Request::Manual)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::manual::PAGES;

    #[test]
    fn every_page_has_a_page_of_the_manual() {
        assert_eq!(names().count() + 1, TOPICS.len(), "and the page of devices");
        assert!(TOPICS.iter().all(|topic| PAGES.iter().any(|(name, _)| name == topic)));
    }
}
