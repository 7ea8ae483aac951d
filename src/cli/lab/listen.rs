//! `sprung lab listen`.

use super::super::quantity;
use super::deliver::{Files, drawn};
use super::system::MethodArgs;
use super::table::{aligned, row};
use sprung::internals::text::short;
use sprung::io::{SampleFormat, WavFormat, WavWriter};
use sprung::lab::figure::SoundFigure;
use sprung::lab::sound::{Sound, listen};
use sprung::{Error, Result};
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct Args {
    /// Directory for the WAV files, made if missing: one per method, named after it
    #[arg(default_value = ".")]
    directory: PathBuf,
    #[command(flatten)]
    methods: MethodArgs,
    /// Frequency of the strike in Hz, below half the sample rate
    #[arg(long, default_value = "440", value_name = "HZ", value_parser = quantity::hertz)]
    frequency: f64,
    /// Time in which it decays by 60 dB, in s (inf: never)
    #[arg(long, default_value_t = 2.0, value_name = "S")]
    t60: f64,
    /// Length of the files in s
    #[arg(long, default_value_t = 2.0, value_name = "S")]
    seconds: f64,
    /// Sample rate, 1000-768000 Hz (44100, 44.1k)
    #[arg(long, default_value = "48000", value_name = "HZ", value_parser = quantity::rate)]
    rate: u32,
    #[command(flatten)]
    files: Files,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let methods = args.methods.named()?;
    let mut deliveries = args.files.open(&["svg", "png"])?;
    let rate = f64::from(args.rate);
    // Check all values before the directory is made.
    let mut sounds = Vec::new();
    for method in &methods {
        sounds.push(listen(*method, args.frequency, args.t60, args.seconds, rate)?);
    }
    let failed = |error| Error::io(args.directory.display().to_string(), error);
    std::fs::create_dir_all(&args.directory).map_err(failed)?;
    let path = |sound: &Sound| args.directory.join(format!("{}.wav", sound.method.key()));
    for sound in &sounds {
        deliveries.add(path(sound), |output| {
            let name = output.name().to_owned();
            let format = WavFormat { sample_rate: args.rate, channels: 1, samples: SampleFormat::Int24 };
            let mut writer = WavWriter::new(output.stream(), &name, format, None, Some(sound.samples.len() as u64))?;
            writer.write(&sound.samples, &sound.samples)?;
            writer.finish()?;
            Ok(())
        })?;
    }
    let title = format!("{} Hz, decay by 60 dB in {} s, at {rate} Hz", short(args.frequency), args.t60);
    let figure = SoundFigure { sounds: &sounds, sample_rate: rate, title: &title };
    deliveries.finish(
        |format| drawn(&figure, format),
        |out| out.write_all(csv(&sounds).as_bytes()),
        &table(&sounds, path),
    )
}

fn table(sounds: &[Sound], path: impl Fn(&Sound) -> PathBuf) -> String {
    let mut rows = vec![row(["file", ""])];
    for sound in sounds {
        let remark = sound.limited.map_or(String::new(), |t| {
            format!("explodes: limited from {t:.3} s on, by {:.0} dB in the end", sound.reduction_db)
        });
        rows.push(vec![path(sound).display().to_string(), remark]);
    }
    aligned(&rows)
}

fn csv(sounds: &[Sound]) -> String {
    let mut csv = String::from("method,peak,limited_from_s,reduction_db\n");
    for sound in sounds {
        let peak = sound.samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        let limited = sound.limited.map_or(String::new(), |t| t.to_string());
        csv += &format!("{},{peak},{limited},{}\n", sound.method.key(), sound.reduction_db);
    }
    csv
}
