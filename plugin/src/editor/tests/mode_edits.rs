//! Changes of modes by the user: they are saved exactly, and a sound that is loaded meanwhile is not changed.

use super::fake_host::Call;
use super::sounding::Band;
use crate::editor::modes::axes::Axes;
use crate::editor::theme::{SIZE, Theme};
use crate::link::Touch;
use crate::state::State;
use egui::{Event, Pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::patch::{Mode, ModeTable};
use sprung::preset::Playable;

impl Band {
    fn table(&self) -> ModeTable {
        self.stage.params.loaded().kit.sounds()[0].patch().modes.clone()
    }

    fn axes(&self) -> Axes {
        Axes::around(self.table().as_slice(), self.rect("Modes of the body").shrink(8.0))
    }

    /// Where the loudest mode is.
    fn loudest(&self) -> Pos2 {
        let (table, axes) = (self.table(), self.axes());
        let loudest = table.as_slice().iter().max_by(|a, b| a.level.abs().total_cmp(&b.level.abs())).unwrap();
        axes.place(loudest)
    }

    /// The place that is farthest from all modes.
    fn free(&self) -> Pos2 {
        let (table, axes) = (self.table(), self.axes());
        let distance = |place: Pos2| {
            let distances = table.as_slice().iter().map(|mode| axes.place(mode).distance(place));
            distances.fold(f32::INFINITY, f32::min)
        };
        let places = (1..40).flat_map(|x| (1..20).map(move |y| vec2(x as f32 / 40.0, y as f32 / 20.0)));
        let places = places.map(|share| axes.rect.min + share * axes.rect.size());
        places.max_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap()
    }

    fn double_click(&mut self, place: Pos2) {
        // A pause, so that it does not count as a triple click.
        self.passes(40);
        for pressed in [true, false, true, false] {
            self.press(place, pressed);
        }
        self.passes(40);
    }

    fn pull(&mut self, from: Pos2) {
        self.passes(40);
        self.press(from, true);
        for step in 1..=8 {
            self.event(Event::PointerMoved(from + vec2(2.0, 3.0) * step as f32));
        }
    }

    #[track_caller]
    fn check_state(&self) {
        let state = self.stage.params.state();
        let read = State::parse(&state.to_json()).unwrap();
        assert_eq!(read.complaints, [""; 0]);
        assert_eq!(read.state, state);
    }
}

fn phases(table: &ModeTable) -> Vec<f32> {
    (0..table.as_slice().len()).map(|mode| table.phase(mode)).collect()
}

#[test]
fn changed_modes_of_a_pair_keep_their_phases_and_are_saved() {
    for sound in ["Glass Marimba", "Guitar"] {
        let mut band = Band::new(sound, SIZE, Theme::Dark);
        let before = band.table();
        assert!(before.origin().is_some_and(|origin| origin.contains("[joint]")), "{sound}: {:?}", before.origin());
        assert!(before.has_phases(), "{sound}");
        let place = band.loudest();
        band.pull(place);
        band.press(place + vec2(16.0, 24.0), false);
        let dragged = band.table();
        let clamped: Vec<Mode> = before.as_slice().iter().map(Mode::clamped).collect();
        let differing = clamped.iter().zip(dragged.as_slice()).filter(|(before, after)| before != after).count();
        assert_eq!((dragged.as_slice().len(), differing), (clamped.len(), 1), "{sound}");
        assert_eq!(phases(&dragged), phases(&before), "{sound}");
        band.check_state();
        band.double_click(band.free());
        let added = band.table();
        assert_eq!(phases(&added), [phases(&dragged), vec![0.0]].concat(), "{sound}");
        band.check_state();
        let place = band.loudest();
        band.double_click(place);
        let removed = band.table();
        let gone = (0..removed.as_slice().len()).find(|mode| removed.as_slice()[*mode] != added.as_slice()[*mode]);
        let mut left = phases(&added);
        left.remove(gone.unwrap_or(removed.as_slice().len()));
        assert_eq!(phases(&removed), left, "{sound}");
        band.check_state();
    }
}

#[test]
fn the_right_button_draws_levels_as_one_step() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    let (table, axes) = (band.table(), band.axes());
    let height = axes.rect.top() + axes.rect.height() / 4.0;
    let [from, to] = [axes.rect.left(), axes.rect.right()].map(|x| Pos2::new(x, height));
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: egui::PointerButton::Secondary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    band.event(Event::PointerMoved(from));
    band.event(button(from, true));
    for step in 1..=10 {
        band.event(Event::PointerMoved(from.lerp(to, step as f32 / 10.0)));
        if step == 5 {
            band.event(Event::PointerGone);
            band.passes(5);
        }
    }
    assert!(matches!(band.heard[..], [.., Touch::Down { .. }]), "it is heard while it is drawn: {:?}", band.heard);
    band.event(button(to, false));
    let drawn = band.table();
    assert_eq!(drawn.as_slice().len(), table.as_slice().len());
    for (before, mode) in table.as_slice().iter().zip(drawn.as_slice()) {
        assert!((mode.level.abs() / axes.level(height) - 1.0).abs() < 1e-3, "{mode:?}");
        let before = before.clamped();
        assert_eq!((mode.ratio, mode.decay, mode.pan), (before.ratio, before.decay, before.pan));
        assert_eq!(mode.level < 0.0, before.level < 0.0);
    }
    band.check_state();
    band.stage.button("Undo");
    assert!(band.stage.params.state() == before, "one step takes it back");
}

