//! Up to 64 masses with the original formulas, stepped one by one as in the original, for the sake of its sound.

use super::coefficients::Coefficients;
use super::exciter::Drive;
use super::mode_bank::{ExcitationGains, ExcitationRows, MAX_MODES, ModeRows};
use super::simd::vector::{LANES, Partial, sum_frames};
use super::{CONTROL_FRAMES, HarmonicOscillator};
use std::f64::consts::PI;

/// The step is unstable above a certain angle. The angle is kept below this share of it.
const MARGIN: f64 = 0.99;

/// A mode with less energy than this (an amplitude of 1e−20) is set to rest before it can become denormal.
const REST_ENERGY: f64 = 1e-40;

/// With the original formulas, a strike at the highest pitch gives seven times the requested amplitude. If the amplitude of
/// a mode exceeds this many times the amplitude that strikes have requested, it is reduced to that at the next control tick.
const MOST_GAIN: f64 = 8.0;

/// A bank of [`HarmonicOscillator`]s with [`Coefficients::seed`]; the sweep sets the pitch ratio. Real-time safe.
///
/// Each operation is one of the original listing, in its order. Two protections are added; they change no bit of a
/// sound that stays stable. First, whenever damping or pitch changes, the sweep is kept below the value at which the step
/// becomes unstable. Second, since a moving sweep can add energy to a mode, its amplitude is limited to 8 times the
/// amplitude that strikes have requested.
#[derive(Clone, Debug)]
pub(crate) struct ClassicBank {
    sample_rate: f64,
    len: usize,
    modes: [Mode; MAX_MODES],
    /// Pitch ratio of the sweeps, or their target while they move.
    ratio: f64,
    /// Whether frequencies or T60s have changed since the last [`ClassicBank::sweep_to`].
    retuned: bool,
    /// Frames until the next control tick, and the length in frames of the sweeps' ramp that ends there; 0 if they do not move.
    until_tick: usize,
    line_frames: usize,
    output: [[f32; CONTROL_FRAMES]; 2],
}

/// One mass and its excitation gains.
#[derive(Clone, Copy, Debug)]
struct Mode {
    mass: HarmonicOscillator<f32>,
    sweep: f32,
    sweep_step: f32,
    frequency: f64,
    t60: f64,
    left: f32,
    right: f32,
    /// Velocity and displacement for each unit of push and each unit of pull, and velocity for each unit of noise.
    push: [f32; 2],
    pull: [f32; 2],
    noise: f32,
    gains: ExcitationGains,
    /// Velocity that gives amplitude 1, by the original formulas.
    unit_push: f32,
    /// Amplitude that strikes have requested, reduced by the decay since then.
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
        push: [0.0; 2],
        pull: [0.0; 2],
        noise: 0.0,
        gains: ExcitationGains::NONE,
        unit_push: 0.0,
        asked: 0.0,
    };

    /// Computes the coefficients from the mode's frequency and T60.
    fn tune(&mut self, sample_rate: f64) {
        let rate = sample_rate as f32;
        let frames = (self.t60 * sample_rate) as f32;
        let zeta = Coefficients::seed(1.0, frames, 1.0, rate).zeta;
        let highest = limit(zeta) / (2.0 * PI) * sample_rate;
        let c = Coefficients::seed(self.frequency.min(highest) as f32, frames, 1.0, rate);
        self.mass.damp(&c);
        self.unit_push = c.v0 as f32;
        // The gains are velocities for these coefficients, so the rest of a running pulse needs new ones.
        self.set_excitation_gains(self.gains);
        self.sweep = self.sweep.min(self.highest_sweep());
    }

    fn highest_sweep(&self) -> f32 {
        let Coefficients { zeta, omega2, .. } = self.mass.coefficients();
        (limit(zeta) / libm::sqrt(omega2)) as f32
    }

    /// The coefficients at the present sweep value.
    fn swept(&self) -> Coefficients {
        let c = self.mass.coefficients();
        let sweep = f64::from(self.sweep);
        Coefficients { omega2: c.omega2 * sweep * sweep, v0: c.v0 * sweep, ..c }
    }

    /// The squared amplitude of the mass at the present sweep value.
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
            // Over-damped: the mass does not oscillate, but it still moves.
            x * x + v * v / omega2.max(1e-12)
        }
    }

    /// The natural logarithm of the energy ratio per frame: the energy decays with the square of the larger eigenvalue
    /// of the step.
    fn energy_rate(&self) -> f64 {
        let Coefficients { zeta, omega2, .. } = self.swept();
        let keep = 1.0 - zeta;
        let half_trace = 0.5 * (1.0 + keep - omega2);
        let discriminant = half_trace * half_trace - keep;
        // With `keep` = 0 the logarithm would be infinite. Anything this small is inaudible after one frame.
        let keep = keep.max(1e-30);
        if discriminant > 0.0 { 2.0 * libm::log(half_trace.abs() + libm::sqrt(discriminant)) } else { libm::log(keep) }
    }

    /// Removes the energy that a moving sweep has added. `frames` have passed since the last call.
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

    /// Sets how strongly pulse and noise excite the mode.
    fn set_excitation_gains(&mut self, gains: ExcitationGains) {
        self.gains = gains;
        let [cos, sin] = gains.turn;
        let turned = |velocity: f32, displacement: f32| {
            [(velocity * cos - displacement * sin) * self.unit_push, displacement * cos + velocity * sin]
        };
        (self.push, self.pull) = (turned(gains.push, 0.0), turned(0.0, gains.pull));
        self.noise = gains.noise * self.unit_push;
    }
}

