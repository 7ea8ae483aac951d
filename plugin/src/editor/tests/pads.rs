//! The pads of a kit: they are struck, chosen, dragged, filled, set and emptied.

use super::pictures::{Stage, compare, compare_small, differing, facing, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use crate::link::Touch;
use crate::state::State;
use egui::{Event, Key, Modifiers, Pos2, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::params::Param;
use sprung::preset::{KitPreset, Playable};
use sprung::sound::Pad;

pub(super) fn at(sound: &str, size: [u32; 2], theme: Theme) -> Stage {
    facing(Face::Kit, sound, size, 1.0, theme)
}

impl Stage {
    pub(super) fn kit(&self) -> KitPreset {
        match self.params.state().playable {
            Playable::Kit(kit) => kit,
            Playable::Preset(preset) => panic!("{}", preset.name),
        }
    }

    /// What a key plays, and how.
    pub(super) fn pad(&self, key: u8) -> Option<(String, Pad)> {
        let kit = self.kit();
        let (_, pad) = kit.pads.iter().find(|(own, _)| *own == key)?;
        Some((kit.sounds[pad.sound].1.name.clone(), pad.clone()))
    }

    /// The middle of a pad.
    pub(super) fn place(&self, key: &str) -> Pos2 {
        let is_it =
            |label: Option<String>| label.is_some_and(|label| format!("{label} ").starts_with(&format!("Pad {key} ")));
        let pads = self.harness.query_all_by_role(Role::Button);
        let pad = pads.into_iter().find(|node| is_it(node.accesskit_node().label()));
        pad.unwrap_or_else(|| panic!("there is no pad {key}")).rect().center()
    }

    /// The place of a sound in the list, after it was searched for.
    pub(super) fn sound(&mut self, name: &str) -> Pos2 {
        self.harness.get_by_label("Search for sounds").click();
        self.harness.run_steps(2);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.event(Event::Text(name.to_owned()));
        self.harness.run_steps(3);
        self.harness.get_by_label(&format!("Put {name}")).rect().center()
    }
}

#[test]
fn pictures_of_the_pads_are_as_accepted() {
    for (theme, size, name) in [
        (Theme::Dark, SIZE, "pads"),
        (Theme::Dark, LEAST_SIZE, "pads-least"),
        (Theme::Light, LEAST_SIZE, "pads-light-least"),
        (Theme::HighContrast, LEAST_SIZE, "pads-high-contrast-least"),
    ] {
        let mut band = Band::of(at("Acoustic Kit", size, theme));
        let hat = band.stage.place("F#2");
        band.press(hat, true);
        band.press(hat, false);
        band.strike(&[38]);
        band.passes(2);
        match theme {
            Theme::Dark => compare(name, &mut band.stage.harness),
            _ => compare_small(name, 2, &mut band.stage.harness),
        }
    }
    for theme in [Theme::Light, Theme::HighContrast] {
        compare_small(&format!("pads-{}", theme.id()), 2, &mut at("Acoustic Kit", SIZE, theme).harness);
    }
    compare_small("pads-twice", 4, &mut facing(Face::Kit, "Acoustic Kit", SIZE, 2.0, Theme::Dark).harness);
    compare_small("kit-knobs", 2, &mut facing(Face::Sound, "Acoustic Kit", SIZE, 1.0, Theme::Light).harness);
    for (size, name) in [(SIZE, "pad-edited"), (LEAST_SIZE, "pad-edited-least")] {
        let mut stage = at("Acoustic Kit", size, Theme::Dark);
        stage.button("Edit this pad");
        compare_small(name, 2, &mut stage.harness);
    }
    compare_small("keys-of-a-preset", 2, &mut at("Marimba", SIZE, Theme::Dark).harness);
    finish();
}

#[test]
fn all_pads_of_a_kit_are_shown_at_once_and_the_chosen_one_stays_chosen() {
    for (size, name) in [(SIZE, "pads-many"), (LEAST_SIZE, "pads-many-least")] {
        let mut stage = at("Acoustic Kit", size, Theme::Dark);
        stage.harness.get_by_label("Pad F#2 Closed hat").click();
        stage.harness.run_steps(3);
        stage.tab("8 × 8");
        compare_small(name, if size == SIZE { 2 } else { 1 }, &mut stage.harness);
        let is_pad = |label: Option<String>| label.is_some_and(|label| label.starts_with("Pad "));
        let pads = stage.harness.query_all_by_role(Role::Button);
        let shown = pads.into_iter().filter(|node| is_pad(node.accesskit_node().label())).count();
        assert_eq!(shown, 64);
        assert!(stage.kit().pads.iter().all(|(key, _)| (24..88).contains(key)), "so all are seen");
        stage.tab("4 × 4");
        stage.harness.get_by_label("Pad F#2 Closed hat");
        stage.tab("Keys");
        stage.harness.get_by_label("Pad C2 Kick").click();
        stage.harness.run_steps(3);
        stage.tab("4 × 4");
        let chosen = stage.harness.get_by_label("Pad C2 Kick").accesskit_node().toggled();
        assert_eq!(chosen, Some(egui::accesskit::Toggled::True), "a key chooses its pad");
    }
    finish();
}

#[test]
fn a_pad_plays_lights_up_is_chosen_and_is_let_go() {
    let mut band = Band::of(at("Acoustic Kit", SIZE, Theme::Dark));
    let kick = band.stage.place("C2");
    band.press(kick + vec2(0.0, 40.0), true);
    assert!(matches!(band.heard[..], [Touch::Down { key: 36, velocity }] if velocity > 0.7), "{:?}", band.heard);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 1 << 36);
    // Leaving the face releases the key.
    band.stage.harness.get_by_role_and_label(Role::Tab, "Play").click();
    band.passes(3);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0);
}

