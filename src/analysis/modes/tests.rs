//! Synthetic strikes whose modes are known, clean and in noise, and sounds that are no strikes.

use super::*;
use libm::{cos, exp, log2, pow};

const RATE: f64 = 48_000.0;

/// A mode that is put into a sound: frequency, T60, amplitude, phase of a sine.
#[derive(Clone, Copy, Debug)]
struct Known(f64, f64, f64, f64);

/// Uniform numbers from 0 to 1 (Marsaglia's xorshift, 2003).
struct Chance(u64);

impl Chance {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of a normal distribution (Box & Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = sqrt(-2.0 * libm::log(self.uniform() + 1e-300));
        radius * cos(2.0 * PI * self.uniform())
    }
}

/// So many modes from 60 Hz to 14 kHz, T60 0.03 to 10 s, levels over 60 dB, no two nearer than the wider one's bandwidth and
/// 1 Hz; a quarter of them with a neighbour that is just as near as that.
fn body(count: usize, chance: &mut Chance) -> Vec<Known> {
    let mut modes: Vec<Known> = Vec::new();
    let clear = |modes: &[Known], frequency: f64, t60: f64| {
        let apart = |mode: &Known| (mode.0 - frequency).abs() > (2.2 / mode.1).max(2.2 / t60).max(1.0);
        modes.iter().all(apart)
    };
    while modes.len() < count {
        let (frequency, t60) = (60.0 * pow(14_000.0 / 60.0, chance.uniform()), 0.03 * pow(333.0, chance.uniform()));
        if !clear(&modes, frequency, t60) {
            continue;
        }
        let amplitude = pow(10.0, -3.0 * chance.uniform());
        let phase = |chance: &mut Chance| PI * (2.0 * chance.uniform() - 1.0);
        modes.push(Known(frequency, t60, amplitude, phase(chance)));
        let neighbour = frequency + 1.02 * (2.2 / t60).max(1.0);
        let (before, t60) = (modes.len() - 1, t60 * (1.0 + 0.3 * chance.uniform()));
        if chance.uniform() < 0.25 && modes.len() < count && clear(&modes[..before], neighbour, t60) {
            let amplitude = (amplitude * pow(10.0, -chance.uniform())).max(1e-3);
            modes.push(Known(neighbour, t60, amplitude, phase(chance)));
        }
    }
    modes
}

/// The sound of modes struck at sample 0, its peak at half of full scale, with noise so many dB below the peak. Gives the
/// factor that amplitudes were scaled by and the noise's standard deviation, too.
fn sound(modes: &[Known], seconds: f64, noise_db: f64, chance: &mut Chance) -> (Vec<f32>, f64, f64) {
    let mut samples = vec![0.0; (seconds * RATE) as usize];
    for Known(frequency, t60, amplitude, phase) in modes.iter().copied() {
        for (n, sample) in samples.iter_mut().enumerate() {
            let t = n as f64 / RATE;
            *sample += amplitude * exp(-LN_60_DB * t / t60) * libm::sin(2.0 * PI * frequency * t + phase);
        }
    }
    let peak = samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
    let (scale, deviation) = (0.5 / peak, 0.5 * pow(10.0, noise_db / 20.0));
    let noisy = samples.iter().map(|sample| (scale * sample + deviation * chance.normal()) as f32);
    (noisy.collect(), scale, deviation)
}

fn taken_apart(samples: Vec<f32>) -> Analysis {
    modes(&[samples], RATE, &Settings::default(), &mut |_| true).unwrap()
}

fn cents(a: f64, b: f64) -> f64 {
    (1200.0 * log2(a / b)).abs()
}

/// For each known mode the nearest found one, if it lies within a bandwidth, and those found that are left over.
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
        let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let known = body(count, &mut chance);
        let (samples, scale, _) = sound(&known, 2.0, -400.0, &mut chance);
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
fn the_modes_of_clean_strikes_are_exact() {
    clean_strikes(24, 1..=2);
}

#[test]
#[ignore = "takes a minute without optimisation"]
fn the_modes_of_many_clean_strikes_are_exact() {
    clean_strikes(60, 1..=20);
}
