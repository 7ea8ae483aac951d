//! "Suite": marimba, vibraphone, a voice of one mass and others, in D minor and, after a slow bar, in D major.

use super::score::{Part, controller, drum, file};
use sprung::units::key_from_note_name;

/// The harmony of a bar: the bass note, and a voicing of five notes around middle C, from low to high.
type Chord = (u8, [u8; 5]);

/// Bars 1–8, in D minor: chords over a slow bass, which the marimba plays broken.
const FIRST: [Chord; 8] = [
    (38, [57, 62, 64, 65, 69]), // Dm9
    (38, [57, 62, 64, 65, 72]), // Dm9, the seventh on top
    (34, [58, 62, 65, 69, 72]), // B♭maj9
    (34, [58, 60, 65, 69, 74]), // B♭maj9
    (41, [57, 60, 64, 67, 72]), // Fmaj9
    (36, [55, 60, 62, 67, 74]), // C with the ninth
    (43, [58, 62, 65, 69, 74]), // Gm9
    (45, [57, 62, 64, 67, 73]), // A7, its fourth held against the third
];

/// Bars 9–16: the bass moves, and the lead plays the melody.
const SECOND: [Chord; 8] = [
    (38, [57, 62, 64, 65, 69]), // Dm9
    (40, [55, 60, 62, 64, 67]), // C ⁄ E
    (41, [57, 60, 62, 65, 69]), // F6
    (43, [58, 62, 65, 69, 70]), // Gm9
    (34, [58, 62, 65, 69, 74]), // B♭maj7
    (33, [57, 60, 65, 67, 72]), // F ⁄ A
    (43, [58, 62, 65, 67, 70]), // Gm7
    (45, [55, 58, 61, 64, 67]), // A7 with the flat ninth
];

/// Bars 17–26, in D major, faster.
const THIRD: [Chord; 10] = [
    (38, [57, 62, 64, 66, 69]), // D with the ninth
    (37, [57, 59, 61, 64, 69]), // A ⁄ C♯
    (35, [57, 59, 62, 66, 69]), // Bm7
    (42, [57, 61, 64, 66, 69]), // F♯m7
    (43, [57, 59, 62, 66, 71]), // Gmaj9
    (42, [57, 62, 64, 66, 74]), // D ⁄ F♯
    (40, [55, 59, 62, 66, 71]), // Em9
    (45, [57, 62, 64, 67, 71]), // A13, suspended
    (43, [57, 59, 62, 66, 73]), // Gmaj9 with the raised fourth
    (38, [57, 62, 64, 66, 74]), // D with the ninth
];

/// The melody, one line per bar from bar 9 on: notes, `-` for a rest, each with its length in eighths.
const MELODY: [&str; 18] = [
    "A4 3 D5 1 E5 2 F5 2",
    "E5 4 C5 2 D5 2",
    "C5 3 A4 1 C5 2 F5 2",
    "D5 6 - 2",
    "F5 3 G5 1 A5 4",
    "G5 2 F5 2 C5 4",
    "Bb4 2 D5 2 F5 2 G5 2",
    "E5 4 C#5 2 E5 2",
    // D major.
    "F#5 6 A5 2",
    "E5 6 C#5 2",
    "D5 4 F#5 4",
    "C#5 6 - 2",
    "B4 2 D5 2 F#5 2 A5 2",
    "A5 4 F#5 4",
    "G5 4 F#5 2 E5 2",
    "D5 4 E5 4",
    "C#5 2 F#5 6",
    "D5 8",
];

/// First beats of the sections and of the last two bars.
const SECOND_AT: f64 = 32.0;
const THIRD_AT: f64 = 64.0;
const CLOSE_AT: f64 = 96.0;
const END: f64 = 104.0;

pub(super) fn compose() -> Result<Vec<u8>, String> {
    let parts = vec![
        marimba()?,
        vibraphone()?,
        lead()?,
        bass()?,
        string()?,
        bell()?,
        swell()?,
        kalimba()?,
        timpani()?,
        shaker(),
        rim(),
        kick(),
        triangle(),
    ];
    file("Suite", &tempo(), parts)
}

/// Tempo: 92, slower through bar 16, then 112, and slower through the last two bars.
fn tempo() -> Vec<(f64, f64)> {
    let mut tempo = vec![(0.0, 92.0)];
    tempo.extend((0..8u32).map(|n| (60.0 + 0.5 * f64::from(n), 88.0 - 4.5 * f64::from(n))));
    tempo.push((THIRD_AT, 112.0));
    tempo.extend((0..8u32).map(|n| (CLOSE_AT + f64::from(n), 106.0 - 6.0 * f64::from(n))));
    tempo
}

