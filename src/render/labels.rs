//! Exact labels of a rendering: each note's onset, and the frequency, T60 and level of each of its modes.
//!
//! The engine is read while it plays, in pieces that end after a strike has let go. Since the samples do not depend on
//! blocks, the sound is the same with and without labels.

use super::job::Job;
use crate::dsp::CONTROL_FRAMES;
use crate::engine::{Ensemble, ModeState, Note, VoiceState};
use crate::units::db_from_gain;
use std::cmp::Reverse;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

/// A mode of a note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModeLabel {
    /// Frequency in Hz without temporary changes of pitch by sweep, glide, vibrato, wheels or tension.
    pub frequency: f64,
    /// T60 in seconds after the strike, without the damping by a release.
    pub t60: f64,
    /// Amplitude in dBFS at [`NoteLabel::free`], with the gains of sound, note, channel and mix, but without the pan of
    /// single modes, the effects and the limiter. −∞ for a mode at rest. If the note's voice was already sounding, it is the
    /// amplitude that this strike alone has added, as if the voice had been at rest. A legato note is not struck: its levels are
    /// those of the voice that it takes over.
    pub level_db: f64,
}

/// A note, or one of its unison voices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoteLabel {
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

/// The numbers of a label's part, of its note and of its unison voice.
type Id = (usize, u64, usize);

/// Reads labels from the engine's state while it plays a job, so that they are exact.
pub(super) struct Labels {
    /// The frames of the song's remaining events and of its end; the next one is last.
    events: Vec<u64>,
    frame: u64,
    all: BTreeMap<Id, NoteLabel>,
    /// Of these, the ones whose strike has not ended.
    open: BTreeSet<Id>,
}

impl Labels {
    /// For a job that has not begun.
    pub(super) fn new(job: &Job) -> Self {
        let sample_rate = f64::from(job.options.sample_rate);
        let first = job.first_frame();
        let frames = job.song.events.iter().map(|event| event.frame(sample_rate).saturating_sub(first));
        let mut events: Vec<u64> = frames.chain([job.song_frames()]).collect();
        events.sort_by_key(|frame| Reverse(*frame));
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
    fn look(&mut self, part: usize, voice: &VoiceState, gain: f32, piece: [u64; 2], open: &BTreeSet<Id>) {
        let id = |note: &Note| (part, note.serial, voice.unison());
        let mut has_own = false;
        for strike in voice.strikes() {
            let note = strike.note();
            has_own |= note.serial == voice.note().serial;
            self.write(id(note), note, strike.modes(), gain, piece, strike.is_acting());
        }
        let id = id(voice.note());
        // A note that was read already, and whose strike has ended, is no longer told apart: its voice may sound for others.
        if !has_own && (!self.all.contains_key(&id) || open.contains(&id)) {
            self.write(id, voice.note(), voice.modes(), gain, piece, voice.is_being_struck());
        }
    }

    /// Writes the label of a note, or the newest levels of one that there is. It stays open while the strike is acting.
    fn write(
        &mut self,
        id: Id,
        note: &Note,
        modes: impl Iterator<Item = ModeState>,
        gain: f32,
        piece: [u64; 2],
        is_acting: bool,
    ) {
        let modes = modes.map(|mode| ModeLabel {
            frequency: mode.frequency,
            t60: mode.t60,
            level_db: db_from_gain(mode.amplitude * f64::from(gain)),
        });
        match self.all.entry(id) {
            Entry::Occupied(label) => {
                let label = label.into_mut();
                label.free = piece[1];
                label.modes.iter_mut().zip(modes).for_each(|(label, mode)| label.level_db = mode.level_db);
            }
            Entry::Vacant(place) => {
                _ = place.insert(NoteLabel {
                    channel: note.channel,
                    key: note.key,
                    detune: note.detune,
                    velocity: note.velocity,
                    unison: id.2,
                    onset: piece[0],
                    free: piece[1],
                    modes: modes.collect(),
                })
            }
        }
        if is_acting {
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
mod tests;