/// Largest `ω` (times sweep): the step becomes unstable where `ω² = 4 − 2ζ`.
fn limit(zeta: f64) -> f64 {
    MARGIN * libm::sqrt(4.0 - 2.0 * zeta)
}

impl ClassicBank {
    /// An empty bank.
    pub(crate) fn new(sample_rate: f64) -> Self {
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

    /// Like [`super::ModeBank::load`].
    pub(crate) fn load(&mut self, modes: &ModeRows) {
        let ModeRows { frequency, t60, left, right, len } = modes;
        self.len = (*len).min(MAX_MODES);
        for (m, mode) in self.modes[..self.len].iter_mut().enumerate() {
            *mode = Mode { frequency: frequency[m], t60: t60[m], left: left[m], right: right[m], ..Mode::REST };
        }
        self.retuned = true;
        self.jump_to(1.0);
    }

    /// Number of modes.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Like [`super::ModeBank::set_excitation_gains`].
    pub(crate) fn set_excitation_gains(&mut self, gains: &ExcitationRows) {
        self.tune();
        self.modes().iter_mut().enumerate().for_each(|(m, mode)| mode.set_excitation_gains(gains.at(m)));
    }

    /// Like [`super::ModeBank::nudge`]; as with strikes, the original formulas give a high mode more than `amplitude`.
    pub(crate) fn nudge(&mut self, m: usize, amplitude: f32) {
        self.tune();
        if let Some(mode) = self.modes().get_mut(m) {
            mode.mass.v += (amplitude * mode.unit_push).copysign(mode.mass.v);
            mode.asked += f64::from(amplitude);
        }
    }

    /// Like [`super::ModeBank::set_t60`].
    pub(crate) fn set_t60(&mut self, m: usize, t60: f64) {
        self.modes[m].t60 = t60;
        self.retuned = true;
    }

    /// Like [`super::ModeBank::retune`].
    pub(crate) fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        let before: [f64; MAX_MODES] = std::array::from_fn(|m| self.modes[m].mass.coefficients().omega2);
        for (mode, tuning) in self.modes().iter_mut().zip(modes) {
            (mode.frequency, mode.t60) = tuning;
        }
        self.retuned = true;
        self.tune();
        for (mode, before) in self.modes().iter_mut().zip(before) {
            // Keep sweep · ω and velocity · sweep as they were, so that pitch and amplitude do not jump.
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

    /// Like [`super::ModeBank::sweep_to`].
    pub(crate) fn sweep_to(&mut self, ratio: f64, frames: usize) {
        let passed = self.line_frames.saturating_sub(self.until_tick);
        self.modes().iter_mut().for_each(|mode| mode.bound(passed));
        let same = ratio == self.ratio && !self.retuned;
        let arrived = same && self.until_tick == 0;
        self.tune();
        (self.ratio, self.until_tick, self.line_frames) = (ratio, frames, frames);
        self.aim(if arrived { None } else { Some(1.0 / frames as f32) });
    }

    /// Like [`super::ModeBank::jump_to`].
    pub(crate) fn jump_to(&mut self, ratio: f64) {
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

    /// Like [`super::ModeBank::render`].
    pub(crate) fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        let frames = frames.min(CONTROL_FRAMES);
        let drive = drive.unwrap_or(&Drive::NONE);
        let area = |force: &[f32]| force[..frames].iter().map(|force| f64::from(force.abs())).sum::<f64>();
        let [pushed, pulled, burst] = [&drive.push, &drive.pull, &drive.noise].map(|force| area(force));
        let mut sums = [[Partial([0.0; LANES]); CONTROL_FRAMES]; 2];
        let [left, right] = &mut sums;
        for (m, mode) in self.modes[..self.len].iter_mut().enumerate() {
            let ExcitationGains { push, pull, noise, .. } = mode.gains;
            mode.asked +=
                pushed * f64::from(push.abs()) + pulled * f64::from(pull.abs()) + burst * f64::from(noise.abs());
            for i in 0..frames {
                mode.sweep += mode.sweep_step;
                let (push, pull) = (drive.push[i], drive.pull[i]);
                mode.mass.v += push * mode.push[0] + pull * mode.pull[0] + drive.noise[i] * mode.noise;
                mode.mass.x += push * mode.push[1] + pull * mode.pull[1];
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

    /// Like [`super::ModeBank::mass`].
    pub(crate) fn mass(&self, m: usize) -> (f32, f32) {
        (self.modes[m].mass.x, self.modes[m].energy() as f32)
    }

    /// Like [`super::ModeBank::rest`].
    pub(crate) fn rest(&mut self) {
        self.modes.iter_mut().for_each(|mode| (mode.mass.x, mode.mass.v) = (0.0, 0.0));
    }

    /// Like [`super::ModeBank::take_state_of`].
    pub(crate) fn take_state_of(&mut self, other: &Self) {
        let states = self.modes.iter_mut().zip(&other.modes);
        states.for_each(|(mode, other)| (mode.mass.x, mode.mass.v) = (other.mass.x, other.mass.v));
    }

    /// Like [`super::ModeBank::settle`].
    pub(crate) fn settle(&mut self) -> f64 {
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

    /// Like [`super::ModeBank::tell_energies`].
    pub(super) fn tell_energies(&self, mut each: impl FnMut(f64, f64)) {
        self.modes[..self.len].iter().for_each(|mode| each(mode.energy(), mode.energy_rate()));
    }
}
