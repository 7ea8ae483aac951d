//! Exact labels of a rendering: each note's onset, and the frequency, T60 and level of each of its modes.

use super::job::Job;
use super::stream::Stream;
use crate::dsp::CONTROL_FRAMES;
use crate::engine::{EventKind, Struck, StruckMode};
use crate::error::Result;
use crate::units::{db_from_gain, note_name};
use std::collections::{BTreeMap, BTreeSet};

/// Frames that are rendered at a time while no strike is under way.
const STEP: usize = 4096;

/// A mode of a note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeLabel {
    /// Hz, at rest: without what bends it for a while, as sweep, glide, vibrato, wheels and tension do.
    pub frequency: f64,
    /// T60 in seconds after the strike, before a release damps it.
    pub t60: f64,
    /// Amplitude in dB of full scale at [`NoteLabel::free`], with the gains of sound, note, channel and mix; before the pan
    /// of single modes, the effects and the limiter. −∞ for a mode at rest.
    pub level_db: f64,
}

/// A note, or one of its unison voices.
#[derive(Clone, Debug, PartialEq)]
pub struct NoteLabel {
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// MIDI key, 0–127.
    pub key: u8,
    /// Offset from the key's pitch in semitones.
    pub detune: f32,
    /// 0–1.
    pub velocity: f32,
    /// Which of the note's unison voices it is, from 0.
    pub unison: usize,
    /// The frame at which it is struck.
    pub onset: u64,
    /// The frame at which levels are taken: mallet, pluck and noise have let go, and the modes ring freely unless a bow or
    /// input drives them.
    pub free: u64,
    /// Its modes, in the order of the sound's table.
    pub modes: Vec<ModeLabel>,
}

impl NoteLabel {
    /// The name of its key.
    pub fn name(&self) -> String {
        note_name(self.key)
    }
}

impl Job<'_> {
    /// The labels of all notes, in order of their onsets. They are read from the engine while it plays the job, so they are
    /// as exact as its state. Plays only as far as the last strike. Allocates.
    ///
    /// # Errors
    /// As [`Job::render`].
    pub fn labels(&self) -> Result<Vec<NoteLabel>> {
        self.options.check()?;
        let sample_rate = f64::from(self.options.sample_rate);
        let mut events = self.song.events.iter().map(|event| event.frame(sample_rate)).peekable();
        let is_strike = |kind: &EventKind| matches!(kind, EventKind::NoteOn { .. } | EventKind::Strike { .. });
        let strikes = self.song.events.iter().filter(|event| is_strike(&event.kind));
        let Some(last) = strikes.map(|event| event.frame(sample_rate)).max() else { return Ok(Vec::new()) };
        let mut stream = Stream::new(self);
        let [mut left, mut right] = [vec![0.0; STEP], vec![0.0; STEP]];
        let (mut labels, mut frame) = (Labels::default(), 0);
        while frame <= last || labels.has_open() {
            // A piece begins with an event or ends before the next, and is short if it may begin with a strike, so that a
            // label is read before anything changes the note.
            let mut piece = if labels.has_open() { CONTROL_FRAMES } else { STEP };
            while events.next_if(|event| *event <= frame).is_some() {
                piece = CONTROL_FRAMES;
            }
            if let Some(next) = events.peek() {
                piece = piece.min(usize::try_from(next - frame).unwrap_or(STEP));
            }
            if stream.fill(&mut left[..piece], &mut right[..piece]) < piece {
                break;
            }
            let start = frame;
            frame += piece as u64;
            let gain = stream.ensemble().gain();
            stream.ensemble().each_struck(&mut |part, struck| labels.look(part, &struck, gain, [start, frame]));
        }
        Ok(labels.finish())
    }
}

/// Labels in the making.
#[derive(Default)]
struct Labels {
    /// By the number of the part, of the note and of the unison voice.
    all: BTreeMap<(usize, u64, usize), NoteLabel>,
    /// Of these, the ones whose strike is under way.
    open: BTreeSet<(usize, u64, usize)>,
}

