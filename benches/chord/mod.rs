//! Chords on a synth, which the benches of whole instruments time.

use sprung::dsp::MAX_MODES;
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::routes::{Route, Routes, Source, amount_param};
use sprung::patch::{Mode, ModeTable, Patch};

/// Frames of a block, typical of a host with low latency.
pub(crate) const FRAMES: usize = 64;

/// A chord is struck again after this many frames, long before its modes have decayed and become cheaper.
const LASTS: usize = 8 * 48_000;

/// A patch of 64 modes, for up to `voices` notes.
pub(crate) fn patch(voices: usize) -> Patch {
    let mut patch = Patch::default().with(Param::Decay, 60.0).with(Param::Voices, voices as f32);
    let mode = |m: usize| Mode { ratio: 1.0 + 0.3 * m as f32, level: 0.1, decay: 10.0, ..Mode::UNIT };
    patch.modes = ModeTable::new(&(0..MAX_MODES).map(mode).collect::<Vec<_>>());
    patch
}

/// Adds vibrato and a long sweep to every voice; [`Chord::process`] adds the bend.
pub(crate) fn moving(patch: Patch) -> Patch {
    patch.with(Param::Vibrato, 30.0).with(Param::Sweep, 12.0).with(Param::SweepTime, 10.0)
}

/// [`moving`] with sixteen routes instead of those of a new patch. Their sources are three oscillators and two
/// envelopes that move during every note.
pub(crate) fn routed(patch: Patch) -> Patch {
    let mut patch = moving(patch).with(Param::Envelope1Attack, 20.0).with(Param::Envelope2Decay, 60.0);
    patch.routes = Routes::NONE;
    let sources = [Source::Lfo1, Source::Lfo2, Source::Lfo3, Source::Envelope1, Source::Envelope2];
    let destinations = [Param::Tune, Param::Gain, Param::Pan, Param::Vibrato, Param::VibratoRate, Param::Fine];
    for place in 0..16 {
        let route = Route::linear(sources[place % sources.len()], destinations[place % destinations.len()]);
        let scale = (place % 4 == 3).then_some(sources[(place + 1) % sources.len()]);
        patch.routes.set(place, Some(Route { scale, ..route }));
        patch = patch.with(amount_param(place), 1.0 + place as f32 * 0.1);
    }
    patch
}

/// A synth that plays a chord.
pub(crate) struct Chord {
    synth: Synth,
    strikes: Vec<Event>,
    left: [f32; FRAMES],
    right: [f32; FRAMES],
    frames: usize,
}

impl Chord {
    /// A chord of this many notes, struck just now.
    pub(crate) fn new(patch: &Patch, voices: usize) -> Self {
        let mut synth = Synth::new(48_000.0, 1);
        synth.set_patch(patch);
        let strikes = (0..voices).map(|voice| Event::note_on(0, (36 + voice % 64) as u8, 1.0)).collect();
        let mut chord = Self { synth, strikes, left: [0.0; FRAMES], right: [0.0; FRAMES], frames: 0 };
        chord.strike();
        assert_eq!(chord.synth.voices_used(), voices);
        chord
    }

    /// Strikes all notes, in the first block after a reset.
    pub(crate) fn strike(&mut self) {
        self.synth.process(&self.strikes, &mut self.left, &mut self.right);
    }

    /// Silences the synth.
    pub(crate) fn reset(&mut self) {
        self.synth.reset();
    }

    /// The next block. If `bent`, the pitch wheel has moved.
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
