//! The two coefficients of a mass on a spring: three ways to compute them, and quantities derived from them.
//!
//! As a matrix the step is `[x; v] ← [[1−ω², 1−ζ], [−ω², 1−ζ]] [x; v]`, with determinant `1−ζ` and trace `2−ω²−ζ`.
//! A damped sinusoid of radius `r` and angle `θ` per sample has determinant `r²` and trace `2 r cos θ`;
//! equating the two gives [`Coefficients::exact`].

use libm::{asin, cos, exp, expm1, log, sin, sqrt};
use std::f64::consts::{PI, TAU};

/// Natural logarithm of −60 dB, as an amplitude ratio of 0.001.
pub(crate) const LN_MINUS_60_DB: f64 = -6.907_755_278_982_137;

/// `ζ`, `ω²` and the starting state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Share of the velocity that is lost per sample.
    pub zeta: f64,
    /// Restoring force per displacement, per sample squared.
    pub omega2: f64,
    /// Displacement before the first step.
    pub x0: f64,
    /// Velocity before the first step, in displacement per sample.
    pub v0: f64,
}

/// Angle per sample of a frequency in Hz.
pub(crate) fn angle_from_frequency(frequency: f64, sample_rate: f64) -> f64 {
    TAU * frequency / sample_rate
}

/// `(1−r)² + 4 r sin²(θ/2)`: the `ω²` of a damped sinusoid. (`1 + r² − 2 r cos θ` would cancel at low pitch.)
pub(crate) fn omega2_from_angle(radius: f64, theta: f64) -> f64 {
    let half_chord = sin(0.5 * theta);
    let loss = 1.0 - radius;
    loss * loss + 4.0 * radius * half_chord * half_chord
}

impl Coefficients {
    /// A damped sinusoid `amplitude · rⁿ · sin(n θ)`, exactly, for every frequency below half the sample rate.
    ///
    /// `frequency` in Hz, `t60` in seconds (infinite: undamped), `sample_rate` in Hz. Real-time safe.
    pub fn exact(frequency: f64, t60: f64, amplitude: f64, sample_rate: f64) -> Self {
        Self::from_polar(
            LN_MINUS_60_DB / (t60 * sample_rate),
            angle_from_frequency(frequency, sample_rate).min(PI),
            amplitude,
        )
    }

    /// [`Coefficients::exact`] from the logarithm of the radius and the angle, both per sample.
    pub(crate) fn from_polar(ln_radius: f64, theta: f64, amplitude: f64) -> Self {
        let radius = exp(ln_radius);
        Self {
            zeta: -expm1(2.0 * ln_radius),
            omega2: omega2_from_angle(radius, theta),
            x0: 0.0,
            v0: amplitude * sin(theta) / radius,
        }
    }

    /// The original formulas, in single precision as they were written: sharp at high pitch, flat when heavily damped,
    /// and unstable above `sample_rate / π`. Kept for comparison and for the `classic` sound.
    ///
    /// Source: "Harmonic oscillator, I turned jiggle physics code into a synthesizer", its complete `Initialise`
    /// (`m_zeta` doubled, then `m_omega` squared). The transcendental part is evaluated in double precision and rounded
    /// once, so that it does not depend on a system's `expf`. Real-time safe.
    pub fn seed(frequency: f32, decay_frames: f32, amplitude: f32, sample_rate: f32) -> Self {
        let omega = (f64::from(frequency / sample_rate) * PI * 2.0) as f32;
        let exponent = log(f64::from(0.001_f32)) as f32 / decay_frames;
        let zeta = (1.0 - exp(f64::from(exponent)) as f32) * 2.0;
        Self { zeta: f64::from(zeta), omega2: f64::from(omega * omega), x0: 0.0, v0: f64::from(omega * amplitude) }
    }

