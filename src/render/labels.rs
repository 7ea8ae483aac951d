//! Exact labels of a rendering: each note's onset, and the frequency, T60 and level of each of its modes.
//!
//! The engine is read while it plays, in pieces that end after a strike has let go. Since the samples do not depend on
//! blocks, the sound is the same with and without labels.

use super::job::Job;
use crate::dsp::CONTROL_FRAMES;
use crate::engine::{Ensemble, ModeState, VoiceState};
use crate::units::db_from_gain;
use std::collections::{BTreeMap, BTreeSet};

/// A mode of a note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeLabel {
    /// Frequency in Hz without temporary changes of pitch by sweep, glide, vibrato, wheels or tension.
    pub frequency: f64,
    /// T60 in seconds after the strike, without the damping by a release.
    pub t60: f64,
    /// Amplitude in dBFS at [`NoteLabel::free`], with the gains of sound, note, channel and mix, but without the pan of
    /// single modes, the effects and the limiter. −∞ for a mode at rest.
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
    /// The frame of the strike.
    pub onset: u64,
    /// The frame at which the levels are measured: mallet, pluck and noise have ended, and the modes ring freely unless
    /// a bow or input drives them.
    pub free: u64,
    /// Its modes, in the order of the sound's table.
    pub modes: Vec<ModeLabel>,
}

/// Reads labels from the engine's state while it plays a job, so that they are exact.
pub(super) struct Labels {
    /// The frames of the song's remaining events; the next one is last.
    events: Vec<u64>,
    frame: u64,
    /// All labels, by the numbers of the part, of the note and of the unison voice.
    all: BTreeMap<(usize, u64, usize), NoteLabel>,
    /// Of these, the ones whose strike has not ended.
    open: BTreeSet<(usize, u64, usize)>,
}

impl Labels {
    /// For a job that has not begun.
    pub(super) fn new(job: &Job) -> Self {
        let sample_rate = f64::from(job.options.sample_rate);
        let events = job.song.events.iter().rev().map(|event| event.frame(sample_rate)).collect();
        Self { events, frame: 0, all: BTreeMap::new(), open: BTreeSet::new() }
    }

    /// Length of the next piece to play, at most `most` frames. It ends before the next event, and is short if a strike
    /// may begin or is in progress, so that a label is read before the note changes.
    pub(super) fn piece(&mut self, most: usize) -> usize {
        let mut piece = most;
        if self.pass_events() || !self.open.is_empty() {
            piece = piece.min(CONTROL_FRAMES);
        }
        match self.events.last() {
            Some(next) => piece.min(usize::try_from(next - self.frame).unwrap_or(piece)),
            None => piece,
        }
    }

    /// Reads the voices after a piece was played.
    pub(super) fn read(&mut self, ensemble: &mut Ensemble, frames: usize) {
        let piece = [self.frame, self.frame + frames as u64];
        self.frame = piece[1];
        let gain = ensemble.gain();
        // Voices that do not appear again were silenced during their strike.
        let open = std::mem::take(&mut self.open);
        ensemble.each_voice(&mut |part, voice| self.look(part, &voice, gain, piece, &open));
    }

    /// Drops the events up to the present frame. Returns whether there were any.
    fn pass_events(&mut self) -> bool {
        let before = self.events.len();
        while self.events.pop_if(|event| *event <= self.frame).is_some() {}
        self.events.len() < before
    }

