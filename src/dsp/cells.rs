//! The body of one voice: a bank of 64 modes, or several side by side where a body has more.

use super::CONTROL_FRAMES;
use super::bank::{Bank, Law};
use super::exciter::Drive;
use super::mode_bank::tail::Energies;
use super::mode_bank::{ExcitationGains, MAX_MODES, ModeSetup};

/// Most cells that one voice plays.
pub const MAX_CELLS: usize = 8;

/// A bank, and what a voice keeps of each of its modes.
pub struct Cell {
    bank: Bank,
    /// Frequency of each mode as a multiple of the note's, and T60 as a multiple of the decay.
    ratios: [f64; MAX_MODES],
    t60_scales: [f64; MAX_MODES],
}

impl Cell {
    /// A cell without modes.
    pub fn new(sample_rate: f64) -> Self {
        Self { bank: Bank::new(sample_rate), ratios: [1.0; MAX_MODES], t60_scales: [1.0; MAX_MODES] }
    }
}

/// The cells that a voice has. Modes are numbered through all of them, and energies are added up in that order. Cells are
/// handed over, never copied: nothing but [`Cell::new`] allocates, and everything is real-time safe.
pub struct Cells {
    cells: [Option<Box<Cell>>; MAX_CELLS],
    /// Modes of all cells.
    len: usize,
    /// The sum of several cells.
    sum: [[f32; CONTROL_FRAMES]; 2],
}

impl Cells {
    /// No cell yet.
    pub const EMPTY: Self = Self { cells: [const { None }; MAX_CELLS], len: 0, sum: [[0.0; CONTROL_FRAMES]; 2] };

    /// How many cells so many modes take.
    pub fn count_for(modes: usize) -> usize {
        modes.div_ceil(MAX_MODES).clamp(1, MAX_CELLS)
    }

    /// Adds a cell; gives it back if there are [`MAX_CELLS`].
    pub fn add(&mut self, cell: Box<Cell>) -> Option<Box<Cell>> {
        let len = cell.bank.len();
        match self.cells.iter_mut().find(|place| place.is_none()) {
            Some(place) => {
                self.len += len;
                place.replace(cell)
            }
            None => Some(cell),
        }
    }

    /// Takes the last cell out.
    pub fn take(&mut self) -> Option<Box<Cell>> {
        let cell = self.cells.iter_mut().rev().find_map(Option::take)?;
        self.len -= cell.bank.len();
        Some(cell)
    }

    fn iter(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().map_while(Option::as_deref)
    }

    fn iter_mut(&mut self) -> impl Iterator<Item = &mut Cell> {
        self.cells.iter_mut().map_while(Option::as_deref_mut)
    }

