//! Random values as functions of a seed, the number of a job, and the name of the option or parameter.

use crate::dsp::random;
use libm::{cos, exp, floor, log, sqrt};
use serde_json::Value;
use std::f64::consts::TAU;

/// A random distribution. Bounds are in the unit of the option or parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Draw {
    /// Uniform between two bounds.
    Uniform(f64, f64),
    /// Uniform in the logarithm, between two bounds above 0.
    LogUniform(f64, f64),
    /// A whole number, uniform between two bounds, both included.
    Integer(f64, f64),
    /// Normal with this mean and standard deviation, clamped to the range of the option or parameter, `[least, most]`.
    Normal(f64, f64, [f64; 2]),
    /// One of these values, all equally likely.
    Choice(Vec<Value>),
}

/// The random numbers of one job. Frozen: the sounds of a batch depend on them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chance {
    job: u64,
}

/// The name of the stream for a job's own seed; the other streams are those of drawn values.
const SEED: &str = "seed";

impl Chance {
    /// The numbers of a job of a batch with this seed.
    pub(super) fn new(seed: u64, number: u64) -> Self {
        Self { job: random::key(seed, number) }
    }

    /// The seed with which the job is rendered, unless the job sets one: 53 bits, which every JSON reader keeps
    /// exactly.
    pub(super) fn seed(self) -> u64 {
        random::key(self.job, hash(SEED)) >> 11
    }

    /// The `n`-th number for a name, uniform in [0, 1). It does not depend on the other drawn values.
    fn unit(self, name: &str, n: u64) -> f64 {
        random::unit(random::key(self.job, hash(name)), n)
    }
}

/// FNV-1a (Fowler, Noll and Vo 1991).
fn hash(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

impl Draw {
    /// Draws a value for the option or parameter of this name. Numbers have seven digits, so that a drawn job can be
    /// written down and rendered again.
    pub(super) fn draw(&self, name: &str, chance: Chance) -> Value {
        let unit = |n| chance.unit(name, n);
        match self {
            Self::Uniform(low, high) => number(rounded(low + (high - low) * unit(0)).clamp(*low, *high)),
            Self::LogUniform(low, high) => {
                let (from, to) = (log(*low), log(*high));
                number(rounded(exp(from + (to - from) * unit(0))).clamp(*low, *high))
            }
            Self::Integer(low, high) => number(floor(low + (high - low + 1.0) * unit(0)).clamp(*low, *high)),
            Self::Normal(mean, deviation, [least, most]) => {
                // Box and Muller 1958. The logarithm is of a number in (0, 1].
                let normal = sqrt(-2.0 * log(1.0 - unit(0))) * cos(TAU * unit(1));
                number(rounded(mean + deviation * normal).clamp(*least, *most))
            }
            Self::Choice(values) => {
                let index = floor(values.len() as f64 * unit(0)) as usize;
                values.get(index).or(values.last()).cloned().unwrap_or(Value::Null)
            }
        }
    }
}

/// Rounds a number to seven digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// A number as JSON; whole ones have no decimal point.
fn number(value: f64) -> Value {
    if value == floor(value) && value.abs() < 9e15 { Value::from(value as i64) } else { Value::from(value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: u64 = 40_000;

    fn drawn(draw: &Draw) -> Vec<f64> {
        (0..COUNT).map(|number| draw.draw("decay", Chance::new(7, number)).as_f64().unwrap()).collect()
    }

    /// The largest distance between the distribution of the values and the expected one (Kolmogorov and Smirnov). By
    /// chance, it exceeds 1.63/√n for one of a hundred seeds.
    fn distance(mut values: Vec<f64>, expected: impl Fn(f64) -> f64) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let at = |(i, value): (usize, &f64)| {
            (expected(*value) - i as f64 / n).abs().max((expected(*value) - (i + 1) as f64 / n).abs())
        };
        values.iter().enumerate().map(at).fold(0.0, f64::max)
    }

    #[test]
    fn values_have_their_distributions() {
        let most = 1.63 / sqrt(COUNT as f64);
        let uniform = distance(drawn(&Draw::Uniform(0.1, 2.0)), |x| (x - 0.1) / 1.9);
        let logarithmic = distance(drawn(&Draw::LogUniform(20.0, 2000.0)), |x| log(x / 20.0) / log(100.0));
        let normal = distance(drawn(&Draw::Normal(1.0, 0.5, [-9.0, 9.0])), |x| {
            0.5 * libm::erfc((1.0 - x) / (0.5 * std::f64::consts::SQRT_2))
        });
        assert!(
            [uniform, logarithmic, normal].iter().all(|distance| *distance < most),
            "{uniform} {logarithmic} {normal}"
        );
        let clamped = drawn(&Draw::Normal(0.0, 1.0, [-0.5, 0.25]));
        assert!(
            clamped.iter().all(|x| (-0.5..=0.25).contains(x)) && clamped.contains(&-0.5) && clamped.contains(&0.25)
        );
    }

    #[test]
    fn whole_numbers_and_choices_are_equally_frequent() {
        let choices = Draw::Choice((3..=7).map(Value::from).collect());
        for draw in [Draw::Integer(3.0, 7.0), choices] {
            let mut counts = [0; 5];
            drawn(&draw).iter().for_each(|value| counts[*value as usize - 3] += 1);
            let expected = COUNT as f64 / 5.0;
            let deviation = |count: &i32| f64::from(*count) - expected;
            let chi_square: f64 = counts.iter().map(|count| deviation(count) * deviation(count) / expected).sum();
            // By chance, one of a thousand seeds exceeds this.
            assert!(chi_square < 18.47, "{counts:?}");
        }
    }

    #[test]
    fn numbers_are_pinned_and_do_not_depend_on_each_other() {
        let draw = Draw::Uniform(0.0, 1.0);
        let first = |name: &str, seed, number| draw.draw(name, Chance::new(seed, number)).to_string();
        // Computed by an independent program.
        assert_eq!(first("decay", 0, 0), "0.01486228");
        let all = [first("decay", 0, 0), first("tune", 0, 0), first("decay", 1, 0), first("decay", 0, 1)];
        assert!((1..4).all(|n| !all[..n].contains(&all[n])), "{all:?}");
        assert_eq!(Chance::new(0, 0).seed(), 1_634_824_822_511_806);
    }
}
