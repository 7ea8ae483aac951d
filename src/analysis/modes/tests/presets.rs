//! Tests with rendered factory presets of all kinds, with a release in the sound: struck, swept, bowed and noisy ones.

use super::*;
use crate::engine::{Ensemble, Event};
use crate::params::Param;
use crate::patch::Patch;
use crate::preset::Preset;
use rayon::prelude::*;

/// Seconds until the key is released, and length of the sound in seconds.
const HELD: f64 = 0.6;
const SECONDS: f64 = 1.5;
/// Keys of which each preset plays one.
const KEYS: [u8; 3] = [36, 60, 84];

/// Presets that are struck once and ring freely, and whether the release damps them.
const STRUCK: [(&str, bool); 6] = [
    ("init", true),
    ("Blip", false),
    ("Free Bar", false),
    ("Glockenspiel", false),
    ("Marimba", false),
    ("Plucked String", true),
];

fn played(preset: &Preset, key: u8) -> Vec<Vec<f32>> {
    // Modes cannot explain noise, so leave it out.
    let is_struck = STRUCK.iter().any(|(name, _)| *name == preset.name);
    let noise = if is_struck { -60.0 } else { preset.patch.get(Param::NoiseLevel) };
    played_by(&preset.patch.clone().with(Param::NoiseLevel, noise), key, HELD, SECONDS)
}

/// So many seconds of a key that is held for some of them.
fn played_by(patch: &Patch, key: u8, held: f64, seconds: f64) -> Vec<Vec<f32>> {
    let mut ensemble = Ensemble::new(RATE, 1, patch, &[]);
    let (frames, off) = ((seconds * RATE) as usize, (held * RATE) as usize);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    ensemble.process(&[Event::note_on(0, key, 0.8)], &mut left[..off], &mut right[..off]);
    ensemble.process(&[Event::note_off(0, key)], &mut left[off..], &mut right[off..]);
    vec![left, right]
}

/// The faults of the modes of a preset.
fn faults(preset: &Preset, key: u8) -> Vec<String> {
    let channels = played(preset, key);
    let peak = channels.iter().flatten().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let settings = Settings { most_modes: 80, ..Settings::default() };
    let found = modes(&channels, RATE, &settings, &mut |_| true).unwrap();
    let (strike, mut faults) = (&found.strikes[0], Vec::new());
    for mode in &strike.modes {
        let loudest = dbfs(2.0 * f64::from(peak)) + 0.1;
        let known = mode.is_finite() && mode.uncertainty.t60 < mode.t60;
        if !known || mode.level_db > loudest || mode.frequency < 20.0 || mode.t60 < 0.005 {
            faults.push(format!("{mode:?}"));
        }
    }
    if let Some((_, released)) = STRUCK.iter().find(|(name, _)| *name == preset.name) {
        if strike.residual_db > -70.0 || strike.modes.is_empty() {
            faults.push(format!("{} modes leave {:.1} dB", strike.modes.len(), strike.residual_db));
        }
        // The sound may be over before the key is released.
        let damped = strike.damped.is_some_and(|seconds| (HELD - 0.15..HELD).contains(&seconds));
        if damped != *released && strike.seconds > HELD {
            faults.push(format!("damped at {:?}", strike.damped));
        }
    }
    faults
}

#[test]
fn modes_of_struck_presets_explain_them() {
    explained(|_, name| STRUCK[..3].iter().any(|(struck, _)| *struck == name));
}

#[test]
#[ignore = "takes minutes"]
fn modes_of_all_kinds_of_presets_are_plausible() {
    explained(|index, name| index.is_multiple_of(8) || STRUCK.iter().any(|(struck, _)| *struck == name));
}

/// The modes of presets that are wanted, by index and name, are plausible, and those of struck ones explain them.
fn explained(wanted: impl Fn(usize, &str) -> bool + Sync) {
    let presets = Preset::factory();
    let faults: Vec<String> = (0..presets.len())
        .into_par_iter()
        .filter(|index| wanted(*index, &presets[*index].name))
        .flat_map_iter(|index| {
            let (preset, key) = (&presets[index], KEYS[index % KEYS.len()]);
            faults(preset, key).into_iter().map(move |fault| format!("{} {key}: {fault}", preset.name))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Gains at which a sound is analysed and the most by which what its modes leave may differ, in dB.
const GAINS: [f32; 6] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5];
const SPREAD_DB: f64 = 6.0;
/// What the modes of a marimba may leave in dB, once the noise of its mallet is over.
const LEFT_DB: f64 = -80.0;

#[test]
#[ignore = "takes half a minute"]
fn other_gains_find_the_same_sound() {
    // With the noise of a mallet, which is no part of what rings, and over before that is looked at.
    let patch = Preset::find("Marimba").unwrap().patch.clone().with(Param::NoiseTime, 0.022);
    let sound = played_by(&patch, 60, HELD, SECONDS);
    let left_db = |gain: &f32| {
        let louder = |channel: &Vec<f32>| channel.iter().map(|sample| gain * sample).collect();
        let channels: Vec<Vec<f32>> = sound.iter().map(louder).collect();
        modes(&channels, RATE, &Settings::default(), &mut |_| true).unwrap().strikes[0].residual_db
    };
    let left_db: Vec<f64> = GAINS.par_iter().map(left_db).collect();
    let [least, most] = [f64::min, f64::max].map(|of| left_db.iter().copied().reduce(of).unwrap());
    assert!(most < LEFT_DB && most - least < SPREAD_DB, "{left_db:?}");
}

#[test]
#[ignore = "takes a minute"]
fn a_bell_that_falls_for_long_is_damped_where_its_key_is_let_go() {
    let damped = |held: &f64| {
        let sound = played_by(&Preset::find("Tubular Bells").unwrap().patch, 72, *held, held + 3.0);
        let strike = modes(&sound, RATE, &Settings::default(), &mut |_| true).unwrap().strikes.remove(0);
        (strike.damped, strike.residual_db)
    };
    let found: Vec<_> = [1.0, 3.0].par_iter().map(damped).collect();
    let is_before = |(held, (damped, left_db)): (f64, &(Option<f64>, f64))| {
        damped.is_some_and(|seconds| (0.7 * held..held).contains(&seconds)) && *left_db < -90.0
    };
    assert!([1.0, 3.0].into_iter().zip(&found).all(is_before), "{found:?}");
}
