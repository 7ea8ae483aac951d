//! The state of the view, and how keys change it.

use super::desk::{Desk, MakeKit};
use super::keyboard::Keyboard;
use crate::engine::telemetry::Load;
use crate::engine::{EventKind, Snapshot};
use crate::params::{PARAMS, ParamInfo, Unit, Values};
use crate::preset::Preset;
use crate::realtime::{KitSender, Status};
use crate::sound::Kit;
use crate::text::printable;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a message is shown.
const MESSAGE: Duration = Duration::from_secs(8);

/// Fraction of a meter's level that remains after a tenth of a second.
const FALL: f32 = 0.7;

/// The list that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    Presets,
    Parameters,
}

/// What the user is typing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Typing {
    Nothing,
    /// The filter of the list.
    Search,
    /// A value for the chosen parameter.
    Value(String),
}

/// The kit of a channel, and its parameters.
pub(super) struct Playing {
    pub(super) name: String,
    pub(super) kit: Arc<Kit>,
    pub(super) values: Values,
    program: Option<u8>,
}

impl Playing {
    fn new(kit: &Arc<Kit>, program: Option<u8>) -> Self {
        // Text from files must not control the terminal.
        Self { name: printable(kit.name()).into_owned(), kit: kit.clone(), values: *kit.values(), program }
    }
}

pub(super) struct App {
    pub(super) device: String,
    pub(super) status: Arc<Status>,
    pub(super) keyboard: Keyboard,
    kits: KitSender,
    /// The kits that program changes select.
    programs: Vec<Arc<Kit>>,
    make: MakeKit,
    playing: Vec<Playing>,
    pub(super) channel: u8,
    pub(super) list: List,
    pub(super) typing: Typing,
    search: [String; 2],
    selected: [usize; 2],
    pub(super) help: bool,
    pub(super) quit: bool,
    pub(super) load: Load,
    pub(super) snapshot: Snapshot,
    pub(super) peaks: [f32; 2],
    message: Option<(String, Instant)>,
    ticked: Instant,
}

impl App {
    pub(super) fn new(desk: Desk) -> Self {
        let Desk { device, status, keys, kits, kit, channels, programs, make } = desk;
        // Nor must text from devices.
        let device = printable(&device).into_owned();
        let mut playing: Vec<Playing> = (0..16).map(|_| Playing::new(&kit, None)).collect();
        channels.iter().for_each(|(channel, kit)| playing[usize::from(*channel)] = Playing::new(kit, None));
        Self {
            device,
            status,
            keyboard: Keyboard::new(keys),
            kits,
            programs,
            make,
            playing,
            channel: 0,
            list: List::Presets,
            typing: Typing::Nothing,
            search: Default::default(),
            selected: [0; 2],
            help: false,
            quit: false,
            load: Load::default(),
            snapshot: Snapshot::default(),
            peaks: [0.0; 2],
            message: None,
            ticked: Instant::now(),
        }
    }

    /// Shows a message for some time.
    pub(super) fn tell(&mut self, message: String) {
        self.message = Some((printable(&message).into_owned(), Instant::now()));
    }

    pub(super) fn message(&self) -> Option<&str> {
        self.message.as_ref().map(|(message, _)| message.as_str())
    }

    pub(super) fn playing(&self) -> &Playing {
        &self.playing[usize::from(self.channel)]
    }

    pub(super) fn search(&self) -> &str {
        &self.search[self.list as usize]
    }

    /// Presets that match the search, with their numbers in the list of all: first the one of just this name.
    pub(super) fn presets(&self) -> Vec<(usize, &'static Preset)> {
        let search = self.search[List::Presets as usize].to_lowercase();
        let matches = |preset: &Preset| {
            let words = [&preset.name].into_iter().chain(&preset.tags);
            words.map(|word| word.to_lowercase()).any(|word| word.contains(&search))
        };
        let mut found: Vec<_> = Preset::factory().iter().enumerate().filter(|(_, preset)| matches(preset)).collect();
        // The preset of just this name comes first.
        found.sort_by_key(|(_, preset)| !preset.name.eq_ignore_ascii_case(&search));
        found
    }

