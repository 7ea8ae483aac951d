//! Random curves of whole rows of modes, smooth from one random number to the next.

use super::random::{bits, key as stream};
use super::series::ROUND;
use super::simd::vector::Vector;
use super::simd::{Instructions, Kernel};
use libm::floor;

/// Where modes stand between one random number and the next: as far apart as can be (the golden ratio).
const STAGGER: f64 = 0.618_033_988_749_894_9;

/// Where two curves of each mode stand, −1 to 1, `phase` random numbers after their start. The first number of a row is for the mode
/// `first`, rows are equally long. Each mode's numbers come at times of its own. Plain double precision in a frozen order. Real-time
/// safe.
pub(crate) fn wander(key: u64, phase: f64, first: usize, curves: [&mut [f64]; 2]) {
    let whole = floor(phase);
    let draws = [0, 1, 2].map(|n| stream(key, whole as u64 + n));
    Instructions::current().run(Wander { draws, phase: phase - whole, first, curves });
}

struct Wander<'a> {
    /// Keys of the last random numbers before a time, and of the two after them.
    draws: [u64; 3],
    /// How far the time is from the first of these to the second.
    phase: f64,
    first: usize,
    curves: [&'a mut [f64]; 2],
}

impl Kernel for Wander<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { draws, phase, first, curves: [ones, others] } = self;
        for (m, (one, other)) in ones.iter_mut().zip(others).enumerate() {
            let number = (first + m) as u64;
            let stagger = STAGGER * f64::from(number as u32);
            let place = phase + stagger - ((stagger - 0.5 + ROUND) - ROUND);
            let is_late = place >= 1.0;
            let share = if is_late { place - 1.0 } else { place };
            let share = share * share * (3.0 - 2.0 * share);
            let from = bits(if is_late { draws[1] } else { draws[0] }, number);
            let to = bits(if is_late { draws[2] } else { draws[1] }, number);
            *one = between(from, to, share);
            *other = between(from >> 32, to >> 32, share);
        }
    }
}

/// A number between those of the lower halves of some bits, each from −1 to 1.
#[inline(always)]
fn between(from: u64, to: u64, share: f64) -> f64 {
    let (from, to) = (f64::from(from as u32 as i32), f64::from(to as u32 as i32));
    let (from, to) = (from * (1.0 / 2_147_483_648.0), to * (1.0 / 2_147_483_648.0));
    from + (to - from) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curves keep within their bounds, are smooth, differ from mode to mode, and have the rate that they are said to have.
    #[test]
    fn curves_wander_at_their_rate() {
        const MODES: usize = 64;
        let (rate, tick) = (4.0, 1.0 / 1500.0);
        let curves: Vec<[f64; MODES]> = (0..30_000)
            .map(|n| {
                let [mut row, mut other] = [[0.0; MODES]; 2];
                wander(7, rate * tick * f64::from(n), MODES, [&mut row, &mut other]);
                row
            })
            .collect();
        let curve = |m: usize| curves.iter().map(move |row| row[m]);
        for m in [0, 5, 63] {
            let (least, most) = curve(m).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
            assert!((-1.0..-0.8).contains(&least) && (0.8..1.0).contains(&most), "{least} to {most}");
            let values: Vec<f64> = curve(m).collect();
            // The steepest slope between numbers from −1 to 1 is 1.5 · 2.
            let steepest = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
            assert!(steepest < 3.01 * rate * tick, "{steepest}");
            let crossings = values.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
            // Half of the numbers have another sign than the one before: 2 a second, in 20 s.
            assert!((24..56).contains(&crossings), "{crossings}");
        }
        let product = |a: usize, b: usize| curve(a).zip(curve(b)).map(|(x, y)| x * y).sum::<f64>() / 30_000.0;
        assert!(product(3, 4).abs() < 0.35 * product(3, 3), "{} of {}", product(3, 4), product(3, 3));
    }
}
