//! The moving pictures: the body is struck elsewhere, the mass is pulled and released.

use super::fake_host::Call;
use super::pictures::{compare_part, differing, facing, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Face;
use crate::link::Touch;
use egui::{Event, Key, Pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::engine::EventKind;
use sprung::params::Param;
use sprung::sound::bodies::{Body, Model, Point};
use sprung_picture::{BodyShape, Form, Origin};

impl Band {
    fn show_body(&mut self) {
        self.stage.harness.get_by_label("Shape").click();
        self.passes(3);
    }

    /// Where the body is struck, and where it is heard.
    fn places(&self) -> [Point; 2] {
        let origin = Origin::of(&self.stage.params.loaded().kit.sounds()[0].patch().modes);
        let body = origin.body().unwrap_or_else(|| panic!("{origin:?}"));
        [body.strike, body.pickup]
    }

    /// Where the body is struck.
    fn struck(&self) -> Point {
        self.places()[0]
    }

    /// Drags from one place to another in some steps.
    pub(super) fn pull_to(&mut self, from: Pos2, to: Pos2) {
        self.press(from, true);
        for step in 1..=6 {
            self.event(Event::PointerMoved(from + (to - from) * (step as f32 / 6.0)));
            self.passes(6);
        }
        self.press(to, false);
    }
}

#[test]
fn pictures_of_bodies_are_as_accepted() {
    for (sound, size, theme, name) in [
        ("Opera Gong", SIZE, Theme::Dark, "body-gong"),
        ("Hand Bell", SIZE, Theme::Light, "body-bell"),
        ("Guitar", LEAST_SIZE, Theme::HighContrast, "body-string-least"),
    ] {
        let mut band = Band::new(sound, size, theme);
        band.show_body();
        band.strike(&[60]);
        band.passes(20);
        compare_part(name, &mut band.stage.harness);
    }
    finish();
}

#[test]
fn a_body_is_struck_where_it_is_clicked_and_that_is_undone_by_name() {
    for (sound, form) in [("Opera Gong", Form::Gong), ("Guitar", Form::Line)] {
        let mut band = Band::new(sound, SIZE, Theme::Dark);
        band.show_body();
        let before = band.stage.params.state();
        let modes = |band: &Band| band.stage.params.loaded().kit.sounds()[0].patch().modes.clone();
        let rect = BodyShape::of(&modes(&band), None, &[]).place(band.rect("Struck body"));
        let place = |x, y| form.on(rect, Point { x, y }, 0.0);
        let from = band.struck();
        band.pull_to(place(from.x, from.y), place(0.3, 0.05));
        let now = band.struck();
        assert!((now.x - 0.3).abs() < 0.03 && (form == Form::Line || (now.y - 0.05).abs() < 0.03), "{sound}: {now:?}");
        assert!(modes(&band).origin().is_some_and(|origin| origin.contains("strike = 0.")), "{sound}: saved as a body");
        let strikes = band.heard.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
        assert!(strikes >= 2, "{sound}: it is heard: {:?}", band.heard);
        band.passes(60);
        assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "{sound}: no key is left down");
        let calls = band.stage.host.calls();
        let is_reported = matches!(&calls[..], [Call::Begin(name), Call::Set(..), Call::End(_)] if name == "Voices");
        assert!(is_reported, "the host is told once that there is something to save: {calls:?}");
        band.stage.button("Undo");
        assert!(band.stage.params.state() == before, "{sound}: one step");
    }
}

#[test]
fn a_body_is_heard_where_the_ear_is_dragged_and_a_click_leaves_it_there() {
    let mut band = Band::of(facing(Face::Play, "Opera Gong", SIZE, 1.0, Theme::Dark));
    let before = band.stage.params.state();
    let (rect, [struck, _]) = (band.rect("Struck body"), band.places());
    let place = |x, y| Form::Gong.on(rect, Point { x, y }, 0.0);
    let ear = band.rect("Ear").center();
    band.press(ear + vec2(3.0, 2.0), true);
    band.press(ear + vec2(3.0, 2.0), false);
    assert!(band.heard.iter().any(|touch| matches!(touch, Touch::Down { .. })), "a click is heard");
    assert!(band.stage.params.state() == before && band.stage.host.calls().is_empty());
    band.heard.clear();
    band.pull_to(ear, place(0.5, 0.9));
    let [still, heard] = band.places();
    assert!(still == struck && (heard.x - 0.5).abs() < 0.03 && (heard.y - 0.9).abs() < 0.03, "{heard:?}");
    let strikes = band.heard.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
    assert!(strikes >= 2, "{:?}", band.heard);
    assert_eq!(band.stage.host.calls().len(), 3, "the host is told once");
    // Beside each other, the nearer one is taken.
    let ring = place(struck.x, struck.y);
    band.pull_to(place(heard.x, heard.y), ring + vec2(9.0, 0.0));
    assert_eq!(band.struck(), struck);
    let [_, beside] = band.places();
    band.pull_to(ring, place(0.3, 0.1));
    let [moved, heard] = band.places();
    assert!(heard == beside && (moved.x - 0.3).abs() < 0.03, "{moved:?} {heard:?}");
    for _ in 0..3 {
        band.undo();
    }
    assert!(band.stage.params.state() == before, "three steps");
}

#[test]
fn arrow_keys_move_ring_and_ear() {
    let mut band = Band::of(facing(Face::Play, "Opera Gong", SIZE, 1.0, Theme::Dark));
    let before = band.stage.params.state();
    let [struck, heard] = band.places();
    for (name, key) in [("Struck body", Key::ArrowUp), ("Ear", Key::ArrowLeft)] {
        band.stage.harness.get_by_label(name).focus();
        band.passes(2);
        band.heard.clear();
        band.stage.harness.key_press(key);
        band.passes(3);
        assert!(band.heard.iter().any(|touch| matches!(touch, Touch::Down { .. })), "{name}");
    }
    let [now, ear] = band.places();
    assert!((struck.x - now.x - 0.01).abs() < 1e-6 && now.y == struck.y, "{struck:?} {now:?}");
    assert!((ear.y - heard.y - 0.01).abs() < 1e-6 && ear.x == heard.x, "{heard:?} {ear:?}");
    band.undo();
    assert_eq!(band.places(), [now, heard]);
    band.undo();
    assert!(band.stage.params.state() == before);
}

#[test]
fn arrow_keys_move_the_place_of_a_tables_pluck_in_one_step() {
    let mut band = Band::of(facing(Face::Play, "Plucked String", SIZE, 1.0, Theme::Dark));
    let before = band.stage.params.state();
    band.stage.harness.get_by_label("Struck body").focus();
    band.passes(2);
    for _ in 0..3 {
        band.stage.harness.key_press(Key::ArrowLeft);
        band.passes(2);
    }
    let moved = before.values.get(Param::PluckPosition) - band.stage.params.state().values.get(Param::PluckPosition);
    assert!((moved - 3.0).abs() < 0.01, "{moved}");
    band.undo();
    assert!(band.stage.params.state() == before);
}

#[test]
fn a_body_that_hears_nothing_of_the_place_has_no_ear() {
    for (id, model) in Model::ALL {
        let body = Body::new(model.clone());
        let moved = Body { pickup: Point { x: 0.35, y: 0.2 }, ..body.clone() };
        let levels = |body: &Body| body.modes().into_iter().map(|mode| mode.level).collect::<Vec<_>>();
        assert_eq!(levels(&body) == levels(&moved), *id == "mass", "{id}");
    }
    for (sound, has_ear) in [("Init", false), ("Crash", false), ("Acoustic Kit", false), ("Church Bell", true)] {
        let band = Band::of(facing(Face::Play, sound, SIZE, 1.0, Theme::Dark));
        assert_eq!(band.stage.harness.query_by_label("Ear").is_some(), has_ear, "{sound}");
    }
}

#[test]
fn the_place_of_a_tables_pluck_is_a_parameter_that_the_host_sees() {
    let mut band = Band::new("Plucked String", SIZE, Theme::Dark);
    band.show_body();
    let before = band.stage.params.state();
    let rect = band.rect("Struck body");
    let place = |x| Form::Line.on(rect, Point { x, y: 0.0 }, 0.0);
    // A place near the other end is equivalent.
    band.pull_to(place(0.5), place(0.75));
    let now = band.stage.params.state().values.get(Param::PluckPosition);
    assert!((now - 25.0).abs() < 1.5, "{now}");
    let calls = band.stage.host.calls();
    let is_one =
        matches!(&calls[..], [Call::Begin(name), .., Call::End(last)] if name == "Pluck position" && last == name);
    assert!(is_one && calls.iter().filter(|calls| matches!(calls, Call::Begin(_))).count() == 1, "{calls:?}");
    band.stage.button("Undo");
    assert!(band.stage.params.state() == before);
}

#[test]
fn a_drag_of_the_strike_is_over_when_another_sound_is_loaded() {
    let mut band = Band::new("Opera Gong", SIZE, Theme::Dark);
    band.show_body();
    let rect = band.rect("Struck body");
    band.press(rect.center(), true);
    band.passes(10);
    let other = Band::new("Gong", SIZE, Theme::Dark).stage.params.state();
    band.stage.params.load(other.clone().into());
    band.passes(2);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0);
    band.event(Event::PointerMoved(rect.center() + vec2(20.0, 0.0)));
    band.press(rect.center() + vec2(20.0, 0.0), false);
    band.passes(10);
    assert!(band.stage.params.state() == other, "it is the sound that was loaded, as it was");
}

