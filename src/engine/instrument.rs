//! One sound of the kit that a synth plays: its current parameters, and the modulation that all its notes share.

use super::controls::Controls;
use super::knobs::Knobs;
use super::modulation::{Bus, Positions, Settings, SharedLfos, Struck};
use super::note::Note;
use super::voice::key_tracking::KeyTracking;
use crate::params::{PARAM_COUNT, Param};
use crate::sound::Sound;
use std::sync::Arc;

/// The values of their sound that voices read when a note starts and while it plays. Real-time safe once built, as long
/// as the sounds are also held elsewhere, so that none is freed here.
#[derive(Clone)]
pub(crate) struct Instrument {
    /// The sound whose modes and routes are played.
    pub(crate) sound: Arc<Sound>,
    /// Its parameters: as they were set, with the host's modulation, and on the way there.
    pub(crate) knobs: Knobs,
    /// Serial number of the sound. A voice that was started with another number must not read this instrument.
    pub(crate) patch_serial: u32,
    /// Serial number of the body. A voice keeps the body that it was started with.
    pub(crate) body_serial: u32,
    pub(crate) sample_rate: f64,
    /// Beats per second.
    pub(crate) beat_rate: f64,
    pub(crate) seed: u64,
    /// Smoothed parameters at the frame at which the last note started.
    pub(crate) controls: Controls,
    /// Smoothed parameters at the next control tick: those that voices follow, and, in the next field, those that
    /// modulators use.
    pub(crate) next_controls: Controls,
    pub(crate) settings: Settings,
    /// Serial number of these: each new version has the next one.
    pub(crate) serial: u32,
    /// Whether they are those of knobs at rest, and no knob and no tempo has changed since.
    is_settled: bool,
    /// Pitch of the previous note in semitones, for the glide.
    pub(crate) last_pitch: Option<f64>,
    /// The routes of the sound.
    pub(crate) bus: Bus,
    /// Oscillators that all voices can share, at frame `shared_clock`.
    pub(crate) shared: SharedLfos,
    /// Controller positions on the channel of the next note.
    pub(crate) positions: Positions,
    /// Whether any sound so far has had routes.
    has_routes: bool,
    /// Frame to which the shared oscillators have advanced.
    shared_clock: u64,
}

impl Instrument {
    /// An instrument at frame `clock`, with parameters modulated by `offsets` in knob travel. Its serial numbers are
    /// set later.
    pub(crate) fn new(
        sound: Arc<Sound>,
        [sample_rate, beat_rate]: [f64; 2],
        seed: u64,
        offsets: &[f32; PARAM_COUNT],
        clock: u64,
    ) -> Self {
        let knobs = Knobs::new(|param| sound.patch().get(param), offsets);
        let controls = Controls::new(|param| knobs.modulated(param), beat_rate);
        let bus = Bus::new(&sound.patch().routes);
        Self {
            knobs,
            patch_serial: 0,
            body_serial: 0,
            sample_rate,
            beat_rate,
            seed,
            controls,
            next_controls: controls,
            settings: Settings::STILL,
            serial: 0,
            is_settled: false,
            last_pitch: None,
            has_routes: !bus.is_empty(),
            bus,
            shared: SharedLfos::new(seed),
            positions: Positions::default(),
            shared_clock: clock,
            sound,
        }
    }

    /// Switches to another sound at the same tempo, with parameters modulated by `offsets` in knob travel. Shared
    /// oscillators continue.
    pub(crate) fn play(&mut self, sound: &Arc<Sound>, offsets: &[f32; PARAM_COUNT]) {
        self.sound = sound.clone();
        self.bus = Bus::new(&sound.patch().routes);
        self.has_routes |= !self.bus.is_empty();
        // Voices of the previous sound keep its controls, so the new values need no ramp.
        self.knobs = Knobs::new(|param| sound.patch().get(param), offsets);
        self.is_settled = false;
    }

    /// Sets all parameters at once, without ramps: `value` gives each from the sound's own value, and `offsets`
    /// modulate them, in knob travel.
    pub(crate) fn begin_at(&mut self, value: impl Fn(Param, f32) -> f32, offsets: &[f32; PARAM_COUNT]) {
        self.knobs = Knobs::new(|param| value(param, self.sound.patch().get(param)), offsets);
        self.controls = Controls::new(|param| self.knobs.modulated(param), self.beat_rate);
        self.is_settled = false;
    }

    /// Sets a parameter and its modulation offset in knob travel, at frame `clock`.
    pub(crate) fn set(&mut self, param: Param, value: f32, offset: f32, clock: u64) {
        // Shared oscillators must first advance to this frame with the old rate.
        self.look_ahead(clock, 0);
        self.is_settled &= !self.knobs.set(param, value, offset, self.sample_rate);
    }

    /// Sets the tempo in beats per second, at frame `clock`.
    pub(crate) fn set_tempo(&mut self, beat_rate: f64, clock: u64) {
        self.look_ahead(clock, 0);
        (self.beat_rate, self.is_settled) = (beat_rate, false);
    }

    /// Advances the shared oscillators to frame `clock`, and computes what voices and modulators follow for the time
    /// `ahead` frames later. Oscillators rest, and there are no settings, if no sound has had routes.
    pub(crate) fn look_ahead(&mut self, clock: u64, ahead: u32) {
        // While a ramp is running, the values are read again at every tick.
        let are_at_rest = self.knobs.are_at_rest_after(ahead);
        if !(self.is_settled && are_at_rest) {
            let value = |param| self.knobs.after(param, ahead);
            self.next_controls = Controls::new(value, self.beat_rate);
            if self.has_routes {
                self.settings = Settings::new(&self.bus, value, self.beat_rate);
            }
            self.serial = self.serial.wrapping_add(1);
        }
        self.is_settled = are_at_rest;
        if self.has_routes {
            let seconds = (clock - self.shared_clock) as f64 / self.sample_rate;
            self.shared_clock = clock;
            self.shared.advance(&self.settings, seconds);
        }
    }

    /// Whether any sound so far has had routes, so that notes need controller positions.
    pub(crate) fn has_routes(&self) -> bool {
        self.has_routes
    }

    /// What modulators read of the strike of a note.
    pub(crate) fn struck(&self, note: &Note) -> Struck {
        Struck { velocity: note.velocity, pitch: self.pitch(note), seed: self.seed, serial: note.serial }
    }

    /// The pitch of a note in semitones on the MIDI scale, with key tracking.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        KeyTracking::new(|param| self.knobs.modulated(param).into()).pitch(note)
    }
}