/// All bars with their first beats.
fn bars() -> impl Iterator<Item = (f64, &'static Chord)> {
    FIRST.iter().chain(&SECOND).chain(&THIRD).enumerate().map(|(bar, chord)| (bar as f64 * 4.0, chord))
}

/// Broken chords in eighths, with accents in groups of three, three and two; quieter in bars 9–16.
fn marimba() -> Result<Part, String> {
    let mut part = Part::new("Marimba", 0, "Marimba", 112, 46)?.loosen(0.01, 8.0);
    const TURN: [usize; 8] = [0, 2, 4, 1, 3, 4, 2, 3];
    for (at, (_, chord)) in bars().filter(|(at, _)| *at < END - 4.0) {
        for (step, note) in TURN.iter().enumerate() {
            let accent = if [0, 3, 6].contains(&step) { 92 } else { 66 };
            let quieter = if (SECOND_AT..THIRD_AT).contains(&at) { 14 } else { 0 };
            part.note(at + step as f64 * 0.5, 0.4, chord[*note], accent - quieter);
        }
    }
    // The last chord, arpeggiated upwards.
    for (n, key) in [50, 57, 62, 66, 69, 74, 78].into_iter().enumerate() {
        part.note(END - 4.0 + n as f64 * 0.12, 2.0, key, 80);
    }
    Ok(part)
}

/// Chords with the pedal, which is lifted just before the next chord.
fn vibraphone() -> Result<Part, String> {
    let mut part = Part::new("Vibraphone", 1, "Vibraphone", 104, 80)?.loosen(0.01, 6.0);
    for (at, (_, chord)) in bars() {
        let sings = (SECOND_AT..THIRD_AT).contains(&at);
        part.pedal(at, if at == END - 4.0 { 7.0 } else { 3.9 });
        for (n, key) in chord[1..].iter().enumerate() {
            part.note(at + 0.04 * n as f64, 0.5, key + 12, if sings { 66 } else { 80 });
        }
        if !sings {
            part.note(at + 2.5, 0.5, chord[4] + 12, 74);
            part.note(at + 3.0, 0.5, chord[2] + 12, 68);
        }
    }
    Ok(part)
}

/// The melody: struck again in each bar and slurred within it, because a struck mass decays. Phrases begin with a bend
/// from below, and long notes have vibrato from the wheel.
fn lead() -> Result<Part, String> {
    let mut part = Part::new("Lead", 2, "Flute", 108, 64)?;
    part.bend_range(4);
    let (mut at, mut rested) = (SECOND_AT, true);
    let words: Vec<&str> = MELODY.iter().flat_map(|bar| bar.split(' ')).collect();
    for pair in words.chunks_exact(2) {
        let eighths: f64 = pair[1].parse().map_err(|_| format!("‘{}’ is no length", pair[1]))?;
        let (key, length) = (key_from_note_name(pair[0]), eighths * 0.5);
        let end = at + length;
        if let Some(key) = key {
            let slurred = end % 4.0 != 0.0;
            part.note(at, if slurred { length + 0.05 } else { length - 0.06 }, key, if rested { 92 } else { 84 });
            if rested {
                part.bend((at, -2.0), (at + 0.25, 0.0));
            }
            if length >= 2.0 {
                part.ramp(controller::WHEEL, (at + 0.5, 0), (end - 0.5, 80));
                part.control(end - 0.1, controller::WHEEL, 0);
            }
        }
        rested = key.is_none();
        at = end;
    }
    // The last note of bar 15 bends up a tone and back.
    part.bend((59.0, 0.0), (59.5, 2.0));
    part.bend((59.5, 2.0), (59.9, 0.0));
    part.ramp(controller::EXPRESSION, (SECOND_AT, 100), (48.0, 122));
    part.ramp(controller::EXPRESSION, (CLOSE_AT, 122), (END, 84));
    Ok(part)
}

/// Root notes: first whole notes, then the rhythm of a slow dance.
fn bass() -> Result<Part, String> {
    let mut part = Part::new("Bass", 3, "Upright Bass", 85, 64)?;
    for (at, (root, _)) in bars().filter(|(at, _)| *at >= 8.0) {
        if !(THIRD_AT..CLOSE_AT).contains(&at) {
            part.note(at, 3.8, *root, 78);
        } else {
            part.note(at, 1.4, *root, 86);
            part.note(at + 1.5, 0.9, *root, 70);
            part.note(at + 2.5, 0.45, root + 12, 60);
            part.note(at + 3.0, 0.9, *root, 74);
        }
    }
    Ok(part)
}

