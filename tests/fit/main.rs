//! Presets rendered and fitted again, and recordings of real instruments: how near the fit comes, as measured.
//!
//! Recordings are those of Debian's packages `fluid-soundfont-gm` (with `fluidsynth`) and `hydrogen-drumkits`; those that are not
//! installed are skipped by name. What takes minutes is ignored unless `--include-ignored` or `--ignored` asks for it.

mod bodies;
mod installed;
mod measures;
mod played;

use installed::Pair;
use libtest_mimic::{Arguments, Failed, Trial};
use measures::Measures;
use played::{fitted, in_parallel, log_mel_distance, preset_at};
use sprung::Error;
use sprung::analysis::log_mel::RATE;
use sprung::analysis::measures::{DRUMS, TUNED};
use sprung::preset::Preset;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let trials = vec![
        Trial::test("round_trip_of_some_presets", || round_trips(&some())),
        Trial::test("a_cancelled_fit_asks_no_more", cancelled),
        Trial::test("bodies_have_the_levels_of_their_modes", bodies::levels),
        Trial::test("round_trip_of_every_preset", || round_trips(&every())).with_ignored_flag(true),
        Trial::test("recordings", recordings).with_ignored_flag(true),
        Trial::test("layers_of_recordings", layers).with_ignored_flag(true),
    ];
    libtest_mimic::run(&arguments, trials).exit_code()
}

const KEYS: [u8; 3] = [48, 60, 72];
/// Presets of the suite's part: every so many of the bank, each at one of [`KEYS`].
const SOME: usize = 24;

