//! How loudly the modes of a note are heard, while it sounds: by its colour, and by their drift.

use super::drift::Drift;
use crate::dsp::cells::{Cells, MAX_CELLS};
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::series::powers;
use crate::patch::ModeTable;
use std::f64::consts::LOG2_10;

/// The gains of a voice's modes. They only make modes softer, so no bound of a strike changes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colour {
    /// In decibels per octave, at most 0; none if the modes have become others since.
    slope: Option<f64>,
    /// The power of their ratios in the patch that the modes have.
    stretch: f64,
    drifts: bool,
}

impl Colour {
    /// All modes as loud as they sound.
    pub(super) const fn full(stretch: f64) -> Self {
        Self { slope: Some(0.0), stretch, drifts: false }
    }

    /// The note has other modes now.
    pub(super) fn change_modes(&mut self, stretch: f64) {
        (self.slope, self.stretch) = (self.slope.filter(|slope| *slope == 0.0), stretch);
    }

    /// Sets the gains of the modes if they have changed: they are reached by the bank's next ramp. `slope` is in decibels per octave.
    /// `modes` returns the patch's modes, or none if the patch was replaced: then the gains stay as they are.
    pub(super) fn control<'a>(
        &mut self,
        slope: f64,
        drift: &Drift,
        modes: impl Fn() -> Option<&'a ModeTable>,
        bank: &mut Cells,
    ) {
        if self.slope == Some(slope) && !drift.moves_levels() && !self.drifts {
            return;
        }
        let Some(modes) = modes() else { return };
        (self.slope, self.drifts) = (Some(slope), drift.moves_levels());
        for (cell, octaves) in modes.octaves().chunks(MAX_MODES).enumerate().take(MAX_CELLS) {
            let mut gains = [1.0; MAX_MODES];
            if slope != 0.0 {
                powers(octaves, slope * self.stretch * (LOG2_10 / 20.0), &mut gains);
            }
            // Modes below the fundamental are not raised.
            gains.iter_mut().for_each(|gain| *gain = gain.min(1.0));
            if self.drifts {
                gains.iter_mut().zip(drift.levels(cell)).for_each(|(gain, drift)| *gain *= drift);
            }
            bank.set_colour(cell, gains.map(|gain| gain as f32));
        }
    }
}