#[test]
fn a_drag_ends_if_another_sound_is_loaded() {
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    let State { seed, view, .. } = band.stage.params.state();
    let place = band.loudest();
    band.pull(place);
    assert!(matches!(band.heard[..], [.., Touch::Down { .. }]), "{:?}", band.heard);
    band.stage.params.load(State::new(Playable::find("Church Bell").unwrap(), seed, view).into());
    let loaded = band.stage.params.state();
    band.passes(3);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "its key is let go");
    band.event(Event::PointerMoved(place + vec2(30.0, 10.0)));
    band.passes(20);
    band.press(place + vec2(30.0, 10.0), false);
    assert!(band.stage.params.state() == loaded, "the modes are those of the sound that was loaded");
    let place = band.loudest();
    band.pull(place);
    band.press(place + vec2(16.0, 24.0), false);
    assert!(band.stage.params.state() != loaded);
    band.stage.button("Undo");
    assert!(band.stage.params.state() == loaded, "the drag before is no step");
}

#[test]
fn a_window_that_is_closed_lets_go_of_every_key_and_knob() {
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    let keyboard = band.rect("Keyboard");
    band.press(keyboard.left_bottom() + vec2(11.0, -4.0), true);
    let [Touch::Down { key, .. }] = band.heard[..] else { panic!("{:?}", band.heard) };
    let Band { stage, mut touches, .. } = band;
    drop(stage.harness);
    assert_eq!((touches.pop(), touches.pop().ok()), (Ok(Touch::Up { key }), None));
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    band.pull(band.loudest());
    let Some(Touch::Down { key, .. }) = band.heard.last().copied() else { panic!("{:?}", band.heard) };
    let Band { stage, mut touches, .. } = band;
    drop(stage.harness);
    assert_eq!((touches.pop(), touches.pop().ok()), (Ok(Touch::Up { key }), None));
    let mut band = Band::new("Glass Marimba", SIZE, Theme::Dark);
    band.stage.tab("Mallet");
    let knob = band.stage.at("Mallet speed");
    band.press(knob, true);
    band.event(Event::PointerMoved(knob - vec2(0.0, 20.0)));
    assert!(matches!(band.stage.host.calls()[..], [Call::Begin(_), ..]));
    drop(band.stage.harness);
    assert!(matches!(band.stage.host.calls()[..], [Call::End(_)]));
}

#[test]
fn a_double_clicks_key_is_let_go_when_something_is_shown_over_the_modes() {
    for opens in ["Browse", "Manual: bodies"] {
        let mut band = Band::new("Marimba", SIZE, Theme::Dark);
        let place = band.free();
        for pressed in [true, false, true, false] {
            band.press(place, pressed);
        }
        assert_ne!(band.stage.params.link().telemetry.keys(0), 0, "it is held");
        band.stage.harness.get_by_label(opens).click();
        band.passes(4);
        assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "{opens}: no key is left down");
    }
}
