//! The page of the body, and the first five minutes of a user who is new to the window.

use super::pictures::{Stage, compare_part, finish, stage};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::link::Touch;
use egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::internals::library::Library;
use sprung::params::Param;
use sprung::preset::Playable;
use sprung_picture::Origin;

impl Stage {
    fn origin(&self) -> Origin {
        let Playable::Preset(preset) = self.params.state().playable else { panic!("a kit") };
        Origin::of(&preset.patch.modes)
    }

    /// Picks a name from the list that a field opens.
    fn pick(&mut self, field: &str, name: &str) {
        self.harness.get_by_role_and_label(Role::ComboBox, field).click();
        self.harness.run_steps(3);
        self.harness.get_by_role_and_label(Role::Button, name).click();
        self.harness.run_steps(4);
    }

    fn type_value(&mut self, knob: &str, text: &str) {
        self.button(&format!("Type {knob}"));
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.key_press(Key::Enter);
        self.harness.run_steps(3);
    }
}

#[test]
fn pictures_of_the_page_are_as_accepted() {
    for (sound, part, size, theme, name) in [
        ("Glass Marimba", "First body", SIZE, Theme::Light, "model"),
        ("Guitar", "Joint of the bodies", LEAST_SIZE, Theme::Dark, "model-joint-least"),
    ] {
        let mut stage = stage(sound, size, 1.0, theme);
        stage.tab("Model");
        stage.button(part);
        compare_part(name, &mut stage.harness);
    }
    finish();
}

/// Keys go from one whole number to the next, and each is heard once.
#[test]
fn a_whole_number_is_moved_by_keys() {
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    band.stage.harness.get_by_role_and_label(Role::Tab, "Model").click();
    band.passes(3);
    let count = |band: &Band| band.stage.origin().body().unwrap().modes;
    let before = count(&band);
    band.stage.harness.get_by_label("Number of modes").focus();
    band.passes(2);
    band.stage.harness.key_press(Key::ArrowDown);
    band.passes(90);
    assert_eq!(count(&band), before - 1);
    let strikes = band.heard.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
    assert_eq!(strikes, 1, "{:?}", band.heard);
}

#[test]
fn a_number_is_dragged_heard_and_undone_as_one_step() {
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    band.stage.harness.get_by_role_and_label(Role::Tab, "Model").click();
    band.passes(3);
    let place = band.stage.harness.get_by_label("Strike place").rect().center();
    band.press(place, true);
    for step in 1..=10 {
        band.event(Event::PointerMoved(place + vec2(4.0 * step as f32, 0.0)));
    }
    let pos = place + vec2(40.0, 0.0);
    band.event(Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    band.passes(60);
    let body = |origin: Origin| origin.body().unwrap().clone();
    let Playable::Preset(preset) = &before.playable else { unreachable!() };
    let (old, new) = (body(Origin::of(&preset.patch.modes)), body(band.stage.origin()));
    assert!(new.strike.x > old.strike.x + 0.05, "{} {}", old.strike.x, new.strike.x);
    assert_eq!(new.pickup, old.pickup);
    let strikes = band.heard.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
    assert!((1..=5).contains(&strikes), "{:?}", band.heard);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "no key is left down");
    band.stage.button("Undo");
    assert_eq!(band.stage.params.state(), before);
}

#[test]
fn a_second_body_is_joined_changed_and_taken_away() {
    let mut stage = stage("init", SIZE, 1.0, Theme::Dark);
    stage.tab("Model");
    stage.pick("Model of the body", "free bar");
    let alone = stage.origin();
    assert_eq!(alone.body().map(|body| body.model.id()), Some("free_bar"));
    stage.button("Second body");
    stage.pick("Model of the body", "plate");
    assert_eq!(stage.origin().pair().map(|pair| pair.second.model.id()), Some("plate"));
    stage.button("The body follows the keys");
    assert!(!stage.origin().pair().unwrap().second.follows_key);
    stage.button("Joint of the bodies");
    stage.pick("Kind of the body", "spring");
    assert!(matches!(stage.origin().pair().unwrap().link, sprung::sound::pairs::Link::Spring { .. }));
    stage.button("Second body");
    stage.pick("Model of the body", "none");
    assert_eq!(stage.origin(), alone);
}

#[test]
fn bodies_with_too_many_modes_are_refused_and_the_sound_stays() {
    let mut stage = stage("Guitar", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    stage.tab("Model");
    let place = stage.harness.get_by_label("Number of modes").rect().center();
    for pressed in [true, false] {
        stage.harness.event(Event::PointerMoved(place));
        stage.harness.event(Event::PointerButton {
            pos: place,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        stage.harness.run_steps(2);
    }
    stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    stage.harness.event(Event::Text("512".to_owned()));
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(4);
    assert_eq!(stage.params.state(), before);
    stage.harness.event(Event::PointerGone);
    stage.harness.run_steps(3);
    stage.harness.get_by_label_contains("expected at most 512");
}

/// A marimba is found, made of glass, put into a big room, saved and found again.
#[test]
fn the_first_five_minutes() {
    let mut stage = stage("init", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    stage.harness.event(Event::Text("marimba".to_owned()));
    stage.harness.run_steps(3);
    stage.harness.get_by_role_and_label(Role::ListItem, "Marimba").click();
    stage.harness.run_steps(3);
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    assert_eq!((stage.params.name().as_str(), stage.origin()), ("Marimba", Origin::Table));

    stage.tab("Model");
    stage.pick("Model of the body", "marimba");
    let wood = stage.params.state().values.get(Param::Decay);
    stage.pick("Material of the body", "glass");
    let glass = stage.params.state().values.get(Param::Decay);
    assert!(glass > 2.0 * wood, "glass rings longer than rosewood: {wood} s, {glass} s");

    stage.tab("Space");
    stage.pick("Space", "room");
    stage.type_value("Space size", "200 %");
    stage.type_value("Space mix", "40 %");

    stage.button("Save");
    stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under").click();
    stage.harness.run_steps(2);
    stage.harness.event(Event::Text(" in a glass hall".to_owned()));
    stage.harness.run_steps(3);
    stage.button("Save under this name");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(2);
    let edited = stage.params.state();

    stage.button("Next sound");
    assert_ne!(stage.params.name(), "Marimba in a glass hall");
    stage.button("Browse");
    stage.harness.event(Event::Text("glass hall".to_owned()));
    stage.harness.run_steps(3);
    stage.harness.get_by_role_and_label(Role::ListItem, "Marimba in a glass hall").click();
    stage.harness.run_steps(3);
    let found = stage.params.state();
    assert_eq!(found.playable.name(), "Marimba in a glass hall");
    assert_eq!(found.values.get(Param::SpaceMix), 40.0);
    assert_eq!(stage.origin().body().map(|body| (body.model.id(), body.material.id)), Some(("marimba", "glass")));
    let path = Library::at(stage.folder.path()).entries()[0].path.clone();
    let Playable::Preset(saved) = crate::files::read(path.to_str().unwrap()).unwrap() else { panic!("a kit") };
    let Playable::Preset(edited) = edited.playable else { panic!("a kit") };
    assert_eq!(saved.patch.modes, edited.patch.modes);
}
