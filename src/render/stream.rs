//! A job under way: the frames that come next, on as many cores as there are channels that sound.

use super::job::{Job, Rendered};
use crate::engine::{Ensemble, Event};
use crate::error::Result;
use crate::io::{SILENCE_INTERVAL, Song, SongCursor};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

/// From this many frames on, other cores are asked for help: handing work over takes them some microseconds, and so
/// many frames of a voice or two take some tens.
const SHARED_FRAMES: usize = 512;

impl Job<'_> {
    /// Renders from the start and hands each block, left and right, to `sink`, whose first error ends it.
    /// Memory does not grow with the length. The same job gives the same samples each time.
    ///
    /// Blocks of 512 frames and more are shared between the threads of the Rayon pool that this is called in (see
    /// [`on_threads`](super::on_threads)): channels are played side by side, and the next block while `sink` has one.
    /// The samples do not depend on it, and `sink` gets the blocks in their order.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if an option is out of range; those of `sink`.
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

/// Renders a job from its start, as many frames at a time as there is room for.
struct Stream<'a> {
    ensemble: Ensemble,
    song: SongCursor<&'a Song>,
    /// Events of the frames that are being rendered.
    events: Vec<Event>,
    known_frames: Option<u64>,
}

impl<'a> Stream<'a> {
    fn new(job: &Job<'a>) -> Self {
        let options = &job.options;
        let sample_rate = f64::from(options.sample_rate);
        let ensemble = Ensemble::of_kits(sample_rate, options.seed, job.kit, job.programs.to_vec());
        let channels = job.channels.iter();
        let mut ensemble = channels
            .fold(ensemble, |ensemble, (channel, kit)| ensemble.with_kit(*channel, kit))
            .with_chunk(options.block);
        ensemble.set_tuning(job.tuning);
        Self {
            ensemble,
            song: SongCursor::new(job.song, sample_rate),
            events: Vec::new(),
            known_frames: job.known_frames(),
        }
    }

    /// Fills both slices, which are of one length, and returns how many frames there were: fewer only at the end.
    fn fill(&mut self, left: &mut [f32], right: &mut [f32]) -> usize {
        let mut filled = 0;
        while filled < left.len()
            && let Some(end) = self.next_end()
        {
            let frames = (end - self.song.frame()).min((left.len() - filled) as u64) as usize;
            self.render(&mut left[filled..][..frames], &mut right[filled..][..frames]);
            filled += frames;
        }
        filled
    }

    /// The frame up to which there is sound to come for certain; none at the end.
    fn next_end(&self) -> Option<u64> {
        let (frame, song_frames) = (self.song.frame(), self.song.song_frames());
        let end = match self.known_frames {
            Some(end) => end,
            None if frame < song_frames => song_frames,
            None => {
                let into_tail = frame - song_frames;
                let may_end = into_tail.is_multiple_of(SILENCE_INTERVAL) && self.song.is_over();
                if may_end && self.ensemble.is_silent() {
                    return None;
                }
                song_frames + (into_tail / SILENCE_INTERVAL + 1) * SILENCE_INTERVAL
            }
        };
        (frame < end).then_some(end)
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.events.clear();
        self.song.advance(left.len(), &mut self.events);
        if left.len() < SHARED_FRAMES {
            self.ensemble.process(&self.events, left, right);
        } else {
            // One part at a time: of the few that sound, no two should wait for one core.
            let each =
                |parts: &mut [_], play: &(dyn Fn(&mut _) + Sync)| parts.par_iter_mut().with_max_len(1).for_each(play);
            self.ensemble.process_by(each, &self.events, left, right);
        }
    }

    /// What it came to, at the end.
    fn rendered(&self) -> Rendered {
        Rendered {
            frames: self.song.frame(),
            tail_frames: self.song.frame() - self.song.song_frames(),
            voices_used: self.ensemble.voices_used(),
            limiter: self.ensemble.limiter_work(),
        }
    }
}
