//! Converts system exclusive messages to events: resets, the master's volume and balance, and drum parts of GS and XG.

use super::master::ALL_CHANNELS;
use crate::engine::EventKind;
use crate::engine::banks::{BANK_SELECT, DRUM_BANK, DRUM_CHANNEL, MELODIC_BANK};
use crate::engine::midi::controller::{BALANCE, RESET, VOLUME};

/// Bytes of reset messages, without the first byte F0 and without device numbers: General MIDI 1 and 2 on, and off
/// (Universal Non-Real Time messages), and Yamaha's XG System On.
const GENERAL_MIDI: [u8; 2] = [0x7E, 0x09];
const XG_RESET: [u8; 6] = [0x4C, 0x00, 0x00, 0x7E, 0x00, 0xF7];

/// The start of messages that set the master volume: of every device (Universal Real Time), XG and GS.
const MASTER_VOLUME: [u8; 2] = [0x04, 0x01];
const MASTER_BALANCE: [u8; 2] = [0x04, 0x02];
const XG_MASTER_VOLUME: [u8; 4] = [0x4C, 0x00, 0x00, 0x04];
const GS_MASTER_VOLUME: [u8; 3] = [0x40, 0x00, 0x04];

/// Roland's GS: the start of a message that sets data, GS reset, and the address of “use for rhythm part” (40 1x 15),
/// where `x` is 0 for channel 10 and 1 to 9 for channels 1 to 9 (Roland SC-55 manual, 1991).
const GS_SET: [u8; 2] = [0x42, 0x12];
const GS_RESET: [u8; 3] = [0x40, 0x00, 0x7F];

/// The channels that play drums, a bit each: what part modes of XG and GS have made of them so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrumParts(u16);

impl Default for DrumParts {
    fn default() -> Self {
        Self(1 << DRUM_CHANNEL)
    }
}

impl DrumParts {
    /// The events that a message is converted to, with their channels: volumes, balances and resets of [`ALL_CHANNELS`], bank
    /// selects and program changes. `message` is the message after its byte F0. All other messages give no events.
    pub(super) fn system_exclusive(&mut self, message: &[u8]) -> Vec<(u8, EventKind)> {
        match message {
            _ if is_reset(message) => {
                *self = Self::default();
                master(RESET, 0.0)
            }
            [0x7F, _, first, second, fine, coarse, 0xF7] if [*first, *second] == MASTER_VOLUME => {
                master(VOLUME, (f32::from(*coarse) * 128.0 + f32::from(*fine)) / 16_383.0)
            }
            [0x7F, _, first, second, fine, coarse, 0xF7] if [*first, *second] == MASTER_BALANCE => {
                master(BALANCE, (f32::from(*coarse) + f32::from(*fine) / 128.0) / 127.0)
            }
            [0x43, _, 0x4C, 0x08, part @ 0..=15, 0x07, mode, 0xF7] => self.set(*part, *mode > 0),
            [0x43, _, rest @ .., volume, 0xF7] if *rest == XG_MASTER_VOLUME => {
                master(VOLUME, f32::from(*volume) / 127.0)
            }
            [0x41, _, model, set, rest @ ..] if [*model, *set] == GS_SET => match rest {
                [address @ .., volume, _, 0xF7] if *address == GS_MASTER_VOLUME => {
                    master(VOLUME, f32::from(*volume) / 127.0)
                }
                [0x40, part @ 0x10..=0x1F, 0x15, map, ..] => self.set(gs_channel(part & 15), *map > 0),
                _ => Vec::new(),
            },
            _ => Vec::new(),
        }
    }

    /// Gives a channel drums or melodic sounds, at once. Yamaha's XG does so by part modes (08 nn 07: 0 is normal, others are drums),
    /// and part `nn` is channel `nn` (XG specification 1.26, 1996). A channel that has them already keeps its program.
    fn set(&mut self, channel: u8, has_drums: bool) -> Vec<(u8, EventKind)> {
        let before = self.0;
        self.0 = before & !(1 << channel) | u16::from(has_drums) << channel;
        let bank = (channel, bank(if has_drums { DRUM_BANK } else { MELODIC_BANK }));
        if self.0 == before { vec![bank] } else { vec![bank, (channel, EventKind::Program(0))] }
    }
}

