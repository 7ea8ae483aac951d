//! The curves in the pictures of sections, as points: a mallet's force, bursts of noise, a sweep, an LFO.
//!
//! Time runs from 0 to 1, values from −1 to 1.

use egui::{Vec2, vec2};
use sprung::params::Shape;
use sprung::sound::contact_time;
use sprung::units::{ratio_from_semitones, semitones_from_ratio};
use std::f32::consts::TAU;
use std::f64::consts::{LN_2, LOG2_10};

/// Number of points of a curve.
const POINTS: usize = 40;
/// The duration that a mallet's picture shows, in seconds: longer contacts are cut off.
const CONTACT: f64 = 0.012;
/// Exponent of a mallet's mass in its contact time, by Hertz's law.
const MASS_POWER: f64 = 0.4;
/// How many halvings a fall by 60 dB has.
const HALVINGS: f64 = 3.0 * LOG2_10;
/// Fixed example values for LFO shapes with random values.
const CHANCE: [f32; 4] = [0.5, -0.8, 0.9, -0.3];

/// The force of a mallet: `u² (1 − u)²` over its contact, scaled to a peak of 1. The width is proportional to the
/// square root of the contact time, so that short contacts stay visible. For an impulse, which lasts one sample, a
/// vertical line.
pub(super) fn mallet(hardness: f64, mass: f64, is_impulse: bool) -> Vec<Vec2> {
    if is_impulse {
        return vec![vec2(0.0, 0.0), vec2(0.02, 0.0), vec2(0.02, 1.0), vec2(0.02, 0.0), vec2(1.0, 0.0)];
    }
    let seconds = contact_time(hardness) * ratio_from_semitones(MASS_POWER * semitones_from_ratio(mass));
    let width = (seconds / CONTACT).sqrt() as f32;
    let force = |share: f32| 16.0 * share * share * (1.0 - share) * (1.0 - share);
    let points = (0..=POINTS).map(|point| point as f32 / POINTS as f32);
    // A contact longer than the picture is cut off.
    let bump = points.map(|share| vec2(share * width, force(share))).filter(|point| point.x < 1.0);
    let end = vec2(1.0, force((1.0 / width).min(1.0)));
    bump.chain([end]).collect()
}

/// The envelope of bursts of noise: the times of attack and decay, the distance between bursts, the kind of decay (an
/// exponential one falls by 60 dB), and the number of bursts.
pub(super) fn noise([attack, time, spacing]: [f64; 3], is_exponential: bool, hits: u32) -> Vec<Vec2> {
    let total = attack + time + spacing * f64::from(hits - 1);
    let level = |since: f64| {
        let fallen = (since - attack) / time.max(1e-9);
        match fallen {
            ..0.0 => since / attack.max(1e-9),
            1.0.. => 0.0,
            _ if is_exponential => ratio_from_semitones(-12.0 * fallen * HALVINGS),
            _ => (1.0 - fallen) * (1.0 - fallen),
        }
    };
    let count = 4 * POINTS;
    (0..=count)
        .map(|point| {
            let now = total * point as f64 / count as f64;
            let hit = if hits > 1 { ((now / spacing) as u32).min(hits - 1) } else { 0 };
            vec2(point as f32 / count as f32, level(now - f64::from(hit) * spacing) as f32)
        })
        .collect()
}

/// A sweep to the note's pitch: its start relative to the note, in semitones, and its curve from −1 to 1.
pub(super) fn sweep(semitones: f64, curve: f64) -> Vec<Vec2> {
    let steepness = 8.0 * curve;
    let exp = |power: f64| ratio_from_semitones(12.0 * power / LN_2);
    let rest = |share: f64| {
        if steepness.abs() < 1e-3 {
            1.0 - share
        } else {
            (exp(-steepness * share) - exp(-steepness)) / (1.0 - exp(-steepness))
        }
    };
    let scale = semitones / semitones.abs().max(12.0);
    // The sweep takes the first two thirds; the note's pitch takes the rest.
    let points = (0..=POINTS).map(|point| point as f64 / POINTS as f64);
    let swept = points.map(|share| vec2(share as f32 * 0.67, (scale * rest(share)) as f32));
    swept.chain([vec2(1.0, 0.0)]).collect()
}

/// Two cycles of an LFO; `start` is its phase at the start, in cycles.
pub(super) fn oscillator(shape: Shape, start: f32) -> Vec<Vec2> {
    let value = |round: usize, phase: f32| match shape {
        Shape::Sine => Vec2::angled(TAU * phase).y,
        Shape::Triangle => 1.0 - (4.0 * if phase < 0.75 { phase } else { phase - 1.0 } - 1.0).abs(),
        Shape::Ramp => 2.0 * phase - 1.0,
        Shape::Square => 1.0_f32.copysign(0.5 - phase),
        Shape::Steps => CHANCE[round % CHANCE.len()],
        Shape::Drift => {
            let [from, to] = [0, 1].map(|next| CHANCE[(round + next) % CHANCE.len()]);
            from + (to - from) * (phase * phase * (3.0 - 2.0 * phase))
        }
    };
    let count = 4 * POINTS;
    (0..=count)
        .map(|point| {
            let cycles = start + 2.0 * point as f32 / count as f32;
            vec2(point as f32 / count as f32, value(cycles as usize, cycles.fract()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Choice as _;

    #[test]
    fn outlines_stay_in_their_picture_and_follow_their_values() {
        let mut all = vec![mallet(0.5, 1.0, true), sweep(0.0, 0.5)];
        all.extend([0.0, 0.7, 1.0].map(|hardness| mallet(hardness, 10.0, false)));
        all.extend([-1.0, 0.0, 1.0].map(|curve| sweep(-60.0, curve)));
        all.extend([1, 4].map(|hits| noise([0.01, 0.1, 0.02], hits > 1, hits)));
        all.extend(Shape::ALL.iter().map(|shape| oscillator(*shape, 0.9)));
        for points in &all {
            assert!(points.windows(2).all(|pair| pair[0].x <= pair[1].x), "{points:?}");
            assert!(points.iter().all(|point| (0.0..=1.0).contains(&point.x) && point.y.abs() <= 1.001), "{points:?}");
            assert_eq!(points.last().unwrap().x, 1.0);
        }
        let width = |hardness| {
            mallet(hardness, 1.0, false).iter().filter(|point| point.y > 0.0).map(|point| point.x).fold(0.0, f32::max)
        };
        assert!(width(0.2) > 2.0 * width(0.8), "a hard mallet touches shortly");
        let peaks =
            |hits| noise([0.0, 0.1, 0.05], true, hits).windows(2).filter(|pair| pair[1].y > pair[0].y + 0.3).count();
        assert_eq!((peaks(1), peaks(3)), (0, 2));
        assert_eq!(sweep(24.0, 0.5)[0].y, 1.0);
        assert!(sweep(24.0, 1.0)[10].y < sweep(24.0, -1.0)[10].y, "it falls fast and settles slowly");
    }
}