#[test]
fn pads_change_places_are_copied_and_emptied() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    let [kick, snare] = [36, 38].map(|key| stage.pad(key).unwrap());
    let (from, to) = (stage.place("C2"), stage.place("D2"));
    stage.drag(from, to - from, Modifiers::NONE);
    assert_eq!(
        [stage.pad(36), stage.pad(38)].map(|pad| pad.map(|(name, _)| name)),
        [Some(snare.0), Some(kick.0.clone())]
    );
    stage.drag(to, from - to, Modifiers::COMMAND);
    assert_eq!([36, 38].map(|key| stage.pad(key).unwrap().0), [kick.0.clone(), kick.0.clone()]);
    stage.button("Empty this pad");
    assert_eq!((stage.pad(36), stage.pad(38).map(|(name, _)| name)), (None, Some(kick.0)));
    for _ in 0..3 {
        stage.button("Undo");
    }
    assert_eq!(Playable::Kit(stage.kit()), Playable::find("Acoustic Kit").unwrap());
}

#[test]
fn numbers_group_and_output_of_a_pad_are_set_and_the_knobs_stay() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    let turned = 0.7;
    stage.params.knobs()[Param::Decay as usize].turn(turned);
    let hat = stage.place("F#2");
    stage.drag(hat, hat - hat, Modifiers::NONE);
    let level = stage.harness.get_by_role_and_label(Role::SpinButton, "Level").rect().center();
    let before = stage.pad(42).unwrap().1;
    stage.drag(level, vec2(30.0, 0.0), Modifiers::NONE);
    let louder = stage.pad(42).unwrap().1;
    assert!(louder.gain_db > before.gain_db + 1.0, "{louder:?}");
    stage.harness.get_by_role_and_label(Role::ComboBox, "Output of the pad").click();
    stage.harness.run_steps(3);
    stage.button("7: channels 15–16");
    assert_eq!(stage.pad(42).unwrap().1, Pad { output: 7, ..louder.clone() });
    stage.harness.get_by_role_and_label(Role::ComboBox, "Choke of the pad").click();
    stage.harness.run_steps(3);
    stage.button("none");
    assert_eq!(stage.pad(42).unwrap().1, Pad { output: 7, choke: Some(0), ..louder });
    assert_eq!(stage.params.knobs()[Param::Decay as usize].position(), turned);
    for _ in 0..3 {
        stage.button("Undo");
    }
    assert_eq!(stage.pad(42).unwrap().1, before);
}

#[test]
fn the_search_for_sounds_is_cleared_by_a_button_and_by_leaving() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    for clears in [true, false] {
        stage.sound("Taiko");
        assert!(stage.harness.query_by_label("Put Kick").is_none());
        if clears {
            stage.button("Clear the search for sounds");
        } else {
            stage.tab("Play");
            stage.tab("Kit");
        }
        assert!(stage.harness.query_by_label("Put Kick").is_some());
    }
}

#[test]
fn what_is_typed_for_a_pad_stays_with_it() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    let (kick, snare) = (stage.place("C2"), stage.place("D2"));
    let type_name = |stage: &mut Stage, name: &str| {
        stage.harness.get_by_label("Name of the pad").click();
        stage.harness.run_steps(2);
        stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        stage.harness.event(Event::Text(name.to_owned()));
        stage.harness.run_steps(2);
    };
    stage.drag(kick, vec2(0.0, 0.0), Modifiers::NONE);
    type_name(&mut stage, "Boom");
    stage.drag(snare, vec2(0.0, 0.0), Modifiers::NONE);
    assert_eq!([36, 38].map(|key| stage.pad(key).unwrap().1.name), ["Boom", "Snare"]);
    type_name(&mut stage, "Other");
    stage.harness.key_press(Key::Escape);
    stage.harness.run_steps(2);
    assert_eq!(stage.pad(38).unwrap().1.name, "Snare", "Escape keeps the name");
    // A key empties the pad that has the focus.
    stage.harness.get_by_label("Pad D2 Snare").focus();
    stage.harness.run_steps(2);
    stage.harness.key_press(Key::Delete);
    stage.harness.run_steps(2);
    assert_eq!((stage.pad(38), stage.pad(36).is_some()), (None, true));
}

