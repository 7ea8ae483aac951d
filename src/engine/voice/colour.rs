//! How loudly the modes of a note are heard while it sounds, and at which pitches: its colour, and their drift.

use super::drift::Drift;
use crate::dsp::cells::{Cells, MAX_CELLS};
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::series::powers;
use crate::patch::ModeTable;
use std::f64::consts::LOG2_10;

/// The gains of a voice's modes, which only make them softer, so that no bound of a strike changes; and their pitches beside those
/// of the note. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colour {
    /// In decibels per octave, at most 0; none if the modes have become others since.
    slope: Option<f64>,
    /// The power of their ratios in the patch that the modes have.
    stretch: f64,
    /// Whether levels drift, and whether pitches do.
    drifts: [bool; 2],
}

impl Colour {
    /// All modes as loud as they sound.
    pub(super) const fn full(stretch: f64) -> Self {
        Self { slope: Some(0.0), stretch, drifts: [false; 2] }
    }

    /// The note has other modes now.
    pub(super) fn change_modes(&mut self, stretch: f64) {
        (self.slope, self.stretch) = (self.slope.filter(|slope| *slope == 0.0), stretch);
    }

    /// Sets gains and pitches of the modes if they have changed: they are reached by the bank's next ramp. `slope` is in decibels per
    /// octave, `frequency` that of the note in Hz, or none while something feels the pitches of the modes, which then stay. `modes`
    /// returns the patch's modes, or none if the patch was replaced: then all stays.
    pub(super) fn control<'a>(
        &mut self,
        slope: f64,
        drift: &Drift,
        frequency: Option<f64>,
        modes: impl Fn() -> Option<&'a ModeTable>,
        bank: &mut Cells,
    ) {
        let [drifts, detunes] = drift.moves();
        let [has_drifted, was_detuned] = self.drifts;
        let is_loud = self.slope == Some(slope) && !drifts && !has_drifted;
        let base = frequency.filter(|_| detunes || was_detuned);
        if is_loud && base.is_none() {
            return;
        }
        let Some(modes) = modes() else { return };
        (self.slope, self.drifts) = (Some(slope), [drifts, if base.is_some() { detunes } else { was_detuned }]);
        for (cell, octaves) in modes.octaves().chunks(MAX_MODES).enumerate().take(MAX_CELLS) {
            let [levels, ratios] = drift.at(cell, octaves.len());
            if !is_loud {
                let mut gains = [1.0; MAX_MODES];
                if slope != 0.0 {
                    powers(octaves, slope * self.stretch * (LOG2_10 / 20.0), &mut gains);
                }
                // Modes below the fundamental are not raised.
                bank.set_colour(cell, std::array::from_fn(|m| (gains[m].min(1.0) * levels[m]) as f32));
            }
            if let Some(base) = base {
                bank.transpose(cell, ratios.iter().map(|ratio| base * ratio));
            }
        }
    }
}