/// Pulls the mass by a share of the circle's radius, and lets go. Returns what was played.
fn pull(band: &mut Band, share: f32) -> Vec<Touch> {
    band.stage.tab("Phase");
    let rect = band.rect("Phase plane");
    let by = vec2(0.6, -0.8) * (share * (rect.width().min(rect.height()) / 2.0 - 4.0));
    band.heard.clear();
    band.press(rect.center(), true);
    band.event(Event::PointerMoved(rect.center() + by));
    assert!(band.heard.is_empty(), "nothing sounds while it is held");
    band.press(rect.center() + by, false);
    std::mem::take(&mut band.heard)
}

/// The energies of the modes that sound.
fn energies(band: &Band) -> Vec<f32> {
    band.stage.params.link().telemetry.snapshot().masses.iter().map(|mass| mass.energy).collect()
}

#[test]
fn a_mass_that_is_pulled_and_let_go_sounds_alone_and_the_louder_the_farther() {
    let energy = |share: f32| {
        let mut band = Band::new("Marimba", SIZE, Theme::Dark);
        let heard = pull(&mut band, share);
        band.passes(3);
        let energies = energies(&band);
        assert!(energies[1..].iter().all(|energy| *energy == 0.0), "{energies:?}");
        band.passes(60);
        assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "no key is left down");
        (heard, energies[0])
    };
    let ((soft, quarter), (loud, whole)) = (energy(0.25), energy(2.0));
    for (heard, expected) in [(soft, 0.25), (loud, 1.0)] {
        let [Touch::Wake { key: 60, mode: 0, amplitude }] = heard[..] else { panic!("{heard:?}") };
        assert!((amplitude - expected).abs() < 0.02, "{amplitude}");
    }
    assert!((whole / quarter / 16.0 - 1.0).abs() < 0.1, "{quarter} {whole}");
    assert!(energy(0.0).0.is_empty(), "a click pulls nothing");
}

