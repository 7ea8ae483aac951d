//! What the knobs of a preset say of its sound, as tags: what moves the body, and how long it sounds.

use super::Preset;
use crate::params::Param;

/// T60 in seconds of the loudest mode, below which a sound is short, and above which it is long.
const LENGTHS: [f32; 2] = [0.5, 4.0];

/// Levels of what can move the body, and the tag of each that is above its least. A burst of noise is part of most strikes: it counts
/// where nothing else does.
const MOVERS: [(Param, &str); 6] = [
    (Param::MalletLevel, "struck"),
    (Param::PluckLevel, "pluck"),
    (Param::BowLevel, "bow"),
    (Param::BreathLevel, "breath"),
    (Param::NoiseHeld, "noise"),
    (Param::NoiseLevel, "noise"),
];

/// The tags of a preset that follow from its knobs.
pub(super) fn traits(preset: &Preset) -> impl Iterator<Item = &'static str> {
    let patch = &preset.patch;
    let is_on = |param: Param| patch.get(param) > param.info().min;
    let movers = MOVERS.iter().filter(|(param, _)| is_on(*param)).map(|(_, tag)| *tag);
    let mut movers: Vec<_> = movers.collect();
    if movers.len() > 1 && is_on(Param::NoiseLevel) {
        movers.pop();
    }
    let is_driven = [Param::BowLevel, Param::BreathLevel, Param::NoiseHeld].into_iter().any(is_on);
    let loudest = patch.modes.as_slice().iter().max_by(|a, b| a.level.abs().total_cmp(&b.level.abs()));
    // Roughly: neither damping by frequency nor key tracking is in it.
    let t60 = patch.get(Param::Decay) * loudest.map_or(1.0, |mode| mode.decay);
    let length = match () {
        () if is_driven => "sustained",
        () if t60 < LENGTHS[0] => "short",
        () if t60 > LENGTHS[1] => "long",
        () => "ringing",
    };
    movers.into_iter().chain([length])
}
