//! What voices read of the instrument.

use super::key_tracking::KeyTracking;
use crate::engine::controls::Controls;
use crate::engine::modulation::{Bus, Modulators, Positions, Settings, SharedLfos, Struck};
use crate::engine::note::Note;
use crate::params::Param;
use crate::patch::Patch;

/// What a voice reads of the instrument when a note starts.
pub(crate) struct Instrument {
    /// The patch as it was set.
    pub(crate) patch: Patch,
    /// With its parameters where modulation has moved them: what is played.
    pub(crate) modulated: Patch,
    /// Counts the patches: a voice that was started by another cannot read this one.
    pub(crate) patch_serial: u32,
    /// Counts the bodies: a voice keeps the one that it was started with.
    pub(crate) body_serial: u32,
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    /// Live parameters at this frame.
    pub(crate) controls: Controls,
    /// Pitch of the note before, in semitones, to glide from.
    pub(crate) last_pitch: Option<f64>,
    /// The routes of the patch.
    pub(crate) bus: Bus,
    /// What modulators follow.
    pub(crate) settings: Settings,
    /// Oscillators that all voices can follow, at the last control tick.
    pub(crate) shared: SharedLfos,
    /// Positions of the controllers on the channel of the next note.
    pub(crate) positions: Positions,
}

impl Instrument {
    /// An instrument with its first patch.
    pub(crate) fn new(patch: Patch, sample_rate: f64, seed: u64, controls: Controls) -> Self {
        let (patch_serial, body_serial) = (0, 0);
        Self {
            modulated: patch.clone(),
            patch_serial,
            body_serial,
            sample_rate,
            seed,
            controls,
            last_pitch: None,
            bus: Bus::new(&patch.routes),
            patch,
            settings: Settings::STILL,
            shared: SharedLfos::new(seed),
            positions: Positions::default(),
        }
    }

    /// The pitch of a note in semitones on the MIDI scale, tracking included.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        KeyTracking::new(|param| self.modulated.get(param).into()).pitch(note)
    }

    /// Tells the modulators of a strike, the `first` of the voice or a later one.
    pub(super) fn strike_modulators(&self, modulators: &mut Modulators, note: &Note, first: bool) {
        let (pitch, seed, serial) = (self.pitch(note), self.seed, note.serial);
        let struck = Struck { velocity: note.velocity, pitch, seed, serial };
        let value = |param| self.modulated.get(param);
        modulators.strike(&struck, &self.positions, &self.settings, &self.shared, value, first);
    }
}

/// The values that the parameters have for one strike: the instrument's, moved by the voice's routes.
#[derive(Clone, Copy)]
pub(super) struct StruckValues<'a> {
    pub(super) instrument: &'a Instrument,
    pub(super) modulators: &'a Modulators,
}

impl StruckValues<'_> {
    /// In the parameter's unit.
    pub(super) fn get(&self, param: Param) -> f64 {
        self.modulators.struck_value(param, |param| self.instrument.modulated.get(param)).into()
    }

    /// The same where the instrument has a parameter at `value`, as while it slides.
    pub(super) fn moved(&self, param: Param, value: f64) -> f64 {
        self.modulators.struck_value(param, |_| value as f32).into()
    }

    /// Of a parameter that is in per cent, as a share of 1.
    pub(super) fn share(&self, param: Param) -> f64 {
        self.get(param) * 0.01
    }
}
