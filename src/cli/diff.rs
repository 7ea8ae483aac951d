//! `sprung diff`: tells whether two sound files are the same, and if not, where and by how much they differ.

use super::recording::{FigureArgs, read};
use super::terminal::{complain, counted, print};
use super::{interrupt, quantity};
use libm::log10;
use serde_json::json;
use sprung::analysis::Comparison;
use sprung::analysis::figure::{Render, comparison_bytes};
use sprung::analysis::log_mel;
use sprung::internals::files::Inputs;
use sprung::internals::measures::level::mono;
use sprung::io::sound_file::{Recording, resampled};
use sprung::{Error, Result};
use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung diff before.wav after.wav
  sprung diff before.wav after.flac --tolerance-db -90 --figure difference.png
  sprung diff before.wav after.wav --json

Exit codes: 0 the same, 1 different, 2 an error or wrong usage, 130 interrupted.";

/// Exit code if the files cannot be compared, as in `diff` and `cmp`.
const TROUBLE: u8 = 2;

#[derive(clap::Args)]
pub(super) struct Args {
    /// The sound that is expected: WAV, AIFF, FLAC, Ogg Vorbis or MP3; - is stdin
    #[arg(value_name = "EXPECTED")]
    expected: PathBuf,
    /// The sound that is compared with it
    #[arg(value_name = "ACTUAL")]
    actual: PathBuf,
    /// Largest error that still counts as the same, in dBFS [default: none]
    #[arg(long, value_name = "DBFS", value_parser = quantity::tolerance_db, allow_hyphen_values = true)]
    tolerance_db: Option<f64>,
    /// Print the differences as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    figure: FigureArgs,
}

/// Compares the files and returns the exit code.
pub(super) fn run(args: &Args) -> ExitCode {
    match compare(args) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            complain("error", &error);
            let interrupted = matches!(error, Error::Interrupted);
            ExitCode::from(if interrupted { interrupt::INTERRUPTED } else { TROUBLE })
        }
    }
}

/// Whether the files are the same.
fn compare(args: &Args) -> Result<bool> {
    if [&args.expected, &args.actual].into_iter().all(|path| path == Path::new("-")) {
        return Err(Error::value("stdin", "both sounds are read from it: expected a file for one of them"));
    }
    let mut inputs = Inputs::default();
    let (expected, first) = read(&args.expected, &mut inputs)?;
    let (actual, second) = read(&args.actual, &mut inputs)?;
    interrupt::end_at_once()?;
    let mut is_finite = true;
    for (name, sound) in [(first, &expected), (second, &actual)] {
        if let Err(error) = sound.check_finite(&name) {
            complain("warning", &error);
            is_finite = false;
        }
    }
    let figure = args.figure.open(&inputs)?;
    // Samples can be compared only at the same rate. Different rates still count as a difference.
    let converted = resampled(&actual, expected.sample_rate)?;
    let channels = expected.channels.len().max(actual.channels.len());
    let [before, after] = [&expected, &converted].map(|sound| on_channels(sound, channels));
    let found = Comparison::of(&before, &after, f64::from(expected.sample_rate));
    let same_kind = expected.sample_rate == actual.sample_rate && expected.channels.len() == actual.channels.len();
    let within = match (&found, args.tolerance_db) {
        (None, _) => true,
        (Some(found), Some(tolerance)) => found.difference.worst_dbfs <= tolerance,
        (Some(_), None) => false,
    };
    let same = same_kind && within;
    if let Some(figure) = figure {
        let [before, after] = [&expected, &converted].map(sides);
        let title = format!("{} and {}", args.expected.display(), args.actual.display());
        figure.write(|format| comparison_bytes(before, after, &title, format))?;
    }
    let distance = match &found {
        None => Some(0.0),
        Some(_) if is_finite => Some(mel_distance(&expected, &actual)?),
        Some(_) => None,
    };
    let converted = converted.frames();
    let report = Report { expected: &expected, actual: &actual, converted, found: found.as_ref(), distance, same };
    print(&if args.json { format!("{:#}\n", report.json()) } else { report.text() })?;
    Ok(same)
}

/// The channels of a sound for a comparison on `count` channels: a mono sound is repeated on each of them.
fn on_channels(sound: &Recording, count: usize) -> Cow<'_, [Vec<f32>]> {
    match &sound.channels[..] {
        [mono] if count > 1 => Cow::Owned(vec![mono.clone(); count]),
        channels => Cow::Borrowed(channels),
    }
}

/// The distance in dB of the means of both sounds, whose samples are finite, each from its onset on, as `fit` measures it.
fn mel_distance(expected: &Recording, actual: &Recording) -> Result<f64> {
    let mean = |sound: &Recording| -> Result<Vec<f32>> {
        let (channels, encoding) = (vec![mono(&sound.channels)], String::new());
        let mean = Recording { sample_rate: sound.sample_rate, channels, encoding, warnings: Vec::new() };
        Ok(resampled(&mean, log_mel::RATE)?.channels.remove(0))
    };
    Ok(log_mel::distance(&mean(expected)?, &mean(actual)?))
}

