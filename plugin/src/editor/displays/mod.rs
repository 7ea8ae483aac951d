//! Pictures of what sounds: the modes, the body, the phase plane of one mass, the waveform with its spectrum, and the modes' decay.

mod phase;
mod ringing;
pub(super) mod scope;
mod spectrum;

use crate::editor::body::view::BodyView;
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::keyboard::audition::Audition;
use crate::editor::modes::ModesView;
use crate::editor::theme::SMALL;
use crate::editor::widgets::text::line;
use crate::link::Link;
use egui::{Align2, Rect, Ui};
use phase::Phase;
use ringing::Ringing;

/// A picture.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Picture {
    Modes,
    Body,
    Phase,
    Scope,
    Ringing,
}

/// The pictures with their names.
pub(super) const PICTURES: [(Picture, &str); 5] = [
    (Picture::Modes, "Modes"),
    (Picture::Body, "Shape"),
    (Picture::Phase, "Phase"),
    (Picture::Scope, "Scope"),
    (Picture::Ringing, "Ringing"),
];

/// The state of the pictures.
#[derive(Default)]
pub(super) struct Displays {
    modes: ModesView,
    phase: Phase,
    body: BodyView,
    ringing: Ringing,
    /// The key that a picture holds.
    audition: Audition,
}

impl Displays {
    /// Drops the user's action in a picture.
    pub(super) fn cancel(&mut self, controls: &mut Controls) {
        self.modes.cancel(controls);
        self.phase.cancel();
        self.body.cancel(controls);
        self.release(controls.params.link());
    }

    /// Releases the key that is held.
    pub(super) fn release(&mut self, link: &Link) {
        self.modes.release(link);
        self.audition.release(link);
    }

    /// Shows a picture for the energies of the modes, and at its head what is said of it.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        [head, area]: [Rect; 2],
        picture: Picture,
        (shown, energies): (&Shown, &[f32]),
        controls: &mut Controls,
    ) {
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.ringing.note(now, energies);
        self.audition.follow_time(now, link);
        let (selected, audition) = (self.modes.selected(), &mut self.audition);
        let palette = controls.palette;
        let text = match picture {
            Picture::Modes => {
                self.modes.show(ui, [head, area], shown, energies, controls);
                String::new()
            }
            Picture::Phase => self.phase.show(ui, area, (energies, selected), shown, audition, controls),
            Picture::Body => self.body.show(ui, (area, false), shown, energies, audition, controls),
            Picture::Scope => scope::show(ui, area, controls),
            Picture::Ringing => {
                self.ringing.paint(ui.painter(), area, selected, palette);
                "each mode’s level".to_owned()
            }
        };
        self.audition.request_end(ui);
        if head.width() >= 48.0 {
            line(ui.painter(), head, Align2::RIGHT_CENTER, &text, SMALL, palette.muted);
        }
    }
}
