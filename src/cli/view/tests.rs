//! Tests of the view on a screen in memory.

use super::app::{App, List, Typing};
use super::{Desk, draw};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Rect;
use sprung::engine::EventKind;
use sprung::internals::learned::Controllers;
use sprung::internals::library::Library;
use sprung::internals::realtime::Moment;
use sprung::params::Param;
use sprung::preset::{KitPreset, Playable, Preset};
use sprung::realtime::{LiveInputs, LiveSender, Player, Setup, Source, Status};
use sprung::sound::Tuning;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Programs of the stand: some of the factory's, since tables of all 250 take seconds.
const PROGRAMS: usize = 16;

/// A view with a player that runs only when [`Stand::play`] is called.
struct Stand {
    app: App,
    midi: LiveSender,
    player: Player,
    epoch: Instant,
    played: Duration,
    folder: tempfile::TempDir,
}

impl Stand {
    fn new() -> Self {
        Self::named("a device", "init")
    }

    fn named(device: &str, name: &str) -> Self {
        let ([keys, midi], inputs) = LiveInputs::new();
        let status = Arc::new(Status::default());
        let programs: Vec<_> = Preset::factory().iter().take(PROGRAMS).map(Preset::kit).collect();
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
        let player = player.with_controllers(&Controllers::from([(21, Param::Tilt)]));
        let make = Box::new(Playable::kit);
        let folder = tempfile::tempdir().unwrap();
        let library = Some(Library::at(folder.path()));
        let desk = Desk { device: device.into(), status, keys, kits, kit, channels, programs, make, library };
        Self { app: App::new(desk), midi, player, epoch: Instant::now(), played: Duration::ZERO, folder }
    }

    fn press(&mut self, code: KeyCode) {
        self.app.key(KeyEvent::new(code, KeyModifiers::NONE), Instant::now());
    }

    fn type_text(&mut self, text: &str) {
        text.chars().for_each(|character| self.press(KeyCode::Char(character)));
    }

    /// Plays a tenth of a second, so that all events sent before are played.
    fn play(&mut self) {
        self.app.tick(Instant::now());
        for _ in 0..10 {
            let moment = Moment { now: self.epoch + self.played, called: self.played, heard: self.played };
            self.player.fill(&mut [0.0_f32; 960], 2, moment);
            self.played += Duration::from_millis(10);
        }
        self.app.tick(Instant::now());
    }

    fn mouse(&mut self, kind: MouseEventKind, column: u16, row: u16) {
        self.app.mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    }

    /// Presses and releases the left button.
    fn click(&mut self, column: u16, row: u16) {
        self.mouse(MouseEventKind::Down(MouseButton::Left), column, row);
        self.mouse(MouseEventKind::Up(MouseButton::Left), column, row);
    }

    fn screen(&mut self, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        self.app.fit(Rect::new(0, 0, width, height));
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
    assert_eq!(stand.app.sounds()[0].name(), "Kick");
    stand.press(KeyCode::Enter);
    stand.press(KeyCode::Enter);
    assert_eq!(stand.app.playing().name, "Kick");
    assert_eq!(stand.app.playing().kit, Preset::find("Kick").unwrap().kit());
    assert!(stand.screen(80, 24).contains("channel 1 plays ‘Kick’"));
    stand.press(KeyCode::Esc);
    assert_eq!(stand.app.sounds().len(), Preset::factory().len() + KitPreset::factory().len());
    let selected = |stand: &Stand| stand.app.sounds()[stand.app.selected().unwrap()].name().to_owned();
    assert_eq!(selected(&stand), "Kick", "the sound that plays is selected in the whole list");
    assert!(stand.screen(80, 24).contains("▸ Kick"));
    stand.type_text("/marimba");
    assert!(selected(&stand).contains("Marimba"), "and the best find in a search");
    assert_eq!(stand.app.selected(), Some(0));
    stand.press(KeyCode::Enter);
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
    // With this short release, a note that is released is silent at once.
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
    for part in ["Sprung", "5 voices", "Masses", "Sounds", "init", "velocity"] {
        assert!(small.contains(part), "{part} in:\n{small}");
    }
}

#[test]
fn control_c_leaves() {
    let mut stand = Stand::new();
    stand.app.key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL), Instant::now());
    assert!(stand.app.quit && stand.app.status.telemetry().keys(0) == 0);
}

#[test]
fn a_sound_is_saved_and_found_again() {
    let mut stand = Stand::new();
    stand.type_text("/kick");
    (0..2).for_each(|_| stand.press(KeyCode::Enter));
    stand.press(KeyCode::Esc);
    stand.press(KeyCode::Tab);
    stand.type_text("/release");
    stand.press(KeyCode::Enter);
    stand.press(KeyCode::Enter);
    stand.type_text("20 ms");
    stand.press(KeyCode::Enter);
    let save = |stand: &mut Stand, name: &str| {
        stand.type_text("W");
        assert_eq!(stand.app.typing, Typing::Name("My Kick".to_owned()), "a name that is free, and then its own");
        (0..40).for_each(|_| stand.press(KeyCode::Backspace));
        stand.type_text(name);
        assert!(stand.screen(80, 24).contains(&format!("save as: {name}▏")));
        stand.press(KeyCode::Enter);
    };
    save(&mut stand, "My Kick");
    let library = Library::at(stand.folder.path());
    let saved = || match library.entries().remove(0).playable.unwrap() {
        Playable::Preset(preset) => preset,
        Playable::Kit(kit) => panic!("{}", kit.name),
    };
    let kick = Preset::find("Kick").unwrap();
    assert_eq!((saved().name.as_str(), saved().patch.get(Param::Release)), ("My Kick", 0.02));
    assert_eq!((&saved().patch.modes, &saved().guide), (&kick.patch.modes, &kick.guide));
    // A text that cannot be a name stays in the field for correction.
    stand.type_text("W");
    (0..40).for_each(|_| stand.press(KeyCode::Backspace));
    stand.type_text("a/b");
    stand.press(KeyCode::Enter);
    assert_eq!(stand.app.typing, Typing::Name("a/b".to_owned()));
    assert!(stand.screen(120, 24).contains("would be taken for a file"));
    stand.press(KeyCode::Esc);
    // A second Enter replaces the file, Esc does not.
    stand.type_text("/release");
    stand.press(KeyCode::Enter);
    stand.press(KeyCode::Backspace);
    let default = Param::Release.info().default;
    for (key, expected) in [(KeyCode::Esc, 0.02), (KeyCode::Enter, default)] {
        save(&mut stand, "My Kick");
        assert!(stand.screen(80, 24).contains("My Kick▏ exists"));
        stand.press(key);
        assert_eq!((stand.app.typing.clone(), saved().patch.get(Param::Release)), (Typing::Nothing, expected));
    }
    stand.press(KeyCode::Tab);
    stand.type_text("/my kick");
    assert_eq!(stand.app.sounds()[0].path, Some(library.presets_folder().join("my-kick.toml")));
}

