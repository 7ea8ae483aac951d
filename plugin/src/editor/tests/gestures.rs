//! The user's actions on knobs, and the gestures that the host receives.

use super::fake_host::Call;
use super::pictures::{Stage, stage};
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::widgets::knob::face_in;
use crate::marks::{Automation, Mapping};
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::params::Param;
use sprung::patch::routes::{MAX_ROUTES, Source, amount_param};
use std::sync::atomic::Ordering::Relaxed;

impl Stage {
    fn new() -> Self {
        let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
        stage.tab("Mallet");
        // The next click is none that follows this one.
        stage.harness.run_steps(40);
        stage
    }

    pub(super) fn at(&self, name: &str) -> Pos2 {
        self.harness.get_by_role_and_label(Role::Slider, name).rect().center() - vec2(0.0, 10.0)
    }

    fn value(&self, param: Param) -> f32 {
        self.params.state().values.get(param)
    }

    fn steps(&mut self, events: &[Event]) {
        for event in events {
            self.harness.event(event.clone());
            self.harness.step();
        }
        self.harness.run_steps(3);
    }

    fn press(&self, pos: Pos2, pressed: bool, modifiers: Modifiers) -> Event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers }
    }

    pub(super) fn drag(&mut self, from: Pos2, by: egui::Vec2, modifiers: Modifiers) {
        let half = Event::PointerMoved(from + by * 0.5);
        let (down, up) = (self.press(from, true, modifiers), self.press(from + by, false, modifiers));
        let events = [Event::PointerMoved(from), down, half, Event::PointerMoved(from + by), up];
        self.steps(&[Event::ModifiersChanged(modifiers)]);
        self.steps(&events);
        self.steps(&[Event::ModifiersChanged(Modifiers::NONE)]);
    }

    pub(super) fn click(&mut self, pos: Pos2) {
        let events =
            [Event::PointerMoved(pos), self.press(pos, true, Modifiers::NONE), self.press(pos, false, Modifiers::NONE)];
        self.steps(&events);
    }

    pub(super) fn button(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.harness.run_steps(3);
    }

    pub(super) fn tab(&mut self, name: &str) {
        self.harness.get_by_role_and_label(Role::Tab, name).click();
        self.harness.run_steps(3);
    }
}

/// Whether the messages are one begin and one end, with only values between them.
fn is_one_gesture(calls: &[Call], name: &str) -> bool {
    let [Call::Begin(first), sets @ .., Call::End(last)] = calls else { return false };
    let is_set = |calls: &Call| matches!(calls, Call::Set(set, _) if set == name);
    first == name && last == name && !sets.is_empty() && sets.iter().all(is_set)
}

#[test]
fn a_drag_is_one_gesture_and_one_step_to_undo() {
    let mut stage = Stage::new();
    let before = stage.params.state();
    let knob = stage.at("Mallet hardness");
    stage.drag(knob, vec2(0.0, -22.0), Modifiers::NONE);
    let moved = stage.value(Param::MalletHardness) - before.values.get(Param::MalletHardness);
    assert!((5.0..15.0).contains(&moved), "a tenth of the travel: {moved}");
    let calls = stage.host.calls();
    assert!(is_one_gesture(&calls, "Mallet hardness"), "{calls:?}");
    stage.button("Undo");
    assert_eq!(stage.params.state(), before);
    let calls = stage.host.calls();
    assert!(is_one_gesture(&calls, "Mallet hardness"), "{calls:?}");
    stage.button("Redo");
    assert_eq!(stage.value(Param::MalletHardness) - before.values.get(Param::MalletHardness), moved);
}

#[test]
fn shift_is_ten_times_finer() {
    let drag = |modifiers| {
        let mut stage = Stage::new();
        let before = stage.value(Param::MalletHardness);
        let knob = stage.at("Mallet hardness");
        stage.drag(knob, vec2(0.0, -44.0), modifiers);
        stage.value(Param::MalletHardness) - before
    };
    let (coarse, fine) = (drag(Modifiers::NONE), drag(Modifiers::SHIFT));
    assert!((coarse / fine - 10.0).abs() < 0.5, "{coarse} {fine}");
}