/// A change of a level in dB with as many digits as it takes to tell it from 0.
fn change(db: f64) -> String {
    let places = if db == 0.0 { 2 } else { (1.0 - log10(db.abs()).floor()).clamp(2.0, 6.0) as usize };
    format!("{db:+.places$}")
}

/// The first two channels, for figures.
fn sides(sound: &Recording) -> Render<'_> {
    let right = sound.channels.get(1).unwrap_or(&sound.channels[0]);
    Render { left: &sound.channels[0], right, sample_rate: f64::from(sound.sample_rate) }
}

struct Report<'a> {
    expected: &'a Recording,
    actual: &'a Recording,
    /// Frames of the actual sound at the rate of the expected one.
    converted: usize,
    found: Option<&'a Comparison>,
    /// Distance of 48 mel bands over time, in dB.
    distance: Option<f64>,
    same: bool,
}

impl Report<'_> {
    fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |line: String| writeln!(text, "{line}").expect("a String takes all");
        let [expected, actual] = [self.expected, self.actual];
        if expected.sample_rate != actual.sample_rate {
            let [before, after] = [expected.sample_rate, actual.sample_rate];
            line(format!("sample rate {before} Hz → {after} Hz: compared at {before} Hz"));
        }
        let [before, after] = [expected.channels.len(), actual.channels.len()];
        if before != after {
            let how = match before.min(after) {
                1 => "the mono sound is compared with each channel",
                _ => "what only one has is compared with silence",
            };
            line(format!("{} → {after}: {how}", counted(before, "channel")));
        }
        let rate = f64::from(expected.sample_rate);
        let seconds = [expected.frames(), self.converted].map(|frames| frames as f64 / rate);
        if expected.frames() != self.converted {
            line(format!(
                "length {:.3} s → {:.3} s ({} → {}): what is beyond the shorter one is compared with silence",
                seconds[0],
                seconds[1],
                expected.frames(),
                counted(self.converted, "frame")
            ));
        }
        let Some(found) = self.found else {
            let verdict = if self.same { "the same" } else { "different, but the same samples" };
            line(format!("{verdict}: {}, every sample", counted(expected.frames(), "frame")));
            return text;
        };
        let verdict = if self.same { "within the tolerance" } else { "different" };
        line(format!("{verdict}: {}", found.difference));
        if let Some(moved) = found.moved() {
            let shift = match moved.shift {
                0 => "in place".to_owned(),
                shift => format!(
                    "{} {}",
                    counted(shift.unsigned_abs(), "frame"),
                    if shift > 0 { "later" } else { "earlier" }
                ),
            };
            let inverted = if moved.gain < 0.0 { ", inverted" } else { "" };
            line(format!(
                "the same sound, {shift}, at {} dB{inverted}: what is left is {:.1} dB below it",
                change(moved.gain_db()),
                -moved.residual_db
            ));
        }
        if let Some(distance) = self.distance {
            line(format!("{distance:.2} dB apart in 48 mel bands over time, each sound from its onset on"));
        }
        for octave in &found.octaves {
            line(format!(
                "{:>8} Hz  {:>7.1} → {:>6.1} dBFS, difference {:>6.1}",
                octave.frequency, octave.expected_db, octave.actual_db, octave.difference_db
            ));
        }
        text
    }

    /// The report as JSON. Infinite levels are null; they occur where a sample is not a number.
    fn json(&self) -> serde_json::Value {
        let sound = |sound: &Recording| {
            json!({
                "sample_rate": sound.sample_rate,
                "channels": sound.channels.len(),
                "frames": sound.frames(),
                "encoding": sound.encoding,
            })
        };
        let difference = self.found.map(|found| found.difference);
        let alignment = self.found.and_then(|found| found.alignment);
        let octaves: Option<Vec<_>> = self.found.map(|found| {
            let octave = |octave: &sprung::analysis::Octave| {
                json!({
                    "frequency": octave.frequency,
                    "expected_db": octave.expected_db,
                    "actual_db": octave.actual_db,
                    "difference_db": octave.difference_db,
                })
            };
            found.octaves.iter().map(octave).collect()
        });
        json!({
            "same": self.same,
            "compared_at": self.expected.sample_rate,
            "expected": sound(self.expected),
            "actual": sound(self.actual),
            "first_frame": difference.map(|difference| difference.first_frame),
            "worst_frame": difference.map(|difference| difference.worst_frame),
            "worst_dbfs": difference.map(|difference| difference.worst_dbfs),
            "rms_dbfs": difference.map(|difference| difference.rms_dbfs),
            "alignment": alignment.map(|found| json!({
                "shift_frames": found.shift,
                "gain_db": found.gain_db(),
                "inverted": found.gain < 0.0,
                "residual_db": found.residual_db,
            })),
            "mel_distance_db": self.distance,
            "octaves": octaves,
        })
    }
}
