//! Sixteen MIDI channels, one synth each, mixed in channel order: the instrument for MIDI files.

mod choke;
mod chunk;
mod lender;
mod mix_limiter;
mod part;
mod process;
mod shared_space;
mod stems;

use super::note::nearest_channel;
use super::synth::allowed;
use super::zones::Owners;
use super::{Snapshot, Synth, VoiceState};
use crate::dsp::limiter::Work;
use crate::params::Values;
use crate::patch::Patch;
use crate::sound::{Kit, Mix, Tuning};
use crate::units::gain_from_db;
use choke::Playing;
use lender::Lender;
use mix_limiter::MixLimiter;
use part::Part;
use shared_space::SharedSpace;
use std::sync::Arc;
pub(crate) use stems::Stems;

/// Frames that are rendered and mixed at a time, unless [`Ensemble::with_chunk`] sets another number.
const CHUNK: usize = 1024;

/// Sixteen synths behind one stream of events.
///
/// Each channel has its own kit, controllers and polyphony. An MPE configuration message makes a zone, whose members
/// play on the instrument of their master channel. A note of a choke group silences that group on every
/// channel. One limiter is at the end of the mix: it is on while any channel that has had a note has a kit that
/// switches it on. Each channel has its own effects, and only those that are on take time; beside them the channels can
/// share one space ([`Mix::space`]). The output is bit for bit the same for all block
/// sizes. Real-time safe once built.
pub struct Ensemble {
    parts: Vec<Part>,
    programs: Vec<Arc<Kit>>,
    /// The kits that channels were built with, kept so that a program change never frees one on the audio thread.
    starts: Vec<Arc<Kit>>,
    /// The kit and choke group of each part, which the other parts need to know.
    playing: [Playing; 16],
    /// Maximum length of a chunk in frames.
    chunk_frames: usize,
    /// Index of the part that plays each channel.
    owners: Owners,
    lender: Lender,
    /// Boxed, because most ensembles have none.
    shared_space: Option<Box<SharedSpace>>,
    /// Amplitude ratio of the mix.
    gain: f32,
    limiter: MixLimiter,
    /// The stems, if they are wanted.
    stems: Option<Box<Stems>>,
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
            shared_space: None,
            gain: 1.0,
            limiter: MixLimiter::new(allowed(sample_rate)),
            stems: None,
        };
        ensemble.reserve(largest);
        let Self { parts, programs, .. } = &mut ensemble;
        for kit in programs.iter() {
            parts.iter_mut().for_each(|part| part.synth.make_room_for(kit));
        }
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

    /// Makes room for kits of up to `sounds` sounds on every channel, so that [`Ensemble::set_kit`] does not allocate.
    /// Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.parts.iter_mut().for_each(|part| part.synth.reserve(sounds));
    }

    /// Makes room on every channel for soundboxes, sympathetic strings and any body of the space, as [`Synth::reserve_space`]: 4 MB
    /// for each channel. Kits and programs that use them reserve it themselves. Allocates.
    pub fn reserve_space(&mut self) {
        self.parts.iter_mut().for_each(|part| part.synth.reserve_space());
    }

    /// The same ensemble, rendering up to `frames` frames (at least 1) at a time. If parts are rendered on several threads,
    /// chunks longer than the default are faster. Allocates.
    #[must_use]
    pub fn with_chunk(mut self, frames: usize) -> Self {
        self.chunk_frames = frames.max(1);
        self.parts.iter_mut().for_each(|part| part.resize(self.chunk_frames));
        if let Some(space) = &mut self.shared_space {
            space.resize(self.chunk_frames);
        }
        self
    }

    /// The same ensemble with the gain and the shared space of `mix`. Allocates.
    #[must_use]
    pub fn with_mix(mut self, mix: &Mix) -> Self {
        let sample_rate = self.parts[0].synth.sample_rate();
        self.shared_space = SharedSpace::new(sample_rate, &mix.space, self.chunk_frames).map(Box::new);
        self.gain = gain_from_db(mix.gain.into()) as f32;
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

    /// Sets the tuning of all channels from the next note on. Sounding notes keep their pitch.
    /// Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.parts.iter_mut().for_each(|part| part.synth.set_tuning(tuning));
    }

    /// The parameters of the kit that plays a channel (one above 15 is taken as 15), without modulation. Real-time safe.
    pub fn values(&self, channel: u8) -> &Values {
        let owner = self.owners.of(nearest_channel(channel));
        self.parts[usize::from(owner)].synth.values()
    }

    /// The voices and masses that sound now, of all channels together. Real-time safe.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.parts.iter().for_each(|part| part.synth.show(&mut snapshot));
        snapshot.set_limiter(self.limiter.gain());
        snapshot
    }

    /// Calls `visit` with each voice that sounds now, and the number of the part that plays it. The order is always the
    /// same. Real-time safe as [`Synth::each_voice`](crate::engine::Synth::each_voice).
    pub(crate) fn each_voice(&mut self, visit: &mut dyn FnMut(usize, VoiceState<'_>)) {
        for (part, Part { synth, .. }) in self.parts.iter_mut().enumerate() {
            synth.each_voice(&mut |voice| visit(part, voice));
        }
    }

    /// Tells the strikes of notes apart that are struck while they sound ([`VoiceState::strikes`]). To be called before the first
    /// note. Afterwards [`Ensemble::process`] is not real-time safe: it allocates at such strikes and while they act. The output stays the same.
    pub(crate) fn separate_strikes(&mut self) {
        self.lender.voices_mut().for_each(|voice| voice.separate_strikes());
    }

    /// From now on, keeps the stems of all frames until they are cleared. Afterwards [`Ensemble::process`] is not real-time safe: it
    /// allocates. The output is the same, but for the rounding of the sums of kits' voices.
    pub(crate) fn keep_stems(&mut self) {
        self.stems = Some(Box::default());
        self.parts.iter_mut().for_each(|part| part.synth.sum_pads());
    }

    /// The stems since they were cleared, if they are kept.
    pub(crate) fn stems(&mut self) -> Option<&mut Stems> {
        self.stems.as_deref_mut()
    }

    /// From now on, the limiter does nothing; [`Ensemble::is_limiter_wanted`] says whether it would have been on.
    pub(crate) fn leave_unlimited(&mut self) {
        self.limiter.leave_unlimited();
    }

    /// Whether the limiter is on for what has been played so far.
    pub(crate) fn is_limiter_wanted(&self) -> bool {
        self.limiter.is_wanted()
    }

    /// Whether notes are left out from now on. Those after them are the same as if they had sounded.
    pub(crate) fn leave_out_notes(&mut self, leaves_out: bool) {
        self.parts.iter_mut().for_each(|part| part.synth.leave_out_notes(leaves_out));
    }

    /// Amplitude ratio at which the channels are mixed, before the limiter.
    pub(crate) fn gain(&self) -> f32 {
        self.gain
    }

    /// How much the limiter has reduced the level so far. Real-time safe.
    pub(crate) fn limiter_work(&self) -> Work {
        self.limiter.work()
    }

    /// Whether nothing sounds, neither on any channel nor in the shared space. Real-time safe.
    pub fn is_silent(&self) -> bool {
        let is_space_silent = self.shared_space.as_ref().is_none_or(|space| space.is_idle());
        is_space_silent && self.parts.iter().all(|part| part.synth.is_silent())
    }

    /// The largest number of notes that sounded at once on each channel, added up over the channels.
    pub fn voices_used(&self) -> usize {
        self.parts.iter().map(|part| part.synth.voices_used()).sum()
    }
}

#[cfg(test)]
mod tests;