type Note = (&'static Preset, u8);

fn some() -> Vec<Note> {
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

/// Every preset at its home key and an octave below and above, where its range has them; with `SPRUNG_EVERY=N` only
/// every Nth of these notes.
fn every() -> Vec<Note> {
    let step = std::env::var("SPRUNG_EVERY").ok().and_then(|step| step.parse().ok()).unwrap_or(1_usize);
    let notes = |preset: &'static Preset| {
        let guide = &preset.guide;
        let keys = [guide.home.checked_sub(12), Some(guide.home), guide.home.checked_add(12)];
        let within = move |key: &u8| *key == guide.home || (guide.lowest..=guide.highest).contains(key);
        keys.into_iter().flatten().filter(within).map(move |key| (preset, key))
    };
    Preset::factory().iter().flat_map(notes).step_by(step.max(1)).collect()
}

/// Median distance in dB of a fit from its preset, and that from which on it is far; and the share of notes that may be.
const MEDIAN: f64 = 1.0;
const FAR: f64 = 3.0;
const FEW: f64 = 0.15;
/// Greatest distance in dB.
const WORST: f64 = 4.0;

fn round_trip((preset, key): &Note) -> Result<f64, Failed> {
    let sound = preset_at(preset, *key);
    let fit = fitted(&sound, (*key).into())?;
    // From the text of the preset, which is what users get.
    let written = Preset::parse(&fit.preset("again", "").to_toml(), "again")?;
    Ok(log_mel_distance(&sound, &preset_at(&written, *key)))
}

fn round_trips(notes: &[Note]) -> Result<(), Failed> {
    let mut table: Vec<(f64, &Note)> = in_parallel(notes, |note| round_trip(note).map(|distance| (distance, note)))
        .into_iter()
        .collect::<Result<_, _>>()?;
    table.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!("| preset | key | distance |\n|---|---|---|");
    table.iter().for_each(|(distance, (preset, key))| println!("| {} | {key} | {distance:.2} dB |", preset.name));
    let (median, worst) = (table[table.len() / 2].0, table[table.len() - 1].0);
    let far = table.iter().filter(|(distance, _)| *distance > FAR).count();
    let summary = format!("median {median:.2} dB, worst {worst:.2} dB; {far} of {} beyond {FAR} dB", table.len());
    println!("{summary}");
    assert!(median < MEDIAN && worst < WORST && far as f64 <= FEW * table.len() as f64, "{summary}");
    Ok(())
}

/// Calls of the progress, after one of which the work is cancelled, and how often it may be told again.
const CALLS: [usize; 6] = [1, 2, 6, 20, 60, 150];
const AGAIN: usize = 8;

/// Cancelled at any time, a fit ends with the next word of its progress.
fn cancelled() -> Result<(), Failed> {
    let preset = Preset::find("init")?;
    let sound = preset_at(preset, KEYS[1]).map(|channel| channel[..RATE as usize / 4].to_vec());
    for most in CALLS {
        let mut calls = 0;
        let result = played::fitted_while(&sound, KEYS[1].into(), &mut |_| {
            calls += 1;
            calls < most
        });
        if !matches!(result, Err(Error::Interrupted)) || calls > most + AGAIN {
            return Err(format!("{calls} calls, cancelled at {most}: {:?}", result.map(|_| ())).into());
        }
    }
    Ok(())
}

/// A fit has to pass the measures that its recording passes, and be nearer to it than another recording of the same instrument,
/// for this share of the sounds.
const LIKE: f64 = 2.0 / 3.0;

/// A line of the table, and whether the fit is like its recording.
fn compared(Pair { name, source, sound, others, key, is_drum }: &Pair) -> Result<(String, bool), Failed> {
    let fit = fitted(sound, *key)?;
    let own = log_mel_distance(sound, &fit.played);
    let other = others.iter().map(|other| log_mel_distance(sound, other)).fold(f64::INFINITY, f64::min);
    let least = if *is_drum { &DRUMS } else { &TUNED };
    let (recording, played) = (Measures::of(sound), Measures::of(&fit.played));
    let short = played.short_of(&recording, least);
    let pair = |value: fn(&Measures) -> String| format!("{} → {}", value(&recording), value(&played));
    let motion = |measures: &Measures| measures.motion_db.map_or("–".to_owned(), |motion| format!("{motion:.1}"));
    let line = format!(
        "| {name} | {source} | {own:.1} | {other:.1} | {} | {} | {} | {} | {} |",
        pair(|measures| format!("{:.0}", measures.flatness_db)),
        pair(|measures| format!("{:.0}", measures.high_db)),
        pair(motion),
        pair(|measures| measures.partials.to_string()),
        if short.is_empty() { "all".to_owned() } else { format!("not {}", short.join(", ")) },
    );
    Ok((line, own < other && short.is_empty()))
}

fn recordings() -> Result<(), Failed> {
    let pairs = installed::all();
    let lines: Vec<(String, bool)> = in_parallel(&pairs, compared).into_iter().collect::<Result<_, _>>()?;
    println!(
        "| sound | from | fit, dB | other recording, dB | flatness, dB | highs, dB | motion, dB | partials | passes |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    lines.iter().for_each(|(line, _)| println!("{line}"));
    let like = lines.iter().filter(|(_, is_like)| *is_like).count();
    println!("{like} of {} are nearer than another recording and pass what theirs passes", lines.len());
    assert!(like as f64 >= LIKE * lines.len() as f64, "{like} of {}", lines.len());
    Ok(())
}

/// Velocities and keys that a preset is fitted to, and others that it is compared with.
const FITTED: [(u8, u8); 5] = [(60, 40), (60, 80), (60, 120), (48, 80), (72, 80)];
const LEFT_OUT: [(u8, u8); 4] = [(60, 60), (60, 100), (54, 80), (66, 80)];

/// How far a preset fitted to several takes is from takes that it was not fitted to, beside one that was fitted to a single take.
fn layers() -> Result<(), Failed> {
    let (mut all, mut single) = (0.0, 0.0);
    let mut count = 0;
    println!("| instrument | key, velocity | several takes, dB | one take, dB |\n|---|---|---|---|");
    for (name, take) in installed::layered() {
        let (Some(takes), Some(others)) = (
            FITTED.map(&take).into_iter().collect::<Option<Vec<_>>>(),
            LEFT_OUT.map(&take).into_iter().collect::<Option<Vec<_>>>(),
        ) else {
            println!("skipped: {name} is not installed");
            continue;
        };
        let fits = [&takes[..], &takes[1..2]].map(played::fitted_to);
        for (other, (key, velocity)) in others.iter().zip(LEFT_OUT) {
            let [several, one] = [&fits[0], &fits[1]].map(|fit| {
                let preset = fit.as_ref().map(|fit| fit.preset("again", ""));
                preset.map_or(f64::INFINITY, |preset| {
                    log_mel_distance(&other.sound, &played::preset_struck(&preset, key, velocity))
                })
            });
            println!("| {name} | {key}, {velocity} | {several:.1} | {one:.1} |");
            (all, single, count) = (all + several, single + one, count + 1);
        }
    }
    if count > 0 {
        let [all, single] = [all, single].map(|sum| sum / f64::from(count));
        println!("mean {all:.2} dB, {single:.2} dB from one take");
        assert!(all < single, "{all:.2} dB, {single:.2} dB from one take");
    }
    Ok(())
}
