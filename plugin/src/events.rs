//! Converts the wrapper's note events to the engine's events.
//!
//! Events are passed on one by one at their frames. The engine's bits do not depend on how frames are divided, so the
//! shell needs no list of events that could overflow.

use nice_plug::prelude::{NoteEvent, PluginApi};
use nice_plug_core::midi::{Channel, Key, VoiceID};
use sprung::engine::midi::parse_message;
use sprung::engine::{EventKind, Expression, NoteId, Notes};
use sprung::params::PARAMS;

/// The engine's event, and its channel. `None` for events that the instrument does not use, and for a note-on without a
/// key. Real-time safe.
pub(crate) fn translate(event: &NoteEvent<()>, api: PluginApi) -> Option<(u8, EventKind)> {
    // Through VST3, the wrapper exchanges these two expressions.
    let (swell, brightness) = match api {
        PluginApi::Vst3 => (Expression::Brightness, Expression::Swell),
        PluginApi::Clap | PluginApi::Standalone => (Expression::Swell, Expression::Brightness),
    };
    Some(match *event {
        NoteEvent::NoteOn { voice_id, channel, key, velocity, .. } => {
            let id = voice_id.id().and_then(NoteId::new);
            let kind = EventKind::NoteOn { key: key.number()?, detune: 0.0, velocity, id };
            (channel.number().unwrap_or(0), kind)
        }
        NoteEvent::NoteOff { voice_id, channel, key, velocity, .. } => {
            (0, EventKind::Release { notes: notes(voice_id, channel, key), velocity })
        }
        NoteEvent::Choke { voice_id, channel, key, .. } => {
            (0, EventKind::Silence { notes: notes(voice_id, channel, key) })
        }
        NoteEvent::PolyPressure { voice_id, channel, key, pressure, .. } => {
            express(notes(voice_id, channel, key), Expression::Pressure, pressure)
        }
        NoteEvent::PolyVolume { voice_id, channel, key, gain, .. } => {
            express(notes(voice_id, channel, key), Expression::Volume, gain)
        }
        NoteEvent::PolyPan { voice_id, channel, key, pan, .. } => {
            express(notes(voice_id, channel, key), Expression::Pan, pan)
        }
        NoteEvent::PolyTuning { voice_id, channel, key, tuning, .. } => {
            express(notes(voice_id, channel, key), Expression::Tuning, tuning)
        }
        NoteEvent::PolyVibrato { voice_id, channel, key, vibrato, .. } => {
            express(notes(voice_id, channel, key), Expression::Vibrato, vibrato)
        }
        NoteEvent::PolyExpression { voice_id, channel, key, expression, .. } => {
            express(notes(voice_id, channel, key), swell, expression)
        }
        NoteEvent::PolyBrightness { voice_id, channel, key, brightness: value, .. } => {
            express(notes(voice_id, channel, key), brightness, value)
        }
        NoteEvent::PolyModulation { voice_id, poly_modulation_id, normalized_offset, .. } => {
            let param = PARAMS.get(poly_modulation_id as usize)?.param;
            let kind = match NoteId::new(voice_id) {
                id @ Some(_) => EventKind::Modulate { id, param, offset: normalized_offset },
                None => {
                    EventKind::ModulateNotes { notes: notes_of_number(voice_id)?, param, offset: normalized_offset }
                }
            };
            (0, kind)
        }
        NoteEvent::MidiChannelPressure { channel, pressure, .. } => (channel, EventKind::ChannelPressure(pressure)),
        NoteEvent::MidiPitchBend { channel, value, .. } => (channel, bend(value)),
        NoteEvent::MidiCC { channel, cc, value, .. } => (channel, EventKind::Control { controller: cc, value }),
        _ => return None,
    })
}

/// The notes that an event selects; a field that is not given matches any note. The wrapper's own fallback for a
/// missing id is not used, because it also ignores ids that are given.
fn notes(id: VoiceID, channel: Channel, key: Key) -> Notes {
    Notes { id: id.id().and_then(NoteId::new), channel: channel.number(), key: key.number() }
}

/// Keys and channels as hosts count them, and one more of each for all of them.
const KEYS: i32 = 129;
const CHANNELS: i32 = 17;

