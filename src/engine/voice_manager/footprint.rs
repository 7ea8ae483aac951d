//! How much of a pool something takes.

use std::ops::{Add, AddAssign, Sub, SubAssign};

/// How many voices and cells something takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Voices.
    pub voices: usize,
    /// Cells of all of them together.
    pub cells: usize,
}

impl Footprint {
    /// Nothing.
    pub const NONE: Self = Self { voices: 0, cells: 0 };

    /// Whether there is enough of both in `room`.
    pub fn fits(self, room: Self) -> bool {
        self.voices <= room.voices && self.cells <= room.cells
    }

    /// The greater number of each.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self { voices: self.voices.max(other.voices), cells: self.cells.max(other.cells) }
    }

    /// How much of a pool of this size may be taken by notes that are not fading. The rest, a quarter, is for those that
    /// make room for others.
    #[must_use]
    pub fn for_sounding(self) -> Self {
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
