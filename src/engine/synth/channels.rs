//! The sixteen MIDI channels of a synth, with their zones and their gains.

use crate::engine::channel::{Channel, Wheels};
use crate::engine::midi::{controller, seven_bits};
use crate::engine::zones::{MEMBER_BEND_RANGE, Zones};

/// Controllers of all channels, and which of them MPE zones bind together. Real-time safe.
pub(super) struct Channels {
    channels: [Channel; 16],
    zones: Zones,
    /// Frames until the gains of all channels have arrived.
    gains_moving: u32,
}

impl Channels {
    /// Channels as after power-on, without zones.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { channels: [Channel::new(sample_rate); 16], zones: Zones::default(), gains_moving: 0 }
    }

    fn of(&self, channel: u8) -> &Channel {
        &self.channels[usize::from(channel)]
    }

    /// The master of the zone that a channel is a member of.
    fn master_of(&self, channel: u8) -> Option<&Channel> {
        self.zones.master_of(channel).map(|master| self.of(master))
    }

    /// What a note on a channel follows of it and of the master of its zone.
    pub(super) fn wheels(&self, channel: u8) -> Wheels<'_> {
        Wheels { channel: self.of(channel), master: self.master_of(channel) }
    }

    /// Brightness of a channel and the master of its zone, −0.5 to 0.5.
    pub(super) fn brightness(&self, channel: u8) -> f32 {
        let of_master = self.master_of(channel).map_or(0.0, |master| master.brightness);
        (self.of(channel).brightness + of_master).clamp(-0.5, 0.5)
    }

    /// Whether the soft pedal of a channel or of the master of its zone is down.
    pub(super) fn is_soft(&self, channel: u8) -> bool {
        self.of(channel).soft || self.master_of(channel).is_some_and(|master| master.soft)
    }

    /// The channels that a message on `channel` is for: itself, and its members if it is a master.
    pub(super) fn reach(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        self.zones.reach(channel)
    }

    /// Moves the pitch wheel of a channel, −1 to 1.
    pub(super) fn bend(&mut self, channel: u8, bend: f32) {
        self.channels[usize::from(channel)].bend = bend;
    }

    /// Sets the pressure on a channel, 0–1.
    pub(super) fn press(&mut self, channel: u8, pressure: f32) {
        self.channels[usize::from(channel)].pressure = pressure;
    }

    /// Takes in a controller at a value 0–1. Gives the number of members if it is a message to configure the zone of
    /// this channel.
    pub(super) fn control(&mut self, channel: u8, number: u8, value: f32) -> Option<u8> {
        for reached in self.zones.reach(channel) {
            // Wheels and pressure of a master act beside those of its members; its reset is for them as well.
            if reached == channel || number == controller::RESET {
                self.channels[usize::from(reached)].control(number, value);
            }
        }
        let sender = *self.of(channel);
        self.gains_moving = sender.slope_frames();
        if matches!(number, controller::DATA | controller::DATA_FINE) && sender.awaits_bend_range() {
            for sibling in self.zones.siblings(channel) {
                self.channels[usize::from(sibling)].bend_range = sender.bend_range;
            }
        }
        (number == controller::DATA && sender.awaits_zone()).then(|| seven_bits(value))
    }

    /// Makes `members` channels the zone of a master. Gives the channels that have another master than before.
    pub(super) fn configure_zone(&mut self, master: u8, members: u8) -> impl Iterator<Item = u8> + use<> {
        let before = self.zones;
        self.zones.configure(master, members);
        let after = self.zones;
        let moved = (0..16).filter(move |channel| before.master_of(*channel) != after.master_of(*channel));
        for channel in moved.clone() {
            let is_member = after.master_of(channel).is_some();
            self.channels[usize::from(channel)].bend_range = is_member.then_some(MEMBER_BEND_RANGE);
        }
        moved
    }

    /// What a channel holds, and for how many frames gains still slide.
    pub(super) fn channel(&self, channel: u8) -> (Channel, u32) {
        (*self.of(channel), self.gains_moving)
    }

    /// Takes over what a channel of another synth held.
    pub(super) fn set_channel(&mut self, channel: u8, (held, gains_moving): (Channel, u32)) {
        self.channels[usize::from(channel)] = held;
        self.gains_moving = self.gains_moving.max(gains_moving);
    }

    /// Lets `frames` frames pass.
    pub(super) fn advance(&mut self, frames: u32) {
        if self.gains_moving > 0 {
            self.channels.iter_mut().for_each(|channel| channel.advance(frames));
            self.gains_moving = self.gains_moving.saturating_sub(frames);
        }
    }
}
