//! A rendering job with its options, and the result of a rendering.

use crate::dsp::limiter::Work as LimiterWork;
use crate::engine::synth::check_rate;
use crate::error::{Error, Result};
use crate::io::Song;
use crate::io::song;
use crate::sound::{Kit, Mix, Tuning};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Range of block lengths, in frames.
pub const BLOCKS: RangeInclusive<usize> = 1..=65_536;

/// How long the rendering continues after the end of the song.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// Until nothing sounds.
    Auto,
    /// Not at all: the rendering ends with the song.
    None,
    /// For this many seconds.
    Seconds(f64),
}

/// Options of a rendering.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Frames per second, within [`SAMPLE_RATES`](super::SAMPLE_RATES).
    pub sample_rate: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Frames per block, within [`BLOCKS`]. The samples do not depend on the block length.
    pub block: usize,
    /// The tail after the song.
    pub tail: Tail,
}

impl Default for Options {
    /// As the command has them: 48 kHz, the seed 0, until nothing sounds.
    fn default() -> Self {
        Self { sample_rate: 48_000, seed: 0, block: 4096, tail: Tail::Auto }
    }
}

/// A rendering job: a song, the kits that play it, and options.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The events, in order of their times.
    pub song: &'a Song,
    /// The initial kit of every channel that is not in `channels`.
    pub kit: &'a Arc<Kit>,
    /// Initial kits of single channels, 0–15. If a channel occurs several times, the last one counts.
    pub channels: &'a [(u8, Arc<Kit>)],
    /// The kits that program changes select from.
    pub programs: &'a [Arc<Kit>],
    /// The mix of the channels; with none, they are only added.
    pub mix: Option<&'a Mix>,
    /// The pitches of the keys, on all channels.
    pub tuning: &'a Tuning,
    /// Input sound from the first frame on, at the sample rate of the options. It drives the notes of sounds whose
    /// input level is above the minimum. Empty for none.
    pub input: &'a [f32],
    /// Seconds at the beginning of the song that are not rendered. All messages in them are obeyed, but no note is played.
    pub from: f64,
    /// The options.
    pub options: Options,
}

/// The result of a rendering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rendered {
    /// Length in frames.
    pub frames: u64,
    /// Length of the tail, which is part of `frames`, in frames.
    pub tail_frames: u64,
    /// The maximum number of simultaneous voices of each channel, added up over all channels: an upper bound of the
    /// number of voices that sounded at the same time.
    pub voices_used: usize,
    /// Gain reduction by the limiter.
    pub limiter: LimiterWork,
}

impl<'a> Job<'a> {
    /// A song that one kit plays on all channels, at equal temperament, without program changes and without input.
    pub fn new(song: &'a Song, kit: &'a Arc<Kit>, options: Options) -> Self {
        Self {
            song,
            kit,
            channels: &[],
            programs: &[],
            mix: None,
            tuning: &Tuning::EQUAL,
            input: &[],
            from: 0.0,
            options,
        }
    }

    /// Length of the song alone, in frames, from the place on at which the rendering begins.
    pub fn song_frames(&self) -> u64 {
        self.song.frames(self.options.sample_rate.into()).saturating_sub(self.first_frame())
    }

    /// Length of the rendering in frames, as far as it is certain before: of the song alone if the rest depends on the sound.
    pub fn least_frames(&self) -> u64 {
        self.known_frames().unwrap_or(self.song_frames())
    }

    /// The frame of the song at which the rendering begins.
    pub(super) fn first_frame(&self) -> u64 {
        song::frames(self.from, self.options.sample_rate.into())
    }

    /// Frames that a block of so many stands for in the progress: an empty one is a block that was passed over.
    pub(super) fn counted(&self, frames: usize) -> u64 {
        if frames == 0 { self.options.block as u64 } else { frames as u64 }
    }

    /// Length of the rendering in frames, unless it depends on the sound ([`Tail::Auto`]).
    pub(crate) fn known_frames(&self) -> Option<u64> {
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
    /// Returns an error if an option is out of range.
    pub(super) fn check(&self) -> Result<()> {
        check_rate(self.sample_rate).map_err(|message| Error::value("rate", message))?;
        if !BLOCKS.contains(&self.block) {
            let (low, high) = BLOCKS.into_inner();
            let message = format!("{} is out of range: expected {low} to {high}", self.block);
            return Err(Error::value("block", message));
        }
        Ok(())
    }
}
