//! Renders a job block by block, on as many cores as there are.

use super::job::{Job, Rendered};
use super::labels::Labels;
use crate::engine::{Ensemble, Event, Stems, Workers};
use crate::error::Result;
use crate::io::{SILENCE_INTERVAL, Song, SongCursor};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

/// Other cores are used for blocks of at least this many frames. Handing work to another core takes some microseconds;
/// rendering this many frames of a voice or two takes some tens of microseconds.
const SHARED_FRAMES: usize = 512;

impl Job<'_> {
    /// Renders from the start and hands each block, left and right, to `sink`. The first error of `sink` ends the
    /// rendering. Memory use does not grow with the length. The same job always gives the same samples.
    ///
    /// For each block of what comes before [`Job::from`], `sink` gets an empty one, so that it can end the work there too.
    ///
    /// Blocks of 512 frames and more are shared between the threads of the current Rayon pool: channels and notes are rendered
    /// in parallel, and the next block is rendered while `sink` works on one. The samples do not depend on this, and `sink`
    /// receives the blocks in order.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if an option is out of range, and the errors of `sink`.
    pub fn render(&self, sink: impl FnMut(&[f32], &[f32]) -> Result<()> + Send) -> Result<Rendered> {
        self.render_labelled(None, sink)
    }

    /// The whole rendering, left and right.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if an option is out of range.
    pub fn samples(&self) -> Result<[Vec<f32>; 2]> {
        let mut sound = [vec![], vec![]];
        self.render(|left, right| {
            sound[0].extend_from_slice(left);
            sound[1].extend_from_slice(right);
            Ok(())
        })?;
        Ok(sound)
    }

    /// Like [`Job::render`], and also reads labels.
    pub(super) fn render_labelled(
        &self,
        mut labels: Option<&mut Labels>,
        mut sink: impl FnMut(&[f32], &[f32]) -> Result<()> + Send,
    ) -> Result<Rendered> {
        let mut stream = Stream::new(self, || sink(&[], &[]))?;
        if labels.is_some() {
            stream.ensemble.separate_strikes();
        }
        let block = || [vec![0.0; self.options.block], vec![0.0; self.options.block]];
        let [mut now, mut next] = [block(), block()];
        let mut fill = |stream: &mut Stream, [left, right]: &mut [Vec<f32>; 2]| match &mut labels {
            None => stream.fill(left, right),
            Some(labels) => stream.fill_labelled(labels, left, right),
        };
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

    /// Renders without the limiter, and hands each block to `sink`. Also says whether the limiter would have been on.
    pub(super) fn render_unlimited(
        &self,
        mut sink: impl FnMut(&[f32], &[f32]) -> Result<()>,
    ) -> Result<(Rendered, bool)> {
        let mut stream = Stream::new(self, || sink(&[], &[]))?;
        stream.ensemble.leave_unlimited();
        stream.each_block(self.options.block, |_, left, right| sink(left, right))?;
        Ok((stream.rendered(), stream.ensemble.is_limiter_wanted()))
    }

    /// Renders, and hands the stems of each block and its number of frames to `sink`; none for the blocks that are passed over.
    pub(super) fn render_stems(&self, mut sink: impl FnMut(Option<&Stems>, usize) -> Result<()>) -> Result<Rendered> {
        let mut stream = Stream::new(self, || sink(None, 0))?;
        stream.ensemble.keep_stems();
        stream.each_block(self.options.block, |ensemble, left, _| {
            if let Some(stems) = ensemble.stems() {
                sink(Some(stems), left.len())?;
                stems.clear();
            }
            Ok(())
        })?;
        Ok(stream.rendered())
    }
}

/// The threads of the current Rayon pool.
struct Threads;

impl Workers for Threads {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        // One at a time: only few channels sound, and two of them should not wait for the same core.
        items.par_iter_mut().with_max_len(1).for_each(&work);
    }

    fn shares_notes(&self) -> bool {
        rayon::current_num_threads() > 1
    }
}

/// Renders a job from its start, as many frames at a time as the slices have room for.
struct Stream<'a> {
    ensemble: Ensemble,
    song: SongCursor<&'a Song>,
    /// Events of the frames that are being rendered.
    events: Vec<Event>,
    /// The input sound.
    input: &'a [f32],
    /// The input frames that are being rendered, with silence after the end of the input.
    input_now: Vec<f32>,
    /// The frame of the song at which the rendering begins, and the one at which it ends, if that is known.
    first_frame: u64,
    end_frame: Option<u64>,
}

