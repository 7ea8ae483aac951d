//! A job under way: the frames that come next, on as many cores as there are channels that sound.

use super::{Job, Rendered};
use crate::engine::{Ensemble, Event};
use crate::io::song::SongEvent;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};
use std::iter::Peekable;
use std::slice;

/// From this many frames on, other cores are asked for help: handing work over takes them some microseconds, and so
/// many frames of a voice or two take some tens.
pub(super) const SHARED_FRAMES: usize = 512;

/// In a tail, silence is looked for each time that this many frames have passed since the end of the song: often
/// enough for a tight end, and at frames that do not depend on the block.
const SILENCE_INTERVAL: u64 = 64;

/// Renders a job from its start, as many frames at a time as there is room for.
pub(super) struct Stream<'a> {
    ensemble: Ensemble,
    pending: Peekable<slice::Iter<'a, SongEvent>>,
    /// Events of the frames that are being rendered.
    events: Vec<Event>,
    sample_rate: f64,
    song_frames: u64,
    known_frames: Option<u64>,
    frame: u64,
}

impl<'a> Stream<'a> {
    pub(super) fn new(job: &Job<'a>) -> Self {
        let options = &job.options;
        let sample_rate = f64::from(options.sample_rate);
        let mut ensemble = Ensemble::new(sample_rate, options.seed, job.patch, job.programs).with_chunk(options.block);
        ensemble.set_tuning(job.tuning);
        Self {
            ensemble,
            pending: job.song.events.iter().peekable(),
            events: Vec::new(),
            sample_rate,
            song_frames: job.song_frames(),
            known_frames: job.known_frames(),
            frame: 0,
        }
    }

    /// Fills both slices, which are of one length, and returns how many frames there were: fewer only at the end.
    pub(super) fn fill(&mut self, left: &mut [f32], right: &mut [f32]) -> usize {
        let mut filled = 0;
        while filled < left.len()
            && let Some(end) = self.next_end()
        {
            let frames = (end - self.frame).min((left.len() - filled) as u64) as usize;
            self.render(&mut left[filled..][..frames], &mut right[filled..][..frames]);
            filled += frames;
        }
        filled
    }

    /// The frame up to which there is sound to come for certain; none at the end.
    fn next_end(&mut self) -> Option<u64> {
        let end = match self.known_frames {
            Some(end) => end,
            None if self.frame < self.song_frames => self.song_frames,
            None => {
                let into_tail = self.frame - self.song_frames;
                let may_end = into_tail.is_multiple_of(SILENCE_INTERVAL) && self.pending.peek().is_none();
                if may_end && self.ensemble.is_silent() {
                    return None;
                }
                self.song_frames + (into_tail / SILENCE_INTERVAL + 1) * SILENCE_INTERVAL
            }
        };
        (self.frame < end).then_some(end)
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let end = self.frame + left.len() as u64;
        self.events.clear();
        while let Some(event) = self.pending.next_if(|event| event.frame(self.sample_rate) < end) {
            self.events.push(event.at(event.frame(self.sample_rate).saturating_sub(self.frame) as u32));
        }
        if left.len() < SHARED_FRAMES {
            self.ensemble.process(&self.events, left, right);
        } else {
            // One part at a time: of the few that sound, no two should wait for one core.
            let each =
                |parts: &mut [_], play: &(dyn Fn(&mut _) + Sync)| parts.par_iter_mut().with_max_len(1).for_each(play);
            self.ensemble.process_by(each, &self.events, left, right);
        }
        self.frame = end;
    }

    /// What it came to, at the end.
    pub(super) fn rendered(&self) -> Rendered {
        Rendered {
            frames: self.frame,
            tail_frames: self.frame - self.song_frames,
            voices_used: self.ensemble.voices_used(),
            limiter: self.ensemble.limiter_work(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::engine::EventKind;
    use crate::io::Song;
    use crate::io::song::SongEvent;
    use crate::params::Param;
    use crate::patch::{Mode, ModeTable, Patch};
    use crate::render::{Job, Options, Rendered, Tail, on_threads};
    use crate::sound::Tuning;

    /// Notes on all channels, which change their sounds and choke each other now and then.
    fn song() -> Song {
        let event = |n: u32| {
            let kind = match n % 8 {
                0 => EventKind::Program((n / 8 % 3) as u8),
                3 => EventKind::PitchBend((n % 5) as f32 / 5.0),
                5 => EventKind::NoteOff { key: (40 + n * 5 % 50) as u8, velocity: 0.5, id: -1 },
                _ => EventKind::NoteOn { key: (40 + n * 7 % 50) as u8, detune: 0.0, velocity: 0.8, id: -1 },
            };
            SongEvent { seconds: 0.003 * f64::from(n), channel: (n * 11 % 16) as u8, kind }
        };
        Song { events: (0..240).map(event).collect(), seconds: 0.75 }
    }

    fn render(threads: u16, block: usize, tail: Tail) -> (Rendered, Vec<u32>) {
        let short = Patch::default().with(Param::Decay, 0.3).with(Param::Release, 0.1);
        let mut rich = short.with(Param::Choke, 1.0);
        rich.modes = ModeTable::new(&[Mode { strike: 0.5, ..Mode::UNIT }; 5]);
        let programs = [short.with(Param::Choke, 2.0), rich, short.with(Param::Vibrato, 1.0)];
        let (song, mut bits) = (song(), Vec::new());
        let options = Options { sample_rate: 48_000, seed: 3, block, tail };
        let job = Job { song: &song, patch: &short, programs: &programs, tuning: &Tuning::EQUAL, options };
        let sink = |left: &[f32], right: &[f32]| {
            bits.extend(left.iter().zip(right).flat_map(|(left, right)| [left.to_bits(), right.to_bits()]));
            Ok(())
        };
        let rendered = on_threads(Some(threads), || job.render(sink)).unwrap().unwrap();
        (rendered, bits)
    }

    #[test]
    fn the_samples_do_not_depend_on_the_threads() {
        for tail in [Tail::Auto, Tail::None, Tail::Seconds(0.3)] {
            let alone = render(1, 64, tail);
            assert!(alone.1.iter().any(|bits| f32::from_bits(*bits).abs() > 0.1), "it sounds");
            for (threads, block) in [(1, 4096), (2, 4096), (3, 4096), (2, 600), (3, 65_536)] {
                assert!(render(threads, block, tail) == alone, "{threads} threads, blocks of {block}, {tail:?}");
            }
        }
    }
}
