//! One part of an ensemble: the synth of a channel, and its output for the chunk that is being mixed.

use super::choke::ChokeGroups;
use super::chunk::Chunk;
use crate::engine::synth::{add, part as part_of};
use crate::engine::workers::Workers;
use crate::engine::{Event, EventKind, Synth};
use crate::params::Param;

/// The synth of one channel and its output. Parts do not depend on each other while a chunk is played.
pub(super) struct Part {
    channel: usize,
    pub(super) synth: Synth,
    left: Vec<f32>,
    right: Vec<f32>,
    /// Whether the synth made any sound in the chunk.
    pub(super) is_heard: bool,
}

impl Part {
    /// The part of a channel, for chunks of up to `frames` frames. Allocates.
    pub(super) fn new(channel: usize, synth: Synth, frames: usize) -> Self {
        Self { channel, synth, left: vec![0.0; frames], right: vec![0.0; frames], is_heard: false }
    }

    /// Makes room for chunks of up to `frames` frames. Allocates.
    pub(super) fn resize(&mut self, frames: usize) {
        self.left.resize(frames, 0.0);
        self.right.resize(frames, 0.0);
    }

    /// Renders a chunk into the part's own buffers. `groups` are the choke groups of all parts before the chunk.
    pub(super) fn play<'a>(&mut self, workers: &impl Workers, chunk: &Chunk<'a>, groups: &[ChokeGroups<'a>; 16]) {
        let Self { channel, synth, is_heard, .. } = self;
        *is_heard = !synth.is_silent();
        if !*is_heard && chunk.events.is_empty() {
            return synth.rest(chunk.frames);
        }
        let (left, right) = (&mut self.left[..chunk.frames], &mut self.right[..chunk.frames]);
        let (mut frame, mut groups) = (0, *groups);
        for event in chunk.events {
            let owner = usize::from(chunk.owner(event));
            let program = match event.kind {
                EventKind::Program(number) => chunk.program(event, number),
                _ => None,
            };
            let kind = match event.kind {
                EventKind::NoteOn { key, .. } | EventKind::Strike { key, .. } if owner != *channel => {
                    EventKind::Choke { group: groups[owner].of_key(key, synth.tuning()) }
                }
                kind => kind,
            };
            if let Some(kit) = program {
                groups[owner] = ChokeGroups::of_kit(kit);
            } else if let EventKind::Param { param: Param::Choke, value } = kind {
                groups[owner].set(value);
            }
            let is_for_all = match kind {
                EventKind::Choke { group } => group != 0,
                EventKind::Tempo(_) => true,
                _ => false,
            };
            if owner != *channel && !is_for_all {
                continue;
            }
            let at = chunk.frame(event).max(frame);
            let input = part_of(chunk.input, frame, at);
            synth.play(workers, input, &mut left[frame..at], &mut right[frame..at], None);
            frame = at;
            match program {
                Some(kit) => synth.set_kit(kit),
                None => synth.handle(&Event { kind, ..*event }),
            }
            *is_heard |= !synth.is_silent();
        }
        if *is_heard {
            let input = part_of(chunk.input, frame, chunk.frames);
            synth.play(workers, input, &mut left[frame..], &mut right[frame..], None);
        } else {
            synth.rest(chunk.frames - frame);
        }
    }

    /// The part's frames of the chunk. Valid only if `is_heard` is true.
    pub(super) fn output(&self) -> [&[f32]; 2] {
        [&self.left, &self.right]
    }

    /// Adds the part's frames to the mix.
    pub(super) fn add_to(&self, left: &mut [f32], right: &mut [f32]) {
        if self.is_heard {
            add(left, &self.left);
            add(right, &self.right);
        }
    }
}
