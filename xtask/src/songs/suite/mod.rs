//! "Suite": what bends, rings and swells. A slow opening in C, a dance in A minor, a tutti in C, and its echo.

mod dance;
mod echo;
mod opening;
mod orchestra;
mod tutti;

use super::score::file;
use orchestra::Orchestra;

/// The harmony of a bar: the bass note, and a voicing of five notes around middle C, from low to high.
type Chord = (u8, [u8; 5]);

/// First beats of the sections, and the end.
const OPENING: f64 = 0.0;
const DANCE: f64 = 16.0;
const TUTTI: f64 = 64.0;
const ECHO: f64 = 92.0;
const END: f64 = 104.0;

pub(super) fn compose() -> Result<Vec<u8>, String> {
    let mut orchestra = Orchestra::seated()?;
    opening::play(&mut orchestra);
    dance::play(&mut orchestra)?;
    tutti::play(&mut orchestra)?;
    echo::play(&mut orchestra)?;
    file("Suite", &tempo(), orchestra.into_parts())
}

/// Each section has its own tempo. The opening presses on, the tutti broadens into the echo, and the echo slows down.
fn tempo() -> Vec<(f64, f64)> {
    let mut tempo = vec![(OPENING, 66.0), (DANCE - 4.0, 70.0), (DANCE - 2.0, 78.0), (DANCE, 120.0)];
    tempo.extend([(TUTTI - 2.0, 112.0), (TUTTI - 1.0, 102.0), (TUTTI, 94.0)]);
    tempo.extend((0..8u32).map(|n| (ECHO - 8.0 + f64::from(n), 92.0 - 3.0 * f64::from(n))));
    tempo.extend([(ECHO, 60.0), (END - 6.0, 57.0), (END - 4.0, 52.0), (END - 2.0, 46.0)]);
    tempo
}

/// The bars of a section with their first beats.
fn bars(at: f64, chords: &'static [Chord]) -> impl Iterator<Item = (f64, &'static Chord)> {
    chords.iter().enumerate().map(move |(bar, chord)| (at + bar as f64 * 4.0, chord))
}
