//! The sounds that a command plays: presets and kits, parameter settings, the tuning, and the seed.

use super::completion;
use super::tuning::TuningArgs;
use clap_complete::ArgValueCompleter;
use sprung::internals::request::{SoundRequest, quantity};
use sprung::params::Param;
use std::ffi::OsString;

/// What sounds a song is played with.
#[derive(Clone, clap::Args)]
pub(super) struct SoundArgs {
    /// Factory preset or kit, one of your own, or a file (.toml), that plays what nothing else says otherwise [default: for
    /// songs the first of --programs, for notes init]
    #[arg(long, value_name = "NAME|FILE.toml", add = ArgValueCompleter::new(completion::presets))]
    preset: Option<OsString>,
    /// Factory preset or kit, one of your own, or a file, that a channel (1-16) starts with, as in 10=drums.toml; may be repeated
    #[arg(long, value_name = "CHANNEL=NAME|FILE.toml", value_parser = quantity::channel)]
    channel: Vec<(u8, String)>,
    /// What program changes select: gm is the factory's sounds for General MIDI, with drums on channel 10; none leaves
    /// program changes out; or a list of one's own
    #[arg(long, default_value = "gm", value_name = "gm|none|FILE.toml", add = completion::among(&["gm", "none"]))]
    programs: OsString,
    /// Set a parameter of every preset used; may be repeated. See `sprung params`
    #[arg(long, value_name = "ID=VALUE", value_parser = quantity::setting,
        add = ArgValueCompleter::new(completion::settings))]
    set: Vec<(Param, f32)>,
    /// Gain of the sum of all sounds before the limiter, -120-120 dB; --set gain would give every preset the same gain
    #[arg(long, default_value_t = 0.0, value_name = "DB", value_parser = quantity::gain_db, allow_hyphen_values = true)]
    pub(super) mix_gain_db: f64,
    #[command(flatten)]
    tuning: TuningArgs,
    /// Seed of all randomness, 0-18446744073709551615
    #[arg(long, default_value_t = 0, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u64>(0..=u64::MAX))]
    pub(super) seed: u64,
}

impl SoundArgs {
    pub(super) fn request(&self) -> SoundRequest {
        SoundRequest {
            preset: self.preset.clone(),
            channels: self.channel.clone(),
            programs: self.programs.clone(),
            set: self.set.clone(),
            mix_gain_db: self.mix_gain_db,
            tuning: self.tuning.request(),
        }
    }
}
