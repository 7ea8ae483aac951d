//! The modes of a body: one table for all keys, or one for each key if only a part of the body follows the key.

use crate::dsp::cells::MAX_CELLS;
use crate::dsp::mode_bank;
use libm::{log2, round};
use std::fmt;
use std::sync::{Arc, OnceLock};

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

/// A body: one to [`MAX_MODES`] modes, each with a phase. Clones share the same table.
///
/// A body can have a table of its own for each key of a range. These tables are made once, off the audio thread
/// ([`ModeTable::make_tables`], which [`Sound::new`](crate::sound::Sound::new) calls), and all clones share them. All
/// have the same number of modes.
#[derive(Clone, Debug)]
pub struct ModeTable {
    modes: Arc<[Mode]>,
    /// Logarithm to base 2 of each mode's ratio.
    octaves: Arc<[f64]>,
    /// Empty if all phases are 0.
    phases: Arc<[f32]>,
    origin: Option<Arc<str>>,
    by_key: Option<Arc<ByKey>>,
}

/// One table for each key from `lowest` on.
struct ByKey {
    lowest: u8,
    make: Box<dyn Fn() -> Vec<ModeTable> + Send + Sync>,
    made: OnceLock<Vec<ModeTable>>,
}

impl fmt::Debug for ByKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ByKey").field("lowest", &self.lowest).field("is_made", &self.made.get().is_some()).finish()
    }
}

/// Tables by key are equal if they were made from the same text, or if they are clones of one table.
impl PartialEq for ModeTable {
    fn eq(&self, other: &Self) -> bool {
        let is_same = match (&self.by_key, &other.by_key) {
            (None, None) => true,
            (Some(one), Some(other)) => self.origin.is_some() || Arc::ptr_eq(one, other),
            _ => false,
        };
        is_same && self.modes == other.modes && self.phases == other.phases && self.origin == other.origin
    }
}

impl ModeTable {
    /// The first [`MAX_MODES`] of `modes`, or [`Mode::UNIT`] if there are none. The caller must check the ranges.
    /// Allocates.
    pub fn new(modes: &[Mode]) -> Self {
        let modes = if modes.is_empty() { &[Mode::UNIT] } else { modes };
        let modes: Arc<[Mode]> = modes[..modes.len().min(MAX_MODES)].into();
        let octaves = modes.iter().map(|mode| log2(mode.ratio.into())).collect();
        Self { modes, octaves, phases: Arc::new([]), origin: None, by_key: None }
    }

    /// The modes. If there is a table for each key, these are the modes of a middle key.
    pub fn as_slice(&self) -> &[Mode] {
        &self.modes
    }

    /// The logarithm to base 2 of each mode's ratio, so that a strike can compute powers of the ratios quickly.
    pub(crate) fn octaves(&self) -> &[f64] {
        &self.octaves
    }

    /// The table with a phase in radians for each mode: a strike starts mode `m` as `sin(ωt + phases[m])`. Missing phases
    /// are 0. Allocates.
    #[must_use]
    pub fn with_phases(self, phases: &[f32]) -> Self {
        Self { phases: phases.into(), ..self }
    }

    /// The phase of mode `m` in radians. Real-time safe.
    pub fn phase(&self, m: usize) -> f32 {
        self.phases.get(m).copied().unwrap_or(0.0)
    }

    /// Whether the modes have phases. Then their levels and phases together are the response at certain places, and no
    /// other place can be derived from them.
    pub fn has_phases(&self) -> bool {
        !self.phases.is_empty()
    }

    /// The table with a text from which its modes were made. Files contain that text instead of the modes. Allocates.
    #[must_use]
    pub(crate) fn with_origin(self, origin: &str) -> Self {
        Self { origin: Some(origin.into()), ..self }
    }

    /// The text from which the modes were made, if there is one.
    pub fn origin(&self) -> Option<&str> {
        self.origin.as_deref()
    }

