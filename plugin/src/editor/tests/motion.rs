//! The face of what moves: sources that are dragged to knobs of any face, and curves that are drawn.

use super::pictures::{Stage, compare, compare_small, facing, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Role, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::params::Param;
use sprung::patch::routes::{MAX_ROUTES, Route, Routes, Source};
use sprung::preset::Playable;

fn at(sound: &str, size: [u32; 2], theme: Theme) -> Stage {
    facing(Face::Motion, sound, size, 1.0, theme)
}

impl Stage {
    pub(super) fn routes(&self) -> Routes {
        self.params.loaded().kit.sounds()[0].patch().routes
    }

    pub(super) fn middle(&self, role: Role, name: &str) -> Pos2 {
        self.harness.get_by_role_and_label(role, name).rect().center()
    }

    pub(super) fn button_at(&mut self, pos: Pos2, pressed: bool) {
        let button = PointerButton::Primary;
        self.harness.event(Event::PointerMoved(pos));
        self.harness.run_steps(1);
        self.harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
        self.harness.run_steps(2);
    }

    /// Takes a source, holds it over tabs, and lets it go over a knob.
    fn carry(&mut self, source: &str, tabs: &[&str], knob: &str) {
        let from = self.middle(Role::Button, &format!("Source {source}"));
        self.button_at(from, true);
        self.harness.event(Event::PointerMoved(from + vec2(12.0, 0.0)));
        self.harness.run_steps(2);
        for tab in tabs {
            let tab = self.middle(Role::Tab, tab);
            self.harness.event(Event::PointerMoved(tab));
            self.harness.run_steps(30);
        }
        let to = self.middle(Role::Slider, knob);
        self.button_at(to, false);
        self.harness.run_steps(2);
    }
}

/// All of a drag but its end comes in one pass.
#[test]
fn a_quick_drag_takes_what_was_pressed() {
    let mut stage = at("Marimba", SIZE, Theme::Dark);
    let [from, other] = ["Source LFO 1", "Source Envelope 1"].map(|name| stage.middle(Role::Button, name));
    let before = stage.routes();
    stage.harness.event(Event::PointerMoved(from));
    stage.harness.run_steps(2);
    let press =
        Event::PointerButton { pos: from, button: PointerButton::Primary, pressed: true, modifiers: Modifiers::NONE };
    stage.harness.input_mut().events.extend([press, Event::PointerMoved(other)]);
    stage.harness.run_steps(3);
    stage.harness.event(Event::PointerMoved(stage.middle(Role::Tab, "Play")));
    stage.harness.run_steps(30);
    let to = stage.middle(Role::Slider, "Decay");
    stage.button_at(to, false);
    stage.harness.run_steps(2);
    let new = |(place, route): &(usize, Route)| before.get(*place) != Some(*route);
    let made: Vec<_> = stage.routes().iter().filter(new).map(|(_, route)| (route.source, route.destination)).collect();
    assert_eq!(made, [(Source::Lfo1, Param::Decay)]);
}

#[test]
fn no_route_is_cut_off_at_the_side() {
    let stage = at("Church Bell", LEAST_SIZE, Theme::Dark);
    let routes = stage.routes();
    let ends = routes.iter().map(|(place, _)| format!("Remove route {}", place + 1));
    for name in ends.chain(["New route".to_owned()]) {
        let end = stage.harness.get_by_label(&name).rect();
        assert!(end.right() < LEAST_SIZE[0] as f32, "{name} {end:?}");
    }
}

#[test]
fn pictures_of_the_face_are_as_accepted() {
    for (theme, size, name) in [
        (Theme::Dark, SIZE, "motion"),
        (Theme::Dark, LEAST_SIZE, "motion-least"),
        (Theme::Light, LEAST_SIZE, "motion-light-least"),
        (Theme::HighContrast, LEAST_SIZE, "motion-high-contrast-least"),
    ] {
        let mut band = Band::of(at("Church Bell", size, theme));
        if size == SIZE {
            band.stage.button("Source Envelope 1");
            band.strike(&[60, 64]);
            band.passes(2);
        }
        compare(name, &mut band.stage.harness);
    }
    for theme in [Theme::Light, Theme::HighContrast] {
        compare_small(&format!("motion-{}", theme.id()), 2, &mut at("Violin", SIZE, theme).harness);
    }
    compare_small("motion-twice", 4, &mut facing(Face::Motion, "Violin", SIZE, 2.0, Theme::Dark).harness);
    finish();
}

#[test]
fn routes_are_a_matrix_whose_empty_cells_make_routes_or_are_ordered_by_target() {
    for (size, name) in [(SIZE, "motion-matrix"), (LEAST_SIZE, "motion-matrix-least")] {
        let mut stage = at("Church Bell", size, Theme::Dark);
        let before = stage.routes();
        stage.tab("Matrix");
        compare(name, &mut stage.harness);
        for (place, _) in before.iter() {
            let amount = sprung::patch::routes::amount_param(place).info().name;
            stage.harness.get_by_role_and_label(Role::Slider, amount);
        }
        stage.button("Add velocity › Noise level");
        let new: Vec<_> = stage.routes().iter().filter(|(place, _)| before.get(*place).is_none()).collect();
        assert_eq!(new.len(), 1);
        assert_eq!(new[0].1, Route::linear(Source::Velocity, Param::NoiseLevel));
        stage.button("Undo");
        assert_eq!(stage.routes(), before);
    }
    let mut stage = at("Church Bell", SIZE, Theme::Dark);
    stage.tab("By target");
    compare_small("motion-targets", 2, &mut stage.harness);
    let routes = stage.routes();
    let row = |place: usize| stage.harness.get_by_label_contains(&format!("Route {}: ", place + 1)).rect().top();
    let mut rows: Vec<(f32, usize)> =
        routes.iter().map(|(place, route)| (row(place), route.destination as usize)).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(rows.is_sorted_by_key(|(_, target)| *target), "{rows:?}");
    finish();
}

#[test]
fn a_source_that_is_dragged_to_a_knob_of_another_face_modulates_it() {
    let mut stage = at("Marimba", SIZE, Theme::Dark);
    let before = stage.routes();
    let place = (0..MAX_ROUTES).find(|place| before.get(*place).is_none()).unwrap();
    stage.carry("random", &["Sound", "Bow"], "Bow force");
    assert_eq!(stage.routes().get(place), Some(Route::linear(Source::Random, Param::BowForce)));
    assert_eq!(stage.params.loaded().kit.sounds()[0].patch().get(sprung::patch::routes::amount_param(place)), 25.0);
    stage.button("Undo");
    assert_eq!(stage.routes(), before);
    // What players move most is on Play, too.
    stage.harness.get_by_role_and_label(Role::Tab, "Play").click();
    stage.harness.run_steps(3);
    stage.carry("pressure", &[], "Width");
    assert_eq!(stage.routes().get(place), Some(Route::linear(Source::Pressure, Param::Width)));
    stage.button("Undo");
    // The same route is not made twice, and what is let go beside a knob makes none.
    stage.harness.get_by_role_and_label(Role::Tab, "Motion").click();
    stage.harness.run_steps(3);
    stage.carry("velocity", &["Sound", "Mallet"], "Mallet hardness");
    assert_eq!(stage.routes(), before, "it has this route");
    stage.harness.get_by_role_and_label(Role::Tab, "Motion").click();
    stage.harness.run_steps(3);
    let from = stage.middle(Role::Button, "Source LFO 2");
    stage.button_at(from, true);
    stage.button_at(from + vec2(0.0, 500.0), false);
    assert_eq!(stage.routes(), before);
}

#[test]
fn an_envelope_is_drawn_and_each_corner_is_one_step() {
    let mut stage = at("Church Bell", SIZE, Theme::Dark);
    stage.button("Source Envelope 1");
    for (param, by) in [
        (Param::Envelope1Attack, vec2(40.0, 0.0)),
        (Param::Envelope1Decay, vec2(30.0, 0.0)),
        (Param::Envelope1Sustain, vec2(0.0, -20.0)),
        (Param::Envelope1Release, vec2(30.0, 0.0)),
    ] {
        let info = param.info();
        let value = |stage: &Stage| {
            stage.params.loaded().value(param as usize, stage.params.knobs()[param as usize].position())
        };
        let before = value(&stage);
        let corner = stage.middle(Role::Label, &format!("Corner {}", info.name));
        stage.drag(corner, by, Modifiers::NONE);
        assert!(value(&stage) > before, "{}", info.name);
        let turned = value(&stage);
        // A press that moves nothing changes nothing.
        let corner = stage.middle(Role::Label, &format!("Corner {}", info.name));
        stage.drag(corner + vec2(3.0, 0.0), vec2(0.0, 0.0), Modifiers::NONE);
        assert_eq!(value(&stage), turned, "{}", info.name);
        stage.button("Undo");
        assert_eq!(value(&stage), before, "{}", info.name);
    }
}

#[test]
fn an_oscillator_is_dragged_to_another_start_faded_in_and_made_faster() {
    let mut stage = at("Church Bell", SIZE, Theme::Dark);
    stage.button("Source LFO 1");
    for (param, by) in
        [(Param::Lfo1Phase, vec2(-40.0, 0.0)), (Param::Lfo1Fade, vec2(60.0, 0.0)), (Param::Lfo1Rate, vec2(-60.0, 0.0))]
    {
        let position = |stage: &Stage| stage.params.knobs()[param as usize].position();
        let before = position(&stage);
        let corner = stage.middle(Role::Label, &format!("Corner {}", param.info().name));
        stage.drag(corner, by, Modifiers::NONE);
        assert!(position(&stage) > before, "{}", param.info().name);
    }
    // The song gives the rate.
    stage.harness.get_by_label("Corner LFO 1 rate");
    let sync = Param::Lfo1Sync.info();
    stage.params.knobs()[Param::Lfo1Sync as usize].turn(sync.normalise(3.0) as f32);
    stage.harness.run_steps(2);
    assert!(stage.harness.query_by_label("Corner LFO 1 rate").is_none());
}

#[test]
fn the_buttons_of_the_header_do_not_overlap() {
    for width in (640..=1100).step_by(20) {
        let stage = at("Church Bell", [width, 400], Theme::Dark);
        let names = ["Browse", "Save", "Undo", "Redo", "A or B", "Copy A to B", "Menu"];
        let places = names.map(|name| stage.harness.get_by_label(name).rect());
        assert!(places.windows(2).all(|pair| pair[0].right() < pair[1].left()), "{width}: {places:?}");
        assert!(places[6].right() <= width as f32, "{width}: {places:?}");
    }
}

#[test]
fn a_macro_is_named_in_its_place_and_the_name_is_one_step() {
    let mut stage = at("Marimba", SIZE, Theme::Dark);
    let names = |stage: &Stage| match stage.params.state().playable {
        Playable::Preset(preset) => preset.guide.macros,
        Playable::Kit(_) => Vec::new(),
    };
    let before = (names(&stage), stage.params.state());
    assert_eq!(before.0.len(), 4);
    let name = |stage: &mut Stage, text: &str, key: Key| {
        stage.harness.run_steps(2);
        stage.type_text(text);
        stage.harness.key_press(key);
        stage.harness.run_steps(3);
    };
    stage.harness.get_by_role_and_label(Role::Button, "Source macro 6").click_secondary();
    name(&mut stage, " Air ", Key::Enter);
    assert_eq!(names(&stage), [&before.0[..], &[String::new(), "Air".to_owned()]].concat());
    stage.harness.get_by_label_contains("named macro 6 Air");
    // By a key, over the present name; Escape keeps that.
    stage.harness.get_by_role_and_label(Role::Button, "Source Air").focus();
    stage.harness.run_steps(2);
    stage.harness.key_press(Key::F2);
    name(&mut stage, "Wind", Key::Escape);
    assert_eq!(names(&stage)[5], "Air");
    stage.harness.key_press(Key::F2);
    stage.button("Undo");
    assert!(stage.params.state() == before.1, "the other knobs are where they were");
    // Nothing is named anew by its own name, and an empty one takes it away.
    let first = format!("Source {}", before.0[0]);
    stage.harness.get_by_role_and_label(Role::Button, &first).click_secondary();
    name(&mut stage, &before.0[0], Key::Enter);
    assert!(stage.params.state() == before.1);
    stage.harness.get_by_role_and_label(Role::Button, &first).click_secondary();
    stage.harness.run_steps(2);
    name(&mut stage, " ", Key::Enter);
    assert_eq!(names(&stage)[0], "");
    stage.harness.get_by_role_and_label(Role::Button, "Source macro 1");
    // With the macros chosen, whose knobs have names too, each letter is typed once.
    stage.harness.get_by_role_and_label(Role::Button, "Source macro 6").click();
    stage.harness.run_steps(3);
    stage.harness.get_by_role_and_label(Role::Button, "Source macro 6").click_secondary();
    name(&mut stage, "Air", Key::Enter);
    assert_eq!(names(&stage)[5], "Air");
}