/// Answers the marimba on the off-beats, from bar 5.
fn string() -> Result<Part, String> {
    let mut part = Part::new("String", 4, "Nylon Guitar", 104, 88)?.loosen(0.015, 9.0);
    for (at, (root, chord)) in bars().filter(|(at, _)| (16.0..CLOSE_AT).contains(at)) {
        part.note(at, 1.8, root + 12, 74);
        for (beat, note) in [(0.5, 2), (1.0, 3), (1.75, 4), (2.5, 3), (3.0, 2), (3.5, 1)] {
            part.note(at + beat, 0.9, chord[note], 62);
        }
    }
    for (n, key) in [50, 57, 62, 66, 69, 76].into_iter().enumerate() {
        part.note(END - 4.0 + 0.06 * n as f64, 4.0, key, 70);
    }
    Ok(part)
}

/// A distant bell opens the two sections in minor.
fn bell() -> Result<Part, String> {
    let mut part = Part::new("Bell", 5, "Tubular Bells", 84, 30)?;
    for (beat, velocity) in [(0.0, 84), (8.0, 70), (32.0, 80)] {
        part.note(beat, 1.0, 62, velocity);
    }
    Ok(part)
}

/// Breath noise under the second section and under the last bars.
fn swell() -> Result<Part, String> {
    let mut part = Part::new("Pad", 6, "Warm Pad", 98, 64)?;
    part.ramp(controller::EXPRESSION, (SECOND_AT, 70), (THIRD_AT, 115));
    for (at, (_, chord)) in bars().filter(|(at, _)| (SECOND_AT..THIRD_AT).contains(at) || *at >= CLOSE_AT) {
        part.chord(at, 3.7, &chord[1..4], 60);
    }
    Ok(part)
}

/// An octave above the marimba in the third section: broken chords in groups of three against the marimba's two.
fn kalimba() -> Result<Part, String> {
    let mut part = Part::new("Kalimba", 7, "Kalimba", 94, 34)?.loosen(0.012, 9.0);
    for (at, (_, chord)) in bars().filter(|(at, _)| (THIRD_AT..CLOSE_AT).contains(at)) {
        for step in 0..6u32 {
            let key = chord[[4, 2, 3, 1, 3, 2][step as usize]] + 12;
            part.note(at + f64::from(step) * (2.0 / 3.0), 0.5, key, if step % 3 == 0 { 76 } else { 58 });
        }
    }
    Ok(part)
}

/// A roll on A that grows louder through the slow bar, and a D at its end.
fn timpani() -> Result<Part, String> {
    let mut part = Part::new("Timpani", 8, "Timpani", 96, 70)?;
    for n in 0..16u8 {
        part.note(60.0 + 0.25 * f64::from(n), 0.2, 45, 26 + 4 * n);
    }
    part.note(THIRD_AT, 1.0, 38, 92);
    part.note(CLOSE_AT + 4.0, 1.0, 38, 60);
    Ok(part)
}

fn shaker() -> Part {
    let mut part = Part::drums("Shaker", 108).loosen(0.012, 12.0);
    for n in 0..64u32 {
        part.note(THIRD_AT + 0.5 * f64::from(n), 0.1, drum::MARACAS, if n % 2 == 0 { 56 } else { 84 });
    }
    part
}

fn rim() -> Part {
    let mut part = Part::drums("Rim", 108).loosen(0.01, 8.0);
    for bar in 0..8u32 {
        let at = THIRD_AT + 4.0 * f64::from(bar);
        part.note(at + 1.0, 0.1, drum::SIDE_STICK, 62);
        part.note(at + 3.0, 0.1, drum::SIDE_STICK, 70);
        part.note(at + 3.75, 0.1, drum::SIDE_STICK, 34);
    }
    part
}

fn kick() -> Part {
    let mut part = Part::drums("Kick", 108).loosen(0.006, 6.0);
    for bar in 0..8u32 {
        let at = THIRD_AT + 4.0 * f64::from(bar);
        part.note(at, 0.1, drum::DEEP_KICK, 84);
        part.note(at + 2.5, 0.1, drum::DEEP_KICK, 68);
    }
    part.note(CLOSE_AT, 0.1, drum::DEEP_KICK, 70);
    part
}

fn triangle() -> Part {
    let mut part = Part::drums("Triangle", 108);
    for beat in [THIRD_AT, 80.0, CLOSE_AT, END - 4.0] {
        part.note(beat, 0.1, drum::TRIANGLE, 76);
    }
    part
}