#[test]
fn the_mass_of_a_sounding_note_is_pulled_and_the_note_goes_on() {
    let mut band = Band::new("Church Bell", SIZE, Theme::Dark);
    let strike = EventKind::NoteOn { key: 50, detune: 0.0, velocity: 0.3, id: None };
    band.play_on(4, strike);
    band.passes(20);
    let before = energies(&band);
    let heard = pull(&mut band, 1.0);
    let [Touch::Nudge { channel: 4, key: 50, mode, .. }] = heard[..] else { panic!("{heard:?}") };
    band.passes(3);
    let (after, mode) = (energies(&band), usize::from(mode));
    assert!(after[mode] > 2.0 * before[mode], "{} {}", before[mode], after[mode]);
    let others = (0..after.len()).filter(|m| *m != mode && before[*m] > 1e-6);
    assert!(others.clone().count() > 3 && others.into_iter().all(|m| after[m] < before[m]), "{before:?} {after:?}");
    band.passes(60);
    assert_eq!(band.stage.params.link().telemetry.keys(4), 1 << 50, "the user's key stays down");
    band.play_on(4, EventKind::NoteOff { key: 50, velocity: 0.5, id: None });
    band.passes(2);
    let heard = pull(&mut band, 1.0);
    assert!(matches!(heard[..], [Touch::Nudge { channel: 4, key: 50, .. }]), "{heard:?}");
    assert_eq!(band.stage.params.link().telemetry.keys(4), 0, "a key that was up stays up");
}

#[test]
fn a_mass_that_is_pulled_again_and_again_is_held_each_time() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    for _ in 0..3 {
        assert!(matches!(pull(&mut band, 1.0)[..], [.., Touch::Wake { key: 60, .. }]), "nothing else is held");
        assert!(matches!(pull(&mut band, 0.5)[..], [Touch::Nudge { key: 60, .. }]), "the note is held already");
        band.passes(50);
        assert_eq!(band.stage.params.link().telemetry.keys(0), 0);
    }
}

#[test]
fn with_less_motion_the_body_stands_at_its_greatest_bend() {
    let mut band = Band::of(facing(Face::Play, "Gong", SIZE, 1.0, Theme::Dark));
    band.stage.button("Menu");
    band.stage.button("Less motion");
    assert!(band.stage.params.view().less_motion);
    band.strike(&[48]);
    band.passes(60);
    let stage = |band: &mut Band| {
        let picture = band.stage.harness.render().unwrap();
        image::imageops::crop_imm(&picture, 300, 100, 480, 300).to_image()
    };
    let before = stage(&mut band);
    band.passes(6);
    let still = differing(&before, &stage(&mut band), 16);
    band.stage.params.set_view(|view| view.less_motion = false);
    band.passes(20);
    let before = stage(&mut band);
    band.passes(6);
    let moving = differing(&before, &stage(&mut band), 16);
    assert!(moving > 200 && still < moving / 4, "{still} {moving}");
}
