//! Checks that what the hands do with a sound is heard: each of its macros, and the wheel.

use super::whole_bank;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use sprung::analysis::log_mel::{RATE, distance};
use sprung::engine::{Event, EventKind, Synth};
use sprung::patch::Patch;
use sprung::patch::routes::{Source, macro_param};
use sprung::preset::Preset;

/// Least change in dB, on average over all bands of a note of a second and its release. A scoop of a tenth of a second into
/// the note changes a third of a dB.
const HEARD_DB: f64 = 0.25;

const MODULATION_WHEEL: u8 = 1;

/// A note on the preset's home key after an event.
fn played(preset: &Preset, patch: Patch, before: Option<EventKind>) -> Vec<f32> {
    let mut synth = Synth::new(f64::from(RATE), 1);
    synth.set_kit(&Preset { patch, ..preset.clone() }.kit());
    let before = before.map(|kind| Event { frame: 0, channel: 0, kind });
    let note = [Event::note_on(0, preset.guide.home, 0.8), Event::note_off(RATE, preset.guide.home)];
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; 3 * RATE as usize / 2]);
    synth.process(&before.into_iter().chain(note).collect::<Vec<_>>(), &mut left, &mut right);
    left
}

/// What is not heard of a preset's macros and of the wheel.
fn idle(preset: &Preset) -> Vec<String> {
    let mut idle = Vec::new();
    let at_rest = played(preset, preset.patch.clone(), None);
    let mut listen = |what: &str, moved: &[f32]| {
        let change = distance(&at_rest, moved);
        if change < HEARD_DB {
            idle.push(format!("{}: {what} changes {change:.2} dB", preset.name));
        }
    };
    for (name, param) in preset.guide.macros.iter().zip((0..).map_while(macro_param)) {
        listen(name, &played(preset, preset.patch.clone().with(param, 100.0), None));
    }
    let wheel = EventKind::Control { controller: MODULATION_WHEEL, value: 1.0 };
    listen("the wheel", &played(preset, preset.patch.clone(), Some(wheel)));
    idle
}

fn are_heard(presets: Vec<&Preset>) {
    let idle: Vec<String> = presets.par_iter().flat_map(|preset| idle(preset)).collect();
    assert!(idle.is_empty(), "{} are hardly heard:\n{}", idle.len(), idle.join("\n"));
}

#[test]
fn macros_and_wheel_of_every_sixteenth_preset_are_heard() {
    are_heard(whole_bank().into_iter().step_by(16).collect());
}

#[test]
#[ignore = "takes half a minute"]
fn macros_and_wheel_of_every_preset_are_heard() {
    are_heard(whole_bank());
}

#[test]
fn every_preset_has_four_macros_of_different_names_and_follows_the_wheel() {
    for Preset { name, guide, patch, .. } in whole_bank() {
        let mut names = guide.macros.clone();
        names.sort();
        names.dedup();
        assert!(names.len() >= 4 && names.len() == guide.macros.len(), "{name}: {:?}", guide.macros);
        assert!(patch.routes.iter().any(|(_, route)| route.source == Source::Wheel), "{name}");
        // No two macros do the same, or undo each other.
        let mut moved: Vec<Vec<_>> = (0..guide.macros.len())
            .map(|number| {
                let source = Source::ALL[Source::Macro1 as usize + number];
                let follows =
                    patch.routes.iter().filter(|(_, route)| [Some(route.source), route.scale].contains(&Some(source)));
                follows
                    .map(|(_, route)| (route.scale.map(|_| route.source as usize), route.destination as usize))
                    .collect()
            })
            .collect();
        assert!(moved.iter().all(|moved| !moved.is_empty()), "{name}: a macro moves nothing: {moved:?}");
        moved.sort();
        moved.dedup();
        assert_eq!(moved.len(), guide.macros.len(), "{name}: two macros move the same");
    }
}
