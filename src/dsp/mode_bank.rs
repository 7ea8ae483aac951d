//! Up to 64 masses side by side, their ringing summed in one fixed order.

use super::CONTROL_FRAMES;
use super::coefficients::{Coefficients, LN_MINUS_60_DB, angle_from_frequency, omega2_from_angle};
use super::exciter::Drive;
use libm::{cos, exp, sqrt};
use std::f64::consts::PI;

/// Most modes in a bank.
pub const MAX_MODES: usize = 64;

/// Modes are stepped, and partial sums kept, in groups of this many. Frozen: the order of summation depends on it.
const LANES: usize = 8;
type Lanes = [f32; LANES];
const GROUPS: usize = MAX_MODES / LANES;

/// Modes up to this angle per sample sound at full level; from here to π they fade out, and beyond they are silent.
const TOP_ANGLE: f64 = 0.98 * PI;

/// A mode that comes down from just below π would need a boost without bound; 2 serves those from 20 kHz at 48 kHz.
const HIGHEST_LEVEL: f64 = 2.0;

/// How far below the angle at which it explodes the classic step is kept.
const CLASSIC_MARGIN: f64 = 0.99;

/// A mode with less energy than this (an amplitude of 1e−20) is set to rest before it can become denormal.
const REST_ENERGY: f64 = 1e-40;

/// Which formulas turn pitch and decay into coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Tuning and decay are exact ([`Coefficients::exact`]), the pitch bends exactly, the level does not depend on it.
    Exact,
    /// The original formulas ([`Coefficients::seed`]), the sweep used as the pitch ratio, clamped short of exploding.
    Classic,
}

/// One mode as it is loaded into a bank.
#[derive(Clone, Copy, Debug)]
pub struct ModeSetup {
    /// Frequency in Hz at a pitch ratio of 1.
    pub frequency: f64,
    /// T60 in seconds.
    pub t60: f64,
    /// Output gain to the left.
    pub left: f32,
    /// Output gain to the right.
    pub right: f32,
}

/// How strongly one mode is moved.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    /// Amplitude that a pulse of unit area gives by pushing (a strike).
    pub push: f32,
    /// Amplitude that a pulse of unit area gives by displacing (a pluck).
    pub pull: f32,
    /// Expected amplitude that a noise burst of unit force gives.
    pub noise: f32,
}

/// A bank of modes, structure of arrays. Real-time safe throughout.
///
/// The output of a mode is its displacement times a level that keeps the amplitude independent of the pitch (exact
/// law): a slow sweep leaves the area of the orbit in `(x, v)` alone, which is `A² ω cos(θ/2)`, so `x` grows as
/// `1/√cos(θ/2)` and the level falls with it.
#[derive(Clone, Debug)]
pub struct ModeBank {
    sample_rate: f64,
    law: Law,
    len: usize,
    ratio: f64,
    /// Frames until sweeps and levels arrive at those of `ratio`.
    line_frames: usize,
    /// Sweeps and levels are those of `ratio` and stay there.
    settled: bool,
    /// And they are all exactly 1, so that the plain step gives the same bits.
    unswept: bool,
    x: [Lanes; GROUPS],
    v: [Lanes; GROUPS],
    zeta: [Lanes; GROUPS],
    omega2: [Lanes; GROUPS],
    sweep: [Lanes; GROUPS],
    sweep_step: [Lanes; GROUPS],
    level: [Lanes; GROUPS],
    level_step: [Lanes; GROUPS],
    left: [Lanes; GROUPS],
    right: [Lanes; GROUPS],
    /// Velocity per unit of pulse, displacement per unit of pulse, velocity per unit of noise.
    push: [Lanes; GROUPS],
    pull: [Lanes; GROUPS],
    noise: [Lanes; GROUPS],
    frequency: [f64; MAX_MODES],
    ln_radius: [f64; MAX_MODES],
}

impl ModeBank {
    /// An empty bank.
    pub fn new(sample_rate: f64) -> Self {
        let zero = [[0.0; LANES]; GROUPS];
        Self {
            sample_rate,
            law: Law::Exact,
            len: 0,
            ratio: 1.0,
            line_frames: 0,
            settled: true,
            unswept: true,
            x: zero,
            v: zero,
            zeta: zero,
            omega2: zero,
            sweep: zero,
            sweep_step: zero,
            level: zero,
            level_step: zero,
            left: zero,
            right: zero,
            push: zero,
            pull: zero,
            noise: zero,
            frequency: [0.0; MAX_MODES],
            ln_radius: [0.0; MAX_MODES],
        }
    }

