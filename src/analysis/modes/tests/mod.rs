//! Tests with synthetic strikes of known modes, clean and in noise, and with sounds that are no strikes.

mod dense;
#[cfg(feature = "analysis")]
mod presets;

use super::fit::energy;
use super::pole::Pole;
use super::*;
use crate::dsp::random::{Sequence, key};
use libm::{cos, exp, log2, pow};
use sprung_fourier::Complex;

const RATE: f64 = 48_000.0;
/// Number of modes of a strike, and numbers of strikes in noise at every commit and in tests that take minutes.
const MODES: usize = 60;
const FEW: u64 = 1;
const MANY: u64 = 20;

/// A mode that is put into a sound: frequency, T60, amplitude, phase of a sine.
#[derive(Clone, Copy, Debug)]
struct Known(f64, f64, f64, f64);

/// A number of a normal distribution (Box & Muller 1958).
fn normal(random: &mut Sequence) -> f64 {
    let radius = sqrt(-2.0 * libm::log(random.unit() + 1e-300));
    radius * cos(2.0 * PI * random.unit())
}

/// Samples of modes that noise drives for the first `len` of them. A mode is its angle per sample and its factor.
pub(super) fn driven(modes: &[(f64, f64)], len: usize, all: usize) -> Vec<f64> {
    let mut random = Sequence::new(1);
    let mut before = vec![[0.0; 2]; modes.len()];
    let sample = |n: usize| {
        let force = if n < len { random.unit() - 0.5 } else { 0.0 };
        let next = |(mode, (theta, radius)): (&mut [f64; 2], &(f64, f64))| {
            let next = force + 2.0 * radius * cos(*theta) * mode[0] - radius * radius * mode[1];
            *mode = [next, mode[0]];
            next
        };
        before.iter_mut().zip(modes).map(next).sum()
    };
    (0..all).map(sample).collect()
}

/// Random modes from 60 Hz to 14 kHz, T60 0.03 to 10 s, levels over 60 dB, no two nearer than the wider one's bandwidth
/// and 1 Hz; a quarter of them with a neighbour at about that distance.
fn body(count: usize, random: &mut Sequence) -> Vec<Known> {
    let mut modes: Vec<Known> = Vec::new();
    let clear = |modes: &[Known], frequency: f64, t60: f64| {
        let apart = |mode: &Known| (mode.0 - frequency).abs() > (2.2 / mode.1).max(2.2 / t60).max(1.0);
        modes.iter().all(apart)
    };
    while modes.len() < count {
        let (frequency, t60) = (60.0 * pow(14_000.0 / 60.0, random.unit()), 0.03 * pow(333.0, random.unit()));
        if !clear(&modes, frequency, t60) {
            continue;
        }
        let amplitude = pow(10.0, -3.0 * random.unit());
        let phase = |random: &mut Sequence| PI * (2.0 * random.unit() - 1.0);
        modes.push(Known(frequency, t60, amplitude, phase(random)));
        let neighbour = frequency + 1.02 * (2.2 / t60).max(1.0);
        let (before, t60) = (modes.len() - 1, t60 * (1.0 + 0.3 * random.unit()));
        if random.unit() < 0.25 && modes.len() < count && clear(&modes[..before], neighbour, t60) {
            let amplitude = (amplitude * pow(10.0, -random.unit())).max(1e-3);
            modes.push(Known(neighbour, t60, amplitude, phase(random)));
        }
    }
    modes
}

/// The sound of modes struck at sample 0, its peak at half of full scale, with noise `noise_db` relative to the
/// strongest mode. Also returns the factor by which amplitudes were scaled and the noise's standard deviation.
fn sound(modes: &[Known], seconds: f64, noise_db: f64, random: &mut Sequence) -> (Vec<f32>, f64, f64) {
    let mut samples = vec![0.0; (seconds * RATE) as usize];
    for Known(frequency, t60, amplitude, phase) in modes.iter().copied() {
        for (n, sample) in samples.iter_mut().enumerate() {
            let t = n as f64 / RATE;
            *sample += amplitude * exp(-LN_1000 * t / t60) * libm::sin(2.0 * PI * frequency * t + phase);
        }
    }
    let peak = samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
    let strongest = modes.iter().map(|mode| mode.2).fold(0.0, f64::max);
    let (scale, deviation) = (0.5 / peak, 0.5 / peak * strongest * pow(10.0, noise_db / 20.0));
    let noisy = samples.iter().map(|sample| (scale * sample + deviation * normal(random)) as f32);
    (noisy.collect(), scale, deviation)
}