    /// The table, with another one for each key from the MIDI key `lowest` on, at A4 = 440 Hz. `make` runs when
    /// [`ModeTable::make_tables`] is called. It must return at least one table, in the order of the keys, each with as
    /// many modes as this one. Allocates.
    #[must_use]
    pub(crate) fn with_keys(self, lowest: u8, make: impl Fn() -> Vec<ModeTable> + Send + Sync + 'static) -> Self {
        let by_key = ByKey { lowest, make: Box::new(make), made: OnceLock::new() };
        Self { by_key: Some(Arc::new(by_key)), ..self }
    }

    /// Makes the tables of the keys, unless they are made already. Not real-time safe: takes up to seconds.
    pub fn make_tables(&self) {
        let Some(ByKey { make, made, .. }) = self.by_key.as_deref() else { return };
        made.get_or_init(|| {
            let fits = |table: &ModeTable| table.modes.len() == self.modes.len();
            make().into_iter().filter(fits).collect()
        });
    }

    /// The keys that have a table of their own; none if one table is for all keys, or if the tables are not made yet.
    #[cfg(test)]
    pub(crate) fn keys(&self) -> Option<std::ops::RangeInclusive<u8>> {
        let lowest = self.by_key.as_deref()?.lowest;
        let highest = usize::from(lowest) + self.made().len().checked_sub(1)?;
        Some(lowest..=highest.min(127) as u8)
    }

    /// All tables: those of the keys in their order, or this one.
    pub fn tables(&self) -> &[ModeTable] {
        if self.made().is_empty() { std::slice::from_ref(self) } else { self.made() }
    }

    /// Index in [`ModeTable::tables`] for a note of this frequency in Hz: the table of the nearest key. Real-time safe.
    pub fn place(&self, frequency: f64) -> usize {
        match self.by_key.as_deref() {
            Some(ByKey { lowest, .. }) if self.made().len() > 1 => {
                let key = round(69.0 + 12.0 * log2(frequency / 440.0)) - f64::from(*lowest);
                // The cast saturates: negative numbers and NaN become 0.
                (key as usize).min(self.made().len() - 1)
            }
            _ => 0,
        }
    }

    /// One of [`ModeTable::tables`]. Real-time safe.
    pub fn at(&self, place: usize) -> &ModeTable {
        self.made().get(place).unwrap_or(self)
    }

    fn made(&self) -> &[ModeTable] {
        self.by_key.as_deref().and_then(|by_key| by_key.made.get()).map_or(&[], Vec::as_slice)
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

    #[test]
    fn a_note_gets_the_table_of_the_nearest_key() {
        let table = |key: u8| ModeTable::new(&[Mode { ratio: f32::from(key), ..Mode::UNIT }]);
        let modes = table(60).with_keys(60, move || (60..=62).map(table).collect());
        let ratio = |frequency| modes.at(modes.place(frequency)).as_slice()[0].ratio;
        assert_eq!((modes.keys(), modes.place(293.66)), (None, 0), "not made yet");
        modes.clone().make_tables();
        assert_eq!((modes.keys(), modes.tables().len()), (Some(60..=62), 3), "clones share them");
        for (frequency, key) in [(1.0, 60.0), (269.0, 60.0), (270.0, 61.0), (293.66, 62.0), (5000.0, 62.0)] {
            assert_eq!(ratio(frequency), key, "{frequency} Hz");
        }
        assert_eq!([f64::NAN, 0.0, f64::INFINITY].map(ratio), [60.0, 60.0, 62.0]);
        assert_eq!((table(7).place(100.0), table(7).at(3), table(7).tables()), (0, &table(7), &[table(7)][..]));
    }

    #[test]
    fn tables_that_do_not_fit_are_left_out() {
        let modes = ModeTable::new(&[Mode::UNIT; 2]).with_keys(60, || vec![ModeTable::new(&[Mode::UNIT; 3])]);
        modes.make_tables();
        assert_eq!(modes.tables(), &[modes.clone()][..]);
        assert_eq!((modes.phase(1), modes.clone().with_phases(&[0.0, 1.0]).phase(1)), (0.0, 1.0));
    }
}
