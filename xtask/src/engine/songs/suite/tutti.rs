//! Beats 64–92, in C with a turn to A flat: all parts play, at full volume.

use super::form::{Chord, ECHO, TUTTI, bars};
use super::orchestra::Orchestra;
use crate::engine::songs::drum::{self, orchestra};
use crate::engine::songs::score::{BROKEN_CHORD, Part};
use sprung::engine::midi::controller;

const CHORDS: [Chord; 7] = [
    (36, [55, 60, 64, 67, 72]), // C
    (35, [55, 59, 62, 67, 74]), // G ⁄ B
    (33, [57, 60, 64, 69, 72]), // Am
    (41, [57, 60, 65, 69, 72]), // F
    (32, [56, 60, 63, 68, 72]), // A♭
    (34, [58, 62, 65, 70, 74]), // B♭
    (36, [55, 60, 64, 67, 76]), // C
];

/// The melody in quarters.
const MELODY: &str = "E5@112*2 G5@108 C6@112 B5@116*2 A5@106 G5@106 A5@112*1.5 G5@100*0.5 E5@108*2 F5@106 A5@110 C6@114*2 \
                      C6@116*2 Eb6@120*2 D6@118*2 F6@122*2 E6@124*4";

/// Keys of the bells, one or more a bar, that belong to melody and chord.
const BELLS: [&[(f64, u8)]; 7] = [
    &[(0.0, 64), (2.0, 67)],
    &[(0.0, 71)],
    &[(0.0, 69), (2.0, 64)],
    &[(0.0, 65), (2.0, 72)],
    &[(0.0, 72), (2.0, 75)],
    &[(0.0, 74), (2.0, 77)],
    &[(0.0, 76), (0.0, 60), (1.0, 72), (2.0, 67), (3.0, 60)],
];

/// The timpani's note in each bar.
const TIMPANI: [u8; 7] = [48, 47, 45, 41, 44, 46, 48];

pub(super) fn play(orchestra: &mut Orchestra) -> Result<(), String> {
    strings(&mut orchestra.strings)?;
    piano(&mut orchestra.piano)?;
    orchestra.glockenspiel.phrase(TUTTI, 1.0, MELODY)?;
    for (at, (root, _)) in bars(TUTTI, &CHORDS) {
        let root = if *root < 36 { root + 12 } else { *root };
        orchestra.bass.note(at, 2.8, root, 108);
        orchestra.bass.note(at + 3.0, 0.9, root, 96);
    }
    for ((at, _), strokes) in bars(TUTTI, &CHORDS).zip(BELLS) {
        strokes.iter().for_each(|(beat, key)| orchestra.bells.note(at + beat, 3.5, *key, 104));
    }
    harp(&mut orchestra.harp);
    marimba(&mut orchestra.marimba);
    vibraphone(&mut orchestra.vibraphone);
    timpani(&mut orchestra.timpani);
    drums(&mut orchestra.drums);
    Ok(())
}

/// The melody in octaves over the chords.
fn strings(part: &mut Part) -> Result<(), String> {
    part.ramp(controller::EXPRESSION, (TUTTI, 112), (TUTTI + 16.0, 127));
    part.phrase(TUTTI, 1.0, MELODY)?;
    bars(TUTTI, &CHORDS).for_each(|(at, (root, chord))| {
        part.note(at, 3.9, root + 12, 100);
        part.chord(at, 3.9, &chord[..4], 96);
    });
    part.ramp(controller::EXPRESSION, (ECHO - 3.0, 127), (ECHO - 0.2, 60));
    Ok(())
}

