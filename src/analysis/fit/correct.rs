//! Corrects levels and decays of a draft's modes by the errors of its mel bands.

use super::draft::{Draft, Partial, SHORTEST_T60, longest_t60};
use super::movement::{ENERGY_PER_T60, Sweep, speed_at};
use crate::analysis::line::Line;
use crate::analysis::log_mel::{BANDS, HOP, LogMel, RATE, SPAN_DB, time, weights};
use libm::{exp, pow};

/// Largest correction at a time: of a level in dB, and of a decay rate as a share of that rate.
const MOST_DB: f64 = 12.0;
const MOST_SHARE: f64 = 0.6;
/// Limit of errors in dB.
const MOST_ERROR_DB: f64 = 20.0;
/// Least number of windows in which a mode must be audible for its decay to be corrected.
const FEWEST: f64 = 8.0;

/// The level in dB that is missing at the onset, and its change in dB/s.
type Correction = (f64, f64);

/// Corrects all modes of a band by the same amount, or if a sweep moves them through several bands, each by what is off there.
pub(super) fn by_bands(draft: &Draft, target: &LogMel, heard: &LogMel, share: f64) -> Draft {
    let errors = Errors::new(target, heard);
    if draft.sweep.semitones != 0.0 {
        let speeds = speeds(&draft.sweep, errors.columns.len());
        return corrected(draft, share, |partial| {
            correction(errors.along(partial, &speeds).map(|(n, _, error, weight)| (n, error, weight)))
        });
    }
    let corrections: [Correction; BANDS] =
        std::array::from_fn(|band| correction(errors.of(band).map(|(n, error)| (n, error, 1.0))));
    corrected(draft, share, |partial| {
        let weights = weights(partial.heard_at(&draft.sweep));
        let both = weights.iter().zip(&corrections);
        both.fold((0.0, 0.0), |sum, (weight, correction)| {
            (sum.0 + weight * correction.0, sum.1 + weight * correction.1)
        })
    })
}

/// Corrects each mode by the errors of its bands, each weighted by the mode's share of the band's power at that moment.
/// Of two modes in a band, the shorter one is corrected by the beginning of the sound, and the longer one by the rest.
pub(super) fn by_moments(draft: &Draft, target: &LogMel, heard: &LogMel, share: f64) -> Draft {
    let errors = Errors::new(target, heard);
    let columns = errors.columns.len();
    let speeds = speeds(&draft.sweep, columns);
    let powers = powers(&draft.partials, &speeds);
    corrected(draft, share, |partial| {
        let own: Vec<f64> = powers_of(partial, columns).collect();
        let share = |n: usize, band: usize, weight: f64| weight * own[n] / powers[n][band];
        let weighted = |(n, band, error, weight)| (n, error, share(n, band, weight) * weight);
        correction(errors.along(partial, &speeds).map(weighted))
    })
}

/// How much a sweep raises the pitch in each window.
fn speeds(sweep: &Sweep, columns: usize) -> Vec<f64> {
    (0..columns).map(|n| speed_at(sweep, time(n))).collect()
}

/// The bands that a mode passes through: numbers of windows, the band there, and the mode's weight in it.
fn track(frequency: f64, speeds: &[f64]) -> impl Iterator<Item = (usize, usize, f64)> {
    let mut end = 0;
    speeds.chunk_by(|a, b| a == b).flat_map(move |run| {
        let windows = end..end + run.len();
        end = windows.end;
        let weights = weights(frequency * run[0]);
        let low = weights.iter().position(|weight| *weight > 0.0).unwrap_or(BANDS);
        let pair = [low, low + 1].map(|band| (band, weights.get(band).copied().unwrap_or(0.0)));
        windows.flat_map(move |n| pair.map(|(band, weight)| (n, band, weight))).filter(|(.., weight)| *weight > 0.0)
    })
}

/// The power of modes in each band of each window.
fn powers(partials: &[Partial], speeds: &[f64]) -> Vec<[f64; BANDS]> {
    let mut powers = vec![[1e-30; BANDS]; speeds.len()];
    for partial in partials {
        let own: Vec<f64> = powers_of(partial, speeds.len()).collect();
        track(partial.frequency, speeds).for_each(|(n, band, weight)| powers[n][band] += weight * own[n]);
    }
    powers
}

/// The power of a mode in each window.
fn powers_of(partial: &Partial, columns: usize) -> impl Iterator<Item = f64> {
    let step = exp(-ENERGY_PER_T60 * HOP as f64 / f64::from(RATE) / partial.t60);
    std::iter::successors(Some(partial.amplitude * partial.amplitude), move |power| Some(power * step)).take(columns)
}

/// The level in dB that is missing in each band of each window; none where neither sound is audible.
struct Errors {
    columns: Vec<[Option<f64>; BANDS]>,
}

impl Errors {
    fn new(target: &LogMel, heard: &LogMel) -> Self {
        let floor = target.loudest().max(heard.loudest()) - SPAN_DB;
        let column = |(n, wanted): (usize, &[f64; BANDS])| {
            std::array::from_fn(|band| {
                let has = heard.columns.get(n).map_or(floor, |column| column[band]);
                let error = wanted[band].max(floor) - has.max(floor);
                (wanted[band].max(has) > floor).then_some(error.clamp(-MOST_ERROR_DB, MOST_ERROR_DB))
            })
        };
        Self { columns: target.columns.iter().enumerate().map(column).collect() }
    }

