//! Finds where a sound has more energy than the noise around it, by spectra matched to decays of all lengths.
//!
//! For a mode of known decay and frequency, the sum of the samples times `e^(−decay·n)` at that frequency is the best
//! detector in white noise (matched filter). One transform does this for all frequencies.

use super::pole::Pole;
use crate::sound::bodies::LN_1000;
use libm::exp;
use sprung_fourier::Planner;
use std::f64::consts::PI;

/// Shortest and longest T60 in seconds to which spectra are matched; each is twice the one before.
const SHORTEST: f64 = 0.012;
const LONGEST: f64 = 30.0;
/// Half-width of the neighbourhood of a running median, in widths of the resonance to which the spectrum is matched.
const NEIGHBOURHOOD: f64 = 30.0;
/// Least half-width of a neighbourhood in Hz.
const LEAST_NEIGHBOURHOOD: f64 = 60.0;
/// Medians per half-width of a neighbourhood; between them the floor is interpolated.
const MEDIANS: usize = 4;
/// Maximum number of bins of a median, evenly spread.
const MEDIAN_BINS: usize = 500;

/// Samples after which the recurrence of a decay starts from an exact power again.
const BLOCK: usize = 256;

/// A peak that is too high for noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) pole: Pole,
    /// Energy that a mode of this pole would explain.
    pub(super) energy: f64,
}

/// A matched spectrum and its floor.
pub(super) struct Spectrum {
    decay: f64,
    /// Radians per sample from one bin to the next.
    width: f64,
    energies: Vec<f64>,
    floor: Vec<f64>,
}

impl Spectrum {
    fn new(samples: &[f64], decay: f64, sample_rate: f64, planner: &Planner) -> Self {
        let len = samples.len().min(((7.0 / decay) as usize).max(16));
        let size = (len + len / 2).next_power_of_two();
        let transform = planner.forward(size);
        let mut input = transform.make_input_vec();
        let mut weights = 0.0;
        for (block, (inputs, samples)) in input.chunks_mut(BLOCK).zip(samples[..len].chunks(BLOCK)).enumerate() {
            let (mut weight, step) = (exp(-decay * (block * BLOCK) as f64), exp(-decay));
            for (input, sample) in inputs.iter_mut().zip(samples) {
                *input = weight * sample;
                weights += weight * weight;
                weight *= step;
            }
        }
        let mut output = transform.make_output_vec();
        transform.process(&mut input, &mut output).expect("the buffers are the transform's own");
        // Both quadratures of a mode explain twice the square over the energy of its envelope.
        let energies: Vec<f64> = output.iter().map(|bin| 2.0 * bin.norm_sqr() / weights).collect();
        let bin = sample_rate / size as f64;
        let resonance = (decay * sample_rate / PI).max(sample_rate / len as f64);
        let half = (NEIGHBOURHOOD * resonance).max(LEAST_NEIGHBOURHOOD) / bin;
        let floor = running_median(&energies, (half as usize).max(8));
        Self { decay, width: 2.0 * PI / size as f64, energies, floor }
    }

    /// Average energy that noise explains near a frequency.
    fn floor_at(&self, theta: f64) -> f64 {
        self.floor[((theta / self.width) as usize).min(self.floor.len() - 1)]
    }
}

/// The mean of exponentially distributed energies, from their median over `half` bins on either side.
fn running_median(energies: &[f64], half: usize) -> Vec<f64> {
    let hop = (half / MEDIANS).max(1);
    let mut sorted = Vec::new();
    let medians: Vec<f64> = (0..energies.len() + hop)
        .step_by(hop)
        .map(|centre| {
            sorted.clear();
            let (from, to) = (centre.saturating_sub(half), (centre + half).min(energies.len()));
            // Near the ends the neighbourhood is shifted, not shortened.
            let (from, to) =
                (from.min(energies.len().saturating_sub(2 * half)), to.max((2 * half).min(energies.len())));
            sorted.extend(energies[from..to].iter().step_by((2 * half).div_ceil(MEDIAN_BINS)));
            let middle = sorted.len() / 2;
            *sorted.select_nth_unstable_by(middle, f64::total_cmp).1 / std::f64::consts::LN_2
        })
        .collect();
    let between = |bin: usize| {
        let (index, share) = (bin / hop, (bin % hop) as f64 / hop as f64);
        medians[index] + share * (medians[index + 1] - medians[index])
    };
    (0..energies.len()).map(between).collect()
}

/// Spectra matched to each decay.
pub(super) struct Spectra(Vec<Spectrum>);

impl Spectra {
    pub(super) fn new(samples: &[f64], sample_rate: f64, planner: &Planner) -> Self {
        let longest = LONGEST.min(6.0 * samples.len() as f64 / sample_rate);
        let t60s = std::iter::successors(Some(SHORTEST), |t60| Some(2.0 * t60)).take_while(|t60| *t60 < 2.0 * longest);
        let decay = |t60: f64| LN_1000 / (t60 * sample_rate);
        Self(t60s.map(|t60| Spectrum::new(samples, decay(t60), sample_rate, planner)).collect())
    }

    /// Average energy that noise explains for a mode of that pole.
    pub(super) fn floor(&self, pole: Pole) -> f64 {
        let distance = |spectrum: &Spectrum| (libm::log(spectrum.decay / pole.decay.max(1e-9))).abs();
        let nearest = self.0.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(0.0, |spectrum| spectrum.floor_at(pole.theta))
    }

    /// Energy of the strongest of [`Self::peaks`].
    pub(super) fn strongest(&self, ratio: f64, energy: f64, range: (f64, f64)) -> f64 {
        self.peaks(ratio, energy, range).map(|peak| peak.energy).fold(0.0, f64::max)
    }

    /// Peaks of at least `ratio` times the floor and of at least `energy`, between two frequencies in radians per sample.
    fn peaks(&self, ratio: f64, energy: f64, (low, high): (f64, f64)) -> impl Iterator<Item = Candidate> {
        self.0.iter().flat_map(move |spectrum| {
            let last = spectrum.energies.len() - 1;
            (1..last).filter_map(move |bin| {
                let (value, theta) = (spectrum.energies[bin], bin as f64 * spectrum.width);
                let peak = value > spectrum.energies[bin - 1] && value >= spectrum.energies[bin + 1];
                let stands_out =
                    value >= energy && value >= ratio * spectrum.floor[bin] && (low..=high).contains(&theta);
                let pole = Pole { decay: spectrum.decay, theta };
                (peak && stands_out).then_some(Candidate { pole, energy: value })
            })
        })
    }

    /// [`Self::peaks`], the strongest first, each without weaker ones within the distance `reach` of it.
    pub(super) fn candidates(
        &self,
        ratio: f64,
        energy: f64,
        range: (f64, f64),
        reach: impl Fn(Pole) -> f64,
    ) -> Vec<Candidate> {
        let mut all: Vec<Candidate> = self.peaks(ratio, energy, range).collect();
        all.sort_unstable_by(|a, b| b.energy.total_cmp(&a.energy));
        let mut kept: Vec<Candidate> = Vec::new();
        for candidate in all {
            let apart = |other: &Candidate| (candidate.pole.theta - other.pole.theta).abs() > reach(other.pole);
            if kept.iter().all(apart) {
                kept.push(candidate);
            }
        }
        kept
    }
}
