//! What a display shows of a sounding instrument: the number of voices, and the motion of their masses.

use super::voice::SynthVoice;
use crate::dsp::mode_bank::MAX_MODES;

/// One mass, or the sum over the voices that have the same mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Displacement. A strike of full force has an amplitude of 1.
    pub displacement: f32,
    /// Squared amplitude.
    pub energy: f32,
}

/// What sounds at one moment. Plain data of fixed size; making one is real-time safe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapshot {
    /// Number of voices that play or fade.
    pub voices: u32,
    /// The masses by mode number, added up over all voices. Modes after the first [`MAX_MODES`] are left out.
    pub masses: [Mass; MAX_MODES],
}

impl Default for Snapshot {
    /// Silence.
    fn default() -> Self {
        Self { voices: 0, masses: [Mass::default(); MAX_MODES] }
    }
}

impl Snapshot {
    /// Adds a voice.
    pub(super) fn add(&mut self, voice: &SynthVoice) {
        self.voices += 1;
        for (mass, (displacement, energy)) in self.masses.iter_mut().zip(voice.bank.masses()) {
            mass.displacement += displacement;
            mass.energy += energy;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Ensemble, Event, EventKind};
    use crate::patch::{Mode, ModeTable, Patch};

    #[test]
    fn struck_masses_are_seen_to_move_and_to_come_to_rest() {
        let quiet = Mode { level: 0.5, ratio: 2.0, ..Mode::UNIT };
        let patch = Patch { modes: ModeTable::new(&[Mode::UNIT, quiet]), ..Patch::default() };
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
        assert_eq!(ensemble.snapshot(), Snapshot::default());
        let strike = EventKind::NoteOn { key: 69, detune: 0.0, velocity: 1.0, id: None };
        let (mut left, mut right) = ([0.0; 27], [0.0; 27]);
        let events = [0, 3].map(|channel| Event { frame: 0, channel, kind: strike });
        ensemble.process(&events, &mut left, &mut right);
        let snapshot = ensemble.snapshot();
        assert_eq!(snapshot.voices, 2);
        // A quarter of a period after the strike the displacement is at its maximum: the sum of both voices'
        // amplitudes.
        assert!((snapshot.masses[0].displacement - 2.0).abs() < 0.02, "{:?}", snapshot.masses[0]);
        assert!((snapshot.masses[0].energy - 2.0).abs() < 0.02, "{:?}", snapshot.masses[0]);
        assert!((snapshot.masses[1].energy - 0.5).abs() < 0.01, "{:?}", snapshot.masses[1]);
        assert_eq!(snapshot.masses[2], Mass::default());
    }
}
