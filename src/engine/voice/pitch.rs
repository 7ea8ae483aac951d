//! The pitch of a note: key, tuning, glide, sweep, bend, vibrato and tension.

use super::clock::Clock;
use super::key_tracking::KeyTracking;
use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::pitch::{Glide, SweepEnvelope};
use crate::dsp::series::powers;
use crate::engine::channel::Wheels;
use crate::engine::controls::Controls;
use crate::engine::note::Note;
use crate::engine::voice_manager::Unison;
use crate::params::Param;
use crate::sound::blown::Correction;
use crate::units::{frequency_from_key, key_from_frequency, ratio_from_semitones};
use libm::{floor, sin};
use std::f64::consts::TAU;

/// The pitch of a voice. Real-time safe.
pub(super) struct Pitch {
    tracking: KeyTracking,
    /// Pitch of the note and transposition of the patch, both in semitones. The bank is tuned to their sum and
    /// `detune`.
    note: f64,
    tune: f64,
    /// Detuning of a unison voice in semitones, and the transposition of a tube that is blown.
    detune: f64,
    correction: f64,
    /// The last offset from the pitch that the bank is tuned to, in semitones, and its frequency ratio.
    offset: f64,
    ratio: f64,
    glide: Glide,
    /// Frames since the last strike when the glide started.
    glide_start: u64,
    sweep: SweepEnvelope,
    /// Phase of the vibrato, 0–1 of a cycle, and its fade-in time in seconds.
    vibrato_phase: f64,
    vibrato_delay: f64,
}

/// Changes to the pitch of a note that do not come from its patch.
pub(super) struct Bends<'a> {
    pub(super) wheels: Wheels<'a>,
    /// The note expression for tuning, in semitones.
    pub(super) tuning: f64,
    /// The rise by tension in semitones.
    pub(super) tension: f64,
}

impl Pitch {
    /// The pitch of a voice before its first note.
    pub(super) fn new() -> Self {
        Self {
            tracking: KeyTracking::FULL,
            note: 0.0,
            tune: 0.0,
            detune: 0.0,
            correction: 0.0,
            offset: 0.0,
            ratio: 1.0,
            glide: Glide::new(0.0, 0.0, 0.0),
            glide_start: 0,
            sweep: SweepEnvelope::new(0.0, 0.0, 0.0),
            vibrato_phase: 0.0,
            vibrato_delay: 0.0,
        }
    }

    /// Reads key tracking and unison detuning from the patch.
    pub(super) fn read(&mut self, values: &StruckValues, unison: Unison) {
        self.tracking = KeyTracking::new(|param| values.get(param));
        self.detune = unison.position() * values.get(Param::UnisonDetune) * 0.01;
    }

    /// Sets the modes' frequency ratios to those of the note's table.
    pub(super) fn set_ratios(values: &StruckValues, bank: &mut Cells) {
        let (stretch, table) = (values.get(Param::Stretch), values.modes());
        let rows = table.as_slice().chunks(MAX_MODES).zip(table.octaves().chunks(MAX_MODES));
        for (ratios, (modes, octaves)) in bank.ratios_mut().zip(rows) {
            if stretch == 1.0 {
                ratios.iter_mut().zip(modes).for_each(|(ratio, mode)| *ratio = mode.ratio.into());
            } else {
                powers(octaves, stretch, ratios);
            }
        }
    }

    /// Sets the pitch and the transposition to those of `note`.
    fn place(&mut self, note: &Note, controls: &Controls) {
        (self.note, self.tune) = (self.tracking.pitch(note), controls.tune);
    }

    /// Transposes a tube that is blown, so that its note sounds in tune.
    pub(super) fn correct(&mut self, correction: Option<&Correction>) {
        self.correction = 0.0;
        if let Some(correction) = correction {
            self.correction = correction.at(key_from_frequency(self.frequency(), 440.0));
        }
    }

