//! Random input: nothing panics, no note stays on, and the state can be read back.

use super::dropped::{Dropped, asset};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::state::State;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, pos2, vec2};
use std::sync::Arc;

/// Sounds, windows and themes.
const CASES: [(&str, [u32; 2], Theme); 4] = [
    ("Glass Marimba", SIZE, Theme::Dark),
    ("Marimba", LEAST_SIZE, Theme::Light),
    ("Hand Kit", SIZE, Theme::HighContrast),
    ("init", LEAST_SIZE, Theme::Dark),
];
/// Number of events for each of them in the commit's suite.
const FEW: usize = 1_000;
/// Most events between two passes.
const AT_ONCE: usize = 6;
const KEYS: [Key; 9] = [
    Key::Enter,
    Key::Escape,
    Key::Tab,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::Delete,
    Key::Backspace,
    Key::PageUp,
    Key::Num1,
];
const TEXTS: [&str; 5] = ["1", "250 ms", "bell", "ä", "-"];

/// Pseudorandom numbers below a limit, the same in each run (Numerical Recipes, 7.1).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit
    }
}

/// One of the files that a user may drop.
fn file(number: usize) -> Arc<Dropped> {
    let files = ["scales/19-equal.scl", "scales/19-equal-on-white-keys.kbm", "kits/hand-kit.toml", "scales/none.scl"];
    Arc::new(Dropped(asset(files[number % files.len()])))
}

/// A random event at the present place, or a movement to another place.
fn event(numbers: &mut Numbers, place: &mut Pos2, size: [u32; 2]) -> Event {
    let modifiers = match numbers.below(8) {
        0 => Modifiers::SHIFT,
        1 => Modifiers::ALT,
        2 => Modifiers::CTRL,
        _ => Modifiers::NONE,
    };
    let button = if numbers.below(5) == 0 { PointerButton::Secondary } else { PointerButton::Primary };
    match numbers.below(10) {
        0..=3 => {
            // Near the last place, or anywhere.
            let near = vec2(numbers.below(60) as f32 - 30.0, numbers.below(60) as f32 - 30.0);
            let any = pos2(numbers.below(size[0] as usize) as f32, numbers.below(size[1] as usize) as f32);
            *place = if numbers.below(2) == 0 { *place + near } else { any };
            Event::PointerMoved(*place)
        }
        4 | 5 => Event::PointerButton { pos: *place, button, pressed: true, modifiers },
        6 | 7 => Event::PointerButton { pos: *place, button, pressed: false, modifiers },
        8 => Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, numbers.below(5) as f32 - 2.0),
            modifiers,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Unknown,
        },
        _ if numbers.below(2) == 0 => Event::Text(TEXTS[numbers.below(TEXTS.len())].to_owned()),
        _ => {
            let key = KEYS[numbers.below(KEYS.len())];
            Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
        }
    }
}

fn storm(case: usize, events: usize) {
    let ((sound, size, theme), seed) = (CASES[case], case as u64 + 1);
    let mut band = Band::new(sound, size, theme);
    let mut numbers = Numbers(seed);
    let mut place = pos2(0.0, 0.0);
    let mut left = events;
    while left > 0 {
        let count = (1 + numbers.below(AT_ONCE)).min(left);
        left -= count;
        for _ in 0..count {
            let event = event(&mut numbers, &mut place, size);
            band.stage.harness.input_mut().events.push(event);
        }
        if numbers.below(200) == 0 {
            let file = file(numbers.below(4));
            band.stage.harness.input_mut().dropped_files.push(file);
        }
        band.passes(1);
    }
    for button in [PointerButton::Primary, PointerButton::Secondary] {
        let (pressed, modifiers) = (false, Modifiers::NONE);
        band.stage.harness.event(Event::PointerButton { pos: place, button, pressed, modifiers });
    }
    band.stage.harness.event(Event::PointerGone);
    band.passes(60);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "seed {seed}: no key is left down");
    let state = band.stage.params.state();
    let read = State::parse(&state.to_json()).unwrap();
    assert_eq!((read.state, read.complaints), (state, vec![]), "seed {seed}");
}

#[test]
fn random_events_do_no_harm_to_a_pair_of_bodies() {
    storm(0, FEW);
}

#[test]
fn random_events_do_no_harm_in_a_small_window() {
    storm(1, FEW);
}

#[test]
fn random_events_do_no_harm_to_a_kit() {
    storm(2, FEW);
}

#[test]
fn random_events_do_no_harm_to_a_single_mass() {
    storm(3, FEW);
}

#[test]
#[ignore = "takes half a minute"]
fn many_random_events_do_no_harm() {
    (0..CASES.len()).for_each(|case| storm(case, 5_000));
}
