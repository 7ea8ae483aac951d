//! What stands where there is nothing yet: no page is empty.

use super::pictures::{Stage, facing, stage};
use crate::devices::Devices;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use crate::state::State;
use egui::epaint::Shape;
use egui::{Key, Role};
use egui_kittest::kittest::Queryable as _;
use sprung::patch::routes::Routes;
use sprung::preset::{Playable, Preset};
use sprung_picture::Origin;
use std::sync::atomic::Ordering::Relaxed;

impl Stage {
    /// Whether a text with these words is painted.
    pub(super) fn paints(&self, words: &str) -> bool {
        fn is_in(shape: &Shape, words: &str) -> bool {
            match shape {
                Shape::Vec(shapes) => shapes.iter().any(|shape| is_in(shape, words)),
                Shape::Text(text) => text.galley.text().contains(words),
                _ => false,
            }
        }
        self.harness.output().shapes.iter().any(|clipped| is_in(&clipped.shape, words))
    }

    fn listed(&self) -> usize {
        self.harness.query_all_by_role(Role::ListItem).count()
    }
}

#[test]
fn a_sound_that_nothing_moves_says_what_can_be_dragged() {
    let preset = Preset::find("init").unwrap().clone();
    let mut still = preset.clone();
    still.patch.routes = Routes::NONE;
    for (preset, is_still) in [(preset, false), (still, true)] {
        let mut stage = facing(Face::Play, "init", SIZE, 1.0, Theme::Dark);
        let State { seed, view, .. } = stage.params.state();
        stage.params.load(State::new(Playable::Preset(preset), seed, view).into());
        stage.harness.run_steps(3);
        assert_eq!(stage.paints("Wheel and pressure move nothing yet"), is_still);
        stage.tab("Motion");
        assert_eq!(stage.paints("nothing yet: drag a source to a knob"), is_still);
    }
}

#[test]
fn a_search_without_a_result_shows_the_nearest_three_which_can_be_loaded() {
    let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    stage.type_text("marimbba");
    assert!(stage.paints("No sound has all of this. The nearest:"));
    assert_eq!(stage.listed(), 3);
    stage.harness.key_press(Key::ArrowDown);
    stage.harness.run_steps(3);
    assert_eq!(stage.params.name(), "Marimba");
    stage.button("Clear the search");
    stage.type_text("qwzx");
    assert!(stage.paints("No sound is like this") && stage.listed() == 0);
    stage.button("Clear the search");
    stage.type_text("rhodes");
    assert!(stage.harness.query_by_role_and_label(Role::ListItem, "Electric Piano 1").is_some());
    for (category, says) in
        [("Favourites", "None yet: a click on a sound’s star"), ("Your own", "None yet: Save keeps")]
    {
        stage.button(&format!("Show {category}"));
        assert!(stage.paints(says) && stage.listed() == 0, "{category}");
    }
    let mut stage = facing(Face::Kit, "Acoustic Kit", SIZE, 1.0, Theme::Dark);
    stage.harness.get_by_label("Search for sounds").click();
    stage.harness.run_steps(2);
    stage.type_text("acoustik kick");
    assert!(stage.paints("No sound has all of this.") && stage.listed() == 3, "presets alone");
}

#[test]
fn a_sound_without_a_file_is_offered_to_be_kept() {
    let mut stage = stage("init", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    assert!(!stage.paints("macros:") && !stage.paints("In no file"), "it has none");
    stage.button("Show Kick");
    assert!(stage.paints("One mass and a bare impulse"), "the loaded sound is told of, whatever is listed");
    stage.params.rename("Something New".to_owned());
    stage.harness.run_steps(3);
    assert!(stage.paints("In no file of yours yet"));
}

#[test]
fn what_has_no_body_to_change_is_offered_one() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.tab("Model");
    stage.button("Make it a marimba");
    assert!(stage.harness.query_by_role_and_label(Role::SpinButton, "Frequency").is_some(), "it has numbers");
    for face in [Face::Play, Face::Sound] {
        let mut stage = facing(face, "Acoustic Kit", SIZE, 1.0, Theme::Dark);
        if face == Face::Sound {
            stage.tab("Model");
        }
        stage.button("Edit High Q");
        assert_eq!(stage.params.name(), "High Q");
    }
}

#[test]
fn modes_alone_are_made_a_body_of_a_material_in_one_click() {
    let made = |stage: &Stage| {
        let origin = Origin::of(&stage.params.loaded().kit.sounds()[0].patch().modes);
        origin.body().map(|body| (body.model.id(), body.material.id))
    };
    let mut stage = facing(Face::Play, "Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    assert!(!stage.paints("What it is made of") && made(&stage).is_none());
    stage.harness.get_by_role_and_label(Role::RadioButton, "material: glass").click();
    stage.harness.run_steps(3);
    assert_eq!(made(&stage), Some(("marimba", "glass")));
    assert!(stage.paints("What it is made of") && stage.paints("mallet  glass"), "no wood any more");
    stage.button("Undo");
    assert!(stage.params.state() == before);
    // The button makes it of the usual material.
    let mut stage = facing(Face::Play, "Marimba", LEAST_SIZE, 1.0, Theme::Dark);
    stage.button("Make it a marimba");
    assert_eq!(made(&stage), Some(("marimba", "rosewood")));
}

#[test]
fn pictures_of_nothing_and_empty_places_say_what_fills_them() {
    let mut stage = stage("init", SIZE, 1.0, Theme::Dark);
    stage.host.is_alone.store(true, Relaxed);
    stage.harness.run_steps(3);
    for (tab, says) in [
        ("Scope", "Play a note to see it"),
        ("Ringing", "Play a note: each mode is a line"),
        ("Voices", "Play a note: it gets a row"),
        ("Soundbox", "none: choose a type"),
        ("Space", "none: choose a type"),
    ] {
        stage.tab(tab);
        assert!(stage.paints(says), "{tab}: {says}");
    }
    stage.devices();
    assert!(stage.paints("Nothing plays yet: choose an output") && stage.paints("No MIDI port is listed"));
    let ports = vec!["Keys".to_owned()];
    stage.params.link().devices.show(Devices { ports, ..Devices::default() });
    stage.harness.run_steps(3);
    assert!(!stage.paints("No MIDI port is listed"));
    let mut stage = facing(Face::Kit, "Kick", SIZE, 1.0, Theme::Dark);
    stage.button("Make a kit of this sound");
    assert!(stage.paints("Drop a sound here"));
    stage.tab("Motion");
    assert!(stage.paints("of the pad that was struck or chosen last"));
}
