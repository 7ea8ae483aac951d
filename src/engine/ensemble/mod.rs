//! Sixteen MIDI channels, a synth each, mixed in channel order: what a MIDI file plays on.

mod choke;
mod chunk;
mod lender;
mod mix_limiter;
mod part;
mod process;

use super::note::nearest_channel;
use super::synth::allowed;
use super::zones::Owners;
use super::{Snapshot, Synth};
use crate::dsp::limiter::Work;
use crate::patch::Patch;
use crate::sound::{Kit, Tuning};
use choke::Playing;
use lender::Lender;
use mix_limiter::MixLimiter;
pub use part::Part;
use std::sync::Arc;

/// Frames that are mixed at a time, unless [`Ensemble::with_chunk`] says otherwise.
const CHUNK: usize = 1024;

/// Sixteen synths behind one stream of events.
///
/// Each channel has its own kit, controllers and polyphony. An MPE configuration message makes a zone, whose members
/// play on the instrument of their master channel. A note of a choke group silences that group on every
/// channel. One limiter is at the end of the mix: it is on while any channel that has had a note has a kit that asks
/// for it. Gives the same bits however the frames are divided into blocks. Real-time safe once built.
pub struct Ensemble {
    parts: Vec<Part>,
    programs: Vec<Arc<Kit>>,
    /// The kits that channels have been built with, kept so that none is freed in a program change.
    starts: Vec<Arc<Kit>>,
    /// What each part plays, for the others to know.
    playing: [Playing; 16],
    /// Most frames of a chunk.
    chunk_frames: usize,
    /// Which part plays which channel.
    owners: Owners,
    lender: Lender,
    limiter: MixLimiter,
}

impl Ensemble {
    /// An ensemble in which every channel starts with `patch` and program changes choose from `programs`
    /// (a number beyond the list changes nothing). Allocates.
    pub fn new(sample_rate: f64, seed: u64, patch: &Patch, programs: &[Patch]) -> Self {
        Self::of_kits(sample_rate, seed, &Kit::of_patch(patch), programs.iter().map(Kit::of_patch).collect())
    }

    /// As [`Ensemble::new`], with kits. Allocates.
    pub fn of_kits(sample_rate: f64, seed: u64, kit: &Arc<Kit>, programs: Vec<Arc<Kit>>) -> Self {
        let part = |channel: u64| {
            let synth = Synth::with_voices(sample_rate, seed.wrapping_add(channel << 32), Lender::for_part());
            Part::new(channel as usize, synth, CHUNK)
        };
        let largest = programs.iter().map(|kit| kit.sounds().len()).max().unwrap_or(1);
        let mut ensemble = Self {
            parts: (0..16).map(part).collect(),
            programs,
            starts: Vec::new(),
            playing: std::array::from_fn(|_| Playing::new(kit)),
            chunk_frames: CHUNK,
            owners: Owners::default(),
            lender: Lender::new(sample_rate),
            limiter: MixLimiter::new(allowed(sample_rate)),
        };
        ensemble.reserve(largest);
        (0..16).fold(ensemble, |ensemble, channel| ensemble.with_kit(channel, kit))
    }

    /// The same ensemble with another kit on a channel (one above 15 is taken as 15) from the start. Allocates.
    #[must_use]
    pub fn with_kit(mut self, channel: u8, kit: &Arc<Kit>) -> Self {
        self.starts.push(kit.clone());
        self.reserve(kit.sounds().len());
        self.set_kit(channel, kit);
        self
    }

    /// Makes room for kits of up to so many sounds on every channel, so that [`Ensemble::set_kit`] need not. Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.parts.iter_mut().for_each(|part| part.synth.reserve(sounds));
    }

    /// The same ensemble, mixing up to `frames` frames (at least 1) at a time: more than it would of itself pay where
    /// parts are played side by side. Allocates.
    #[must_use]
    pub fn with_chunk(mut self, frames: usize) -> Self {
        self.chunk_frames = frames.max(1);
        self.parts.iter_mut().for_each(|part| part.resize(self.chunk_frames));
        self
    }

    /// Plays another kit on a channel (one above 15 is taken as 15) from its next note on. As real-time safe as
    /// [`Synth::set_kit`]: the ensemble itself keeps its programs and the kits that it was built with.
    pub fn set_kit(&mut self, channel: u8, kit: &Arc<Kit>) {
        let channel = nearest_channel(channel);
        let synth = &mut self.parts[usize::from(channel)].synth;
        synth.set_kit(kit);
        self.playing[usize::from(channel)].follow(synth);
        self.limiter.set_kit(channel, kit);
    }

    /// Tunes the keys of all channels in another way from the next note on. Notes that sound keep their pitch.
    /// Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.parts.iter_mut().for_each(|part| part.synth.set_tuning(tuning));
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

#[cfg(test)]
mod tests;
