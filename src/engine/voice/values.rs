//! The parameter values that a strike reads.

use crate::dsp::mode_bank::MAX_MODES;
use crate::engine::instrument::Instrument;
use crate::engine::modulation::{Modulators, Struck};
use crate::engine::note::Note;
use crate::params::Param;
use crate::patch::{Mode, ModeTable};

/// Passes a strike to the modulators. `first` is true for the first strike of the voice.
pub(super) fn strike_modulators(instrument: &Instrument, modulators: &mut Modulators, note: &Note, first: bool) {
    let (pitch, seed, serial) = (instrument.pitch(note), instrument.seed, note.serial);
    let struck = Struck { velocity: note.velocity, pitch, seed, serial };
    let Instrument { positions, settings, shared, knobs, .. } = instrument;
    modulators.strike(&struck, positions, settings, shared, |param| knobs.modulated(param), first);
}

/// The ratios of the modes of a cell; 0 for those that are missing.
pub(super) fn ratios(modes: &[Mode]) -> [f64; MAX_MODES] {
    let mut ratios = [0.0; MAX_MODES];
    ratios.iter_mut().zip(modes).for_each(|(ratio, mode)| *ratio = mode.ratio.into());
    ratios
}

/// The parameter values of one strike: the instrument's, modulated by the voice's routes.
#[derive(Clone, Copy)]
pub(super) struct StruckValues<'a> {
    pub(super) instrument: &'a Instrument,
    pub(super) modulators: &'a Modulators,
    /// The index of the note's table of modes.
    pub(super) table: usize,
}

impl<'a> StruckValues<'a> {
    /// The modes of the note.
    pub(super) fn modes(&self) -> &'a ModeTable {
        self.instrument.sound.patch().modes.at(self.table)
    }

    /// The value in the parameter's unit.
    pub(super) fn get(&self, param: Param) -> f64 {
        self.modulators.struck_value(param, |param| self.instrument.knobs.modulated(param)).into()
    }

    /// As [`StruckValues::get`], with the smoothed `value` in place of the instrument's value.
    pub(super) fn moved(&self, param: Param, value: f64) -> f64 {
        self.modulators.struck_value(param, |_| value as f32).into()
    }

    /// A parameter in per cent, as a fraction of 1.
    pub(super) fn share(&self, param: Param) -> f64 {
        self.get(param) * 0.01
    }
}
