//! Beats 16–64, in A minor: the marimba turns in threes and twos, and one part after another joins in.

use super::form::{Chord, DANCE, TUTTI, bars};
use super::orchestra::Orchestra;
use crate::engine::songs::drum;
use crate::engine::songs::score::Part;
use sprung::engine::midi::controller;

const CHORDS: [Chord; 12] = [
    (45, [57, 60, 64, 67, 71]), // Am9
    (45, [57, 60, 64, 67, 72]), // Am7
    (41, [57, 60, 64, 67, 72]), // Fmaj9
    (43, [59, 62, 64, 67, 71]), // G6
    (38, [57, 60, 64, 65, 69]), // Dm9
    (40, [55, 60, 64, 67, 72]), // C ⁄ E
    (41, [57, 60, 64, 69, 71]), // Fmaj7 with the raised fourth
    (40, [56, 62, 64, 68, 71]), // E7
    (41, [57, 60, 64, 67, 72]), // Fmaj9
    (43, [59, 62, 67, 69, 74]), // G with the ninth
    (45, [60, 64, 67, 69, 76]), // Am7
    (43, [60, 62, 65, 69, 74]), // G9, its fourth held against the third
];

/// Steps of an eighth, from bar 3 on, four bars a line.
const MELODY: [&str; 3] = [
    "A4@88*3 C5@78 E5@92*2 D5@80*2 B4@86*3 D5@76 E5@90*4 F5@96*3 E5@82 D5@86*2 A4@80*2 G5@100*3 E5@84 C5@86*2 D5@90*2",
    "E5@98*2 B4@84*2 C5@88*2 A4@82*2 B4@92*2 C5@84 D5@88 B4@96*4 C5@98*2 E5@92*2 G5@104*3 A5@96 B5@110*3 A5@96 G5@98*2 D5@90*2",
    "E5@106*2 G5@102*2 A5@108*2 C6@112*2 D6@118*4 C6@108*2 A5@104*2",
];

/// Long notes of the melody that are pulled up from a tone or a semitone below: beat after the dance's start, semitones.
const PULLS: [(f64, f64); 6] = [(8.0, -2.0), (14.0, -2.0), (16.0, -1.0), (20.0, -2.0), (34.0, -2.0), (44.0, -2.0)];

pub(super) fn play(orchestra: &mut Orchestra) -> Result<(), String> {
    marimba(&mut orchestra.marimba);
    bass(&mut orchestra.bass);
    koto(&mut orchestra.koto)?;
    orchestra.glockenspiel.phrase(DANCE + 40.0, 0.5, MELODY[2])?;
    guitar(&mut orchestra.guitar);
    kalimba(&mut orchestra.kalimba);
    vibraphone(&mut orchestra.vibraphone);
    piano(&mut orchestra.piano);
    strings(&mut orchestra.strings);
    drums(&mut orchestra.drums);
    timpani(&mut orchestra.timpani);
    Ok(())
}

fn from_bar(bar: usize) -> impl Iterator<Item = (f64, &'static Chord)> {
    bars(DANCE, &CHORDS).skip(bar - 1)
}

/// Broken chords in eighths, with accents in groups of three, three and two.
fn marimba(part: &mut Part) {
    part.ramp(controller::EXPRESSION, (DANCE, 84), (DANCE + 16.0, 104));
    part.ramp(controller::EXPRESSION, (DANCE + 32.0, 104), (TUTTI, 127));
    for (at, (_, chord)) in from_bar(1) {
        part.broken_chord(at, chord);
    }
}

/// Roots in the marimba's groups.
fn bass(part: &mut Part) {
    for (at, (root, _)) in from_bar(1) {
        part.note(at, 1.4, *root, 100);
        part.note(at + 1.5, 0.9, *root, 82);
        part.note(at + 2.5, 0.45, root + 12, 70);
        part.note(at + 3.0, 0.9, *root, 88);
    }
}

