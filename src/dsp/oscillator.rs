//! The mass on a spring: two multiplications, two subtractions and one addition per sample.

use super::coefficients::Coefficients;
use super::real::Real;

/// A mass on a spring, stepped once per sample. It is the definition of a mode.
///
/// The coefficients of [`super::ModeBank`] are derived from it, and the bank's tests compare the bank with it. The bank
/// stores the same mass in other coordinates, `(x, y)`, where `y` is the displacement a quarter period later. In these
/// coordinates the pitch may move in any way. With constant coefficients both give the same samples.
///
/// `x` is the displacement (the audio sample), `v` the velocity in displacement per sample. Source: `Step` and
/// `StepWithSweep` of "Harmonic oscillator, I turned jiggle physics code into a synthesizer", operation for operation.
/// Everything here is real-time safe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicOscillator<T> {
    /// Displacement.
    pub x: T,
    /// Velocity, per sample.
    pub v: T,
    zeta: T,
    omega2: T,
}

impl HarmonicOscillator<f32> {
    /// At rest, with neither spring nor damper.
    pub(crate) const REST: Self = Self { x: 0.0, v: 0.0, zeta: 0.0, omega2: 0.0 };
}

impl<T: Real> HarmonicOscillator<T> {
    /// An oscillator with the starting state of `coefficients`, rounded to `T`.
    pub fn new(coefficients: &Coefficients) -> Self {
        Self {
            x: T::from_f64(coefficients.x0),
            v: T::from_f64(coefficients.v0),
            zeta: T::from_f64(coefficients.zeta),
            omega2: T::from_f64(coefficients.omega2),
        }
    }

    /// The next sample.
    #[inline]
    pub fn step(&mut self) -> T {
        self.v -= self.v * self.zeta + self.x * self.omega2;
        self.x += self.v;
        self.x
    }

    /// The next sample at a swept pitch: the frequency is multiplied by about `sweep`. ([`Coefficients::sweep_for_ratio`]
    /// gives the sweep for an exact ratio.)
    ///
    /// At any constant sweep below the limit of [`Coefficients::sweep_for_ratio`] this is as exact as [`Self::step`].
    /// The sweep may change if it moves slowly compared with the oscillation and stays well below half the sample rate: a
    /// bend, a vibrato of a few hertz, the falling pitch of a kick drum. Changes at a rate near twice the mass's frequency, or
    /// at a pitch near half the sample rate, add energy without bound (+108 dB in two seconds at 23 kHz with a vibrato of ±800
    /// cents at 20 Hz, at 48 kHz). So does damping that changes while the sweep moves. The bank does not have these limits.
    #[inline]
    pub fn step_with_sweep(&mut self, sweep: T) -> T {
        self.v -= self.v * self.zeta + self.x * self.omega2 * sweep;
        self.x += self.v * sweep;
        self.x
    }

    /// Strikes the mass: adds velocity, without a click. A moving mass gains or loses energy.
    pub fn strike(&mut self, velocity: T) {
        self.v += velocity;
    }

    /// Changes decay or pitch from the next step on. The displacement is continuous.
    pub(crate) fn damp(&mut self, coefficients: &Coefficients) {
        self.zeta = T::from_f64(coefficients.zeta);
        self.omega2 = T::from_f64(coefficients.omega2);
    }

    /// The coefficients in use, with the present state as the starting state.
    pub(crate) fn coefficients(&self) -> Coefficients {
        Coefficients {
            zeta: self.zeta.to_f64(),
            omega2: self.omega2.to_f64(),
            x0: self.x.to_f64(),
            v0: self.v.to_f64(),
        }
    }

    /// Amplitude of the oscillation at this sample, in closed form.
    pub fn amplitude(&self) -> f64 {
        self.coefficients().amplitude(self.x.to_f64(), self.v.to_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::coefficients::{LN_MINUS_60_DB, angle_from_frequency};
    use libm::{exp, pow, sin};

    fn radius_from_t60(t60: f64) -> f64 {
        exp(LN_MINUS_60_DB / (t60 * 48_000.0))
    }

    #[test]
    fn the_step_is_the_damped_sinusoid_asked_for() {
        for (frequency, t60) in [(27.5, 10.0), (440.0, 1.0), (4186.0, 0.1), (12_000.0, 0.01), (23_500.0, 2.0)] {
            let coefficients = Coefficients::exact(frequency, t60, 0.8, 48_000.0);
            let mut reference = HarmonicOscillator::<f64>::new(&coefficients);
            let mut audio = HarmonicOscillator::<f32>::new(&coefficients);
            let (theta, radius) = (angle_from_frequency(frequency, 48_000.0), radius_from_t60(t60));
            for n in 1..=(t60 * 48_000.0) as i32 {
                let expected = 0.8 * pow(radius, n.into()) * sin(f64::from(n) * theta);
                assert!((reference.step() - expected).abs() < 1e-9, "{frequency} Hz, frame {n}");
                // In single precision the rounding of ω², 2⁻²³ at most, causes a phase error that grows with n sin θ.
                let drift = f64::from(n) * 1.2e-7 / (2.0 * sin(theta));
                let error = (f64::from(audio.step()) - expected).abs() / pow(radius, n.into());
                assert!(error < 4e-5 + drift, "{frequency} Hz in f32, frame {n}: {error:e}");
            }
        }
    }

    #[test]
    fn a_sweep_of_one_is_no_sweep_to_the_bit() {
        let coefficients = Coefficients::exact(440.0, 1.0, 1.0, 48_000.0);
        let mut plain = HarmonicOscillator::<f32>::new(&coefficients);
        let mut swept = plain;
        assert!((0..10_000).all(|_| plain.step() == swept.step_with_sweep(1.0)));
    }

    #[test]
    fn amplitude_is_the_envelope_at_any_phase() {
        let mut mass = HarmonicOscillator::<f64>::new(&Coefficients::exact(997.0, 0.2, 0.5, 48_000.0));
        let radius = radius_from_t60(0.2);
        for n in 1..2000 {
            mass.step();
            assert!((mass.amplitude() / (0.5 * pow(radius, n.into())) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn strike_and_damp_leave_the_displacement_alone() {
        let mut mass = HarmonicOscillator::<f32>::new(&Coefficients::exact(100.0, 1.0, 1.0, 48_000.0));
        (0..100).for_each(|_| {
            mass.step();
        });
        let x = mass.x;
        mass.damp(&Coefficients::exact(100.0, 0.05, 1.0, 48_000.0));
        mass.strike(0.01);
        assert_eq!(mass.x, x);
        let before = mass.amplitude();
        (0..2400).for_each(|_| {
            mass.step();
        });
        assert!((mass.amplitude() / before - 0.001).abs() < 1e-5, "the new T60 of 2,400 frames");
    }
}
