//! MIDI learn: the next controller that moves becomes a route.

use super::sounding::Band;
use crate::editor::theme::{SIZE, Theme};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use sprung::engine::EventKind;
use sprung::params::Param;
use sprung::patch::routes::{Routes, Source, amount_param};

impl Band {
    fn learn(&mut self, name: &str) {
        self.stage.harness.get_by_role_and_label(Role::Slider, name).click_secondary();
        self.passes(3);
        self.stage.button("MIDI learn");
        self.passes(2);
    }

    fn routes(&self) -> Routes {
        self.stage.params.loaded().kit.sounds()[0].patch().routes
    }

    fn control(&mut self, controller: u8) {
        self.play(EventKind::Control { controller, value: 0.5 });
        self.passes(3);
    }
}

#[test]
fn the_next_controller_that_moves_modulates_the_knob() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let before = (band.stage.params.state(), band.routes());
    band.control(11);
    band.learn("Mallet speed");
    assert!(band.routes() == before.1, "what was moved before does not count");
    // A controller that cannot be a source gives a message, and learning goes on.
    band.control(21);
    assert!(band.routes() == before.1);
    band.play(EventKind::PitchBend(0.0));
    band.control(2);
    let (now, old) = (band.routes(), before.1);
    let (place, route) = now.iter().find(|(place, route)| old.get(*place) != Some(*route)).unwrap();
    assert_eq!((route.source, route.destination), (Source::Breath, Param::MalletSpeed));
    let position = band.stage.params.knobs()[Param::MalletSpeed as usize].position();
    let amount = band.stage.params.state().values.get(amount_param(place));
    assert!((amount / 100.0 + position - 1.0).abs() < 0.01, "as far as the knob goes: {amount}");
    band.control(1);
    assert!(band.routes() == now, "one is learnt");
    band.learn("Mallet speed");
    band.control(2);
    assert!(band.routes() == now, "not twice");
    band.stage.button("Undo");
    assert!(band.stage.params.state() == before.0, "one step");
}

#[test]
fn escape_gives_up() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    band.learn("Mallet speed");
    band.stage.harness.key_press_modifiers(Modifiers::NONE, Key::Escape);
    band.passes(3);
    band.control(1);
    assert!(band.stage.params.state() == before);
}
