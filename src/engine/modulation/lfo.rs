//! A low-frequency oscillator: its phase, and its value there.

use crate::dsp::random::uniform;
use crate::params::Shape;

/// The state of a low-frequency oscillator. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lfo {
    /// Phase, 0–1 of a cycle.
    phase: f64,
    /// Number of complete cycles so far.
    cycle: u64,
    /// Stream of its random numbers.
    stream: u64,
}

impl Lfo {
    /// Placeholder until the first note starts.
    pub(crate) const REST: Self = Self { phase: 0.0, cycle: 0, stream: 0 };

    /// Starts at a phase in cycles (only the fraction counts).
    pub(crate) fn new(phase: f64, stream: u64) -> Self {
        Self { phase: phase - libm::floor(phase), cycle: 0, stream }
    }

    /// The oscillator after a number of cycles, at least 0.
    #[must_use]
    pub(crate) fn after(&self, cycles: f64) -> Self {
        let phase = self.phase + cycles;
        let whole = phase as i64;
        Self { phase: phase - whole as f64, cycle: self.cycle.wrapping_add(whole as u64), ..*self }
    }

    /// Its phase, 0–1 of a cycle.
    pub(crate) fn phase(&self) -> f32 {
        self.phase as f32
    }

    /// Its value, −1 to 1.
    pub(crate) fn value(&self, shape: Shape) -> f32 {
        let phase = self.phase as f32;
        match shape {
            Shape::Sine => sine_of_cycles(phase),
            Shape::Triangle => {
                let quarter = if phase < 0.75 { phase } else { phase - 1.0 };
                1.0 - (4.0 * quarter - 1.0).abs()
            }
            Shape::Ramp => 2.0 * phase - 1.0,
            Shape::Square => 1.0_f32.copysign(0.5 - phase),
            Shape::Steps => uniform(self.stream, self.cycle),
            Shape::Drift => {
                let [from, to] = [0, 1].map(|next| uniform(self.stream, self.cycle.wrapping_add(next)));
                from + (to - from) * (phase * phase * (3.0 - 2.0 * phase))
            }
        }
    }
}

/// `sin 2πx` for 0 ≤ x ≤ 1, with an error of at most 4e−6, in a fifth of the time of an exact sine.
fn sine_of_cycles(x: f32) -> f32 {
    // The angle is folded to the quarter cycle around 0; there the sine's power series up to the ninth power is used.
    let centred = if x > 0.5 { x - 1.0 } else { x };
    let folded = if centred > 0.25 {
        0.5 - centred
    } else if centred < -0.25 {
        -0.5 - centred
    } else {
        centred
    };
    let angle = folded * std::f32::consts::TAU;
    let square = angle * angle;
    let pair = |even: f32, odd: f32| even + odd * square;
    // Terms in pairs, so that the CPU can compute the pairs at the same time.
    let sum = pair(1.0 / 120.0, -1.0 / 5_040.0) + 1.0 / 362_880.0 * (square * square);
    let sum = pair(1.0, -1.0 / 6.0) + sum * (square * square);
    (sum * angle).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::key;

    fn values(shape: Shape, phases: &[f64]) -> Vec<f32> {
        phases.iter().map(|phase| Lfo::new(*phase, 7).value(shape)).collect()
    }

    #[test]
    fn shapes_go_their_ways() {
        let phases = [0.0, 0.25, 0.5, 0.75];
        for (shape, expected) in [
            (Shape::Triangle, [0.0, 1.0, 0.0, -1.0]),
            (Shape::Ramp, [-1.0, -0.5, 0.0, 0.5]),
            (Shape::Square, [1.0, 1.0, 1.0, -1.0]),
        ] {
            assert_eq!(values(shape, &phases), expected, "{shape:?}");
        }
        for n in 0..=1000 {
            let x = n as f32 / 1000.0;
            let expected = libm::sin(std::f64::consts::TAU * f64::from(x)) as f32;
            assert!((sine_of_cycles(x) - expected).abs() < 5e-6, "{x}");
        }
    }

    #[test]
    fn random_shapes_change_with_the_cycle_and_repeat_with_the_seed() {
        let (mut one, mut other) = (Lfo::new(0.0, key(1, 2)), Lfo::new(0.0, key(1, 2)));
        let first = one.value(Shape::Steps);
        one = one.after(0.9);
        assert_eq!(one.value(Shape::Steps), first);
        one = one.after(0.2);
        assert_ne!(one.value(Shape::Steps), first);
        (0..11).for_each(|_| other = other.after(0.1));
        assert_eq!(one.value(Shape::Steps), other.value(Shape::Steps));
        let mut drift = Lfo::new(0.0, 5);
        let mut before = drift.value(Shape::Drift);
        for _ in 0..5000 {
            drift = drift.after(0.001);
            let now = drift.value(Shape::Drift);
            assert!((now - before).abs() < 0.004, "it slides");
            before = now;
        }
    }
}
