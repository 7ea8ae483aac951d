//! A chunk: the events and frames that all parts of an ensemble render before they are mixed.

use crate::engine::Event;
use crate::engine::note::nearest_channel;
use crate::engine::zones::Owners;
use crate::sound::Kit;
use std::sync::Arc;

/// The input of every part between two mixes.
#[derive(Clone, Copy)]
pub(super) struct Chunk<'a> {
    pub(super) events: &'a [Event],
    /// Incoming sound, from the start of the chunk.
    pub(super) input: &'a [f32],
    /// Frame of the block at which the chunk starts. Events count their frames from the start of the block.
    pub(super) start: usize,
    /// The last frame that an event of the chunk can have, counted from the chunk's start.
    pub(super) last: usize,
    pub(super) frames: usize,
    /// Which part plays which channel.
    pub(super) owners: Owners,
    /// The kits of the program numbers.
    pub(super) programs: &'a [Arc<Kit>],
}

impl<'a> Chunk<'a> {
    /// The frame of an event, counted from the start of the chunk.
    pub(super) fn frame(&self, event: &Event) -> usize {
        (event.frame as usize).saturating_sub(self.start).min(self.last)
    }

    /// The channel whose part plays the notes of an event.
    pub(super) fn owner(&self, event: &Event) -> u8 {
        self.owners.of(nearest_channel(event.channel))
    }

    /// The kit that a program change event selects. None if there is no such program, or if the event is on a member
    /// channel of an MPE zone, which plays the kit of its master channel.
    pub(super) fn program(&self, event: &Event, number: u8) -> Option<&'a Arc<Kit>> {
        let is_own = self.owner(event) == nearest_channel(event.channel);
        self.programs.get(usize::from(number)).filter(|_| is_own)
    }
}
