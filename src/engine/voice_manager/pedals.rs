//! The pedals that hold notes: sustain and sostenuto, for each channel.

use super::slot::{Slot, State};
use super::voice::Voice;

/// Release velocity of notes that end because of a pedal or a mode message.
const MIDDLE_VELOCITY: f32 = 0.5;

/// Which pedals are down. Real-time safe.
pub(super) struct Pedals {
    /// Positions, 0–1.
    sustain: [f32; 16],
    sostenuto: [bool; 16],
}

impl Pedals {
    /// No pedal is down.
    pub(super) const UP: Self = Self { sustain: [0.0; 16], sostenuto: [false; 16] };

    /// The position of the sustain pedal of a channel, 0–1.
    pub(super) fn sustain_of(&self, channel: u8) -> f32 {
        self.sustain[usize::from(channel)]
    }

    /// Sets the position of the sustain pedal, 0–1. When it goes up, notes whose keys are up are released.
    pub(super) fn sustain<V: Voice>(&mut self, channel: u8, position: f32, slots: &mut [Slot<V>]) {
        self.sustain[usize::from(channel)] = position;
        self.release_unheld(channel, slots);
    }

    /// Sets the sostenuto pedal: when it goes down, it holds the notes whose keys are down.
    pub(super) fn sostenuto<V: Voice>(&mut self, channel: u8, down: bool, slots: &mut [Slot<V>]) {
        // A pedal that sends positions repeats the message. Only the first one on the way down may hold notes.
        if std::mem::replace(&mut self.sostenuto[usize::from(channel)], down) == down {
            return;
        }
        for slot in slots.iter_mut().filter(|slot| slot.note.channel == channel) {
            slot.sostenuto = down && slot.state == State::Held && slot.key_down;
        }
        self.release_unheld(channel, slots);
    }

    /// Releases the notes of a channel whose keys are up and that no pedal holds.
    pub(super) fn release_unheld<V: Voice>(&self, channel: u8, slots: &mut [Slot<V>]) {
        for slot in slots.iter_mut().filter(|slot| slot.note.channel == channel && !slot.key_down) {
            slot.release_unless_held(self.sustain_of(channel), MIDDLE_VELOCITY);
        }
    }
}