    /// Reads a voice of a part after a piece was played. `gain` is that of the mix; `open` has the voices whose strike
    /// had not ended before.
    fn look(
        &mut self,
        part: usize,
        voice: &VoiceState,
        gain: f32,
        piece: [u64; 2],
        open: &BTreeSet<(usize, u64, usize)>,
    ) {
        let note = voice.note();
        let id = (part, note.serial, voice.unison());
        if self.all.contains_key(&id) && !open.contains(&id) {
            return;
        }
        let level = |amplitude: f64| db_from_gain(amplitude * f64::from(gain));
        let label = self.all.entry(id).or_insert_with(|| {
            let mode = |mode: ModeState| ModeLabel { frequency: mode.frequency, t60: mode.t60, level_db: 0.0 };
            NoteLabel {
                channel: note.channel,
                key: note.key,
                detune: note.detune,
                velocity: note.velocity,
                unison: id.2,
                onset: piece[0],
                free: piece[1],
                modes: voice.modes().map(mode).collect(),
            }
        });
        label.free = piece[1];
        let levels = label.modes.iter_mut().zip(voice.modes());
        levels.for_each(|(label, mode)| label.level_db = level(mode.amplitude));
        if voice.is_being_struck() {
            self.open.insert(id);
        }
    }

    /// All labels, in order of their onsets. Voices that were silenced during their strike have their last levels.
    pub(super) fn finish(self) -> Vec<NoteLabel> {
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

    /// The labels of a song. Reading them changes no sample.
    fn of(song: &Song, patch: &Patch) -> Vec<NoteLabel> {
        let kit = Kit::of_patch(patch);
        let job = Job::new(song, &kit, OPTIONS);
        let render = |labels: Option<&mut Labels>| {
            let mut samples = Vec::new();
            let sink = |left: &[f32], right: &[f32]| {
                samples.extend(left.iter().chain(right).map(|sample| sample.to_bits()));
                Ok(())
            };
            job.render_labelled(labels, sink).unwrap();
            samples
        };
        let mut labels = Labels::new(&job);
        assert!(render(Some(&mut labels)) == render(None));
        labels.finish()
    }

    fn labels(patch: &Patch, keys: &[f64]) -> Vec<NoteLabel> {
        let song = Song::chord(keys, 1.0, 1.0);
        of(&song, patch)
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
        let noisy =
            Patch::default().with(Param::NoiseLevel, 0.0).with(Param::NoiseReach, 100.0).with(Param::NoiseTime, 0.1);
        let [long] = labels(&noisy, &[60.0]).try_into().unwrap();
        assert!((4800..4900).contains(&long.free), "{}", long.free);
        let song = Song::chord(&[60.0], 1.0, 0.0005);
        let patch = Patch::default().with(Param::Decay, 3.0).with(Param::Release, 0.05);
        let labels = of(&song, &patch);
        assert_eq!(labels[0].modes[0].t60, 3.0);
    }

    #[test]
    fn a_voice_that_is_silenced_during_its_strike_is_waited_for_no_longer() {
        use crate::engine::{EventKind, Notes};
        let mut song = Song::chord(&[60.0], 1.0, 0.5);
        let kind = EventKind::Silence { notes: Notes::default() };
        song.events.insert(1, crate::io::SongEvent { seconds: 0.01, channel: 0, kind });
        let patch =
            Patch::default().with(Param::NoiseLevel, 0.0).with(Param::NoiseReach, 100.0).with(Param::NoiseTime, 0.4);
        let kit = Kit::of_patch(&patch);
        let job = Job::new(&song, &kit, OPTIONS);
        let mut labels = Labels::new(&job);
        job.render_labelled(Some(&mut labels), |_, _| Ok(())).unwrap();
        assert!(labels.open.is_empty(), "{:?}", labels.open);
        let [label] = labels.finish().try_into().unwrap();
        assert!((480..4800).contains(&label.free), "{}", label.free);
    }

    #[test]
    fn late_notes_are_labelled_at_their_frames() {
        let mut song = Song::chord(&[60.0], 1.0, 0.1);
        let again =
            song.events.clone().into_iter().map(|event| crate::io::SongEvent { seconds: event.seconds + 0.5, ..event });
        song.events.extend(again.collect::<Vec<_>>());
        song.seconds = 1.0;
        let labels = of(&song, &Patch::default());
        assert_eq!(labels.iter().map(|label| label.onset).collect::<Vec<_>>(), [0, 24_000]);
    }
}