/// The melody, which swells and falls with its phrases. Some notes are bent up from below; the longest have vibrato.
fn koto(part: &mut Part) -> Result<(), String> {
    part.bend_to(DANCE, 0.0);
    for (line, text) in MELODY.iter().enumerate() {
        let at = DANCE + 8.0 + 16.0 * line as f64;
        part.phrase(at, 0.5, text)?;
        let top = (at + 8.0).min(TUTTI);
        part.ramp(controller::EXPRESSION, (at, 104), (top, 127));
        part.ramp(controller::EXPRESSION, (top, 127), (top + 7.0, 108));
    }
    for (beat, semitones) in PULLS {
        let at = DANCE + beat;
        part.bend((at, semitones), (at + 0.3, 0.0));
    }
    for (from, length) in [(14.4, 1.5), (30.4, 1.5), (44.4, 1.5)] {
        part.ramp(controller::WHEEL, (DANCE + from, 0), (DANCE + from + length, 90));
        part.control(DANCE + from + length, controller::WHEEL, 0);
    }
    Ok(())
}

/// Chords off the beat from bar 3.
fn guitar(part: &mut Part) {
    for (at, (root, chord)) in from_bar(3) {
        part.note(at, 1.8, root + 12, 82);
        for (beat, note) in [(0.5, 2), (1.0, 3), (1.75, 4), (2.5, 3), (3.0, 2), (3.5, 1)] {
            part.note(at + beat, 0.9, chord[note], 74);
        }
    }
}

/// Groups of three against the marimba's two from bar 5, an octave above it.
fn kalimba(part: &mut Part) {
    for (at, (_, chord)) in from_bar(5) {
        for step in 0..6u32 {
            let key = chord[[4, 2, 3, 1, 3, 2][step as usize]] + 12;
            part.note(at + f64::from(step) * (2.0 / 3.0), 0.5, key, if step % 3 == 0 { 84 } else { 64 });
        }
    }
}

/// Chords from bar 7, with the pedal, which is lifted just before the next chord.
fn vibraphone(part: &mut Part) {
    for (at, (_, chord)) in from_bar(7) {
        part.pedal(at, 3.9);
        chord[1..].iter().enumerate().for_each(|(n, key)| part.note(at + 0.04 * n as f64, 0.5, key + 12, 82));
        part.note(at + 2.5, 0.5, chord[4] + 12, 74);
    }
}

/// Octaves in the left hand and the chords' rhythm in the right, from bar 9.
fn piano(part: &mut Part) {
    for (at, (root, chord)) in from_bar(9) {
        part.pedal(at, 3.8);
        part.chord(at, 1.4, &[root - 12, *root], 92);
        for (beat, velocity) in [(0.0, 84), (1.5, 74), (3.0, 80)] {
            part.chord(at + beat, 0.6, &chord[1..], velocity);
        }
    }
}

/// Held chords that grow from bar 9.
fn strings(part: &mut Part) {
    part.ramp(controller::EXPRESSION, (DANCE + 32.0, 56), (TUTTI, 122));
    from_bar(9).for_each(|(at, (_, chord))| part.chord(at, 3.9, &chord[1..], 80));
}

fn drums(part: &mut Part) {
    for (bar, (at, _)) in from_bar(1).enumerate() {
        let mut play = |from: usize, key, pattern| {
            if bar + 1 >= from {
                part.sixteenths(at, 0.03, key, pattern);
            }
        };
        play(3, drum::SHAKER, "5243 5243 5243 5243");
        play(5, drum::LOW_CONGA, "6... ..5. ..6. ....");
        play(5, drum::CONGA, "...4 .... 5... 4.54");
        play(5, drum::MUTE_CONGA, ".3.. 5.3. .3.. .5..");
        play(7, drum::KICK, "6... .... ..4. ....");
        play(7, drum::TAMBOURINE, ".... 5... .... 5..3");
        play(9, drum::CLAVES, "6..6 ..6. ...6 ..6.");
    }
    part.roll((TUTTI - 4.0, 18), (TUTTI, 104), 8.0, drum::SNARE);
}

/// A roll into the tutti, from G up to its C.
fn timpani(part: &mut Part) {
    part.bend_to(DANCE, 0.0);
    part.note(DANCE, 1.0, 45, 96);
    part.note(DANCE + 32.0, 1.0, 41, 80);
    part.roll((TUTTI - 4.0, 40), (TUTTI, 112), 8.0, 43);
    part.bend((TUTTI - 2.0, 0.0), (TUTTI - 0.2, 5.0));
}
