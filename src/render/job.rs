//! What there is to render and how, and what it came to.

use crate::dsp::limiter::Work as LimiterWork;
use crate::engine::synth::SAMPLE_RATES;
use crate::error::{Error, Result};
use crate::io::Song;
use crate::io::song;
use crate::sound::{Kit, Tuning};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Lengths that a block can have, in frames.
pub const BLOCKS: RangeInclusive<usize> = 1..=65_536;

/// How long rendering goes on after the end of the song.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// Until nothing sounds.
    Auto,
    /// Not at all.
    None,
    /// For this many seconds.
    Seconds(f64),
}

/// How to render.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Frames per second, within [`SAMPLE_RATES`].
    pub sample_rate: u32,
    /// Seed of all randomness.
    pub seed: u64,
    /// Frames per block, within [`BLOCKS`]. The samples do not depend on it.
    pub block: usize,
    /// What follows the song.
    pub tail: Tail,
}

/// What to render: a song, the kits that play it, and how.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The events, in order of their times.
    pub song: &'a Song,
    /// What every channel starts with that is not among `channels`.
    pub kit: &'a Arc<Kit>,
    /// What single channels, 0–15, start with; the last of several for one channel counts.
    pub channels: &'a [(u8, Arc<Kit>)],
    /// What program changes choose from.
    pub programs: &'a [Arc<Kit>],
    /// The pitches of the keys, on all channels.
    pub tuning: &'a Tuning,
    /// How.
    pub options: Options,
}

/// What a rendering came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rendered {
    /// Length in frames.
    pub frames: u64,
    /// How much of it is tail, in frames.
    pub tail_frames: u64,
    /// Most voices that sounded at once on each channel, added up over channels: at least as many as ever sounded at
    /// once on all of them together.
    pub voices_used: usize,
    /// How much the limiter worked.
    pub limiter: LimiterWork,
}

impl Job<'_> {
    /// Length of the song alone, in frames.
    pub fn song_frames(&self) -> u64 {
        self.song.frames(self.options.sample_rate.into())
    }

    /// Length of the rendering in frames, unless it depends on the sound ([`Tail::Auto`]).
    pub fn known_frames(&self) -> Option<u64> {
        match self.options.tail {
            Tail::Auto => None,
            Tail::None => Some(self.song_frames()),
            Tail::Seconds(tail) => {
                Some(self.song_frames().saturating_add(song::frames(tail, self.options.sample_rate.into())))
            }
        }
    }
}

impl Options {
    /// Whether it can be rendered so.
    pub(super) fn check(&self) -> Result<()> {
        let range = |name, value: String, low: String, high: String| {
            Err(Error::value(name, format!("{value} is out of range: expected {low} to {high}")))
        };
        if !SAMPLE_RATES.contains(&self.sample_rate) {
            let (low, high) = SAMPLE_RATES.into_inner();
            return range("rate", self.sample_rate.to_string(), low.to_string(), high.to_string());
        }
        if !BLOCKS.contains(&self.block) {
            let (low, high) = BLOCKS.into_inner();
            return range("block", self.block.to_string(), low.to_string(), high.to_string());
        }
        Ok(())
    }
}
