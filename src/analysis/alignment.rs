//! Finds whether one sound is a shifted or scaled copy of another.

use super::level::{SILENCE_DB, dbfs};
use libm::{log10, sqrt};
use sprung_fourier::Planner;

/// Length in frames of the stretch of the first sound that is searched for in the second. It starts at the first
/// audible frame. A power of two.
const STRETCH: usize = 1 << 18;
/// Largest shift in frames, earlier or later.
const MOST_SHIFT: usize = 1 << 18;

/// The shift and the gain that best turn the first of two sounds into the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// Frames by which the second is later.
    pub shift: isize,
    /// Factor by which the second is louder; negative if its polarity is inverted.
    pub gain: f64,
    /// Level of the residual (the second sound minus the shifted and scaled first) in dB relative to the second.
    pub residual_db: f64,
}

impl Alignment {
    /// The magnitude of the gain in dB.
    pub fn gain_db(&self) -> f64 {
        dbfs(self.gain.abs())
    }
}

/// Finds the shift, of at most some seconds, and the gain by the largest cross-correlation, summed over the channels
/// that both sounds have. `None` if one of them is silent or not finite.
pub(crate) fn align(first: &[Vec<f32>], second: &[Vec<f32>]) -> Option<Alignment> {
    let loudest = |sound: &[Vec<f32>]| sound.iter().flatten().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    let finite = |sound: &[Vec<f32>]| sound.iter().flatten().all(|sample| sample.is_finite());
    let peak = loudest(first);
    if !(finite(first) && finite(second) && peak > 0.0 && loudest(second) > 0.0) {
        return None;
    }
    let audible = |channel: &Vec<f32>| channel.iter().position(|sample| sample.abs() > 0.01 * peak);
    let start = first.iter().filter_map(audible).min()?;
    let shift = best_shift(first, second, start);
    let (mut product, mut energy, mut power) = (0.0, 0.0, 0.0);
    for (first, second) in first.iter().zip(second) {
        for (frame, sample) in second.iter().enumerate() {
            let sample = f64::from(*sample);
            let source = frame.checked_add_signed(-shift).and_then(|frame| first.get(frame));
            let source = f64::from(source.copied().unwrap_or(0.0));
            product += source * sample;
            energy += source * source;
            power += sample * sample;
        }
    }
    let gain = if energy > 0.0 { product / energy } else { 0.0 };
    let left = (power - gain * product).max(0.0);
    Some(Alignment { shift, gain, residual_db: (10.0 * log10(left / power)).max(SILENCE_DB) })
}

/// The shift at which `second` correlates best with a stretch of `first` that begins at frame `start`. Each correlation
/// is divided by the square root of the energy of its passage, so that louder passages are not preferred.
fn best_shift(first: &[Vec<f32>], second: &[Vec<f32>], start: usize) -> isize {
    let len = (STRETCH + 2 * MOST_SHIFT).next_power_of_two();
    let planner = Planner::default();
    let (forward, inverse) = (planner.forward(len), planner.inverse(len));
    let mut sums = forward.make_output_vec();
    let mut energies = vec![0.0; len + 1];
    let window = start as isize - MOST_SHIFT as isize;
    for (first, second) in first.iter().zip(second) {
        let spectrum = |at: &dyn Fn(usize) -> f64| {
            let mut input: Vec<f64> = (0..len).map(at).collect();
            let mut output = forward.make_output_vec();
            forward.process(&mut input, &mut output).expect("the buffers are the transform's own");
            output
        };
        let stretch = first.get(start..).unwrap_or_default();
        let sought = |n: usize| stretch.get(n).filter(|_| n < STRETCH).map_or(0.0, |sample| f64::from(*sample));
        let place =
            |n: usize| window.checked_add_unsigned(n).and_then(|frame| second.get(usize::try_from(frame).ok()?));
        let searched = |n: usize| place(n).filter(|_| n < STRETCH + 2 * MOST_SHIFT).map_or(0.0, |s| f64::from(*s));
        let (sought, spectrum) = (spectrum(&sought), spectrum(&searched));
        sums.iter_mut().zip(sought.iter().zip(&spectrum)).for_each(|(sum, (a, b))| *sum += a.conj() * b);
        (0..len).for_each(|n| energies[n + 1] += searched(n) * searched(n));
    }
    let mut correlation = inverse.make_output_vec();
    // These bins are real by symmetry, but not exactly so after rounding.
    sums[0].im = 0.0;
    sums[len / 2].im = 0.0;
    inverse.process(&mut sums, &mut correlation).expect("the buffers are the transform's own");
    for n in 0..len {
        energies[n + 1] += energies[n];
    }
    let stretch = first.iter().map(|channel| channel.len().saturating_sub(start)).max().unwrap_or(0).min(STRETCH);
    // Passages with almost no energy are skipped, since their relative correlation is large by chance.
    let least = 1e-6 * energies[len];
    let likeness = |n: usize| {
        let energy = energies[n + stretch] - energies[n];
        if energy > least { correlation[n].abs() / sqrt(energy) } else { 0.0 }
    };
    let best = (0..=2 * MOST_SHIFT).max_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(MOST_SHIFT);
    best as isize - MOST_SHIFT as isize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::uniform;

    /// Uniform numbers from −0.5 to 0.5.
    fn noise(len: usize) -> Vec<f32> {
        (0..len as u64).map(|n| 0.5 * uniform(1, n)).collect()
    }

    #[test]
    fn a_sound_is_found_where_it_was_moved_to() {
        let sound = noise(20_000);
        for (shift, gain) in [(0_isize, 1.0_f32), (37, 0.5), (-12, 0.25), (5000, -2.0)] {
            let moved = |n: usize| n.checked_add_signed(-shift).and_then(|n| sound.get(n)).map_or(0.0, |s| gain * s);
            let other = vec![(0..20_000).map(moved).collect::<Vec<_>>()];
            let found = align(std::slice::from_ref(&sound), &other).unwrap();
            assert_eq!(found.shift, shift);
            assert!((found.gain - f64::from(gain)).abs() < 1e-9 && found.residual_db < -120.0, "{found:?}");
        }
    }

    #[test]
    fn different_sounds_leave_a_residual_and_silence_has_no_place() {
        let (a, b) = (noise(5000), noise(9000)[4000..].iter().map(|x| x * x).collect::<Vec<_>>());
        assert!(align(std::slice::from_ref(&a), &[b]).unwrap().residual_db > -1.0);
        assert_eq!(align(std::slice::from_ref(&a), &[vec![0.0; 10]]), None);
        assert_eq!(align(&[a], &[vec![f32::NAN]]), None);
        assert_eq!(align(&[], &[]), None);
    }
}
