//! A window with a playing engine: the audio thread's work is done between the window's passes.

use super::pictures::{Stage, compare, compare_part, compare_small, finish, stage};
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::link::Touch;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use rtrb::Consumer;
use sprung::engine::{Event as Played, EventKind, Snapshot, Synth};
use sprung::internals::display::TelemetryWriter;
use sprung::params::Param;
use std::time::Duration;

const RATE: f64 = 48_000.0;

/// A synth that plays the events of a window.
pub(super) struct Band {
    pub(super) stage: Stage,
    synth: Synth,
    pub(super) touches: Consumer<Touch>,
    writer: TelemetryWriter,
    /// The events that the window has played.
    pub(super) heard: Vec<Touch>,
}

impl Band {
    pub(super) fn new(sound: &str, size: [u32; 2], theme: Theme) -> Self {
        Self::of(stage(sound, size, 1.0, theme))
    }

    /// A synth that plays the events of a window.
    pub(super) fn of(stage: Stage) -> Self {
        let link = stage.params.link();
        let (touches, writer) = (link.connect(RATE), TelemetryWriter::new(link.telemetry.clone(), RATE));
        let mut synth = Synth::new(RATE, 0);
        synth.set_kit(&stage.params.loaded().kit);
        Self { stage, synth, touches, writer, heard: Vec::new() }
    }

    pub(super) fn play(&mut self, kind: EventKind) {
        self.play_on(0, kind);
    }

    pub(super) fn play_on(&mut self, channel: u8, kind: EventKind) {
        let event = Played { frame: 0, channel, kind };
        self.writer.note_event(&event);
        self.synth.handle(&event);
    }

    pub(super) fn strike(&mut self, keys: &[u8]) {
        keys.iter().for_each(|key| self.strike_at(*key, 0.8));
    }

    pub(super) fn strike_at(&mut self, key: u8, velocity: f32) {
        self.play(EventKind::NoteOn { key, detune: 0.0, velocity, id: None });
    }

    /// Loads the window's present sound into the synth.
    pub(super) fn follow(&mut self) {
        self.synth.set_kit(&self.stage.params.loaded().kit);
    }

    /// Ends all notes.
    pub(super) fn silence(&mut self) {
        self.play(EventKind::Silence { notes: Default::default() });
    }

    /// The positions of a parameter in the sounding notes, the newest note first.
    pub(super) fn marks(&self, param: Param) -> Vec<f32> {
        let notes = self.stage.params.link().telemetry.snapshot().notes;
        let moved = notes.into_iter().flatten().flat_map(|note| note.moved).flatten();
        moved.filter(|(moved, _)| *moved == param).map(|(_, value)| param.info().normalise(value) as f32).collect()
    }

    /// Does some passes of the window, and renders a sixtieth of a second before each.
    pub(super) fn passes(&mut self, count: usize) {
        for _ in 0..count {
            while let Ok(touch) = self.touches.pop() {
                self.heard.push(touch);
                touch.events().for_each(|(channel, kind)| self.play_on(channel, kind));
            }
            let (mut left, mut right) = ([0.0; 800], [0.0; 800]);
            self.synth.process(&[], &mut left, &mut right);
            let synth = &self.synth;
            self.writer.note_block(left.len(), Duration::from_micros(200));
            self.writer.note_sound(&left, &right, synth.is_silent(), || {
                let mut snapshot = Snapshot::default();
                synth.show(&mut snapshot);
                snapshot
            });
            self.stage.harness.step();
        }
    }

    pub(super) fn rect(&self, name: &str) -> Rect {
        self.stage.harness.get_by_label(name).rect()
    }

    pub(super) fn event(&mut self, event: Event) {
        self.stage.harness.event(event);
        self.passes(2);
    }

    pub(super) fn press(&mut self, pos: Pos2, pressed: bool) {
        self.event(Event::PointerMoved(pos));
        self.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE });
    }
}

/// The wheels play, show where a player's own stand, and the pitch springs back when its wheel is let go.
#[test]
fn wheels_are_moved_here_and_there() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let value = |band: &Band, name| band.stage.harness.get_by_label(name).accesskit_node().numeric_value();
    let key = |pressed| {
        let (physical_key, modifiers) = (None, Modifiers::NONE);
        Event::Key { key: Key::ArrowUp, physical_key, pressed, repeat: false, modifiers }
    };
    let top = band.rect("Bend").center_top();
    band.press(top + vec2(0.0, 1.0), true);
    assert_eq!((&band.heard[..], value(&band, "Bend")), (&[Touch::Bend(1.0)][..], Some(1.0)));
    band.press(top + vec2(0.0, 1.0), false);
    band.passes(2);
    assert_eq!((band.heard.last(), value(&band, "Bend")), (Some(&Touch::Bend(0.0)), Some(0.0)));
    let middle = band.rect("Wheel").center();
    [true, false].into_iter().for_each(|pressed| band.press(middle, pressed));
    band.passes(2);
    assert_eq!((band.heard.last(), value(&band, "Wheel")), (Some(&Touch::Wheel(0.5)), Some(0.5)), "it stays");
    band.play(EventKind::Control { controller: 1, value: 0.25 });
    band.stage.harness.get_by_label("Wheel").focus();
    band.passes(2);
    band.event(key(true));
    assert_eq!(band.heard.last(), Some(&Touch::Wheel(0.3)), "a step from where the player has it");
    band.event(key(false));
    // An arrow bends as long as it is down.
    band.stage.harness.get_by_label("Bend").focus();
    band.passes(2);
    for (pressed, bend) in [(true, 1.0), (false, 0.0)] {
        band.event(key(pressed));
        assert_eq!(band.heard.last(), Some(&Touch::Bend(bend)));
    }
    // What the window holds is let go when it closes.
    band.press(top + vec2(0.0, 1.0), true);
    let Band { stage, mut touches, .. } = band;
    drop(stage);
    assert_eq!(touches.pop().ok(), Some(Touch::Bend(0.0)));
}

