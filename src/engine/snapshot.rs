//! State of a sounding instrument for a display: the motion of its masses, and its newest notes with their modulation.

use super::note::Note;
use super::voice::SynthVoice;
use crate::dsp::mode_bank::MAX_MODES;
use crate::params::Param;
use crate::patch::routes::{MAX_ROUTES, Route, Source};
use crate::units::db_from_gain;

/// Maximum number of notes in a snapshot.
pub(crate) const SHOWN_NOTES: usize = 16;

/// A note that sounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SoundingNote {
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// MIDI key, 0–127.
    pub key: u8,
    /// Velocity of its last strike, 0–1.
    pub velocity: f32,
    /// Its pitch in semitones on the MIDI scale, with glide, sweep, bend and vibrato.
    pub pitch: f32,
    /// Seconds since its last strike.
    pub age: f32,
    /// Parameters that its routes and its own offsets modulate, with their current values. A parameter that only strikes
    /// read has the value of the last strike.
    pub moved: [Option<(Param, f32)>; MAX_ROUTES],
    /// The values of the sources, in the order of [`Source::ALL`], as routes read them. Those that no route reads may be old.
    pub sources: [f32; Source::ALL.len()],
    /// How far the three oscillators are in their cycle, 0–1, and the two envelopes: the number of the stage (delay, attack, hold,
    /// decay, sustain, release; 6 when over) and the share of it that has passed. −1 for those that none of its routes reads.
    pub progress: [f32; 5],
}

impl SoundingNote {
    /// By how much of its destination's travel a route with this amount in per cent moves it now. Real-time safe.
    pub fn travel(&self, route: &Route, amount: f32) -> f32 {
        let scale = route.scale.map_or(1.0, |scale| self.sources[scale as usize]);
        0.01 * amount * route.response.apply(self.sources[route.source as usize]) * scale
    }
}

/// The state of one mass, or the sum over the voices that have the same mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Displacement. A strike of full force has an amplitude of 1.
    pub displacement: f32,
    /// Squared amplitude.
    pub energy: f32,
}

/// The sounding masses and notes at one moment. Plain data of fixed size; making one is real-time safe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapshot {
    /// Number of voices that play or fade.
    pub voices: u32,
    /// By how many decibels the limiter lowers the sound.
    pub lowered: f32,
    /// The masses by mode number, added up over all voices; of a kit, over those that play the sound of the newest note. Modes after
    /// the first [`MAX_MODES`] are left out.
    pub masses: [Mass; MAX_MODES],
    /// The notes whose last strikes are the newest, the newest first; none after the last.
    pub notes: [Option<SoundingNote>; SHOWN_NOTES],
}

impl Default for Snapshot {
    /// Silence.
    fn default() -> Self {
        Self { voices: 0, lowered: 0.0, masses: [Mass::default(); MAX_MODES], notes: [None; SHOWN_NOTES] }
    }
}

impl Snapshot {
    /// Sets the gain of the limiter, an amplitude ratio of at most 1.
    pub(super) fn set_limiter(&mut self, gain: f64) {
        self.lowered = -db_from_gain(gain).min(0.0) as f32;
    }

    /// Adds a voice that plays `note`, with or without its masses.
    pub(super) fn add(&mut self, note: &Note, voice: &SynthVoice, has_masses: bool) {
        // The unison voices of a note have the same routes.
        if voice.unison_index() == 0 {
            self.add_note(note, voice);
        }
        self.voices += 1;
        if !has_masses {
            return;
        }
        for (mass, (displacement, energy)) in self.masses.iter_mut().zip(voice.bank.masses()) {
            mass.displacement += displacement;
            mass.energy += energy;
        }
    }

