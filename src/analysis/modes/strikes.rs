//! Finds the strikes of a recording, and how long each can be analysed.

use super::contact::let_go;
use crate::analysis::level::{energy, offset, rms};

/// Seconds of the steps whose energies are compared before and after an onset.
const STEP: f64 = 0.005;
/// Rise of the energy from one step to the next at an onset: 8 dB.
const RISE: f64 = 6.3;
/// Seconds before an onset in which nothing may have been as loud: beats return, but never above their earlier level.
const MEMORY: f64 = 0.08;
/// Rise of the mean energy at an onset (2 dB), and the seconds before and after it over which the mean is taken.
const LOUDER: f64 = 1.6;
const LOUDER_OVER: f64 = 0.05;
/// Seconds by which an onset may precede its first clearly audible sample.
const SWELL: f64 = 0.001;
/// Least distance of onsets in seconds.
const APART: f64 = 0.05;
/// Amplitude relative to the loudest of the recording below which there is no strike: −50 dB.
const FAINT: f64 = 3e-3;
/// Seconds within which an exciter lets go.
const CONTACT: f64 = 0.015;
/// Seconds per block whose level shows whether there is more than noise.
pub(super) const BLOCK: f64 = 0.05;
/// Level relative to the noise above which there is more than noise.
const ABOVE_NOISE: f64 = 1.03;
/// Noise keeps its level within 1 dB for this many blocks, in which even a T60 of 30 s falls by more.
const STEADY: f64 = 1.122;
const STEADY_BLOCKS: usize = 12;
/// Shortest stretch in seconds in which modes are searched for.
const SHORTEST: f64 = 0.03;

/// A strike, in frames of the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Where the sound begins.
    pub(super) onset: usize,
    /// Where the exciter has let go, and the modes ring freely.
    pub(super) start: usize,
    /// Where only noise is left, or the next strike comes.
    pub(super) end: usize,
}

/// Finds strikes in samples that are not silent; none longer than `longest` seconds.
pub(super) fn strikes(samples: &[f64], sample_rate: f64, longest: f64) -> Vec<Stretch> {
    let frames = |seconds: f64| ((seconds * sample_rate) as usize).max(1);
    let constant = offset(samples, frames(BLOCK));
    let samples: Vec<f64> = samples.iter().map(|sample| sample - constant).collect();
    let samples = &samples[..];
    let mut onsets = onsets(samples, sample_rate);
    if onsets.is_empty() {
        // The sound has no onset: it begins before the recording.
        onsets.push(0);
    }
    let floor = noise(samples, frames(BLOCK));
    let next = |index: usize| onsets.get(index + 1).map_or(samples.len(), |next| next.saturating_sub(frames(0.002)));
    let stretch = |(index, onset): (usize, &usize)| {
        let released = released(samples, *onset, frames(0.001), frames(CONTACT));
        let free = onset + let_go(&samples[*onset..next(index).max(*onset)], sample_rate);
        let start = released.max(free);
        let limit = next(index).min(start + frames(longest));
        let mut blocks = samples[start.min(limit)..limit].chunks(frames(BLOCK)).enumerate();
        let above = |block: &[f64]| rms(block) > ABOVE_NOISE * floor;
        let heard = blocks.rfind(|(_, block)| above(block)).map_or(0, |(block, _)| block + 1);
        let end = (start + (heard * frames(BLOCK)).max(frames(SHORTEST))).min(limit);
        Stretch { onset: *onset, start, end }
    };
    let long_enough = |stretch: &Stretch| stretch.end >= stretch.start + frames(SHORTEST);
    onsets.iter().enumerate().map(stretch).filter(long_enough).collect()
}

/// Frames at which strikes begin.
fn onsets(samples: &[f64], sample_rate: f64) -> Vec<usize> {
    let step = ((STEP * sample_rate) as usize).max(1);
    let peak = samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
    let energies: Vec<f64> = samples.chunks(step).map(|block| energy(block, 0.0)).collect();
    let (memory, apart) = ((MEMORY / STEP) as usize, (APART * sample_rate) as usize);
    let least = FAINT * FAINT * peak * peak * step as f64 * 0.1;
    // The level before the recording is unknown.
    let quietest = energies.iter().copied().fold(f64::INFINITY, f64::min);
    let mut found: Vec<usize> = Vec::new();
    for (block, energy) in energies.iter().enumerate() {
        let loudest =
            energies[block.saturating_sub(memory)..block].iter().fold(0.0_f64, |most, energy| most.max(*energy));
        let before = block.checked_sub(1).map_or(quietest, |before| energies[before]);
        if *energy < least || *energy < RISE * before || *energy < 1.5 * loudest {
            continue;
        }
        // Low modes that beat quickly rise again in each step, but not above their earlier level.
        let around = (LOUDER_OVER / STEP) as usize;
        let mean = |range: &[f64]| range.iter().sum::<f64>() / range.len().max(1) as f64;
        let after = mean(&energies[block..(block + around).min(energies.len())]);
        if block > 0 && after < LOUDER * mean(&energies[block.saturating_sub(around)..block]) {
            continue;
        }
        let onset = first_above(samples, block * step, step, (SWELL * sample_rate) as usize);
        if found.last().is_none_or(|last| onset >= last + apart) {
            found.push(onset);
        }
    }
    found
}

