//! The colour of a note: how much softer its higher modes are heard than they sound.

use crate::dsp::cells::{Cells, MAX_CELLS};
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::series::powers;
use crate::engine::controls::Controls;
use crate::patch::ModeTable;
use std::f64::consts::LOG2_10;

/// The colour of a voice. It only makes modes softer, so no bound of a strike changes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colour {
    /// In decibels per octave, at most 0.
    slope: f64,
}

impl Colour {
    /// All modes as loud as they sound.
    pub(super) const FULL: Self = Self { slope: 0.0 };

    /// Sets the output gains of the modes if the colour has changed: they are reached by the bank's next ramp. `modes` returns the
    /// patch's modes, or none if the patch was replaced.
    pub(super) fn control<'a>(
        &mut self,
        controls: &Controls,
        modes: impl Fn() -> Option<&'a ModeTable>,
        bank: &mut Cells,
    ) {
        if controls.colour == self.slope {
            return;
        }
        let Some(modes) = modes() else { return };
        self.slope = controls.colour;
        for (cell, octaves) in modes.octaves().chunks(MAX_MODES).enumerate().take(MAX_CELLS) {
            let mut gains = [1.0; MAX_MODES];
            powers(octaves, self.slope * (LOG2_10 / 20.0), &mut gains);
            // Modes below the fundamental are not raised.
            bank.set_colour(cell, gains.map(|gain| gain.min(1.0) as f32));
        }
    }
}
