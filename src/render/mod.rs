//! The offline renderer: songs to samples, block by block, as fast as the machine can.

pub mod meter;
mod stream;
mod threads;
mod wav;

pub use crate::dsp::limiter::Work as LimiterWork;
pub use crate::engine::synth::SAMPLE_RATES;
pub use meter::{Levels, Meter};
pub use threads::{THREADS, on_threads};
pub use wav::{Delivery, Level, Progress, Report, to_wav};

use crate::error::{Error, Result};
use crate::io::Song;
use crate::io::song;
use crate::patch::Patch;
use crate::sound::Tuning;
use std::ops::RangeInclusive;
use stream::{SHARED_FRAMES, Stream};

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

/// What to render: a song, the sounds that play it, and how.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The events, in order of their times.
    pub song: &'a Song,
    /// The sound that every channel starts with.
    pub patch: &'a Patch,
    /// The sounds that program changes choose from.
    pub programs: &'a [Patch],
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

    /// Renders from the start and hands each block, left and right, to `sink`, whose first error ends it.
    /// Memory does not grow with the length. The same job gives the same samples each time.
    ///
    /// Blocks of 512 frames and more are shared between the threads of the Rayon pool that this is called in (see
    /// [`on_threads`]): channels are played side by side, and the next block while `sink` has one. The samples do not
    /// depend on it, and `sink` gets the blocks in their order.
    ///
    /// # Errors
    /// [`Error::Value`] if an option is out of range; those of `sink`.
    pub fn render(&self, mut sink: impl FnMut(&[f32], &[f32]) -> Result<()> + Send) -> Result<Rendered> {
        self.options.check()?;
        let mut stream = Stream::new(self);
        let block = || [vec![0.0; self.options.block], vec![0.0; self.options.block]];
        let [mut now, mut next] = [block(), block()];
        let fill = |stream: &mut Stream, [left, right]: &mut [Vec<f32>; 2]| stream.fill(left, right);
        let mut frames = fill(&mut stream, &mut now);
        while frames > 0 {
            let [left, right] = &now;
            let mut deliver = || sink(&left[..frames], &right[..frames]);
            let mut render = || fill(&mut stream, &mut next);
            let (delivered, rendered) =
                if self.options.block < SHARED_FRAMES { (deliver(), render()) } else { rayon::join(deliver, render) };
            delivered?;
            frames = rendered;
            std::mem::swap(&mut now, &mut next);
        }
        Ok(stream.rendered())
    }
}

impl Options {
    fn check(&self) -> Result<()> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;

    fn options(sample_rate: u32, block: usize, tail: Tail) -> Options {
        Options { sample_rate, seed: 0, block, tail }
    }

    fn render(song: &Song, options: Options) -> (Rendered, Vec<f32>) {
        let patch = Patch::default().with(Param::Decay, 0.2).with(Param::Release, 0.05);
        let mut samples = Vec::new();
        let job = Job { song, patch: &patch, programs: &[], tuning: &Tuning::EQUAL, options };
        let rendered = job
            .render(|left, right| {
                assert!(left.len() <= options.block && left.len() == right.len());
                samples.extend(left);
                Ok(())
            })
            .unwrap();
        assert_eq!(rendered.frames, samples.len() as u64);
        (rendered, samples)
    }

    #[test]
    fn lengths_are_exact() {
        let song = Song::chord(&[60.0], 1.0, 0.125);
        for (rate, tail, frames, tail_frames) in [
            (44_100, Tail::None, 5513, 0),
            (48_000, Tail::None, 6000, 0),
            (8_000, Tail::Seconds(0.25), 3000, 2000),
            (768_000, Tail::Seconds(0.0), 96_000, 0),
        ] {
            for block in [1000, 65_536] {
                let (rendered, _) = render(&song, options(rate, block, tail));
                assert_eq!((rendered.frames, rendered.tail_frames), (frames, tail_frames), "{rate} {tail:?}");
            }
        }
        assert_eq!(render(&Song::default(), options(48_000, 1, Tail::Auto)).0.frames, 0);
    }

    #[test]
    fn an_auto_tail_ends_in_silence_at_a_frame_that_does_not_depend_on_the_block() {
        let song = Song::chord(&[60.0, 67.5], 1.0, 0.1);
        let (whole, samples) = render(&song, options(48_000, 65_536, Tail::Auto));
        for block in [1, 7, 64, 480] {
            let (rendered, other) = render(&song, options(48_000, block, Tail::Auto));
            assert_eq!(rendered, whole, "{block}");
            assert!(samples.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()), "{block}");
        }
        assert_eq!(whole.voices_used, 2);
        assert!(samples.iter().any(|sample| sample.abs() > 0.01), "it sounds");
        assert!(samples[samples.len() - 10..].iter().all(|sample| sample.abs() < 1e-5), "to its end");
        assert!((1000..48_000).contains(&whole.tail_frames), "{whole:?}");
    }

    #[test]
    fn options_out_of_range_and_errors_of_the_sink_end_it() {
        let song = Song::chord(&[60.0], 1.0, 0.125);
        let patch = Patch::default();
        for options in [options(0, 64, Tail::None), options(48_000, 0, Tail::None), options(48_000, 65_537, Tail::None)]
        {
            let job = Job { song: &song, patch: &patch, programs: &[], tuning: &Tuning::EQUAL, options };
            assert!(matches!(job.render(|_, _| Ok(())), Err(Error::Value { .. })));
        }
        let job = Job {
            song: &song,
            patch: &patch,
            programs: &[],
            tuning: &Tuning::EQUAL,
            options: options(48_000, 64, Tail::None),
        };
        let mut blocks = 0;
        let result = job.render(|_, _| {
            blocks += 1;
            if blocks == 3 { Err(Error::Interrupted) } else { Ok(()) }
        });
        assert!(matches!(result, Err(Error::Interrupted)));
        assert_eq!(blocks, 3);
    }
}