    /// Parameters that match the search.
    pub(super) fn parameters(&self) -> Vec<&'static ParamInfo> {
        let search = self.search[List::Parameters as usize].to_lowercase();
        let matches = |info: &&ParamInfo| info.id.contains(&search) || info.name.to_lowercase().contains(&search);
        PARAMS.iter().filter(matches).collect()
    }

    /// The selected row of the list; none if the list is empty.
    pub(super) fn selected(&self) -> Option<usize> {
        let rows = self.rows();
        (rows > 0).then(|| self.selected[self.list as usize].min(rows - 1))
    }

    fn rows(&self) -> usize {
        match self.list {
            List::Presets => self.presets().len(),
            List::Parameters => self.parameters().len(),
        }
    }

    /// Updates the state: meters fall, notes end, and program changes of the song are shown.
    pub(super) fn tick(&mut self, now: Instant) {
        self.keyboard.tick(now);
        self.message.take_if(|(_, since)| since.elapsed() > MESSAGE);
        let telemetry = self.status.telemetry();
        self.load = telemetry.load();
        self.snapshot = telemetry.snapshot();
        let fall = libm::powf(FALL, 10.0 * now.saturating_duration_since(self.ticked).as_secs_f32());
        self.ticked = now;
        for (shown, peak) in self.peaks.iter_mut().zip(telemetry.take_peaks()) {
            *shown = peak.max(*shown * fall);
        }
        for (channel, playing) in (0..).zip(&mut self.playing) {
            let program = telemetry.program(channel);
            if let Some(number) = program.filter(|_| program != playing.program)
                && let Some(kit) = self.programs.get(usize::from(number))
            {
                *playing = Playing::new(kit, program);
            }
        }
    }

    /// Handles a key of the computer's keyboard.
    pub(super) fn key(&mut self, event: KeyEvent, now: Instant) {
        if event.kind == KeyEventKind::Release {
            if let KeyCode::Char(character) = event.code {
                self.keyboard.release(character);
            }
            return;
        }
        if event.modifiers.contains(KeyModifiers::CONTROL) {
            self.quit |= matches!(event.code, KeyCode::Char('c' | 'q'));
            return;
        }
        if self.help {
            self.help = false;
        } else if self.typing == Typing::Nothing {
            self.command(event, now);
        } else {
            self.type_key(event.code);
        }
    }

    fn command(&mut self, event: KeyEvent, now: Instant) {
        let fine = event.modifiers.contains(KeyModifiers::SHIFT);
        match event.code {
            KeyCode::Char(character) if self.keyboard.press(character, self.channel, now) => {}
            KeyCode::Char('?') => self.help = true,
            KeyCode::Char('/') => {
                self.search[self.list as usize].clear();
                self.typing = Typing::Search;
            }
            KeyCode::Char('[') => self.keyboard.octave = (self.keyboard.octave - 1).max(0),
            KeyCode::Char(']') => self.keyboard.octave = (self.keyboard.octave + 1).min(8),
            KeyCode::Char('-') => self.keyboard.velocity = (self.keyboard.velocity - 8).max(1),
            KeyCode::Char('=' | '+') => self.keyboard.velocity = (self.keyboard.velocity + 8).min(127),
            KeyCode::Char('<' | ',') => self.channel = (self.channel + 15) % 16,
            KeyCode::Char('>' | '.') => self.channel = (self.channel + 1) % 16,
            KeyCode::Char(' ') => self.keyboard.panic(),
            KeyCode::Tab | KeyCode::BackTab => {
                self.list = if self.list == List::Presets { List::Parameters } else { List::Presets };
            }
            KeyCode::Up => self.select(-1),
            KeyCode::Down => self.select(1),
            KeyCode::PageUp => self.select(-10),
            KeyCode::PageDown => self.select(10),
            KeyCode::Left => self.nudge(-1.0, fine),
            KeyCode::Right => self.nudge(1.0, fine),
            KeyCode::Enter if self.list == List::Presets => self.load_preset(),
            KeyCode::Enter => self.typing = Typing::Value(String::new()),
            KeyCode::Backspace => self.reset(),
            KeyCode::Esc => self.search[self.list as usize].clear(),
            _ => {}
        }
    }

    fn type_key(&mut self, code: KeyCode) {
        let text = match &mut self.typing {
            Typing::Value(text) => text,
            _ => &mut self.search[self.list as usize],
        };
        match code {
            KeyCode::Char(character) => text.push(character),
            KeyCode::Backspace => drop(text.pop()),
            KeyCode::Up => self.select(-1),
            KeyCode::Down => self.select(1),
            KeyCode::Esc => {
                text.clear();
                self.typing = Typing::Nothing;
            }
            KeyCode::Enter => {
                if let Typing::Value(text) = std::mem::replace(&mut self.typing, Typing::Nothing) {
                    self.enter_value(&text);
                }
            }
            _ => {}
        }
    }

    fn select(&mut self, rows: isize) {
        let last = self.rows().saturating_sub(1);
        let selected = self.selected().unwrap_or(0);
        self.selected[self.list as usize] = selected.saturating_add_signed(rows).min(last);
    }

    fn load_preset(&mut self) {
        let Some((_, preset)) = self.selected().and_then(|row| self.presets().get(row).copied()) else { return };
        let kit = (self.make)(preset);
        if self.kits.send(self.channel, &kit) {
            let playing = &mut self.playing[usize::from(self.channel)];
            *playing = Playing::new(&kit, playing.program);
            let told = format!("channel {} plays ‘{}’", self.channel + 1, playing.name);
            self.tell(told);
        }
    }

    fn parameter(&self) -> Option<&'static ParamInfo> {
        let row = self.selected().filter(|_| self.list == List::Parameters)?;
        self.parameters().get(row).copied()
    }

    /// Changes the selected parameter: by one step, or by a fiftieth or five-hundredth of its knob travel.
    fn nudge(&mut self, direction: f64, fine: bool) {
        let Some(info) = self.parameter() else { return };
        let value = self.playing().values.get(info.param);
        let turned = match info.unit {
            Unit::Choice | Unit::Count => value + direction as f32,
            _ => info.denormalise(info.normalise(value) + direction * if fine { 0.002 } else { 0.02 }),
        };
        self.set(info, turned);
    }

    fn reset(&mut self) {
        if let Some(info) = self.parameter() {
            self.set(info, info.default);
        }
    }

    fn enter_value(&mut self, text: &str) {
        let Some(info) = self.parameter() else { return };
        match info.parse(text) {
            Ok(value) => self.set(info, value),
            Err(message) => self.tell(format!("{}: {message}", info.id)),
        }
    }

    fn set(&mut self, info: &ParamInfo, value: f32) {
        let value = info.clamp(value);
        self.playing[usize::from(self.channel)].values.set(info.param, value);
        self.keyboard.send(self.channel, EventKind::Param { param: info.param, value });
    }
}