    /// Starts the first note of a voice, with a glide from the pitch of the note before.
    pub(super) fn start(&mut self, note: &Note, controls: &Controls, last_pitch: Option<f64>) {
        self.place(note, controls);
        self.glide = self.tracking.glide(last_pitch.unwrap_or(self.note), note, note.is_legato);
        (self.offset, self.ratio, self.glide_start, self.vibrato_phase) = (0.0, 1.0, 0, 0.0);
    }

    /// The present pitch during a glide, in semitones on the MIDI scale.
    pub(super) fn now(&self, clock: &Clock) -> f64 {
        self.note + self.glide.at(clock.seconds(clock.age - self.glide_start))
    }

    /// The pitch with all offsets at the last control tick, in semitones on the MIDI scale.
    pub(super) fn sounding(&self) -> f64 {
        self.note + self.tune + self.offset
    }

    /// Starts a glide from a pitch, in semitones on the MIDI scale, to that of `note`. `is_legato` says that another
    /// key is down.
    pub(super) fn slide(&mut self, from: f64, note: &Note, controls: &Controls, is_legato: bool, clock: &Clock) {
        self.place(note, controls);
        self.glide = self.tracking.glide(from, note, is_legato);
        self.glide_start = clock.age;
    }

    /// Starts the sweep of a strike and the fade-in of the vibrato.
    pub(super) fn strike(&mut self, values: &StruckValues) {
        let [depth, time] = [Param::Sweep, Param::SweepTime].map(|param| values.get(param));
        self.sweep = SweepEnvelope::new(depth, time, values.share(Param::SweepCurve));
        self.vibrato_delay = values.get(Param::VibratoDelay);
    }

    /// Prepares for a strike, which sets the voice's age to 0: the glide starts there too, and the vibrato keeps its
    /// phase.
    pub(super) fn restart(&mut self, vibrato_rate: f64, passed: f64) {
        self.vibrato_phase += vibrato_rate * passed;
        self.glide_start = 0;
    }

    /// Advances the vibrato by `passed` seconds, at a rate in Hz.
    pub(super) fn advance(&mut self, vibrato_rate: f64, passed: f64) {
        self.vibrato_phase += vibrato_rate * passed;
        self.vibrato_phase -= floor(self.vibrato_phase);
    }

    /// Pitch of the note in semitones on the MIDI scale.
    pub(super) fn note(&self) -> f64 {
        self.note
    }

    /// Frequency in Hz of a mode of ratio 1.
    pub(super) fn frequency(&self) -> f64 {
        frequency_from_key(self.note + self.tune + self.detune + self.correction, self.tracking.a4_hz)
    }

    /// The frequency ratio that was computed last.
    pub(super) fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Computes the ratio of the pitch `ahead` frames from now to the pitch that the bank is tuned to.
    pub(super) fn aim(&mut self, controls: &Controls, bends: &Bends, clock: &Clock, ahead: usize) -> f64 {
        let offset = self.offset_after(controls, bends, clock, ahead);
        if offset != self.offset {
            // The ratio is slow to compute, so it is computed only if the offset has changed, which is seldom.
            (self.offset, self.ratio) = (offset, ratio_from_semitones(offset));
        }
        self.ratio
    }

    /// As [`Pitch::aim`], in semitones.
    fn offset_after(&self, controls: &Controls, bends: &Bends, clock: &Clock, ahead: usize) -> f64 {
        let age = clock.age + ahead as u64;
        let fade = if self.vibrato_delay > 0.0 { (clock.seconds(age) / self.vibrato_delay).min(1.0) } else { 1.0 };
        let depth = controls.vibrato * fade + controls.added_vibrato;
        let phase = self.vibrato_phase + controls.vibrato_rate * clock.seconds(ahead as u64);
        let vibrato = if depth > 0.0 { depth * sin(TAU * phase) } else { 0.0 };
        let (bend, tuning) = bends.wheels.semitones(controls.bend_range);
        self.glide.at(clock.seconds(age - self.glide_start))
            + self.sweep.at(clock.seconds(age))
            + (controls.tune - self.tune)
            + bend
            + tuning
            + bends.tuning
            + vibrato
            + bends.tension
    }
}
