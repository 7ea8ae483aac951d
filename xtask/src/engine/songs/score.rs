//! Parts written in beats, and the standard MIDI file made from them.

use midly::num::{u4, u7, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, PitchBend, Smf, Timing, Track, TrackEvent, TrackEventKind};
use sprung::dsp::random::uniform;
use sprung::engine::banks::{BANK_SELECT, DRUM_BANK, DRUM_CHANNEL};
use sprung::engine::midi::controller;
use sprung::preset::{Phrase, Programs};

/// Ticks per beat: a quarter note.
const TICKS: u16 = 480;

/// The order in which the eighths of a bar turn through a chord of five notes, in groups of three, three and two.
pub(super) const BROKEN_CHORD: [usize; 8] = [0, 2, 4, 1, 3, 4, 2, 3];

/// The events of one instrument, on a track and a channel of its own.
pub(super) struct Part {
    name: &'static str,
    channel: u8,
    bend_range: f64,
    /// Maximum random deviation of notes from their beat, in beats, and from their velocity, in per cent.
    looseness: (f64, f64),
    /// Tick, rank within the tick (note-offs first, note-ons last), and event.
    events: Vec<(u32, u8, MidiMessage)>,
}

impl Part {
    /// A part that plays a sound of General MIDI, with a volume (controller 7) and a pan position (controller 10, 64 is the
    /// middle).
    pub(super) fn new(name: &'static str, channel: u8, preset: &str, volume: u8, pan: u8) -> Result<Self, String> {
        let programs = Programs::general_midi();
        let program = (0..128).find(|number| programs.sound(*number) == Some(preset));
        let program = program.ok_or_else(|| format!("no program of General MIDI plays ‘{preset}’"))?;
        let mut part = Self::silent(name, channel, volume);
        part.program(0.0, program + 1);
        part.control(0.0, controller::PAN, pan);
        Ok(part)
    }

    /// A part that plays a kit of drums by its number in Roland's GS, from 1, on any channel, with a volume (controller 7).
    pub(super) fn kit(name: &'static str, channel: u8, kit: u8, volume: u8) -> Self {
        let mut part = Self::silent(name, channel, volume);
        if channel != DRUM_CHANNEL {
            // The bank has to be known when the program changes: rank 0.
            let (controller, value) = (u7::new(BANK_SELECT), u7::new(DRUM_BANK));
            part.add(0.0, 0, MidiMessage::Controller { controller, value });
        }
        part.program(0.0, kit);
        part
    }

    fn silent(name: &'static str, channel: u8, volume: u8) -> Self {
        let mut part = Self { name, channel, bend_range: 2.0, looseness: (0.0, 0.0), events: Vec::new() };
        part.control(0.0, controller::VOLUME, volume);
        part
    }

    /// Sends this much of the part to the space that all channels share (controller 91).
    pub(super) fn send(mut self, amount: u8) -> Self {
        self.control(0.0, controller::REVERB_SEND, amount);
        self
    }

    /// Lets notes deviate by up to `beats`, and by up to `percent` of their velocity, in the same way each time.
    pub(super) fn loosen(mut self, beats: f64, percent: f64) -> Self {
        self.looseness = (beats, percent);
        self
    }

    fn add(&mut self, beat: f64, rank: u8, message: MidiMessage) {
        self.events.push((ticks(beat), rank, message));
    }

    /// A note from `beat` for `length` beats.
    pub(super) fn note(&mut self, beat: f64, length: f64, key: u8, velocity: u8) {
        let (beats, percent) = self.looseness;
        let serial = 2 * self.events.len() as u64;
        let stray = |n: u64| f64::from(uniform(u64::from(self.channel), serial + n));
        let beat = (beat + beats * stray(0)).max(0.0);
        let velocity = (f64::from(velocity) * (1.0 + percent * 0.01 * stray(1))).clamp(1.0, 127.0);
        let (key, vel) = (u7::new(key), u7::new(velocity as u8));
        self.add(beat, 3, MidiMessage::NoteOn { key, vel });
        self.add(beat + length, 0, MidiMessage::NoteOff { key, vel: u7::new(64) });
    }

    /// Selects a program or, on a channel of drums, a kit by its number from 1.
    pub(super) fn program(&mut self, beat: f64, number: u8) {
        self.add(beat, 1, MidiMessage::ProgramChange { program: u7::new(number - 1) });
    }

    /// A phrase in the notation of presets, such as `C4@40 - E4+G4@110*2`, with steps of `step` beats.
    pub(super) fn phrase(&mut self, beat: f64, step: f64, text: &str) -> Result<(), String> {
        let phrase: Phrase = text.parse()?;
        for note in phrase.notes() {
            let (start, steps) = (note.start / Phrase::STEP, note.seconds / Phrase::STEP);
            self.note(beat + start * step, steps * step * 0.95, note.key, note.velocity);
        }
        Ok(())
    }

    /// Sixteenths from `beat` on: a digit is the velocity in ninths of the maximum, anything else but a space is a rest.
    /// Every second one is late by `swing` beats.
    pub(super) fn sixteenths(&mut self, beat: f64, swing: f64, key: u8, pattern: &str) {
        for (step, strength) in pattern.chars().filter(|c| *c != ' ').enumerate() {
            if let Some(strength) = strength.to_digit(10) {
                let late = if step % 2 == 1 { swing } else { 0.0 };
                self.note(beat + step as f64 * 0.25 + late, 0.1, key, (127 * strength / 9) as u8);
            }
        }
    }

