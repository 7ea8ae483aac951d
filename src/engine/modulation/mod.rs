//! Modulation: offsets that the host sets for the instrument or for single notes, and the routes of the sound.
//!
//! `note` holds the host's offsets for one note. `bus` holds the routes; each is a `link` to a `destination`. `lfo` and
//! `envelope` are the two kinds of source that change with time; `moving` holds those of one voice. `settings` holds
//! the parameter values that sources and routes use. `modulators` combines them for one voice: at each control tick it
//! reads the sources and computes the destinations' values.
//!
//! At every control tick, each voice with routes reads its sources as they will be at the next tick, adds `amount ·
//! source` of each route to its destination in knob travel, and passes the values on to pitch, damping and gain. Routes
//! that modulate amounts or macros are evaluated first; the others keep the order of their places. Parameters that only
//! a strike uses are modulated at the strike. A voice keeps the routes that it was started with, and follows the
//! settings of the instrument only as long as the instrument has the voice's patch.
//!
//! - Routes to the effects behind the voices are evaluated once for all notes (`behind`).
//! - Values that all voices share are computed once per tick. A shared oscillator is copied into each voice that
//!   follows it, so that a voice that outlives its patch can continue alone.
//! - Oscillators and envelopes store their present and their next state, so that a tick without events computes nothing
//!   twice.
//! - A destination is computed again only if a source of one of its routes, an amount or its base value has changed
//!   since the last tick. A debug build compares every tick with a full computation.
//! - Sines and powers of two are short series here, accurate to 5e−6 and 3e−7: with those of `libm`, sixteen routes
//!   cost three times as much (measured once).
//!
//! The wheel, pressure, brightness, velocity and the key have effects beyond their plain meaning only through routes. A
//! new patch has three (`Routes::INITIAL`). `routed` and `moving` in `cargo bench --bench synth` measure the cost: sixteen routes, three
//! oscillators and two envelopes on each of 16 voices of 64 modes, all moving, play at 0.82 to 0.86 of the speed of the
//! same voices without them (AVX2 and AVX-512). Tests: `tests/engine/modulation.rs` has every source and every kind of
//! destination; `tests/levels/`, `tests/engine/blocks.rs` and `tests/engine/storm/` use random routes.

mod behind;
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

pub(crate) use behind::Behind;
pub(crate) use bus::Bus;
#[cfg(feature = "fit")]
pub(crate) use lfo::Lfo;
pub(crate) use modulators::{Modulators, Positions, Struck};
pub(crate) use note::{NoteModulation, modulated};
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
