//! A chunk: the events and frames that all parts of an ensemble play before they are mixed.

use crate::engine::Event;
use crate::engine::note::nearest_channel;
use crate::engine::zones::Owners;
use crate::sound::Kit;
use std::sync::Arc;

/// What the parts play in one go.
#[derive(Clone, Copy)]
pub(super) struct Chunk<'a> {
    pub(super) events: &'a [Event],
    /// The frame of the block, from which events count, at which the chunk starts.
    pub(super) start: usize,
    /// The last frame of the chunk that an event can be at.
    pub(super) last: usize,
    pub(super) frames: usize,
    /// Who plays which channel.
    pub(super) owners: Owners,
    /// The kits that program changes choose from.
    pub(super) programs: &'a [Arc<Kit>],
}

impl<'a> Chunk<'a> {
    /// The frame of an event, from the start of the chunk.
    pub(super) fn frame(&self, event: &Event) -> usize {
        (event.frame as usize).saturating_sub(self.start).min(self.last)
    }

    /// The channel whose part plays the notes of an event.
    pub(super) fn owner(&self, event: &Event) -> u8 {
        self.owners.of(nearest_channel(event.channel))
    }

    /// The kit of a program number that an event brings to a part; none if there is no such program, or if the event is
    /// on a member channel, which plays what its master does.
    pub(super) fn program(&self, event: &Event, number: u8) -> Option<&'a Arc<Kit>> {
        let is_own = self.owner(event) == nearest_channel(event.channel);
        self.programs.get(usize::from(number)).filter(|_| is_own)
    }
}
