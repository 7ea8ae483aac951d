//! Events that end notes: key releases, pedals, mode messages, choke groups, and hosts.

use super::VoiceManager;
use super::slot::Slot;
use super::voice::Voice;
use crate::engine::note::Notes;
use crate::params::PlayMode;

impl<V: Voice> VoiceManager<V> {
    /// Releases the keys of these notes, at a velocity 0–1. In a monophonic mode the voice returns to a key that is
    /// still down.
    pub(crate) fn note_off(&mut self, context: &V::Context, notes: Notes, velocity: f32) {
        if self.mode != PlayMode::Poly && self.return_to_held(context, &notes) {
            return;
        }
        for slot in self.slots.in_use_mut().iter_mut().filter(|slot| slot.is_one_of(&notes)) {
            slot.key_down = false;
            slot.release_unless_held(self.pedals.sustain_of(slot.note.channel), velocity);
        }
    }

    /// The sustain pedal (controller 64), at a position 0–1.
    pub(crate) fn sustain(&mut self, channel: u8, position: f32) {
        self.pedals.sustain(channel, position, self.slots.in_use_mut());
    }

    /// The sostenuto pedal (controller 66): holds the notes whose keys are down when it goes down.
    pub(crate) fn sostenuto(&mut self, channel: u8, down: bool) {
        self.pedals.sostenuto(channel, down, self.slots.in_use_mut());
    }

    /// All notes off (controller 123): releases every key of the channel. Pedals still hold notes.
    pub(crate) fn all_notes_off(&mut self, channel: u8) {
        self.forget(|held| held.channel == channel);
        self.slots.on_channel(channel).for_each(|slot| slot.key_down = false);
        self.pedals.release_unheld(channel, self.slots.in_use_mut());
    }

    /// All sound off (controller 120): fades out all notes of the channel.
    pub(crate) fn all_sound_off(&mut self, channel: u8) {
        self.forget(|held| held.channel == channel);
        self.slots.on_channel(channel).filter(|slot| slot.is_sounding()).for_each(Slot::fade);
    }

    /// Fades out these notes.
    pub(crate) fn silence(&mut self, notes: Notes) {
        self.forget(|held| notes.include(held));
        self.slots.in_use_mut().iter_mut().filter(|slot| slot.is_one_of(&notes)).for_each(Slot::fade);
    }

    /// Fades out the notes of a choke group. Group 0 has no notes.
    pub(crate) fn choke(&mut self, group: u8) {
        self.slots.sounding().filter(|slot| group != 0 && slot.note.choke == group).for_each(Slot::fade);
    }
}