#[test]
fn kits_are_saved_with_their_presets() {
    let mut stand = Stand::new();
    stand.type_text("/acoustic kit");
    (0..2).for_each(|_| stand.press(KeyCode::Enter));
    assert_eq!(stand.app.playing().name, "Acoustic Kit");
    stand.type_text("W");
    (0..40).for_each(|_| stand.press(KeyCode::Backspace));
    stand.type_text("My Drums");
    stand.press(KeyCode::Enter);
    let saved = Library::at(stand.folder.path()).entries().remove(0).playable.unwrap();
    let Ok(Playable::Kit(kit)) = Playable::find("Acoustic Kit") else { panic!("it is there") };
    assert_eq!((saved.name(), saved.kit().sounds().len()), ("My Drums", kit.sounds.len()));
}

#[test]
fn the_mouse_plays_chooses_and_turns() {
    let mut stand = Stand::new();
    stand.screen(80, 24);
    let (piano, rows) = (stand.app.layout.piano, stand.app.layout.rows());
    // Pressed on C, dragged to D, and released.
    stand.mouse(MouseEventKind::Down(MouseButton::Left), piano.x, piano.y + 3);
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 1 << 60);
    stand.mouse(MouseEventKind::Drag(MouseButton::Left), piano.x + 4, piano.y + 3);
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 1 << 62);
    stand.mouse(MouseEventKind::Up(MouseButton::Left), piano.x + 4, piano.y + 3);
    stand.play();
    assert_eq!(stand.app.status.telemetry().keys(0), 0);
    // Selecting a visible row does not scroll the list.
    (0..4).for_each(|_| stand.mouse(MouseEventKind::ScrollDown, rows.x, rows.y));
    stand.screen(80, 24);
    stand.click(rows.x, rows.y + 2);
    let chosen = stand.app.selected();
    stand.screen(80, 24);
    assert_eq!((chosen, stand.app.first()), (stand.app.selected(), chosen.unwrap() - 2));
    stand.click(rows.x, rows.y + 2);
    assert_eq!(stand.app.playing().name, stand.app.sounds()[chosen.unwrap()].name());
    // A click on the title switches to the other list, in which dragging a row changes its value by one step per
    // column.
    stand.click(rows.x, rows.y - 1);
    assert_eq!(stand.app.list, List::Parameters);
    stand.screen(80, 24);
    let info = stand.app.parameters()[1];
    let value = |stand: &Stand| stand.app.playing().values.get(info.param);
    let before = value(&stand);
    stand.mouse(MouseEventKind::Down(MouseButton::Left), rows.x, rows.y + 1);
    stand.mouse(MouseEventKind::Drag(MouseButton::Left), rows.x + 2, rows.y + 1);
    let two = info.stepped(info.stepped(before, true, 0.02), true, 0.02);
    assert_eq!(value(&stand), two);
    stand.mouse(MouseEventKind::Up(MouseButton::Left), rows.x + 2, rows.y + 1);
    // Dragging back also works on a row that is already selected.
    stand.mouse(MouseEventKind::Down(MouseButton::Left), rows.x + 2, rows.y + 1);
    stand.mouse(MouseEventKind::Drag(MouseButton::Left), rows.x + 1, rows.y + 1);
    stand.mouse(MouseEventKind::Up(MouseButton::Left), rows.x + 1, rows.y + 1);
    assert_eq!((value(&stand), &stand.app.typing), (info.stepped(two, false, 0.02), &Typing::Nothing));
    // A click on the selected row begins typing.
    stand.click(rows.x, rows.y + 1);
    assert_eq!(stand.app.typing, Typing::Value(String::new()));
}

#[test]
fn the_help_fits_forty_columns() {
    let mut stand = Stand::new();
    stand.app.help = true;
    for (width, height) in [(40, 24), (80, 12)] {
        let screen = stand.screen(width, height);
        for text in ["lower octave", "load, or type a value", "save under a name", "Ctrl-C         end"] {
            assert!(screen.contains(text), "{text}: {screen}");
        }
    }
}

#[test]
fn what_a_controller_moves_is_shown() {
    let mut stand = Stand::new();
    for value in [0.0, 1.0] {
        stand.midi.send_now(3, EventKind::Control { controller: 21, value });
        stand.play();
    }
    let tilt = |stand: &Stand, channel: usize| stand.app.playing[channel].values.get(Param::Tilt);
    assert_eq!((tilt(&stand, 3), tilt(&stand, 2)), (Param::Tilt.info().max, Param::Tilt.info().default));
}
