//! Writes a fit as one HTML file that works offline: both sounds to hear and to see, and their modes side by side.

use super::Fitted;
use crate::analysis::figure::Render;
use crate::analysis::figure::sound::{DrawnMode, Ranges, SoundFigure, modes_of};
use crate::analysis::modes::Mode;
use crate::error::Result;
use crate::figure::page::{STYLE, data_link, escaped, fill};
use crate::io::{SampleFormat, WavFormat, WavWriter};
use crate::text::number::measured;
use crate::units::frequency_from_key;
use libm::{fabs, log2};
use std::io::Cursor;

const PAGE: &str = include_str!("report.html");

/// Distance in cents below which a mode of the preset counts as one of the recording.
const NEAR: f64 = 50.0;

/// Makes the page with this title.
///
/// # Errors
/// [`Error::Format`](crate::Error::Format) if a figure cannot be drawn.
pub fn html(fitted: &Fitted, title: &str) -> Result<String> {
    let modes = modes_of(&fitted.patch, frequency_from_key(fitted.key, super::draft::A4));
    // A recording with one channel has it on both sides.
    let first = fitted.recording.first().map_or(&[][..], Vec::as_slice);
    let last = fitted.recording.last().map_or(&[][..], Vec::as_slice);
    let [left, right] = &fitted.played;
    let renders =
        [[first, last], [left, right]].map(|[left, right]| Render { left, right, sample_rate: fitted.sample_rate() });
    let ranges = Ranges::of(&renders);
    let figure = |title, render, modes| {
        Ok(data_link("image/png", &SoundFigure { title, render, modes, ranges, cell: 1 }.bytes("png")?))
    };
    let figures: [Result<String>; 2] = [figure("Recording", renders[0], &[]), figure("Preset", renders[1], &modes)];
    let [recording, preset] = figures;
    let (recording, preset) = (recording?, preset?);
    let sounds = [wav([first, last], fitted.sample_rate())?, wav([left, right], fitted.sample_rate())?];
    Ok(fill(PAGE, |name| match name {
        "style" => STYLE.to_owned(),
        "title" => escaped(title),
        "summary" => escaped(&format!("{}{}", fitted.summary(), others(fitted))),
        "warnings" => fitted.warnings.iter().map(|warning| format!("<p>Warning: {}</p>\n", escaped(warning))).collect(),
        "recording" => data_link("audio/wav", &sounds[0]),
        "preset" => data_link("audio/wav", &sounds[1]),
        "recording-figure" => recording.clone(),
        "preset-figure" => preset.clone(),
        "note" => escaped(&note(fitted, &modes)),
        _ => rows(fitted, &modes),
    }))
}

/// What the page does not show: the distances of several takes, of which it shows one.
fn others(fitted: &Fitted) -> String {
    if fitted.distances.len() == 1 {
        return String::new();
    }
    let distances: Vec<String> = fitted.distances.iter().map(|distance| format!("{distance:.2}")).collect();
    format!(
        " This is recording {} of {}; the preset is {} dB from them, in their order.",
        fitted.base + 1,
        distances.len(),
        distances.join(", ")
    )
}

fn note(fitted: &Fitted, modes: &[DrawnMode]) -> String {
    let mut text = "Modes of the recording with the nearest ones of the preset.".to_owned();
    match &fitted.strike {
        Some(strike) => text += &format!(" They leave {:.1} dB of the recording unexplained", strike.residual_db),
        None => text += " The recording has none",
    }
    match modes.iter().filter(|mode| mode.is_noisy).count() {
        0 => text + ".",
        noisy => {
            text + &format!("; {noisy} of the preset's {} modes are moved by noise and fill up its bands.", modes.len())
        }
    }
}

/// A line for each mode and tone, by rising frequency.
fn rows(fitted: &Fitted, modes: &[DrawnMode]) -> String {
    let row = |(mode, decays): &(&Mode, bool)| {
        let cents = |other: &&DrawnMode| 1200.0 * log2(other.frequency / mode.frequency);
        let nearest = modes.iter().min_by(|a, b| fabs(cents(a)).total_cmp(&fabs(cents(b))));
        let (frequency, off, t60) = match nearest.filter(|other| fabs(cents(other)) < NEAR) {
            Some(other) => (format!("{:.2}", other.frequency), format!("{:+.1}", cents(&other)), measured(other.t60)),
            None => ("–".to_owned(), "–".to_owned(), "–".to_owned()),
        };
        format!(
            "<tr><th scope=\"row\">{:.2}</th><td>{frequency}</td><td>{off}</td><td>{}</td><td>{t60}</td><td>{:.1}</td><td>{:.0}</td></tr>\n",
            mode.frequency,
            if *decays { measured(mode.t60) } else { "steady".to_owned() },
            mode.level_db,
            mode.snr_db
        )
    };
    let mut found: Vec<(&Mode, bool)> = Vec::new();
    if let Some(strike) = &fitted.strike {
        found.extend(strike.modes.iter().map(|mode| (mode, true)));
        found.extend(strike.steady.iter().map(|tone| (tone, false)));
    }
    found.sort_by(|a, b| a.0.frequency.total_cmp(&b.0.frequency));
    found.iter().map(row).collect()
}

/// A WAV file in memory, of 16 bits.
fn wav([left, right]: [&[f32]; 2], sample_rate: f64) -> Result<Vec<u8>> {
    let format = WavFormat { sample_rate: sample_rate as u32, channels: 2, samples: SampleFormat::Int16 };
    let mut file = Vec::new();
    let mut writer = WavWriter::new(Cursor::new(&mut file), "report", format, None, None)?;
    writer.write(left, right)?;
    writer.finish()?;
    Ok(file)
}
