//! Finds the modes that several strikes have in common, which belong to the struck body.

use super::mode::{Mode, Strike};

/// A mode that was found in several strikes.
#[derive(Clone, Debug, PartialEq)]
pub struct Common {
    /// Hz: the mean of all, weighted by their certainty.
    pub frequency: f64,
    /// Seconds, likewise.
    pub t60: f64,
    /// Its level in dBFS in each strike; none where it was not found.
    pub levels_db: Vec<Option<f64>>,
}

/// Distance in standard deviations below which two frequencies are the same.
const DEVIATIONS: f64 = 4.0;
/// The same in bandwidths of the mode, since a strike may shift the frequencies of the body.
const BANDWIDTHS: f64 = 0.3;

/// The modes that at least two strikes have in common, by rising frequency.
pub fn common(strikes: &[Strike]) -> Vec<Common> {
    let mut taken: Vec<Vec<bool>> = strikes.iter().map(|strike| vec![false; strike.modes.len()]).collect();
    let mut found = Vec::new();
    for (index, strike) in strikes.iter().enumerate() {
        for place in 0..strike.modes.len() {
            if taken[index][place] {
                continue;
            }
            let mode = &strike.modes[place];
            let mut members = vec![(index, place)];
            for (other, candidates) in strikes.iter().enumerate().skip(index + 1) {
                let distance = |k: &usize| (candidates.modes[*k].frequency - mode.frequency).abs();
                let free = (0..candidates.modes.len()).filter(|k| !taken[other][*k]);
                let nearest = free.min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let within = |k: &usize| {
                    let candidate = &candidates.modes[*k];
                    let deviation = mode.uncertainty.frequency + candidate.uncertainty.frequency;
                    let bandwidth = 2.2 / mode.t60.min(candidate.t60);
                    distance(k) < (DEVIATIONS * deviation).max(BANDWIDTHS * bandwidth)
                };
                members.extend(nearest.filter(within).map(|k| (other, k)));
            }
            if members.len() < 2 {
                continue;
            }
            members.iter().for_each(|(strike, place)| taken[*strike][*place] = true);
            let of = |(strike, place): &(usize, usize)| &strikes[*strike].modes[*place];
            let mean = |value: fn(&Mode) -> (f64, f64)| {
                let (sum, weights) = members.iter().map(|member| value(of(member))).fold(
                    (0.0, 0.0),
                    |(sum, weights), (value, deviation)| {
                        let weight = 1.0 / (deviation * deviation).max(1e-18);
                        (sum + weight * value, weights + weight)
                    },
                );
                sum / weights
            };
            let mut levels_db = vec![None; strikes.len()];
            members.iter().for_each(|member| levels_db[member.0] = Some(of(member).level_db));
            found.push(Common {
                frequency: mean(|mode| (mode.frequency, mode.uncertainty.frequency)),
                t60: mean(|mode| (mode.t60, mode.uncertainty.t60)),
                levels_db,
            });
        }
    }
    found.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    found
}
