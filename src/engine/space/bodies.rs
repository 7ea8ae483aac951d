//! The bodies of spaces and of sympathetic strings, as tables of modes that all synths share.
//!
//! Turning a knob retunes a body or loads another table; it computes no modes. This happens on the audio thread, at the
//! resonator's control ticks, so a song that changes the size has the same bits everywhere. While sound passes, a
//! retuned body continues at its new pitch, and its work is divided into the ticks of a block; another body starts when
//! the previous one has faded out, after 20 ms: it is laid out in its first block, before it sounds. (Laid out at once, it took half of
//! the time of a host's block of 64 frames.) One that was set in silence is laid out slice by slice in the silence that follows; what
//! the first sound finds undone is done at once, since that must be heard from its first frame on.
//!
//! Rejected: making bodies with the sound and handing them over. A sound does not know the sample rate, each channel
//! would need a state to be handed over with it, and a knob would need a thread that follows it. The price: a body has
//! the same number of masses at every size, so the modes of a room of twice the size end at 5 kHz.

use crate::dsp::space::{Material, ModeSet, Plate, Room, Spring, Strings};
use crate::params::{Space, SpaceMaterial, StringsTuning};
use crate::units::frequency_from_key;
use std::sync::LazyLock;

/// The modes of each body at its reference size, computed when a synth first reserves room for bodies.
///
/// A body of another size or material has all its frequencies multiplied by one ratio. So the tables never change, and
/// changing a knob does not need a new table.
#[derive(Debug)]
pub(super) struct Bodies {
    plate: ModeSet,
    spring: ModeSet,
    room: ModeSet,
    chromatic: ModeSet,
    major: ModeSet,
    minor: ModeSet,
    fifths: ModeSet,
}

/// Keys of the strings.
const MAJOR: [u8; 8] = [36, 43, 48, 52, 55, 60, 64, 67];
const MINOR: [u8; 8] = [36, 43, 48, 51, 55, 60, 63, 67];
const FIFTHS: [u8; 6] = [36, 43, 50, 57, 64, 71];

impl Bodies {
    /// The shared instance. The first call creates it, which takes some 10 ms, so do not make it on the audio thread.
    pub(super) fn shared() -> &'static Self {
        static SHARED: LazyLock<Bodies> = LazyLock::new(Bodies::new);
        &SHARED
    }

    fn new() -> Self {
        let strings = |keys: &mut dyn Iterator<Item = u8>| {
            Strings::new(keys.map(|key| frequency_from_key(key.into(), 440.0))).modes()
        };
        Self {
            plate: Plate::default().modes(),
            spring: Spring::default().modes(),
            room: Room::default().modes(),
            chromatic: strings(&mut (36..60)),
            major: strings(&mut MAJOR.into_iter()),
            minor: strings(&mut MINOR.into_iter()),
            fifths: strings(&mut FIFTHS.into_iter()),
        }
    }

    /// The largest number of masses of a space, and that of strings.
    pub(super) fn most(&self) -> [usize; 2] {
        let most = |sets: &[&ModeSet]| sets.iter().map(|modes| modes.len()).max().unwrap_or(0);
        [
            most(&[&self.plate, &self.spring, &self.room]),
            most(&[&self.chromatic, &self.major, &self.minor, &self.fifths]),
        ]
    }

    /// The modes of a space. Real-time safe.
    pub(super) fn of_space(&'static self, space: Space) -> Option<&'static ModeSet> {
        match space {
            Space::None => None,
            Space::Plate => Some(&self.plate),
            Space::Spring => Some(&self.spring),
            Space::Room => Some(&self.room),
        }
    }

    /// The modes of strings. Real-time safe.
    pub(super) fn of_strings(&'static self, tuning: StringsTuning) -> &'static ModeSet {
        match tuning {
            StringsTuning::Chromatic => &self.chromatic,
            StringsTuning::Major => &self.major,
            StringsTuning::Minor => &self.minor,
            StringsTuning::Fifths => &self.fifths,
        }
    }
}

/// Frequency ratio of a space with a size (1 is the reference) and a material to the modes in its table. Real-time safe.
///
/// Plate of constant thickness: inverse to the area, and proportional to the stiffness of a sheet
/// ([`Material::plate_stiffness`]). Spring tank scaled in all dimensions: inverse to its size, and proportional to the speed
/// of waves in the wire ([`Material::bar_speed`]). Room: inverse to its size.
pub(super) fn pitch(space: Space, size: f64, material: SpaceMaterial) -> f64 {
    let material = match material {
        SpaceMaterial::Steel => Material::STEEL,
        SpaceMaterial::Aluminium => Material::ALUMINIUM,
        SpaceMaterial::Gold => Material::GOLD,
        SpaceMaterial::Bronze => Material::BRONZE,
        SpaceMaterial::Glass => Material::GLASS,
    };
    match space {
        Space::None | Space::Room => 1.0 / size,
        Space::Plate => material.plate_stiffness(1.0) / Material::STEEL.plate_stiffness(1.0) / (size * size),
        Space::Spring => material.bar_speed() / Material::STEEL.bar_speed() / size,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_materials_are_those_of_bodies_made_so() {
        let bodies = Bodies::shared();
        let lowest = |modes: &ModeSet| modes.modes()[0].frequency;
        let pitch = |space, size, material| pitch(space, size, material) * lowest(bodies.of_space(space).unwrap());
        let gold = Plate { length: 1.0, width: 0.5, material: Material::GOLD, ..Plate::default() };
        let close = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found}, {expected}");
        close(pitch(Space::Plate, 0.5, SpaceMaterial::Gold), lowest(&gold.modes()));
        let room = Room { size: Room::default().size.map(|side| 1.5 * side), ..Room::default() };
        close(pitch(Space::Room, 1.5, SpaceMaterial::Steel), lowest(&room.modes()));
        let own = Spring::default();
        let large = Spring {
            wires: own.wires.map(|wire| 2.0 * wire),
            wire_radius: 2.0 * own.wire_radius,
            coil_radius: 2.0 * own.coil_radius,
            material: Material::BRONZE,
            ..own
        };
        let transition = super::pitch(Space::Spring, 2.0, SpaceMaterial::Bronze) * own.transition_frequency();
        close(transition, large.transition_frequency());
        assert_eq!(bodies.of_strings(StringsTuning::Chromatic).modes()[0].frequency, {
            let c2 = frequency_from_key(36.0, 440.0);
            c2 * libm::sqrt(1.0 + Strings::new([c2]).stiffness)
        });
    }
}
