//! Tests of the view on a screen in memory.

use super::app::{App, List, Typing};
use super::{Desk, draw};
use crate::params::Param;
use crate::preset::Preset;
use crate::realtime::{LiveInputs, Moment, Player, Setup, Status};
use crate::sound::Tuning;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A view with a player that runs only when [`Stand::play`] is called.
struct Stand {
    app: App,
    player: Player,
    epoch: Instant,
    played: Duration,
}

impl Stand {
    fn new() -> Self {
        Self::named("a device", "init")
    }

    fn named(device: &str, name: &str) -> Self {
        let ([keys], inputs) = LiveInputs::new();
        let status = Arc::new(Status::default());
        let programs: Vec<_> = Preset::factory().iter().map(Preset::kit).collect();
        let kit = Preset { name: name.into(), ..Preset::factory()[0].clone() }.kit();
        let channels = vec![];
        let setup = Setup {
            sample_rate: 48_000,
            seed: 0,
            kit: &kit,
            channels: &channels,
            programs: &programs,
            mix: None,
            tuning: &Tuning::EQUAL,
            song: None,
        };
        let (player, kits) = Player::new(setup, inputs, None, status.clone());
        let make = Box::new(Preset::kit);
        let desk = Desk { device: device.into(), status, keys, kits, kit, channels, programs, make };
        Self { app: App::new(desk), player, epoch: Instant::now(), played: Duration::ZERO }
    }

    fn press(&mut self, code: KeyCode) {
        self.app.key(KeyEvent::new(code, KeyModifiers::NONE), Instant::now());
    }

    fn type_text(&mut self, text: &str) {
        text.chars().for_each(|character| self.press(KeyCode::Char(character)));
    }

    /// Plays a tenth of a second, so that every event that was sent is played.
    fn play(&mut self) {
        self.app.tick(Instant::now());
        for _ in 0..10 {
            let moment = Moment { now: self.epoch + self.played, called: self.played, heard: self.played };
            self.player.fill(&mut [0.0_f32; 960], 2, moment);
            self.played += Duration::from_millis(10);
        }
        self.app.tick(Instant::now());
    }

    fn screen(&self, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw::draw(&self.app, frame)).unwrap();
        terminal.backend().to_string()
    }
}

#[test]
fn nothing_of_a_name_steers_the_terminal() {
    let mut stand = Stand::named("card\u{1b}[2J", "gnp\u{202e}.");
    stand.app.tell("gone: \u{9b}1m\n".to_owned());
    let screen = stand.screen(100, 24);
    for shown in ["card\\u001b[2J", "gnp\\u202e.", "gone: \\u009b1m\\u000a"] {
        assert!(screen.contains(shown), "{shown}: {screen}");
    }
}

#[test]
fn keys_play_notes_that_end_by_themselves() {
    let mut stand = Stand::new();
    stand.type_text("zq");
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 1 << 60 | 1 << 72);
    assert!(stand.app.snapshot.voices == 2 && stand.app.peaks[0] > 0.01);
    let screen = stand.screen(80, 24);
    assert!(screen.contains("2 voices") && screen.contains('●'), "{screen}");
    stand.app.tick(Instant::now() + Duration::from_secs(1));
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 0);
}

#[test]
fn octave_velocity_and_channel_move_within_their_bounds() {
    let mut stand = Stand::new();
    stand.type_text("]]]]]]]");
    assert_eq!((stand.app.keyboard.octave, stand.app.keyboard.lowest()), (8, 108));
    stand.type_text("p");
    stand.type_text("[[[[[[[[[[[");
    assert_eq!(stand.app.keyboard.lowest(), 12);
    stand.type_text("--------------------");
    assert_eq!(stand.app.keyboard.velocity, 1);
    stand.type_text("====================");
    assert_eq!(stand.app.keyboard.velocity, 127);
    stand.type_text(",");
    assert_eq!(stand.app.channel, 15);
    stand.type_text(".z");
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 1 << 12, "a note beyond the keyboard is none");
}

#[test]
fn a_preset_is_found_and_loaded() {
    let mut stand = Stand::new();
    stand.type_text("/kick");
    assert_eq!(stand.app.presets()[0].1.name, "Kick");
    stand.press(KeyCode::Enter);
    stand.press(KeyCode::Enter);
    assert_eq!(stand.app.playing().name, "Kick");
    assert_eq!(stand.app.playing().kit, Preset::find("Kick").unwrap().kit());
    assert!(stand.screen(80, 24).contains("channel 1 plays ‘Kick’"));
    stand.press(KeyCode::Esc);
    assert_eq!(stand.app.presets().len(), Preset::factory().len());
    stand.type_text("/no such preset");
    stand.press(KeyCode::Enter);
    stand.press(KeyCode::Enter);
    assert_eq!((stand.app.selected(), stand.app.playing().name.as_str()), (None, "Kick"));
}

#[test]
fn a_parameter_is_turned_typed_and_reset() {
    let mut stand = Stand::new();
    stand.press(KeyCode::Tab);
    assert_eq!(stand.app.list, List::Parameters);
    stand.type_text("/release");
    stand.press(KeyCode::Enter);
    let value = |stand: &Stand| stand.app.playing().values.get(Param::Release);
    let default = value(&stand);
    stand.press(KeyCode::Right);
    assert!(value(&stand) > default);
    stand.press(KeyCode::Enter);
    stand.type_text("20 ms");
    assert!(stand.screen(80, 24).contains("20 ms▏"));
    stand.press(KeyCode::Enter);
    assert_eq!(value(&stand), 0.02);
    stand.press(KeyCode::Enter);
    stand.type_text("99 s");
    stand.press(KeyCode::Enter);
    assert_eq!((value(&stand), &stand.app.typing), (0.02, &Typing::Nothing));
    assert!(stand.screen(80, 24).contains("release: 99 is out of range"));
    // A note that is released together with it is silent at once.
    stand.type_text("z");
    stand.play();
    stand.app.tick(Instant::now() + Duration::from_secs(1));
    stand.play();
    assert!(stand.app.status.telemetry().is_silent(), "the player has heard of it");
    stand.press(KeyCode::Backspace);
    assert_eq!(value(&stand), default);
}

#[test]
fn every_size_of_screen_can_be_drawn() {
    let mut stand = Stand::new();
    stand.type_text("zxcvb");
    stand.play();
    for help in [false, true] {
        stand.app.help = help;
        for (width, height) in [(1, 1), (5, 3), (19, 7), (40, 12), (80, 24), (250, 90)] {
            stand.screen(width, height);
        }
    }
    stand.app.help = false;
    let small = stand.screen(40, 12);
    for part in ["Sprung", "5 voices", "Masses", "Presets", "Kick", "velocity"] {
        assert!(small.contains(part), "{part} in:\n{small}");
    }
}

#[test]
fn control_c_leaves() {
    let mut stand = Stand::new();
    stand.app.key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL), Instant::now());
    assert!(stand.app.quit && stand.app.status.telemetry().keys(0) == 0);
}