fn taken_apart(samples: Vec<f32>) -> Analysis {
    modes(&[samples], RATE, &Settings::default(), &mut |_| true).unwrap()
}

fn cents(a: f64, b: f64) -> f64 {
    (1200.0 * log2(a / b)).abs()
}

/// For each known mode the nearest found one, if it lies within a bandwidth, and the remaining found modes.
fn matched<'a>(known: &[Known], found: &'a [Mode]) -> (Vec<Option<&'a Mode>>, Vec<&'a Mode>) {
    let mut free: Vec<&Mode> = found.iter().collect();
    let take = |known: &Known| {
        let distance = |mode: &Mode| (mode.frequency - known.0).abs() / (2.2 / known.1).max(1.0);
        let nearest = (0..free.len()).min_by(|a, b| distance(free[*a]).total_cmp(&distance(free[*b])))?;
        (distance(free[nearest]) < 0.5).then(|| free.remove(nearest))
    };
    (known.iter().map(take).collect::<Vec<_>>(), free)
}

fn clean_strikes(count: usize, seeds: std::ops::RangeInclusive<u64>) {
    for seed in seeds {
        let mut random = Sequence::new(key(seed, 0));
        let known = body(count, &mut random);
        let (samples, scale, _) = sound(&known, 2.0, -400.0, &mut random);
        let found = taken_apart(samples);
        let strike = &found.strikes[0];
        let (pairs, spurious) = matched(&known, &strike.modes);
        for (known, found) in known.iter().zip(pairs) {
            let found = found.unwrap_or_else(|| panic!("seed {seed}: {known:?} was not found"));
            let level = found.level_db - dbfs(scale * known.2);
            let case = format!("seed {seed}: {known:?} is {found:?}");
            assert!(cents(found.frequency, known.0) < 0.01 && (found.t60 / known.1 - 1.0).abs() < 1e-3, "{case}");
            assert!(level.abs() < 0.05, "{case}");
        }
        let loudest = known.iter().map(|known| dbfs(scale * known.2)).fold(-300.0, f64::max);
        let worst = spurious.iter().map(|mode| mode.level_db - loudest).fold(-300.0, f64::max);
        assert!(worst < -70.0, "seed {seed}: {spurious:?}");
    }
}

#[test]
fn the_modes_of_a_clean_strike_are_exact() {
    clean_strikes(24, 1..=1);
}

#[test]
#[ignore = "takes minutes"]
fn the_modes_of_many_clean_strikes_are_exact() {
    clean_strikes(MODES, 1..=MANY);
}

/// Height of the highest noise peak in two seconds, as energy over the power density of the noise, in dB: `2 ln n` for
/// `n` bins.
const FLOOR_DB: f64 = 13.3;

/// The best accuracy that any method can have for a mode in noise (Cramér & Rao), if all modes are unknown.
struct Bound {
    /// Energy that no change of the other modes could explain, over the power density of the noise, in dB. For a single
    /// mode, this is all of its energy.
    energy_db: f64,
    /// Standard deviation in Hz.
    frequency: f64,
    /// Standard deviation as a share of T60.
    t60: f64,
}

fn bounds(known: &[Known], scale: f64, deviation: f64) -> Vec<Bound> {
    let pole = |known: &Known| Pole { decay: LN_1000 / (known.1 * RATE), theta: 2.0 * PI * known.0 / RATE };
    let poles: Vec<Pole> = known.iter().map(pole).collect();
    let mut samples = vec![0.0; (2.0 * RATE) as usize];
    for (known, pole) in known.iter().zip(&poles) {
        let amplitude = Complex::from_polar(scale * known.2, known.3 - 0.5 * PI);
        add(&mut samples, *pole, amplitude, 1.0);
    }
    let fit = Fit::new(&samples, poles).unwrap();
    let (all, certainty) = (fit.inverses().unwrap().all, fit.certainty(samples.len()).unwrap());
    let bound = |k: usize| {
        // A single mode loses half of its energy to its own pole.
        let own = 2.0 * energy(&all, k, fit.amplitudes[k]);
        let [decay, theta, ..] = certainty.variances[k].map(|variance| deviation * sqrt(variance));
        Bound {
            energy_db: 10.0 * log10(own / (deviation * deviation)),
            frequency: theta * RATE / (2.0 * PI),
            t60: decay / fit.poles[k].decay,
        }
    };
    (0..known.len()).map(bound).collect()
}