impl Labels {
    fn has_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Looks at a voice of a part after the frames of a piece. `gain` is that of the mix.
    fn look(&mut self, part: usize, struck: &Struck, gain: f32, piece: [u64; 2]) {
        let note = struck.note();
        let id = (part, note.serial, struck.unison());
        if self.all.contains_key(&id) && !self.open.contains(&id) {
            return;
        }
        let level = |amplitude: f64| db_from_gain(amplitude * f64::from(gain));
        let label = self.all.entry(id).or_insert_with(|| {
            let mode = |mode: StruckMode| ModeLabel { frequency: mode.frequency, t60: mode.t60, level_db: 0.0 };
            NoteLabel {
                channel: note.channel,
                key: note.key,
                detune: note.detune,
                velocity: note.velocity,
                unison: id.2,
                onset: piece[0],
                free: piece[1],
                modes: struck.modes().map(mode).collect(),
            }
        });
        label.free = piece[1];
        let levels = label.modes.iter_mut().zip(struck.modes());
        levels.for_each(|(label, mode)| label.level_db = level(mode.amplitude));
        if struck.is_being_struck() {
            self.open.insert(id);
        } else {
            self.open.remove(&id);
        }
    }

    /// All labels. Voices that were silenced during their strike have the levels that they had last.
    fn finish(self) -> Vec<NoteLabel> {
        let mut labels: Vec<NoteLabel> = self.all.into_values().collect();
        labels.sort_by_key(|label| (label.onset, label.channel));
        labels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::Song;
    use crate::params::Param;
    use crate::patch::{Mode, ModeTable, Patch};
    use crate::render::{Options, Tail};
    use crate::sound::Kit;

    const OPTIONS: Options = Options { sample_rate: 48_000, seed: 0, block: 256, tail: Tail::None };

    fn labels(patch: &Patch, keys: &[f64]) -> Vec<NoteLabel> {
        let song = Song::chord(keys, 1.0, 1.0);
        Job::new(&song, &Kit::of_patch(patch), OPTIONS).labels().unwrap()
    }

    #[test]
    fn an_impulse_has_the_levels_of_the_table() {
        let high = Mode { ratio: 2.5, level: 0.5, decay: 0.5, ..Mode::UNIT };
        let mut patch = Patch::default().with(Param::Decay, 2.0).with(Param::Gain, -6.0);
        patch.modes = ModeTable::new(&[Mode::UNIT, high]);
        let labels = labels(&patch, &[69.0, 81.0]);
        assert_eq!(labels.iter().map(|label| label.key).collect::<Vec<_>>(), [69, 81]);
        for (label, pitch) in labels.iter().zip([440.0, 880.0]) {
            assert_eq!((label.onset, label.channel, label.unison), (0, 0, 0));
            let passed = label.free as f64 / 48_000.0;
            for (mode, (ratio, level_db, decay)) in label.modes.iter().zip([(1.0, -6.0, 2.0), (2.5, -12.0206, 1.0)]) {
                assert!((mode.frequency / (pitch * ratio) - 1.0).abs() < 1e-12, "{mode:?}");
                assert_eq!(mode.t60, decay);
                assert!((mode.level_db - (level_db - 60.0 * passed / decay)).abs() < 0.01, "{mode:?} {passed}");
            }
        }
    }

    #[test]
    fn a_strike_is_waited_for_and_a_release_is_not() {
        let noisy = Patch::default().with(Param::NoiseLevel, 0.0).with(Param::NoiseTime, 0.1);
        let [long] = labels(&noisy, &[60.0]).try_into().unwrap();
        assert!((4800..4900).contains(&long.free), "{}", long.free);
        let song = Song::chord(&[60.0], 1.0, 0.0005);
        let patch = Patch::default().with(Param::Decay, 3.0).with(Param::Release, 0.05);
        let labels = Job::new(&song, &Kit::of_patch(&patch), OPTIONS).labels().unwrap();
        assert_eq!(labels[0].modes[0].t60, 3.0);
    }

    #[test]
    fn late_notes_are_labelled_at_their_frames() {
        let mut song = Song::chord(&[60.0], 1.0, 0.1);
        let again =
            song.events.clone().into_iter().map(|event| crate::io::SongEvent { seconds: event.seconds + 0.5, ..event });
        song.events.extend(again.collect::<Vec<_>>());
        song.seconds = 1.0;
        let labels = Job::new(&song, &Kit::of_patch(&Patch::default()), OPTIONS).labels().unwrap();
        assert_eq!(labels.iter().map(|label| label.onset).collect::<Vec<_>>(), [0, 24_000]);
    }
}
