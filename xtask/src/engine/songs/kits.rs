//! "Kits": one rhythm, played in turn by the seven kits of channel 10 over the pulse of a marimba.

use super::drum::{self, metal, orchestra};
use super::score::{Part, file};
use sprung::engine::midi::controller;

/// Beats that each kit has: three bars.
const TURN: f64 = 12.0;

/// A kit's turn: its number in Roland's GS, the keys that play the rhythm's roles, and its loudness.
struct Player {
    number: u8,
    /// The deep voice, the bright voice on the back beat, and its ghost notes.
    low: u8,
    high: u8,
    ghost: u8,
    /// The steady sixteenths, and the open sound at the end of the second bar.
    pulse: u8,
    open: u8,
    /// The fill, from high to low.
    fill: [u8; 4],
    /// The first stroke, if there is one.
    crash: Option<u8>,
    /// Controller 11 (expression) while it plays.
    loudness: u8,
    /// The marimba's chord during this turn, and its bass note.
    chord: [u8; 5],
    bass: u8,
}

/// A player with the keys of General MIDI's drum map.
const COMMON: Player = Player {
    number: 1,
    low: drum::KICK,
    high: drum::SNARE,
    ghost: drum::SNARE,
    pulse: drum::CLOSED_HAT,
    open: drum::OPEN_HAT,
    fill: [drum::HIGH_TOM, drum::MIDDLE_TOM, drum::LOW_TOM, drum::FLOOR_TOM],
    crash: Some(drum::CRASH),
    loudness: 116,
    chord: [62, 65, 69, 72, 76],
    bass: 38,
};

const PLAYERS: [Player; 7] = [
    // Hands: djembe, shaker, tabla; D minor.
    Player { number: 65, ghost: drum::MIDDLE_TOM, crash: None, loudness: 104, ..COMMON },
    // The acoustic kit; B flat.
    Player { number: 1, chord: [62, 65, 69, 72, 77], bass: 34, ..COMMON },
    // The tight kit; G minor.
    Player { number: 17, chord: [62, 65, 67, 70, 74], bass: 43, ..COMMON },
    // Brushes: taps, swirls and a ride; A minor.
    Player {
        number: 33,
        ghost: drum::SECOND_SNARE,
        pulse: drum::RIDE,
        open: drum::PEDAL_HAT,
        loudness: 96,
        chord: [60, 64, 67, 69, 76],
        bass: 45,
        ..COMMON
    },
    // Metal: sheets, a brake drum, triangles, a bottle, glasses on C and F; F.
    Player {
        number: 57,
        ghost: metal::BOTTLE,
        pulse: drum::PEDAL_HAT,
        fill: metal::GLASSES,
        loudness: 108,
        chord: [60, 64, 65, 69, 76],
        bass: 41,
        ..COMMON
    },
    // The drum machine; C.
    Player { number: 25, ghost: drum::SIDE_STICK, chord: [60, 64, 67, 70, 74], bass: 36, loudness: 120, ..COMMON },
    // The orchestra: bass drum, snare, castanets, timpani on D, A, G and F; D minor.
    Player {
        number: 49,
        pulse: drum::CLAP,
        open: drum::TRIANGLE,
        fill: orchestra::TIMPANI,
        crash: Some(orchestra::CLASH),
        loudness: 127,
        ..COMMON
    },
];

/// The rhythm of three bars: sixteenths in groups of three and two, then the fill.
const LOW: [&str; 3] = ["9..5 ..8. ..7. ..5.", "9..5 ..8. .6.. 8...", "9..5 ..8. 8... 7..."];
const HIGH: [&str; 3] = [".... 8... .... 8...", ".... 8... .... 8..5", ".... 8.45 .... ...."];
const GHOST: [&str; 3] = ["...2 ..3. .2.3 ..2.", "..2. ..3. .2.3 .3..", "...2 .... .... ...."];
const PULSE: [&str; 3] = ["7354 7353 7354 7353", "7354 7353 7354 73..", "7354 73.. .... ...."];
const OPEN: [&str; 3] = ["", ".... .... .... ..6.", ""];
const FILL: [&str; 4] = [".... .... 8.67 ....", ".... .... ...7 8...", ".... .... .... .68.", ".... .... .... ..79"];

