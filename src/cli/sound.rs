//! The sounds that a command plays with: presets and kits, settings on top of them, the tuning, and the seed.

use super::tuning::TuningArgs;
use super::{completion, presets, quantity};
use clap_complete::ArgValueCompleter;
use sprung::io::Inputs;
use sprung::params::Param;
use sprung::preset::{Playable, Preset};
use sprung::sound::{Kit, Tuning};
use sprung::{Error, Result};
use std::ffi::{OsStr, OsString};
use std::sync::Arc;

/// What sounds a song is played with.
#[derive(clap::Args)]
pub(super) struct SoundArgs {
    /// Factory preset, or preset or kit file (.toml), that plays what nothing else says otherwise [default: init]
    #[arg(long, value_name = "NAME|FILE.toml", add = ArgValueCompleter::new(completion::presets))]
    preset: Option<OsString>,
    /// Factory preset, or preset or kit file, that a channel (1-16) starts with, as in 10=drums.toml; may be repeated
    #[arg(long, value_name = "CHANNEL=NAME|FILE.toml", value_parser = quantity::channel)]
    channel: Vec<(u8, String)>,
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
    /// What every channel starts with that is not among `channels`.
    pub(super) kit: Arc<Kit>,
    /// What single channels, from 0, start with.
    pub(super) channels: Vec<(u8, Arc<Kit>)>,
    /// The factory's sounds, in the order of their program numbers.
    pub(super) programs: Vec<Arc<Kit>>,
    /// The pitches of the keys.
    pub(super) tuning: Tuning,
}

impl SoundArgs {
    /// Loads the presets and kits, sets the parameters of all sounds, and reads the tuning.
    pub(super) fn load(&self, inputs: &mut Inputs) -> Result<Sounds> {
        let kit = self.kit(presets::load(self.preset.as_deref().unwrap_or(OsStr::new("init")), inputs)?);
        let mut channels = Vec::with_capacity(self.channel.len());
        for (channel, name) in &self.channel {
            if channels.iter().any(|(taken, _)| taken == channel) {
                let message = format!("channel {} is there twice: expected each channel once", channel + 1);
                return Err(Error::value("--channel", message));
            }
            channels.push((*channel, self.kit(presets::load(OsStr::new(name), inputs)?)));
        }
        let programs = Preset::factory().iter().map(|preset| self.kit(Playable::Preset(preset.clone()))).collect();
        Ok(Sounds { kit, channels, programs, tuning: self.tuning.read(inputs)? })
    }

    /// What each channel was asked to play: nothing where neither it nor all of them were given anything.
    pub(super) fn asked_for<'a>(&self, sounds: &'a Sounds) -> [Option<&'a Arc<Kit>>; 16] {
        let mut asked = [self.preset.is_some().then_some(&sounds.kit); 16];
        sounds.channels.iter().for_each(|(channel, kit)| asked[usize::from(*channel)] = Some(kit));
        asked
    }

    fn kit(&self, mut playable: Playable) -> Arc<Kit> {
        for preset in playable.presets_mut() {
            self.set.iter().for_each(|(param, value)| preset.patch.set(*param, *value));
        }
        playable.kit()
    }
}
