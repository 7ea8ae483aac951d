//! `sprung sample`: makes a sampler instrument of a preset or kit.

use super::progress::Count;
use super::terminal::{complain_lines, counted};
use super::{completion, interrupt, quantity};
use clap_complete::ArgValueCompleter;
use sprung::Result;
use sprung::internals::files::Inputs;
use sprung::internals::request::{SoundRequest, playable};
use sprung::internals::threads::THREADS;
use sprung::io::{FileFormat, SampleFormat};
use sprung::params::Param;
use sprung::sampler::Sampling;
use sprung::units::parse_key;
use std::ffi::OsString;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Mutex;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung sample Marimba -o marimba
  sprung sample drums.toml -o drums --velocities 4 --strikes 3 --format flac
  sprung sample Celesta --set space=room --releases -o celesta
  sprung sample mine.toml -o mine --keys C2-C6 --every 2 --length 8
  sprung sample Marimba -o marimba --resume";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Factory preset or kit, one of your own, or a file (.toml)
    #[arg(value_name = "NAME|FILE.toml", add = ArgValueCompleter::new(completion::presets))]
    sound: OsString,
    /// Folder for the instrument: an SFZ and a DecentSampler file, and the samples
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Keys to play, names or 0-127 [default: those that the preset is meant for; all pads of a kit]
    #[arg(long, value_name = "LOW-HIGH", value_parser = keys)]
    keys: Option<RangeInclusive<u8>>,
    /// Semitones from one sampled key of a preset to the next, 1-127
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = quantity::whole::<u8>(1..=127))]
    every: u8,
    /// Velocity layers, 1-127; each is sampled at its highest velocity
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = quantity::whole::<u8>(1..=127))]
    velocities: u8,
    /// Strikes that alternate, 1-16; sounds whose strikes are all alike get one
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = quantity::whole::<u8>(1..=16))]
    strikes: u8,
    /// Sample what sounds after keys are let go too, such as a room; only the SFZ file plays it
    #[arg(long)]
    releases: bool,
    /// How long keys are held, and the longest sample, 0-86400 s
    #[arg(long, default_value = "4", value_name = "SECONDS", value_parser = quantity::seconds)]
    length: f64,
    /// Set a parameter of every preset used; may be repeated. See `sprung params`
    #[arg(long, value_name = "ID=VALUE", value_parser = quantity::setting,
        add = ArgValueCompleter::new(completion::settings))]
    set: Vec<(Param, f32)>,
    /// Sample rate, 1000-768000 Hz (44100, 44.1k)
    #[arg(long, default_value_t = 48_000, value_name = "HZ", value_parser = quantity::rate)]
    rate: u32,
    /// Sample format: 16 or 24 bits, or 32f for floats
    #[arg(long, default_value = "24", value_name = "16|24|32f", value_parser = quantity::bits,
        add = completion::among(&["16", "24", "32f"]))]
    bits: SampleFormat,
    /// Format of the samples
    #[arg(long, default_value = "wav", value_name = "wav|flac", value_parser = quantity::file_format,
        add = completion::among(&["wav", "flac"]))]
    format: FileFormat,
    /// Seed of all randomness
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = quantity::whole::<u64>(0..=u64::MAX))]
    seed: u64,
    /// Go on with an instrument that was broken off
    #[arg(long)]
    resume: bool,
    /// Samples to make at once, 1-256 [default: one a core]
    #[arg(long, value_name = "N",
        value_parser = quantity::whole::<u16>((*THREADS.start()).into()..=(*THREADS.end()).into()))]
    jobs: Option<u16>,
}

/// Parses a range of keys: names or numbers, as in `C2-C6` and `36-84`.
fn keys(text: &str) -> std::result::Result<RangeInclusive<u8>, String> {
    let key = |text: &str| {
        parse_key(text, 440.0).ok().filter(|key| key.fract() == 0.0 && (0.0..128.0).contains(key)).map(|key| key as u8)
    };
    // A name may have a minus sign of its own: C-1.
    let ranges = text.match_indices('-').filter_map(|(at, _)| Some(key(&text[..at])?..=key(&text[at + 1..])?));
    let wrong = || format!("‘{text}’ is no range of keys: expected LOW-HIGH, as in C2-C6 or 36-84");
    ranges.into_iter().find(|range| !range.is_empty()).ok_or_else(wrong)
}

pub(super) fn run(args: &Args) -> Result<()> {
    let mut inputs = Inputs::default();
    let mut playable = playable(&args.sound, &mut inputs)?;
    for preset in playable.presets_mut() {
        args.set.iter().for_each(|(param, value)| preset.patch.set(*param, *value));
    }
    let kit = SoundRequest::default().kit(playable.clone());
    let sampling = Sampling {
        folder: args.output.clone(),
        keys: args.keys.clone(),
        every: args.every,
        velocities: args.velocities,
        strikes: args.strikes,
        releases: args.releases,
        length: args.length,
        rate: args.rate,
        bits: args.bits,
        format: args.format,
        seed: args.seed,
        resume: args.resume,
        at_once: args.jobs,
    };
    interrupt::catch(true)?;
    let count = Mutex::new(Count::new());
    let made = sampling.run(&playable, &kit, &inputs, &|done, of| {
        if let Ok(mut count) = count.lock() {
            count.show(done as u64, 0, of as u64);
        }
        interrupt::check()
    });
    let made = made.inspect_err(|error| {
        if error.is_interrupt() {
            complain_lines(&format!("{}: --resume goes on from the finished samples\n", args.output.display()));
        }
    })?;
    let found = if made.found > 0 { format!(", {} found finished", made.found) } else { String::new() };
    let (samples, loops) = (counted(made.samples, "sample"), counted(made.loops, "loop"));
    complain_lines(&format!("{}: {samples}, {loops}{found}\n", args.output.display()));
    Ok(())
}
