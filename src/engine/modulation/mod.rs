//! What moves parameters away from their values: the host, for the instrument and for single notes, and the routes of the sound.
//!
//! `note` has what a host moves for one note. `bus` has the routes: each is a `link` to a `destination`. `lfo` and
//! `envelope` are two kinds of source, `moving` those of them that a voice has, `settings` what they and the routes follow.
//! `modulators` has all sources of a voice: at each control tick they are read and destinations get their values.

mod bus;
mod destination;
mod envelope;
mod lfo;
mod link;
mod modulators;
mod moving;
mod note;
mod settings;

use crate::params::NoteValue;

pub(crate) use bus::Bus;
pub(crate) use modulators::{Modulators, Positions, Struck};
pub(crate) use note::{NoteModulation, modulated, moved};
pub(crate) use settings::{Settings, SharedLfos};

/// Rounds a second of what lasts a note value, at a tempo in beats per second, or has its own `rate`.
pub(crate) fn rate_at(value: NoteValue, rate: f64, beat_rate: f64) -> f64 {
    let beats = match value {
        NoteValue::Off => return rate,
        NoteValue::Whole => 4.0,
        NoteValue::Half => 2.0,
        NoteValue::DottedQuarter => 1.5,
        NoteValue::Quarter => 1.0,
        NoteValue::QuarterTriplet => 2.0 / 3.0,
        NoteValue::DottedEighth => 0.75,
        NoteValue::Eighth => 0.5,
        NoteValue::EighthTriplet => 1.0 / 3.0,
        NoteValue::Sixteenth => 0.25,
    };
    beat_rate / beats
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_value_lasts_its_beats() {
        assert_eq!(rate_at(NoteValue::Off, 5.0, 2.0), 5.0);
        assert_eq!(rate_at(NoteValue::Quarter, 5.0, 2.0), 2.0);
    }
}
