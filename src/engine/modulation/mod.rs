//! Modulation: offsets that the host sets for the instrument or for single notes, and the routes of the sound.
//!
//! `note` holds the host's offsets for one note. `bus` holds the routes; each is a `link` to a `destination`. `lfo` and
//! `envelope` are the two kinds of source that change with time; `moving` holds those of one voice. `settings` holds
//! the parameter values that sources and routes use. `modulators` combines them for one voice: at each control tick it
//! reads the sources and computes the destinations' values.

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
#[cfg(feature = "fit")]
pub(crate) use lfo::Lfo;
pub(crate) use modulators::{Modulators, Positions, Struck};
pub(crate) use note::{NoteModulation, modulated, moved};
pub(crate) use settings::{Settings, SharedLfos};

/// Rate in Hz of an oscillator whose cycle lasts a note value, at a tempo in beats per second; `rate` if
/// synchronisation is off.
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
