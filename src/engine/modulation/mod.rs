//! What moves parameters away from their values: the host, for the instrument and for single notes, and the routes of the sound.
//!
//! `note` has what a host moves for one note. `bus` has the routes, `lfo` and `envelope` two kinds of source, and
//! `modulators` all sources of a voice: at each control tick they are read and every destination gets its value.

mod bus;
mod envelope;
mod lfo;
mod modulators;
mod note;

pub(crate) use bus::Bus;
pub(crate) use modulators::{Modulators, Positions, Settings, SharedLfos, Struck};
pub(crate) use note::{NoteModulation, modulated, moved};

/// Quarter notes that one round takes, in the order of the choices of the parameters that set a note value; 0 for one
/// that keeps its own time.
const BEATS: [f64; 10] = [0.0, 4.0, 2.0, 1.5, 1.0, 2.0 / 3.0, 0.75, 0.5, 1.0 / 3.0, 0.25];

/// Rounds a second of what lasts the note value of a choice, at a tempo in beats per second, or has its own `rate`.
pub(crate) fn rate_at(choice: f32, rate: f64, beat_rate: f64) -> f64 {
    match BEATS.get(choice as usize) {
        Some(beats) if *beats > 0.0 => beat_rate / beats,
        _ => rate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;

    #[test]
    fn every_choice_of_a_note_value_has_its_beats() {
        for param in [Param::VibratoSync, Param::Lfo1Sync, Param::Lfo2Sync, Param::Lfo3Sync] {
            assert_eq!(BEATS.len(), param.info().choices.len());
        }
        assert_eq!(rate_at(0.0, 5.0, 2.0), 5.0);
        assert_eq!(rate_at(4.0, 5.0, 2.0), 2.0);
    }
}
