//! Upper bound of the amplitude that a burst of noise gives, from the parameters alone.

use libm::{exp, floor, log, pow, sqrt};
use sprung::params::Param;

/// Standard deviations in the bound of a burst of noise, which is a random sum. By Hoeffding's inequality, the sum exceeds this
/// bound in one of 10¹⁷ cases, whatever the pitch does, since the pitch cannot follow the noise.
const DEVIATIONS: f64 = 9.0;

/// A burst of force 1: its times in frames, and its form.
pub(crate) struct Noise {
    attack: f64,
    fall: f64,
    is_exponential: bool,
    hits: f64,
    spacing: f64,
    /// High-passed noise: the noise minus its low-passed part. The sum of its magnitudes is up to twice that of the noise, its
    /// power never more.
    is_bright: bool,
}

impl Noise {
    pub(crate) fn new(value: impl Fn(Param) -> f64, sample_rate: f64) -> Self {
        let frames = |param| floor(value(param) * sample_rate + 0.5);
        Self {
            attack: frames(Param::NoiseAttack),
            fall: frames(Param::NoiseTime).max(1.0),
            is_exponential: value(Param::NoiseDecay) != 0.0,
            hits: value(Param::NoiseHits),
            spacing: frames(Param::NoiseSpacing),
            is_bright: value(Param::NoiseColour) > 0.0,
        }
    }

    /// Number of frames of the whole burst.
    pub(crate) fn frames(&self) -> f64 {
        self.attack + self.fall + (self.hits - 1.0) * self.spacing
    }

    /// The squared envelope of a hit, integrated over some frames. The burst is scaled by it.
    fn integral(&self, frames: f64) -> f64 {
        if frames < self.attack {
            return pow(frames, 3.0) / (3.0 * self.attack * self.attack);
        }
        let falling = (frames - self.attack).min(self.fall);
        let rate = log(1000.0) / self.fall;
        self.attack / 3.0
            + if self.is_exponential {
                (1.0 - exp(-2.0 * rate * falling)) / (2.0 * rate)
            } else {
                self.fall / 5.0 * (1.0 - pow(1.0 - falling / self.fall, 5.0))
            }
    }

    /// Bound of the burst's amplitude. If amplitudes are not exact, the bound is the sum of all frames, as if all pushed in the
    /// same direction. Hits that cut each other off count in full.
    pub(crate) fn most(&self, is_exact: bool) -> f64 {
        let energy = (self.integral(f64::INFINITY) + (self.hits - 1.0) * self.integral(self.spacing)) / 3.0;
        let n = self.fall;
        let (sum, squares) = if self.is_exponential {
            let keep = exp(-log(1000.0) / n);
            (1.0 / (1.0 - keep), 1.0 / (1.0 - keep * keep))
        } else {
            // Σ (j/n)² and Σ (j/n)⁴ for j = 1 … n.
            let squares = (n + 1.0) * (2.0 * n + 1.0) * (3.0 * n * n + 3.0 * n - 1.0) / (30.0 * n * n * n);
            ((n + 1.0) * (2.0 * n + 1.0) / (6.0 * n), squares)
        };
        let (sum, squares) = (self.hits * (self.attack / 2.0 + sum), self.hits * (self.attack / 3.0 + squares));
        let sum = if self.is_bright { 2.0 * sum } else { sum };
        let likely = DEVIATIONS * sqrt(squares / 3.0);
        if is_exact { sum.min(likely) / sqrt(energy) } else { sum / sqrt(energy) }
    }
}
