//! "Suite": a slow opening in C, a dance in A minor, a tutti in C and its echo, with many bends, long tails and swells.

mod dance;
mod echo;
mod form;
mod opening;
mod orchestra;
mod tutti;

use super::score::file;
use form::{DANCE, ECHO, END, OPENING, TUTTI};
use orchestra::Orchestra;

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
