//! What parts of a sound do, as curves for displays: by the formulas with which the engine plays.

use super::gain::pan_gains;
use super::space::body;
use crate::dsp::exciter::{Bow, JetLaw, MouthpieceLaw};
use crate::dsp::space::{Decay, Overdrive, Tone, Tremolo};
use crate::params::{Soundbox, Valve};
use crate::sound::blown;
use libm::pow;

/// The force of a strike at a velocity from 0 to 1, whose power it is. Velocity 0 is without force whatever the power.
pub fn force(velocity: f32, power: f64) -> f64 {
    if velocity > 0.0 { pow(f64::from(velocity), power) } else { 0.0 }
}

/// The friction of a bow at a slip, as a share of that without slip: it has fallen half way at a slip of `width`.
pub fn friction(width: f32, slip: f32) -> f32 {
    Bow::friction(width, slip)
}

/// The flow through a valve at rest, at a steady pressure difference of which 1 closes a reed, or of a jet into a tube, by its bend in
/// half widths; `opening` is from 0 to 1.
pub fn flow(valve: Valve, opening: f64, difference: f64) -> f64 {
    let opening = blown::flow(opening);
    match blown::law(valve, 0.0, 1.0, 0.0) {
        MouthpieceLaw::Valve(law) => law.steady_flow(opening, difference),
        MouthpieceLaw::Jet(_) => opening * JetLaw::into_tube(difference),
    }
}

/// The gain of a tremolo with a depth from 0 to 1, after some turns of its motor.
pub fn tremolo(depth: f64, turns: f64) -> f32 {
    Tremolo::gain(depth, turns)
}

/// What a drive in dB makes of a sample.
pub fn drive(decibels: f32, sample: f32) -> f32 {
    Overdrive::steady(decibels, sample)
}

/// The gain in dB of a tone control at a frequency in Hz, for its gains of lows and highs in dB.
pub fn tone([low, high]: [f32; 2], hertz: f64) -> f64 {
    Tone::gain_at(low, high, hertz)
}

/// The gain in dB of a soundbox by frequency in Hz, at a size of 1 and a vowel from 0 to 1; none without a body. Allocates.
pub fn soundbox(soundbox: Soundbox, vowel: f64) -> Option<impl Fn(f64) -> f64> {
    body(soundbox).map(|body| body.response(vowel))
}

/// T60 in seconds of strings or a space at a frequency in Hz, for those of low and of high frequencies.
pub fn decay([low, high]: [f64; 2], hertz: f64) -> f64 {
    Decay { low, high }.t60_at(hertz)
}

/// The gains of both sides for a pan from 0 (left) to 1 (right).
pub fn pan(position: f32) -> [f32; 2] {
    pan_gains(position).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::{log10, sin, sqrt};
    use std::f64::consts::TAU;

    const RATE: f64 = 48_000.0;

    /// The last half of what a processor makes of a second.
    fn last(wave: impl Fn(f64) -> f64, mut process: impl FnMut(&mut [f32], &mut [f32])) -> Vec<f64> {
        let mut left: Vec<f32> = (0..RATE as usize).map(|frame| wave(frame as f64 / RATE) as f32).collect();
        let mut right = left.clone();
        process(&mut left, &mut right);
        left[RATE as usize / 2..].iter().map(|sample| f64::from(*sample)).collect()
    }

    #[test]
    fn curves_are_what_the_processors_do() {
        for (hertz, decibels) in [(60.0, [9.0, -6.0]), (700.0, [9.0, -6.0]), (6000.0, [-3.0, 12.0])] {
            let mut filter = Tone::new(RATE);
            filter.set(decibels[0], decibels[1]);
            let played = last(|time| sin(TAU * hertz * time), |left, right| filter.process(left, right));
            let mean = played.iter().map(|sample| sample * sample).sum::<f64>() / played.len() as f64;
            let gain = 20.0 * log10(sqrt(2.0 * mean));
            assert!((gain - tone(decibels, hertz)).abs() < 0.3, "{hertz} Hz: {gain} {}", tone(decibels, hertz));
        }
        for sample in [0.05, 0.5, 1.0] {
            let mut overdrive = Overdrive::new(RATE);
            overdrive.set(18.0);
            let played = last(|_| sample, |left, right| overdrive.process(left, right));
            assert!((played[1000] - f64::from(drive(18.0, sample as f32))).abs() < 1e-3, "{sample}");
        }
        let mut motor = Tremolo::new(RATE);
        motor.set_rate(2.0);
        motor.set_depth(0.7);
        motor.reset();
        let played = last(|_| 1.0, |left, right| motor.process(left, right));
        for frame in [0, 4000, 9000] {
            let gain = f64::from(tremolo(0.7, 2.0 * (0.5 + frame as f64 / RATE)));
            assert!((played[frame] - gain).abs() < 1e-3, "{frame}");
        }
    }

    #[test]
    fn a_reed_closes_lips_open_and_a_jet_turns_in() {
        let at = |valve, difference| flow(valve, 0.5, difference);
        assert!(at(Valve::Reed, 0.3) > at(Valve::Reed, 0.9) && at(Valve::Reed, 1.0) == 0.0);
        assert!(at(Valve::Lips, 1.0) > 3.0 * at(Valve::Lips, 0.3) && at(Valve::Lips, 0.0) == 0.0);
        assert!(at(Valve::Jet, 3.0) > 1.9 * at(Valve::Jet, 0.3) && at(Valve::Jet, -9.0) < 0.01 * at(Valve::Jet, 0.3));
        assert!(friction(0.2, 0.0) == 1.0 && (friction(0.2, 0.2) - 0.65).abs() < 1e-6);
        assert_eq!((force(0.0, 0.0), force(0.5, 2.0), pan(0.5)), (0.0, 0.25, [1.0; 2]));
    }
}
