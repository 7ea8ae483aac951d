//! Sources that are held over knobs, which take them, and how far they move them.

use super::fake_host::Call;
use super::pictures::{Stage, compare_small, facing, finish};
use crate::editor::theme::{SIZE, Theme};
use crate::editor::window::Face;
use egui::{Event, Key, Pos2, Role, vec2};
use sprung::params::Param;
use sprung::patch::routes::{MAX_ROUTES, Route, Source, amount_param};

impl Stage {
    /// Takes a source from Play to a knob, and rests there. Returns where the pointer is.
    fn rest(&mut self, source: &str, knob: &str) -> Pos2 {
        let from = self.middle(Role::Button, &format!("Source {source}"));
        self.button_at(from, true);
        self.harness.event(Event::PointerMoved(from + vec2(12.0, 0.0)));
        self.harness.run_steps(2);
        let to = self.middle(Role::Slider, knob);
        self.harness.event(Event::PointerMoved(to));
        self.harness.run_steps(30);
        to
    }

    fn move_to(&mut self, pos: Pos2) {
        self.harness.event(Event::PointerMoved(pos));
        self.harness.run_steps(2);
    }

    fn amount(&self, place: usize) -> f32 {
        let amount = amount_param(place);
        self.params.loaded().value(amount as usize, self.params.knobs()[amount as usize].position())
    }
}

fn play() -> (Stage, usize) {
    let stage = facing(Face::Play, "Marimba", SIZE, 1.0, Theme::Dark);
    let routes = stage.routes();
    (stage, (0..MAX_ROUTES).find(|place| routes.get(*place).is_none()).unwrap())
}

#[test]
fn a_source_that_rests_on_a_knob_moves_it_as_far_as_it_is_pulled_in_one_step() {
    let (mut stage, place) = play();
    let before = stage.params.state();
    let at = stage.rest("pressure", "Width");
    assert_eq!(stage.routes().get(place), Some(Route::linear(Source::Pressure, Param::Width)));
    assert_eq!(stage.amount(place), 25.0);
    stage.move_to(at - vec2(0.0, 40.0));
    assert_eq!(stage.amount(place), 45.0);
    stage.move_to(at + vec2(0.0, 10.0));
    assert_eq!(stage.amount(place), 20.0);
    stage.move_to(at - vec2(0.0, 30.0));
    let title = "pressure moves Width by 40 %";
    assert!(stage.paints(title));
    stage.button_at(at - vec2(0.0, 30.0), false);
    assert!(matches!(stage.host.calls().last(), Some(Call::End(name)) if *name == amount_param(place).info().name));
    assert_eq!(stage.amount(place), 40.0);
    stage.button("Undo");
    assert!(stage.params.state() == before && stage.paints(&format!("taken back: {title}")));
    stage.button("Redo");
    assert_eq!(stage.amount(place), 40.0);
    // It has this route now, whose amount goes on from where it is.
    let at = stage.rest("pressure", "Width");
    stage.move_to(at + vec2(0.0, 20.0));
    stage.button_at(at + vec2(0.0, 20.0), false);
    assert_eq!((stage.amount(place), stage.routes().iter().count()), (30.0, before_count(&before) + 1));
}

fn before_count(state: &crate::state::State) -> usize {
    match &state.playable {
        sprung::preset::Playable::Preset(preset) => preset.patch.routes.iter().count(),
        sprung::preset::Playable::Kit(_) => 0,
    }
}

#[test]
fn what_a_knob_has_taken_is_given_up_by_escape_or_to_the_side() {
    let (mut stage, place) = play();
    let before = stage.params.state();
    let at = stage.rest("pressure", "Width");
    stage.move_to(at - vec2(0.0, 40.0));
    stage.harness.key_press(Key::Escape);
    stage.harness.run_steps(2);
    stage.button_at(at, false);
    assert!(stage.params.state() == before);
    let at = stage.rest("pressure", "Width");
    assert!(stage.routes().get(place).is_some());
    stage.move_to(at + vec2(0.0, -300.0));
    stage.move_to(at + vec2(-150.0, -300.0));
    assert!(stage.params.state() == before, "the source is in the hand again");
    stage.button_at(at + vec2(-150.0, -300.0), false);
    assert!(stage.params.state() == before);
}

#[test]
fn a_knob_that_cannot_take_a_source_makes_no_route_and_those_that_can_are_lit() {
    let mut stage = facing(Face::Play, "Church Bell", SIZE, 1.0, Theme::Dark);
    stage.params.knobs()[Param::Space as usize].turn(1.0);
    stage.harness.run_steps(2);
    let before = stage.params.state();
    assert!(!Route::linear(Source::Lfo1, Param::SpaceMix).is_possible());
    let at = stage.rest("LFO 1", "Space mix");
    stage.button_at(at, false);
    assert!(stage.params.state() == before);
    let at = stage.rest("LFO 1", "Space mix");
    stage.move_to(at - vec2(0.0, 150.0));
    compare_small("carrying", 2, &mut stage.harness);
    finish();
}
