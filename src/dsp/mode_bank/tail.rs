//! The time until a bank is silent: the sum of decaying exponentials, solved for the time.

use super::ModeBank;
use libm::{ceil, exp, log};

/// Maximum number of Newton steps; about five are typical.
const MOST_STEPS: usize = 50;

/// Upper limit of every result: 40 years at 768 kHz.
const LONGEST_FRAMES: f64 = 1e15;

/// Squared amplitudes of up to `N` modes, and the logarithms of their ratios per frame. Real-time safe.
pub(in crate::dsp) struct Energies<const N: usize> {
    energy: [f64; N],
    rate: [f64; N],
    len: usize,
}

impl<const N: usize> Energies<N> {
    /// No modes.
    pub(in crate::dsp) const NONE: Self = Self { energy: [0.0; N], rate: [0.0; N], len: 0 };

    /// Adds a mode. Does nothing if there is no room.
    pub(in crate::dsp) fn add(&mut self, energy: f64, rate: f64) {
        if self.len < N {
            (self.energy[self.len], self.rate[self.len]) = (energy, rate);
            self.len += 1;
        }
    }

    /// Frames until the sum of the squared amplitudes falls below `total`. Takes one exponential per mode for each of
    /// about five steps.
    ///
    /// The logarithm of a sum of exponentials is convex, so Newton's method starting at time 0 never exceeds the solution.
    pub(in crate::dsp) fn frames_until(&self, total: f64) -> u64 {
        let target = log(total);
        let mut time = 0.0;
        for _ in 0..MOST_STEPS {
            let (mut sum, mut slope) = (0.0, 0.0);
            for (energy, rate) in self.energy.iter().zip(&self.rate).take(self.len) {
                let left = energy * exp(rate * time);
                sum += left;
                slope += left * rate;
            }
            if sum <= total {
                break;
            }
            if slope >= 0.0 {
                return LONGEST_FRAMES as u64;
            }
            let step = (target - log(sum)) * sum / slope;
            time += step;
            if step < 1e-3 {
                break;
            }
        }
        whole_frames(time)
    }

    /// Upper bound of [`Energies::frames_until`] after `more` energy has been added, whichever modes get it.
    pub(in crate::dsp) fn frames_until_at_most(&self, total: f64, more: f64) -> u64 {
        let slowest = self.rate.iter().take(self.len).copied().fold(f64::NEG_INFINITY, f64::max);
        let energy = more + self.energy.iter().take(self.len).sum::<f64>();
        if energy <= total || self.len == 0 { 0 } else { whole_frames(log(total / energy) / slowest.min(-1e-300)) }
    }
}

fn whole_frames(time: f64) -> u64 {
    ceil(time.clamp(0.0, LONGEST_FRAMES)) as u64
}

impl ModeBank {
    /// Calls `each` for every mode with its squared amplitude and the logarithm of the squared amplitude's ratio per frame.
    pub(in crate::dsp) fn tell_energies(&self, mut each: impl FnMut(f64, f64)) {
        // In a tick that is rendered by tables, the stored state is the one at the start of the tick.
        let passed = self.frames_since() as f64;
        for m in 0..self.len {
            let (energy, rate) = (f64::from(self.mass(m).1), 2.0 * self.ln_radius[m]);
            each(if passed > 0.0 { energy * exp(rate * passed) } else { energy }, rate);
        }
    }
}
