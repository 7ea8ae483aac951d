//! A number of voices and cells: the need of a note, or the content of a pool.

use std::ops::{Add, AddAssign, Sub, SubAssign};

/// A number of voices and a number of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Footprint {
    /// Voices.
    pub voices: usize,
    /// Cells of all these voices together.
    pub cells: usize,
}

impl Footprint {
    /// No voices and no cells.
    pub(crate) const NONE: Self = Self { voices: 0, cells: 0 };

    /// Whether `room` has enough of both.
    pub(crate) fn fits(self, room: Self) -> bool {
        self.voices <= room.voices && self.cells <= room.cells
    }

    /// The larger of each of the two numbers.
    #[must_use]
    pub(crate) fn max(self, other: Self) -> Self {
        Self { voices: self.voices.max(other.voices), cells: self.cells.max(other.cells) }
    }

    /// The part of a pool of this size that notes may use as long as they do not fade. The rest, a quarter, is for
    /// stolen notes while they fade out.
    #[must_use]
    pub(crate) fn for_sounding(self) -> Self {
        Self { voices: self.voices - self.voices / 4, cells: self.cells - self.cells / 4 }
    }
}

impl Add for Footprint {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { voices: self.voices + other.voices, cells: self.cells + other.cells }
    }
}

impl AddAssign for Footprint {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Footprint {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { voices: self.voices.saturating_sub(other.voices), cells: self.cells.saturating_sub(other.cells) }
    }
}

impl SubAssign for Footprint {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
