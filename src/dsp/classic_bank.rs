//! Up to 64 masses with the original formulas, stepped one by one as they were written: kept for their sound.

use super::coefficients::Coefficients;
use super::exciter::Drive;
use super::mode_bank::{ExcitationGains, MAX_MODES, ModeSetup};
use super::simd::vector::{LANES, Partial, sum_frames};
use super::{CONTROL_FRAMES, HarmonicOscillator};
use libm::{cosf, sinf};
use std::f64::consts::PI;

/// How far below the angle at which it explodes the step is kept.
const MARGIN: f64 = 0.99;

/// A mode with less energy than this (an amplitude of 1e−20) is set to rest before it can become denormal.
const REST_ENERGY: f64 = 1e-40;

/// A strike at the highest pitch gives seven times the amplitude asked for. A mode that rings louder than this many times
/// what strikes have asked for is brought back to that at the next control tick.
const MOST_GAIN: f64 = 8.0;

/// A bank of [`HarmonicOscillator`]s with [`Coefficients::seed`], the sweep used as the pitch ratio. Real-time safe.
///
/// Each operation is one of the listing's, in its order. Two things are added, and change no bit of a sound that does
/// not run away: the sweep is held below where the step explodes, at every change of damping as well as of pitch; and
/// what a moving sweep has pumped into a mode beyond 8 times what strikes have asked for is taken out again.
#[derive(Clone, Debug)]
pub struct ClassicBank {
    sample_rate: f64,
    len: usize,
    modes: [Mode; MAX_MODES],
    /// Pitch ratio at which the sweeps are, or at which they are to arrive.
    ratio: f64,
    /// Frequencies or T60s have changed since the sweeps set out.
    retuned: bool,
    /// Frames until the next control tick, and those of the line of sweeps that ends there; 0 for none.
    until_tick: usize,
    line_frames: usize,
    output: [[f32; CONTROL_FRAMES]; 2],
}

/// One mass, and what moves it.
#[derive(Clone, Copy, Debug)]
struct Mode {
    mass: HarmonicOscillator<f32>,
    sweep: f32,
    sweep_step: f32,
    frequency: f64,
    t60: f64,
    left: f32,
    right: f32,
    /// Velocity per unit of pulse, displacement per unit of pulse, velocity per unit of noise.
    push: f32,
    pull: f32,
    noise: f32,
    gains: ExcitationGains,
    /// Velocity that rings with the amplitude 1, by the formulas.
    unit_push: f32,
    /// Amplitude that strikes have asked for, less what has decayed since.
    asked: f64,
}

impl Mode {
    const REST: Mode = Mode {
        mass: HarmonicOscillator::REST,
        sweep: 1.0,
        sweep_step: 0.0,
        frequency: 0.0,
        t60: 1.0,
        left: 1.0,
        right: 1.0,
        push: 0.0,
        pull: 0.0,
        noise: 0.0,
        gains: ExcitationGains { push: 0.0, pull: 0.0, noise: 0.0, phase: 0.0 },
        unit_push: 0.0,
        asked: 0.0,
    };

    /// The coefficients of the mode's frequency and T60.
    fn tune(&mut self, sample_rate: f64) {
        let rate = sample_rate as f32;
        let frames = (self.t60 * sample_rate) as f32;
        let zeta = Coefficients::seed(1.0, frames, 1.0, rate).zeta;
        let highest = limit(zeta) / (2.0 * PI) * sample_rate;
        let c = Coefficients::seed(self.frequency.min(highest) as f32, frames, 1.0, rate);
        self.mass.damp(&c);
        self.unit_push = c.v0 as f32;
        // What is still to come of a force is in velocities of this tuning.
        self.set_excitation_gains(self.gains);
        self.sweep = self.sweep.min(self.highest_sweep());
    }

    fn highest_sweep(&self) -> f32 {
        let Coefficients { zeta, omega2, .. } = self.mass.coefficients();
        (limit(zeta) / libm::sqrt(omega2)) as f32
    }

    /// The coefficients at the present sweep.
    fn swept(&self) -> Coefficients {
        let c = self.mass.coefficients();
        let sweep = f64::from(self.sweep);
        Coefficients { omega2: c.omega2 * sweep * sweep, v0: c.v0 * sweep, ..c }
    }

