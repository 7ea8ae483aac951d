//! How long a bank rings: the sum of decaying exponentials, solved for the time.

use super::{MAX_MODES, ModeBank};
use libm::{ceil, exp, log};

/// Newton's method starts at most this many times over; it needs about five.
const MOST_STEPS: usize = 50;

/// No answer is longer than this: 40 years at 768 kHz.
const LONGEST_FRAMES: f64 = 1e15;

/// Squared amplitudes, and the logarithms of what a frame leaves of them. Real-time safe.
pub(in crate::dsp) struct Energies {
    energy: [f64; MAX_MODES],
    rate: [f64; MAX_MODES],
    len: usize,
}

impl Energies {
    /// Of at most [`MAX_MODES`] modes.
    pub(in crate::dsp) fn new(modes: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut energies = Self { energy: [0.0; MAX_MODES], rate: [0.0; MAX_MODES], len: 0 };
        for (m, mode) in modes.take(MAX_MODES).enumerate() {
            (energies.energy[m], energies.rate[m]) = mode;
            energies.len = m + 1;
        }
        energies
    }

    /// Frames until they add up to less than `total`, `passed` of which have gone. Takes an exponential a mode for each
    /// of about five steps.
    ///
    /// The logarithm of a sum of exponentials is convex, so Newton's method from now never oversteps.
    pub(in crate::dsp) fn frames_until(&self, total: f64, passed: usize) -> u64 {
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
        whole_frames(time - passed as f64)
    }

    /// At most how many frames that takes once `more` energy, wherever it goes, has been added.
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
    fn energies(&self, modes: usize) -> Energies {
        Energies::new((0..modes).map(|m| (f64::from(self.mass(m).1), 2.0 * self.ln_radius[m])))
    }

    /// Frames until the squared amplitudes of the modes add up to less than `total`, if nothing damps them anew.
    /// Real-time safe; takes some microseconds.
    pub fn frames_until(&self, total: f64) -> u64 {
        self.energies(self.live).frames_until(total, self.frames_since())
    }

    /// At most how many frames that takes once `more` energy, wherever it goes, has been added.
    pub fn frames_until_at_most(&self, total: f64, more: f64) -> u64 {
        self.energies(self.len).frames_until_at_most(total, more)
    }
}
