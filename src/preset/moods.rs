//! The moods of a preset, by ear and yet from its knobs: bright, dark, warbling, rough, breathy, wide, moving.

use super::Preset;
use crate::params::Param;
use crate::patch::routes::{Source, amount_param};
use crate::patch::{Mode, Patch};
use crate::sound::contact_time;
use crate::units::{frequency_from_key, gain_from_db};
use libm::{exp, exp2, fabs, log, log2, pow, sqrt};

/// All moods, in the order in which they are told. Their thresholds below are set so that between one in twenty and three in ten of the
/// factory's presets have each. Beside renderings of all of them, the centroid has a rank correlation of 0.91, the width one of 0.86.
pub const MOODS: [&str; 7] = ["bright", "dark", "warbling", "rough", "breathy", "wide", "moving"];

/// Mean frequency of the modes on an axis of octaves, by their energy on the key that suits the preset: bright from here on (in Hz; 16 %
/// of the presets), and dark up to here (16 %).
const BRIGHT: f64 = 1600.0;
const DARK: f64 = 165.0;
/// Least share of the energy in modes that beat with another one, which has at least a tenth of theirs: warbling (23 %).
const WARBLING: f64 = 0.5;
/// How often a second they beat: slower is a swell, faster is rough.
const BEATS: [f64; 2] = [0.7, 7.0];
/// How many modes share the energy, as if each had as much: rough, since they are heard as noise (13 %, with drive or a rattle 15 %).
const ROUGH: f64 = 27.0;
/// Least drive that is rough, in decibels.
const DRIVEN: f32 = 6.0;
/// Least turbulence of breath, in per cent, and least route that raises held noise as the tone stands: breathy (5 %).
const BREATHY: f32 = 0.9;
const RAISED: f32 = 30.0;
/// Mean distance of the modes from the middle, by their energy: wide (19 %).
const WIDE: f64 = 0.4;
/// The least of what moves the sound by itself: moving (19 %).
const MOVING: [(Param, f32); 3] = [(Param::DriftLevel, 6.0), (Param::Bloom, 30.0), (Param::TremoloDepth, 20.0)];
/// What an oscillator moves, and the least amount of the route that is heard as a movement. Vibrato as players have it is less, and an
/// envelope opens most tones.
const ROUTED: [(Param, f32); 4] = [(Param::Pan, 20.0), (Param::Colour, 10.0), (Param::Tilt, 10.0), (Param::Gain, 8.0)];

/// Energy counts for as long as a note is listened to, in seconds.
const HEARD: f64 = 1.5;
/// What is heard, in Hz.
const AUDIBLE: [f64; 2] = [20.0, 18_000.0];
/// A burst of noise beside a strike of the same level.
const BURST: f64 = 0.3;

/// A mode as it sounds.
struct Sounding {
    frequency: f64,
    t60: f64,
    energy: f64,
    pan: f64,
}

/// The moods of a preset.
pub(super) fn moods(preset: &Preset) -> Vec<&'static str> {
    let patch = &preset.patch;
    let modes = sounding(preset);
    let total: f64 = modes.iter().map(|mode| mode.energy).sum();
    let mean = |of: &dyn Fn(&Sounding) -> f64| {
        if total > 0.0 { modes.iter().map(|mode| mode.energy * of(mode)).sum::<f64>() / total } else { 0.0 }
    };
    let centroid = exp2(mean(&|mode| log2(mode.frequency)));
    let entropy = mean(&|mode| if mode.energy > 0.0 { -log(mode.energy / total) } else { 0.0 });
    let width = sqrt(mean(&|mode| mode.pan * mode.pan)) * f64::from(patch.get(Param::Width)) / 100.0;
    let is_raised = |(place, source, to): (usize, Source, Param)| {
        to == Param::NoiseHeld && source.is_moving() && patch.get(amount_param(place)) >= RAISED
    };
    let is_there = [
        total > 0.0 && centroid >= BRIGHT,
        total > 0.0 && centroid <= DARK,
        beating(&modes) >= WARBLING * total && total > 0.0,
        exp(entropy) >= ROUGH || patch.get(Param::Drive) > DRIVEN || patch.get(Param::Rattle) > 0.0,
        patch.get(Param::BreathNoise) >= BREATHY && is_on(patch, Param::BreathLevel) || routed(patch).any(is_raised),
        width >= WIDE,
        moves(patch),
    ];
    MOODS.into_iter().zip(is_there).filter_map(|(mood, is_there)| is_there.then_some(mood)).collect()
}

fn is_on(patch: &Patch, level: Param) -> bool {
    patch.get(level) > level.info().min
}

/// The places of the routes, with their sources and destinations.
fn routed(patch: &Patch) -> impl Iterator<Item = (usize, Source, Param)> + '_ {
    patch.routes.iter().map(|(place, route)| (place, route.source, route.destination))
}

