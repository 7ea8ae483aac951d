//! What the knobs of a preset say of its sound, as tags: what moves the body, and how long it sounds.

use super::Preset;
use super::body::body_of_modes;
use super::pair::pair_of_modes;
use crate::params::Param;
use crate::patch::Mode;

/// T60 in seconds of the mode with the most energy over its time, below which a sound is short, and above which it is long.
const LENGTHS: [f32; 2] = [0.5, 4.0];

/// Levels of what strikes the body and of what drives it while a key is held, and the tag of each that is above its least.
const STRIKES: [(Param, &str); 2] = [(Param::MalletLevel, "struck"), (Param::PluckLevel, "pluck")];
const DRIVERS: [(Param, &str); 3] =
    [(Param::BowLevel, "bow"), (Param::BreathLevel, "breath"), (Param::NoiseHeld, "noise")];
/// A burst of noise is part of most strikes: it counts where nothing else does.
const BURST: (Param, &str) = (Param::NoiseLevel, "noise");

/// Materials, the usual one first, and the tags of what is made of them.
const MATERIALS: [(&[&str], &str); 3] = [
    (&["rosewood", "maple", "spruce"], "wood"),
    (&["steel", "aluminium", "brass", "bronze", "wire", "snare_wire"], "metal"),
    (&["glass"], "glass"),
];

/// The tags of a preset that was made from another, without those which were true of that and are not any more.
pub(super) fn true_tags(preset: &Preset, other: &Preset) -> Vec<String> {
    let ([now, before], [new_material, old_material]) = ([preset, other].map(traits), [preset, other].map(material));
    let is_material = |tag: &str| MATERIALS.iter().any(|(_, material)| *material == tag);
    let mut tags = Vec::new();
    for tag in preset.tags.iter().map(String::as_str) {
        let tag = match new_material {
            Some(new) if is_material(tag) && new_material != old_material => new,
            _ if before.contains(&tag) && !now.contains(&tag) => continue,
            _ => tag,
        };
        if !tags.iter().any(|other| other == tag) {
            tags.push(tag.to_owned());
        }
    }
    tags
}

/// The usual material, by its name, of what has one of the tags of materials.
pub fn tagged_material(tags: &[String]) -> Option<&'static str> {
    MATERIALS.iter().find(|(_, tag)| tags.iter().any(|own| own == tag)).map(|(ids, _)| ids[0])
}

/// The tag of what a preset's body is made of, if it has a body.
fn material(preset: &Preset) -> Option<&'static str> {
    let modes = &preset.patch.modes;
    let id = body_of_modes(modes).or_else(|| pair_of_modes(modes).map(|pair| pair.first))?.material.id;
    MATERIALS.iter().find(|(ids, _)| ids.contains(&id)).map(|(_, tag)| *tag)
}

/// The tags of a preset that follow from its knobs.
pub(super) fn traits(preset: &Preset) -> Vec<&'static str> {
    let patch = &preset.patch;
    let is_on = |(param, _): &(Param, _)| patch.get(*param) > param.info().min;
    let is_driven = DRIVERS.iter().any(is_on);
    let mut tags: Vec<_> = STRIKES.into_iter().chain(DRIVERS).filter(is_on).map(|(_, tag)| tag).collect();
    if tags.is_empty() && is_on(&BURST) {
        tags.push(BURST.1);
    }
    let energy = |mode: &Mode| mode.level * mode.level * mode.decay;
    let loudest = patch.modes.as_slice().iter().max_by(|a, b| energy(a).total_cmp(&energy(b)));
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
