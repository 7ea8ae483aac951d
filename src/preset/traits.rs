//! What the knobs of a preset say of its sound, as tags: what moves the body, and how long it sounds.

use super::Preset;
use crate::params::Param;

/// T60 in seconds of the loudest mode, below which a sound is short, and above which it is long.
const LENGTHS: [f32; 2] = [0.5, 4.0];

/// Levels of what strikes the body and of what drives it while a key is held, and the tag of each that is above its least.
const STRIKES: [(Param, &str); 2] = [(Param::MalletLevel, "struck"), (Param::PluckLevel, "pluck")];
const DRIVERS: [(Param, &str); 3] =
    [(Param::BowLevel, "bow"), (Param::BreathLevel, "breath"), (Param::NoiseHeld, "noise")];
/// A burst of noise is part of most strikes: it counts where nothing else does.
const BURST: (Param, &str) = (Param::NoiseLevel, "noise");

/// The tags of a preset that follow from its knobs.
pub(super) fn traits(preset: &Preset) -> Vec<&'static str> {
    let patch = &preset.patch;
    let is_on = |(param, _): &(Param, _)| patch.get(*param) > param.info().min;
    let is_driven = DRIVERS.iter().any(is_on);
    let mut tags: Vec<_> = STRIKES.into_iter().chain(DRIVERS).filter(is_on).map(|(_, tag)| tag).collect();
    if tags.is_empty() && is_on(&BURST) {
        tags.push(BURST.1);
    }
    let loudest = patch.modes.as_slice().iter().max_by(|a, b| a.level.abs().total_cmp(&b.level.abs()));
    // Roughly: neither damping by frequency nor key tracking is in it.
    let t60 = patch.get(Param::Decay) * loudest.map_or(1.0, |mode| mode.decay);
    tags.push(match () {
        () if is_driven => "sustained",
        () if t60 < LENGTHS[0] => "short",
        () if t60 > LENGTHS[1] => "long",
        () => "ringing",
    });
    tags
}
