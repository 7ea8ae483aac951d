//! Measures how near fits come to presets that are rendered and fitted again, and to recordings of real instruments.
//!
//! Recordings are those of Debian's packages `fluid-soundfont-gm` (with `fluidsynth`) and `hydrogen-drumkits`; those that are not
//! installed are skipped by name. Tests that take minutes run with `--ignored`.

mod bodies;
mod clock;
mod installed;
mod measures;
mod played;
mod round_trip;
mod speed;

use installed::Pair;
use measures::Measures;
use played::{Outcome, fitted, in_parallel, log_mel_distance, preset_at};
use sprung::Error;
use sprung::analysis::fit::Family;
use sprung::analysis::log_mel::RATE;
use sprung::internals::measures::{DRUMS, TUNED};
use sprung::internals::random::uniform;
use sprung::preset::Preset;

/// Numbers of progress calls after which the fit is cancelled, and the number of calls that may follow.
const CALLS: [usize; 6] = [1, 2, 6, 20, 40, 80];
const AGAIN: usize = 8;
const KEY: u8 = 60;
/// Samples over which the noise fades in.
const SWELL: usize = RATE as usize / 5;
/// Least number of different shares that the progress reports.
const STEPS: usize = 8;

/// A fit that is cancelled at any time ends after at most [`AGAIN`] more calls of its progress.
#[test]
fn a_cancelled_fit_asks_no_more() -> Outcome<()> {
    let preset = Preset::find("init")?;
    let sound = preset_at(preset, KEY).map(|channel| channel[..RATE as usize / 4].to_vec());
    for most in CALLS {
        let mut calls = 0;
        let result = played::fitted_while(&sound, KEY.into(), &mut |_| {
            calls += 1;
            calls < most
        });
        if !matches!(result, Err(Error::Interrupted)) || calls > most + AGAIN {
            return Err(format!("{calls} calls, cancelled at {most}: {:?}", result.map(|_| ())).into());
        }
    }
    Ok(())
}

/// The reported progress never falls, and ends with 1: for a stroke, for noise that fades in, of which every kind of draft is
/// made, and for a body.
#[test]
#[ignore = "takes half a minute"]
fn the_progress_never_runs_backwards() -> Outcome<()> {
    let swell = |n: usize, noise: f32| (n as f32 / SWELL as f32).min(1.0) * noise;
    let noise: Vec<f32> = (0..2 * SWELL).map(|n| swell(n, 0.5 * uniform(1, n as u64))).collect();
    let stroke = preset_at(Preset::find("init")?, KEY).map(|channel| channel[..RATE as usize / 4].to_vec());
    let cases = [
        ("a stroke", &stroke, Family::Table),
        ("noise", &[noise.clone(), noise], Family::Table),
        ("a bar", &stroke, Family::Bar),
    ];
    for (name, sound, family) in cases {
        let mut told = Vec::new();
        played::fitted_by(sound, KEY.into(), family, &mut |share| {
            told.push(share);
            true
        })?;
        if let Some(pair) = told.windows(2).find(|pair| pair[1] < pair[0]) {
            return Err(format!("{name}: {} follows {}", pair[1], pair[0]).into());
        }
        let mut steps = told.clone();
        steps.dedup();
        let (first, last) = (told[0], told[told.len() - 1]);
        if first < 0.0 || last != 1.0 || steps.len() < STEPS {
            return Err(format!("{name}: {first} to {last} in {} steps", steps.len()).into());
        }
    }
    Ok(())
}

/// A fit has to pass the measures that its recording passes, and be nearer to it than another recording of the same instrument,
/// for this share of the sounds.
const LIKE: f64 = 2.0 / 3.0;

/// A line of the table, and whether the fit is like its recording.
fn compared(Pair { name, source, sound, others, key, is_drum }: &Pair) -> Outcome<(String, bool)> {
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

#[test]
#[ignore = "takes minutes"]
fn recordings() -> Outcome<()> {
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

/// Compares a preset fitted to several takes with one fitted to a single take, by their distances from other takes.
#[test]
#[ignore = "takes minutes"]
fn layers_of_recordings() -> Outcome<()> {
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