    /// Frequency of each mode as a multiple of the note's: to be written before [`Cells::load`].
    pub fn ratios_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.iter_mut().flat_map(|cell| &mut cell.ratios)
    }

    /// T60 of each mode as a multiple of the decay: to be written before [`Cells::load`].
    pub fn t60_scales_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.iter_mut().flat_map(|cell| &mut cell.t60_scales)
    }

    /// Fills the cells with modes at rest, made by `setup` of each of `modes`, its ratio and its T60's scale. Whatever a
    /// cell played before leaves no trace.
    pub fn load<T>(
        &mut self,
        law: Law,
        sample_rate: f64,
        modes: &[T],
        setup: impl Fn(&T, f64, f64) -> ModeSetup + Copy,
    ) {
        for (Cell { bank, ratios, t60_scales }, modes) in self.iter_mut().zip(modes.chunks(MAX_MODES)) {
            bank.set_law(law, sample_rate);
            let rows = modes.iter().zip(ratios).zip(t60_scales);
            bank.load(rows.map(|((mode, ratio), scale)| setup(mode, *ratio, *scale)));
        }
        self.len = self.iter().map(|cell| cell.bank.len()).sum();
    }

    /// As [`super::ModeBank::retune`]: `tuning` makes frequency and T60 of a mode's ratio and its T60's scale.
    pub fn retune(&mut self, tuning: impl Fn(f64, f64) -> (f64, f64) + Copy) {
        for Cell { bank, ratios, t60_scales } in self.iter_mut() {
            bank.retune(ratios.iter().zip(t60_scales).map(|(ratio, scale)| tuning(*ratio, *scale)));
        }
    }

    /// As [`super::ModeBank::set_t60`], for all modes: `t60` makes it of a mode's scale.
    pub fn damp(&mut self, t60: impl Fn(f64) -> f64) {
        for Cell { bank, t60_scales, .. } in self.iter_mut() {
            (0..bank.len()).for_each(|m| bank.set_t60(m, t60(t60_scales[m])));
        }
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no modes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// As [`super::ModeBank::set_excitation_gains`]; a mode that there is not is left out.
    pub fn set_excitation_gains(&mut self, m: usize, gains: ExcitationGains) {
        if let Some(Some(cell)) = self.cells.get_mut(m / MAX_MODES) {
            cell.bank.set_excitation_gains(m % MAX_MODES, gains);
        }
    }

    /// As [`super::ModeBank::sweep_to`].
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        self.iter_mut().for_each(|cell| cell.bank.sweep_to(ratio, frames));
    }

    /// As [`super::ModeBank::jump_to`].
    pub fn jump_to(&mut self, ratio: f64) {
        self.iter_mut().for_each(|cell| cell.bank.jump_to(ratio));
    }

    /// As [`super::ModeBank::render`]; all cells are driven alike.
    pub fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        let Self { cells, sum, .. } = self;
        let frames = frames.min(CONTROL_FRAMES);
        let (first, rest) = cells.split_at_mut(1);
        let mut rest = rest.iter_mut().map_while(Option::as_deref_mut).peekable();
        let first = first.iter_mut().flatten().map(|cell| cell.bank.render(drive, frames)).next();
        let Some(first) = first else { return sum.each_ref().map(|side| &side[..frames]) };
        if rest.peek().is_none() {
            return first;
        }
        sum.iter_mut().zip(first).for_each(|(sum, side)| sum[..frames].copy_from_slice(side));
        for cell in rest {
            for (sum, side) in sum.iter_mut().zip(cell.bank.render(drive, frames)) {
                sum.iter_mut().zip(side).for_each(|(sum, sample)| *sum += sample);
            }
        }
        sum.each_ref().map(|side| &side[..frames])
    }

    /// As [`super::ModeBank::mass`], of the first [`MAX_MODES`] modes or fewer.
    pub fn masses(&self) -> impl Iterator<Item = (f32, f32)> {
        let bank = self.iter().next().map(|cell| &cell.bank);
        bank.into_iter().flat_map(|bank| (0..bank.len()).map(|m| bank.mass(m)))
    }

    /// As [`super::ModeBank::settle`].
    pub fn settle(&mut self) -> f64 {
        self.iter_mut().map(|cell| cell.bank.settle()).sum()
    }

    /// Frames until the squared amplitudes of all modes add up to less than `total`, if nothing damps them anew. Takes
    /// some microseconds.
    pub fn frames_until(&self, total: f64) -> u64 {
        self.energies().frames_until(total)
    }

    /// At most how many frames that takes once `more` energy, wherever it goes, has been added.
    pub fn frames_until_at_most(&self, total: f64, more: f64) -> u64 {
        self.energies().frames_until_at_most(total, more)
    }

    fn energies(&self) -> Energies<{ MAX_CELLS * MAX_MODES }> {
        let mut energies = Energies::NONE;
        self.iter().for_each(|cell| cell.bank.tell_energies(|energy, rate| energies.add(energy, rate)));
        energies
    }
}

#[cfg(test)]
#[path = "cells/tests.rs"]
mod tests;
