//! The sixteen MIDI channels of a synth, with their zones and their gains.

use crate::engine::channel::{Channel, Wheels};
use crate::engine::midi::{controller, seven_bits};
use crate::engine::portamento::NoteGlide;
use crate::engine::zones::{MEMBER_BEND_RANGE, Zones};
use crate::params::PlayMode;

/// The controllers of all channels, and the MPE zones. Real-time safe.
#[derive(Clone)]
pub(super) struct Channels {
    channels: [Channel; 16],
    zones: Zones,
    /// Frames until the gains of all channels have reached their targets.
    gains_moving: u32,
    /// The play mode that the last message of mode has chosen; none for the patch's.
    mode: Option<PlayMode>,
}

impl Channels {
    /// All channels in their power-on state, without zones.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { channels: [Channel::new(sample_rate); 16], zones: Zones::default(), gains_moving: 0, mode: None }
    }

    fn of(&self, channel: u8) -> &Channel {
        &self.channels[usize::from(channel)]
    }

    /// The master channel of the zone that a channel is a member of.
    fn master_of(&self, channel: u8) -> Option<&Channel> {
        self.zones.master_of(channel).map(|master| self.of(master))
    }

    /// Whether a channel is a member of an MPE zone.
    pub(super) fn is_member(&self, channel: u8) -> bool {
        self.zones.master_of(channel).is_some()
    }

    /// The controllers that a note on a channel follows: those of the channel, and those of its zone's master.
    pub(super) fn wheels(&self, channel: u8) -> Wheels<'_> {
        Wheels { channel: self.of(channel), master: self.master_of(channel) }
    }

    /// Brightness of a channel plus that of its zone's master, −0.5 to 0.5.
    pub(super) fn brightness(&self, channel: u8) -> f32 {
        let of_master = self.master_of(channel).map_or(0.0, |master| master.brightness);
        (self.of(channel).brightness + of_master).clamp(-0.5, 0.5)
    }

    /// Whether the soft pedal of a channel or of its zone's master is down.
    pub(super) fn is_soft(&self, channel: u8) -> bool {
        self.of(channel).soft || self.master_of(channel).is_some_and(|master| master.soft)
    }

    /// The channels that a message on `channel` affects: itself, and the members of its zone if it is a master.
    pub(super) fn reach(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        self.zones.reach(channel)
    }

    /// The glide of a note that starts now on a channel, if it is not its patch's: the channel's own, or that of its zone's master.
    pub(super) fn glide(&mut self, channel: u8) -> Option<NoteGlide> {
        let own = self.channels[usize::from(channel)].glide();
        let master = self.zones.master_of(channel);
        own.or_else(|| self.channels[usize::from(master?)].glide())
    }

    /// The play mode of notes whose patch has `own`. A patch that moves without strikes does so in mono mode too.
    pub(super) fn mode(&self, own: PlayMode) -> PlayMode {
        match self.mode {
            Some(PlayMode::Mono) if own == PlayMode::Legato => own,
            chosen => chosen.unwrap_or(own),
        }
    }

    /// Moves the pitch wheel of a channel, −1 to 1.
    pub(super) fn bend(&mut self, channel: u8, bend: f32) {
        self.channels[usize::from(channel)].bend = bend;
    }

    /// Sets the pressure on a channel, 0–1.
    pub(super) fn press(&mut self, channel: u8, pressure: f32) {
        self.channels[usize::from(channel)].pressure = pressure;
    }

    /// Handles a controller at a value 0–1. Returns the number of members if the message configures this channel's
    /// zone.
    pub(super) fn control(&mut self, channel: u8, number: u8, value: f32) -> Option<u8> {
        let mode = self.of(channel).mode();
        for reached in self.zones.reach(channel) {
            // Notes combine the master's wheels and pressure with their own, so these stay separate. Only a reset goes
            // to members.
            if reached == channel || number == controller::RESET {
                self.channels[usize::from(reached)].control(number, value);
            }
        }
        let sender = *self.of(channel);
        let is_mode = matches!(number, controller::MONO | controller::POLY);
        let may_change = is_mode || matches!(number, controller::LEGATO | controller::RESET) && sender.mode() != mode;
        // Members of a zone have one note each, and no mode of their own.
        if may_change && self.master_of(channel).is_none() {
            self.mode = sender.mode();
        }
        self.gains_moving = sender.slope_frames();
        let is_entry =
            matches!(number, controller::DATA | controller::DATA_FINE | controller::INCREMENT | controller::DECREMENT);
        if is_entry && sender.awaits_bend_range() {
            for sibling in self.zones.siblings(channel) {
                self.channels[usize::from(sibling)].bend_range = sender.bend_range;
            }
        }
        (number == controller::DATA && sender.awaits_zone()).then(|| seven_bits(value))
    }

    /// Sets the gains of a channel to their targets at once, for one on which nothing sounds.
    pub(super) fn land(&mut self, channel: u8) {
        self.channels[usize::from(channel)].land();
    }

    /// Makes a zone of a master and `members` channels. Returns the channels whose master has changed.
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

    /// The controllers of a channel, and the number of frames until all gains have reached their targets.
    pub(super) fn channel(&self, channel: u8) -> (Channel, u32) {
        (*self.of(channel), self.gains_moving)
    }

    /// Sets the controllers of a channel to those of another synth's.
    pub(super) fn set_channel(&mut self, channel: u8, (held, gains_moving): (Channel, u32)) {
        self.channels[usize::from(channel)] = held;
        self.gains_moving = self.gains_moving.max(gains_moving);
    }

    /// Advances the gains by `frames` frames.
    pub(super) fn advance(&mut self, frames: u32) {
        if self.gains_moving > 0 {
            self.channels.iter_mut().for_each(|channel| channel.advance(frames));
            self.gains_moving = self.gains_moving.saturating_sub(frames);
        }
    }
}