    /// Fills the bank with modes at rest, at a pitch ratio of 1. Modes beyond [`MAX_MODES`] are left out.
    pub fn load(&mut self, law: Law, modes: impl Iterator<Item = ModeSetup>) {
        *self = Self { law, ..Self::new(self.sample_rate) };
        for (m, mode) in modes.take(MAX_MODES).enumerate() {
            self.len = m + 1;
            let (group, lane) = (m / LANES, m % LANES);
            self.frequency[m] = mode.frequency;
            self.left[group][lane] = mode.left;
            self.right[group][lane] = mode.right;
            self.set_t60(m, mode.t60);
        }
        self.jump_to(1.0);
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the bank has no modes.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The coefficients of mode `m` at a pitch ratio of 1.
    fn coefficients(&self, m: usize) -> Coefficients {
        let (frequency, ln_radius) = (self.frequency[m], self.ln_radius[m]);
        match self.law {
            Law::Exact => {
                let theta = angle_from_frequency(frequency, self.sample_rate).min(TOP_ANGLE);
                Coefficients::from_polar(ln_radius, theta, 1.0)
            }
            Law::Classic => {
                let frames = (LN_MINUS_60_DB / ln_radius) as f32;
                let zeta = Coefficients::seed(1.0, frames, 1.0, self.sample_rate as f32).zeta;
                let highest = classic_limit(zeta) / (2.0 * PI) * self.sample_rate;
                Coefficients::seed(frequency.min(highest) as f32, frames, 1.0, self.sample_rate as f32)
            }
        }
    }

    /// Changes the T60 of mode `m` to `t60` seconds. The displacement is continuous. Follow with [`ModeBank::sweep_to`].
    pub fn set_t60(&mut self, m: usize, t60: f64) {
        let (group, lane) = (m / LANES, m % LANES);
        self.ln_radius[m] = LN_MINUS_60_DB / (t60 * self.sample_rate);
        let coefficients = self.coefficients(m);
        self.zeta[group][lane] = coefficients.zeta as f32;
        self.omega2[group][lane] = coefficients.omega2 as f32;
        self.settled = false;
        self.unswept = false;
    }

    /// Sets how strongly mode `m` is moved by what drives the bank.
    pub fn set_coupling(&mut self, m: usize, coupling: Coupling) {
        let (group, lane) = (m / LANES, m % LANES);
        let coefficients = self.coefficients(m);
        // A push gives the mass the velocity, a pull the displacement, of a ringing of unit amplitude.
        let push = coefficients.v0 as f32;
        let pull = match self.law {
            Law::Exact => coefficients.v0 * exp(self.ln_radius[m]) / sqrt(coefficients.omega2),
            Law::Classic => 1.0,
        };
        self.push[group][lane] = coupling.push * push;
        self.pull[group][lane] = coupling.pull * pull as f32;
        self.noise[group][lane] = coupling.noise * push;
    }

    /// Sweep and level of mode `m` at a pitch ratio.
    fn swept(&self, m: usize, ratio: f64) -> (f32, f32) {
        let (group, lane) = (m / LANES, m % LANES);
        let omega2 = f64::from(self.omega2[group][lane]);
        match self.law {
            Law::Exact => {
                let base = angle_from_frequency(self.frequency[m], self.sample_rate);
                if ratio == 1.0 && base <= TOP_ANGLE {
                    return (1.0, 1.0);
                }
                let target = base * ratio;
                let theta = target.min(TOP_ANGLE);
                let sweep = sqrt(omega2_from_angle(exp(self.ln_radius[m]), theta) / omega2);
                let edge = ((PI - target) / (PI - TOP_ANGLE)).clamp(0.0, 1.0);
                let level = sqrt(cos(0.5 * theta) / cos(0.5 * base.min(TOP_ANGLE)));
                (sweep as f32, (edge * level.min(HIGHEST_LEVEL)) as f32)
            }
            Law::Classic => {
                let highest = classic_limit(f64::from(self.zeta[group][lane])) / sqrt(omega2);
                (ratio.min(highest) as f32, 1.0)
            }
        }
    }

    /// Moves every mode to a pitch ratio, in a straight line of sweep and level over `frames` frames; to be called
    /// again before more than those are rendered.
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        if ratio == self.ratio && self.settled {
            return;
        }
        let arrived = ratio == self.ratio && self.line_frames == 0;
        self.ratio = ratio;
        self.line_frames = if arrived { 0 } else { frames };
        self.settled = false;
        self.unswept = false;
        let per_frame = 1.0 / frames as f32;
        for m in 0..self.len {
            let (group, lane) = (m / LANES, m % LANES);
            let (sweep, level) = self.swept(m, ratio);
            if arrived {
                // What the steps of the line left by rounding is dropped.
                self.sweep[group][lane] = sweep;
                self.level[group][lane] = level;
            }
            self.sweep_step[group][lane] = (sweep - self.sweep[group][lane]) * per_frame;
            self.level_step[group][lane] = (level - self.level[group][lane]) * per_frame;
        }
        if arrived {
            self.rest_sweep();
        }
    }