    /// A mass `m` on a spring of stiffness `k` with a damper `c`, sampled every `dt`, starting from displacement `x0`
    /// and velocity `velocity0` (per second). The step follows the continuous motion exactly in all cases: under-damped,
    /// critically damped, over-damped, undamped (`c = 0`), without a spring (`k = 0`), and without both.
    ///
    /// If the damper stops any velocity within one sample (`ζ` rounds to 1), no `v0` can move the mass, so `v0` is 0.
    /// The displacement is then wrong by at most `(|velocity0| + |x0| k/c)·m/c`, and this error shrinks as the mass
    /// returns.
    ///
    /// `m > 0`, `c ≥ 0`, `k ≥ 0`, `dt > 0`, in consistent units. Source: the closed form of "Damped Harmonic
    /// Oscillator" (`τ₀`, `τ₁`). Real-time safe.
    pub(crate) fn mass_spring(m: f64, c: f64, k: f64, x0: f64, velocity0: f64, dt: f64) -> Self {
        let lambda = 0.5 * c / m * dt;
        let omega0_squared = k / m * dt * dt;
        let sigma_squared = lambda * lambda - omega0_squared;
        let scale = sqrt(sigma_squared.abs());
        let decay = exp(-lambda);
        // τ₀ and τ₁ over one sample are both multiplied by e^(−λ̄), because cosh and sinh alone could overflow although the
        // product is small. ω² = 1 + g² − 2 g τ₀ is written so that no digits cancel.
        let (tau0, tau1, omega2) = if sigma_squared < 0.0 {
            (decay * cos(scale), decay * sin(scale) / scale, omega2_from_angle(decay, scale))
        } else if sigma_squared > 0.0 {
            let slow = omega0_squared / (lambda + scale);
            let (slowly, shrink) = (exp(-slow), expm1(-2.0 * scale));
            let (tau0, tau1) = (slowly * (1.0 + 0.5 * shrink), -slowly * shrink / (2.0 * scale));
            (tau0, tau1, expm1(-slow) * expm1(-lambda - scale))
        } else {
            (decay, decay, (1.0 - decay) * (1.0 - decay))
        };
        let x1 = x0 * (tau0 + lambda * tau1) + velocity0 * dt * tau1;
        let zeta = -expm1(-2.0 * lambda);
        let v0 = if zeta == 1.0 { 0.0 } else { (x1 - x0 * (1.0 - omega2)) / (decay * decay) };
        Self { zeta, omega2, x0, v0 }
    }

    /// Amplitude ratio per sample, `r = √(1−ζ)`.
    pub(crate) fn radius(&self) -> f64 {
        sqrt(1.0 - self.zeta)
    }

    /// Angle per sample `θ`, for coefficients that oscillate. NaN for others (over-damped or unstable).
    pub(crate) fn angle(&self) -> f64 {
        let radius = self.radius();
        let loss = 1.0 - radius;
        2.0 * asin(sqrt((self.omega2 - loss * loss) / (4.0 * radius)))
    }

    /// The sweep that multiplies the pitch by exactly `ratio`. The decay does not change, because the sweep does not
    /// change the determinant `1−ζ`. The pitch stays below half the sample rate. Real-time safe.
    pub fn sweep_for_ratio(&self, ratio: f64) -> f64 {
        sqrt(omega2_from_angle(self.radius(), (ratio * self.angle()).min(PI)) / self.omega2)
    }

    /// Amplitude of the damped sinusoid that passes through the state `(x, v)`: the envelope of the output at this
    /// sample.
    ///
    /// From `A² sin²θ = ω² x² + (ζ−ω²) x v + (1−ζ) v²`; each step multiplies this quadratic form by `r²`. Only meaningful
    /// for coefficients that oscillate. Real-time safe.
    pub fn amplitude(&self, x: f64, v: f64) -> f64 {
        sqrt(self.quadratic_form(x, v).max(0.0) / self.sin_squared_angle())
    }

    /// `A² sin²θ` of a state: each step multiplies it by `r²`.
    pub(super) fn quadratic_form(&self, x: f64, v: f64) -> f64 {
        self.omega2 * x * x + (self.zeta - self.omega2) * x * v + (1.0 - self.zeta) * v * v
    }

