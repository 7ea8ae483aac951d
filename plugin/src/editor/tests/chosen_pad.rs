//! The chosen pad of a kit: its knobs, its choke group and output, the pads of that group, swapping, and the kit's effects.

use super::gestures::wheel;
use super::pads::at;
use super::pictures::Stage;
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::link::Touch;
use egui::accesskit::Toggled;
use egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::sound::Pad;
use std::sync::Arc;

impl Stage {
    fn is_lit(&self, name: &str) -> bool {
        self.harness.get_by_label(name).accesskit_node().toggled() == Some(Toggled::True)
    }

    fn choose(&mut self, key: &str) {
        let pad = self.place(key);
        self.drag(pad, vec2(0.0, 0.0), Modifiers::NONE);
    }

    /// Whether the last step has this name.
    fn would_undo(&mut self, name: &str) -> bool {
        let at = self.harness.get_by_label("Undo").rect().center();
        self.harness.event(Event::PointerMoved(at));
        self.harness.run_steps(3);
        self.paints(&format!("Undo {name}"))
    }
}

#[test]
fn choke_group_and_output_are_chips_and_the_pads_of_the_group_are_chosen_by_a_click() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    stage.choose("F#2");
    assert!(stage.is_lit("Choke 1") && stage.is_lit("Output Main") && !stage.is_lit("Choke none"));
    let before = stage.pad(42).unwrap().1;
    stage.button("Choose Open hat");
    assert!(stage.is_lit("Pad A#2 Open hat"));
    stage.button("Choose Closed hat");
    stage.button("Output 3–4");
    assert_eq!(stage.pad(42).unwrap().1, Pad { output: 1, ..before.clone() });
    stage.button("Choke 3");
    assert_eq!(stage.pad(42).unwrap().1, Pad { output: 1, choke: Some(3), ..before.clone() });
    assert!(stage.is_lit("Choke 3") && stage.harness.query_by_label("Choose Open hat").is_none());
    assert!(stage.would_undo("pad F#2 choke 3"));
    stage.button("Undo");
    stage.button("Undo");
    assert_eq!(stage.pad(42).unwrap().1, before);
    // In the smallest window, what has no chip is in the list.
    let mut stage = at("Acoustic Kit", LEAST_SIZE, Theme::Dark);
    stage.choose("F#2");
    assert!(stage.is_lit("Choke 1") && stage.harness.query_by_label("Choke 5").is_none());
    stage.harness.get_by_role_and_label(Role::ComboBox, "Choke of the pad").click();
    stage.harness.run_steps(3);
    stage.button("9");
    assert_eq!(stage.pad(42).unwrap().1.choke, Some(9));
    let list = stage.harness.get_by_role_and_label(Role::ComboBox, "Choke of the pad");
    assert_eq!(list.accesskit_node().value().as_deref(), Some("9"), "the list shows it");
}

#[test]
fn a_pad_is_swapped_with_the_one_that_is_clicked_next_and_escape_cancels() {
    let mut band = Band::of(at("Acoustic Kit", SIZE, Theme::Dark));
    let before = band.stage.kit();
    let names = |band: &Band| [36, 38].map(|key| band.stage.pad(key).unwrap().0);
    let [kick, snare] = names(&band);
    band.stage.choose("C2");
    let place = band.stage.place("D2");
    band.stage.button("Swap with another pad");
    assert!(band.stage.paints("Swap Kick with …"));
    band.stage.harness.key_press(Key::Escape);
    band.passes(3);
    band.stage.click(place);
    assert_eq!(band.stage.kit(), before);
    band.stage.choose("C2");
    band.passes(3);
    band.heard.clear();
    band.stage.button("Swap with another pad");
    band.stage.click(place);
    assert_eq!(names(&band), [snare, kick]);
    assert!(band.stage.would_undo("swapped Kick and Snare"));
    band.passes(3);
    assert!(!band.heard.iter().any(|touch| matches!(touch, Touch::Down { .. })), "{:?}", band.heard);
    band.stage.button("Undo");
    assert_eq!(band.stage.kit(), before);
    // An empty pad is a place to go to, and the next click chooses again.
    band.stage.choose("C2");
    band.stage.button("Swap with another pad");
    band.stage.button("Pads from C1");
    let empty = band.stage.place("C#1");
    band.stage.click(empty);
    assert!(band.stage.pad(36).is_none() && band.stage.pad(25).is_some());
    let other = band.stage.place("E1");
    let after = band.stage.kit();
    band.stage.click(other);
    assert_eq!(band.stage.kit(), after);
}