    /// Puts every mode at a pitch ratio at once: for modes at rest.
    pub fn jump_to(&mut self, ratio: f64) {
        self.ratio = ratio;
        self.line_frames = 0;
        for m in 0..self.len {
            let (group, lane) = (m / LANES, m % LANES);
            (self.sweep[group][lane], self.level[group][lane]) = self.swept(m, ratio);
            (self.sweep_step[group][lane], self.level_step[group][lane]) = (0.0, 0.0);
        }
        self.rest_sweep();
    }

    /// Sweeps and levels are where they belong; notices whether they are all exactly 1.
    fn rest_sweep(&mut self) {
        self.settled = true;
        self.unswept = (0..self.len).all(|m| {
            let (group, lane) = (m / LANES, m % LANES);
            self.sweep[group][lane] == 1.0 && self.level[group][lane] == 1.0
        });
    }

    /// Renders the next frames (at most [`CONTROL_FRAMES`]), overwriting `left` and `right`.
    pub fn render(&mut self, drive: Option<&Drive>, left: &mut [f32], right: &mut [f32]) {
        debug_assert!(left.len() == right.len() && left.len() <= CONTROL_FRAMES);
        self.line_frames = self.line_frames.saturating_sub(left.len());
        match (drive, self.unswept) {
            (Some(drive), _) => self.advance::<true, true>(drive, left, right),
            (None, false) => self.advance::<false, true>(&Drive::NONE, left, right),
            (None, true) => self.advance::<false, false>(&Drive::NONE, left, right),
        }
    }

    /// The step of [`super::HarmonicOscillator`], for every mode and frame. The three forms give the same bits where
    /// they overlap: a sweep of 1 multiplies by 1, a drive of 0 adds 0.
    fn advance<const DRIVEN: bool, const SWEPT: bool>(&mut self, drive: &Drive, left: &mut [f32], right: &mut [f32]) {
        let groups = self.len.div_ceil(LANES);
        for (i, (out_left, out_right)) in left.iter_mut().zip(right.iter_mut()).enumerate() {
            let (mut sum_left, mut sum_right) = ([0.0; LANES], [0.0; LANES]);
            for g in 0..groups {
                let (x, v) = (&mut self.x[g], &mut self.v[g]);
                let (zeta, omega2) = (&self.zeta[g], &self.omega2[g]);
                let (sweep, sweep_step) = (&mut self.sweep[g], &self.sweep_step[g]);
                let (level, level_step) = (&mut self.level[g], &self.level_step[g]);
                for k in 0..LANES {
                    if SWEPT {
                        sweep[k] += sweep_step[k];
                        level[k] += level_step[k];
                    }
                    if DRIVEN {
                        let push = drive.pulse[i] * self.push[g][k] + drive.noise[i] * self.noise[g][k];
                        v[k] += push * level[k];
                        x[k] += drive.pulse[i] * self.pull[g][k] * level[k];
                    }
                    let out = if SWEPT {
                        v[k] -= v[k] * zeta[k] + x[k] * omega2[k] * sweep[k];
                        x[k] += v[k] * sweep[k];
                        x[k] * level[k]
                    } else {
                        v[k] -= v[k] * zeta[k] + x[k] * omega2[k];
                        x[k] += v[k];
                        x[k]
                    };
                    sum_left[k] += out * self.left[g][k];
                    sum_right[k] += out * self.right[g][k];
                }
            }
            *out_left = sum_lanes(&sum_left);
            *out_right = sum_lanes(&sum_right);
        }
    }

    /// The sum of the squared amplitudes at which the modes ring, as heard; modes that have all but stopped are set
    /// to rest. To be called once a control tick.
    pub fn settle(&mut self) -> f64 {
        let mut total = 0.0;
        for m in 0..self.len {
            let (group, lane) = (m / LANES, m % LANES);
            let energy = self.energy(m);
            if energy < REST_ENERGY {
                self.x[group][lane] = 0.0;
                self.v[group][lane] = 0.0;
            } else {
                let level = f64::from(self.level[group][lane]);
                total += energy * level * level;
            }
        }
        total
    }