/// Beats by which a kit is selected before its first stroke.
const EARLY: f64 = 0.02;

/// First beat of the last bars, in which the orchestra ends.
const END: f64 = TURN * 7.0;

pub(super) fn compose() -> Result<Vec<u8>, String> {
    let tempo =
        [(0.0, 116.0), (TURN * 3.0, 112.0), (TURN * 4.0, 116.0), (TURN * 5.0, 120.0), (END - 2.0, 108.0), (END, 96.0)];
    file("Kits", &tempo, vec![drums(), marimba()?, bass()?, vibraphone()?])
}

/// The players with their first beats.
fn turns() -> impl Iterator<Item = (f64, &'static Player)> {
    PLAYERS.iter().enumerate().map(|(turn, player)| (turn as f64 * TURN, player))
}

fn drums() -> Part {
    let mut part = Part::kit("Drums", 9, PLAYERS[0].number, 115).send(50).loosen(0.009, 8.0);
    for (at, player) in turns() {
        // Before the first stroke, which may come early.
        let before = (at - EARLY).max(0.0);
        part.program(before, player.number);
        part.control(before, controller::EXPRESSION, player.loudness);
        for bar in 0..3usize {
            let roles = [
                (player.low, LOW),
                (player.high, HIGH),
                (player.ghost, GHOST),
                (player.pulse, PULSE),
                (player.open, OPEN),
            ];
            for (key, patterns) in roles {
                part.sixteenths(at + 4.0 * bar as f64, 0.03, key, patterns[bar]);
            }
        }
        for (key, pattern) in player.fill.into_iter().zip(FILL) {
            part.sixteenths(at + 8.0, 0.0, key, pattern);
        }
        if let Some(key) = player.crash {
            part.note(at, 1.0, key, 96);
        }
    }
    // Timpani on D, the bass drum and the tam-tam.
    let [timpani, ..] = orchestra::TIMPANI;
    part.roll((END, 56), (END + 2.0, 112), 8.0, timpani);
    for (key, velocity) in [(timpani, 118), (drum::KICK, 118), (orchestra::CLASH, 110), (orchestra::TAM_TAM, 104)] {
        part.note(END + 2.0, 2.0, key, velocity);
    }
    part
}

/// Eighths that turn through the chord in threes and twos, softer where the kit is.
fn marimba() -> Result<Part, String> {
    let mut part = Part::new("Marimba", 0, "Marimba", 108, 30)?.send(50).loosen(0.008, 7.0);
    for (at, player) in turns() {
        part.control(at, controller::EXPRESSION, player.loudness);
        for bar in 0..3u32 {
            part.broken_chord(at + 4.0 * f64::from(bar), &player.chord);
        }
    }
    part.roll((END, 60), (END + 2.0, 108), 8.0, 69);
    part.chord(END + 2.0, 2.0, &[62, 69, 74, 77], 112);
    Ok(part)
}

/// Roots with the rhythm's deep voice.
fn bass() -> Result<Part, String> {
    let mut part = Part::new("Bass", 1, "Upright Bass", 116, 64)?.send(20);
    for (at, player) in turns() {
        for bar in 0..3u32 {
            let at = at + 4.0 * f64::from(bar);
            part.note(at, 1.3, player.bass, 100);
            part.note(at + 1.5, 0.9, player.bass, 84);
            part.note(at + 2.5, 0.9, player.bass + 7, 78);
        }
    }
    part.note(END + 2.0, 3.0, 38, 108);
    Ok(part)
}

/// A chord as each kit begins, with the pedal.
fn vibraphone() -> Result<Part, String> {
    let mut part = Part::new("Vibraphone", 2, "Vibraphone", 106, 104)?.send(80).loosen(0.012, 6.0);
    for (at, player) in turns().chain([(END + 2.0, &PLAYERS[0])]) {
        part.pedal(at, 7.5);
        for (n, key) in player.chord[1..].iter().enumerate() {
            part.note(at + 0.05 * n as f64, 1.0, key + 12, 76);
        }
    }
    Ok(part)
}
