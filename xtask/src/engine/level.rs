//! `cargo xtask level`: measures the loudness of the factory's presets, and proposes gains that make it equal.

use crate::shell::root;
use sprung::internals::measures::preset::{chord_peaks, loudness, wanted_loudness};
use sprung::internals::text::slug;
use sprung::params::Param;
use sprung::preset::Preset;
use std::fs;

/// The most by which the limiter should lower a loud chord, in dB: half a decibel less than the bank's test allows.
const MOST_LIMITED: f64 = 5.5;

/// Smaller changes are not proposed, in dB.
const LEAST_CHANGE: f64 = 0.5;

/// Prints the loudness of every preset, and the gain that is proposed for it if it is to change. With `write`, sets it in
/// the preset's file.
pub(crate) fn run(write: bool) -> Result<(), String> {
    println!("{:24}{:14}{:>8}{:>10}{:>8}", "preset", "family", "LUFS", "limited", "gain");
    for preset in Preset::factory().iter().filter(|preset| preset.name != "init") {
        let Some(family) = preset.guide.family else { continue };
        let failed = |error: sprung::Error| format!("{}: {error}", preset.name);
        let Some(loudness) = loudness(preset).map_err(failed)? else {
            println!("{:24}{family:14}silent", preset.name);
            continue;
        };
        let [_, peak] = chord_peaks(preset).map_err(failed)?;
        // The limiter holds peaks to about -0.9 dBFS.
        let limited = (peak + 0.9).max(0.0);
        let wanted = wanted_loudness(preset);
        let middle = 0.5 * (wanted.start() + wanted.end());
        let change = (middle - loudness).min(MOST_LIMITED - limited);
        let is_right = wanted.contains(&loudness) && limited <= MOST_LIMITED + 0.5;
        let gain = f64::from(preset.patch.get(Param::Gain)) + change;
        let proposal = if is_right || change.abs() < LEAST_CHANGE { String::new() } else { format!("{gain:.1}") };
        println!("{:24}{:14}{loudness:>8.1}{limited:>10.1}{proposal:>8}", preset.name, family.name());
        if write && !proposal.is_empty() {
            set_gain(preset, &proposal)?;
        }
    }
    Ok(())
}

/// Replaces the gain in a preset's file, or adds it.
fn set_gain(preset: &Preset, gain: &str) -> Result<(), String> {
    let family = preset.guide.family.map_or("", |family| family.name());
    let path = root().join("assets/presets").join(family).join(format!("{}.toml", slug(&preset.name)));
    let at = |error: std::io::Error| format!("{}: {error}", path.display());
    let text = fs::read_to_string(&path).map_err(at)?;
    let line = format!("gain = {gain}");
    let is_gain = |line: &str| line.split('=').next().is_some_and(|key| key.trim() == "gain");
    let has_gain = text.lines().any(is_gain);
    let lines = text.lines().map(|old| match old {
        old if is_gain(old) => line.clone(),
        "[params]" if !has_gain => format!("[params]\n{line}"),
        old => old.to_owned(),
    });
    let new: String = lines.map(|line| line + "\n").collect();
    Preset::parse(&new, &path.display().to_string()).map_err(|error| error.to_string())?;
    fs::write(&path, new).map_err(at)
}
