//! Named cases that once exploded.

use super::case::{Case, voices_alone};
use super::check::check;
use crate::events::{event, off, on};
use sprung::engine::{Event, EventKind};
use sprung::params::Param;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;
use sprung::sound::bodies::{Body, Model};
use sprung::sound::pairs::{Link, Pair};
use sprung::units::key_from_frequency;

/// A case on one synth at 48 kHz.
fn case(patch: Patch, events: Vec<Event>, frames: usize) -> Case {
    let (sample_rate, seed, ensemble, programs, block) = (48_000.0, 1, false, vec![], 512);
    Case { sample_rate, seed, ensemble, outputs: false, patch: voices_alone(patch), programs, block, events, frames }
}

fn preset(name: &str) -> Patch {
    Preset::find(name).unwrap().patch.clone()
}

/// Plays a case, which must stay within its bound and reach at least `share` of it.
fn stays_bounded(name: &str, storm: &Case, share: f64) {
    match check(storm) {
        Ok(reached) => {
            let reached = reached.unwrap_or(0.0);
            println!("{name}: {reached:.3} of its bound");
            assert!(reached >= share, "{name}: only {reached} of its bound");
        }
        Err(failure) => panic!("{name}: {failure}"),
    }
}

#[test]
fn a_note_let_go_in_the_middle_of_a_wide_glide() {
    let patch = Patch::default().with(Param::Glide, 0.3).with(Param::Release, 0.005);
    let events = vec![on(6001, 119), on(6024, 4), off(6145, 4)];
    let storm = Case { sample_rate: 44_100.0, ..case(patch, events, 44_100) };
    stays_bounded("key 119, key 4, off", &storm, 0.4);
}

#[test]
fn a_note_let_go_50_ms_into_a_glide_over_seven_octaves() {
    for mode in [0.0, 1.0, 2.0] {
        for release in [0.005, 0.3] {
            let patch = Patch::default().with(Param::Glide, 1.0).with(Param::Mode, mode).with(Param::Release, release);
            let events = vec![on(0, 108), on(4800, 24), off(7200, 24), off(7200, 108)];
            stays_bounded("C8 to C1", &case(patch, events, 96_000), 0.4);
        }
    }
}

#[test]
fn deep_vibrato_just_below_nyquist() {
    let patch = Patch::default().with(Param::Vibrato, 800.0).with(Param::VibratoRate, 20.0).with(Param::Decay, 60.0);
    let key = key_from_frequency(23_000.0, 440.0);
    let detune = (key - 127.0) as f32;
    let note = event(0, EventKind::NoteOn { key: 127, detune, velocity: 1.0, id: None });
    stays_bounded("23 kHz", &case(patch, vec![note], 480_000), 0.5);
}

#[test]
fn deep_vibrato_on_many_modes() {
    let patch = preset("Swell").with(Param::Vibrato, 1200.0).with(Param::VibratoRate, 20.0);
    let storm = Case { sample_rate: 22_050.0, ..case(patch, vec![on(0, 115)], 22_050 * 10) };
    stays_bounded("Swell", &storm, 0.0);
}

#[test]
fn vibrato_of_an_octave_on_the_highest_key_of_a_piano() {
    let patch = Patch::default().with(Param::Vibrato, 1200.0).with(Param::VibratoRate, 20.0);
    let storm = Case { sample_rate: 44_100.0, ..case(patch, vec![on(0, 108)], 44_100) };
    stays_bounded("C8", &storm, 0.9);
}

/// With every fifth factory preset.
#[test]
fn quick_strikes_in_mono_that_are_never_let_go() {
    for preset in Preset::factory().iter().step_by(5) {
        for interval in [80, 7] {
            let patch = preset.patch.clone().with(Param::Mode, 1.0).with(Param::Sweep, 16.7);
            let events = (0..300).map(|n| on(n * interval, 48 + (n * 7 % 40) as u8)).collect();
            stays_bounded(&preset.name, &case(patch, events, 300 * interval as usize + 48_000), 0.0);
        }
    }
}

/// A string joined to a plate, whose notes change the mode table while they ring.
#[test]
fn joined_bodies_slide_from_key_to_key() {
    let body = |model, modes| Body { modes, ..Body::new(Model::find(model).unwrap().clone()) };
    let plate = Body { follows_key: false, ..body("plate", 20) };
    for (link, mode) in [(Link::Rigid, 1.0), (Link::Spring { stiffness: 900.0, damping: 1.0 }, 2.0)] {
        let pair = Pair { polarisation: 0.5, keys: [40, 80], ..Pair::new(body("string", 20), plate.clone(), link) };
        let patch = Patch { modes: pair.table().unwrap(), ..Patch::default() };
        for (glide, level) in [(0.0, -60.0), (0.2, 0.0)] {
            let patch = patch.clone().with(Param::Mode, mode).with(Param::Glide, glide).with(Param::NoiseLevel, level);
            let events = (0..100).map(|n| on(n * 301, 40 + (n * 7 % 40) as u8)).collect();
            stays_bounded("string on a plate", &case(patch, events, 96_000), 0.01);
        }
    }
}

/// Rounding errors must not add up either: hundreds of thousands of frames with the smallest possible damping.
#[test]
fn the_longest_decay_at_the_highest_rate() {
    for (sample_rate, key) in [(768_000.0, 60), (768_000.0, 127), (48_000.0, 127), (44_100.0, 21)] {
        let patch = Patch::default().with(Param::Decay, 60.0).with(Param::Vibrato, 30.0);
        let mut low = patch.clone().with(Param::DecayTilt, 2.0);
        low.modes = ModeTable::new(&[Mode { ratio: 0.25, decay: 10.0, ..Mode::UNIT }]);
        for patch in [patch.clone(), patch.with(Param::Vibrato, 0.0), low] {
            let storm = Case { sample_rate, ..case(patch, vec![on(0, key)], sample_rate as usize * 4) };
            stays_bounded("long", &storm, 0.9);
        }
    }
}
