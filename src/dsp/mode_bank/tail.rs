//! How long a bank rings: the sum of decaying exponentials, solved for the time.

use super::{Law, MAX_MODES, ModeBank};
use libm::{ceil, exp, fabs, log, sqrt};

/// Newton's method starts at most this many times over; it needs about five.
const MOST_STEPS: usize = 50;

impl ModeBank {
    /// Frames until the squared amplitudes of the modes, as heard, add up to less than `total`, if nothing moves or
    /// damps them anew. Real-time safe; takes an exponential a mode for each of about five steps.
    ///
    /// The logarithm of a sum of exponentials is convex, so Newton's method from now never oversteps.
    pub fn frames_until(&self, total: f64) -> u64 {
        let mut energy = [0.0; MAX_MODES];
        let mut rate = [0.0; MAX_MODES];
        for m in 0..self.live {
            (energy[m], rate[m]) = (self.mode_energy(m), self.energy_rate(m));
        }
        let passed = self.handed_out.unwrap_or(0) as f64;
        let target = log(total);
        let mut time = 0.0;
        for _ in 0..MOST_STEPS {
            let (mut sum, mut slope) = (0.0, 0.0);
            for m in 0..self.live {
                let left = energy[m] * exp(rate[m] * time);
                sum += left;
                slope += left * rate[m];
            }
            if sum <= total || slope >= 0.0 {
                break;
            }
            let step = (target - log(sum)) * sum / slope;
            time += step;
            if step < 1e-3 {
                break;
            }
        }
        ceil((time - passed).max(0.0)) as u64
    }

    /// At most how many frames that takes once `more` energy, wherever it goes, has been added.
    pub fn frames_until_at_most(&self, total: f64, more: f64) -> u64 {
        let slowest = (0..self.len).map(|m| self.energy_rate(m)).fold(f64::NEG_INFINITY, f64::max);
        let energy = more + (0..self.live).map(|m| self.mode_energy(m)).sum::<f64>();
        if energy <= total || self.len == 0 { 0 } else { ceil(log(total / energy) / slowest) as u64 }
    }

    fn mode_energy(&self, m: usize) -> f64 {
        match self.law {
            Law::Exact => {
                // One that a sweep holds above the spectrum is silent but not at rest: it may come down.
                let level = f64::from(self.modes.level.0[m].max(self.modes.least.0[m]));
                f64::from(self.energy(m)) * level * level
            }
            Law::Classic => self.energy_classic(m),
        }
    }

    /// The logarithm of what a frame leaves of a mode's energy: the square of the larger root of the step.
    fn energy_rate(&self, m: usize) -> f64 {
        let sweep = f64::from(self.modes.sweep.0[m]);
        let keep = 1.0 - f64::from(self.modes.zeta.0[m]);
        let half_trace = 0.5 * (1.0 + keep - f64::from(self.modes.omega2.0[m]) * sweep * sweep);
        let discriminant = half_trace * half_trace - keep;
        // A mode without a memory has no logarithm: what is left after a frame is not heard.
        let keep = keep.max(1e-30);
        if discriminant > 0.0 { 2.0 * log(fabs(half_trace) + sqrt(discriminant)) } else { log(keep) }
    }
}
