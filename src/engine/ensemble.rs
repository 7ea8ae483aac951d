//! Sixteen MIDI channels, a synth each, mixed in channel order.

use super::Event;
use crate::patch::Patch;

/// Sixteen synths behind one stream of events.
pub struct Ensemble {}

impl Ensemble {
    /// An ensemble in which every channel starts with `patch` and program changes choose from `programs`
    /// (a number beyond the list is ignored). Allocates; nothing after does.
    pub fn new(sample_rate: f64, seed: u64, patch: &Patch, programs: &[Patch]) -> Self {
        let _ = (sample_rate, seed, patch, programs);
        Self {}
    }

    /// Renders the next `left.len()` frames, overwriting both slices (which must be of one length).
    /// `events` are in order of their frames. Real-time safe.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        let _ = events;
        left.fill(0.0);
        right.fill(0.0);
    }

    /// Whether nothing sounds any more. Real-time safe.
    pub fn is_silent(&self) -> bool {
        true
    }

    /// Most voices that have sounded at once so far.
    pub fn voices_used(&self) -> usize {
        0
    }
}
