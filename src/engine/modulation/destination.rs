//! A parameter that routes modulate: which part of the engine uses it, and how an offset changes its value.

use super::link::Mover;
use crate::dsp::power_of_two;
use crate::params::{Change, Curve, Param};

/// A parameter that routes modulate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Destination {
    pub(crate) param: Param,
    pub(crate) target: Target,
    min: f32,
    max: f32,
    /// Width of the range: in the parameter's unit, or in octaves if its knob is logarithmic.
    span: f32,
    is_logarithmic: bool,
}

/// Which part of the engine uses a destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// Used when a note is struck.
    Strike,
    /// Used by sounding voices at each control tick.
    Control,
    /// Used by the effects behind the voices.
    Behind,
    /// The rate of an oscillator, by index.
    Lfo(u8),
}

impl Destination {
    pub(super) const NONE: Self =
        Self { param: Param::Gain, target: Target::Strike, min: 0.0, max: 0.0, span: 0.0, is_logarithmic: false };

    pub(super) fn new(param: Param) -> Self {
        let info = param.info();
        let is_logarithmic = info.curve == Curve::Logarithmic;
        let (min, max) = (info.min, info.max);
        let octaves = || libm::log2(f64::from(max) / f64::from(min)) as f32;
        let target = match (param, info.change) {
            (Param::Lfo1Rate, _) => Target::Lfo(0),
            (Param::Lfo2Rate, _) => Target::Lfo(1),
            (Param::Lfo3Rate, _) => Target::Lfo(2),
            (_, Change::AtOnce) => Target::Behind,
            (_, Change::Smoothed(_)) if Mover::of(param).is_none() => Target::Control,
            _ => Target::Strike,
        };
        Self { param, target, min, max, span: if is_logarithmic { octaves() } else { max - min }, is_logarithmic }
    }

    /// A value moved by an offset in knob travel, within the parameter's range. Real-time safe.
    pub(crate) fn moved(&self, value: f32, offset: f32) -> f32 {
        let way = offset * self.span;
        let moved = if self.is_logarithmic { value * power_of_two(way) } else { value + way };
        moved.clamp(self.min, self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_move_along_the_knob_and_stay_in_range() {
        let destination = Destination::new;
        assert_eq!(destination(Param::Gain).moved(-24.0, 0.25), -6.0);
        assert_eq!(destination(Param::Gain).moved(-24.0, 9.0), 12.0);
        let decay = destination(Param::Decay);
        let info = Param::Decay.info();
        let expected = info.denormalise(info.normalise(0.5) + 0.1);
        assert!((decay.moved(0.5, 0.1) / expected - 1.0).abs() < 1e-4);
        assert_eq!(decay.moved(0.5, -9.0), info.min);
    }
}