#[test]
fn knobs_of_a_pad_are_dragged_stepped_and_reset_each_as_one_step() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    stage.choose("F#2");
    let before = stage.pad(42).unwrap().1;
    let level = stage.at("Level");
    stage.drag(level, vec2(0.0, -22.0), Modifiers::NONE);
    let louder = stage.pad(42).unwrap().1.gain_db;
    assert!((louder - before.gain_db - 7.2).abs() < 0.2, "a tenth of its way: {louder}");
    stage.button("Undo");
    assert_eq!(stage.pad(42).unwrap().1, before);
    stage.harness.get_by_role_and_label(Role::Slider, "Pitch").focus();
    stage.harness.run_steps(2);
    for key in [Key::ArrowUp, Key::PageUp, Key::ArrowUp] {
        stage.harness.key_press(key);
        stage.harness.run_steps(2);
    }
    stage.harness.run_steps(60);
    assert_eq!(stage.pad(42).unwrap().1.pitch, Some(72.0));
    stage.button("Undo");
    assert_eq!(stage.pad(42).unwrap().1, before, "keys that follow each other are one step");
    let pan = stage.at("Pan");
    stage.harness.event(Event::PointerMoved(pan));
    for _ in 0..3 {
        stage.harness.event(wheel(1.0));
        stage.harness.run_steps(2);
    }
    stage.harness.run_steps(60);
    let moved = stage.pad(42).unwrap().1.pan;
    assert!((moved - before.pan - 0.03).abs() < 1e-6, "{moved}");
    assert!(stage.would_undo("pad F#2 pan -37 %"));
    stage.button("Undo");
    assert_eq!(stage.pad(42).unwrap().1, before, "turns that follow each other are one step");
}

/// All sounds of a kit are made again for each change of it, so that a drag must not change it in each pass.
#[test]
fn a_kit_is_made_again_at_intervals_while_a_number_is_dragged_and_at_the_end() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    stage.choose("F#2");
    let level = stage.at("Level");
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    stage.harness.event(Event::PointerMoved(level));
    stage.harness.event(button(level, true));
    stage.harness.run_steps(3);
    let (mut made, mut last) = (0, stage.params.loaded());
    let (moves, before) = (24, stage.pad(42).unwrap().1.gain_db);
    let end = level - vec2(0.0, moves as f32);
    for step in 1..=moves {
        stage.harness.event(Event::PointerMoved(level - vec2(0.0, step as f32)));
        stage.harness.step();
        let now = stage.params.loaded();
        made += usize::from(!Arc::ptr_eq(&now, &last));
        last = now;
    }
    assert!((1..=moves / 3).contains(&made), "{made} times");
    stage.harness.event(button(end, false));
    stage.harness.run_steps(3);
    let now = stage.pad(42).unwrap().1.gain_db;
    // Before it is a drag, the pointer may move a little.
    let pixels = (now - before) * 220.0 / 72.0;
    assert!((moves as f32 - 8.0..moves as f32 + 1.0).contains(&pixels), "the last of all is kept: {pixels}");
    stage.button("Undo");
    assert_eq!(stage.pad(42).unwrap().1.gain_db, before);
}

#[test]
fn the_effects_behind_all_pads_are_told_and_shown_and_the_body_is_struck() {
    let mut band = Band::of(at("Acoustic Kit", SIZE, Theme::Dark));
    band.stage.choose("D2");
    band.passes(60);
    band.heard.clear();
    band.stage.button("Strike this pad");
    band.passes(3);
    assert!(matches!(band.heard[..], [Touch::Down { key: 38, .. }]), "{:?}", band.heard);
    assert!(band.stage.paints("Effects behind all pads: room"));
    band.stage.harness.get_by_role(Role::Link).click();
    band.passes(3);
    let space = band.stage.harness.get_by_role_and_label(Role::Tab, "Space");
    assert_eq!(space.accesskit_node().toggled(), Some(Toggled::True));
}
