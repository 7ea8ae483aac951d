//! Renders a song as a loop without a seam: what sounds on after its end is added to its beginning.
//!
//! The song is folded before the limiter, since a sum can need it where its parts do not. Then the limiter plays the loop twice, and
//! the second round is the result: so its gain at the beginning is the one that the end leaves.

use super::job::{Job, Rendered, Tail};
use super::labels::Labels;
use super::wav::{Delivery, Progress, Report, Sink, Source, write};
use crate::dsp::Limiter;
use crate::error::{Error, Result};
use crate::io::Output;
use std::time::Instant;

/// A song that goes round. It is held in memory: 8 bytes a frame.
struct Looped<'a> {
    job: &'a Job<'a>,
    sound: [Vec<f32>; 2],
    rendered: Rendered,
}

/// Frames of the pieces in which the limiter plays the first round, so that no second copy of the whole is needed.
const FIRST_ROUND_FRAMES: usize = 4096;

/// As [`to_wav`](super::wav::to_wav), but as a loop of the song's length, with loop points for samplers.
///
/// # Errors
/// As [`to_wav`](super::wav::to_wav), and [`Error::Value`] for a song without length or a job without a tail, whose end cannot join its
/// beginning.
pub fn to_looped_wav(
    job: &Job,
    delivery: &Delivery,
    output: &mut Output,
    mut progress: impl FnMut(Progress) -> Result<()> + Send,
) -> Result<Report> {
    let started = Instant::now();
    let looped = Looped::new(job, &mut progress)?;
    write(&looped, delivery, output, None, started, progress)
}

impl<'a> Looped<'a> {
    fn new(job: &'a Job<'a>, progress: &mut impl FnMut(Progress) -> Result<()>) -> Result<Self> {
        if job.options.tail == Tail::None {
            return Err(Error::value(
                "--loop",
                "what sounds on goes into the beginning: expected it without --tail none",
            ));
        }
        let frames = usize::try_from(job.song_frames()).unwrap_or(usize::MAX);
        let too_long = |_| Error::value("--loop", "the song is too long to be held in memory");
        let mut sound = [Vec::new(), Vec::new()];
        for side in &mut sound {
            side.try_reserve_exact(frames).map_err(too_long)?;
            side.resize(frames, 0.0);
        }
        if frames == 0 {
            return Err(Error::value("--loop", "the song has no length: expected one that lasts"));
        }
        let (mut at, mut done) = (0, 0);
        let (mut rendered, is_limited) = job.render_unlimited(|left, right| {
            for (sound, block) in sound.iter_mut().zip([left, right]) {
                let mut at = at;
                for sample in block {
                    sound[at] += sample;
                    at = if at + 1 == frames { 0 } else { at + 1 };
                }
            }
            at = (at + left.len()) % frames;
            done += job.counted(left.len());
            let expected = 2 * frames as u64 + job.first_frame();
            progress(Progress { frames: done, expected: expected.max(done) })
        })?;
        let [left, right] = &mut sound;
        let mut limiter = Limiter::new(job.options.sample_rate.into());
        for (left, right) in left.chunks(FIRST_ROUND_FRAMES).zip(right.chunks(FIRST_ROUND_FRAMES)) {
            limiter.process(is_limited, &mut left.to_vec(), &mut right.to_vec());
        }
        let before = limiter.work();
        limiter.process(is_limited, left, right);
        rendered.limiter = limiter.work();
        rendered.limiter.frames -= before.frames;
        rendered.limiter.non_finite -= before.non_finite;
        (rendered.frames, rendered.tail_frames) = (frames as u64, 0);
        Ok(Self { job, sound, rendered })
    }
}

impl Source for Looped<'_> {
    fn job(&self) -> &Job<'_> {
        self.job
    }

    fn known_frames(&self) -> Option<u64> {
        Some(self.rendered.frames)
    }

    fn is_loop(&self) -> bool {
        true
    }

    fn play(&self, _: Option<&mut Labels>, sink: &mut Sink) -> Result<Rendered> {
        let [left, right] = self.sound.each_ref().map(|side| side.chunks(self.job.options.block));
        for (left, right) in left.zip(right) {
            sink(left, right)?;
        }
        Ok(self.rendered)
    }
}
