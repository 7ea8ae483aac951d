//! Finds modes that are heard as one partial: split pairs, and decays in two stages.

use super::mode::{Group, Kind, Mode};

/// Bandwidth in Hz of a mode with a T60 of 1 s, at half its power: ln 1000 / π.
const BANDWIDTH: f64 = 2.199;
/// Ratio of T60s above which a decay has two stages.
const STAGES: f64 = 2.0;
/// Largest distance of a pair, in bandwidths of the wider mode (at least 2 Hz) and in Hz.
const NEAR: f64 = 6.0;
const NEAR_HZ: f64 = 12.0;
/// Largest difference of the levels of a pair.
const PAIR_DB: f64 = 40.0;
/// Range in dB by which the fast stage of a decay is louder than the slow one at the onset.
const LEAST_LEAD: f64 = -6.0;
const MOST_LEAD: f64 = 50.0;
/// Standard deviations above which two values differ.
const DEVIATIONS: f64 = 4.0;

/// Finds the groups in modes of rising frequency.
pub(super) fn groups(modes: &[Mode]) -> Vec<Group> {
    let mut found = Vec::new();
    let mut first = 0;
    while first + 1 < modes.len() {
        let (a, b) = (&modes[first], &modes[first + 1]);
        let kind = kind(a, b);
        match kind {
            Some(kind) => {
                found.push(Group { kind, modes: vec![first, first + 1] });
                first += 2;
            }
            None => first += 1,
        }
    }
    found
}

/// The kind of group that two neighbours form, if any.
fn kind(a: &Mode, b: &Mode) -> Option<Kind> {
    let (fast, slow) = if a.t60 < b.t60 { (a, b) } else { (b, a) };
    let (wide, narrow) = (BANDWIDTH / fast.t60, BANDWIDTH / slow.t60);
    let distance = b.frequency - a.frequency;
    let deviation = |mode: &Mode| mode.uncertainty.t60 / mode.t60;
    let ratio = slow.t60 / fast.t60;
    let differs = ratio - 1.0 > DEVIATIONS * ratio * (deviation(fast) + deviation(slow));
    let decibels = fast.level_db - slow.level_db;
    // A short mode beside a long one is a stage of its decay only if it has the same frequency and is heard first.
    let stages =
        distance < 0.5 * wide && distance < narrow + deviated(a, b) && (LEAST_LEAD..MOST_LEAD).contains(&decibels);
    if ratio >= STAGES {
        (stages && differs).then_some(Kind::TwoStageDecay)
    } else {
        (distance < (NEAR * wide).clamp(2.0, NEAR_HZ) && decibels.abs() < PAIR_DB).then_some(Kind::SplitPair)
    }
}

/// Distance in Hz below which two frequencies are the same.
fn deviated(a: &Mode, b: &Mode) -> f64 {
    DEVIATIONS * (a.uncertainty.frequency + b.uncertainty.frequency)
}