/// Whether a message, after its byte F0, sets everything back: General MIDI on and off, XG System On, and GS reset.
pub(super) fn is_reset(message: &[u8]) -> bool {
    match message {
        [universal, _, id, 0x01..=0x03, ..] => [*universal, *id] == GENERAL_MIDI,
        [0x43, _, rest @ ..] => rest.starts_with(&XG_RESET),
        [0x41, _, model, set, rest @ ..] => [*model, *set] == GS_SET && rest.starts_with(&GS_RESET),
        _ => false,
    }
}

fn bank(value: u8) -> EventKind {
    EventKind::Control { controller: BANK_SELECT, value: f32::from(value) / 127.0 }
}

fn master(controller: u8, value: f32) -> Vec<(u8, EventKind)> {
    vec![(ALL_CHANNELS, EventKind::Control { controller, value: value.min(1.0) })]
}

/// The channel of a part of a GS device.
fn gs_channel(part: u8) -> u8 {
    match part {
        0 => DRUM_CHANNEL,
        1..=9 => part - 1,
        _ => part,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::banks::{Banks, MELODIC};

    #[test]
    fn a_gs_part_for_drums_plays_drums_until_a_reset() {
        let (mut banks, mut parts) = (Banks::default(), DrumParts::default());
        let mut send = |message: &[u8]| {
            let events = parts.system_exclusive(message);
            events.into_iter().map(|(channel, kind)| (channel, banks.resolve(channel, kind))).collect::<Vec<_>>()
        };
        // An address of 40 1A is channel 11, and one of 40 11 is channel 1.
        let drums = send(&[0x41, 0x10, 0x42, 0x12, 0x40, 0x1A, 0x15, 0x02, 0x0F, 0xF7]);
        assert_eq!(drums[1], (10, EventKind::Program(MELODIC)));
        assert_eq!(send(&[0x41, 0x10, 0x42, 0x12, 0x40, 0x11, 0x15, 0x01, 0x19, 0xF7])[1].0, 0);
        let off = send(&[0x41, 0x10, 0x42, 0x12, 0x40, 0x10, 0x15, 0x00, 0x1B, 0xF7]);
        assert_eq!(off[1], (DRUM_CHANNEL, EventKind::Program(0)));
        let xg = send(&[0x43, 0x10, 0x4C, 0x08, 0x03, 0x07, 0x02, 0xF7]);
        assert_eq!(xg[1], (3, EventKind::Program(MELODIC)));
        assert_eq!(send(&[0x43, 0x10, 0x4C, 0x08, 0x03, 0x07, 0x03, 0xF7]).len(), 1, "it keeps the program");
        assert_eq!(send(&[0x43, 0x10, 0x4C, 0x08, 0x03, 0x07, 0x00, 0xF7])[1], (3, EventKind::Program(0)));
        for reset in [
            &[0x7E, 0x7F, 0x09, 0x01, 0xF7][..],
            &[0x41, 0x10, 0x42, 0x12, 0x40, 0x00, 0x7F, 0x00, 0x41, 0xF7],
            &[0x43, 0x10, 0x4C, 0x00, 0x00, 0x7E, 0x00, 0xF7],
        ] {
            assert_eq!(send(reset), master(RESET, 0.0));
        }
        assert!(send(&[0x7E, 0x7F, 0x06, 0x01, 0xF7]).is_empty(), "an identity request");
        assert!(send(&[]).is_empty());
    }

    #[test]
    fn every_kind_of_master_volume_is_read() {
        for (message, value) in [
            (&[0x7F, 0x7F, 0x04, 0x01, 0x00, 0x40, 0xF7][..], 8192.0 / 16_383.0),
            (&[0x7F, 0x7F, 0x04, 0x01, 0x7F, 0x7F, 0xF7], 1.0),
            (&[0x43, 0x10, 0x4C, 0x00, 0x00, 0x04, 0x00, 0xF7], 0.0),
            (&[0x41, 0x10, 0x42, 0x12, 0x40, 0x00, 0x04, 0x7F, 0x3D, 0xF7], 1.0),
        ] {
            assert_eq!(DrumParts::default().system_exclusive(message), master(VOLUME, value));
        }
    }
}
