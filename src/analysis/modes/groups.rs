//! Modes that are heard as one partial: split pairs, and decays in two stages.

use super::mode::{Group, Kind, Mode};

/// Bandwidth in Hz of a mode with a T60 of 1 s, at half its power: ln 1000 / π.
const BANDWIDTH: f64 = 2.199;
/// Ratio of T60s from which on a decay has two stages.
const STAGES: f64 = 2.0;
/// Distance of a pair, in bandwidths of the wider mode and in Hz at most.
const NEAR: f64 = 6.0;
const NEAR_HZ: f64 = 12.0;

/// Finds the groups in modes of rising frequency.
pub(super) fn groups(modes: &[Mode]) -> Vec<Group> {
    let mut found = Vec::new();
    let mut first = 0;
    while first + 1 < modes.len() {
        let (a, b) = (&modes[first], &modes[first + 1]);
        let bandwidth = (BANDWIDTH / a.t60).max(BANDWIDTH / b.t60);
        let distance = b.frequency - a.frequency;
        let stages = (a.t60 / b.t60).max(b.t60 / a.t60) >= STAGES;
        let kind = if distance < 0.5 * bandwidth && stages {
            Some(Kind::TwoStageDecay)
        } else if distance < (NEAR * bandwidth).clamp(2.0, NEAR_HZ) {
            Some(Kind::SplitPair)
        } else {
            None
        };
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
