//! Chords on a synth: what the benches of whole instruments time.

use sprung::dsp::mode_bank::MAX_MODES;
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::{Mode, ModeTable, Patch};

/// Frames of a block, as a host with little latency has them.
pub(crate) const FRAMES: usize = 64;

/// Sound after which a chord is struck anew: long before its modes have died and are spared.
const LASTS: usize = 8 * 48_000;

/// A patch of 64 modes, for up to `voices` notes.
pub(crate) fn patch(voices: usize) -> Patch {
    let mut patch = Patch::default().with(Param::Decay, 60.0).with(Param::Voices, voices as f32);
    let mode = |m: usize| Mode { ratio: 1.0 + 0.3 * m as f32, level: 0.1, decay: 10.0, ..Mode::UNIT };
    patch.modes = ModeTable::new(&(0..MAX_MODES).map(mode).collect::<Vec<_>>());
    patch
}

/// Vibrato and a long sweep on every voice; the bend comes from [`Chord::process`].
pub(crate) fn moving(patch: Patch) -> Patch {
    patch.with(Param::Vibrato, 30.0).with(Param::Sweep, 12.0).with(Param::SweepTime, 10.0)
}

/// A synth on which a chord rings.
pub(crate) struct Chord {
    synth: Synth,
    strikes: Vec<Event>,
    left: [f32; FRAMES],
    right: [f32; FRAMES],
    frames: usize,
}

impl Chord {
    /// A chord of so many notes, which has just been struck.
    pub(crate) fn new(patch: &Patch, voices: usize) -> Self {
        let mut synth = Synth::new(48_000.0, 1);
        synth.set_patch(patch);
        let strike = |voice: usize| {
            let key = (36 + voice % 64) as u8;
            let kind = EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None };
            Event { frame: 0, channel: 0, kind }
        };
        let strikes = (0..voices).map(strike).collect();
        let mut chord = Self { synth, strikes, left: [0.0; FRAMES], right: [0.0; FRAMES], frames: 0 };
        chord.strike();
        assert_eq!(chord.synth.voices_used(), voices);
        chord
    }

    /// All notes, in the first block after a reset.
    pub(crate) fn strike(&mut self) {
        self.synth.process(&self.strikes, &mut self.left, &mut self.right);
    }

    /// Silence.
    pub(crate) fn reset(&mut self) {
        self.synth.reset();
    }

    /// The next block; `bent`, with the wheel somewhere else.
    pub(crate) fn process(&mut self, bent: bool) {
        self.frames += FRAMES;
        if self.frames > LASTS {
            self.frames = 0;
            self.reset();
            self.strike();
        }
        let bend = EventKind::PitchBend((self.frames / FRAMES % 100) as f32 / 100.0);
        let events = [Event { frame: 0, channel: 0, kind: bend }];
        self.synth.process(if bent { &events } else { &[] }, &mut self.left, &mut self.right);
    }
}
