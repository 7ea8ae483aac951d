//! Beats 92–104, in C: the tutti dies away, and the opening's bowls return.

use super::form::{ECHO, END};
use super::opening::{Pluck, pluck};
use super::orchestra::Orchestra;
use crate::engine::songs::drum::orchestra as drum;
use sprung::engine::midi::controller;

/// The sitar's last phrases.
const SITAR: [Pluck; 4] = [
    (2.0, 1.9, 64, 86, &[(0.4, 0.0), (0.7, 3.0), (1.2, 3.0), (1.6, 0.0)]), // E, G, E
    (4.0, 0.6, 62, 72, &[]),
    (4.5, 2.4, 60, 82, &[(0.0, 2.0), (0.6, 2.0), (1.0, 0.0)]), // D falls to C
    (8.0, 4.0, 55, 74, &[(0.0, -3.0), (0.4, -3.0), (1.2, 0.0)]), // E rises to G
];

/// Beat, key of the metal kit, velocity: C4 is 59, G4 78, A4 79, B4 80, D5 53.
const BOWLS: [(f64, u8, u8); 6] =
    [(0.0, 59, 108), (1.5, 79, 84), (4.0, 78, 90), (5.5, 80, 71), (8.0, 59, 93), (9.5, 53, 68)];

/// Beat, key of the metal kit, velocity: falling through two octaves of C, A, G, E, D.
const GLASSES: [(f64, u8, u8); 6] =
    [(3.0, 69, 92), (3.5, 68, 88), (4.0, 67, 84), (7.0, 67, 80), (7.5, 66, 76), (8.0, 65, 71)];

pub(super) fn play(orchestra: &mut Orchestra) -> Result<(), String> {
    let Orchestra { sitar, bowls, glasses, bells, drums, vibraphone, piano, harp, .. } = orchestra;
    pluck(sitar, ECHO, &SITAR);
    BOWLS.iter().for_each(|(at, key, velocity)| bowls.note(ECHO + at, 1.0, *key, *velocity));
    GLASSES.iter().for_each(|(at, key, velocity)| glasses.note(ECHO + at, 0.5, *key, *velocity));
    bells.note(ECHO, 6.0, 48, 104);
    bells.note(END - 4.0, 6.0, 48, 92);
    drums.note(END - 4.0, 4.0, drum::TAM_TAM, 64);
    // F with the raised fourth, and C with the ninth.
    vibraphone.pedal(ECHO + 4.0, 3.9);
    vibraphone.pedal(END - 4.0, 5.0);
    vibraphone.phrase(ECHO + 4.0, 1.0, "F4+A4+E5@70*2 C5@60 B4@64 - E4@66*0.25 G4@66*0.25 D5@68*0.5 E5@62*2")?;
    piano.control(ECHO + 3.5, controller::EXPRESSION, 100);
    piano.pedal(ECHO + 4.0, 3.9);
    piano.pedal(END - 4.0, 5.0);
    piano.phrase(ECHO + 4.0, 1.0, "F2+C3@62*2 A3@52 E4@54 C2+G2@60*2 E4@50 G4@46")?;
    for (n, key) in [48, 55, 60, 64, 67, 74, 79, 84].into_iter().enumerate() {
        harp.note(END - 2.0 + 0.14 * n as f64, 2.0, key, 58 - 2 * n as u8);
    }
    Ok(())
}
