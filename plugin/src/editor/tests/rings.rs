//! Rings of modulated knobs: a mark for each sounding note at the parameter's modulated position.

use super::pictures::{compare, finish};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::widgets::knob;
use crate::editor::widgets::knob::face::on_ring;
use crate::state::{State, VIEW};
use egui::{Color32, Event, Pos2, Rect};
use egui_kittest::kittest::Queryable as _;
use sprung::params::Param;
use sprung::patch::routes::{Route, Routes, Source, amount_param};
use sprung::preset::{Playable, Preset};

/// A band with these routes, and their amounts in per cent.
fn band(size: [u32; 2], theme: Theme, routes: &[(Source, Param, f32)]) -> Band {
    let mut preset = Preset::find("Church Bell").unwrap().clone();
    preset.patch.routes = Routes::NONE;
    for (place, (source, destination, amount)) in routes.iter().enumerate() {
        preset.patch.routes.set(place, Some(Route::linear(*source, *destination)));
        preset.patch.set(amount_param(place), *amount);
    }
    preset.patch.set(Param::Lfo1Rate, 1.0);
    preset.patch.set(Param::Pan, 0.0);
    preset.patch.set(Param::MalletHardness, 20.0);
    let mut band = Band::new("Church Bell", size, theme);
    let mut view = VIEW;
    view.theme = theme;
    band.stage.params.load(State::new(Playable::Preset(preset), 7, view).into());
    band.follow();
    band.stage.tab("Mallet");
    band.passes(2);
    band
}

impl Band {
    /// The face of a parameter's knob.
    fn face(&self, param: Param) -> Rect {
        let named = self.stage.harness.get_by_role_and_label(egui::Role::Slider, param.info().name);
        knob::face_in(named.rect())
    }

    fn colour_at(&mut self, place: Pos2) -> Color32 {
        let picture = self.stage.harness.render().unwrap();
        let [red, green, blue, _] = picture.get_pixel(place.x as u32, place.y as u32).0;
        Color32::from_rgb(red, green, blue)
    }

    fn is_marked(&mut self, param: Param, position: f32) -> bool {
        let place = on_ring(self.face(param), position);
        let (found, wanted) = (self.colour_at(place), Theme::Dark.palette().modulation);
        let away = |one: u8, other: u8| one.abs_diff(other) < 40;
        away(found.r(), wanted.r()) && away(found.g(), wanted.g()) && away(found.b(), wanted.b())
    }
}

#[test]
fn each_note_has_a_mark_where_its_velocity_moves_the_knob() {
    // From 20 % downwards by 20 % of the travel, multiplied by the velocity.
    let mut band = band(SIZE, Theme::Dark, &[(Source::Velocity, Param::MalletHardness, -20.0)]);
    band.passes(2);
    let [far, near] = [0.8_f32, 0.2].map(|velocity| 0.2 - 0.2 * velocity);
    let marks = |band: &Band| band.marks(Param::MalletHardness);
    assert!(marks(&band).is_empty(), "nothing sounds");
    band.strike_at(60, 0.8);
    band.passes(6);
    assert!(matches!(marks(&band)[..], [mark] if (mark - far).abs() < 1e-3), "{:?}", marks(&band));
    band.strike_at(72, 0.2);
    band.passes(6);
    let now = marks(&band);
    assert!(matches!(now[..], [one, two] if (one - near).abs() < 1e-3 && (two - far).abs() < 1e-3), "{now:?}");
    assert!(band.is_marked(Param::MalletHardness, near) && band.is_marked(Param::MalletHardness, far));
}

#[test]
fn an_oscillator_moves_the_mark_to_and_fro_while_the_note_sounds() {
    let mut band = band(SIZE, Theme::Dark, &[(Source::Lfo1, Param::Pan, 25.0)]);
    band.stage.harness.get_by_role_and_label(egui::Role::Tab, "Output").click();
    band.passes(3);
    band.strike_at(60, 0.8);
    let mut seen = Vec::new();
    for _ in 0..40 {
        band.passes(3);
        let [mark] = band.marks(Param::Pan)[..] else { panic!("one mark") };
        assert!((0.249..=0.751).contains(&mark), "within the range: {mark}");
        seen.push(mark);
    }
    let (least, most) = seen.iter().fold((1.0_f32, 0.0_f32), |(least, most), mark| (least.min(*mark), most.max(*mark)));
    assert!(least < 0.3 && most > 0.7, "a whole cycle of two seconds: {seen:?}");
    let mark = seen[seen.len() - 1];
    assert!(band.is_marked(Param::Pan, mark), "it is drawn");
    band.silence();
    band.passes(4);
    assert!(band.marks(Param::Pan).is_empty(), "it ends with the note");
}

/// A knob that does nothing is dimmed, and says what to switch on; what a route can raise is not off.
#[test]
fn a_knob_without_effect_says_what_it_waits_for() {
    for (sound, says) in [(&[][..], true), (&[(Source::Wheel, Param::BowLevel, 50.0)], false)] {
        let mut band = band(SIZE, Theme::Dark, sound);
        band.stage.tab("Bow");
        band.event(Event::PointerMoved(band.face(Param::BowForce).center()));
        assert_eq!(band.stage.paints("Bow is off: its lamp is on Sound and Play."), says);
        band.event(Event::PointerMoved(band.face(Param::BowLevel).center()));
        assert!(!band.stage.paints("its lamp is on"), "it is what switches it on");
        band.stage.tab("Pitch");
        band.event(Event::PointerMoved(band.face(Param::VibratoRate).center()));
        assert!(band.stage.paints("Vibrato is 0 ct: turn it up and this matters."));
    }
}

#[test]
fn a_source_is_dragged_from_the_line_below_the_part_to_its_knob() {
    let mut band = band(SIZE, Theme::Dark, &[]);
    let from = band.rect("Source breath").center();
    let to = band.face(Param::MalletSpeed).center();
    band.press(from, true);
    (1..=6).for_each(|step| band.event(Event::PointerMoved(from + (to - from) * (step as f32 / 6.0))));
    band.press(to, false);
    let routes = band.stage.params.loaded().kit.sounds()[0].patch().routes;
    let (_, route) = routes.iter().next().unwrap();
    assert_eq!((route.source, route.destination), (Source::Breath, Param::MalletSpeed));
}

#[test]
fn pictures_of_rings_are_as_accepted() {
    let routes = [
        (Source::Velocity, Param::MalletHardness, 60.0),
        (Source::Lfo1, Param::MalletLevel, 15.0),
        (Source::Key, Param::NoiseLevel, 30.0),
    ];
    for (size, theme, name) in [(SIZE, Theme::Dark, "rings"), (LEAST_SIZE, Theme::HighContrast, "rings-least")] {
        let mut band = band(size, theme, &routes);
        for (key, velocity) in [(48, 0.9), (60, 0.5), (79, 0.2)] {
            band.strike_at(key, velocity);
            band.passes(15);
        }
        // The status line shows the newest note's value.
        let place = band.face(Param::MalletHardness).center();
        band.event(Event::PointerMoved(place));
        compare(name, &mut band.stage.harness);
    }
    finish();
}

#[test]
fn a_knob_says_what_moves_it() {
    let routes = [(Source::Velocity, Param::MalletHardness, 35.0), (Source::Lfo1, Param::MalletHardness, 0.0)];
    let mut band = band(SIZE, Theme::Dark, &routes);
    let at = band.face(Param::MalletHardness).center();
    band.event(Event::PointerMoved(at));
    band.passes(2);
    assert!(band.stage.paints("Moved by velocity +35 %."));
}
