//! The parts of the suite: the sound, volume, pan position and reverb send of each.

use crate::engine::songs::score::Part;
use sprung::engine::midi::controller;

/// Kits of Roland's GS.
const ORCHESTRA_KIT: u8 = 49;
const METAL_KIT: u8 = 57;

/// Semitones that bring the metal kit's bowls to C, D, G, A and B, and its glasses to the pentatonic scale on C.
const BOWLS_BEND: f64 = 0.09;
const GLASSES_BEND: f64 = -3.07;

pub(super) struct Orchestra {
    pub(super) drums: Part,
    pub(super) sitar: Part,
    pub(super) vibraphone: Part,
    pub(super) marimba: Part,
    pub(super) bass: Part,
    pub(super) harp: Part,
    pub(super) bells: Part,
    pub(super) timpani: Part,
    pub(super) glockenspiel: Part,
    pub(super) strings: Part,
    pub(super) bowls: Part,
    pub(super) glasses: Part,
    pub(super) piano: Part,
    pub(super) koto: Part,
    pub(super) kalimba: Part,
    pub(super) guitar: Part,
}

impl Orchestra {
    pub(super) fn seated() -> Result<Self, String> {
        let mut orchestra = Self {
            drums: Part::kit("Percussion", 9, ORCHESTRA_KIT, 103).send(60).loosen(0.012, 8.0),
            sitar: Part::new("Sitar", 0, "Sitar", 119, 56)?.send(90),
            vibraphone: Part::new("Vibraphone", 1, "Vibraphone", 100, 86)?.send(80).loosen(0.01, 6.0),
            marimba: Part::new("Marimba", 2, "Marimba", 117, 30)?.send(45).loosen(0.01, 8.0),
            bass: Part::new("Bass", 3, "Upright Bass", 111, 64)?.send(20),
            harp: Part::new("Harp", 4, "Harp", 90, 20)?.send(85),
            bells: Part::new("Tubular Bells", 5, "Tubular Bells", 113, 96)?.send(110),
            timpani: Part::new("Timpani", 6, "Timpani", 94, 78)?.send(70),
            glockenspiel: Part::new("Glockenspiel", 7, "Glockenspiel", 88, 104)?.send(90),
            strings: Part::new("Strings", 8, "Strings", 90, 64)?.send(75),
            bowls: Part::kit("Bowls", 10, METAL_KIT, 119).send(100),
            glasses: Part::kit("Glasses", 11, METAL_KIT, 119).send(100),
            piano: Part::new("Piano", 12, "Grand Piano", 90, 50)?.send(55).loosen(0.006, 5.0),
            koto: Part::new("Koto", 13, "Koto", 107, 74)?.send(60),
            kalimba: Part::new("Kalimba", 14, "Kalimba", 105, 106)?.send(50).loosen(0.012, 9.0),
            guitar: Part::new("Guitar", 15, "Nylon Guitar", 111, 98)?.send(40).loosen(0.012, 9.0),
        };
        for part in [&mut orchestra.sitar, &mut orchestra.koto] {
            part.bend_range(5);
        }
        // The brightest strings are made a little darker.
        for part in [&mut orchestra.sitar, &mut orchestra.koto, &mut orchestra.strings] {
            part.control(0.0, controller::BRIGHTNESS, 44);
        }
        orchestra.timpani.bend_range(7);
        orchestra.glasses.bend_range(5);
        orchestra.bowls.bend_to(0.0, BOWLS_BEND);
        orchestra.glasses.bend_to(0.0, GLASSES_BEND);
        Ok(orchestra)
    }

    pub(super) fn into_parts(self) -> Vec<Part> {
        vec![
            self.drums,
            self.sitar,
            self.vibraphone,
            self.marimba,
            self.bass,
            self.harp,
            self.bells,
            self.timpani,
            self.glockenspiel,
            self.strings,
            self.bowls,
            self.glasses,
            self.piano,
            self.koto,
            self.kalimba,
            self.guitar,
        ]
    }
}