    /// Strikes a key evenly from one beat to another, `rate` times a beat, with velocities that go from one value to
    /// another.
    pub(super) fn roll(&mut self, from: (f64, u8), to: (f64, u8), rate: f64, key: u8) {
        let strokes = ((to.0 - from.0) * rate + 0.5) as u32;
        for stroke in 0..strokes {
            let progress = f64::from(stroke) / f64::from(strokes);
            let velocity = f64::from(from.1) + (f64::from(to.1) - f64::from(from.1)) * progress;
            self.note(from.0 + f64::from(stroke) / rate, 0.8 / rate, key, velocity as u8);
        }
    }

    /// A bar of eighths that turn through a chord, with an accent on the first of each group.
    pub(super) fn broken_chord(&mut self, beat: f64, chord: &[u8; 5]) {
        for (step, note) in BROKEN_CHORD.into_iter().enumerate() {
            let velocity = if [0, 3, 6].contains(&step) { 100 } else { 72 };
            self.note(beat + step as f64 * 0.5, 0.4, chord[note], velocity);
        }
    }

    /// Several notes struck together.
    pub(super) fn chord(&mut self, beat: f64, length: f64, keys: &[u8], velocity: u8) {
        keys.iter().for_each(|key| self.note(beat, length, *key, velocity));
    }

    /// Sets a controller to a value.
    pub(super) fn control(&mut self, beat: f64, controller: u8, value: u8) {
        self.add(beat, 2, MidiMessage::Controller { controller: u7::new(controller), value: u7::new(value) });
    }

    /// Moves a controller evenly between two values, in steps of a sixteenth of a beat.
    pub(super) fn ramp(&mut self, controller: u8, from: (f64, u8), to: (f64, u8)) {
        sixteenths(from.0, to.0, |beat, progress| {
            let value = f64::from(from.1) + (f64::from(to.1) - f64::from(from.1)) * progress;
            self.control(beat, controller, (value + 0.5) as u8);
        });
    }

    /// Presses the sustain pedal at `beat` and releases it after `length` beats.
    pub(super) fn pedal(&mut self, beat: f64, length: f64) {
        self.control(beat, controller::SUSTAIN, 127);
        self.control(beat + length, controller::SUSTAIN, 0);
    }

    /// Sets the range of the pitch wheel in semitones, with registered parameter 0.
    pub(super) fn bend_range(&mut self, semitones: u8) {
        self.bend_range = f64::from(semitones);
        for (controller, value) in [
            (controller::RPN, 0),
            (controller::RPN_FINE, 0),
            (controller::DATA, semitones),
            (controller::DATA_FINE, 0),
            (controller::RPN, 127),
            (controller::RPN_FINE, 127),
        ] {
            self.control(0.0, controller, value);
        }
    }

    /// Sets the pitch wheel, in semitones.
    pub(super) fn bend_to(&mut self, beat: f64, semitones: f64) {
        let bend = PitchBend::from_f64(semitones / self.bend_range);
        self.add(beat, 2, MidiMessage::PitchBend { bend });
    }

    /// Moves the pitch wheel evenly between two pitches in semitones.
    pub(super) fn bend(&mut self, from: (f64, f64), to: (f64, f64)) {
        sixteenths(from.0, to.0, |beat, progress| self.bend_to(beat, from.1 + (to.1 - from.1) * progress));
    }

    fn track(mut self) -> Track<'static> {
        self.events.sort_by_key(|(tick, rank, _)| (*tick, *rank));
        let channel = u4::new(self.channel);
        let messages = self.events.into_iter();
        timed(self.name, messages.map(|(tick, _, message)| (tick, TrackEventKind::Midi { channel, message })))
    }
}

/// Calls `at` with a beat and the share of the way passed, on every sixteenth of a beat and at the end.
fn sixteenths(from: f64, to: f64, mut at: impl FnMut(f64, f64)) {
    let steps = ((to - from) * 16.0 + 0.5).max(1.0) as u32;
    for step in 0..=steps {
        let progress = f64::from(step) / f64::from(steps);
        at(from + (to - from) * progress, progress);
    }
}

fn ticks(beat: f64) -> u32 {
    (beat * f64::from(TICKS) + 0.5) as u32
}

/// A track with this name, with events at their ticks.
fn timed(name: &'static str, events: impl Iterator<Item = (u32, TrackEventKind<'static>)>) -> Track<'static> {
    let event = |delta, kind| TrackEvent { delta: u28::new(delta), kind };
    let mut track = vec![event(0, TrackEventKind::Meta(MetaMessage::TrackName(name.as_bytes())))];
    let mut now = 0;
    for (tick, kind) in events {
        track.push(event(tick - now, kind));
        now = tick;
    }
    track.push(event(0, TrackEventKind::Meta(MetaMessage::EndOfTrack)));
    track
}

/// The file: a first track with the title and the tempo (beat, beats per minute), then a track per part.
pub(super) fn file(title: &'static str, tempo: &[(f64, f64)], parts: Vec<Part>) -> Result<Vec<u8>, String> {
    let tempo = tempo.iter().map(|(beat, bpm)| {
        let microseconds = u24::new((60e6 / bpm + 0.5) as u32);
        (ticks(*beat), TrackEventKind::Meta(MetaMessage::Tempo(microseconds)))
    });
    let four_four = (0, TrackEventKind::Meta(MetaMessage::TimeSignature(4, 2, 24, 8)));
    let mut smf = Smf::new(Header::new(Format::Parallel, Timing::Metrical(u15::new(TICKS))));
    smf.tracks.push(timed(title, std::iter::once(four_four).chain(tempo)));
    smf.tracks.extend(parts.into_iter().map(Part::track));
    let mut bytes = Vec::new();
    smf.write_std(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}
