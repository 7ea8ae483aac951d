//! A score: a patch, events at frames, and a length; can be rendered in blocks of any size.

use sprung::engine::{Ensemble, Event, EventKind};
use sprung::patch::Patch;
use sprung::sound::{Kit, Mix};
use std::sync::Arc;

/// A block as long as the score.
pub(crate) const WHOLE: usize = usize::MAX;

/// Block sizes that must all give the same bits as one block of the whole length.
pub(crate) const BLOCKS: &[usize] = &[1, 7, 64, 480, 4096];

/// The patch, events and settings of a golden case.
#[derive(Clone)]
pub(crate) struct Score {
    /// Name of the case and of its files.
    pub(crate) name: String,
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    pub(crate) patch: Patch,
    /// The kits that program changes select from.
    pub(crate) programs: Vec<Arc<Kit>>,
    pub(crate) mix: Mix,
    /// Events as frame, channel and kind, in order of time.
    events: Vec<(u64, u8, EventKind)>,
    pub(crate) frames: usize,
    /// Block sizes that it is played in, beside one block.
    pub(crate) blocks: &'static [usize],
    /// Whether the beginning of the audio is kept in addition to the digest.
    pub(crate) keeps_audio: bool,
}

impl Score {
    /// A score of `seconds` without events, at 48 kHz.
    pub(crate) fn new(name: impl Into<String>, patch: Patch, seconds: f64) -> Self {
        let sample_rate = 48_000.0;
        Self {
            name: name.into(),
            sample_rate,
            seed: 1,
            patch,
            programs: Vec::new(),
            mix: Mix::default(),
            events: Vec::new(),
            frames: (seconds * sample_rate) as usize,
            blocks: BLOCKS,
            keeps_audio: false,
        }
    }

    /// Changes the sample rate but not the length in seconds. Must be called before any event is added.
    pub(crate) fn at_rate(mut self, sample_rate: f64) -> Self {
        assert!(self.events.is_empty(), "events are placed by frame");
        self.frames = (self.frames as f64 * sample_rate / self.sample_rate) as usize;
        self.sample_rate = sample_rate;
        self
    }

    pub(crate) fn with_programs(self, programs: Vec<Patch>) -> Self {
        self.with_kits(programs.iter().map(Kit::of_patch).collect())
    }

    pub(crate) fn with_kits(mut self, programs: Vec<Arc<Kit>>) -> Self {
        self.programs = programs;
        self
    }

    pub(crate) fn with_mix(self, mix: Mix) -> Self {
        Self { mix, ..self }
    }

    /// Plays it in these block sizes only, beside one block.
    pub(crate) fn in_blocks(self, blocks: &'static [usize]) -> Self {
        Self { blocks, ..self }
    }

    pub(crate) fn keeping_audio(mut self) -> Self {
        self.keeps_audio = true;
        self
    }

    /// Adds an event at `seconds`, which must not be before the previous event.
    pub(crate) fn then(mut self, seconds: f64, channel: u8, kind: EventKind) -> Self {
        let frame = (seconds * self.sample_rate).round() as u64;
        assert!(self.events.last().is_none_or(|last| last.0 <= frame), "{}: events in order", self.name);
        self.events.push((frame, channel, kind));
        self
    }

    /// Key down on channel 0, with a MIDI velocity.
    pub(crate) fn on(self, seconds: f64, key: u8, velocity: u8) -> Self {
        let velocity = f32::from(velocity) / 127.0;
        self.then(seconds, 0, EventKind::NoteOn { key, detune: 0.0, velocity, id: None })
    }

    /// Key up on channel 0.
    pub(crate) fn off(self, seconds: f64, key: u8) -> Self {
        self.then(seconds, 0, EventKind::NoteOff { key, velocity: 0.5, id: None })
    }

    /// A controller on channel 0, with a MIDI value.
    pub(crate) fn control(self, seconds: f64, controller: u8, value: u8) -> Self {
        self.then(seconds, 0, EventKind::Control { controller, value: f32::from(value) / 127.0 })
    }

    /// Multiplies the pitch of every note by `ratio`.
    pub(crate) fn out_of_tune(mut self, ratio: f64) -> Self {
        let semitones = sprung::units::semitones_from_ratio(ratio) as f32;
        for (_, _, kind) in &mut self.events {
            if let EventKind::NoteOn { detune, .. } = kind {
                *detune += semitones;
            }
        }
        self
    }

    /// Renders left and right in blocks of at most `block` frames.
    pub(crate) fn render(&self, block: usize) -> [Vec<f32>; 2] {
        let mut ensemble =
            Ensemble::of_kits(self.sample_rate, self.seed, &Kit::of_patch(&self.patch), self.programs.clone())
                .with_mix(&self.mix);
        // Not zero, so that samples which a block does not write are noticed.
        let [mut left, mut right] = [(); 2].map(|()| vec![f32::NAN; self.frames]);
        let mut events = self.events.iter().peekable();
        let mut in_block = Vec::new();
        let mut start = 0;
        for (left, right) in left.chunks_mut(block).zip(right.chunks_mut(block)) {
            in_block.clear();
            while let Some((frame, channel, kind)) = events.next_if(|event| event.0 < (start + left.len()) as u64) {
                in_block.push(Event { frame: (*frame - start as u64) as u32, channel: *channel, kind: *kind });
            }
            ensemble.process(&in_block, left, right);
            start += left.len();
        }
        [left, right]
    }
}
