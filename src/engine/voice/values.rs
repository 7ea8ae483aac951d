//! The parameter values that a strike reads.

use crate::dsp::cells::MAX_CELLS;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::series::powers;
use crate::engine::instrument::Instrument;
use crate::engine::modulation::Modulators;
use crate::engine::note::Note;
use crate::params::Param;
use crate::patch::{Mode, ModeTable};
use libm::fabs;
use std::f64::consts::LOG2_10;

/// Passes a strike to the modulators. `first` is true for the first strike of the voice.
pub(super) fn strike_modulators(instrument: &Instrument, modulators: &mut Modulators, note: &Note, first: bool) {
    let struck = instrument.struck(note);
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

    /// The levels of the modes, a row for each cell, with the strike's tilt: each level is multiplied by a power of the mode's
    /// ratio, and all by a factor that keeps the sum of their magnitudes.
    pub(super) fn tilted_levels(&self) -> [[f64; MAX_MODES]; MAX_CELLS] {
        let (table, exponent) = (self.modes(), self.get(Param::Tilt) / (20.0 / LOG2_10));
        let mut levels = [[0.0; MAX_MODES]; MAX_CELLS];
        let rows = table.as_slice().chunks(MAX_MODES).zip(table.octaves().chunks(MAX_MODES));
        if exponent == 0.0 {
            for (levels, (modes, _)) in levels.iter_mut().zip(rows) {
                levels.iter_mut().zip(modes).for_each(|(level, mode)| *level = mode.level.into());
            }
            return levels;
        }
        let (mut plain, mut total) = (0.0, 0.0);
        for (levels, (modes, octaves)) in levels.iter_mut().zip(rows) {
            powers(octaves, exponent, levels);
            for (level, mode) in levels.iter_mut().zip(modes) {
                *level *= f64::from(mode.level);
                plain += fabs(mode.level.into());
                total += fabs(*level);
            }
        }
        let balance = if total > 0.0 { plain / total } else { 1.0 };
        levels.as_flattened_mut().iter_mut().for_each(|level| *level *= balance);
        levels
    }
}