/// A turn of the wheel by some lines.
pub(super) fn wheel(lines: f32) -> Event {
    Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, lines),
        modifiers: Modifiers::NONE,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
    }
}

#[test]
fn the_wheel_turns_and_a_double_click_resets() {
    let mut stage = Stage::new();
    let knob = stage.at("Mallet speed");
    let before = stage.value(Param::MalletSpeed);
    stage.steps(&[Event::PointerMoved(knob), wheel(2.0)]);
    assert!((stage.value(Param::MalletSpeed) - before - 2.0).abs() < 1e-3, "two steps of 1 %");
    stage.click(knob);
    stage.click(knob);
    assert_eq!(stage.value(Param::MalletSpeed), Param::MalletSpeed.info().default);
    assert_eq!(stage.host.calls().iter().filter(|calls| matches!(calls, Call::Begin(_))).count(), 2);
}

/// Turns of the wheel that follow each other are one step, parts of a step of a touchpad add up, and undo leaves alone what a host has
/// moved since.
#[test]
fn a_run_of_the_wheel_is_one_step_and_undo_moves_no_other_knob() {
    let mut stage = Stage::new();
    let before = stage.params.state();
    let knob = stage.at("Mallet speed");
    stage.steps(&[Event::PointerMoved(knob), wheel(1.0), wheel(1.0), wheel(1.0)]);
    let automated = &stage.params.knobs()[Param::Tilt as usize];
    automated.turn(0.9);
    let tilt = stage.value(Param::Tilt);
    assert!(tilt != before.values.get(Param::Tilt));
    stage.host.calls();
    stage.button("Undo");
    assert_eq!(stage.value(Param::MalletSpeed), before.values.get(Param::MalletSpeed));
    assert_eq!(stage.value(Param::Tilt), tilt);
    let calls = stage.host.calls();
    assert!(is_one_gesture(&calls, "Mallet speed"), "{calls:?}");
    stage.button("Redo");
    assert!((stage.value(Param::MalletSpeed) - before.values.get(Param::MalletSpeed) - 3.0).abs() < 1e-3);
    assert_eq!(stage.value(Param::Tilt), tilt);

    let pulse = stage.harness.get_by_role_and_label(Role::ComboBox, "Mallet pulse").rect().center();
    let kind = stage.value(Param::MalletPulse);
    stage.steps(&[Event::PointerMoved(pulse), wheel(-0.4)]);
    assert_eq!(stage.value(Param::MalletPulse), kind);
    stage.steps(&[wheel(-0.4), wheel(-0.4)]);
    assert_eq!(stage.value(Param::MalletPulse), kind - 1.0);
}

#[test]
fn a_wheel_that_scrolls_a_page_turns_no_knob_until_the_pointer_rests_on_one() {
    // There the page is wider than the window.
    let mut stage = stage("Church Bell", LEAST_SIZE, 1.0, Theme::Dark);
    stage.tab("Knobs");
    let value = |stage: &Stage| stage.value(Param::Damper);
    let left = |stage: &Stage| stage.at("Damper").x;
    let turn = |stage: &mut Stage, lines: f32| {
        stage.harness.event(wheel(lines));
        stage.harness.run_steps(40);
    };
    let (before, at) = (value(&stage), stage.at("Damper"));
    stage.harness.event(Event::PointerMoved(at));
    stage.harness.step();
    turn(&mut stage, -1.0);
    let scrolled = left(&stage);
    assert!(scrolled < at.x && value(&stage) == before, "{scrolled} {at}");
    turn(&mut stage, 1.0);
    assert_eq!((left(&stage), value(&stage)), (at.x, before), "it goes on scrolling");
    stage.harness.event(Event::PointerMoved(at + vec2(1.0, 0.0)));
    stage.harness.run_steps(40);
    turn(&mut stage, 1.0);
    assert!(left(&stage) == at.x && value(&stage) > before, "now the knob is meant");
}