impl<'a> Stream<'a> {
    /// Advances to the first frame; `passed` is called for each block that is passed over.
    fn new(job: &Job<'a>, passed: impl FnMut() -> Result<()>) -> Result<Self> {
        job.options.check()?;
        let options = &job.options;
        let sample_rate = f64::from(options.sample_rate);
        let ensemble = Ensemble::of_kits(sample_rate, options.seed, job.kit, job.programs.to_vec());
        let channels = job.channels.iter();
        let mut ensemble = channels
            .fold(ensemble, |ensemble, (channel, kit)| ensemble.with_kit(*channel, kit))
            .with_chunk(options.block);
        if let Some(mix) = job.mix {
            ensemble = ensemble.with_mix(mix);
        }
        ensemble.set_tuning(job.tuning);
        let first_frame = job.first_frame();
        let mut stream = Self {
            ensemble,
            song: SongCursor::new(job.song, sample_rate),
            events: Vec::new(),
            input: job.input,
            input_now: Vec::new(),
            first_frame,
            end_frame: job.known_frames().map(|frames| first_frame.saturating_add(frames)),
        };
        stream.pass_over(options.block, passed)?;
        Ok(stream)
    }

    /// Advances to the first frame: obeys all messages at their frames, but leaves notes out. So controllers, programs and oscillators
    /// are there as they would be if the notes had been played.
    fn pass_over(&mut self, block: usize, mut passed: impl FnMut() -> Result<()>) -> Result<()> {
        let [mut left, mut right] = [vec![0.0; block], vec![0.0; block]];
        self.ensemble.leave_out_notes(true);
        while self.song.frame() < self.first_frame {
            let frames = (self.first_frame - self.song.frame()).min(block as u64) as usize;
            self.events.clear();
            self.song.advance(frames, &mut self.events);
            self.ensemble.process(&self.events, &mut left[..frames], &mut right[..frames]);
            passed()?;
        }
        self.ensemble.leave_out_notes(false);
        Ok(())
    }

    /// Renders to the end, and hands the ensemble and its output to `visit` after each block of up to so many frames.
    fn each_block(
        &mut self,
        frames: usize,
        mut visit: impl FnMut(&mut Ensemble, &[f32], &[f32]) -> Result<()>,
    ) -> Result<()> {
        let [mut left, mut right] = [vec![0.0; frames], vec![0.0; frames]];
        loop {
            match self.fill(&mut left, &mut right) {
                0 => return Ok(()),
                frames => visit(&mut self.ensemble, &left[..frames], &right[..frames])?,
            }
        }
    }

    /// Fills both slices, which have the same length, and returns the number of frames. It is smaller than their length
    /// only at the end.
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

    /// Like [`Stream::fill`], and also reads labels; to be used from the start on. The samples are the same.
    fn fill_labelled(&mut self, labels: &mut Labels, left: &mut [f32], right: &mut [f32]) -> usize {
        let mut filled = 0;
        while filled < left.len() {
            let piece = labels.piece(left.len() - filled);
            let frames = self.fill(&mut left[filled..][..piece], &mut right[filled..][..piece]);
            labels.read(&mut self.ensemble, frames);
            filled += frames;
            if frames < piece {
                break;
            }
        }
        filled
    }

    /// The frame up to which the rendering certainly continues; `None` at the end.
    fn next_end(&self) -> Option<u64> {
        let (frame, song_frames) = (self.song.frame(), self.song.song_frames());
        let end = match self.end_frame {
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
        self.follow_input(left.len());
        self.song.advance(left.len(), &mut self.events);
        if left.len() < SHARED_FRAMES {
            self.ensemble.process_with_input(&self.events, &self.input_now, left, right);
        } else {
            self.ensemble.process_by(&Threads, &self.events, &self.input_now, left, right);
        }
    }

    /// Takes the next frames of the input. After its end, the input is silence, as in a host: notes with a silent input
    /// are computed in other steps than notes without an input, so that their bits would differ.
    fn follow_input(&mut self, frames: usize) {
        self.input_now.clear();
        if !self.input.is_empty() {
            let from = usize::try_from(self.song.frame()).unwrap_or(usize::MAX);
            self.input_now.extend(self.input.iter().skip(from).take(frames));
            self.input_now.resize(frames, 0.0);
        }
    }

    /// The result, to be called at the end.
    fn rendered(&self) -> Rendered {
        Rendered {
            frames: self.song.frame() - self.first_frame,
            tail_frames: self.song.frame() - self.song.song_frames().max(self.first_frame),
            voices_used: self.ensemble.voices_used(),
            limiter: self.ensemble.limiter_work(),
        }
    }
}