    /// The squared amplitude at which the mass rings at the present sweep.
    fn energy(&self) -> f64 {
        let swept = self.swept();
        let Coefficients { zeta, omega2, x0: x, v0: v } = swept;
        let keep = 1.0 - zeta;
        let half_trace = 0.5 * (1.0 + keep - omega2);
        let discriminant = keep - half_trace * half_trace;
        let form = swept.quadratic_form(x, v);
        if discriminant > 1e-12 && keep > 0.0 {
            form * keep / discriminant
        } else {
            // Over-damped: no ringing, but still something that moves.
            x * x + v * v / omega2.max(1e-12)
        }
    }

    /// The logarithm of what a frame leaves of the energy: the square of the larger root of the step.
    fn energy_rate(&self) -> f64 {
        let Coefficients { zeta, omega2, .. } = self.swept();
        let keep = 1.0 - zeta;
        let half_trace = 0.5 * (1.0 + keep - omega2);
        let discriminant = half_trace * half_trace - keep;
        // A mode without a memory has no logarithm: what is left after a frame is not heard.
        let keep = keep.max(1e-30);
        if discriminant > 0.0 { 2.0 * libm::log(half_trace.abs() + libm::sqrt(discriminant)) } else { libm::log(keep) }
    }

    /// Takes out what a moving sweep has pumped in. `frames` have passed since the last time.
    fn bound(&mut self, frames: usize) {
        let most = MOST_GAIN * self.asked;
        let energy = self.energy();
        if energy > most * most {
            let factor = (most / libm::sqrt(energy)) as f32;
            self.mass.x *= factor;
            self.mass.v *= factor;
        }
        self.asked *= libm::exp(0.5 * self.energy_rate().min(0.0) * frames as f64);
    }

    /// Takes over what drives the mode.
    fn set_excitation_gains(&mut self, gains: ExcitationGains) {
        self.gains = gains;
        let (mut push, mut pull) = (gains.push, gains.pull);
        if gains.phase != 0.0 {
            let (sin, cos) = (sinf(gains.phase), cosf(gains.phase));
            (push, pull) = (push * cos - pull * sin, pull * cos + push * sin);
        }
        (self.push, self.pull, self.noise) = (push * self.unit_push, pull, gains.noise * self.unit_push);
    }
}

/// Largest `ω` (times sweep) of the step: it explodes where `ω² = 4 − 2ζ`.
fn limit(zeta: f64) -> f64 {
    MARGIN * libm::sqrt(4.0 - 2.0 * zeta)
}