    /// `sin²θ = 4 sin²(θ/2) (1 − sin²(θ/2))`.
    fn sin_squared_angle(&self) -> f64 {
        let radius = self.radius();
        let loss = 1.0 - radius;
        let half = (self.omega2 - loss * loss) / (4.0 * radius);
        4.0 * half * (1.0 - half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::HarmonicOscillator;
    use proptest::prelude::*;

    /// The sample implementation of "Damped Harmonic Oscillator": position and velocity at time `t`.
    fn sprung_response(t: f64, d: f64, v: f64, k: f64, c: f64, m: f64) -> (f64, f64) {
        let decay = c / 2.0 / m;
        let omega = sqrt(k / m);
        let resid = decay * decay - omega * omega;
        let scale = sqrt(resid.abs());
        let (t1, t0) = if resid < 0.0 {
            (sin(scale * t) / scale, cos(scale * t))
        } else if resid > 0.0 {
            (libm::sinh(scale * t) / scale, libm::cosh(scale * t))
        } else {
            (t, 1.0)
        };
        let dissipation = exp(-decay * t);
        (
            dissipation * (d * (t0 + t1 * decay) + v * t1),
            dissipation * (d * (-t1 * omega * omega) + v * (t0 - t1 * decay)),
        )
    }

    #[test]
    fn the_step_follows_the_closed_form_in_every_regime() {
        let dt = 0.01;
        for (regime, m, c, k) in [
            ("underdamped", 1.0, 0.4, 50.0),
            ("underdamped, heavy", 3.0, 2.0, 700.0),
            ("critically damped", 1.0, 2.0 * 4.0, 16.0),
            ("overdamped", 1.0, 20.0, 16.0),
            ("strongly overdamped", 0.5, 40.0, 1.0),
            ("undamped", 1.0, 0.0, 50.0),
            ("unsprung", 1.0, 3.0, 0.0),
            ("unimpeded", 2.0, 0.0, 0.0),
        ] {
            for (x0, v0) in [(0.5, 0.0), (0.0, 1.0), (-0.3, 0.7)] {
                let mut mass = HarmonicOscillator::<f64>::new(&Coefficients::mass_spring(m, c, k, x0, v0, dt));
                let worst = (1..=400).fold(0.0_f64, |worst, n| {
                    let (expected, _) = sprung_response(f64::from(n) * dt, x0, v0, k, c, m);
                    worst.max((mass.step() - expected).abs())
                });
                assert!(worst < 1e-12, "{regime} from ({x0}, {v0}): {worst:e}");
            }
        }
    }

    /// Compared with `(s₂ e^(s₁t) − s₁ e^(s₂t)) / (s₂ − s₁)` and `(e^(s₁t) − e^(s₂t)) / (s₁ − s₂)`, where the fast
    /// `e^(s₂t)` is 0.
    #[test]
    fn heavy_damping_creeps_and_does_not_overflow() {
        for (m, c, k, x0, velocity0) in [
            (1.0, 2000.0, 1.0, 0.5, 0.0),
            (1.0, 2000.0, 1.0, 0.5, -3.0),
            (1.0, 40.0, 1.0, 0.5, 1.0),
            (1.0, 1e6, 0.0, 0.0, 1.0),
            (2.0, 1e9, 1e9, -0.3, 0.7),
        ] {
            let coefficients = Coefficients::mass_spring(m, c, k, x0, velocity0, 1.0);
            assert_eq!(coefficients.v0, 0.0);
            let spread = sqrt(c * c - 4.0 * k * m) / m;
            let slow = -2.0 * k / (c + m * spread);
            let tolerance = (f64::abs(velocity0) + f64::abs(x0) * k / c) * m / c * 1.01 + 1e-12;
            let mut mass = HarmonicOscillator::<f64>::new(&coefficients);
            for n in 1..=100 {
                let expected = ((spread - slow) * x0 + velocity0) / spread * exp(slow * f64::from(n));
                let (x, most) = (mass.step(), tolerance * exp(slow * f64::from(n)) + 1e-12);
                assert!((x - expected).abs() <= most, "c {c} from ({x0}, {velocity0}): {x} {expected}");
            }
        }
    }

    /// The pitch error in cents of the original formulas must match the published figures for 48 kHz.
    #[test]
    fn the_seed_is_as_far_out_as_published() {
        let cents = |frequency: f64, t60: f64| {
            let seed = Coefficients::seed(frequency as f32, (t60 * 48_000.0) as f32, 1.0, 48_000.0);
            1200.0 * libm::log2(seed.angle() / angle_from_frequency(frequency, 48_000.0))
        };
        for (frequency, t60, published) in
            [(440.0, 1.0, 0.4), (4186.0, 1.0, 22.4), (8000.0, 1.0, 89.0), (12_000.0, 1.0, 243.0), (27.5, 0.1, -149.0)]
        {
            let measured = cents(frequency, t60);
            let shown = if published == f64::trunc(published) { 0.7 } else { 0.05 };
            assert!((measured - published).abs() <= shown, "{frequency} Hz: {measured} against {published}");
        }
        assert!(cents(15_270.0, 60.0).is_finite());
        assert!(cents(15_290.0, 60.0).is_nan(), "past sample_rate / π there is no pitch left: it explodes");
    }

    proptest! {
        #[test]
        fn exact_coefficients_have_the_pitch_and_decay_asked_for(
            theta in 1e-4..3.1f64, frames in 50.0..1e7f64, ratio in 0.1..8.0f64, amplitude in 1e-3..1.0f64,
        ) {
            let c = Coefficients::from_polar(LN_MINUS_60_DB / frames, theta, amplitude);
            prop_assert!((c.angle() / theta - 1.0).abs() < 1e-9);
            prop_assert!((2.0 * LN_MINUS_60_DB / log(1.0 - c.zeta) / frames - 1.0).abs() < 1e-8);
            // With the sweep, the trace must be that of the new angle and the determinant must not change.
            let target = (ratio * theta).min(PI);
            let s = c.sweep_for_ratio(ratio);
            let trace = 2.0 - s * s * c.omega2 - c.zeta;
            prop_assert!((trace - 2.0 * c.radius() * cos(target)).abs() < 1e-9);
            prop_assert!((c.amplitude(0.0, c.v0) / amplitude - 1.0).abs() < 1e-6);
        }
    }
}
