//! Bank selects and program changes as General MIDI, General MIDI 2 and XG define them: melodic sounds and drum kits.
//!
//! General MIDI has 128 melodic programs, and drums on channel 10 (MIDI Manufacturers Association, General MIDI System
//! Level 1, 1991). Level 2 (1999) selects drums on any channel by bank 120 and melodic sounds by 121, and Yamaha's XG drums
//! by banks 126 and 127. Other banks hold variations of the same programs; here they play the plain program.

use super::event::EventKind;
use super::midi::seven_bits;
use super::note::nearest_channel;

/// Number of melodic programs. Drum kit `n` is program `MELODIC + n` in a list that holds both.
pub(crate) const MELODIC: u8 = 128;

/// The channel of drums, from 0.
pub(crate) const DRUM_CHANNEL: u8 = 9;

/// Controller number of the bank's more significant byte.
pub(crate) const BANK_SELECT: u8 = 0;

/// Banks of drums: those of General MIDI 2 and of XG.
pub(crate) const DRUM_BANK: u8 = 120;
const XG_DRUM_BANKS: [u8; 2] = [126, 127];

/// The bank of General MIDI 2 that is melodic on channel 10 too.
pub(crate) const MELODIC_BANK: u8 = 121;

/// The bank that each channel has selected. Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Banks([u8; 16]);

impl Banks {
    /// Returns the event. A program change gets the number of its program in a list of melodic sounds and drum kits.
    pub(crate) fn resolve(&mut self, channel: u8, kind: EventKind) -> EventKind {
        let channel = nearest_channel(channel);
        let bank = &mut self.0[usize::from(channel)];
        match kind {
            EventKind::Control { controller: BANK_SELECT, value } => *bank = seven_bits(value),
            EventKind::Program(number) if number < MELODIC && Self::has_drums(channel, *bank) => {
                return EventKind::Program(MELODIC + number);
            }
            _ => {}
        }
        kind
    }

    fn has_drums(channel: u8, bank: u8) -> bool {
        bank == DRUM_BANK || XG_DRUM_BANKS.contains(&bank) || (channel == DRUM_CHANNEL && bank != MELODIC_BANK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drums_are_on_channel_10_and_in_their_banks() {
        let mut banks = Banks::default();
        let mut program = |channel, bank: Option<u8>| {
            if let Some(bank) = bank {
                let value = f32::from(bank) / 127.0;
                let control = EventKind::Control { controller: BANK_SELECT, value };
                assert_eq!(banks.resolve(channel, control), control);
            }
            let EventKind::Program(number) = banks.resolve(channel, EventKind::Program(5)) else { panic!("a program") };
            number
        };
        assert_eq!(program(0, None), 5);
        assert_eq!(program(DRUM_CHANNEL, None), MELODIC + 5);
        assert_eq!(program(DRUM_CHANNEL, Some(8)), MELODIC + 5, "a variation");
        assert_eq!(program(DRUM_CHANNEL, Some(121)), 5);
        for bank in [120, 126, 127] {
            assert_eq!(program(3, Some(bank)), MELODIC + 5);
        }
        assert_eq!(program(3, Some(0)), 5);
    }
}
