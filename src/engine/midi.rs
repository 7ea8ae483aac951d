//! MIDI 1.0: channel messages as events, and the numbers of controllers.

use super::EventKind;

/// Numbers of the controllers that the engine responds to.
pub(crate) mod controller {
    /// Modulation wheel.
    pub(crate) const WHEEL: u8 = 1;
    /// Breath.
    pub(crate) const BREATH: u8 = 2;
    /// Portamento time.
    pub(crate) const PORTAMENTO_TIME: u8 = 5;
    /// Data entry for the selected registered parameter, most significant seven bits.
    pub(crate) const DATA: u8 = 6;
    /// Channel volume.
    pub(crate) const VOLUME: u8 = 7;
    /// Balance.
    pub(crate) const BALANCE: u8 = 8;
    /// Pan.
    pub(crate) const PAN: u8 = 10;
    /// Expression.
    pub(crate) const EXPRESSION: u8 = 11;
    /// Data entry, least significant seven bits.
    pub(crate) const DATA_FINE: u8 = 38;
    /// Sustain pedal.
    pub(crate) const SUSTAIN: u8 = 64;
    /// Portamento on or off.
    pub(crate) const PORTAMENTO: u8 = 65;
    /// Sostenuto pedal.
    pub(crate) const SOSTENUTO: u8 = 66;
    /// Soft pedal.
    pub(crate) const SOFT: u8 = 67;
    /// Legato footswitch: one voice at a time, which moves from key to key without a strike.
    pub(crate) const LEGATO: u8 = 68;
    /// Brightness.
    pub(crate) const BRIGHTNESS: u8 = 74;
    /// The key that the next note glides from.
    pub(crate) const PORTAMENTO_CONTROL: u8 = 84;
    /// How much of a channel is sent to the space that a song's channels share.
    pub(crate) const REVERB_SEND: u8 = 91;
    /// Raises the selected registered parameter by a step.
    pub(crate) const INCREMENT: u8 = 96;
    /// Lowers it by a step.
    pub(crate) const DECREMENT: u8 = 97;
    /// Selects a non-registered parameter, least significant seven bits.
    pub(crate) const NRPN_FINE: u8 = 98;
    /// Selects a non-registered parameter, most significant seven bits.
    pub(crate) const NRPN: u8 = 99;
    /// Selects a registered parameter, least significant seven bits.
    pub(crate) const RPN_FINE: u8 = 100;
    /// Selects a registered parameter, most significant seven bits.
    pub(crate) const RPN: u8 = 101;
    /// All sound off.
    pub(crate) const ALL_SOUND_OFF: u8 = 120;
    /// Reset all controllers.
    pub(crate) const RESET: u8 = 121;
    /// All notes off. The mode messages 124–127 do the same.
    pub(crate) const ALL_NOTES_OFF: u8 = 123;
    /// Mono mode: one voice at a time.
    pub(crate) const MONO: u8 = 126;
    /// Poly mode.
    pub(crate) const POLY: u8 = 127;

    /// Whether a controller sets the gains of a channel.
    pub(crate) const fn is_gain(controller: u8) -> bool {
        matches!(controller, VOLUME | EXPRESSION | PAN | BALANCE)
    }
}

/// The value of [`controller::REVERB_SEND`] at the start and after a system reset (General MIDI 2, 1999).
pub(crate) const DEFAULT_REVERB_SEND: f32 = 40.0 / 127.0;

/// Parses one complete MIDI message, as a port delivers it. Returns its channel and event; none if it is not a channel
/// message. Real-time safe.
pub fn parse_message(bytes: &[u8]) -> Option<(u8, EventKind)> {
    let (&status, data) = bytes.split_first()?;
    let data = |index: usize| data.get(index).copied().filter(|byte| *byte < 128);
    let unit = |byte: u8| f32::from(byte) / 127.0;
    let first = data(0)?;
    let kind = match status >> 4 {
        0x8 => EventKind::NoteOff { key: first, velocity: unit(data(1)?), id: None },
        0x9 => match data(1)? {
            // A note on with velocity 0 is a note off without a velocity of its own.
            0 => EventKind::NoteOff { key: first, velocity: 0.5, id: None },
            velocity => EventKind::NoteOn { key: first, detune: 0.0, velocity: unit(velocity), id: None },
        },
        0xA => EventKind::PolyPressure { key: first, pressure: unit(data(1)?) },
        0xB => EventKind::Control { controller: first, value: unit(data(1)?) },
        0xC => EventKind::Program(first),
        0xD => EventKind::ChannelPressure(unit(first)),
        0xE => EventKind::PitchBend(bend_position(i16::from(data(1)?) << 7 | i16::from(first))),
        _ => return None,
    };
    Some((status & 15, kind))
}

/// Converts a controller's value 0–1 to MIDI's 0–127.
pub(crate) fn seven_bits(value: f32) -> u8 {
    (value * 127.0 + 0.5) as u8
}

/// Converts 0…16383 to −1…1. Both ends and the centre are exact, so the two halves have slightly different step sizes.
fn bend_position(value: i16) -> f32 {
    let steps = f32::from(value - 8192);
    if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_read_one_by_one() {
        use EventKind as E;
        for (bytes, expected) in [
            (&[0x91, 60, 127][..], Some((1, E::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: None }))),
            (&[0x9f, 60, 0], Some((15, E::NoteOff { key: 60, velocity: 0.5, id: None }))),
            (&[0x80, 60, 127], Some((0, E::NoteOff { key: 60, velocity: 1.0, id: None }))),
            (&[0xa3, 1, 127], Some((3, E::PolyPressure { key: 1, pressure: 1.0 }))),
            (&[0xb3, 64, 127], Some((3, E::Control { controller: 64, value: 1.0 }))),
            (&[0xc2, 7], Some((2, E::Program(7)))),
            (&[0xd2, 0], Some((2, E::ChannelPressure(0.0)))),
            (&[0xe0, 0, 0], Some((0, E::PitchBend(-1.0)))),
            (&[0xe0, 0, 64], Some((0, E::PitchBend(0.0)))),
            (&[0xe0, 127, 127], Some((0, E::PitchBend(1.0)))),
            (&[0xf8], None),
            (&[0xf0, 1, 2, 0xf7], None),
            (&[0x90, 60], None),
            (&[0x90, 128, 1], None),
            (&[60, 60], None),
            (&[], None),
        ] {
            assert_eq!(parse_message(bytes), expected, "{bytes:?}");
        }
    }
}