impl ClassicBank {
    /// An empty bank.
    pub fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            len: 0,
            modes: [Mode::REST; MAX_MODES],
            ratio: 1.0,
            retuned: false,
            until_tick: 0,
            line_frames: 0,
            output: [[0.0; CONTROL_FRAMES]; 2],
        }
    }

    fn modes(&mut self) -> &mut [Mode] {
        &mut self.modes[..self.len]
    }

    /// As [`super::ModeBank::load`].
    pub fn load(&mut self, modes: impl Iterator<Item = ModeSetup>) {
        self.len = 0;
        for (mode, ModeSetup { frequency, t60, left, right }) in self.modes.iter_mut().zip(modes) {
            *mode = Mode { frequency, t60, left, right, ..Mode::REST };
            self.len += 1;
        }
        self.retuned = true;
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

    /// As [`super::ModeBank::set_excitation_gains`].
    pub fn set_excitation_gains(&mut self, m: usize, gains: ExcitationGains) {
        self.tune();
        self.modes[m].set_excitation_gains(gains);
    }

    /// As [`super::ModeBank::set_t60`].
    pub fn set_t60(&mut self, m: usize, t60: f64) {
        self.modes[m].t60 = t60;
        self.retuned = true;
    }

    /// As [`super::ModeBank::retune`].
    pub fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        let before: [f64; MAX_MODES] = std::array::from_fn(|m| self.modes[m].mass.coefficients().omega2);
        for (mode, tuning) in self.modes().iter_mut().zip(modes) {
            (mode.frequency, mode.t60) = tuning;
        }
        self.retuned = true;
        self.tune();
        for (mode, before) in self.modes().iter_mut().zip(before) {
            // Sweep times ω, and velocity times sweep, are what was before.
            let stretch = libm::sqrtf((mode.mass.coefficients().omega2 / before) as f32);
            mode.sweep = (mode.sweep / stretch).min(mode.highest_sweep());
            mode.mass.v *= stretch;
        }
        self.retuned = true;
    }

    fn tune(&mut self) {
        if std::mem::take(&mut self.retuned) {
            let sample_rate = self.sample_rate;
            self.modes().iter_mut().for_each(|mode| mode.tune(sample_rate));
        }
    }

    /// As [`super::ModeBank::sweep_to`].
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        let passed = self.line_frames.saturating_sub(self.until_tick);
        self.modes().iter_mut().for_each(|mode| mode.bound(passed));
        let same = ratio == self.ratio && !self.retuned;
        let arrived = same && self.until_tick == 0;
        self.tune();
        (self.ratio, self.until_tick, self.line_frames) = (ratio, frames, frames);
        self.aim(if arrived { None } else { Some(1.0 / frames as f32) });
    }

    /// As [`super::ModeBank::jump_to`].
    pub fn jump_to(&mut self, ratio: f64) {
        self.tune();
        (self.ratio, self.until_tick, self.line_frames) = (ratio, 0, 0);
        self.aim(None);
    }

    fn aim(&mut self, per_frame: Option<f32>) {
        let ratio = self.ratio as f32;
        for mode in self.modes() {
            let sweep = ratio.min(mode.highest_sweep());
            match per_frame {
                Some(share) => mode.sweep_step = (sweep - mode.sweep) * share,
                None => (mode.sweep, mode.sweep_step) = (sweep, 0.0),
            }
        }
    }

    /// As [`super::ModeBank::render`].
    pub fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        let frames = frames.min(CONTROL_FRAMES);
        let drive = drive.unwrap_or(&Drive::NONE);
        let area = |force: &[f32]| force[..frames].iter().map(|force| f64::from(force.abs())).sum::<f64>();
        let (pulse, noise) = (area(&drive.pulse), area(&drive.noise));
        let mut sums = [[Partial([0.0; LANES]); CONTROL_FRAMES]; 2];
        let [left, right] = &mut sums;
        for (m, mode) in self.modes[..self.len].iter_mut().enumerate() {
            let ExcitationGains { push, pull, noise: by_noise, .. } = mode.gains;
            mode.asked += pulse * f64::from(push.abs() + pull.abs()) + noise * f64::from(by_noise.abs());
            for i in 0..frames {
                mode.sweep += mode.sweep_step;
                mode.mass.v += drive.pulse[i] * mode.push + drive.noise[i] * mode.noise;
                mode.mass.x += drive.pulse[i] * mode.pull;
                let heard = mode.mass.step_with_sweep(mode.sweep);
                left[i].0[m % LANES] += heard * mode.left;
                right[i].0[m % LANES] += heard * mode.right;
            }
        }
        for (sums, out) in sums.iter().zip(&mut self.output) {
            sum_frames(&sums[..frames], out);
        }
        self.until_tick = self.until_tick.saturating_sub(frames);
        let [left, right] = &self.output;
        [&left[..frames], &right[..frames]]
    }

    /// As [`super::ModeBank::mass`].
    pub fn mass(&self, m: usize) -> (f32, f32) {
        (self.modes[m].mass.x, self.modes[m].energy() as f32)
    }

    /// As [`super::ModeBank::settle`].
    pub fn settle(&mut self) -> f64 {
        let mut total = 0.0;
        for mode in self.modes() {
            let energy = mode.energy();
            if energy < REST_ENERGY {
                (mode.mass.x, mode.mass.v) = (0.0, 0.0);
            }
            total += energy;
        }
        total
    }

    /// As [`super::ModeBank::tell_energies`].
    pub(super) fn tell_energies(&self, mut each: impl FnMut(f64, f64)) {
        self.modes[..self.len].iter().for_each(|mode| each(mode.energy(), mode.energy_rate()));
    }
}
