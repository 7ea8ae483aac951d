//! The page that a window opens with.

use super::pictures::{compare, compare_exactly, compare_small, facing, facing_on, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use crate::link::Touch;
use crate::loaded::Loaded;
use crate::params::SprungParams;
use egui::accesskit::Toggled;
use egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::params::Param;
use sprung_picture::Origin;

impl Band {
    pub(super) fn click(&mut self, role: Role, name: &str) {
        self.stage.harness.get_by_role_and_label(role, name).click();
        self.passes(4);
    }

    pub(super) fn value(&self, param: Param) -> f32 {
        self.stage.params.state().values.get(param)
    }

    pub(super) fn undo(&mut self) {
        self.click(Role::Button, "Undo");
    }

    /// The model and the material of the body.
    fn thing(&self) -> [&'static str; 2] {
        let loaded = self.stage.params.loaded();
        let origin = Origin::of(&loaded.kit.sounds()[0].patch().modes);
        origin.body().map_or([""; 2], |body| [body.model.id(), body.material.id])
    }

    /// How many strikes the window has played since this was called last.
    fn strikes(&mut self) -> usize {
        std::mem::take(&mut self.heard).iter().filter(|touch| matches!(touch, Touch::Down { .. })).count()
    }
}

fn playing(sound: &str) -> Band {
    Band::of(facing(Face::Play, sound, SIZE, 1.0, Theme::Dark))
}

#[test]
fn pictures_of_the_page_are_as_accepted() {
    compare_exactly("play-dark", &mut facing(Face::Play, "Church Bell", SIZE, 1.0, Theme::Dark).harness);
    for theme in [Theme::Light, Theme::HighContrast] {
        let name = format!("play-{}", theme.id());
        compare_small(&name, 2, &mut facing(Face::Play, "Church Bell", SIZE, 1.0, theme).harness);
    }
    for (sound, theme, name) in [
        ("Marimba", Theme::Dark, "play-marimba-least"),
        ("Tam-Tam", Theme::Light, "play-gong-least"),
        ("Acoustic Kit", Theme::HighContrast, "play-kit-least"),
    ] {
        let mut stage = facing(Face::Play, sound, LEAST_SIZE, 1.0, theme);
        match theme {
            Theme::Dark => compare(name, &mut stage.harness),
            _ => compare_small(name, 2, &mut stage.harness),
        }
    }
    compare_small("play-marimba", 2, &mut facing(Face::Play, "Marimba", SIZE, 1.0, Theme::Dark).harness);
    let mut band = playing("Tam-Tam");
    band.strike_at(48, 1.0);
    band.passes(30);
    compare_small("play-gong", 3, &mut band.stage.harness);
    finish();
}

#[test]
fn a_body_that_is_clicked_sounds() {
    let mut band = playing("Church Bell");
    let place = band.rect("Struck body").center();
    band.press(place, true);
    band.passes(2);
    band.press(place, false);
    band.passes(2);
    assert_eq!(band.strikes(), 1);
    // A sound without a body has no place to be struck at.
    let mut band = playing("Crash");
    let place = band.rect("Strike").center();
    band.press(place, true);
    band.passes(1);
    band.press(place, false);
    band.passes(2);
    assert_eq!(band.strikes(), 1);
}

#[test]
fn a_click_within_one_pass_and_a_kit_sound_too() {
    let mut band = playing("Church Bell");
    let place = band.rect("Struck body").center() + vec2(30.0, 0.0);
    let before = band.stage.params.loaded();
    band.stage.harness.event(Event::PointerMoved(place));
    for pressed in [true, false] {
        let modifiers = Modifiers::NONE;
        band.stage.harness.event(Event::PointerButton {
            pos: place,
            button: PointerButton::Primary,
            pressed,
            modifiers,
        });
    }
    band.passes(3);
    assert_eq!(band.strikes(), 1);
    let strike = |loaded: &Loaded| Origin::of(&loaded.kit.sounds()[0].patch().modes).body().map(|body| body.strike);
    assert_ne!(strike(&band.stage.params.loaded()), strike(&before), "and the place has moved");
    band.undo();
    assert_eq!(strike(&band.stage.params.loaded()), strike(&before));
    let mut band = playing("Acoustic Kit");
    let place = band.rect("Strike").center();
    band.press(place, true);
    band.press(place, false);
    band.passes(3);
    let kit = band.stage.params.loaded().kit.clone();
    let struck =
        band.heard.iter().find_map(|touch| if let Touch::Down { key, .. } = touch { Some(*key) } else { None });
    assert_eq!(kit.pad(struck.unwrap()).unwrap().sound, 0, "the sound whose body is shown");
}

#[test]
fn another_body_and_another_material_are_heard_and_undone_one_by_one() {
    let mut band = playing("Church Bell");
    let [bell, _] = band.thing();
    band.click(Role::RadioButton, "thing: Glass");
    let [glass, material] = band.thing();
    assert_eq!((glass, band.strikes()), ("glass", 1));
    band.click(Role::RadioButton, "material: steel");
    assert_eq!((band.thing(), band.strikes()), (["glass", "steel"], 1));
    band.undo();
    assert_eq!(band.thing(), ["glass", material]);
    band.undo();
    assert_eq!(band.thing()[0], bell);
}

#[test]
fn a_table_of_modes_says_what_it_lacks_and_becomes_the_body_that_is_offered() {
    for size in [SIZE, LEAST_SIZE] {
        let mut band = Band::of(facing(Face::Play, "Marimba", size, 1.0, Theme::Dark));
        assert!(band.stage.harness.query_by_label("Struck body").is_none(), "it knows no place");
        band.click(Role::Button, "Make it a marimba");
        assert_eq!((band.thing(), band.strikes()), (["marimba", "rosewood"], 1));
        band.rect("Struck body");
        assert!(band.stage.harness.query_by_label("Make it a marimba").is_none());
        if size == SIZE {
            let tile = band.stage.harness.get_by_role_and_label(Role::RadioButton, "thing: Bar");
            assert_eq!(tile.accesskit_node().toggled(), Some(Toggled::True), "it is lit for what has none of its own");
        }
        band.undo();
        assert_eq!(band.thing(), [""; 2]);
    }
}

#[test]
fn an_exciter_acts_alone_and_its_lamp_adds_it() {
    let mut band = playing("Marimba");
    let silent = Param::BowLevel.info().min;
    band.click(Role::Button, "Bow alone");
    assert!(band.value(Param::BowLevel) > silent && band.value(Param::MalletLevel) == silent);
    assert_eq!(band.strikes(), 1);
    band.click(Role::CheckBox, "Mallet");
    assert!(band.value(Param::BowLevel) > silent && band.value(Param::MalletLevel) > silent);
    band.undo();
    band.undo();
    assert!(band.value(Param::BowLevel) == silent && band.value(Param::MalletLevel) > silent);
}

/// Noise has two levels, which its lamp takes down together.
#[test]
fn a_lamp_is_one_step() {
    let mut band = playing("Accordion");
    let before = band.stage.params.state();
    let levels = [Param::NoiseLevel, Param::NoiseHeld];
    assert!(levels.iter().all(|level| before.values.get(*level) > level.info().min));
    band.click(Role::CheckBox, "Noise");
    assert!(levels.iter().all(|level| band.value(*level) == level.info().min));
    band.undo();
    assert_eq!(band.stage.params.state(), before);
}

/// In the effect, what the user switches on stays on.
#[test]
fn a_mallet_may_strike_what_the_incoming_sound_drives() {
    let mut band = Band::of(facing_on(SprungParams::of_effect(), Face::Play, "Marimba", (SIZE, 1.0), Theme::Dark));
    let silent = Param::MalletLevel.info().min;
    assert!(band.value(Param::MalletLevel) == silent && band.value(Param::InputLevel) == 0.0);
    band.click(Role::Button, "Mallet alone");
    assert!(band.value(Param::MalletLevel) > silent && band.value(Param::InputLevel) == Param::InputLevel.info().min);
}

#[test]
fn the_floor_is_the_space_and_the_tabs_lead_to_all_of_the_sound_and_back() {
    let mut band = playing("Church Bell");
    band.click(Role::Tab, "Spring");
    assert_eq!(band.value(Param::Space), 2.0);
    band.click(Role::Tab, "Sound");
    assert!(band.stage.harness.query_by_label("Struck body").is_none());
    band.stage.harness.get_by_role_and_label(Role::Tab, "Mallet");
    band.click(Role::Tab, "Play");
    band.rect("Struck body");
    // Everything on the page can be reached by the keyboard.
    for _ in 0..60 {
        band.stage.harness.key_press_modifiers(Modifiers::NONE, Key::Tab);
        band.passes(1);
        if band.stage.harness.get_by_role_and_label(Role::RadioButton, "thing: Gong").is_focused() {
            return;
        }
    }
    panic!("the tiles cannot be reached by Tab");
}