#[test]
fn pictures_of_a_struck_bell_are_as_accepted() {
    for (size, theme, name) in
        [(SIZE, Theme::Dark, "bell"), (SIZE, Theme::Light, "bell-light"), (LEAST_SIZE, Theme::Dark, "bell-least")]
    {
        let mut band = Band::new("Church Bell", size, theme);
        band.passes(2);
        band.strike(&[60, 67]);
        band.passes(120);
        // A light window differs from a dark one in its colours.
        match theme {
            Theme::Light => compare_small(name, 2, &mut band.stage.harness),
            _ => compare(name, &mut band.stage.harness),
        }
    }
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    band.stage.harness.get_by_label("Scope").click();
    band.passes(3);
    band.strike(&[48, 52]);
    band.passes(6);
    compare_part("scope", &mut band.stage.harness);
    let mut band = Band::new("Church Bell", SIZE, Theme::Light);
    band.stage.harness.get_by_label("Ringing").click();
    band.passes(3);
    band.strike(&[60]);
    band.passes(150);
    compare_part("ringing", &mut band.stage.harness);
    finish();
}

#[test]
fn the_keyboard_plays_what_is_clicked_and_louder_below() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let keyboard = band.rect("Keyboard");
    let (soft, loud) = (keyboard.left_top() + vec2(11.0, 3.0), keyboard.left_bottom() + vec2(11.0, -4.0));
    band.press(loud, true);
    let [Touch::Down { key, velocity }] = band.heard[..] else { panic!("{:?}", band.heard) };
    assert!(velocity > 0.9, "{velocity}");
    assert_eq!(band.stage.params.link().telemetry.keys(0), 1 << key);
    band.event(Event::PointerMoved(loud + vec2(60.0, 0.0)));
    assert!(matches!(band.heard[1..], [Touch::Up { key: up }, Touch::Down { .. }] if up == key), "{:?}", band.heard);
    band.press(loud + vec2(60.0, 0.0), false);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "no key is left down");
    band.heard.clear();
    band.press(soft, true);
    assert!(matches!(band.heard[..], [Touch::Down { velocity, .. }] if velocity < 0.1), "{:?}", band.heard);
}

#[test]
fn the_limiters_work_is_told_beside_the_level() {
    let mut band = Band::new("Church Bell", SIZE, Theme::Dark);
    band.synth.handle(&Played {
        frame: 0,
        channel: 0,
        kind: EventKind::Param { param: Param::Gain, value: Param::Gain.info().max },
    });
    band.strike(&[48, 52, 55, 60, 64, 67, 72]);
    band.passes(6);
    let meter = band.rect("Level").center();
    band.event(Event::PointerMoved(meter));
    band.passes(60);
    assert!(band.stage.params.link().telemetry.snapshot().lowered > 1.0);
    assert!(
        band.stage.paints("the limiter takes") && band.stage.paints("limiter −"),
        "in the status line, and at the meter"
    );
}

#[test]
fn a_dragged_mode_changes_sounds_and_comes_back() {
    let mut band = Band::new("init", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    let modes = |band: &Band| band.stage.params.loaded().kit.sounds()[0].patch().modes.as_slice().to_vec();
    assert_eq!(modes(&band).len(), 1);
    let area = band.rect("Modes of the body");
    // Adds a second mode, at a place without one.
    let place = area.center();
    for _ in 0..2 {
        band.press(place, true);
        band.press(place, false);
    }
    let added = modes(&band);
    assert_eq!(added.len(), 2);
    assert!(added[1].level > 0.01 && added[1].ratio > 1.0, "{added:?}");
    band.passes(30);
    let place = band.stage.harness.ctx.input(|input| input.pointer.latest_pos()).unwrap();
    band.heard.clear();
    band.press(place, true);
    for step in 1..=10 {
        band.event(Event::PointerMoved(place + vec2(4.0, -3.0) * step as f32));
    }
    band.press(place + vec2(40.0, -30.0), false);
    let moved = modes(&band);
    assert!(moved[1].ratio > added[1].ratio && moved[1].level > added[1].level, "{moved:?}");
    assert_eq!(moved[0], added[0]);
    let strikes = band.heard.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
    assert!((1..=4).contains(&strikes), "struck four times a second at most: {:?}", band.heard);
    assert_eq!(band.stage.params.link().telemetry.keys(0), 0, "no key is left down");
    for _ in 0..2 {
        band.stage.harness.get_by_label("Undo").click();
        band.passes(3);
    }
    assert_eq!(band.stage.params.state(), before);
}
