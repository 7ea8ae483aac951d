//! The page that a window opens with.

use super::fake_host::Call;
use super::pictures::{Stage, compare, compare_exactly, compare_small, differing, facing, facing_on, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use crate::link::Touch;
use crate::loaded::Loaded;
use crate::params::SprungParams;
use egui::accesskit::Toggled;
use egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use image::RgbaImage;
use sprung::params::Param;
use sprung::patch::routes::{Route, Routes, Source};
use sprung::preset::Playable;
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
    band.click(Role::RadioButton, "body: Glass");
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
            let tile = band.stage.harness.get_by_role_and_label(Role::RadioButton, "body: Bar");
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
    // What acts already is only heard.
    band.click(Role::Button, "Hear Mallet");
    assert!(band.value(Param::BowLevel) > silent && band.value(Param::MalletLevel) > silent);
    assert_eq!(band.strikes(), 1);
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

/// What is painted of the stage while exciters have these levels, and no others, and nothing sounds.
fn acted_on(values: &[(Param, f32)]) -> RgbaImage {
    let mut stage = facing(Face::Play, "Church Bell", SIZE, 1.0, Theme::Dark);
    let levels = [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel, Param::BowLevel];
    for (param, value) in levels.map(|level| (level, level.info().min)).iter().chain(values) {
        stage.params.knobs()[*param as usize].turn(param.info().normalise(*value) as f32);
    }
    stage.harness.run_steps(3);
    let picture = stage.harness.render().unwrap();
    image::imageops::crop_imm(&picture, 160, 60, 740, 340).to_image()
}

#[test]
fn what_acts_most_is_drawn_where_it_acts() {
    let bare = acted_on(&[(Param::NoiseLevel, 0.0)]);
    let drawn: Vec<_> = [Param::MalletLevel, Param::PluckLevel, Param::BowLevel]
        .into_iter()
        .map(|level| acted_on(&[(level, -6.0), (Param::NoiseLevel, 0.0)]))
        .collect();
    for (place, one) in drawn.iter().enumerate() {
        assert!(differing(&bare, one, 16) > 200, "{place}");
        assert!(drawn[..place].iter().all(|other| differing(other, one, 16) > 200), "{place}");
    }
    let both = acted_on(&[(Param::MalletLevel, -6.0), (Param::BowLevel, -12.0)]);
    assert_eq!(differing(&both, &drawn[0], 1), 0, "the louder one alone");
    let soft = acted_on(&[(Param::MalletLevel, -6.0), (Param::MalletHardness, 0.0)]);
    assert!(differing(&soft, &drawn[0], 16) > 50, "a head of felt");
}

#[test]
fn the_floor_is_dragged_for_the_mix_and_its_far_edge_for_the_size() {
    let mut band = playing("Church Bell");
    assert!(band.stage.harness.query_by_label("The floor").is_none(), "there is nothing to drag yet");
    band.click(Role::Tab, "Plate");
    assert_eq!(band.strikes(), 1, "the choice is heard");
    band.click(Role::Tab, "Plate");
    assert_eq!(band.strikes(), 0, "it is no other");
    for (name, param) in [("The floor", Param::SpaceMix), ("The floor’s far edge", Param::SpaceSize)] {
        let before = band.stage.params.state();
        let value = before.values.get(param);
        band.stage.host.calls();
        let from = band.rect(name).center();
        band.pull_to(from, from - vec2(0.0, 30.0));
        band.passes(2);
        assert!(band.value(param) > 1.1 * value, "{name}: {value} {}", band.value(param));
        assert!(band.strikes() > 0, "{name}");
        let calls = band.stage.host.calls();
        let is_one = matches!(&calls[..], [Call::Begin(first), .., Call::End(last)] if first == last);
        assert!(is_one && calls.iter().filter(|call| matches!(call, Call::Begin(_))).count() == 1, "{calls:?}");
        band.undo();
        assert!(band.stage.params.state() == before, "{name}: one step");
        band.stage.harness.get_by_label(name).focus();
        band.passes(2);
        band.stage.harness.key_press(Key::ArrowUp);
        band.passes(2);
        assert!(band.value(param) > value, "{name} by key");
        band.undo();
    }
    band.passes(60);
    let edge = band.rect("The floor’s far edge");
    band.heard.clear();
    band.press(edge.center(), true);
    band.press(edge.center(), false);
    assert_eq!(band.strikes(), 1, "a click strikes the body");
    assert!(!edge.intersects(band.rect("Ear")), "what belongs to the body stays its own");
}

#[test]
fn the_far_edge_stays_in_hand_when_it_goes_behind_the_body() {
    let mut band = playing("Guitar");
    band.click(Role::Tab, "Plate");
    band.stage.host.calls();
    let edge = band.rect("The floor’s far edge");
    band.pull_to(edge.center(), edge.center() - vec2(0.0, 150.0));
    band.passes(2);
    assert_eq!(band.value(Param::SpaceSize), Param::SpaceSize.info().max);
    let calls = band.stage.host.calls();
    assert_eq!(calls.iter().filter(|call| matches!(call, Call::Begin(_))).count(), 1, "{calls:?}");
    assert!(band.rect("The floor’s far edge").center().y < edge.center().y - 20.0, "and it is farther away");
}

#[test]
fn the_floor_glows_by_the_level_and_is_as_it_was_when_nothing_sounds() {
    let mut band = playing("Church Bell");
    band.click(Role::Tab, "Room");
    let wall = |band: &mut Band| {
        let picture = band.stage.harness.render().unwrap();
        image::imageops::crop_imm(&picture, 170, 60, 180, 120).to_image()
    };
    band.silence();
    band.passes(150);
    let rest = wall(&mut band);
    band.strike_at(48, 1.0);
    band.passes(6);
    assert!(differing(&rest, &wall(&mut band), 1) > 50);
    band.silence();
    band.passes(150);
    assert_eq!(differing(&rest, &wall(&mut band), 1), 0);
}

#[test]
fn hands_are_told_how_far_they_move_things_where_there_is_room() {
    let mut band = playing("Church Bell");
    assert!(band.stage.paints("Wheel: brightness +") && band.stage.paints("Bend: pitch ±2 st"));
    // In a small window that stands below the body, once the sound was played.
    band = Band::of(facing(Face::Play, "Church Bell", LEAST_SIZE, 1.0, Theme::Dark));
    assert!(!band.stage.paints("Wheel: brightness"));
    band.strike_at(60, 0.8);
    band.passes(3);
    assert!(band.stage.paints("Wheel: brightness"));
}

#[test]
fn a_small_window_has_pictures_of_bodies_and_materials_and_sources_to_drag() {
    let mut band = Band::of(facing(Face::Play, "Church Bell", LEAST_SIZE, 1.0, Theme::Dark));
    for name in ["Source velocity", "Source pressure", "Source wheel"] {
        band.rect(name);
    }
    let [bodies, materials] = ["All bodies", "All materials"].map(|name| band.rect(name).x_range());
    let is_seen = |band: &Band, name: &str, within: egui::Rangef| {
        let place = band.rect(name).x_range();
        within.contains(place.min) && within.contains(place.max)
    };
    assert!(is_seen(&band, "body: Bell", bodies) && is_seen(&band, "material: bronze", materials));
    for (name, key) in [("body: Bowl", Key::Enter), ("material: nylon", Key::Space)] {
        assert!(!is_seen(&band, name, bodies), "{name} is farther to the right");
        band.stage.harness.get_by_role_and_label(Role::RadioButton, name).focus();
        band.passes(3);
        assert!(is_seen(&band, name, bodies), "{name} is scrolled to");
        band.stage.harness.key_press(key);
        band.passes(4);
        assert_eq!(band.strikes(), 1, "{name}");
    }
    assert_eq!(band.thing(), ["bowl", "nylon"]);
    band.undo();
    band.undo();
    assert!(is_seen(&band, "body: Bell", bodies), "what comes back is seen");
}

#[test]
fn a_macro_is_added_by_its_name_and_named_again_in_its_menu() {
    let mut stage = facing(Face::Play, "Church Bell", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    let names = |stage: &Stage| match stage.params.state().playable {
        Playable::Preset(preset) => preset.guide.macros,
        Playable::Kit(_) => Vec::new(),
    };
    let has = |stage: &Stage, number: usize| {
        stage.harness.query_by_role_and_label(Role::Slider, &format!("Macro {number}")).is_some()
    };
    let typed = |stage: &mut Stage, text: &str, key: Key| {
        stage.harness.event(Event::Text(text.to_owned()));
        stage.harness.run_steps(2);
        stage.harness.key_press(key);
        stage.harness.run_steps(3);
    };
    let known = names(&stage);
    assert!(known.len() == 4 && !has(&stage, 5));
    stage.button("Add a macro");
    stage.harness.get_by_role_and_label(Role::TextInput, "Name of Macro 5");
    typed(&mut stage, "Shi", Key::Escape);
    assert!(stage.params.state() == before && !has(&stage, 5), "Escape leaves all as it was");
    stage.button("Add a macro");
    typed(&mut stage, " Shine ", Key::Enter);
    assert_eq!((&names(&stage)[..4], &names(&stage)[4][..]), (&known[..], "Shine"));
    assert!(has(&stage, 5) && !stage.host.calls().is_empty(), "the host saves the project");
    stage.harness.get_by_role_and_label(Role::Slider, "Macro 5").click_secondary();
    stage.harness.run_steps(3);
    stage.button("Name Macro 5");
    typed(&mut stage, "Glow", Key::Enter);
    assert_eq!(names(&stage)[4], "Glow");
    stage.button("Undo");
    assert_eq!(names(&stage)[4], "Shine");
    stage.button("Undo");
    assert!(stage.params.state() == before);
    // A sound of the user's own has macros without names: one that moves something comes first.
    stage.params.change(|mut state| {
        let Playable::Preset(preset) = &mut state.playable else { return None };
        preset.guide.macros.clear();
        preset.patch.routes = Routes::NONE;
        preset.patch.routes.set(3, Some(Route::linear(Source::Macro7, Param::Tilt)));
        Some(state)
    });
    stage.harness.run_steps(3);
    for number in [7, 1] {
        stage.button("Add a macro");
        typed(&mut stage, "Mine", Key::Enter);
        assert_eq!(names(&stage)[number - 1], "Mine");
    }
    let kit = facing(Face::Play, "Acoustic Kit", SIZE, 1.0, Theme::Dark);
    assert!(kit.harness.query_by_label("Add a macro").is_none(), "its sounds have theirs");
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
        if band.stage.harness.get_by_role_and_label(Role::RadioButton, "body: Gong").is_focused() {
            return;
        }
    }
    panic!("the tiles cannot be reached by Tab");
}