/// A number by which the notes of a key and a channel pass the wrapper as if it were a note's id. Hosts' ids are not below
/// −1. None if both fields match any note.
pub(crate) fn number_of_notes(channel: i16, key: i16) -> Option<i32> {
    let place = |number: i16, any: i32| if (0..any).contains(&number.into()) { number.into() } else { any };
    let (channel, key) = (place(channel, CHANNELS - 1), place(key, KEYS - 1));
    ((channel, key) != (CHANNELS - 1, KEYS - 1)).then_some(-2 - channel * KEYS - key)
}

/// The notes with a number of [`number_of_notes`]; none for any other number. Real-time safe.
fn notes_of_number(number: i32) -> Option<Notes> {
    let place = (-2_i32).checked_sub(number).filter(|place| (0..CHANNELS * KEYS - 1).contains(place))?;
    let given = |place: i32, any: i32| (place < any).then_some(place as u8);
    Some(Notes { id: None, channel: given(place / KEYS, CHANNELS - 1), key: given(place % KEYS, KEYS - 1) })
}

fn express(notes: Notes, expression: Expression, value: f32) -> (u8, EventKind) {
    (0, EventKind::Express { notes, expression, value })
}

/// Converts a pitch wheel's position 0–1 to an event. If it was made from a 14-bit value, that value is used, so that
/// the result is the same as from a MIDI file.
fn bend(value: f32) -> EventKind {
    let steps = value * 16_383.0;
    let whole = steps.round();
    if (steps - whole).abs() < 0.01 && (0.0..=16_383.0).contains(&whole) {
        let whole = whole as u16;
        if let Some((_, kind)) = parse_message(&[0xE0, (whole & 127) as u8, (whole >> 7) as u8]) {
            return kind;
        }
    }
    EventKind::PitchBend(value * 2.0 - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;

    const ID: VoiceID = VoiceID::ID(7);
    const CHANNEL: Channel = Channel::Number(3);
    const KEY: Key = Key::Number(60);
    fn one() -> Notes {
        Notes { id: NoteId::new(7), channel: Some(3), key: Some(60) }
    }

    #[test]
    fn notes_are_translated() {
        let off = |voice_id, channel, key| NoteEvent::NoteOff { timing: 0, voice_id, channel, key, velocity: 0.5 };
        let release = |notes| Some((0, EventKind::Release { notes, velocity: 0.5 }));
        let on = |voice_id, channel, key| NoteEvent::NoteOn { timing: 0, voice_id, channel, key, velocity: 0.5 };
        let strike = |channel, id| {
            Some((channel, EventKind::NoteOn { key: 60, detune: 0.0, velocity: 0.5, id: NoteId::new(id) }))
        };
        let choke = NoteEvent::Choke { timing: 0, voice_id: ID, channel: CHANNEL, key: KEY };
        for (event, expected) in [
            (on(ID, CHANNEL, KEY), strike(3, 7)),
            (on(VoiceID::Wildcard, Channel::Wildcard, KEY), strike(0, -1)),
            (on(ID, CHANNEL, Key::Wildcard), None),
            (off(ID, CHANNEL, KEY), release(one())),
            (off(VoiceID::Wildcard, CHANNEL, KEY), release(Notes { id: None, ..one() })),
            // Sent by VST3 hosts without note ids.
            (off(VoiceID::ID(-1), CHANNEL, KEY), release(Notes { id: None, ..one() })),
            (off(VoiceID::Wildcard, Channel::Wildcard, Key::Wildcard), release(Notes::default())),
            (choke, Some((0, EventKind::Silence { notes: one() }))),
        ] {
            assert_eq!(translate(&event, PluginApi::Clap), expected, "{event:?}");
        }
    }

    #[test]
    fn expressions_are_translated() {
        let (timing, voice_id, channel, key) = (0, ID, CHANNEL, KEY);
        let says = |expression| Some((0, EventKind::Express { notes: one(), expression, value: 0.25 }));
        for (event, in_clap, in_vst3) in [
            (
                NoteEvent::PolyPressure { timing, voice_id, channel, key, pressure: 0.25 },
                Expression::Pressure,
                Expression::Pressure,
            ),
            (
                NoteEvent::PolyVolume { timing, voice_id, channel, key, gain: 0.25 },
                Expression::Volume,
                Expression::Volume,
            ),
            (NoteEvent::PolyPan { timing, voice_id, channel, key, pan: 0.25 }, Expression::Pan, Expression::Pan),
            (
                NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning: 0.25 },
                Expression::Tuning,
                Expression::Tuning,
            ),
            (
                NoteEvent::PolyVibrato { timing, voice_id, channel, key, vibrato: 0.25 },
                Expression::Vibrato,
                Expression::Vibrato,
            ),
            (
                NoteEvent::PolyExpression { timing, voice_id, channel, key, expression: 0.25 },
                Expression::Swell,
                Expression::Brightness,
            ),
            (
                NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness: 0.25 },
                Expression::Brightness,
                Expression::Swell,
            ),
        ] {
            assert_eq!(translate(&event, PluginApi::Clap), says(in_clap));
            assert_eq!(translate(&event, PluginApi::Vst3), says(in_vst3));
        }
        let modulation = |poly_modulation_id| NoteEvent::PolyModulation {
            timing,
            voice_id: 7,
            poly_modulation_id,
            normalized_offset: 0.25,
        };
        let kind = EventKind::Modulate { id: NoteId::new(7), param: Param::Decay, offset: 0.25 };
        assert_eq!(translate(&modulation(Param::Decay as u32), PluginApi::Clap), Some((0, kind)));
        assert_eq!(translate(&modulation(9999), PluginApi::Clap), None);
    }

    #[test]
    fn notes_of_a_key_or_a_channel_pass_by_a_number() {
        let mut numbers = std::collections::BTreeSet::new();
        for channel in -1..17 {
            for key in -1..129 {
                let given = |number: i16, most: i16| (0..most).contains(&number).then_some(number as u8);
                let notes = Notes { id: None, channel: given(channel, 16), key: given(key, 128) };
                let number = number_of_notes(channel, key);
                assert_eq!(number.and_then(notes_of_number), Some(notes).filter(|notes| *notes != Notes::default()));
                assert!(number.is_none_or(|number| number < -1));
                numbers.extend(number);
            }
        }
        assert_eq!(numbers.len(), 17 * 129 - 1);
        let least = *numbers.first().unwrap();
        for none in [-1, 0, 7, least - 1, least - 2, i32::MIN, i32::MAX] {
            assert_eq!(notes_of_number(none), None, "{none}");
        }
        let modulation = NoteEvent::PolyModulation {
            timing: 0,
            voice_id: number_of_notes(3, 60).unwrap(),
            poly_modulation_id: Param::Decay as u32,
            normalized_offset: 0.25,
        };
        let kind = EventKind::ModulateNotes { notes: Notes::on(3, 60), param: Param::Decay, offset: 0.25 };
        assert_eq!(translate(&modulation, PluginApi::Clap), Some((0, kind)));
    }

    #[test]
    fn channels_are_translated_as_midi_files_are() {
        for (event, bytes) in [
            (NoteEvent::MidiCC { timing: 0, channel: 3, cc: 64, value: 100.0 / 127.0 }, &[0xB3, 64, 100][..]),
            (NoteEvent::MidiChannelPressure { timing: 0, channel: 3, pressure: 9.0 / 127.0 }, &[0xD3, 9]),
        ] {
            assert_eq!(translate(&event, PluginApi::Clap), parse_message(bytes));
        }
        for steps in 0..16_384u16 {
            let file = parse_message(&[0xE3, (steps & 127) as u8, (steps >> 7) as u8]);
            let event = NoteEvent::MidiPitchBend { timing: 0, channel: 3, value: f32::from(steps) / 16_383.0 };
            assert_eq!(translate(&event, PluginApi::Clap), file, "{steps}");
        }
        // A host whose pitch wheel is not limited to 14 bits.
        for (value, expected) in [(0.5, 0.0), (0.250_01, -0.499_98), (f32::NAN, f32::NAN)] {
            let EventKind::PitchBend(bend) = bend(value) else { panic!("a bend is a bend") };
            assert!((bend - expected).abs() < 1e-6 || (bend.is_nan() && expected.is_nan()), "{bend}");
        }
    }
}
