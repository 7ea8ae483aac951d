//! Presets rendered and fitted again: how far the fit's sound is from the preset's.

use super::clock::Clock;
use super::played::{Outcome, Stereo, fitted, in_parallel, log_mel_distance, preset_at, preset_let_go, preset_of_seed};
use sprung::Error;
use sprung::analysis::log_mel::RATE;
use sprung::params::Param;
use sprung::preset::Preset;

const KEYS: [u8; 3] = [48, 60, 72];
/// A preset that is fitted at every commit, in seconds.
const ONE: (&str, u8) = ("Xylophone", 72);
/// Number of presets that are fitted in minutes: at equal distances in the bank, each at one of [`KEYS`].
const MANY: usize = 24;
/// Another seed than that of the sounds which are fitted.
const OTHER_SEED: u64 = 1;

/// A preset and a key.
type Note = (&'static Preset, u8);

/// Some presets that are struck.
fn some() -> Vec<Note> {
    let bank = Preset::factory();
    let step = bank.len().div_ceil(MANY);
    let notes = bank.iter().step_by(step).enumerate().map(|(n, preset)| (preset, KEYS[n % KEYS.len()]));
    notes.filter(|(preset, _)| is_struck(preset)).collect()
}

/// Whether a preset is struck or plucked and rings freely. A fit does not explain sounds that last as long as their key is held.
fn is_struck(preset: &Preset) -> bool {
    use sprung::preset::Family::{Bowed, Drone, Lead, Pad, Wind};
    !matches!(preset.guide.family, Some(Bowed | Drone | Lead | Pad | Wind))
        && preset.tags.iter().all(|tag| !["organ", "voice", "bow"].contains(&tag.as_str()))
}

/// With `SPRUNG_EVERY=N`, every Nth note of all presets: each at its home key and an octave below and above, where its range has them. `SPRUNG_KEYS=home` keeps the home keys
/// only, `SPRUNG_PRESETS=NAME,…` the presets whose names begin with one of these, and `SPRUNG_FROM=N` begins at that note.
fn every() -> Option<Vec<Note>> {
    let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse::<usize>().ok());
    let (step, from) = (number("SPRUNG_EVERY")?, number("SPRUNG_FROM").unwrap_or(0));
    let home_only = std::env::var("SPRUNG_KEYS").is_ok_and(|keys| keys == "home");
    let names = std::env::var("SPRUNG_PRESETS").unwrap_or_default();
    let is_named = |preset: &&Preset| names.split(',').any(|name| preset.name.starts_with(name));
    let notes = |preset: &'static Preset| {
        let guide = &preset.guide;
        let keys = [guide.home.checked_sub(12), Some(guide.home), guide.home.checked_add(12)];
        let within = move |key: &u8| *key == guide.home || !home_only && (guide.lowest..=guide.highest).contains(key);
        keys.into_iter().flatten().filter(within).map(move |key| (preset, key))
    };
    Some(Preset::factory().iter().filter(is_named).flat_map(notes).skip(from).step_by(step.max(1)).collect())
}

/// Bound of the median distance in dB of a fit from its preset; distance beyond which a fit is far; and largest share of such
/// fits.
const MEDIAN: f64 = 1.0;
const FAR: f64 = 3.0;
const FAR_SHARE: f64 = 0.15;
/// Greatest distance in dB.
const WORST: f64 = 4.0;

/// The distance in dB between a note and its fit.
fn round_trip(sound: &Stereo, (_, key): &Note) -> Result<f64, Error> {
    let fit = fitted(sound, (*key).into())?;
    // The preset is read from its text, which is what users get.
    let written = Preset::parse(&fit.preset("again", "").to_toml(), "again")?;
    let let_go = fit.release.map(|release| release.seconds);
    let seconds = sound[0].len() as f64 / f64::from(RATE);
    Ok(log_mel_distance(sound, &preset_let_go(&written, *key, let_go, seconds)))
}

/// Presets whose key is let go, with key and seconds: a string that is damped while it rings, and a held sound.
const LET_GO: [(&str, u8, f64); 2] = [("Nylon Guitar", 52, 0.6), ("Square Lead", 60, 1.2)];
/// Seconds that are recorded after that.
const AFTER: f64 = 0.5;
/// Greatest distance in dB, and greatest errors: in seconds, and of the T60 as a ratio.
const NEAR: f64 = 1.0;
const LATE: f64 = 0.03;
const LONGER: f64 = 1.3;

/// The fit of a sound whose key is let go sounds like all of it if it is played so.
#[test]
#[ignore = "takes minutes"]
fn releases_are_fitted_too() -> Outcome<()> {
    for (name, key, seconds) in LET_GO {
        let preset = Preset::find(name)?;
        let t60 = f64::from(preset.patch.get(Param::Release));
        let sound = preset_let_go(preset, key, Some(seconds), seconds + AFTER);
        let fit = fitted(&sound, key.into())?;
        let release = fit.release.ok_or_else(|| format!("{name}: no release was found"))?;
        let written = Preset::parse(&fit.preset("again", "").to_toml(), "again")?;
        let again = preset_let_go(&written, key, Some(release.seconds), seconds + AFTER);
        let distance = log_mel_distance(&sound, &again);
        println!("{name}: {distance:.2} dB, {release:?}");
        let is_near = distance < NEAR && (release.seconds - seconds).abs() < LATE;
        if !is_near || !(t60 / LONGER..t60 * LONGER).contains(&release.t60) {
            return Err(format!("{name}: {distance:.2} dB, {release:?}: expected {seconds} s and {t60} s").into());
        }
    }
    Ok(())
}

/// Prints the table's line of a note and returns the distance: infinite if there is no fit.
fn told(note: &Note) -> f64 {
    let (preset, key) = note;
    let (sound, clock) = (preset_at(preset, *key), Clock::start());
    let distance = round_trip(&sound, note);
    let seconds = clock.seconds();
    // Noise differs with each seed, so a fit may differ from the sound by as much as another seed does.
    let again = log_mel_distance(&sound, &preset_of_seed(preset, *key, OTHER_SEED));
    let text = match &distance {
        Ok(distance) => format!("{distance:.2} dB"),
        Err(error) => format!("{error}"),
    };
    println!("| {} | {key} | {text} | {again:.2} dB | {seconds:.0} |", preset.name);
    distance.unwrap_or(f64::INFINITY)
}

/// Fits all notes and checks their distances.
fn round_trips(notes: &[Note]) -> Outcome<()> {
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
    assert!(median < MEDIAN && worst < WORST && far as f64 <= FAR_SHARE * distances.len() as f64, "{summary}");
    Ok(())
}

#[test]
fn round_trip_of_a_preset() -> Outcome<()> {
    round_trips(&[(Preset::find(ONE.0)?, ONE.1)])
}

#[test]
#[ignore = "takes minutes"]
fn round_trip_of_many_presets() -> Outcome<()> {
    round_trips(&every().unwrap_or_else(some))
}
