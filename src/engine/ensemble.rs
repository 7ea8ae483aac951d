//! Sixteen MIDI channels, a synth each, mixed in channel order: what a MIDI file plays on.

use super::mix_limiter::MixLimiter;
use super::synth::allowed;
use super::{Event, EventKind, Snapshot, Synth};
use crate::dsp::limiter::Work;
use crate::params::Param;
use crate::patch::Patch;

/// Frames that are mixed at a time, unless [`Ensemble::with_chunk`] says otherwise.
const CHUNK: usize = 1024;

/// Sixteen synths behind one stream of events.
///
/// Each channel has its own patch, controllers and polyphony. A note of a choke group silences that group on every
/// channel. One limiter is at the end of the mix: it is on while any channel that has had a note has a patch that asks
/// for it. Gives the same bits however the frames are divided into blocks. Real-time safe after [`Ensemble::new`].
pub struct Ensemble {
    parts: Vec<Part>,
    programs: Vec<Patch>,
    chunk: usize,
    limiter: MixLimiter,
}

/// What one channel plays: its synth, and the frames of the chunk that is being mixed.
pub struct Part {
    channel: usize,
    synth: Synth,
    left: Vec<f32>,
    right: Vec<f32>,
    /// Whether the chunk has sound.
    heard: bool,
}

/// The events and frames that every part plays in one go.
#[derive(Clone, Copy)]
struct Chunk<'a> {
    events: &'a [Event],
    /// The frames of the events count from so many before the chunk.
    start: usize,
    frames: usize,
    programs: &'a [Patch],
    /// Choke groups of the channels before the events.
    groups: [f32; 16],
}

impl Ensemble {
    /// An ensemble in which every channel starts with `patch` and program changes choose from `programs`
    /// (a number beyond the list changes nothing). Allocates.
    pub fn new(sample_rate: f64, seed: u64, patch: &Patch, programs: &[Patch]) -> Self {
        let part = |channel: u64| {
            let mut synth = Synth::new(sample_rate, seed.wrapping_add(channel << 32));
            synth.set_patch(patch);
            Part { channel: channel as usize, synth, left: vec![0.0; CHUNK], right: vec![0.0; CHUNK], heard: false }
        };
        let limiter = MixLimiter::new(allowed(sample_rate), patch);
        Self { parts: (0..16).map(part).collect(), programs: programs.to_vec(), chunk: CHUNK, limiter }
    }

    /// The same ensemble, mixing up to `frames` frames (at least 1) at a time: more than it would of itself pay where
    /// parts are played side by side. Allocates.
    #[must_use]
    pub fn with_chunk(mut self, frames: usize) -> Self {
        self.chunk = frames.max(1);
        for Part { left, right, .. } in &mut self.parts {
            left.resize(self.chunk, 0.0);
            right.resize(self.chunk, 0.0);
        }
        self
    }

    /// Renders the next `left.len()` frames (any number) over what the slices hold; both are of one length.
    /// `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process_by(|parts, play| parts.iter_mut().for_each(play), events, left, right);
    }

    /// As [`Ensemble::process`], with the parts played by `each`: it calls the function that it is given once with
    /// every part, in any order and on any threads, as no part depends on another. The bits are the same. As
    /// real-time safe as `each` is.
    pub fn process_by(
        &mut self,
        each: impl Fn(&mut [Part], &(dyn Fn(&mut Part) + Sync)),
        events: &[Event],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let (mut events, frames, mut start) = (events, left.len(), 0);
        // At least once: a block of no frames still brings its events.
        loop {
            let end = frames.min(start + self.chunk);
            let now =
                if end == frames { events.len() } else { events.partition_point(|event| (event.frame as usize) < end) };
            let mut groups = [0.0; 16];
            for (group, part) in groups.iter_mut().zip(&self.parts) {
                *group = part.synth.patch().get(Param::Choke);
            }
            let programs = &self.programs;
            let chunk = Chunk { events: &events[..now], start, frames: end - start, programs, groups };
            each(&mut self.parts, &|part| part.play(chunk));
            let (left, right) = (&mut left[start..end], &mut right[start..end]);
            self.mix(left, right);
            let is_heard = self.parts.iter().any(|part| part.heard);
            self.limiter.process(&events[..now], start, &self.programs, is_heard, [left, right]);
            if end == frames {
                break;
            }
            (events, start) = (&events[now..], end);
        }
    }

    /// Adds up the parts, in the order of their channels.
    fn mix(&self, left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        for part in self.parts.iter().filter(|part| part.heard) {
            add(left, &part.left);
            add(right, &part.right);
        }
    }

    /// Plays another patch on a channel from its next note on. Real-time safe.
    pub fn set_patch(&mut self, channel: u8, patch: &Patch) {
        self.parts[usize::from(channel & 15)].synth.set_patch(patch);
        self.limiter.set_patch(channel, patch);
    }

    /// What sounds now, on all channels together. Real-time safe.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.parts.iter().for_each(|part| part.synth.show(&mut snapshot));
        snapshot
    }

    /// How much the limiter has worked. Real-time safe.
    pub fn limiter_work(&self) -> Work {
        self.limiter.work()
    }

    /// Whether nothing sounds any more. Real-time safe.
    pub fn is_silent(&self) -> bool {
        self.parts.iter().all(|part| part.synth.is_silent())
    }

    /// Most notes that have sounded at once on one channel each, added up.
    pub fn voices_used(&self) -> usize {
        self.parts.iter().map(|part| part.synth.voices_used()).sum()
    }
}

impl Part {
    /// Renders a chunk into the part's own frames.
    fn play(&mut self, chunk: Chunk) {
        let Chunk { events, start, frames, programs, mut groups } = chunk;
        let Self { channel, synth, heard, .. } = self;
        let (left, right) = (&mut self.left[..frames], &mut self.right[..frames]);
        let mut frame = 0;
        *heard = !synth.is_silent();
        for event in events {
            let sender = usize::from(event.channel & 15);
            let program = match event.kind {
                EventKind::Program(number) => programs.get(usize::from(number)),
                _ => None,
            };
            let kind = match event.kind {
                EventKind::NoteOn { .. } if sender != *channel => EventKind::Choke { group: groups[sender] as u8 },
                kind => kind,
            };
            if let Some(patch) = program {
                groups[sender] = patch.get(Param::Choke);
            } else if let EventKind::Param { param: Param::Choke, value } = kind {
                groups[sender] = Param::Choke.info().clamp(value);
            }
            let is_for_all = match kind {
                EventKind::Choke { group } => group != 0,
                EventKind::Tempo(_) => true,
                _ => false,
            };
            if sender != *channel && !is_for_all {
                continue;
            }
            let at = (event.frame as usize).saturating_sub(start).min(frames.saturating_sub(1)).max(frame);
            synth.play(&mut left[frame..at], &mut right[frame..at]);
            frame = at;
            match program {
                Some(patch) => synth.set_patch(patch),
                None => synth.handle(&Event { kind, ..*event }),
            }
            *heard |= !synth.is_silent();
        }
        if *heard {
            synth.play(&mut left[frame..], &mut right[frame..]);
        } else {
            synth.pass(frames - frame);
        }
    }
}

fn add(sum: &mut [f32], part: &[f32]) {
    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
}
