//! A patch: a value for each parameter, the table of modes, and the routes. It is what users edit and save.

pub mod routes;

use crate::dsp::cells::MAX_CELLS;
use crate::dsp::mode_bank;
use crate::params::{Param, Values};
use routes::{Route, Routes, Source, amount_param};
use std::sync::Arc;

/// Maximum number of modes of a body.
pub const MAX_MODES: usize = MAX_CELLS * mode_bank::MAX_MODES;

/// One mode of the body: a mass on a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Frequency as a multiple of the note's.
    pub ratio: f32,
    /// Amplitude after a strike of full force. A negative level inverts the phase.
    pub level: f32,
    /// T60 as a multiple of the patch's `decay`.
    pub decay: f32,
    /// Fraction of the excitation that comes from the strike or pluck; the rest is the noise burst.
    pub strike: f32,
    /// Position from −1 (left) to 1 (right).
    pub pan: f32,
}

impl Mode {
    /// The single mode of the preset `init`: at the note's pitch, full level, the patch's own decay, struck, centred.
    pub const UNIT: Mode = Mode { ratio: 1.0, level: 1.0, decay: 1.0, strike: 1.0, pan: 0.0 };

    /// Names and ranges of the fields, for reading, checking and writing preset files.
    pub(crate) const FIELDS: [(&'static str, f32, f32); 5] = [
        ("ratio", 0.01, 1000.0),
        ("level", -1.0, 1.0),
        ("decay", 0.001, 10.0),
        ("strike", 0.0, 1.0),
        ("pan", -1.0, 1.0),
    ];

    /// The fields in the order of [`Mode::FIELDS`].
    pub(crate) fn fields(&self) -> [f32; 5] {
        [self.ratio, self.level, self.decay, self.strike, self.pan]
    }

    /// The mode with each field at the nearest value in its range; NaN becomes the smallest one.
    #[must_use]
    pub fn clamped(&self) -> Self {
        let mut fields = self.fields();
        for (field, (_, min, max)) in fields.iter_mut().zip(Self::FIELDS) {
            *field = if *field >= min { field.min(max) } else { min };
        }
        Self::from_fields(fields)
    }

    /// The reverse of [`Mode::fields`].
    pub(crate) fn from_fields([ratio, level, decay, strike, pan]: [f32; 5]) -> Self {
        Self { ratio, level, decay, strike, pan }
    }
}

/// A body: one to [`MAX_MODES`] modes. Clones share the same table.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeTable {
    modes: Arc<[Mode]>,
    origin: Option<Arc<str>>,
}

impl ModeTable {
    /// The first [`MAX_MODES`] of `modes`, or [`Mode::UNIT`] if there are none. The caller must check the ranges.
    /// Allocates.
    pub fn new(modes: &[Mode]) -> Self {
        let modes = if modes.is_empty() { &[Mode::UNIT] } else { modes };
        Self { modes: modes[..modes.len().min(MAX_MODES)].into(), origin: None }
    }

    /// The modes.
    pub fn as_slice(&self) -> &[Mode] {
        &self.modes
    }

    /// The table with a text from which its modes were made. Files contain that text instead of the modes. Allocates.
    #[must_use]
    pub fn with_origin(self, origin: &str) -> Self {
        Self { origin: Some(origin.into()), ..self }
    }

    /// The text from which the modes were made, if there is one.
    pub fn origin(&self) -> Option<&str> {
        self.origin.as_deref()
    }
}

/// A value for each parameter, the modes of the body, and the routes.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The parameters.
    pub values: Values,
    /// The body.
    pub modes: ModeTable,
    /// The modulation routes.
    pub routes: Routes,
}

impl Default for Patch {
    /// The preset `init`: every parameter at its default, one mode and [`Routes::INITIAL`]. Allocates.
    fn default() -> Self {
        Self { values: Values::default(), modes: ModeTable::new(&[Mode::UNIT]), routes: Routes::INITIAL }
    }
}

impl Patch {
    /// As [`Values::get`].
    pub fn get(&self, param: Param) -> f32 {
        self.values.get(param)
    }

    /// As [`Values::set`].
    pub fn set(&mut self, param: Param, value: f32) {
        self.values.set(param, value);
    }

    /// The patch with one parameter changed, for building a patch in an expression.
    #[must_use]
    pub fn with(mut self, param: Param, value: f32) -> Self {
        self.set(param, value);
        self
    }

    /// The patch with a route at a place, 0 to 15, as [`Patch::with`]: `source` modulates `destination` linearly, by
    /// `amount` per cent of its knob travel if the source is 1.
    #[must_use]
    pub fn with_route(mut self, place: usize, source: Source, destination: Param, amount: f32) -> Self {
        self.routes.set(place, Some(Route::linear(source, destination)));
        self.with(amount_param(place), amount)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_out_of_range_becomes_the_nearest_in_it() {
        let mode = Mode { ratio: 0.0, level: 3.0, decay: f32::NAN, strike: 0.5, pan: -2.0 }.clamped();
        assert_eq!(mode, Mode { ratio: 0.01, level: 1.0, decay: 0.001, strike: 0.5, pan: -1.0 });
    }

    #[test]
    fn a_table_has_between_one_and_512_modes() {
        assert_eq!(ModeTable::new(&[]).as_slice(), &[Mode::UNIT]);
        assert_eq!(ModeTable::new(&[Mode::UNIT; 1000]).as_slice().len(), MAX_MODES);
    }
}
