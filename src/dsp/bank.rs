//! The mode bank of a voice, with exact tuning or with the original formulas.

use super::exciter::{Drive, Player};
use super::mode_bank::exchange::{BANDS, Band, Exchange};
use super::mode_bank::played::Part;
use super::mode_bank::{ExcitationRows, MAX_MODES, ModeRows};
use super::{ClassicBank, ModeBank};

/// Selects the formulas that turn pitch and decay into coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Recurrence {
    /// Tuning and decay are exact, also during pitch bends; amplitudes do not depend on the pitch.
    Exact,
    /// The original formulas ([`super::Coefficients::seed`]), with the sweep kept below the value at which they are
    /// unstable.
    Classic,
}

/// A bank of modes with either recurrence. Each method does the same as the method of [`ModeBank`] with its name. Real-time safe.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "both are large, and a voice has one of them without allocating")]
pub(crate) enum Bank {
    /// By the exact recurrence.
    Exact(ModeBank),
    /// By the original formulas.
    Classic(ClassicBank),
}

/// Makes the same call on either bank.
macro_rules! either {
    ($self:expr, $bank:ident => $call:expr) => {
        match $self {
            Bank::Exact($bank) => $call,
            Bank::Classic($bank) => $call,
        }
    };
}

impl Bank {
    /// An empty bank of the exact recurrence.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self::Exact(ModeBank::new(sample_rate))
    }

    /// An empty bank with this recurrence.
    fn of(recurrence: Recurrence, sample_rate: f64) -> Self {
        match recurrence {
            Recurrence::Exact => Self::new(sample_rate),
            Recurrence::Classic => Self::Classic(ClassicBank::new(sample_rate)),
        }
    }

    /// Replaces the bank by an empty one with another recurrence. Does nothing if the bank has this recurrence already.
    pub(crate) fn set_recurrence(&mut self, recurrence: Recurrence, sample_rate: f64) {
        match (recurrence, &*self) {
            (Recurrence::Exact, Self::Exact(_)) | (Recurrence::Classic, Self::Classic(_)) => {}
            _ => *self = Self::of(recurrence, sample_rate),
        }
    }

    /// See [`ModeBank::load`].
    pub(crate) fn load(&mut self, modes: &ModeRows) {
        either!(self, bank => bank.load(modes));
    }

    /// See [`ModeBank::set_colour`]. Does nothing with the original formulas, whose modes have no gains that move.
    pub(crate) fn set_colour(&mut self, colour: [f32; MAX_MODES]) {
        if let Self::Exact(bank) = self {
            bank.set_colour(colour);
        }
    }

    /// See [`ModeBank::len`].
    pub(crate) fn len(&self) -> usize {
        either!(self, bank => bank.len())
    }

    /// See [`ModeBank::set_excitation_gains`].
    pub(crate) fn set_excitation_gains(&mut self, gains: &ExcitationRows) {
        either!(self, bank => bank.set_excitation_gains(gains));
    }

    /// See [`ModeBank::set_contact`]. Does nothing with the original formulas, which no player can drive.
    pub(crate) fn set_contact(&mut self, m: usize, take: f32, give: f32) {
        if let Self::Exact(bank) = self {
            bank.set_contact(m, take, give);
        }
    }

    /// See [`ModeBank::push`]. With the original formulas, nothing touches.
    pub(crate) fn push(&self, m: usize) -> f64 {
        if let Self::Exact(bank) = self { bank.push(m) } else { 0.0 }
    }

    /// See [`ModeBank::is_transposed`].
    pub(crate) fn is_transposed(&self) -> bool {
        if let Self::Exact(bank) = self { bank.is_transposed() } else { false }
    }

    /// See [`ModeBank::pitch`]; none with the original formulas.
    pub(crate) fn pitch(&self) -> Option<f64> {
        if let Self::Exact(bank) = self { bank.pitch() } else { None }
    }

    /// See [`ModeBank::set_touched`].
    pub(crate) fn set_touched(&mut self, m: usize, push: f64, weight: f64) -> [f64; 2] {
        if let Self::Exact(bank) = self { bank.set_touched(m, push, weight) } else { [0.0; 2] }
    }

    /// See [`ModeBank::part`]; none with the original formulas.
    pub(super) fn part(&mut self, frames: usize) -> Option<Part<'_>> {
        if let Self::Exact(bank) = self { Some(bank.part(frames).0) } else { None }
    }

    /// See [`ModeBank::nudge`].
    pub(crate) fn nudge(&mut self, m: usize, amplitude: f32) {
        either!(self, bank => bank.nudge(m, amplitude));
    }

    /// See [`ModeBank::set_t60`].
    pub(crate) fn set_t60(&mut self, m: usize, t60: f64) {
        either!(self, bank => bank.set_t60(m, t60));
    }

    /// See [`ModeBank::retune`].
    pub(crate) fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        either!(self, bank => bank.retune(modes));
    }

    /// See [`ModeBank::transpose`]. Does nothing with the original formulas, whose pitch drifts by itself.
    pub(crate) fn transpose(&mut self, frequencies: impl Iterator<Item = f64>) {
        if let Self::Exact(bank) = self {
            bank.transpose(frequencies);
        }
    }

    /// See [`ModeBank::sweep_to`].
    pub(crate) fn sweep_to(&mut self, ratio: f64, frames: usize) {
        either!(self, bank => bank.sweep_to(ratio, frames));
    }

    /// See [`ModeBank::jump_to`].
    pub(crate) fn jump_to(&mut self, ratio: f64) {
        either!(self, bank => bank.jump_to(ratio));
    }

    /// See [`ModeBank::render`].
    pub(crate) fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        either!(self, bank => bank.render(drive, frames))
    }

    /// See [`ModeBank::render_played`]. With the original formulas, the player moves nothing, and a hammer passes.
    pub(crate) fn render_played(
        &mut self,
        drive: Option<&Drive>,
        player: Option<Player>,
        frames: usize,
    ) -> [&[f32]; 2] {
        match self {
            Self::Exact(bank) => bank.render_played(drive, player, frames),
            Self::Classic(bank) => {
                if let Some(Player::Hammer(hammer)) = player {
                    (0..frames).for_each(|_| _ = hammer.force_on(0.0));
                }
                bank.render(drive, frames)
            }
        }
    }

    /// See [`ModeBank::mass`].
    pub(crate) fn mass(&self, m: usize) -> (f32, f32) {
        either!(self, bank => bank.mass(m))
    }

    /// See [`ModeBank::rest`].
    pub(super) fn rest(&mut self) {
        either!(self, bank => bank.rest());
    }

    /// See [`ModeBank::take_state_of`]. The other bank has the same recurrence.
    pub(super) fn take_state_of(&mut self, other: &Self) {
        match (self, other) {
            (Self::Exact(bank), Self::Exact(other)) => bank.take_state_of(other),
            (Self::Classic(bank), Self::Classic(other)) => bank.take_state_of(other),
            (bank, _) => bank.rest(),
        }
    }

    /// See [`ModeBank::settle`].
    pub(crate) fn settle(&mut self) -> f64 {
        either!(self, bank => bank.settle())
    }

    /// See [`ModeBank::rest_below`]. Does nothing with the original formulas.
    pub(super) fn rest_below(&mut self, least: f32) {
        if let Self::Exact(bank) = self {
            bank.rest_below(least);
        }
    }

    /// See [`ModeBank::add_energies`]. Modes of the original formulas do not exchange energy, so they are not counted.
    pub(super) fn add_energies(&self, bands: &[u8; MAX_MODES], sums: &mut [Band; BANDS]) {
        if let Self::Exact(bank) = self {
            bank.add_energies(bands, sums);
        }
    }

    /// See [`ModeBank::squared_amplitudes`].
    #[cfg(test)]
    pub(super) fn squared_amplitudes(&self) -> impl Iterator<Item = f64> {
        match self {
            Self::Exact(bank) => bank.squared_amplitudes().collect::<Vec<_>>().into_iter(),
            Self::Classic(bank) => (0..bank.len()).map(|m| f64::from(bank.mass(m).1)).collect::<Vec<_>>().into_iter(),
        }
    }

    /// See [`ModeBank::exchange`].
    pub(super) fn exchange(
        &mut self,
        bands: &[u8; MAX_MODES],
        exchange: &[Exchange; BANDS],
        sign: impl Fn(usize) -> f32,
    ) {
        if let Self::Exact(bank) = self {
            bank.exchange(bands, exchange, sign);
        }
    }

    /// See [`ModeBank::tell_energies`].
    pub(super) fn tell_energies(&self, each: impl FnMut(f64, f64)) {
        either!(self, bank => bank.tell_energies(each));
    }
}
