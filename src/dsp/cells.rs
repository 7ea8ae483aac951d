//! The modes of one voice: a bank of 64 modes, or several such banks for a body with more modes.

mod cascade;

pub(crate) use cascade::Climb;

use super::CONTROL_FRAMES;
use super::bank::{Bank, Recurrence};
use super::exciter::{Drive, Player};
use super::mode_bank::played::play;
use super::mode_bank::tail::Energies;
use super::mode_bank::{ExcitationRows, MAX_MODES, ModeRows};

/// Maximum number of cells of one voice.
pub(crate) const MAX_CELLS: usize = 8;

/// A bank, with the frequency ratio and decay scale of each of its modes.
#[derive(Clone)]
pub(crate) struct Cell {
    bank: Bank,
    /// Frequency of each mode as a multiple of the note's frequency, and its T60 as a multiple of the note's decay.
    ratios: [f64; MAX_MODES],
    t60_scales: [f64; MAX_MODES],
    /// Square of each mode's shape at the point of touch, 0–1.
    touched: [f32; MAX_MODES],
    /// The band of each mode, for [`Cells::climb`].
    bands: [u8; MAX_MODES],
}

impl Cell {
    /// A cell without modes.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self {
            bank: Bank::new(sample_rate),
            ratios: [1.0; MAX_MODES],
            t60_scales: [1.0; MAX_MODES],
            touched: [0.0; MAX_MODES],
            bands: [0; MAX_MODES],
        }
    }
}

/// The cells of one voice. Modes are numbered consecutively through all cells, and energies are added up in that order.
/// Cells are moved between owners: only `Cell::new` and copies allocate, and everything else is real-time safe.
#[derive(Clone)]
pub(crate) struct Cells {
    cells: [Option<Box<Cell>>; MAX_CELLS],
    /// Number of modes of all cells together.
    len: usize,
    /// The summed output of several cells.
    sum: [[f32; CONTROL_FRAMES]; 2],
}

impl Cells {
    /// No cells.
    pub(crate) const EMPTY: Self = Self { cells: [const { None }; MAX_CELLS], len: 0, sum: [[0.0; CONTROL_FRAMES]; 2] };

    /// Number of cells that this number of modes needs.
    pub(crate) fn count_for(modes: usize) -> usize {
        modes.div_ceil(MAX_MODES).clamp(1, MAX_CELLS)
    }

    /// Adds a cell. Returns it if there are [`MAX_CELLS`] already.
    pub(crate) fn add(&mut self, cell: Box<Cell>) -> Option<Box<Cell>> {
        let len = cell.bank.len();
        match self.cells.iter_mut().find(|place| place.is_none()) {
            Some(place) => {
                self.len += len;
                place.replace(cell)
            }
            None => Some(cell),
        }
    }

