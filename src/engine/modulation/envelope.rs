//! An envelope: delay, attack, hold, decay, sustain, release.

use crate::params::{PARAMS, Param};

/// What a sound says of an envelope, read when a note is struck. Times are in seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    delay: f64,
    attack: f64,
    hold: f64,
    decay: f64,
    sustain: f32,
    release: f64,
    bend: f32,
}

impl Times {
    pub(crate) const NONE: Self =
        Self { delay: 0.0, attack: 0.0, hold: 0.0, decay: 0.0, sustain: 0.0, release: 0.0, bend: 1.0 };

    /// Those of envelope `index`, 0 or 1.
    pub(crate) fn new(index: usize, value: impl Fn(Param) -> f64) -> Self {
        let rows = Param::Envelope2Delay as usize - Param::Envelope1Delay as usize;
        let value = |first: Param| value(PARAMS[first as usize + index * rows].param);
        Self {
            delay: value(Param::Envelope1Delay),
            attack: value(Param::Envelope1Attack),
            hold: value(Param::Envelope1Hold),
            decay: value(Param::Envelope1Decay),
            sustain: (value(Param::Envelope1Sustain) * 0.01) as f32,
            release: value(Param::Envelope1Release),
            bend: libm::exp2(-0.04 * value(Param::Envelope1Curve)) as f32,
        }
    }

    fn seconds(&self, stage: Stage) -> f64 {
        match stage {
            Stage::Delay => self.delay,
            Stage::Attack => self.attack,
            Stage::Hold => self.hold,
            Stage::Decay => self.decay,
            Stage::Release => self.release,
            Stage::Sustain | Stage::Over => f64::INFINITY,
        }
    }
}

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
    times: Times,
    stage: Stage,
    /// Seconds of the stage that have passed.
    passed: f64,
    /// Level at which the attack or the release has started.
    from: f32,
}

impl Envelope {
    /// At rest.
    pub(crate) const REST: Self = Self { times: Times::NONE, stage: Stage::Over, passed: 0.0, from: 0.0 };

    /// Starts, from the level that it has.
    pub(crate) fn strike(&mut self, times: Times) {
        *self = Self { from: self.level(), times, stage: Stage::Delay, passed: 0.0 };
        self.advance(0.0);
    }

    /// Sets out for 0, unless it has already.
    pub(crate) fn release(&mut self) {
        if !matches!(self.stage, Stage::Release | Stage::Over) {
            *self = Self { from: self.level(), stage: Stage::Release, passed: 0.0, ..*self };
        }
    }

    /// Goes on by some seconds.
    pub(crate) fn advance(&mut self, seconds: f64) {
        self.passed += seconds;
        loop {
            let length = self.times.seconds(self.stage);
            if self.passed < length || length == f64::INFINITY {
                return;
            }
            self.passed -= length;
            self.stage = match self.stage {
                Stage::Delay => Stage::Attack,
                Stage::Attack => Stage::Hold,
                Stage::Hold => Stage::Decay,
                Stage::Decay | Stage::Sustain => Stage::Sustain,
                Stage::Release | Stage::Over => Stage::Over,
            };
        }
    }

    /// Its level, 0–1.
    pub(crate) fn level(&self) -> f32 {
        let towards = |target: f32, from: f32| {
            let share = (self.passed / self.times.seconds(self.stage)) as f32;
            from + (target - from) * bent(share, self.times.bend)
        };
        match self.stage {
            Stage::Delay => self.from,
            Stage::Attack => towards(1.0, self.from),
            Stage::Hold => 1.0,
            Stage::Decay => towards(self.times.sustain, 1.0),
            Stage::Sustain => self.times.sustain,
            Stage::Release => towards(0.0, self.from),
            Stage::Over => 0.0,
        }
    }
}

/// A share from 0 to 1, bent: straight for a bend of 1, fast at first below it, slow at first above. A hyperbola, which
/// unlike an exponential takes one division (Schlick 1994, "Fast alternatives to Perlin's bias and gain functions").
fn bent(share: f32, bend: f32) -> f32 {
    share / (share + bend * (1.0 - share))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: Times =
        Times { delay: 0.1, attack: 0.2, hold: 0.3, decay: 0.4, sustain: 0.5, release: 0.8, bend: 1.0 };

    fn level_after(envelope: &Envelope, seconds: f64) -> f32 {
        let mut envelope = *envelope;
        envelope.advance(seconds);
        (envelope.level() * 1e4).round() / 1e4
    }

    #[test]
    fn stages_follow_each_other() {
        let mut envelope = Envelope::REST;
        envelope.strike(TIMES);
        for (seconds, level) in [(0.0, 0.0), (0.1, 0.0), (0.2, 0.5), (0.3, 1.0), (0.6, 1.0), (0.8, 0.75), (9.0, 0.5)] {
            assert_eq!(level_after(&envelope, seconds), level, "{seconds}");
        }
        envelope.advance(0.8);
        envelope.release();
        for (seconds, level) in [(0.0, 0.75), (0.4, 0.375), (0.8, 0.0), (99.0, 0.0)] {
            assert_eq!(level_after(&envelope, seconds), level, "released {seconds}");
        }
        envelope.advance(0.4);
        envelope.strike(Times { delay: 0.0, ..TIMES });
        assert_eq!(level_after(&envelope, 0.0), 0.375, "struck again, it starts where it is");
    }

    #[test]
    fn stages_without_length_are_passed_at_once() {
        let mut envelope = Envelope::REST;
        envelope.strike(Times { sustain: 0.25, ..Times::NONE });
        assert_eq!(envelope.level(), 0.25);
        envelope.release();
        envelope.advance(0.0);
        assert_eq!(envelope.level(), 0.0);
    }

    #[test]
    fn curves_are_fast_or_slow_at_first() {
        for (bend, least, most) in [(0.25, 0.79, 0.81), (1.0, 0.5, 0.5), (4.0, 0.19, 0.21)] {
            assert!((least..=most).contains(&bent(0.5, bend)), "{bend}");
            assert_eq!([bent(0.0, bend), bent(1.0, bend)], [0.0, 1.0]);
        }
    }
}
