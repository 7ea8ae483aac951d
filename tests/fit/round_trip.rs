//! Presets rendered and fitted again: how far the fit's sound is from the preset's.

use crate::clock::Clock;
use crate::played::{Stereo, fitted_while, in_parallel, log_mel_distance, preset_at, preset_of_seed};
use libtest_mimic::Failed;
use sprung::Error;
use sprung::preset::Preset;

const KEYS: [u8; 3] = [48, 60, 72];
/// Presets of the suite's part: every so many of the bank, each at one of [`KEYS`].
const SOME: usize = 24;
/// Seconds that a note may take; one that takes longer has failed.
const LONGEST: f64 = 120.0;
/// Another seed than that of the sounds which are fitted.
const OTHER_SEED: u64 = 1;

/// A preset and a key.
pub(crate) type Note = (&'static Preset, u8);

/// Some presets that are struck.
pub(crate) fn some() -> Vec<Note> {
    // A debug build takes twenty times as long.
    let count = if cfg!(debug_assertions) { 2 } else { SOME };
    let bank = Preset::factory();
    let step = bank.len().div_ceil(count);
    let notes = bank.iter().step_by(step).enumerate().map(|(n, preset)| (preset, KEYS[n % KEYS.len()]));
    notes.filter(|(preset, _)| is_struck(preset)).collect()
}

/// Whether a preset is struck or plucked and rings freely: what lasts as long as its key is held is not what a fit explains.
fn is_struck(preset: &Preset) -> bool {
    use sprung::preset::Family::{Bowed, Drone, Lead, Pad, Wind};
    !matches!(preset.guide.family, Some(Bowed | Drone | Lead | Pad | Wind))
        && preset.tags.iter().all(|tag| !["organ", "voice", "bow"].contains(&tag.as_str()))
}

/// Every preset at its home key and an octave below and above, where its range has them. `SPRUNG_KEYS=home` leaves the home keys,
/// `SPRUNG_PRESETS=NAME,…` presets whose names begin so, and `SPRUNG_EVERY=N` every Nth of these notes, from `SPRUNG_FROM=N` on.
pub(crate) fn every() -> Vec<Note> {
    let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse::<usize>().ok());
    let (step, from) = (number("SPRUNG_EVERY").unwrap_or(1), number("SPRUNG_FROM").unwrap_or(0));
    let home_only = std::env::var("SPRUNG_KEYS").is_ok_and(|keys| keys == "home");
    let names = std::env::var("SPRUNG_PRESETS").unwrap_or_default();
    let is_named = |preset: &&Preset| names.split(',').any(|name| preset.name.starts_with(name));
    let notes = |preset: &'static Preset| {
        let guide = &preset.guide;
        let keys = [guide.home.checked_sub(12), Some(guide.home), guide.home.checked_add(12)];
        let within = move |key: &u8| *key == guide.home || !home_only && (guide.lowest..=guide.highest).contains(key);
        keys.into_iter().flatten().filter(within).map(move |key| (preset, key))
    };
    Preset::factory().iter().filter(is_named).flat_map(notes).skip(from).step_by(step.max(1)).collect()
}

/// Median distance in dB of a fit from its preset, and that from which on it is far; and the share of notes that may be.
const MEDIAN: f64 = 1.0;
const FAR: f64 = 3.0;
const FEW: f64 = 0.15;
/// Greatest distance in dB.
const WORST: f64 = 4.0;

/// The distance of a note's fit from it.
fn round_trip(sound: &Stereo, (_, key): &Note, clock: &Clock) -> Result<f64, Error> {
    let fit = fitted_while(sound, (*key).into(), &mut |_| clock.seconds() < LONGEST)?;
    // From the text of the preset, which is what users get.
    let written = Preset::parse(&fit.preset("again", "").to_toml(), "again")?;
    Ok(log_mel_distance(sound, &preset_at(&written, *key)))
}

/// A line of the table as soon as it is known, and the distance: infinite where there is no fit.
fn told(note: &Note) -> f64 {
    let (preset, key) = note;
    let (sound, clock) = (preset_at(preset, *key), Clock::start());
    let distance = round_trip(&sound, note, &clock);
    let seconds = clock.seconds();
    // What noise moves sounds different each time: by as much, a fit may be off by chance.
    let again = log_mel_distance(&sound, &preset_of_seed(preset, *key, OTHER_SEED));
    let text = match &distance {
        Ok(distance) => format!("{distance:.2} dB"),
        Err(Error::Interrupted) => "too slow".to_owned(),
        Err(error) => format!("{error}"),
    };
    println!("| {} | {key} | {text} | {again:.2} dB | {seconds:.0} |", preset.name);
    distance.unwrap_or(f64::INFINITY)
}

/// Fits all of some notes, and says how far they are.
pub(crate) fn round_trips(notes: &[Note]) -> Result<(), Failed> {
    println!("| preset | key | distance | of other noise | seconds |\n|---|---|---|---|---|");
    let mut distances = in_parallel(notes, told);
    if distances.is_empty() {
        return Err("no note was fitted: expected presets of the factory bank".into());
    }
    distances.sort_by(f64::total_cmp);
    let (median, worst) = (distances[distances.len() / 2], distances[distances.len() - 1]);
    let far = distances.iter().filter(|distance| **distance > FAR).count();
    let summary = format!("median {median:.2} dB, worst {worst:.2} dB; {far} of {} beyond {FAR} dB", distances.len());
    println!("{summary}");
    assert!(median < MEDIAN && worst < WORST && far as f64 <= FEW * distances.len() as f64, "{summary}");
    Ok(())
}