    /// Where mode `m` is: its displacement as heard, at full level.
    pub fn displacement(&self, m: usize) -> f32 {
        let (group, lane) = (m / LANES, m % LANES);
        self.x[group][lane] * self.level[group][lane]
    }

    /// The squared amplitude of mode `m`, in closed form: [`Coefficients::energy`] with the sweep taken in
    /// (`ω² → s²ω²`, `v → s v`).
    pub fn energy(&self, m: usize) -> f64 {
        let (group, lane) = (m / LANES, m % LANES);
        let sweep = f64::from(self.sweep[group][lane]);
        let (x, v) = (f64::from(self.x[group][lane]), f64::from(self.v[group][lane]) * sweep);
        let (zeta, omega2) = (f64::from(self.zeta[group][lane]), f64::from(self.omega2[group][lane]) * sweep * sweep);
        let keep = 1.0 - zeta;
        let half_trace = 0.5 * (1.0 + keep - omega2);
        let discriminant = keep - half_trace * half_trace;
        let form = omega2 * x * x + (zeta - omega2) * x * v + keep * v * v;
        if discriminant > 1e-12 && keep > 0.0 {
            form * keep / discriminant
        } else {
            // Classic coefficients can be over-damped: no ringing, but still something that moves.
            x * x + v * v / omega2.max(1e-12)
        }
    }
}

/// Largest `ω` (times sweep) of the classic step: it explodes where `ω² = 4 − 2ζ`.
fn classic_limit(zeta: f64) -> f64 {
    CLASSIC_MARGIN * sqrt(4.0 - 2.0 * zeta)
}