/// Returns the errors in cents and in shares of T60 of the modes at least 6 dB above the floor, and descriptions of
/// those that were not found, or not as exactly as 0.5 cents, 5 % and the bound require.
fn noisy_strike(count: usize, seed: u64) -> (Vec<f64>, Vec<f64>, Vec<String>) {
    let mut random = Sequence::new(key(seed, 0));
    let known = body(count, &mut random);
    let (samples, scale, deviation) = sound(&known, 2.0, -60.0, &mut random);
    let found = taken_apart(samples);
    let (pairs, spurious) = matched(&known, &found.strikes[0].modes);
    let (mut pitch, mut decay, mut missed) = (Vec::new(), Vec::new(), Vec::new());
    for ((known, found), bound) in known.iter().zip(pairs).zip(bounds(&known, scale, deviation)) {
        if bound.energy_db < FLOOR_DB + 6.0 {
            continue;
        }
        let Some(found) = found else {
            missed.push(format!("seed {seed}: {known:?} of {:.1} dB was not found", bound.energy_db));
            continue;
        };
        let (cents, share) = (cents(found.frequency, known.0), (found.t60 / known.1 - 1.0).abs());
        // No method can measure a short and weak mode better than the bound, nor a mode beside what looks like another.
        let deviation = bound.frequency.max(found.uncertainty.frequency);
        let share_deviation = bound.t60.max(found.uncertainty.t60 / known.1);
        let tuned = cents < 0.5 || (found.frequency - known.0).abs() < 5.0 * deviation;
        if !tuned || (share >= 0.05 && share >= 5.0 * share_deviation) {
            missed.push(format!("seed {seed}: {known:?} of {:.1} dB is {found:?}", bound.energy_db));
            continue;
        }
        pitch.push(cents);
        decay.push(share);
    }
    assert!(spurious.len() * 10 <= found.strikes[0].modes.len(), "seed {seed}: {spurious:?}");
    (pitch, decay, missed)
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn noisy_strikes(count: usize, seeds: std::ops::RangeInclusive<u64>) {
    let (mut pitch, mut decay, mut missed) = (Vec::new(), Vec::new(), Vec::new());
    for seed in seeds {
        let (cents, shares, more) = noisy_strike(count, seed);
        pitch.extend(cents);
        decay.extend(shares);
        missed.extend(more);
    }
    let all = missed.len() + pitch.len();
    assert!(missed.len() * 200 <= all, "{} of {all} were not found:\n{}", missed.len(), missed.join("\n"));
    assert!(median(&mut pitch) < 0.01 && median(&mut decay) < 0.003, "{pitch:?}, {decay:?}");
}

#[test]
fn modes_in_noise_are_as_certain_as_they_can_be() {
    noisy_strikes(24, 3..=2 + FEW);
}

#[test]
#[ignore = "takes minutes"]
fn modes_of_many_strikes_in_noise_are_as_certain_as_they_can_be() {
    noisy_strikes(24, 3..=2 + MANY);
}

#[test]
fn a_pair_is_told_from_a_decay_in_two_stages() {
    let known = [
        Known(440.0, 2.0, 0.3, 0.1),
        Known(441.2, 2.2, 0.2, 1.0),
        Known(900.0, 0.4, 0.4, 0.0),
        Known(900.3, 3.0, 0.08, 0.4),
    ];
    let found = taken_apart(sound(&known, 2.0, -300.0, &mut Sequence::new(7)).0);
    let kinds: Vec<_> = found.strikes[0].groups.iter().map(|group| (group.kind, group.modes.clone())).collect();
    assert_eq!(kinds, [(Kind::SplitPair, vec![0, 1]), (Kind::TwoStageDecay, vec![2, 3])]);
}

#[test]
fn a_late_onset_a_constant_and_a_second_channel_change_nothing() {
    let known = [Known(300.0, 0.8, 0.5, 0.4), Known(1234.5, 0.5, 0.25, -1.0)];
    let (strike, scale, _) = sound(&known, 1.0, -300.0, &mut Sequence::new(7));
    let mut late = vec![0.1_f32; 12_345];
    late.extend(strike.iter().map(|sample| sample + 0.1));
    let quiet: Vec<f32> = late.iter().map(|sample| 0.5 * sample).collect();
    let found = modes(&[late, quiet], RATE, &Settings::default(), &mut |_| true).unwrap();
    let strike = &found.strikes[0];
    assert!((strike.onset - 12_345.0 / RATE).abs() < 1e-3, "{}", strike.onset);
    assert_eq!(strike.modes.len(), 2, "{:?}", strike.modes);
    for (known, mode) in known.iter().zip(&strike.modes) {
        assert!(cents(mode.frequency, known.0) < 0.01 && (mode.t60 / known.1 - 1.0).abs() < 1e-3, "{mode:?}");
        let [left, right] = [mode.channels[0].0, mode.channels[1].0];
        assert!((left - right - 6.0206).abs() < 0.01 && (left - dbfs(scale * known.2)).abs() < 0.2, "{mode:?}");
    }
}

#[test]
fn what_rings_on_is_no_part_of_the_next_strike() {
    let (first, second) = ([Known(300.0, 3.0, 0.5, 0.0)], [Known(300.0, 3.0, 0.5, 0.0), Known(800.0, 1.0, 0.7, 0.2)]);
    let mut samples = sound(&first, 2.0, -300.0, &mut Sequence::new(7)).0;
    let (next, scale, _) = sound(&second, 1.0, -300.0, &mut Sequence::new(7));
    samples[48_000..].iter_mut().zip(&next).for_each(|(sample, next)| *sample += 2.0 * next);
    let settings = Settings { all_strikes: true, ..Settings::default() };
    let found = modes(&[samples.clone(), samples], RATE, &settings, &mut |_| true).unwrap();
    assert_eq!(found.strikes.iter().map(|strike| strike.modes.len()).collect::<Vec<_>>(), [1, 2]);
    let mode = &found.strikes[1].modes[0];
    for level in [mode.level_db, mode.channels[0].0, mode.channels[1].0] {
        assert!((level - dbfs(2.0 * scale * 0.5)).abs() < 0.2, "{level}");
    }
    let shared = common(&found.strikes);
    assert_eq!(shared.len(), 1);
    assert!(cents(shared[0].frequency, 300.0) < 0.01 && shared[0].levels_db.iter().all(Option::is_some), "{shared:?}");
}

#[test]
fn what_cannot_be_taken_apart_is_refused_or_warned_of() {
    let try_with = |samples: Vec<f32>| modes(&[samples], RATE, &Settings::default(), &mut |_| true);
    for (samples, message) in [
        (vec![], "sound: it is silent, or a constant: expected a strike above −100 dBFS"),
        (vec![0.0; 5000], "sound: it is silent, or a constant: expected a strike above −100 dBFS"),
        (
            [0.5, -0.5].repeat(50),
            "sound: there is no strike of at least 30 ms in it: expected something that is struck and rings",
        ),
        (vec![0.1; 48_000], "sound: it is silent, or a constant: expected a strike above −100 dBFS"),
        (vec![f32::NAN; 5000], "sound: some samples are not finite: expected numbers"),
    ] {
        assert_eq!(try_with(samples).unwrap_err().to_string(), message);
    }
    let unequal = modes(&[vec![0.5; 5000], vec![0.5; 4000]], RATE, &Settings::default(), &mut |_| true);
    let message = "sound: its channels differ in length: expected as many samples in each";
    assert_eq!(unequal.unwrap_err().to_string(), message);
    let mut random = Sequence::new(5);
    let noise = (0..24_000).map(|_| (0.1 * normal(&mut random)) as f32).collect();
    let found = try_with(noise).unwrap();
    assert!(found.warnings.iter().any(|warning| warning.contains("explain little of it")), "{:?}", found.warnings);
    assert!(found.strikes[0].modes.len() < 4, "{:?}", found.strikes[0].modes);

    let (loud, ..) = sound(&[Known(300.0, 1.0, 1.0, 0.0)], 0.5, -300.0, &mut random);
    let clipped: Vec<f32> = loud.iter().take(9600).map(|sample| (4.0 * sample).clamp(-1.0, 1.0)).collect();
    // A sound that is no sum of modes would get more modes than are allowed.
    let few = Settings { most_modes: 24, ..Settings::default() };
    let found = modes(&[clipped], RATE, &few, &mut |_| true).unwrap();
    assert!(
        found.warnings[0].starts_with("the sound is clipped in ") && found.strikes[0].modes.len() <= 24,
        "{found:?}"
    );
    assert!(matches!(modes(&[loud], RATE, &Settings::default(), &mut |_| false), Err(Error::Interrupted)));
}
