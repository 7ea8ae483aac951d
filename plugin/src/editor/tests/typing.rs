//! Routes that are typed, and those whose parts are chosen.

use super::pictures::{Stage, facing};
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use egui::{Key, Role};
use egui_kittest::kittest::Queryable as _;
use sprung::params::Param;
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Source, amount_param};

impl Stage {
    fn type_route(&mut self, text: &str) {
        self.harness.get_by_label("New route").focus();
        self.harness.run_steps(2);
        self.type_text(text);
    }

    fn enter(&mut self) {
        self.harness.key_press(Key::Enter);
        self.harness.run_steps(3);
    }
}

fn motion(sound: &str, size: [u32; 2]) -> Stage {
    facing(Face::Motion, sound, size, 1.0, Theme::Dark)
}

#[test]
fn a_route_is_typed_by_the_beginnings_of_its_names_and_shown_before_it_is_made() {
    for size in [SIZE, LEAST_SIZE] {
        let mut stage = motion("Marimba", size);
        let before = (stage.routes(), stage.params.state());
        let place = (0..MAX_ROUTES).find(|place| before.0.get(*place).is_none()).unwrap();
        stage.type_route("wheel noise lev 30");
        assert!(stage.paints("Enter: wheel raises Noise level by 30 %"));
        assert_eq!(stage.routes(), before.0);
        stage.enter();
        assert_eq!(stage.routes().get(place), Some(Route::linear(Source::Wheel, Param::NoiseLevel)));
        assert_eq!(stage.params.state().values.get(amount_param(place)), 30.0);
        // The next one can be typed at once.
        stage.type_text("nothing at all");
        stage.enter();
        assert!(stage.paints("begin like ‘nothing at all’"));
        stage.button("Undo");
        assert!(stage.params.state() == before.1 && stage.paints("taken back: wheel moves Noise level by 30 %"));
    }
}

#[test]
fn a_route_is_chosen_part_by_part() {
    let mut stage = motion("Marimba", SIZE);
    let before = stage.routes();
    let place = (0..MAX_ROUTES).find(|place| before.get(*place).is_none()).unwrap();
    stage.button("Source of a new route");
    stage.button("breath");
    stage.button("Target of a new route");
    stage.button("Noise");
    stage.button("Noise level");
    let route = Route::linear(Source::Breath, Param::NoiseLevel);
    assert_eq!(stage.routes().get(place), Some(route));
    let number = place + 1;
    stage.button(&format!("Curve of route {number}: linear"));
    stage.button("squared");
    stage.button(&format!("Multiplier of route {number}: nothing"));
    stage.button("velocity");
    let route = Route { response: Response::Squared, scale: Some(Source::Velocity), ..route };
    assert_eq!(stage.routes().get(place), Some(route));
    stage.button(&format!("Remove route {number}"));
    assert_eq!(stage.routes(), before);
    stage.button("Undo");
    assert_eq!(stage.routes().get(place), Some(route));
    assert!(stage.paints("taken back: removed breath × velocity › Noise level"));
}

#[test]
fn there_is_no_empty_row_when_all_routes_are_taken() {
    let mut stage = motion("Church Bell", SIZE);
    for target in ["decay", "tilt", "vibrato", "mallet hardness", "noise level", "pan", "mallet level"] {
        if stage.harness.query_by_label("New route").is_none() {
            break;
        }
        stage.type_route(&format!("lfo 2 {target}"));
        stage.enter();
    }
    assert_eq!(stage.routes().iter().count(), MAX_ROUTES);
    assert!(stage.harness.query_by_label("New route").is_none() && stage.paints("all sixteen routes are taken"));
    for place in 0..MAX_ROUTES {
        stage.harness.get_by_role_and_label(Role::Slider, amount_param(place).info().name);
    }
}
