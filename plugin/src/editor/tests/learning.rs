//! What is moved next becomes a route, or turns the knob.

use super::fake_host::Call;
use super::sounding::Band;
use crate::editor::theme::{SIZE, Theme};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use sprung::engine::EventKind;
use sprung::internals::learned::{Controllers, Movement, Takeover, check_controller};
use sprung::internals::library::Library;
use sprung::params::Param;
use sprung::patch::routes::{Routes, Source, amount_param};

impl Band {
    fn learn(&mut self, name: &str) {
        self.pick(name, "Learn a route");
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
fn whatever_moves_is_learnt() {
    let note_off = |key| EventKind::NoteOff { key, velocity: 0.5, id: None };
    let note_on = |key| EventKind::NoteOn { key, detune: 0.0, velocity: 0.7, id: None };
    let control = |controller| EventKind::Control { controller, value: 0.8 };
    for (source, events) in [
        (Source::Wheel, vec![control(1)]),
        (Source::Breath, vec![control(2)]),
        (Source::Expression, vec![control(11)]),
        (Source::Timbre, vec![control(74)]),
        (Source::Bend, vec![EventKind::PitchBend(0.5)]),
        (Source::Pressure, vec![EventKind::ChannelPressure(0.5)]),
        // A key that is held has not decided yet.
        (Source::Pressure, vec![note_on(60), EventKind::PolyPressure { key: 60, pressure: 0.5 }, note_off(60)]),
        (Source::Bend, vec![note_on(60), EventKind::PitchBend(-0.5), note_off(60)]),
        (Source::Velocity, vec![note_on(60), note_off(60)]),
        (Source::Velocity, vec![note_on(60), note_on(64), note_off(60), note_off(64)]),
    ] {
        let mut band = Band::new("Marimba", SIZE, Theme::Dark);
        let before = band.routes();
        band.learn("Mallet speed");
        for event in events {
            band.play(event);
            band.passes(3);
        }
        let new: Vec<_> = band.routes().iter().filter(|(place, _)| before.get(*place).is_none()).collect();
        assert_eq!(new.len(), 1, "{source:?}");
        assert_eq!((new[0].1.source, new[0].1.destination), (source, Param::MalletSpeed));
        assert!(band.stage.paints(&format!("moves {} by", Param::MalletSpeed.info().name)), "{source:?}");
    }
}

#[test]
fn every_controller_but_those_that_are_parts_of_messages_is_learnt() {
    let params = crate::params::SprungParams::default();
    let learned = params.learned();
    for controller in 0..128 {
        let is_part = matches!(controller, 0 | 6 | 32 | 38 | 96..=101 | 120..);
        learned.listen();
        let movement = Takeover::default().follow(learned, controller, 0.5, |info| params.present(info));
        assert_eq!(learned.heard(), Some(controller));
        assert_eq!(matches!(movement, Movement::Free), is_part, "what does something else goes on doing so");
        assert_eq!(check_controller(controller).is_err(), is_part, "{controller}");
        learned.stop();
    }
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

impl Band {
    /// Picks an entry of a knob's menu.
    fn pick(&mut self, name: &str, entry: &str) {
        self.stage.tab("Mallet");
        self.stage.harness.get_by_role_and_label(Role::Slider, name).click_secondary();
        self.passes(3);
        self.stage.button(entry);
        self.passes(2);
    }

    /// Moves a controller, as the audio thread sees it.
    fn turn(&mut self, controller: u8) -> Movement {
        let params = self.stage.params.clone();
        let movement = Takeover::default().follow(params.learned(), controller, 0.5, |info| params.present(info));
        self.passes(3);
        movement
    }

    fn kept(&self) -> Controllers {
        Library::at(self.stage.folder.path()).controllers().unwrap()
    }
}

#[test]
fn the_next_controller_that_moves_turns_the_knob_and_is_kept() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    band.pick("Mallet speed", "Learn a controller");
    assert!(matches!(band.turn(101), Movement::Free) && band.kept().is_empty(), "it is part of a message");
    band.stage.harness.get_by_label_contains("controller 101 sets registered parameters");
    assert!(matches!(band.turn(64), Movement::Nothing));
    assert_eq!(band.kept(), Controllers::from([(64, Param::MalletSpeed)]), "a pedal is a controller too");
    band.pick("Mallet speed", "Learn a controller");
    assert!(matches!(band.turn(21), Movement::Nothing));
    assert_eq!(band.kept(), Controllers::from([(21, Param::MalletSpeed)]));
    assert!(!matches!(band.turn(21), Movement::Free) && matches!(band.turn(22), Movement::Free));
    // Another program has bound another one meanwhile.
    Library::at(band.stage.folder.path()).set_controller(Param::Decay, Some(30)).unwrap();
    band.pick("Mallet hardness", "Learn a controller");
    band.turn(21);
    assert_eq!(band.kept(), Controllers::from([(21, Param::MalletHardness), (30, Param::Decay)]));
    band.stage.harness.get_by_role_and_label(Role::Slider, "Mallet hardness").click_secondary();
    band.passes(3);
    band.stage.harness.get_by_label("CC 21 on any channel");
    band.stage.button("Forget the controller");
    band.passes(2);
    assert_eq!(band.kept(), Controllers::from([(30, Param::Decay)]));
    assert!(matches!(band.turn(21), Movement::Free) && !matches!(band.turn(30), Movement::Free));
    band.pick("Mallet speed", "Learn a controller");
    band.stage.harness.key_press_modifiers(Modifiers::NONE, Key::Escape);
    band.passes(3);
    assert!(matches!(band.turn(21), Movement::Free) && band.kept().len() == 1, "given up");
    band.pick("Mallet speed", "Learn a controller");
    band.pick("Mallet speed", "Learn a route");
    assert!(matches!(band.turn(22), Movement::Free), "a route is learnt in its place");
    band.pick("Mallet hardness", "Learn a controller");
    band.turn(21);
    band.pick("Mallet speed", "Learn a controller");
    band.pick("Mallet hardness", "Forget the controller");
    assert!(matches!(band.turn(22), Movement::Free) && band.kept().len() == 1, "another knob’s was forgotten");
    assert!(band.stage.host.calls().iter().all(|call| matches!(call, Call::Menu(..))), "no knob has moved");
}

#[test]
fn what_is_kept_and_not_understood_is_said_and_stays() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let file = band.stage.folder.path().join("controllers.toml");
    std::fs::write(&file, "decay = \"x\"\n").unwrap();
    band.pick("Mallet speed", "Learn a controller");
    assert!(matches!(band.turn(21), Movement::Nothing));
    assert!(matches!(band.turn(21), Movement::Free), "it cannot be kept");
    band.stage.harness.get_by_label_contains("controllers.toml: decay = \"x\": expected");
    assert_eq!(std::fs::read_to_string(file).unwrap(), "decay = \"x\"\n");
}
