//! An envelope: delay, attack, hold, decay, sustain, release.

use crate::params::{PARAMS, Param};

/// The parameters of an envelope, as modulated at a strike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    /// Length of each stage in seconds; infinite for stages that do not end by themselves.
    lengths: [f64; STAGES],
    /// Reciprocals of the lengths; 0 for stages of length 0, for which they are not used.
    rates: [f64; STAGES],
    sustain: f32,
    bend: f32,
}

impl Times {
    /// An envelope whose stages have length 0.
    pub(crate) const NONE: Self = Self {
        lengths: [0.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.0, f64::INFINITY],
        rates: [0.0; STAGES],
        sustain: 0.0,
        bend: 1.0,
    };

    /// The parameters of envelope `index`, 0 or 1.
    pub(crate) fn new(index: usize, value: impl Fn(Param) -> f64) -> Self {
        let rows = Param::Envelope2Delay as usize - Param::Envelope1Delay as usize;
        let value = |first: Param| value(PARAMS[first as usize + index * rows].param);
        Self::of(
            [Param::Envelope1Delay, Param::Envelope1Attack, Param::Envelope1Hold, Param::Envelope1Decay].map(value),
            (value(Param::Envelope1Sustain) * 0.01) as f32,
            value(Param::Envelope1Release),
            libm::exp2(-0.04 * value(Param::Envelope1Curve)) as f32,
        )
    }

    /// An envelope with these lengths of the four stages before the sustain, sustain level, release time and curve.
    fn of([delay, attack, hold, decay]: [f64; 4], sustain: f32, release: f64, bend: f32) -> Self {
        let lengths = [delay, attack, hold, decay, f64::INFINITY, release, f64::INFINITY];
        let rates = lengths.map(|length| if length > 0.0 { 1.0 / length } else { 0.0 });
        Self { lengths, rates, sustain, bend }
    }
}

const STAGES: usize = 7;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Delay,
    Attack,
    Hold,
    Decay,
    Sustain,
    Release,
    Over,
}

/// The present state of an envelope. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Envelope {
    stage: Stage,
    /// Level when the attack or the release began.
    from: f32,
    /// Seconds since the stage began.
    passed: f64,
}

impl Envelope {
    /// At rest.
    pub(crate) const REST: Self = Self { stage: Stage::Over, passed: 0.0, from: 0.0 };

    /// Starts the envelope with new times, at its present level, which follows from the times `before`.
    pub(crate) fn strike(&mut self, times: &Times, before: &Times) {
        *self = Self { from: self.level(before), stage: Stage::Delay, passed: 0.0 }.after(0.0, times);
    }

    /// Starts the release stage, unless the envelope is in it or has ended.
    pub(crate) fn release(&mut self, times: &Times) {
        if !matches!(self.stage, Stage::Release | Stage::Over) {
            *self = Self { from: self.level(times), stage: Stage::Release, passed: 0.0 };
        }
    }

    /// The envelope some seconds later.
    #[must_use]
    pub(crate) fn after(&self, seconds: f64, times: &Times) -> Self {
        let (mut stage, mut passed) = (self.stage, self.passed + seconds);
        loop {
            let length = times.lengths[stage as usize];
            if passed < length || length == f64::INFINITY {
                return Self { stage, passed, ..*self };
            }
            passed -= length;
            stage = match stage {
                Stage::Delay => Stage::Attack,
                Stage::Attack => Stage::Hold,
                Stage::Hold => Stage::Decay,
                Stage::Decay | Stage::Sustain => Stage::Sustain,
                Stage::Release | Stage::Over => Stage::Over,
            };
        }
    }

    /// The number of the stage and the share of it that has passed. A stage that does not end by itself is at its beginning.
    pub(crate) fn progress(&self, times: &Times) -> f32 {
        f32::from(self.stage as u8) + ((self.passed * times.rates[self.stage as usize]) as f32).min(0.999)
    }

    /// The present level, 0–1.
    pub(crate) fn level(&self, times: &Times) -> f32 {
        let towards = |target: f32, from: f32| {
            let share = (self.passed * times.rates[self.stage as usize]) as f32;
            from + (target - from) * bent(share, times.bend)
        };
        match self.stage {
            Stage::Delay => self.from,
            Stage::Attack => towards(1.0, self.from),
            Stage::Hold => 1.0,
            Stage::Decay => towards(times.sustain, 1.0),
            Stage::Sustain => times.sustain,
            Stage::Release => towards(0.0, self.from),
            Stage::Over => 0.0,
        }
    }
}

/// Curve from 0 to 1: linear if `bend` is 1, fast at first if it is smaller, slow at first if it is greater. A hyperbola
/// is used, since it needs only one division, unlike an exponential (Schlick 1994, "Fast alternatives to Perlin's bias
/// and gain functions").
fn bent(share: f32, bend: f32) -> f32 {
    share / (share + bend * (1.0 - share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(release: f64) -> Times {
        Times::of([0.1, 0.2, 0.3, 0.4], 0.5, release, 1.0)
    }

    fn level_after(envelope: &Envelope, seconds: f64) -> f32 {
        (envelope.after(seconds, &times(0.8)).level(&times(0.8)) * 1e4).round() / 1e4
    }

    #[test]
    fn stages_follow_each_other() {
        let (mut envelope, times) = (Envelope::REST, times(0.8));
        envelope.strike(&times, &Times::NONE);
        for (seconds, level) in [(0.0, 0.0), (0.1, 0.0), (0.2, 0.5), (0.3, 1.0), (0.6, 1.0), (0.8, 0.75), (9.0, 0.5)] {
            assert_eq!(level_after(&envelope, seconds), level, "{seconds}");
        }
        envelope = envelope.after(0.8, &times);
        envelope.release(&times);
        for (seconds, level) in [(0.0, 0.75), (0.4, 0.375), (0.8, 0.0), (99.0, 0.0)] {
            assert_eq!(level_after(&envelope, seconds), level, "released {seconds}");
        }
        envelope = envelope.after(0.4, &times);
        envelope.strike(&Times::of([0.0, 0.2, 0.3, 0.4], 0.5, 0.8, 1.0), &times);
        assert_eq!(level_after(&envelope, 0.0), 0.375, "struck again, it starts where it is");
    }

    #[test]
    fn stages_without_length_are_passed_at_once() {
        let (mut envelope, times) = (Envelope::REST, Times::of([0.0; 4], 0.25, 0.0, 1.0));
        envelope.strike(&times, &Times::NONE);
        assert_eq!(envelope.level(&times), 0.25);
        envelope.release(&times);
        assert_eq!(envelope.after(0.0, &times).level(&times), 0.0);
    }

    #[test]
    fn curves_are_fast_or_slow_at_first() {
        for (bend, least, most) in [(0.25, 0.79, 0.81), (1.0, 0.5, 0.5), (4.0, 0.19, 0.21)] {
            assert!((least..=most).contains(&bent(0.5, bend)), "{bend}");
            assert_eq!([bent(0.0, bend), bent(1.0, bend)], [0.0, 1.0]);
        }
    }
}
