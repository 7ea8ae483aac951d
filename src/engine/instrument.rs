//! One sound of the kit that a synth plays: its live values, and what moves them for all of its notes.

use super::controls::{Controls, Smoother};
use super::modulation::{Bus, Positions, Settings, SharedLfos, modulated};
use super::note::Note;
use super::voice::key_tracking::KeyTracking;
use crate::params::{PARAM_COUNT, PARAMS, Param, Values};
use crate::sound::Sound;
use std::sync::Arc;

/// What voices read of their sound, when a note starts and while it is played. Real-time safe once built, as far as
/// handles of sounds are kept elsewhere.
pub(crate) struct Instrument {
    /// Whose modes and routes are played.
    pub(crate) sound: Arc<Sound>,
    /// Its parameters as they were set.
    pub(crate) values: Values,
    /// Where modulation has moved them: what is played.
    pub(crate) modulated: Values,
    /// Counts the sounds of a synth: a voice that was started by another cannot read this one.
    pub(crate) patch_serial: u32,
    /// Counts the bodies: a voice keeps the one that it was started with.
    pub(crate) body_serial: u32,
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    pub(crate) smoother: Smoother,
    /// Live parameters at this frame, when a note starts.
    pub(crate) controls: Controls,
    /// Live parameters at the next control tick, and a count of how often they have changed.
    pub(crate) next_controls: Controls,
    pub(crate) controls_serial: u32,
    /// Pitch of the note before, in semitones, to glide from.
    pub(crate) last_pitch: Option<f64>,
    /// The routes of the sound.
    pub(crate) bus: Bus,
    /// What modulators follow.
    pub(crate) settings: Settings,
    /// Oscillators that all voices can follow, at the last control tick.
    pub(crate) shared: SharedLfos,
    /// Positions of the controllers on the channel of the next note.
    pub(crate) positions: Positions,
    /// A sound since the start has had routes.
    has_routes: bool,
    /// Changes of the smoother that the next controls and the settings have, if they have arrived.
    controls_changes: Option<u32>,
    settings_changes: Option<u32>,
    /// The frame at which the shared oscillators are.
    shared_clock: u64,
}

impl Instrument {
    /// An instrument at frame `clock`, with its parameters moved by `offsets` in knob travel, and serial numbers to be
    /// given.
    pub(crate) fn new(
        sound: Arc<Sound>,
        [sample_rate, beat_rate]: [f64; 2],
        seed: u64,
        offsets: &[f32; PARAM_COUNT],
        clock: u64,
    ) -> Self {
        let values = sound.patch().values;
        let modulated = all_modulated(&values, offsets);
        let smoother = Smoother::new(sample_rate, &modulated, beat_rate);
        let controls = smoother.after(0);
        let bus = Bus::new(&sound.patch().routes);
        Self {
            values,
            modulated,
            patch_serial: 0,
            body_serial: 0,
            sample_rate,
            seed,
            smoother,
            controls,
            next_controls: controls,
            controls_serial: 0,
            last_pitch: None,
            has_routes: !bus.is_empty(),
            bus,
            settings: Settings::STILL,
            shared: SharedLfos::new(seed),
            positions: Positions::default(),
            controls_changes: None,
            settings_changes: None,
            shared_clock: clock,
            sound,
        }
    }

    /// Plays another sound, at the same tempo, with its parameters moved by `offsets` in knob travel. Shared oscillators
    /// go on.
    pub(crate) fn play(&mut self, sound: &Arc<Sound>, offsets: &[f32; PARAM_COUNT]) {
        self.sound = sound.clone();
        self.values = sound.patch().values;
        self.modulated = all_modulated(&self.values, offsets);
        self.bus = Bus::new(&sound.patch().routes);
        self.has_routes |= !self.bus.is_empty();
        // Voices of the sound before keep its controls, so the new ones need no slope.
        self.smoother = Smoother::new(self.sample_rate, &self.modulated, self.smoother.beat_rate());
        (self.controls_changes, self.settings_changes) = (None, None);
    }

    /// Takes all parameters to where `value` puts those of the sound, moved by `offsets` in knob travel, at once.
    pub(crate) fn begin_at(&mut self, value: impl Fn(Param, f32) -> f32, offsets: &[f32; PARAM_COUNT]) {
        for info in PARAMS {
            self.values.set(info.param, value(info.param, self.sound.patch().get(info.param)));
        }
        self.modulated = all_modulated(&self.values, offsets);
        self.smoother = Smoother::new(self.sample_rate, &self.modulated, self.smoother.beat_rate());
        self.controls = self.smoother.after(0);
        (self.controls_changes, self.settings_changes) = (None, None);
    }

    /// Sets a parameter that is moved by an offset in knob travel, at frame `clock`.
    pub(crate) fn set(&mut self, param: Param, value: f32, offset: f32, clock: u64) {
        self.values.set(param, value);
        let value = modulated(&self.values, param, offset);
        self.modulated.set(param, value);
        // Until now, shared oscillators have had the rate before.
        self.move_shared(clock, 0);
        self.smoother.set(param, value);
    }

    /// Finds what voices follow at the next control tick, which is `ahead` frames after frame `clock`.
    pub(crate) fn look_ahead(&mut self, clock: u64, ahead: u32) {
        // What slides is read again, until all have arrived.
        let changes = self.smoother.changes(ahead);
        if changes.is_none() || changes != self.controls_changes {
            self.next_controls = self.smoother.after(ahead);
            self.controls_serial = self.controls_serial.wrapping_add(1);
        }
        self.controls_changes = changes;
        self.move_shared(clock, ahead);
    }

    /// Moves the shared oscillators to frame `clock`, and reads what modulators are to follow `ahead` frames from then: if
    /// there are any routes to follow them.
    pub(crate) fn move_shared(&mut self, clock: u64, ahead: u32) {
        if !self.has_routes {
            return;
        }
        let seconds = (clock - self.shared_clock) as f64 / self.sample_rate;
        self.shared_clock = clock;
        // Values that slide are read again, until those that they slide to have been read.
        let changes = self.smoother.changes(ahead);
        if changes.is_none() || changes != self.settings_changes {
            self.settings = self.smoother.settings_after(ahead, &self.settings, &self.bus);
        }
        self.settings_changes = changes;
        self.shared.advance(&self.settings, seconds);
    }

    /// Whether its notes ask where the controllers are.
    pub(crate) fn has_routes(&self) -> bool {
        self.has_routes
    }

    /// The value of a parameter without the routes' part.
    fn value(&self, param: Param) -> f64 {
        self.modulated.get(param).into()
    }

    /// The pitch of a note in semitones on the MIDI scale, tracking included.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        KeyTracking::new(|param| self.value(param)).pitch(note)
    }
}

/// All values, moved by offsets in knob travel.
fn all_modulated(values: &Values, offsets: &[f32; PARAM_COUNT]) -> Values {
    let mut all = *values;
    for info in PARAMS {
        all.set(info.param, modulated(values, info.param, offsets[info.param as usize]));
    }
    all
}
