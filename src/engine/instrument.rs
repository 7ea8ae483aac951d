//! One sound of the kit that a synth plays: its current parameters, and the modulation that all its notes share.

use super::controls::{Controls, Smoother};
use super::modulation::{Bus, Positions, Settings, SharedLfos, modulated};
use super::note::Note;
use super::voice::key_tracking::KeyTracking;
use crate::params::{PARAM_COUNT, PARAMS, Param, Values};
use crate::sound::Sound;
use std::sync::Arc;

/// The values of their sound that voices read when a note starts and while it plays. Real-time safe once built, as long
/// as the sounds are also held elsewhere, so that none is freed here.
pub(crate) struct Instrument {
    /// The sound whose modes and routes are played.
    pub(crate) sound: Arc<Sound>,
    /// Its parameters as they were set.
    pub(crate) values: Values,
    /// The parameters with the host's modulation. Voices use these.
    pub(crate) modulated: Values,
    /// Serial number of the sound. A voice that was started with another number must not read this instrument.
    pub(crate) patch_serial: u32,
    /// Serial number of the body. A voice keeps the body that it was started with.
    pub(crate) body_serial: u32,
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    pub(crate) smoother: Smoother,
    /// Smoothed parameters at the frame at which a note starts.
    pub(crate) controls: Controls,
    /// Smoothed parameters at the next control tick, and, in the next field, a count of their changes.
    pub(crate) next_controls: Controls,
    pub(crate) controls_serial: u32,
    /// Pitch of the previous note in semitones, for the glide.
    pub(crate) last_pitch: Option<f64>,
    /// The routes of the sound.
    pub(crate) bus: Bus,
    /// Parameter values for the modulators.
    pub(crate) settings: Settings,
    /// Oscillators that all voices can share, at frame `shared_clock`.
    pub(crate) shared: SharedLfos,
    /// Controller positions on the channel of the next note.
    pub(crate) positions: Positions,
    /// Whether any sound so far has had routes.
    has_routes: bool,
    /// The smoother's change count that `next_controls`, and in the next field `settings`, were computed with; none
    /// while a ramp is running.
    controls_changes: Option<u32>,
    settings_changes: Option<u32>,
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

    /// Switches to another sound at the same tempo, with parameters modulated by `offsets` in knob travel. Shared
    /// oscillators continue.
    pub(crate) fn play(&mut self, sound: &Arc<Sound>, offsets: &[f32; PARAM_COUNT]) {
        self.sound = sound.clone();
        self.bus = Bus::new(&sound.patch().routes);
        self.has_routes |= !self.bus.is_empty();
        // Voices of the previous sound keep its controls, so the new values need no ramp.
        self.jump_to(sound.patch().values, offsets);
    }

    /// Sets all parameters at once, without ramps: `value` gives each from the sound's own value, and `offsets`
    /// modulate them, in knob travel.
    pub(crate) fn begin_at(&mut self, value: impl Fn(Param, f32) -> f32, offsets: &[f32; PARAM_COUNT]) {
        let mut values = self.sound.patch().values;
        for info in PARAMS {
            values.set(info.param, value(info.param, values.get(info.param)));
        }
        self.jump_to(values, offsets);
        self.controls = self.smoother.after(0);
    }

    /// Sets all parameters at once, without ramps.
    fn jump_to(&mut self, values: Values, offsets: &[f32; PARAM_COUNT]) {
        (self.values, self.modulated) = (values, all_modulated(&values, offsets));
        self.smoother = Smoother::new(self.sample_rate, &self.modulated, self.smoother.beat_rate());
        (self.controls_changes, self.settings_changes) = (None, None);
    }

    /// Sets a parameter and its modulation offset in knob travel, at frame `clock`.
    pub(crate) fn set(&mut self, param: Param, value: f32, offset: f32, clock: u64) {
        self.values.set(param, value);
        let value = modulated(&self.values, param, offset);
        self.modulated.set(param, value);
        // Shared oscillators must first advance to this frame with the old rate.
        self.move_shared(clock, 0);
        self.smoother.set(param, value);
    }

    /// Computes the controls at the next control tick, `ahead` frames after frame `clock`.
    pub(crate) fn look_ahead(&mut self, clock: u64, ahead: u32) {
        // While a ramp is running, the values are read again at every tick.
        let changes = self.smoother.changes(ahead);
        if changes.is_none() || changes != self.controls_changes {
            self.next_controls = self.smoother.after(ahead);
            self.controls_serial = self.controls_serial.wrapping_add(1);
        }
        self.controls_changes = changes;
        self.move_shared(clock, ahead);
    }

    /// Advances the shared oscillators to frame `clock`, and computes the modulators' settings `ahead` frames later.
    /// Does nothing if no sound has had routes.
    pub(crate) fn move_shared(&mut self, clock: u64, ahead: u32) {
        if !self.has_routes {
            return;
        }
        let seconds = (clock - self.shared_clock) as f64 / self.sample_rate;
        self.shared_clock = clock;
        // While a ramp is running, the values are read again at every tick.
        let changes = self.smoother.changes(ahead);
        if changes.is_none() || changes != self.settings_changes {
            self.settings = self.smoother.settings_after(ahead, &self.settings, &self.bus);
        }
        self.settings_changes = changes;
        self.shared.advance(&self.settings, seconds);
    }

    /// Whether any sound so far has had routes, so that notes need controller positions.
    pub(crate) fn has_routes(&self) -> bool {
        self.has_routes
    }

    /// The value of a parameter without the effect of routes.
    fn value(&self, param: Param) -> f64 {
        self.modulated.get(param).into()
    }

    /// The pitch of a note in semitones on the MIDI scale, with key tracking.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        KeyTracking::new(|param| self.value(param)).pitch(note)
    }
}

/// All values, modulated by offsets in knob travel.
fn all_modulated(values: &Values, offsets: &[f32; PARAM_COUNT]) -> Values {
    let mut all = *values;
    for info in PARAMS {
        all.set(info.param, modulated(values, info.param, offsets[info.param as usize]));
    }
    all
}
