//! Resolves bands into poles where something stands out of the residual of a fit.

use super::detect::Spectra;
use super::esprit::Band;
use super::fit::Fit;
use super::pole::{Pole, add};
use super::prune::DETECTION;
use crate::analysis::level;
use crate::sound::bodies::LN_1000;
use libm::fabs;
use sprung_fourier::{Complex, Planner};
use std::f64::consts::PI;

/// Least energy that is used in one round, relative to the strongest: the skirts of strong modes hide weak ones.
const ROUND_SPAN: f64 = 1e-4;
/// Lowest and highest frequency of a mode, in Hz and as a share of half the sample rate.
const LOWEST: f64 = 10.0;
const HIGHEST: f64 = 0.99;
/// Share of the energy that remains when a sound is over.
const OVER: f64 = 1e-6;
/// Maximum number of long bands on either side of one, and their distance in half-widths.
const MOST_LONG_BANDS: usize = 1;
const LONG_BANDS_APART: f64 = 2.0;

/// Which bands are resolved into poles anew.
pub(super) enum Where {
    /// Bands in which more than this energy stands out of the residual.
    StandsOut(f64),
    /// The band of every mode, since the mode may be two that are hard to separate.
    Modes,
}

/// The poles of a fit together with those of bands that are newly resolved; empty if nothing stands out.
pub(super) fn resolve(
    fit: &Fit,
    samples: &[f64],
    sample_rate: f64,
    most_modes: usize,
    place: Where,
    planner: &Planner,
) -> Vec<Pole> {
    let range = (2.0 * PI * LOWEST / sample_rate, HIGHEST * PI);
    let residual = fit.residual(samples);
    let reach = |pole: Pole| band(pole, samples.len()).half_width();
    let candidates: Vec<Pole> = match place {
        Where::StandsOut(least) => {
            let spectra = Spectra::new(&residual, sample_rate, planner);
            let strongest = spectra.strongest(DETECTION, least, range);
            let mut candidates = spectra.candidates(DETECTION, least.max(ROUND_SPAN * strongest), range, reach);
            candidates.truncate(most_modes.saturating_sub(fit.poles.len()));
            candidates.into_iter().map(|candidate| candidate.pole).collect()
        }
        Where::Modes => fit.poles.clone(),
    };
    let split = matches!(place, Where::Modes);
    let before = |(pole, amplitude): (&Pole, &Complex<f64>)| Known { pole: *pole, amplitude: *amplitude, before: true };
    let known = fit.poles.iter().zip(&fit.amplitudes).map(before).collect();
    let mut resolution = Resolution { known, residual: &residual, range };
    let len = heard(&residual);
    let mut long_bands: Vec<f64> = Vec::new();
    for candidate in candidates {
        if resolution.known.len() >= most_modes {
            break;
        }
        // Another band may have resolved this mode already.
        if split && !resolution.known.iter().any(|known| known.before && known.pole == candidate) {
            continue;
        }
        let narrow = band(candidate, samples.len());
        let mut found = Vec::new();
        if !resolution.resolve(&narrow, false, &mut found) {
            let mut is_resolved = false;
            for long in long_bands_of(&narrow, len) {
                if long_bands.iter().all(|theta| fabs(theta - long.theta) > LONG_BANDS_APART * long.half_width()) {
                    long_bands.push(long.theta);
                    is_resolved |= resolution.resolve(&long, false, &mut found);
                }
            }
            if !is_resolved {
                resolution.resolve(&narrow, true, &mut found);
            }
        }
        // A band may have found too few poles to include a faint mode beside strong ones, or a short one beside long ones.
        let width = candidate.width(samples.len());
        let met = |pole: &Pole| fabs(pole.theta - candidate.theta) < width;
        if !split && !found.iter().any(met) {
            resolution.known.push(Known { pole: candidate, amplitude: Complex::ZERO, before: false });
        }
    }
    let mut known = resolution.known;
    if !split && known.iter().all(|known| known.before) {
        return Vec::new();
    }
    known.truncate(most_modes);
    apart(known.into_iter().map(|known| known.pole), samples.len())
}

/// A pole, its amplitude, and whether it is older than the newly resolved bands.
#[derive(Clone, Copy)]
struct Known {
    pole: Pole,
    amplitude: Complex<f64>,
    before: bool,
}

/// Poles, in which those of resolved bands replace the old ones.
struct Resolution<'a> {
    known: Vec<Known>,
    residual: &'a [f64],
    /// Lowest and highest frequency in radians per sample.
    range: (f64, f64),
}

impl Resolution<'_> {
    /// Resolves a band and adds its poles to `found` if they are more than the old ones. If the band has more poles
    /// than can be resolved, it does nothing and returns false, unless `anyway` accepts as many as can be.
    fn resolve(&mut self, band: &Band, anyway: bool, found: &mut Vec<Pole>) -> bool {
        let is_member = |known: &Known| known.before && fabs(known.pole.theta - band.theta) < band.half_width();
        let mut mixed = self.residual[..band.reach().min(self.residual.len())].to_vec();
        let mut members = 0;
        for known in self.known.iter().filter(|known| is_member(known)) {
            add(&mut mixed, known.pole, known.amplitude, 1.0);
            members += 1;
        }
        let (mut poles, crowded) = band.poles(&mixed);
        if crowded && !anyway {
            return false;
        }
        poles.retain(|pole| (self.range.0..=self.range.1).contains(&pole.theta));
        if poles.len() > members {
            self.known.retain(|known| !is_member(known));
            self.known.extend(poles.iter().map(|pole| Known { pole: *pole, amplitude: Complex::ZERO, before: false }));
            found.extend(poles);
        }
        true
    }
}

/// The band in which a pole is resolved: about as long as its T60.
fn band(pole: Pole, len: usize) -> Band {
    Band::new(pole.theta, ((1.2 * LN_1000 / pole.decay) as usize).min(len))
}

/// Number of samples after which almost nothing is left of a residual.
fn heard(residual: &[f64]) -> usize {
    let energy = level::energy(residual, 0.0);
    let mut rest = 0.0;
    let over = residual.iter().rposition(|sample| {
        rest += sample * sample;
        rest > OVER * energy
    });
    over.map_or(residual.len(), |last| last + 1)
}

/// Bands that cover one with too many poles, each of `len` samples; the middle one first.
fn long_bands_of(crowded: &Band, len: usize) -> Vec<Band> {
    let long = |theta: f64| Band::long(theta, len);
    let middle = long(crowded.theta);
    let step = LONG_BANDS_APART * middle.half_width();
    let beside = (1..=MOST_LONG_BANDS).flat_map(|n| [-1.0, 1.0].map(|side| crowded.theta + side * step * n as f64));
    let within = |theta: &f64| fabs(theta - crowded.theta) < crowded.half_width() && (0.0..PI).contains(theta);
    std::iter::once(middle).chain(beside.filter(within).map(long)).collect()
}

/// The poles without those that coincide with an earlier one.
fn apart(poles: impl Iterator<Item = Pole>, len: usize) -> Vec<Pole> {
    let mut kept: Vec<Pole> = Vec::new();
    for pole in poles {
        if !kept.iter().any(|other| pole.coincides(*other, len)) {
            kept.push(pole);
        }
    }
    kept
}
