//! Renders one strike of a key, as the first of a row or a later one.

use super::settings::Sampling;
use crate::engine::EventKind;
use crate::error::Result;
use crate::io::{Song, SongEvent};
use crate::render::{Job, Options, Tail};
use crate::sound::Kit;
use std::sync::Arc;

/// Frames per block: too few to be shared between cores, since every core has samples of its own.
const BLOCK: usize = 256;

/// Frames before a strike for each of the notes that come before it and are left out. They give it another number, and so other
/// random numbers and the other side of an alternation.
const FRAMES_OF_A_NOTE: f64 = 64.0;

/// A strike of a zone's key at a velocity, left and right. The key is held for some seconds; `let_go` more seconds follow.
pub(super) fn strike(
    sampling: &Sampling,
    kit: &Arc<Kit>,
    key: u8,
    velocity: u8,
    number: usize,
    [held, let_go]: [f64; 2],
) -> Result<[Vec<f32>; 2]> {
    let rate = f64::from(sampling.rate);
    let from = number as f64 * FRAMES_OF_A_NOTE / rate;
    let note = EventKind::NoteOn { key, detune: 0.0, velocity: f32::from(velocity) / 127.0, id: None };
    let event = |seconds, kind| SongEvent { seconds, channel: 0, kind };
    let before = (0..number).map(|n| event(n as f64 * FRAMES_OF_A_NOTE / rate, note));
    let mut events: Vec<SongEvent> = before.chain([event(from, note)]).collect();
    if let_go > 0.0 {
        events.push(event(from + held, EventKind::NoteOff { key, velocity: 0.5, id: None }));
    }
    let song = Song { events, seconds: from + held + let_go };
    let options = Options { sample_rate: sampling.rate, seed: sampling.seed, block: BLOCK, tail: Tail::None };
    Job { from, ..Job::new(&song, kit, options) }.samples()
}

/// Whether two strikes of a key in a row are different.
pub(super) fn strikes_differ(sampling: &Sampling, kit: &Arc<Kit>, key: u8) -> bool {
    let sound = |number| strike(sampling, kit, key, 127, number, [sampling.length.min(0.25), 0.0]).ok();
    sound(0) != sound(1)
}
