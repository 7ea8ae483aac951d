//! Random variations of a sound: from parts of factory sounds, or by small changes. Locked sections stay as they are.

use crate::editor::theme::PADDING;
use egui::{ScrollArea, Ui};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::{PARAMS, Param, ParamInfo, Unit};
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::units::db_from_gain;
use std::collections::BTreeSet;

/// Sections that define how the instrument is played, or that belong to routes: they are never varied.
const FIXED: [&str; 6] = ["Input", "Macros", "Routes", "Voices", "Control", "Output"];
/// Mean level below which a sound counts as silent, in decibels.
const SILENCE: f64 = -70.0;
/// Number of attempts before giving up.
const TRIES: u64 = 8;

/// How a sound is varied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Variation {
    /// Each section is replaced by that of a factory sound.
    Randomise,
    /// Some parameters move a little.
    Mutate,
}

/// Pseudorandom numbers, the same for each seed (Numerical Recipes, 7.1).
struct Numbers(u64);

impl Numbers {
    /// From 0 to below 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }
}

/// The sections that can be varied.
pub(super) fn sections() -> impl Iterator<Item = &'static [ParamInfo]> {
    PARAMS.chunk_by(|a, b| a.section == b.section).filter(|rows| !FIXED.contains(&rows[0].section))
}

impl Variation {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Randomise => "Randomise",
            Self::Mutate => "Mutate a little",
        }
    }

    /// A variation of a preset, about equally loud on its home key. None if all attempts are silent. It renders notes:
    /// not for the audio thread.
    pub(super) fn of(self, preset: &Preset, seed: u64, locked: &BTreeSet<&'static str>) -> Option<Preset> {
        let home = preset.guide.home;
        let before = level(&preset.patch, home);
        (0..TRIES).find_map(|number| {
            let mut numbers =
                Numbers(seed.wrapping_mul(TRIES).wrapping_add(number).wrapping_mul(0x9E37_79B9_7F4A_7C15));
            numbers.next();
            let mut varied = preset.clone();
            for section in sections().filter(|section| !locked.contains(section[0].section)) {
                match self {
                    Self::Randomise => take(section, &mut varied.patch, &mut numbers),
                    Self::Mutate => mutate(section, &mut varied.patch, &mut numbers),
                }
            }
            let after = level(&varied.patch, home);
            if after < SILENCE {
                return None;
            }
            if before >= SILENCE {
                let gain = Param::Gain.info();
                let wanted = varied.patch.get(Param::Gain) + (before - after) as f32;
                varied.patch.set(Param::Gain, gain.clamp(wanted));
            }
            Some(varied)
        })
    }
}

/// Copies a section from a random factory sound; the body's section comes with the modes.
fn take(section: &[ParamInfo], patch: &mut Patch, numbers: &mut Numbers) {
    let all = Preset::factory();
    let source = &all[((numbers.next() * all.len() as f64) as usize).min(all.len() - 1)].patch;
    for info in section {
        patch.set(info.param, source.get(info.param));
    }
    if section[0].section == "Body" {
        patch.modes = source.modes.clone();
    }
}

/// Moves about a third of a section's continuous parameters by up to a tenth of their travel. A parameter at its lowest
/// value, such as the level of an exciter that is off, stays there.
fn mutate(section: &[ParamInfo], patch: &mut Patch, numbers: &mut Numbers) {
    for info in section {
        let (chance, by) = (numbers.next(), numbers.next() - numbers.next());
        let value = patch.get(info.param);
        let is_quantity = !matches!(info.unit, Unit::Count | Unit::Choice) && info.is_modulatable();
        if is_quantity && chance < 1.0 / 3.0 && value > info.min {
            patch.set(info.param, info.denormalise((info.normalise(value) + 0.1 * by).clamp(0.0, 1.0)));
        }
    }
}

/// The mean level of the first half second of a struck note, in decibels.
fn level(patch: &Patch, key: u8) -> f64 {
    const FRAMES: usize = 12_000;
    let mut synth = Synth::new(2.0 * FRAMES as f64, 0);
    synth.set_patch(patch);
    let on = EventKind::NoteOn { key, detune: 0.0, velocity: 0.8, id: None };
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    synth.process(&[Event { frame: 0, channel: 0, kind: on }], &mut left, &mut right);
    let energy: f64 = left.iter().chain(&right).map(|sample| f64::from(*sample) * f64::from(*sample)).sum();
    db_from_gain((energy / (2 * FRAMES) as f64).max(1e-20)) / 2.0
}

/// A request made with the menu of variations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum VariationRequest {
    Vary(Variation),
    /// Lock a section, or unlock it if it is locked.
    Lock(&'static str),
}

/// The menu of variations and locks.
pub(super) fn menu(ui: &mut Ui, locked: &BTreeSet<&'static str>) -> Option<VariationRequest> {
    let mut asked = None;
    for variation in [Variation::Mutate, Variation::Randomise] {
        if ui.button(variation.name()).clicked() {
            asked = Some(VariationRequest::Vary(variation));
            ui.close();
        }
    }
    ui.separator();
    ui.label("Locked sections stay as they are");
    // In a small window, not all are seen at once.
    let room = ui.ctx().content_rect().bottom() - ui.cursor().top() - 2.0 * PADDING;
    ScrollArea::vertical().max_height(room).show(ui, |ui| {
        for section in sections().map(|section| section[0].section) {
            let mut is_locked = locked.contains(section);
            if ui.checkbox(&mut is_locked, format!("Lock {section}")).clicked() {
                asked = Some(VariationRequest::Lock(section));
            }
        }
    });
    asked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variations_stay_in_range_keep_what_is_locked_and_are_as_loud() {
        let preset = Preset::find("Marimba").unwrap();
        let locked = BTreeSet::from(["Noise", "Body"]);
        let before = level(&preset.patch, preset.guide.home);
        for variation in [Variation::Randomise, Variation::Mutate] {
            for seed in 0..4 {
                let varied = variation.of(preset, seed, &locked).unwrap();
                assert_eq!(Some(&varied), variation.of(preset, seed, &locked).as_ref(), "the same for a seed");
                assert_ne!(varied.patch.values, preset.patch.values, "{variation:?} {seed}");
                assert_eq!(varied.patch.modes, preset.patch.modes, "{variation:?} {seed}");
                for info in PARAMS.iter().filter(|info| info.param != Param::Gain) {
                    let value = varied.patch.get(info.param);
                    assert_eq!(info.check(value), Ok(value), "{variation:?} {seed}: {}", info.id);
                    if locked.contains(info.section) || FIXED.contains(&info.section) {
                        assert_eq!(value, preset.patch.get(info.param), "{variation:?} {seed}: {}", info.id);
                    }
                }
                let gain = Param::Gain.info();
                let set = varied.patch.get(Param::Gain);
                let after = level(&varied.patch, preset.guide.home);
                let is_at_end = set == gain.min || set == gain.max;
                assert!(is_at_end || (after - before).abs() < 3.0, "{variation:?} {seed}: {before} {after}");
            }
        }
    }
}
