//! Sixteen MIDI channels, a synth each, mixed in channel order: what a MIDI file plays on.

use super::{Event, EventKind, Snapshot, Synth};
use crate::params::Param;
use crate::patch::Patch;

/// Frames that are mixed at a time.
const CHUNK: usize = 1024;

/// Sixteen synths behind one stream of events.
///
/// Each channel has its own patch, controllers and polyphony. A note of a choke group silences that group on every
/// channel. Gives the same bits however the frames are divided into blocks. Real-time safe after [`Ensemble::new`].
pub struct Ensemble {
    synths: Vec<Synth>,
    programs: Vec<Patch>,
    scratch: [Vec<f32>; 2],
}

impl Ensemble {
    /// An ensemble in which every channel starts with `patch` and program changes choose from `programs`
    /// (a number beyond the list changes nothing). Allocates.
    pub fn new(sample_rate: f64, seed: u64, patch: &Patch, programs: &[Patch]) -> Self {
        let synth = |channel: u64| {
            let mut synth = Synth::new(sample_rate, seed.wrapping_add(channel << 32));
            synth.set_patch(patch);
            synth
        };
        Self {
            synths: (0..16).map(synth).collect(),
            programs: programs.to_vec(),
            scratch: [vec![0.0; CHUNK], vec![0.0; CHUNK]],
        }
    }

    /// Renders the next `left.len()` frames (any number) over what the slices hold; both are of one length.
    /// `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        let (mut events, frames, mut start) = (events, left.len(), 0);
        // At least once: a block of no frames still brings its events.
        loop {
            let end = frames.min(start + CHUNK);
            let now =
                if end == frames { events.len() } else { events.partition_point(|event| (event.frame as usize) < end) };
            self.process_chunk(&events[..now], start, &mut left[start..end], &mut right[start..end]);
            if end == frames {
                break;
            }
            (events, start) = (&events[now..], end);
        }
    }

    /// Renders up to [`CHUNK`] frames; the frames of `events` count from `start` before the chunk.
    fn process_chunk(&mut self, events: &[Event], start: usize, left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        let mut groups_before = [0.0; 16];
        for (group, synth) in groups_before.iter_mut().zip(&self.synths) {
            *group = synth.patch().get(Param::Choke);
        }
        let frames = left.len();
        let [scratch_left, scratch_right] = &mut self.scratch;
        let (scratch_left, scratch_right) = (&mut scratch_left[..frames], &mut scratch_right[..frames]);
        for (channel, synth) in self.synths.iter_mut().enumerate() {
            let mut groups = groups_before;
            let mut frame = 0;
            let mut heard = !synth.is_silent();
            for event in events {
                let sender = usize::from(event.channel & 15);
                let program = match event.kind {
                    EventKind::Program(number) => self.programs.get(usize::from(number)),
                    _ => None,
                };
                let kind = match event.kind {
                    EventKind::NoteOn { .. } if sender != channel => EventKind::Choke { group: groups[sender] as u8 },
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
                if sender != channel && !is_for_all {
                    continue;
                }
                let at = (event.frame as usize).saturating_sub(start).min(frames.saturating_sub(1)).max(frame);
                synth.process(&[], &mut scratch_left[frame..at], &mut scratch_right[frame..at]);
                frame = at;
                match program {
                    Some(patch) => synth.set_patch(patch),
                    None => synth.handle(&Event { kind, ..*event }),
                }
                heard |= !synth.is_silent();
            }
            if !heard {
                synth.pass(frames - frame);
            } else {
                synth.process(&[], &mut scratch_left[frame..], &mut scratch_right[frame..]);
                add(left, scratch_left);
                add(right, scratch_right);
            }
        }
    }

    /// Plays another patch on a channel from its next note on. Real-time safe.
    pub fn set_patch(&mut self, channel: u8, patch: &Patch) {
        self.synths[usize::from(channel & 15)].set_patch(patch);
    }

    /// What sounds now, on all channels together. Real-time safe.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.synths.iter().for_each(|synth| synth.show(&mut snapshot));
        snapshot
    }

    /// Whether nothing sounds any more. Real-time safe.
    pub fn is_silent(&self) -> bool {
        self.synths.iter().all(Synth::is_silent)
    }

    /// Most notes that have sounded at once on one channel each, added up.
    pub fn voices_used(&self) -> usize {
        self.synths.iter().map(Synth::voices_used).sum()
    }
}

fn add(sum: &mut [f32], part: &[f32]) {
    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
}