    /// Inserts a note before the older ones. If all places are taken, the oldest is left out.
    fn add_note(&mut self, note: &Note, voice: &SynthVoice) {
        let (age, pitch) = (voice.age() as f32, voice.sounding_pitch() as f32);
        let Some(place) = self.notes.iter().position(|other| other.is_none_or(|other| age < other.age)) else { return };
        self.notes[place..].rotate_right(1);
        let mut shown = SoundingNote {
            channel: note.channel,
            key: note.key,
            velocity: note.velocity,
            pitch,
            age,
            sources: voice.sources(),
            progress: voice.progress(),
            ..Default::default()
        };
        let mut count = 0;
        voice.each_moved(|param, value| {
            let is_new = shown.moved.iter().flatten().all(|(known, _)| *known != param);
            if is_new && let Some(place) = shown.moved.get_mut(count) {
                *place = Some((param, value));
                count += 1;
            }
        });
        self.notes[place] = Some(shown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Ensemble, Event, EventKind, Synth};
    use crate::patch::routes::{Route, Routes, Source, amount_param};
    use crate::patch::{Mode, ModeTable, Patch};
    use crate::preset::{Playable, Preset};

    #[test]
    fn struck_masses_are_seen_to_move_and_to_come_to_rest() {
        let quiet = Mode { level: 0.5, ratio: 2.0, ..Mode::UNIT };
        let patch = Patch { modes: ModeTable::new(&[Mode::UNIT, quiet]), ..Patch::default() };
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
        assert_eq!(ensemble.snapshot(), Snapshot::default());
        let (mut left, mut right) = ([0.0; 27], [0.0; 27]);
        let events = [0, 3].map(|channel| Event { channel, ..Event::note_on(0, 69, 1.0) });
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

    #[test]
    fn notes_tell_what_moves_their_parameters() {
        let mut patch =
            Patch::default().with(Param::Pan, 10.0).with(Param::MalletHardness, 20.0).with(Param::Macro1, 40.0);
        // The default patch has a route from the modulation wheel to vibrato.
        patch.routes = Routes::NONE;
        let routes = [
            (Source::Velocity, Param::MalletHardness),
            (Source::Key, Param::Pan),
            (Source::Wheel, Param::Macro1),
            (Source::Wheel, amount_param(4)),
        ];
        for (place, (source, destination)) in routes.into_iter().enumerate() {
            patch.routes.set(place, Some(Route::linear(source, destination)));
            patch.set(amount_param(place), 50.0);
        }
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
        let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
        for (key, velocity) in [(60, 0.5), (90, 0.25)] {
            let strike = Event { channel: 2, ..Event::note_on(0, key, velocity) };
            ensemble.process(&[strike], &mut left, &mut right);
        }
        let wheel = EventKind::Control { controller: 1, value: 1.0 };
        ensemble.process(&[Event { frame: 0, channel: 2, kind: wheel }], &mut left, &mut right);
        let notes = ensemble.snapshot().notes;
        let [Some(newest), Some(first), None, ..] = notes else { panic!("{notes:?}") };
        assert_eq!((newest.channel, newest.key, first.key, newest.velocity), (2, 90, 60, 0.25));
        assert!((newest.age - 0.02).abs() < 1e-6 && (first.age - 0.03).abs() < 1e-6, "{notes:?}");
        assert!((newest.pitch - 90.0).abs() < 1e-4, "{newest:?}");
        let moved = |note: &SoundingNote| {
            [Param::MalletHardness, Param::Pan, Param::Macro1, amount_param(4)].map(|param| {
                note.moved.iter().flatten().find(|(moved, _)| *moved == param).map_or(f32::NAN, |(_, value)| *value)
            })
        };
        // Half of the knob's travel, times the source: of 100 % for hardness and macro, of 200 for pan and amount.
        let near =
            |found: [f32; 4], expected: [f32; 4]| found.iter().zip(expected).all(|(one, two)| (one - two).abs() < 1e-3);
        assert!(near(moved(&first), [45.0, 10.0, 90.0, 100.0]), "{:?}", moved(&first));
        assert!(near(moved(&newest), [32.5, 60.0, 90.0, 100.0]), "{:?}", moved(&newest));
        let source = |note: &SoundingNote, source| note.sources[source as usize];
        assert_eq!([Source::Velocity, Source::Wheel].map(|of| source(&newest, of)), [0.25, 1.0]);
        let by = Route { scale: Some(Source::Velocity), ..Route::linear(Source::Wheel, Param::Pan) };
        assert!((newest.travel(&by, -40.0) + 0.1).abs() < 1e-6, "{}", newest.travel(&by, -40.0));
    }

    #[test]
    fn notes_tell_how_far_oscillators_and_envelopes_are() {
        let mut patch = Patch::default().with(Param::Lfo2Rate, 5.0).with(Param::Envelope1Attack, 0.1);
        for (place, source) in [Source::Lfo2, Source::Envelope1].into_iter().enumerate() {
            patch.routes.set(place, Some(Route::linear(source, Param::Pan)));
        }
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
        let (mut left, mut right) = ([0.0; 2400], [0.0; 2400]);
        ensemble.process(&[Event::note_on(0, 60, 1.0)], &mut left, &mut right);
        let Some(note) = ensemble.snapshot().notes[0] else { panic!("it sounds") };
        // A quarter of a cycle, and half of the attack, which is stage 1.
        let near = |found: f32, expected: f32| (found - expected).abs() < 0.02;
        assert_eq!([note.progress[0], note.progress[4]], [-1.0; 2], "no route reads them");
        assert!(near(note.progress[1], 0.25) && near(note.progress[3], 1.5), "{:?}", note.progress);
        let value = |source| note.sources[source as usize];
        assert!(near(value(Source::Lfo2), 1.0), "{:?}", note.sources);
        assert!((0.3..0.9).contains(&value(Source::Envelope1)), "{:?}", note.sources);
    }

    #[test]
    fn of_many_notes_the_newest_are_told() {
        let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default(), &[]);
        let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
        for key in 40..40 + SHOWN_NOTES as u8 + 4 {
            ensemble.process(&[Event::note_on(0, key, 1.0)], &mut left, &mut right);
        }
        let keys = ensemble.snapshot().notes.map(|note| note.map_or(0, |note| note.key));
        let expected: [u8; SHOWN_NOTES] = std::array::from_fn(|place| 59 - place as u8);
        assert_eq!(keys, expected);
    }

    #[test]
    fn the_masses_of_a_kit_are_those_of_its_newest_note() {
        let text =
            "kit = 1\nname = \"k\"\nkeys = [{ key = 36, sound = \"init\" }, { key = 49, sound = \"Church Bell\" }]";
        let kit = Playable::parse(text, "x", &mut |name| Preset::find(name).cloned()).unwrap();
        let masses = |keys: &[u8]| {
            let mut synth = Synth::new(48_000.0, 0);
            synth.set_kit(&kit.kit());
            for key in keys {
                synth.handle(&Event::note_on(0, *key, 0.8));
                synth.process(&[], &mut [0.0; 600], &mut [0.0; 600]);
            }
            let mut snapshot = Snapshot::default();
            synth.show(&mut snapshot);
            assert_eq!(snapshot.notes.iter().flatten().count(), keys.len());
            snapshot.masses.map(|mass| mass.energy)
        };
        let moving = |masses: &[f32]| masses.iter().filter(|energy| **energy > 0.0).count();
        let (bell, mass) = (moving(&masses(&[49])), moving(&masses(&[36])));
        assert!(mass == 1 && bell > 30, "{mass} {bell}");
        assert_eq!((moving(&masses(&[36, 49])), moving(&masses(&[49, 36]))), (bell, mass));
    }
}