    /// Removes the last cell and returns it.
    pub(crate) fn take(&mut self) -> Option<Box<Cell>> {
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

    /// Like [`super::ModeBank::rest`].
    pub(crate) fn rest(&mut self) {
        self.iter_mut().for_each(|cell| cell.bank.rest());
    }

    /// Like [`super::ModeBank::take_state_of`].
    pub(crate) fn take_state_of(&mut self, other: &Self) {
        self.iter_mut().zip(other.iter()).for_each(|(cell, other)| cell.bank.take_state_of(&other.bank));
    }

    /// Frequency of each mode as a multiple of the note's frequency, a row for each cell. Write these before
    /// [`Cells::load`].
    pub(crate) fn ratios_mut(&mut self) -> impl Iterator<Item = &mut [f64; MAX_MODES]> {
        self.iter_mut().map(|cell| &mut cell.ratios)
    }

    /// T60 of each mode as a multiple of the note's decay, a row for each cell. Write these before [`Cells::load`].
    pub(crate) fn t60_scales_mut(&mut self) -> impl Iterator<Item = &mut [f64; MAX_MODES]> {
        self.iter_mut().map(|cell| &mut cell.t60_scales)
    }

    /// Square of each mode's shape at the point of touch, 0–1, a row for each cell. Only the functions that are passed to
    /// [`Cells::load`], [`Cells::retune`] and [`Cells::damp`] receive it.
    pub(crate) fn touched_mut(&mut self) -> impl Iterator<Item = &mut [f32; MAX_MODES]> {
        self.iter_mut().map(|cell| &mut cell.touched)
    }

    /// Fills the cells with modes at rest. `setup` computes those of a cell from its part of `modes`, and from the rows of their
    /// ratios, T60 scales and squared shapes at the point of touch. Nothing remains of earlier modes.
    pub(crate) fn load<T>(
        &mut self,
        recurrence: Recurrence,
        sample_rate: f64,
        modes: &[T],
        setup: impl Fn(&[T], [&[f64; MAX_MODES]; 3]) -> ModeRows,
    ) {
        for (Cell { bank, ratios, t60_scales, touched, .. }, modes) in self.iter_mut().zip(modes.chunks(MAX_MODES)) {
            bank.set_recurrence(recurrence, sample_rate);
            bank.load(&setup(modes, [ratios, t60_scales, &touched.map(f64::from)]));
        }
        self.len = self.iter().map(|cell| cell.bank.len()).sum();
    }

    /// Like [`super::ModeBank::retune`]: `tuning` computes a mode's frequency in Hz and its T60 in seconds from its
    /// ratio, its T60 scale, and its squared shape at the point of touch.
    pub(crate) fn retune(&mut self, tuning: impl Fn(f64, f64, f64) -> (f64, f64) + Copy) {
        for Cell { bank, ratios, t60_scales, touched, .. } in self.iter_mut() {
            let rows = ratios.iter().zip(t60_scales).zip(touched);
            bank.retune(rows.map(|((ratio, scale), touched)| tuning(*ratio, *scale, f64::from(*touched))));
        }
    }

    /// Like [`super::ModeBank::transpose`], for the modes of a cell: a mode's frequency is its ratio times one of `bases`, in Hz. Does
    /// nothing if there is no such cell.
    pub(crate) fn transpose(&mut self, cell: usize, bases: impl Iterator<Item = f64>) {
        if let Some(Some(cell)) = self.cells.get_mut(cell) {
            cell.bank.transpose(cell.ratios.iter().zip(bases).map(|(ratio, base)| ratio * base));
        }
    }

    /// Like [`super::ModeBank::set_t60`], for all modes: `t60` computes the T60 in seconds from a mode's T60 scale and its
    /// squared shape at the point of touch.
    pub(crate) fn damp(&mut self, t60: impl Fn(f64, f64) -> f64) {
        for Cell { bank, t60_scales, touched, .. } in self.iter_mut() {
            (0..bank.len()).for_each(|m| bank.set_t60(m, t60(t60_scales[m], f64::from(touched[m]))));
        }
    }

    /// Number of modes.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Like [`super::ModeBank::set_excitation_gains`], for the modes of a cell. Does nothing if there is no such cell.
    pub(crate) fn set_excitation_gains(&mut self, cell: usize, gains: &ExcitationRows) {
        if let Some(Some(cell)) = self.cells.get_mut(cell) {
            cell.bank.set_excitation_gains(gains);
        }
    }

    /// Like [`super::ModeBank::set_colour`], for the modes of a cell. Does nothing if there is no such cell.
    pub(crate) fn set_colour(&mut self, cell: usize, colour: [f32; MAX_MODES]) {
        if let Some(Some(cell)) = self.cells.get_mut(cell) {
            cell.bank.set_colour(colour);
        }
    }

    /// Like [`super::ModeBank::nudge`]. Does nothing if there is no mode `m`.
    pub(crate) fn nudge(&mut self, m: usize, amplitude: f32) {
        if let Some(Some(cell)) = self.cells.get_mut(m / MAX_MODES) {
            cell.bank.nudge(m % MAX_MODES, amplitude);
        }
    }

    /// Like [`super::ModeBank::sweep_to`].
    pub(crate) fn sweep_to(&mut self, ratio: f64, frames: usize) {
        self.iter_mut().for_each(|cell| cell.bank.sweep_to(ratio, frames));
    }

    /// Like [`super::ModeBank::jump_to`].
    pub(crate) fn jump_to(&mut self, ratio: f64) {
        self.iter_mut().for_each(|cell| cell.bank.jump_to(ratio));
    }

    /// See [`super::ModeBank::is_transposed`].
    pub(crate) fn is_transposed(&self) -> bool {
        self.cells[0].as_ref().is_some_and(|cell| cell.bank.is_transposed())
    }

    /// See [`super::ModeBank::pitch`].
    pub(crate) fn pitch(&self) -> Option<f64> {
        self.cells[0].as_ref()?.bank.pitch()
    }

    /// Sets what the first [`MAX_MODES`] modes take of a player's force and what they give of their displacement. Modes after
    /// these are not played. `contact` tells both of a mode by its number.
    pub(crate) fn set_contacts(&mut self, contact: impl Fn(usize) -> [f32; 2]) {
        let Some(Cell { bank, .. }) = self.iter_mut().next() else { return };
        for m in 0..bank.len() {
            let [take, give] = contact(m);
            bank.set_contact(m, take, give);
        }
    }

    /// Like [`super::ModeBank::set_touched`], for the modes of the first cells. `touch` tells push and weight of a mode by its number
    /// and by the push of a mallet. Returns the sums.
    pub(crate) fn set_touched(&mut self, cells: usize, touch: impl Fn(usize, f64) -> [f64; 2]) -> [f64; 2] {
        let mut total = [0.0; 2];
        for (cell, Cell { bank, .. }) in self.iter_mut().take(cells).enumerate() {
            for m in 0..bank.len() {
                let [push, weight] = touch(cell * MAX_MODES + m, bank.push(m));
                let own = bank.set_touched(m, push, weight);
                total = [total[0] + own[0], total[1] + own[1]];
            }
        }
        total
    }

    /// As [`super::ModeBank::render_played`]. The drive acts on all cells, and so does a hammer; other players act only on the first.
    pub(crate) fn render(&mut self, drive: Option<&Drive>, player: Option<Player>, frames: usize) -> [&[f32]; 2] {
        let frames = frames.min(CONTROL_FRAMES);
        let mut player = player;
        let is_exact = matches!(self.cells[0].as_deref(), Some(Cell { bank: Bank::Exact(_), .. }));
        if is_exact
            && self.cells[1].is_some()
            && let Some(player @ (Player::Hammer(_) | Player::Forces(_))) = &mut player
        {
            self.render_hammered(drive.unwrap_or(&Drive::NONE), player, frames);
            return self.sum.each_ref().map(|side| &side[..frames]);
        }
        let Self { cells, sum, .. } = self;
        let (first, rest) = cells.split_at_mut(1);
        let mut rest = rest.iter_mut().map_while(Option::as_deref_mut).peekable();
        let first = first[0].as_deref_mut().map(|cell| cell.bank.render_played(drive, player, frames));
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

    /// Renders all cells together, since a hammer feels all of them. Returns the player's forces.
    pub(crate) fn render_hammered(
        &mut self,
        drive: &Drive,
        player: &mut Player,
        frames: usize,
    ) -> [f32; CONTROL_FRAMES] {
        let Self { cells, sum, .. } = self;
        let mut parts = cells.each_mut().map(|cell| cell.as_deref_mut()?.bank.part(frames));
        play(&mut parts, frames, drive, player, sum)
    }

    /// Like [`super::ModeBank::mass`], for the modes of the first cell: at most [`MAX_MODES`].
    pub(crate) fn masses(&self) -> impl Iterator<Item = (f32, f32)> {
        let bank = self.iter().next().map(|cell| &cell.bank);
        bank.into_iter().flat_map(|bank| (0..bank.len()).map(|m| bank.mass(m)))
    }

    /// Each mode: its frequency as a multiple of the note's, its T60 as a multiple of the note's decay, its squared shape at the
    /// point of touch, and its squared amplitude.
    pub(crate) fn modes(&self) -> impl Iterator<Item = (f64, f64, f64, f64)> {
        self.iter().flat_map(|cell| {
            let energy = |m| f64::from(cell.bank.mass(m).1);
            let row = move |m| (cell.ratios[m], cell.t60_scales[m], f64::from(cell.touched[m]), energy(m));
            (0..cell.bank.len()).map(row)
        })
    }

    /// Like [`super::ModeBank::settle`].
    pub(crate) fn settle(&mut self) -> f64 {
        self.iter_mut().map(|cell| cell.bank.settle()).sum()
    }

    /// Like [`super::ModeBank::rest_below`], for each cell.
    pub(crate) fn rest_below(&mut self, least: f32) {
        self.iter_mut().for_each(|cell| cell.bank.rest_below(least));
    }

    /// Frames until the sum of the squared amplitudes of all modes falls below `total`, if their damping does not
    /// change. Takes some microseconds.
    pub(crate) fn frames_until(&self, total: f64) -> u64 {
        self.energies().frames_until(total)
    }

    /// Upper bound of [`Cells::frames_until`] after `more` energy has been added, whichever modes get it.
    pub(crate) fn frames_until_at_most(&self, total: f64, more: f64) -> u64 {
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
