//! Gains from parameters, modulation and controllers, and the largest output gain of a case.

use super::case::Case;
use libm::sqrt;
use sprung::engine::{Event, EventKind, Expression};
use sprung::params::{PARAMS, Param};
use sprung::patch::Patch;
use sprung::units::gain_from_db;
use std::f64::consts::SQRT_2;

/// Amplitudes, left and right.
pub(crate) type Sides = [f64; 2];

/// The largest possible output gain for each side: each factor at its highest value in the case.
pub(crate) fn most_gain<'a>(
    case: &Case,
    patch: &Patch,
    ensemble: bool,
    events: impl Iterator<Item = &'a Event>,
) -> Sides {
    let mut levels = vec![patch.get(Param::Gain)];
    let mut pans = vec![patch.get(Param::Pan)];
    let (mut level_offsets, mut pan_offsets) = (vec![0.0], vec![0.0]);
    // A route to the gain can move it all the way, since events can change its amount.
    let mut patches = std::iter::once(patch).chain(&case.programs);
    if patches.any(|patch| patch.routes.iter().any(|(_, route)| route.destination == Param::Gain)) {
        level_offsets.push(1.0);
    }
    let mut volume = 1.0_f32;
    let mut positions = vec![0.5_f32];
    // The highest values on channels that can be masters, and on all channels.
    let (mut masters, mut channels, mut zones) = (vec![0.5_f32], vec![0.5_f32], false);
    for event in events {
        match event.kind {
            EventKind::Param { param: Param::Gain, value } => levels.push(Param::Gain.info().clamp(value)),
            EventKind::Param { param: Param::Pan, value } => pans.push(Param::Pan.info().clamp(value)),
            EventKind::Modulate { param: Param::Gain, offset, .. } => level_offsets.push(finite(offset)),
            EventKind::Modulate { param: Param::Pan, offset, .. } => pan_offsets.push(finite(offset)),
            EventKind::Program(number) if ensemble => {
                if let Some(patch) = case.programs.get(usize::from(number)) {
                    levels.push(patch.get(Param::Gain));
                    pans.push(patch.get(Param::Pan));
                }
            }
            EventKind::Express { expression: Expression::Volume, value, .. } => {
                volume = volume.max(finite(value).clamp(0.0, 4.0));
            }
            EventKind::Express { expression: Expression::Pan, value, .. } => {
                positions.push(finite(value).clamp(-1.0, 1.0) * 0.5 + 0.5);
            }
            EventKind::Control { controller: 10, value } => {
                let position = ((unit(value) * 127.0 - 1.0) / 126.0).clamp(0.0, 1.0);
                channels.push(position);
                if matches!(event.channel & 15, 0 | 15) {
                    masters.push(position);
                }
            }
            EventKind::Control { controller: 6, .. } => zones = true,
            _ => {}
        }
    }
    if !zones {
        masters = vec![0.5];
    }
    let most = |values: &[f32]| values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let least = |values: &[f32]| values.iter().copied().fold(f32::INFINITY, f32::min);
    let level = modulated(most(&levels), Param::Gain, most(&level_offsets));
    let pan_ends = [
        modulated(least(&pans), Param::Pan, least(&pan_offsets)),
        modulated(most(&pans), Param::Pan, most(&pan_offsets)),
    ];
    let pans = pan_ends.map(|pan| pan * 0.005 + 0.5);
    let gain = gain_from_db(level.into()) * f64::from(volume);
    [0, 1].map(|side| {
        let widest = |positions: &[f32]| {
            positions.iter().map(|position| pan_gains(f64::from(*position))[side]).fold(0.0, f64::max)
        };
        gain * widest(&pans) * widest(&positions) * widest(&channels) * widest(&masters)
    })
}

/// Constant-power gains of a position from 0 (left) to 1 (right).
pub(crate) fn pan_gains(position: f64) -> Sides {
    [1.0 - position, position].map(|share| SQRT_2 * sqrt(share.max(0.0)))
}

pub(crate) fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}

pub(crate) fn unit(value: f32) -> f32 {
    finite(value).clamp(0.0, 1.0)
}

/// A parameter's value, moved by an offset of the knob position.
pub(crate) fn modulated(value: f32, param: Param, offset: f32) -> f32 {
    let info = &PARAMS[param as usize];
    let offset = offset.clamp(-1.0, 1.0);
    if offset == 0.0 { value } else { info.denormalise(info.normalise(value) + f64::from(offset)) }
}
