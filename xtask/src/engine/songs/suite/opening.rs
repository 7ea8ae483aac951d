//! Beats 0–16, in C with a raised fourth: bowls, glasses, a bell and a tam-tam, and a sitar that bends its string.

use super::form::{DANCE, OPENING};
use super::orchestra::Orchestra;
use crate::engine::songs::drum::orchestra as drum;
use crate::engine::songs::score::Part;
use sprung::engine::midi::controller;

/// A pluck: beat, length, key, velocity, and where its string is pulled to (beats after the pluck, semitones).
pub(super) type Pluck = (f64, f64, u8, u8, &'static [(f64, f64)]);

/// Slides between notes of the scale: each long note is left and reached on one string.
const SITAR: [Pluck; 10] = [
    (2.0, 2.4, 55, 78, &[(0.5, 0.0), (0.8, 2.0), (1.4, 2.0), (1.8, 0.0)]), // G, A, G
    (4.5, 0.6, 59, 66, &[]),
    (5.0, 2.3, 60, 84, &[(0.6, 0.0), (0.85, 2.0), (1.2, 2.0), (1.35, 4.0), (1.6, 4.0), (2.0, 2.0)]), // C, D, E, D
    (7.5, 0.6, 62, 70, &[]),
    (8.0, 2.0, 64, 92, &[(0.4, 0.0), (0.6, 2.0), (1.0, 2.0), (1.3, 3.0), (1.7, 3.0)]), // E, F♯, G
    (10.25, 0.5, 64, 72, &[]),
    (10.75, 1.6, 60, 80, &[(0.0, 2.0), (0.4, 2.0), (0.7, 0.0)]), // D falls to C
    (12.5, 0.3, 59, 74, &[]),
    (12.75, 0.3, 62, 80, &[]),
    (13.0, 3.4, 67, 104, &[(0.5, 0.0), (1.0, 4.0), (1.7, 4.0), (2.4, 2.0)]), // G rises to B and rests on A
];

/// Beat, key of the metal kit, velocity: C4 is 59, G4 78, A4 79, B4 80, D5 53.
const BOWLS: [(f64, u8, u8); 10] = [
    (0.0, 59, 118),
    (1.5, 78, 87),
    (3.0, 79, 74),
    (5.0, 59, 96),
    (6.5, 80, 81),
    (8.0, 78, 105),
    (9.5, 53, 78),
    (11.0, 79, 87),
    (12.0, 59, 102),
    (14.0, 53, 84),
];

/// Beat, key of the metal kit, velocity: 60–69 are two octaves of C, D, E, G, A.
const GLASSES: [(f64, u8, u8); 12] = [
    (1.0, 66, 78),
    (1.25, 67, 90),
    (1.5, 69, 70),
    (4.0, 68, 86),
    (4.5, 64, 74),
    (7.0, 65, 86),
    (7.25, 67, 78),
    (7.5, 68, 70),
    (9.0, 63, 94),
    (11.5, 69, 86),
    (11.75, 68, 78),
    (12.0, 66, 70),
];

pub(super) fn play(orchestra: &mut Orchestra) {
    let Orchestra { sitar, bowls, glasses, bells, drums, strings, harp, timpani, .. } = orchestra;
    pluck(sitar, OPENING, &SITAR);
    BOWLS.iter().for_each(|(at, key, velocity)| bowls.note(*at, 1.0, *key, *velocity));
    GLASSES.iter().for_each(|(at, key, velocity)| glasses.note(*at, 0.5, *key, *velocity));
    for (at, velocity) in [(0.0, 112), (8.0, 98)] {
        bells.note(at, 6.0, 48, velocity);
        drums.note(at, 1.0, drum::TAM_TAM, velocity - 28);
    }
    swell(strings);
    rise(harp, timpani);
    drums.note(DANCE - 1.5, 1.0, drum::BELL_TREE, 52);
}

/// Plucks strings and pulls them.
pub(super) fn pluck(part: &mut Part, start: f64, plucks: &[Pluck]) {
    for (beat, length, key, velocity, pulls) in plucks {
        let at = start + beat;
        part.bend_to(at, pulls.first().filter(|pull| pull.0 == 0.0).map_or(0.0, |pull| pull.1));
        part.note(at, *length, *key, *velocity);
        for pair in pulls.windows(2) {
            part.bend((at + pair[0].0, pair[0].1), (at + pair[1].0, pair[1].1));
        }
    }
}

/// A quiet fifth that grows louder, then a chord on the fifth degree of A minor.
fn swell(strings: &mut Part) {
    strings.ramp(controller::EXPRESSION, (6.0, 24), (13.0, 66));
    strings.ramp(controller::EXPRESSION, (13.0, 66), (DANCE, 108));
    strings.chord(6.0, 6.9, &[48, 55], 72);
    strings.chord(13.0, 2.9, &[52, 59, 62, 67], 80);
}

/// The harp's glissando, and a roll of the timpani whose pitch rises.
fn rise(harp: &mut Part, timpani: &mut Part) {
    const SCALE: [u8; 7] = [0, 2, 4, 6, 7, 9, 11];
    let keys = (3..7u8).flat_map(|octave| SCALE.map(|step| 12 * octave + step)).filter(|key| (40..=81).contains(key));
    for (n, key) in keys.enumerate() {
        harp.note(DANCE - 2.0 + n as f64 * 0.08, 1.0, key, 36 + n as u8);
    }
    timpani.roll((12.0, 22), (DANCE, 92), 8.0, 45);
    timpani.bend((12.0, -5.0), (DANCE - 0.25, 0.0));
}