#[test]
fn a_value_is_typed_in_its_unit_and_nonsense_is_not_taken() {
    let mut stage = Stage::new();
    stage.tab("Noise");
    let typed = |stage: &mut Stage, text: &str, key: Key| {
        stage.button("Type Noise time");
        stage.harness.event(Event::Text(text.to_owned()));
        stage.harness.run_steps(2);
        stage.harness.key_press(key);
        stage.harness.run_steps(3);
    };
    typed(&mut stage, "250 ms", Key::Enter);
    assert_eq!(stage.value(Param::NoiseTime), 0.25);
    assert!(is_one_gesture(&stage.host.calls(), "Noise time"));
    typed(&mut stage, "100 ms", Key::Escape);
    assert_eq!(stage.value(Param::NoiseTime), 0.25);
    typed(&mut stage, "loud", Key::Enter);
    assert_eq!((stage.value(Param::NoiseTime), stage.host.calls()), (0.25, vec![]));
    // The field stays open for another attempt.
    stage.harness.event(Event::Text("1".to_owned()));
    stage.harness.run_steps(1);
    assert!(stage.harness.query_by_role_and_label(Role::TextInput, "Noise time").is_some());
}

#[test]
fn a_choice_opens_a_list() {
    let mut stage = Stage::new();
    let pulse = stage.value(Param::MalletPulse);
    stage.button("Mallet pulse");
    let choices = Param::MalletPulse.info().choices;
    let other = choices[1 - pulse as usize];
    stage.harness.get_by_role_and_label(Role::Button, other).click();
    stage.harness.run_steps(3);
    assert_eq!(stage.value(Param::MalletPulse), 1.0 - pulse);
    assert!(is_one_gesture(&stage.host.calls(), "Mallet pulse"));
}

#[test]
fn keys_turn_what_has_the_focus() {
    let mut stage = Stage::new();
    stage.harness.get_by_role_and_label(Role::Slider, "Mallet speed").focus();
    stage.harness.run_steps(2);
    let before = stage.value(Param::MalletSpeed);
    stage.harness.key_press(Key::ArrowUp);
    stage.harness.run_steps(2);
    assert!((stage.value(Param::MalletSpeed) - before - 1.0).abs() < 1e-3);
    let node = stage.harness.get_by_role_and_label(Role::Slider, "Mallet speed");
    let value = node.accesskit_node().numeric_value().unwrap();
    assert!((value as f32 - stage.value(Param::MalletSpeed)).abs() < 1e-3, "what a screen reader says");
}

#[test]
fn only_what_changed_is_announced_when_a_sound_is_loaded() {
    let mut stage = Stage::new();
    let before = stage.params.state();
    stage.button("Next sound");
    let after = stage.params.state();
    assert_ne!(before.playable.name(), after.playable.name());
    let changed = before.positions.iter().zip(after.positions).filter(|(one, other)| **one != *other).count();
    let calls = stage.host.calls();
    assert_eq!((calls.len(), changed > 0), (3 * changed, true), "begin, set and end for each");
    stage.button("Previous sound");
    assert_eq!(stage.params.state(), before);
}

#[test]
fn two_versions_are_compared() {
    let mut stage = Stage::new();
    stage.button("Copy A to B");
    let knob = stage.at("Mallet hardness");
    let before = stage.params.state();
    assert!(stage.paints("A = B"));
    stage.drag(knob, vec2(0.0, -30.0), Modifiers::NONE);
    let after = stage.params.state();
    assert!(stage.paints("A → B"), "they differ, and that is the way in which one is copied");
    stage.button("A or B");
    assert_eq!(stage.params.state(), before);
    assert!(stage.paints("B → A"));
    stage.button("A or B");
    assert_eq!(stage.params.state(), after);
    stage.button("Copy A to B");
    assert!(stage.paints("A = B"));
    stage.button("A or B");
    assert_eq!(stage.params.state(), after);
}