#[test]
fn a_drag_ends_with_escape_and_nothing_sounds_on_when_another_sound_is_loaded() {
    let mut band = Band::of(at("Acoustic Kit", SIZE, Theme::Dark));
    let before = band.stage.kit();
    let (kick, snare) = (band.stage.place("C2"), band.stage.place("D2"));
    band.press(kick, true);
    band.event(Event::PointerMoved(snare));
    band.stage.harness.key_press(Key::Escape);
    band.passes(2);
    band.press(snare, false);
    assert_eq!(band.stage.kit(), before);
    band.press(kick, true);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 1 << 36);
    let state = State::new(Playable::find("Marimba").unwrap(), 0, band.stage.params.view());
    band.stage.params.load(state.into());
    band.passes(3);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0);
    band.press(kick, false);
}

#[test]
fn a_pad_that_sounds_swings_and_glows_and_comes_to_rest() {
    let mut band = Band::of(at("Acoustic Kit", SIZE, Theme::Dark));
    band.passes(3);
    let pads = ["D2", "C2"].map(|key| {
        let place = band.stage.place(key) - vec2(50.0, 50.0);
        [place.x as u32, place.y as u32]
    });
    let seen = |band: &mut Band| {
        let picture = band.stage.harness.render().unwrap();
        pads.map(|[x, y]| image::imageops::crop_imm(&picture, x, y, 100, 100).to_image())
    };
    let rest = seen(&mut band);
    band.strike(&[38]);
    band.passes(4);
    let [snare, kick] = seen(&mut band);
    assert!(differing(&rest[0], &snare, 4) > 500);
    assert_eq!(differing(&rest[1], &kick, 4), 0);
    // Of the one that was struck before, only the light is known.
    band.strike(&[36]);
    band.passes(4);
    let [snare, kick] = seen(&mut band);
    assert!(differing(&rest[0], &snare, 4) > 500 && differing(&rest[1], &kick, 4) > 500);
    // With no time between, what still changes is motion.
    let moves = |band: &mut Band| {
        let before = seen(band);
        band.stage.harness.run_steps(4);
        let after = seen(band);
        differing(&before[1], &after[1], 4)
    };
    assert!(moves(&mut band) > 0);
    band.stage.params.set_view(|view| view.less_motion = true);
    band.passes(2);
    assert_eq!(moves(&mut band), 0);
    band.silence();
    band.passes(60);
    let still = seen(&mut band);
    assert_eq!([0, 1].map(|pad| differing(&rest[pad], &still[pad], 4)), [0, 0]);
}

#[test]
fn octaves_are_gone_to_by_name_and_the_kit_is_named() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    assert!(stage.paints(&format!("{} pads", stage.kit().pads.len())));
    assert_eq!(stage.harness.query_all_by_label("Pad C2 Kick").count(), 1);
    stage.button("Pads from C4");
    assert!(stage.harness.query_by_label("Pad C2 Kick").is_none());
    stage.place("D#5");
    stage.button("Pads an octave lower");
    stage.place("C3");
    // In less room there are fewer, and that which is shown is one of them.
    let mut stage = at("Acoustic Kit", LEAST_SIZE, Theme::Dark);
    for _ in 0..4 {
        stage.button("Pads an octave higher");
    }
    stage.harness.get_by_label("Pads from C6");
    assert!(stage.harness.query_by_label("Pads from C1").is_none());
}

#[test]
fn the_sounds_for_pads_are_narrowed_by_chips_and_words() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    let is_listed = |stage: &Stage, name: &str| stage.harness.query_by_label(&format!("Put {name}")).is_some();
    stage.button("Only metal");
    assert!(!is_listed(&stage, "Kick"));
    stage.sound("Church Bell");
    stage.button("Only drums, hats, cymbals and other percussion");
    assert!(!is_listed(&stage, "Church Bell"));
    stage.sound("Taiko");
    stage.button("Clear the search for sounds");
    assert!(is_listed(&stage, "Kick") && !is_listed(&stage, "init"));
    stage.button("Only your own sounds");
    assert!(!is_listed(&stage, "Kick") && stage.paints("None yet"));
    stage.button("All sounds");
    assert!(is_listed(&stage, "init"));
}