/// The first sample, from a step before frame `from` on, that is louder than the sound before it. In the `swell` frames
/// before a clearly louder sample, fainter samples count too.
fn first_above(samples: &[f64], from: usize, step: usize, swell: usize) -> usize {
    let most = |range: &[f64]| range.iter().fold(0.0_f64, |most, sample| most.max(sample.abs()));
    let begin = from.saturating_sub(step);
    let (before, after) = (most(&samples[begin.saturating_sub(4 * step)..begin]), {
        most(&samples[begin..(from + step).min(samples.len())])
    });
    let threshold = (1.5 * before).max(0.03 * after).min(after);
    let place = begin + samples[begin..].iter().position(|sample| sample.abs() >= threshold).unwrap_or(0);
    // In these frames the sound may rise slowly, but it must still exceed the sound before it.
    let faint = (1.5 * before).max(0.001 * after).min(after);
    let earliest = place.saturating_sub(swell);
    earliest + samples[earliest..].iter().position(|sample| sample.abs() >= faint).unwrap_or(0)
}

/// Where the energy first reaches half of its maximum within the time of contact: soon after, the modes ring freely.
fn released(samples: &[f64], onset: usize, block: usize, contact: usize) -> usize {
    let end = (onset + contact).min(samples.len());
    let energies: Vec<f64> = samples[onset..end].chunks(block).map(|block| energy(block, 0.0)).collect();
    let most = energies.iter().fold(0.0_f64, |most, energy| most.max(*energy));
    let reached = energies.iter().position(|energy| *energy >= 0.5 * most).unwrap_or(0);
    onset + reached * block
}

/// Level of the background noise; 0 if there is none, as in a strike that decays to the end.
fn noise(samples: &[f64], block: usize) -> f64 {
    let mut levels: Vec<f64> = samples.chunks_exact(block).map(rms).collect();
    levels.sort_by(f64::total_cmp);
    let (Some(quietest), Some(loudest)) = (levels.first(), levels.last()) else { return 0.0 };
    // The level of noise is constant, that of a decay is not.
    let still = levels.iter().take_while(|level| **level <= STEADY * quietest).count();
    if still >= STEADY_BLOCKS && *quietest < 0.1 * loudest { levels[still / 2] } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decay(len: usize) -> impl Iterator<Item = f64> {
        (0..len).map(|n| libm::exp(-3e-4 * n as f64) * libm::cos(0.1 * n as f64))
    }

    #[test]
    fn strikes_begin_where_they_begin() {
        let mut samples = vec![0.0; 1000];
        samples.extend(decay(24_000));
        samples.extend(decay(24_000));
        let found = strikes(&samples, 48_000.0, 10.0);
        assert_eq!(found.iter().map(|stretch| stretch.onset).collect::<Vec<_>>(), [1000, 25_000]);
        assert!(found[0].end <= 25_000 && found[1].end == 49_000, "{found:?}");
    }

    #[test]
    fn a_strike_ends_where_noise_alone_is_left() {
        let mut state = 1_u32;
        let mut noise = || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            1e-3 * (f64::from(state) / f64::from(u32::MAX) - 0.5)
        };
        let silence = std::iter::repeat_n(0.0, 72_000);
        let samples: Vec<f64> = decay(24_000).chain(silence).map(|sample| sample + noise()).collect();
        let [strike] = strikes(&samples, 48_000.0, 10.0)[..] else { panic!("one strike") };
        // The decay stops at frame 24,000, and only noise follows.
        assert!((21_600..60_000).contains(&strike.end), "{strike:?}");
    }

    #[test]
    fn an_asymmetric_strike_does_not_end_in_noise_but_a_constant_changes_nothing() {
        let pushed = |n: usize, x: f64| x + if n < 500 { 1.0 } else { 0.0 };
        let samples: Vec<f64> = decay(96_000).enumerate().map(|(n, x)| pushed(n, x)).collect();
        let shifted: Vec<f64> = samples.iter().map(|x| x + 0.1).collect();
        for samples in [&samples, &shifted] {
            let [strike] = strikes(samples, 48_000.0, 10.0)[..] else { panic!("one strike") };
            assert_eq!(strike.end, 96_000);
        }
    }

    #[test]
    fn beats_are_no_strikes() {
        let beat = |n: usize| 1.0 + libm::cos(std::f64::consts::TAU * 25.0 * n as f64 / 48_000.0);
        let samples: Vec<f64> = decay(48_000).enumerate().map(|(n, x)| beat(n) * x).collect();
        assert_eq!(strikes(&samples, 48_000.0, 10.0).len(), 1);
    }

    #[test]
    fn a_constant_tone_is_one_strike_and_a_few_samples_are_none() {
        let tone: Vec<f64> = (0..48_000).map(|n| libm::sin(0.1 * f64::from(n))).collect();
        assert_eq!(strikes(&tone, 48_000.0, 0.5).len(), 1);
        assert!(strikes(&tone[..100], 48_000.0, 1.0).is_empty());
    }
}
