//! What moves the pitch and the level of a draft: sweep, vibrato, swell and oscillators.

use crate::dsp::pitch::SweepEnvelope;
use crate::engine::Lfo;
use crate::params::Shape;
use crate::sound::bodies::LN_1000;
use libm::{exp, pow, sin};
use std::f64::consts::PI;

/// In a T60, the energy falls to e to the power of minus this.
pub(super) const ENERGY_PER_T60: f64 = 2.0 * LN_1000;

/// The movement of the pitch after the strike: a sweep and a vibrato.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sweep {
    pub(super) semitones: f64,
    pub(super) seconds: f64,
    /// −1 to 1.
    pub(super) curve: f64,
    pub(super) vibrato: Vibrato,
}

/// A vibrato, which begins upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vibrato {
    /// Depth each way.
    pub(super) semitones: f64,
    /// Hz.
    pub(super) rate: f64,
    /// Seconds in which it fades in.
    pub(super) delay: f64,
}

impl Sweep {
    /// The engine's largest sweep in semitones.
    pub(super) const LARGEST: f64 = 60.0;
    pub(super) const NONE: Self =
        Self { semitones: 0.0, seconds: 0.1, curve: 0.5, vibrato: Vibrato { semitones: 0.0, rate: 5.0, delay: 0.0 } };

    pub(super) fn envelope(&self) -> SweepEnvelope {
        SweepEnvelope::new(self.semitones, self.seconds, self.curve)
    }

    /// The sweep with changed numbers: the semitones by a share of them, the time by a power of e, the curve by a sum.
    pub(super) fn moved(&self, [semitones, seconds, curve]: [f64; 3]) -> Self {
        Self {
            semitones: (self.semitones * (1.0 + semitones)).clamp(-Self::LARGEST, Self::LARGEST),
            seconds: (self.seconds * exp(seconds)).clamp(0.002, 5.0),
            curve: (self.curve + curve).clamp(-1.0, 1.0),
            ..*self
        }
    }

    /// The sweep with a changed vibrato: its depth by a share of it, its rate by a tenth of a share.
    pub(super) fn with_vibrato_moved(&self, [depth, rate]: [f64; 2]) -> Self {
        let Vibrato { semitones, rate: before, delay } = self.vibrato;
        // What the engine cannot play would be taken out of the sound and not come back.
        let semitones = (semitones * (1.0 + depth)).clamp(0.0, Vibrato::DEEPEST);
        let rate = (before * (1.0 + 0.1 * rate)).clamp(0.0, Vibrato::FASTEST);
        Self { vibrato: Vibrato { semitones, rate, delay }, ..*self }
    }

    /// Whether the pitch is constant.
    pub(super) fn is_none(&self) -> bool {
        self.semitones == 0.0 && self.vibrato.semitones == 0.0
    }
}

impl Vibrato {
    /// The engine's fastest vibrato in Hz, and its deepest one in semitones.
    pub(super) const FASTEST: f64 = 20.0;
    pub(super) const DEEPEST: f64 = 12.0;

    /// Semitones, `time` seconds after the strike.
    pub(super) fn at(&self, time: f64) -> f64 {
        let fade = if self.delay > 0.0 { (time / self.delay).min(1.0) } else { 1.0 };
        if self.semitones == 0.0 { 0.0 } else { self.semitones * fade * sin(2.0 * PI * self.rate * time) }
    }
}

/// The rise of a sound that is not struck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swell {
    pub(super) seconds: f64,
    /// Rise in dB.
    pub(super) depth: f64,
    /// −1 to 1: above 0 the rise is fast at first.
    pub(super) curve: f64,
    /// Seconds in which it falls again, if it does not stay at its level.
    pub(super) fall: Option<f64>,
}

/// A low-frequency oscillator that moves pitch and level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Oscillator {
    pub(super) shape: Shape,
    /// Hz.
    pub(super) rate: f64,
    /// Phase in which it starts, 0–1 of a cycle.
    pub(super) phase: f64,
    /// Depth each way; negative if the pitch moves against the oscillator.
    pub(super) semitones: f64,
    /// The same of the level.
    pub(super) db: f64,
}

impl Oscillator {
    /// Its value, −1 to 1, `time` seconds after the strike.
    pub(super) fn at(&self, time: f64) -> f64 {
        Lfo::new(self.phase, 0).after(self.rate * time).value(self.shape).into()
    }
}

/// Factor by which a sweep raises a mode at the mean time of the mode's energy, relative to its final pitch. `t60` in
/// seconds.
pub(super) fn speed(sweep: &Sweep, t60: f64) -> f64 {
    // The mean time of an exponential decay is the time in which it falls to 1/e.
    speed_at(sweep, t60 / ENERGY_PER_T60)
}

/// Factor by which a sweep raises all modes `time` seconds after the strike, relative to their final pitch.
pub(super) fn speed_at(sweep: &Sweep, time: f64) -> f64 {
    if sweep.semitones == 0.0 { 1.0 } else { pow(2.0, sweep.envelope().at(time) / 12.0) }
}