/// Low octaves, full chords, and the melody on top. The last chord is held by the pedal far into the echo.
fn piano(part: &mut Part) -> Result<(), String> {
    part.phrase(TUTTI, 1.0, MELODY)?;
    for (at, (root, chord)) in bars(TUTTI, &CHORDS) {
        part.pedal(at, if at == ECHO - 4.0 { 7.5 } else { 3.85 });
        let low = if *root < 36 { *root } else { root - 12 };
        part.chord(at, 2.0, &[low, low + 12], 112);
        part.chord(at + 1.0, 1.0, chord, 104);
        part.chord(at + 2.0, 1.0, &[root + 12, chord[1], chord[3]], 100);
        part.chord(at + 3.0, 1.0, chord, 106);
    }
    Ok(())
}

/// Waves of broken chords, six notes a beat.
fn harp(part: &mut Part) {
    for (at, (root, chord)) in bars(TUTTI, &CHORDS).take(6) {
        let (low, high) = (chord.map(|key| key - 12), chord.map(|key| key + 12));
        let wave: Vec<u8> = [root + 12].into_iter().chain(low).chain(*chord).chain(high).collect();
        let there_and_back = wave[..12].iter().chain(wave[1..13].iter().rev());
        for (n, key) in there_and_back.enumerate() {
            part.note(at + n as f64 / 6.0, 0.5, *key, 96);
        }
    }
}

/// Broken chords in sixteenths, with the same accents as in the dance.
fn marimba(part: &mut Part) {
    part.control(TUTTI, controller::EXPRESSION, 94);
    for (at, (_, chord)) in bars(TUTTI, &CHORDS).take(6) {
        for step in 0..16usize {
            let accent = if [0, 6, 12].contains(&step) { 112 } else { 84 };
            part.note(at + step as f64 * 0.25, 0.2, chord[BROKEN_CHORD[step % 8]] + 12 * u8::from(step >= 8), accent);
        }
    }
    part.roll((ECHO - 4.0, 100), (ECHO - 0.5, 40), 12.0, 72);
    part.roll((ECHO - 4.0, 96), (ECHO - 0.5, 38), 12.0, 67);
}

fn vibraphone(part: &mut Part) {
    for (at, (_, chord)) in bars(TUTTI, &CHORDS) {
        part.pedal(at, if at == ECHO - 4.0 { 7.5 } else { 3.85 });
        part.chord(at, 1.0, &chord.map(|key| key + 12), 96);
    }
}

/// Three strokes a bar, rolls into the fifth and the last bar, and the last bar's roll that fades.
fn timpani(part: &mut Part) {
    part.bend_to(TUTTI, 0.0);
    for ((at, _), key) in bars(TUTTI, &CHORDS).zip(TIMPANI) {
        part.note(at, 1.0, key, 110);
        part.note(at + 1.5, 0.5, key, 92);
        part.note(at + 2.0, 1.0, key, 108);
    }
    part.roll((TUTTI + 15.0, 60), (TUTTI + 16.0, 110), 8.0, 41);
    part.roll((TUTTI + 22.0, 60), (ECHO - 4.0, 110), 8.0, 46);
    part.roll((ECHO - 3.0, 96), (ECHO, 24), 8.0, 48);
}

fn drums(part: &mut Part) {
    for at in [TUTTI, TUTTI + 16.0, ECHO - 4.0] {
        part.note(at, 1.0, orchestra::CLASH, 104);
        part.note(at, 1.0, drum::DEEP_KICK, 106);
    }
    for at in [TUTTI + 8.0, TUTTI + 20.0] {
        part.note(at, 1.0, drum::KICK, 104);
        part.note(at, 1.0, drum::TRIANGLE, 90);
    }
    part.note(TUTTI + 16.0, 4.0, orchestra::GONG, 104);
    part.note(ECHO - 4.0, 4.0, orchestra::TAM_TAM, 122);
    for bar in 0..6u32 {
        part.sixteenths(TUTTI + 4.0 * f64::from(bar), 0.0, drum::SNARE, "6..3 4.34 6.34 4344");
    }
    part.roll((TUTTI + 22.0, 56), (ECHO - 4.0, 106), 8.0, drum::SNARE);
}
