//! The limiter at the end of an ensemble's mix, and the channels whose kits switch it on.

use super::chunk::Chunk;
use crate::dsp::Limiter;
use crate::dsp::limiter::Work;
use crate::engine::note::nearest_channel;
use crate::engine::{Event, EventKind};
use crate::params::Param;
use crate::sound::Kit;

/// One limiter for the mix of sixteen channels. It is on while any channel that has had a note has a kit that switches
/// it on. So a preset that switches the limiter off is respected if its channel plays alone, and a song with several sounds
/// is limited unless all of them switch it off. Real-time safe once built.
pub(super) struct MixLimiter {
    limiter: Limiter,
    channels: Channels,
    is_bypassed: bool,
}

/// Sets of channels, one bit each.
#[derive(Clone, Copy)]
struct Channels {
    /// Channels whose kit switches the limiter on.
    asking: u16,
    /// Channels that have had a note.
    played: u16,
}

impl Channels {
    fn is_on(self) -> bool {
        self.asking & self.played != 0
    }

    fn set_asking(&mut self, channel: u8, value: f32) {
        let bit = 1 << nearest_channel(channel);
        self.asking = if value == 0.0 { self.asking & !bit } else { self.asking | bit };
    }

    /// Updates the sets after an event of a chunk.
    fn handle(&mut self, event: &Event, chunk: &Chunk) {
        let owner = chunk.owner(event);
        match event.kind {
            EventKind::NoteOn { .. } | EventKind::Strike { .. } => self.played |= 1 << owner,
            EventKind::Param { param: Param::Limiter, value } => {
                self.set_asking(owner, Param::Limiter.info().clamp(value));
            }
            EventKind::Program(number) => {
                if let Some(kit) = chunk.program(event, number) {
                    self.set_asking(owner, kit.values().get(Param::Limiter));
                }
            }
            _ => {}
        }
    }
}

impl MixLimiter {
    /// A limiter for sixteen channels, each of which must then be given a kit.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { limiter: Limiter::new(sample_rate), channels: Channels { asking: 0, played: 0 }, is_bypassed: false }
    }

    /// Sets the kit of a channel.
    pub(super) fn set_kit(&mut self, channel: u8, kit: &Kit) {
        self.channels.set_asking(channel, kit.values().get(Param::Limiter));
    }

    /// From now on, changes no sample.
    pub(super) fn leave_unlimited(&mut self) {
        self.is_bypassed = true;
    }

    /// Whether the kits of the channels that have played ask for it.
    pub(super) fn is_wanted(&self) -> bool {
        self.channels.is_on()
    }

    /// The present gain, an amplitude ratio.
    pub(super) fn gain(&self) -> f64 {
        self.limiter.gain()
    }

    /// How much the limiter has reduced the level so far.
    pub(super) fn work(&self) -> Work {
        self.limiter.work()
    }

    /// Limits the frames of a chunk in place. If `is_heard` is false, the frames are silent.
    pub(super) fn process(&mut self, chunk: &Chunk, is_heard: bool, [left, right]: [&mut [f32]; 2]) {
        let mut limit = |is_on: bool, left: &mut [f32], right: &mut [f32]| {
            if is_heard || !self.limiter.is_idle() {
                self.limiter.process(is_on && !self.is_bypassed, left, right);
            }
        };
        let mut frame = 0;
        for event in chunk.events {
            let was_on = self.channels.is_on();
            self.channels.handle(event, chunk);
            if was_on != self.channels.is_on() {
                let at = chunk.frame(event).max(frame);
                limit(was_on, &mut left[frame..at], &mut right[frame..at]);
                frame = at;
            }
        }
        limit(self.channels.is_on(), &mut left[frame..], &mut right[frame..]);
    }
}