#[test]
fn a_route_is_added_by_a_right_click_and_changed_on_its_page() {
    let mut stage = Stage::new();
    let routes = |stage: &Stage| stage.params.loaded().kit.sounds()[0].patch().routes;
    let before = (stage.params.state(), routes(&stage));
    stage.harness.get_by_role_and_label(Role::Slider, "Mallet speed").click_secondary();
    stage.harness.run_steps(3);
    stage.harness.get_by_label_contains("Modulate by").click();
    stage.harness.run_steps(3);
    stage.button("LFO 1");
    let added = routes(&stage);
    let (place, route) = added.iter().find(|(place, route)| before.1.get(*place) != Some(*route)).unwrap();
    assert_eq!((route.source, route.destination), (Source::Lfo1, Param::MalletSpeed));
    assert_eq!(stage.value(amount_param(place)), 25.0);
    assert!(is_one_gesture(&stage.host.calls(), amount_param(place).info().name));
    stage.harness.get_by_role_and_label(Role::Tab, "Motion").click();
    stage.harness.run_steps(3);
    stage.harness.get_by_label(&format!("Route {}: LFO 1 › Mallet speed", place + 1));
    stage.button(&format!("Remove route {}", place + 1));
    assert_eq!(routes(&stage).get(place), None);
    for _ in 0..2 {
        stage.button("Undo");
    }
    assert_eq!(stage.params.state(), before.0);
}

#[test]
fn a_free_place_shows_no_amount_and_leaves_none_to_its_next_route() {
    let mut stage = Stage::new();
    stage.harness.get_by_role_and_label(Role::Tab, "Motion").click();
    stage.harness.run_steps(3);
    let routes = |stage: &Stage| stage.params.loaded().kit.sounds()[0].patch().routes;
    let has_knob = |stage: &Stage, place: usize| {
        let name = amount_param(place).info().name;
        assert_eq!(
            stage.harness.query_by_role_and_label(Role::Slider, name).is_some(),
            stage.harness.query_by_label(&format!("Type {name}")).is_some()
        );
        stage.harness.query_by_role_and_label(Role::Slider, name).is_some()
    };
    for place in 0..MAX_ROUTES {
        assert_eq!(has_knob(&stage, place), routes(&stage).get(place).is_some(), "route {}", place + 1);
    }
    // The last three have routes, and so amounts, in a new patch, but not in this sound.
    let place = MAX_ROUTES - 3;
    let param = amount_param(place);
    assert!(routes(&stage).get(place).is_none() && stage.value(param) != 0.0);
    let free: Vec<usize> = (0..=place).filter(|place| routes(&stage).get(*place).is_none()).collect();
    for (_, target) in free.iter().zip(["decay", "tilt", "vibrato", "mallet hardness", "noise level", "pan", "sweep"]) {
        stage.harness.get_by_label("New route").focus();
        stage.harness.run_steps(2);
        stage.type_text(&format!("lfo 2 {target}"));
        stage.harness.key_press(Key::Enter);
        stage.harness.run_steps(3);
    }
    assert!(routes(&stage).get(place).is_some_and(|route| route.source == Source::Lfo2) && has_knob(&stage, place));
    assert_eq!(stage.value(param), 25.0, "as of every new route");
    stage.button(&format!("Remove route {}", place + 1));
    assert!(!has_knob(&stage, place) && stage.value(param) == param.info().default);
}

#[test]
fn what_a_knob_does_is_said_at_the_pointer_once_that_rests() {
    let mut stage = Stage::new();
    let knob = stage.at("Mallet speed");
    let tip = |stage: &Stage| {
        let help = Param::MalletSpeed.info().help;
        stage.harness.query_by_label_contains(help).map(|tip| tip.rect().distance_to_pos(knob))
    };
    stage.harness.event(Event::PointerMoved(knob));
    stage.harness.run_steps(3);
    assert_eq!(tip(&stage), None, "it moves");
    stage.harness.run_steps(60);
    assert!(tip(&stage).is_some_and(|distance| distance < 50.0), "{:?}", tip(&stage));
    stage.harness.event(Event::PointerMoved(knob + vec2(0.0, 2.0)));
    stage.harness.run_steps(3);
    assert_eq!(tip(&stage), None, "it moves again");
}

