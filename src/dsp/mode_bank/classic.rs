//! The original formulas, a mode at a time: kept for their sound, not for speed.

use super::{LN_MINUS_60_DB, ModeBank};
use crate::dsp::Coefficients;
use std::f64::consts::PI;

/// How far below the angle at which it explodes the step is kept.
const MARGIN: f64 = 0.99;

/// A mode with less energy than this (an amplitude of 1e−20) is set to rest before it can become denormal.
const REST_ENERGY: f64 = 1e-40;

impl ModeBank {
    /// The coefficients of mode `m`.
    pub(super) fn tune_classic(&mut self, m: usize) {
        let frames = (LN_MINUS_60_DB / self.ln_radius[m]) as f32;
        let zeta = Coefficients::seed(1.0, frames, 1.0, self.sample_rate as f32).zeta;
        let highest = limit(zeta) / (2.0 * PI) * self.sample_rate;
        let frequency = self.half_angle[m] / PI * self.sample_rate;
        let c = Coefficients::seed(frequency.min(highest) as f32, frames, 1.0, self.sample_rate as f32);
        (self.modes.zeta.0[m], self.modes.omega2.0[m]) = (c.zeta as f32, c.omega2 as f32);
        (self.pitch.unit_push.0[m], self.pitch.unit_pull.0[m]) = (c.v0 as f32, 1.0);
        self.pitch.rest_level.0[m] = 1.0;
    }

    /// The squared amplitude of mode `m`, which is set to rest if it has all but stopped.
    pub(super) fn settle_classic(&mut self, m: usize) -> f64 {
        let energy = self.energy_classic(m);
        if energy < REST_ENERGY {
            let state = &mut self.states[self.current];
            (state.x.0[m], state.v.0[m]) = (0.0, 0.0);
        }
        energy
    }

    /// The squared amplitude of mode `m`.
    pub(super) fn energy_classic(&self, m: usize) -> f64 {
        let sweep = f64::from(self.modes.sweep.0[m]);
        let state = &self.states[self.current];
        let (x, v) = (f64::from(state.x.0[m]), f64::from(state.v.0[m]) * sweep);
        let (zeta, omega2) = (f64::from(self.modes.zeta.0[m]), f64::from(self.modes.omega2.0[m]) * sweep * sweep);
        let keep = 1.0 - zeta;
        let half_trace = 0.5 * (1.0 + keep - omega2);
        let discriminant = keep - half_trace * half_trace;
        let form = omega2 * x * x + (zeta - omega2) * x * v + keep * v * v;
        if discriminant > 1e-12 && keep > 0.0 {
            form * keep / discriminant
        } else {
            // Over-damped: no ringing, but still something that moves.
            x * x + v * v / omega2.max(1e-12)
        }
    }
}

/// Largest `ω` (times sweep) of the step: it explodes where `ω² = 4 − 2ζ`.
pub(super) fn limit(zeta: f64) -> f64 {
    MARGIN * libm::sqrt(4.0 - 2.0 * zeta)
}
