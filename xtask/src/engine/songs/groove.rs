//! "Groove": eighteen bars in E dorian for a drum kit, hands, a bass and keys.
//!
//! Hand drums begin, the kit follows, the middle is quiet, and all parts play the end.

use super::drum;
use super::score::{Part, file};
use sprung::engine::midi::controller;
use std::ops::Range;

/// Delay in beats of the second of two sixteenths.
const SWING: f64 = 0.04;

/// First bars of the sections, and the bar of the last stroke.
const KIT: u32 = 4;
const MIDDLE: u32 = 8;
const ALL: u32 = 12;
const LAST: u32 = 17;

/// Which bars a drum plays, with patterns for even and odd bars.
type Line = (Range<u32>, u8, [&'static str; 2]);

const HANDS: [Line; 10] = [
    (0..4, drum::LOW_CONGA, ["6... ..4. ..5. ....", "6... ..4. .... 4.5."]),
    (0..4, drum::CONGA, ["...4 .... 4... 3.54", "...4 ..3. 4... ...."]),
    (0..4, drum::MUTE_CONGA, [".2.. 4.2. .2.. .4..", ".2.. 4... .23. .4.3"]),
    (1..4, drum::SHAKER, ["4132 4132 4132 4132"; 2]),
    (2..4, drum::CLAVES, ["6..6 ..6. .... ....", "..6. 6... .... ...."]),
    (8..12, drum::LOW_CONGA, ["5... ..3. ..4. ....", "5... ..3. .... 3.4."]),
    (8..12, drum::MUTE_CONGA, [".2.. 3.2. .2.. .3..", ".2.. 3... .23. .3.2"]),
    (12..17, drum::CONGA, ["...5 .... 5... 4.65", "...5 ..4. 5... ..45"]),
    (12..17, drum::TAMBOURINE, ["2.4. 2.4. 2.4. 2.43"; 2]),
    (13..17, drum::COWBELL, ["6... 4... 6... 4.3."; 2]),
];

/// The kit. Digits below 4 on the snare are ghost notes around the back beat.
const DRUMS: [Line; 18] = [
    (4..7, drum::KICK, ["8... ..6. ..7. ...4", "8..5 ..7. .... 6..."]),
    (4..7, drum::SNARE, ["...2 8..2 .2.. 8..2", "..2. 8..2 .1.2 8.2."]),
    (4..7, drum::CLOSED_HAT, ["6354 6353 6354 6354", "6354 6353 6354 63.."]),
    (5..7, drum::OPEN_HAT, [".... .... .... ....", ".... .... .... ..6."]),
    (7..8, drum::KICK, ["", "8... ..6. 7... 7..."]),
    (7..8, drum::SNARE, ["", "..2. 8.45 .... ...."]),
    (7..8, drum::CLOSED_HAT, ["", "6354 6... .... ...."]),
    (8..12, drum::KICK, ["5... .... ..4. ....", "5... ..4. .... ...."]),
    (8..11, drum::SIDE_STICK, [".... 5... .... 5..3", ".... 5..2 .... 5..."]),
    (8..11, drum::RIDE, ["4.2. 4.23 4.2. 4.2.", "4.2. 4.2. 4.2. 4.23"]),
    (11..12, drum::SNARE, ["", "1.1. 2.2. 3233 4567"]),
    (12..16, drum::KICK, ["8..5 ..8. ..8. ...5", "8..5 ..8. 6.7. 6..."]),
    (12..16, drum::SNARE, ["...2 8..3 .3.. 8..2", "..3. 8..3 .2.3 8.34"]),
    (12..16, drum::CLAP, [".... 7... .... 7...", ".... 7... .... 7..."]),
    (12..16, drum::CLOSED_HAT, ["7364 73.4 7364 7364", "7364 7364 7364 73.."]),
    (12..16, drum::OPEN_HAT, [".... ..7. .... ....", ".... .... .... ..7."]),
    (16..17, drum::KICK, ["8... 7... 8... 8...", ""]),
    (16..17, drum::SNARE, ["7456 .... .... ....", ""]),
];

/// Fills by their bars, from the highest tom to the lowest.
const FILLS: [(u32, [&str; 4]); 2] = [
    (7, [".... .... 8.6. ....", ".... .... ..67 ....", ".... .... .... 8.6.", ".... .... .... ..78"]),
    (16, [".... 8.67 .... ....", ".... .... 8.68 ....", ".... .... .... 8.8.", ".... .... .... .8.9"]),
];

/// Bars of bass and chords in sixteenths: E minor with the ninth, A with the thirteenth, C and B.
const E_MINOR: [&str; 2] = ["E1@112*3 E2@64 -*3 G1@92 A1@104*3 - B1@88*2 D2@92 E2@98", "G3+B3+D4+F#4"];
const A_MAJOR: [&str; 2] = ["A1@112*3 A1@70 -*3 C2@88 C#2@104*3 - E2@88*2 F#2@92 G2@96", "G3+B3+C#4+F#4"];
const C_MAJOR: [&str; 2] = ["C2@112*3 C2@70 -*3 G1@90 B1@100*3 - C2@88*2 B1@90 A1@86", "G3+B3+D4+E4"];
const B_SEVEN: [&str; 2] = ["B1@112*3 B1@70 -*3 F#1@92 A1@102*3 - B1@90*2 D#2@94 F#2@98", "A3+C#4+D#4+F#4"];

/// The bars of the kit's section and of the end; the first section has the bass alone in its last two.
const TURN: [[&str; 2]; 4] = [E_MINOR, A_MAJOR, C_MAJOR, B_SEVEN];

/// Bass and chords of the middle: C, B minor, A minor, B.
const SLOW: [[&str; 2]; 4] = [
    ["C2@92*7 G2@70 A2@84*4 G2@76*4", "G4+B4+D5+E5"],
    ["B1@92*7 F#2@70 A2@84*4 F#2@76*4", "F#4+A4+D5+F#5"],
    ["A1@94*7 E2@72 G2@88*4 E2@80*4", "G4+B4+C5+E5"],
    ["B1@98*4 D#2@88*4 F#2@94*2 A2@98*2 B2@104*4", "A4+C#5+D#5+F#5"],
];

/// The marimba's riff, a bar for each chord of the turn.
const RIFF: [&str; 4] = [
    "E4@100 - - G4@86 - A4@84 - B4@104*2 - D5@96 - B4@84 A4@78 - G4@72",
    "E4@100 - - G4@86 - A4@84 - C#5@104*2 - B4@96 - A4@84 F#4@78 - E4@72",
    "E4@100 - - G4@86 - B4@84 - D5@104*2 - E5@96 - D5@84 B4@78 - G4@72",
    "D#4@100 - - F#4@86 - A4@84 - C#5@104*2 - D#5@98 - C#5@88 A4@84 - F#4@80",
];

pub(super) fn compose() -> Result<Vec<u8>, String> {
    let tempo = [(0.0, 104.0), (f64::from(LAST) * 4.0 - 1.0, 100.0), (f64::from(LAST) * 4.0 - 0.5, 94.0)];
    let parts = vec![drums(), bass()?, marimba()?, electric_piano()?, vibraphone()?, clavinet()?];
    file("Groove", &tempo, parts)
}

fn drums() -> Part {
    let mut part = Part::kit("Drums", 9, 1, 109).send(44).loosen(0.01, 8.0);
    for (bars, key, patterns) in HANDS.iter().chain(&DRUMS) {
        for bar in bars.clone() {
            part.sixteenths(f64::from(bar) * 4.0, SWING, *key, patterns[bar as usize % 2]);
        }
    }
    for (bar, patterns) in FILLS {
        for (key, pattern) in
            [drum::HIGH_TOM, drum::MIDDLE_TOM, drum::LOW_TOM, drum::FLOOR_TOM].into_iter().zip(patterns)
        {
            part.sixteenths(f64::from(bar) * 4.0, 0.0, key, pattern);
        }
    }
    for (bar, velocity) in [(KIT, 88), (ALL, 108), (LAST, 118)] {
        part.note(f64::from(bar) * 4.0, 1.0, drum::CRASH, velocity);
    }
    for key in [drum::DEEP_KICK, drum::SNARE] {
        part.note(f64::from(LAST) * 4.0, 1.0, key, 116);
    }
    part
}

/// The turn's bars from one bar to another, with their first beats.
fn turn(bars: Range<u32>) -> impl Iterator<Item = (f64, [&'static str; 2])> {
    bars.map(|bar| (f64::from(bar) * 4.0, TURN[bar as usize % 4]))
}

/// The turn's line, a slow line in the middle with bends into its notes, and the last E.
fn bass() -> Result<Part, String> {
    let mut part = Part::new("Bass", 0, "Fingered Bass", 127, 64)?.send(10);
    for (at, [line, _]) in turn(2..MIDDLE).chain(turn(ALL..LAST)) {
        part.phrase(at, 0.25, line)?;
    }
    for (bar, [line, _]) in (MIDDLE..).zip(SLOW) {
        let at = f64::from(bar) * 4.0;
        part.phrase(at, 0.25, line)?;
        part.bend((at + 2.0, -2.0), (at + 2.2, 0.0));
    }
    part.ramp(controller::EXPRESSION, (8.0, 84), (16.0, 118));
    part.ramp(controller::EXPRESSION, (32.0, 100), (33.0, 96));
    part.ramp(controller::EXPRESSION, (44.0, 96), (48.0, 127));
    part.note(f64::from(LAST) * 4.0, 1.8, 28, 120);
    Ok(part)
}

/// The riff, which grows until the kit comes in, and is loudest at the end.
fn marimba() -> Result<Part, String> {
    let mut part = Part::new("Marimba", 1, "Marimba", 124, 14)?.send(45).loosen(0.008, 7.0);
    for bar in (0..MIDDLE).chain(ALL..LAST) {
        let line = if bar < 2 { RIFF[0] } else { RIFF[bar as usize % 4] };
        part.phrase(f64::from(bar) * 4.0, 0.25, line)?;
    }
    part.ramp(controller::EXPRESSION, (0.0, 72), (14.0, 112));
    part.control(48.0, controller::EXPRESSION, 127);
    part.chord(f64::from(LAST) * 4.0, 1.0, &[64, 71, 76], 112);
    Ok(part)
}

/// Chords, most of them off the beat, in the kit's section and at the end.
fn electric_piano() -> Result<Part, String> {
    let mut part = Part::new("Electric Piano", 2, "Electric Piano 1", 123, 108)?.send(48).loosen(0.01, 8.0);
    for (at, [_, chord]) in turn(KIT..MIDDLE).chain(turn(ALL..LAST)) {
        let loud = if at < 48.0 { 84 } else { 102 };
        for (step, length, softer) in [(0.0, 5.0, 0), (6.0, 1.5, 14), (9.0, 4.0, 4), (14.0, 1.5, 18)] {
            part.phrase(at + step * 0.25, 0.25, &format!("{chord}@{}*{length}", loud - softer))?;
        }
    }
    part.phrase(f64::from(LAST) * 4.0, 1.0, "E3+G3+B3+D4+F#4@108*2")?;
    Ok(part)
}

/// The chords of the middle, with the pedal, each struck again softly after two and a half beats.
fn vibraphone() -> Result<Part, String> {
    let mut part = Part::new("Vibraphone", 3, "Vibraphone", 120, 114)?.send(85).loosen(0.012, 8.0);
    for (bar, [_, chord]) in (MIDDLE..).zip(SLOW) {
        let at = f64::from(bar) * 4.0;
        part.pedal(at, 3.9);
        part.phrase(at, 0.25, &format!("{chord}@78*10 {chord}@60*6"))?;
    }
    part.pedal(f64::from(LAST) * 4.0, 3.0);
    part.phrase(f64::from(LAST) * 4.0, 1.0, "D5+F#5+B5@92*3")?;
    Ok(part)
}

/// Short sixteenths at the end, in the gaps of the riff.
fn clavinet() -> Result<Part, String> {
    let mut part = Part::new("Clavinet", 4, "Clavinet", 94, 6)?.send(28).loosen(0.008, 10.0);
    for (at, [_, chord]) in turn(ALL..LAST) {
        let (low, high) = chord.split_at(chord.rfind('+').unwrap_or_default());
        let high = high.trim_start_matches('+');
        for (step, velocity) in [(1, 70), (2, 92), (4, 100), (7, 76), (9, 72), (10, 96), (12, 100), (15, 80)] {
            let notes = if velocity > 90 { low } else { high };
            part.phrase(at + f64::from(step) * 0.25, 0.25, &format!("{notes}@{velocity}*0.6"))?;
        }
    }
    Ok(part)
}
