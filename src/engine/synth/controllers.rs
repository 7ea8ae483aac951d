//! How a synth responds to MIDI controllers and MPE configuration messages.

use super::Synth;
use crate::engine::channel::Channel;
use crate::engine::midi::controller;

impl Synth {
    /// Handles a controller at a value 0–1.
    pub(super) fn control(&mut self, channel: u8, number: u8, value: f32) {
        for reached in self.channels.reach(channel) {
            self.control_voices(reached, number, value);
        }
        let members = self.channels.control(channel, number, value);
        // A ramp would let the attack of a note at the same frame through at the gain from before.
        if controller::is_gain(number) && !self.sounds_on(channel) {
            self.channels.land(channel);
        }
        if number == controller::BRIGHTNESS {
            self.channels.reach(channel).for_each(|reached| self.brighten(reached));
        }
        if matches!(number, controller::LEGATO | controller::MONO | controller::POLY | controller::RESET) {
            self.configure_manager();
        }
        if let Some(members) = members {
            self.configure_zone(channel, members);
        }
    }

    /// Whether a note sounds that a message on `channel` affects.
    fn sounds_on(&mut self, channel: u8) -> bool {
        let Self { manager, channels, .. } = self;
        manager.active().any(|(note, _)| channels.reach(channel).any(|reached| reached == note.channel))
    }

    /// Handles pedals and mode messages, which concern the notes of a channel.
    fn control_voices(&mut self, channel: u8, number: u8, value: f32) {
        match number {
            controller::SUSTAIN => self.manager.sustain(channel, value),
            controller::SOSTENUTO => self.manager.sostenuto(channel, value >= 0.5),
            controller::ALL_SOUND_OFF => self.manager.all_sound_off(channel),
            // The mode messages 124–127 imply all notes off.
            controller::ALL_NOTES_OFF..=127 => self.manager.all_notes_off(channel),
            controller::RESET => {
                self.lift_pedals(channel);
                let on_channel = self.manager.active().filter(|(note, _)| note.channel == channel);
                on_channel.for_each(|(_, voice)| voice.relax());
            }
            _ => {}
        }
    }

    fn lift_pedals(&mut self, channel: u8) {
        self.manager.sustain(channel, 0.0);
        self.manager.sostenuto(channel, false);
    }

    /// Passes a channel's brightness on to its notes.
    fn brighten(&mut self, channel: u8) {
        let brightness = self.channels.brightness(channel);
        self.manager.brighten(channel, brightness);
        for (note, voice) in self.manager.active().filter(|(note, _)| note.channel == channel) {
            voice.shade(self.instruments.of_note(note), brightness);
        }
    }

    /// Handles an MPE configuration message: a zone with a master channel and a number of member channels.
    pub(in crate::engine) fn configure_zone(&mut self, master: u8, members: u8) {
        self.needs_control = true;
        // A channel whose master changes starts again without notes held by keys or pedals.
        for channel in self.channels.configure_zone(master, members) {
            self.manager.all_notes_off(channel);
            self.lift_pedals(channel);
        }
    }

    /// The controllers of a channel, and the number of frames until all gains have reached their targets.
    pub(in crate::engine) fn channel(&self, channel: u8) -> (Channel, u32) {
        self.channels.channel(channel)
    }

    /// Sets the controllers of a channel to those of another synth's.
    pub(in crate::engine) fn set_channel(&mut self, channel: u8, held: (Channel, u32)) {
        self.channels.set_channel(channel, held);
    }
}
