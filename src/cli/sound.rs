//! The sounds that a command plays with: a preset, settings on top of it, the tuning, and the seed.

use super::tuning::TuningArgs;
use super::{completion, presets, quantity};
use clap_complete::ArgValueCompleter;
use sprung::Result;
use sprung::io::Inputs;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::sound::Tuning;
use std::ffi::{OsStr, OsString};

/// What sounds a song is played with.
#[derive(clap::Args)]
pub(super) struct SoundArgs {
    /// Factory preset or preset file (.toml) that plays what no program change says otherwise [default: init]
    #[arg(long, value_name = "NAME|FILE.toml", add = ArgValueCompleter::new(completion::presets))]
    preset: Option<OsString>,
    /// Set a parameter of every preset used; may be repeated. See `sprung params`
    #[arg(long, value_name = "ID=VALUE", value_parser = quantity::setting,
        add = ArgValueCompleter::new(completion::settings))]
    set: Vec<(Param, f32)>,
    #[command(flatten)]
    pub(super) tuning: TuningArgs,
    /// Seed of all randomness, 0-18446744073709551615
    #[arg(long, default_value_t = 0, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u64>(0..=u64::MAX))]
    pub(super) seed: u64,
}

/// The sounds, as they were set.
pub(super) struct Sounds {
    /// What every channel starts with.
    pub(super) preset: Preset,
    /// The factory's sounds, in the order of their program numbers.
    pub(super) programs: Vec<Patch>,
    /// The pitches of the keys.
    pub(super) tuning: Tuning,
}

impl SoundArgs {
    /// Loads the preset, sets the parameters of all sounds, and reads the tuning.
    pub(super) fn load(&self, inputs: &mut Inputs) -> Result<Sounds> {
        let mut preset = presets::load(self.preset.as_deref().unwrap_or(OsStr::new("init")), inputs)?;
        let programs = Preset::factory().iter().map(|preset| self.with_settings(preset.patch.clone())).collect();
        let tuning = self.tuning.read(inputs)?;
        preset.patch = self.with_settings(preset.patch);
        Ok(Sounds { preset, programs, tuning })
    }

    /// `patch`, if a preset was asked for.
    pub(super) fn asked_for<'a>(&self, patch: &'a Patch) -> Option<&'a Patch> {
        self.preset.is_some().then_some(patch)
    }

    fn with_settings(&self, mut patch: Patch) -> Patch {
        for (param, value) in &self.set {
            patch.set(*param, *value);
        }
        patch
    }
}
