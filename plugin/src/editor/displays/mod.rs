//! Moving pictures: the phase plane of one mass, the body, the waveform with its spectrum, and the modes' decay.

mod phase;
mod ringing;
mod scope;
mod spectrum;

use crate::editor::body::view::BodyView;
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::keyboard::audition::Audition;
use crate::editor::theme::{PADDING, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text::line;
use crate::link::Link;
use egui::{Align2, Rect, Ui, pos2};
use phase::Phase;
use ringing::Ringing;
use scope::SHOWN;

#[derive(Clone, Copy, PartialEq, Default)]
enum Picture {
    #[default]
    Phase,
    Body,
    Scope,
    Ringing,
}

/// The pictures with their names and the widths of their tabs.
const PICTURES: [(Picture, &str, f32); 4] = [
    (Picture::Phase, "Phase", 44.0),
    (Picture::Body, "Shape", 46.0),
    (Picture::Scope, "Scope", 44.0),
    (Picture::Ringing, "Ringing", 52.0),
];

/// The state of the pictures.
#[derive(Default)]
pub(super) struct Displays {
    picture: Picture,
    phase: Phase,
    body: BodyView,
    ringing: Ringing,
    /// The key that a picture holds.
    audition: Audition,
}

impl Displays {
    /// Drops the user's action in a picture.
    pub(super) fn cancel(&mut self, controls: &mut Controls) {
        self.phase.cancel();
        self.body.cancel(controls);
        self.release(controls.params.link());
    }

    /// Releases the key that is held.
    pub(super) fn release(&mut self, link: &Link) {
        self.audition.release(link);
    }

    /// Shows the chosen picture for the energies of the modes; `selected` is the mode that was touched last.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        shown: &Shown,
        (energies, selected): (&[f32], Option<usize>),
        controls: &mut Controls,
    ) {
        let palette = controls.palette;
        palette.paint_panel(ui.painter(), rect);
        let mut left = rect.left() + PADDING;
        for (picture, name, width) in PICTURES {
            let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), egui::vec2(width, TITLE_HEIGHT));
            left = place.right() + 4.0;
            if tab(ui, place, name, picture == self.picture, palette).clicked() {
                self.cancel(controls);
                self.picture = picture;
            }
        }
        let caption = Rect::from_min_max(
            pos2(left + 4.0, rect.top() + 2.0),
            pos2(rect.right() - PADDING, rect.top() + 2.0 + TITLE_HEIGHT),
        );
        let area = Rect::from_min_max(pos2(rect.left(), rect.top() + TITLE_HEIGHT + 4.0), rect.max).shrink(PADDING);
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.ringing.note(now, energies);
        self.audition.follow_time(now, link);
        let audition = &mut self.audition;
        let text = match self.picture {
            Picture::Phase => self.phase.show(ui, area, (energies, selected), shown, audition, controls),
            Picture::Body => self.body.show(ui, (area, false), shown, energies, audition, controls),
            Picture::Scope => {
                let rate = link.sample_rate();
                scope::paint(ui.painter(), area, &link.telemetry.scope().read(), rate, palette);
                if rate == 0 { String::new() } else { format!("{:.0} ms", SHOWN as f32 * 1000.0 / rate as f32) }
            }
            Picture::Ringing => {
                self.ringing.paint(ui.painter(), area, selected, palette);
                "each mode’s level".to_owned()
            }
        };
        self.audition.request_end(ui);
        if caption.width() >= 48.0 {
            line(ui.painter(), caption, Align2::RIGHT_CENTER, &text, SMALL, palette.muted);
        }
    }
}