    /// The errors of a mode: for each the number of its window, its band, the error, and the weight of the mode in that band.
    fn along(&self, partial: &Partial, speeds: &[f64]) -> impl Iterator<Item = (usize, usize, f64, f64)> {
        let track = track(partial.frequency, speeds);
        track.filter_map(|(n, band, weight)| Some((n, band, self.columns[n][band]?, weight)))
    }

    /// The errors of a band, with the numbers of their windows.
    fn of(&self, band: usize) -> impl Iterator<Item = (usize, f64)> {
        self.columns.iter().enumerate().filter_map(move |(n, column)| Some((n, column[band]?)))
    }
}

/// The correction by a line through errors: their times, the errors and their weights.
fn correction(errors: impl Iterator<Item = (usize, f64, f64)>) -> Correction {
    let errors: Vec<[f64; 3]> = errors.map(|(n, error, weight)| [time(n), error, weight]).collect();
    match Line::through(errors.iter().copied()) {
        Some(line) if line.weight >= FEWEST => (line.at(0.0), line.slope),
        // With a weight of less than one window, the error is uncertain: correct only a part of it.
        Some(line) => (line.weight.min(1.0) * line.y, 0.0),
        None => (0.0, 0.0),
    }
}

/// The draft with a share of each mode's correction.
fn corrected(draft: &Draft, share: f64, mut correction: impl FnMut(&Partial) -> Correction) -> Draft {
    let mut draft = draft.clone();
    for partial in &mut draft.partials {
        let (level, slope) = correction(partial);
        partial.amplitude *= pow(10.0, (share * level).clamp(-MOST_DB, MOST_DB) / 20.0);
        // Decay rate in dB/s.
        let falls = 60.0 / partial.t60;
        let change = (share * slope).clamp(-MOST_SHARE * falls, MOST_SHARE * falls);
        partial.t60 = (60.0 / (falls - change)).clamp(SHORTEST_T60, longest_t60(draft.is_held));
    }
    draft
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::draft::Noise;
    use super::super::movement::Sweep;
    use super::*;
    use crate::params::Param;

    pub(crate) fn draft(amplitudes: [f64; 2]) -> Draft {
        let partial =
            |(frequency, t60, amplitude)| Partial { frequency, t60, amplitude, phase: 0.0, pan: 0.0, struck: true };
        let [first, second] = amplitudes;
        Draft {
            note: 440.0,
            velocity: 1.0,
            follow: 1.0,
            partials: [(440.0, 0.1, first), (445.0, 3.0, second)].map(partial).to_vec(),
            hardness: None,
            sweep: Sweep::NONE,
            noise: Noise::SHORT,
            swell: None,
            oscillators: Vec::new(),
            is_held: false,
        }
    }

    /// The bands of a draft's modes, without beats.
    fn bands(draft: &Draft) -> LogMel {
        let mut columns = vec![[1e-12; BANDS]; 300];
        for partial in &draft.partials {
            for (n, power) in powers_of(partial, 300).enumerate() {
                let weights = weights(partial.frequency * speed_at(&draft.sweep, time(n)));
                columns[n].iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * power);
            }
        }
        LogMel { columns: columns.into_iter().map(|column| column.map(|power| 10.0 * libm::log10(power))).collect() }
    }

    #[test]
    fn a_faint_mode_rings_on_beside_a_loud_short_one() {
        let mut draft = draft([0.5, 0.02]);
        draft.partials[0].t60 = 0.05;
        let modes = draft.patch().modes;
        let t60 = modes.as_slice()[1].decay * draft.patch().get(Param::Decay);
        assert!((t60 - 3.0).abs() < 1e-3, "{t60}");
    }

    #[test]
    fn of_two_modes_in_a_band_the_one_that_is_off_is_corrected() {
        let target = bands(&draft([0.4, 0.1]));
        let off =
            |draft: &Draft, n: usize, wanted: f64| (20.0 * libm::log10(draft.partials[n].amplitude / wanted)).abs();
        let mut found = draft([0.1, 0.1]);
        for _ in 0..12 {
            found = by_moments(&found, &target, &bands(&found), 0.8);
        }
        assert!(off(&found, 0, 0.4) < 2.0 && off(&found, 1, 0.1) < 0.5, "{:?}", found.partials);
        // Correcting all modes of the band alike does not get there.
        let mut alike = draft([0.1, 0.1]);
        for _ in 0..12 {
            alike = by_bands(&alike, &target, &bands(&alike), 0.8);
        }
        assert!(off(&alike, 0, 0.4) > 4.0 || off(&alike, 1, 0.1) > 1.0, "{:?}", alike.partials);
    }

    #[test]
    fn a_mode_whose_pitch_falls_is_corrected_wherever_it_is() {
        let falling = Sweep { semitones: 36.0, seconds: 0.4, curve: 0.0, ..Sweep::NONE };
        let mut known = draft([0.4, 0.1]);
        (known.sweep, known.partials[0].t60) = (falling, 0.5);
        known.partials[1].frequency = 1000.0;
        let target = bands(&known);
        for by in [by_bands, by_moments] {
            let mut found = known.clone();
            found.partials[0] = Partial { amplitude: 0.2, t60: 0.8, ..found.partials[0] };
            for _ in 0..12 {
                found = by(&found, &target, &bands(&found), 0.8);
            }
            let [found, known] = [found.partials[0], known.partials[0]];
            let near =
                (found.amplitude / known.amplitude - 1.0).abs() < 0.1 && (found.t60 / known.t60 - 1.0).abs() < 0.1;
            assert!(near, "{found:?}");
        }
    }
}