/// The sum of the partial sums, pairwise.
fn sum_lanes(lanes: &Lanes) -> f32 {
    let [a, b, c, d, e, f, g, h] = *lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::HarmonicOscillator;
    use crate::dsp::random::{key, uniform};

    const RATE: f64 = 48_000.0;

    fn bank(law: Law, modes: &[(f64, f64)]) -> ModeBank {
        let mut bank = ModeBank::new(RATE);
        let setup =
            |(frequency, t60): &(f64, f64)| ModeSetup { frequency: *frequency, t60: *t60, left: 1.0, right: 1.0 };
        bank.load(law, modes.iter().map(setup));
        (0..bank.len()).for_each(|m| bank.set_coupling(m, Coupling { push: 1.0, ..Coupling::default() }));
        bank
    }

    fn strike() -> Drive {
        let mut drive = Drive::NONE;
        drive.pulse[0] = 1.0;
        drive
    }

    fn run(bank: &mut ModeBank, frames: usize, drive: Option<&Drive>) -> Vec<f32> {
        let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
        for (n, (left, right)) in left.chunks_mut(CONTROL_FRAMES).zip(right.chunks_mut(CONTROL_FRAMES)).enumerate() {
            bank.sweep_to(bank.ratio, CONTROL_FRAMES);
            bank.render(drive.filter(|_| n == 0), left, right);
        }
        left
    }

    /// Moves to a pitch ratio in one control tick.
    fn glide(bank: &mut ModeBank, ratio: f64) -> Vec<f32> {
        let (mut left, mut right) = ([0.0; CONTROL_FRAMES], [0.0; CONTROL_FRAMES]);
        bank.sweep_to(ratio, CONTROL_FRAMES);
        bank.render(None, &mut left, &mut right);
        left.to_vec()
    }

    #[test]
    fn one_mode_is_the_oscillator_to_the_bit() {
        for law in [Law::Exact, Law::Classic] {
            let mut bank = bank(law, &[(440.0, 1.0)]);
            let coefficients = match law {
                Law::Exact => Coefficients::exact(440.0, 1.0, 1.0, RATE),
                Law::Classic => Coefficients::seed(440.0, 48_000.0, 1.0, 48_000.0),
            };
            let mut mass = HarmonicOscillator::<f32>::new(&coefficients);
            let rendered = run(&mut bank, 48_000, Some(&strike()));
            assert!(rendered.iter().all(|sample| *sample == mass.step()), "{law:?}");
        }
    }

    #[test]
    fn the_energy_is_that_of_the_amplitudes() {
        let mut bank = bank(Law::Exact, &[(100.0, 1.0), (3000.0, 1.0), (19_000.0, 1.0)]);
        run(&mut bank, 48_000, Some(&strike()));
        assert!((bank.settle() / 3e-6 - 1.0).abs() < 1e-4);
        glide(&mut bank, 1.1);
        assert!((bank.settle() / 3e-6 - 1.0).abs() < 5e-3, "swept: {}", bank.settle());
    }

    #[test]
    fn a_pull_and_a_push_give_the_same_amplitude() {
        for frequency in [50.0, 5000.0, 20_000.0] {
            let mut pulled = bank(Law::Exact, &[(frequency, 1.0)]);
            pulled.set_coupling(0, Coupling { pull: 1.0, ..Coupling::default() });
            run(&mut pulled, 1, Some(&strike()));
            assert!((pulled.settle() - 1.0).abs() < 1e-3, "{frequency}: {}", pulled.settle());
        }
    }

    #[test]
    fn a_sweep_reaches_its_pitch_exactly_and_keeps_the_amplitude() {
        let mut bank = bank(Law::Exact, &[(1000.0, 60.0)]);
        run(&mut bank, 320, Some(&strike()));
        for step in 1..=100 {
            glide(&mut bank, 1.0 + f64::from(step) * 0.05);
        }
        assert!((bank.settle() - 1.0).abs() < 0.02, "{}", bank.settle());
        let samples = run(&mut bank, 48_000, None);
        let crossings = samples.windows(2).filter(|w| w[0] <= 0.0 && w[1] > 0.0).count();
        assert!((5999..=6001).contains(&crossings), "{crossings}");
    }

    #[test]
    fn a_strike_is_as_strong_at_a_swept_pitch() {
        for ratio in [0.1, 1.0, 12.0, 20.0] {
            let mut bank = bank(Law::Exact, &[(1000.0, 60.0)]);
            glide(&mut bank, ratio);
            run(&mut bank, 32, Some(&strike()));
            assert!((bank.settle() - 1.0).abs() < 0.01, "{ratio}: {}", bank.settle());
        }
    }

    #[test]
    fn modes_beyond_nyquist_are_silent() {
        let mut bank = bank(Law::Exact, &[(24_000.0, 1.0), (30_000.0, 1.0)]);
        assert!(run(&mut bank, 4800, Some(&strike())).iter().all(|sample| *sample == 0.0));
    }

    #[test]
    fn classic_is_clamped_short_of_exploding() {
        for frequency in [15_000.0, 15_500.0, 23_000.0] {
            let mut bank = bank(Law::Classic, &[(frequency, 10.0)]);
            run(&mut bank, 32, Some(&strike()));
            glide(&mut bank, 8.0);
            assert!(run(&mut bank, 480_000, None).iter().all(|sample| sample.abs() < 20.0), "{frequency}");
        }
    }

    /// Ten million random coefficients of the exact law, as the bank rounds them: by Jury's criterion none grows.
    /// A thousand of them are then run, swept to the limits.
    #[test]
    fn random_parameter_sets_are_stable() {
        let stream = key(5, 0);
        let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
        let between = |n: u64, low: f64, high: f64| low * libm::pow(high / low, unit(n));
        for case in 0..10_000_000_u64 {
            let rate = between(4 * case, 8_000.0, 768_000.0);
            let theta = angle_from_frequency(between(4 * case + 1, 8.0, 0.5 * rate), rate).min(TOP_ANGLE);
            let t60 = between(4 * case + 2, 0.0005, 240.0);
            let c = Coefficients::from_polar(LN_MINUS_60_DB / (t60 * rate), theta, 1.0);
            let (zeta, omega2) = (f64::from(c.zeta as f32), f64::from(c.omega2 as f32));
            assert!(zeta > 0.0 && zeta < 2.0 && omega2 > 0.0 && omega2 < 4.0 - 2.0 * zeta, "{case}: {c:?}");
            if case % 10_000 == 0 {
                let mut bank = ModeBank::new(rate);
                let frequency = theta * rate / (2.0 * PI);
                bank.load(Law::Exact, [ModeSetup { frequency, t60, left: 1.0, right: 1.0 }].into_iter());
                bank.set_coupling(0, Coupling { push: 1.0, ..Coupling::default() });
                let mut peak = run(&mut bank, 1024, Some(&strike())).iter().fold(0.0_f32, |a, b| a.max(b.abs()));
                assert!(peak < 1.001, "{case}: {peak} from {frequency} Hz, {t60} s at {rate} Hz");
                // Jumps of pitch within a tick are no slow sweep and can pump a mode, but not without bound.
                for n in 0..8 {
                    let mut samples = glide(&mut bank, between(4 * case + 3 + n, 0.03, 32.0));
                    samples.extend(run(&mut bank, 256, None));
                    peak = samples.iter().fold(peak, |a, b| a.max(b.abs()));
                }
                assert!(peak < 100.0, "{case}: {peak} from {frequency} Hz, {t60} s at {rate} Hz, swept");
            }
        }
    }
}