#[test]
fn the_hosts_own_menu_opens_where_the_entry_is() {
    let mut stage = Stage::new();
    let open = |stage: &mut Stage| {
        stage.harness.get_by_role_and_label(Role::Slider, "Mallet speed").click_secondary();
        stage.harness.run_steps(3);
    };
    open(&mut stage);
    assert!(stage.harness.query_by_label("Host menu").is_none(), "this host has none");
    stage.harness.key_press(Key::Escape);
    stage.harness.run_steps(3);
    stage.host.has_menu.store(true, Relaxed);
    open(&mut stage);
    let entry = stage.harness.get_by_label("Host menu").rect();
    stage.button("Host menu");
    let [Call::Menu(name, [x, y])] = &stage.host.calls()[..] else { panic!("a menu and no gesture") };
    assert_eq!(name, Param::MalletSpeed.info().name);
    let there = pos2(*x as f32, *y as f32) / stage.harness.ctx.pixels_per_point();
    assert!(entry.expand(2.0).contains(there), "{there} {entry}");
    assert!(stage.harness.query_by_label("Host menu").is_none(), "the window's own menu is closed");
}

#[test]
fn undo_and_redo_bring_the_version_back_that_was_shown() {
    let mut stage = Stage::new();
    let is_b = |stage: &Stage| {
        stage.harness.get_by_label("A or B").accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    stage.button("A or B");
    assert!(is_b(&stage));
    stage.drag(stage.at("Mallet speed"), vec2(0.0, -20.0), Modifiers::NONE);
    let b = stage.params.state();
    stage.button("A or B");
    let a = stage.params.state();
    assert!(a != b && !is_b(&stage));
    stage.button("Undo");
    assert!(stage.params.state() == b && is_b(&stage));
    stage.button("A or B");
    assert!(stage.params.state() == a && !is_b(&stage), "the other version is still there");
    stage.button("Undo");
    stage.button("Redo");
    assert!(stage.params.state() == a && !is_b(&stage));
    stage.button("A or B");
    assert!(stage.params.state() == b && is_b(&stage));
}

#[test]
fn a_sound_is_varied_by_a_right_click_apart_from_what_is_locked() {
    let mut stage = Stage::new();
    let before = stage.params.state();
    let sound = format!("Sound: {}", before.playable.name());
    stage.harness.get_by_label(&sound).click_secondary();
    stage.harness.run_steps(3);
    stage.button("Lock Mallet");
    stage.button("Randomise");
    let after = stage.params.state();
    assert_ne!(after.values, before.values);
    for index in Param::MalletLevel as usize..=Param::MalletVelocity as usize {
        let param = sprung::params::PARAMS[index].param;
        assert_eq!(after.values.get(param), before.values.get(param), "{param:?}");
    }
    stage.button("Undo");
    assert_eq!(stage.params.state(), before);
}

#[test]
fn what_the_host_says_of_a_knob_is_shown_in_its_colours() {
    let mut stage = Stage::new();
    let knob = stage.harness.get_by_role_and_label(Role::Slider, "Mallet hardness").rect();
    let face = face_in(knob);
    let colours = |stage: &mut Stage| {
        stage.harness.run_steps(2);
        let picture = stage.harness.render().unwrap();
        [-4.0, 4.0].map(|aside| {
            let place = face.center_bottom() + vec2(aside, -3.0);
            let [red, green, blue, _] = picture.get_pixel(place.x as u32, place.y as u32).0;
            [red, green, blue]
        })
    };
    let before = colours(&mut stage);
    let (pink, blue) = ([230, 20, 120], [20, 90, 250]);
    let mapping = Mapping { colour: Some(pink), label: "Knob 3".to_owned(), description: String::new() };
    let index = Param::MalletHardness as usize;
    stage.params.mark(index, |mark| mark.mapping = Some(mapping));
    assert_eq!(colours(&mut stage), [pink, before[1]]);
    for (automation, is_filled) in [
        (Automation::Present, false),
        (Automation::Playing, true),
        (Automation::Recording, true),
        (Automation::Overriding, false),
    ] {
        stage.params.mark(index, |mark| mark.automation = Some((automation, Some(blue))));
        assert_eq!(colours(&mut stage)[1] == blue, is_filled, "{automation:?}");
    }
    let mark = stage.params.mark_of(index).unwrap();
    stage.params.mark(index, |mark| *mark = Default::default());
    assert_eq!(colours(&mut stage), before);
    stage.params.mark(index, |now| *now = mark);
    stage.harness.get_by_role_and_label(Role::Slider, "Mallet hardness").click_secondary();
    stage.harness.run_steps(3);
    stage.harness.get_by_label("mapped to Knob 3; automation is overridden");
}