/// Whether a sound changes by itself while it lasts.
fn moves(patch: &Patch) -> bool {
    let is_heard = |(place, source, to): (usize, Source, Param)| {
        let amount = patch.get(amount_param(place)).abs();
        let is_lfo = matches!(source, Source::Lfo1 | Source::Lfo2 | Source::Lfo3);
        is_lfo && ROUTED.iter().any(|(param, least)| *param == to && amount >= *least)
    };
    MOVING.iter().any(|(param, least)| patch.get(*param) >= *least) || routed(patch).any(is_heard)
}

/// The modes on the key that suits a preset, as it is struck or driven.
fn sounding(preset: &Preset) -> Vec<Sounding> {
    let patch = &preset.patch;
    let get = |param| f64::from(patch.get(param));
    let key = 60.0 + (f64::from(preset.guide.home) - 60.0) * get(Param::KeyTrack) / 100.0 + get(Param::Tune);
    let note = frequency_from_key(key, 440.0);
    let level = |param| if is_on(patch, param) { gain_from_db(get(param)) } else { 0.0 };
    let is_driven = [Param::BowLevel, Param::BreathLevel, Param::NoiseHeld].iter().any(|param| is_on(patch, *param));
    let [mallet, pluck, noise] = [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel].map(level);
    let is_impulse = patch.get(Param::MalletPulse) == 0.0;
    let contact = if is_impulse { 0.0 } else { contact_time(get(Param::MalletHardness) / 100.0) };
    let let_go = contact_time(get(Param::PluckHardness) / 100.0);
    // A contact moves the modes less that swing faster than it lasts.
    let slowed = |frequency: f64, seconds: f64| 1.0 / (1.0 + pow(frequency * seconds, 2.0));
    let sounding = |mode: &Mode| {
        let [ratio, strike] = [mode.ratio, mode.strike].map(f64::from);
        let frequency = note * pow(ratio, get(Param::Stretch));
        let tilted = gain_from_db((get(Param::Tilt) + get(Param::Colour)) * log2(ratio));
        let forces = [
            mallet * strike * slowed(frequency, contact),
            pluck * strike * slowed(frequency, let_go),
            BURST * noise * (1.0 - strike),
        ];
        let force = if is_driven { 1.0 } else { sqrt(forces.iter().map(|force| force * force).sum()) };
        let amplitude = fabs(f64::from(mode.level)) * tilted * force;
        let t60 = get(Param::Decay) * f64::from(mode.decay) * pow(ratio, -get(Param::DecayTilt));
        let is_heard = (AUDIBLE[0]..AUDIBLE[1]).contains(&frequency);
        let energy = if is_heard { amplitude * amplitude * t60.min(HEARD) } else { 0.0 };
        Sounding { frequency, t60, energy, pan: mode.pan.into() }
    };
    let mut modes: Vec<_> = patch.modes.as_slice().iter().map(sounding).collect();
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes
}

/// The energy of those of some modes in the order of their frequencies that beat with another one, at least once while they sound.
fn beating(modes: &[Sounding]) -> f64 {
    let mut beats = vec![false; modes.len()];
    for (place, low) in modes.iter().enumerate() {
        for (other, high) in modes.iter().enumerate().skip(place + 1) {
            let rate = high.frequency - low.frequency;
            if rate > BEATS[1] {
                break;
            }
            let is_long = low.t60.min(high.t60) * rate >= 1.0;
            if rate >= BEATS[0] && is_long && low.energy.min(high.energy) >= 0.1 * low.energy.max(high.energy) {
                (beats[place], beats[other]) = (true, true);
            }
        }
    }
    modes.iter().zip(beats).filter(|(_, beats)| *beats).map(|(mode, _)| mode.energy).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_sounds_have_the_moods_that_one_expects() {
        let of = |name: &str| moods(Preset::find(name).unwrap());
        for (name, has, has_not) in [
            ("Glockenspiel", "bright", "dark"),
            ("Triangle", "bright", "dark"),
            ("Kick", "dark", "bright"),
            ("Contrabass", "dark", "bright"),
            ("Gong", "dark", "bright"),
            ("Gong", "moving", "warbling"),
            ("Honky-Tonk", "warbling", "dark"),
            ("Gamelan", "warbling", "moving"),
            ("Vibraphone", "moving", "rough"),
            ("Crash", "rough", "dark"),
            ("Distortion Guitar", "rough", "breathy"),
            ("Sitar", "rough", "wide"),
            ("Shakuhachi", "breathy", "wide"),
            ("Flute", "breathy", "bright"),
            ("Glass Pad", "wide", "breathy"),
            ("Grand Piano", "wide", "rough"),
            ("Choir Pad", "moving", "rough"),
            ("Drone", "dark", "bright"),
        ] {
            let moods = of(name);
            assert!(moods.contains(&has) && !moods.contains(&has_not), "{name}: {moods:?}");
        }
        assert_eq!(of("Init"), [""; 0]);
        assert_eq!(of("Marimba"), [""; 0]);
    }

    #[test]
    fn each_mood_is_that_of_some_sounds_and_not_of_most() {
        let all = Preset::factory();
        for mood in MOODS {
            let share = all.iter().filter(|preset| moods(preset).contains(&mood)).count() as f64 / all.len() as f64;
            assert!((0.05..=0.3).contains(&share), "{mood}: {share}");
        }
    }
}
