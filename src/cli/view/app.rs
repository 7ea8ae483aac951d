//! The state of the view, and its changes.

use super::desk::{Desk, MakeKit};
use super::keyboard::Keyboard;
use super::layout::Layout;
use ratatui::layout::Rect;
use sprung::engine::{EventKind, Snapshot};
use sprung::internals::display::Load;
use sprung::internals::library::{Catalogue, Library, Listed};
use sprung::internals::text::printable;
use sprung::params::{PARAMS, ParamInfo, Values};
use sprung::realtime::{KitSender, Status};
use sprung::sound::Kit;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a message is shown.
const MESSAGE: Duration = Duration::from_secs(8);

/// Fraction of a meter's level that remains after a tenth of a second.
const FALL: f32 = 0.7;

/// The list that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    Sounds,
    Parameters,
}

/// The text that the user is typing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Typing {
    Nothing,
    /// The filter of the list.
    Search,
    /// A value for the chosen parameter.
    Value(String),
    /// The name to save the channel's sound under.
    Name(String),
}

/// A mouse button that is held on a row of the list.
#[derive(Clone, Copy)]
pub(super) struct Press {
    /// The column at the last event.
    pub(super) column: u16,
    /// Whether the row was already selected before.
    pub(super) again: bool,
    pub(super) moved: bool,
}

/// The kit of a channel, and its parameters.
pub(super) struct Playing {
    pub(super) name: String,
    pub(super) kit: Arc<Kit>,
    pub(super) values: Values,
    program: Option<u8>,
    /// Its entry in the list of sounds, if it was chosen there.
    pub(super) listed: Option<Arc<Listed>>,
}

impl Playing {
    fn new(kit: &Arc<Kit>, program: Option<u8>) -> Self {
        // Text from files must not control the terminal.
        Self {
            name: printable(kit.name()).into_owned(),
            kit: kit.clone(),
            values: *kit.values(),
            program,
            listed: None,
        }
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
    pub(super) library: Option<Library>,
    pub(super) catalogue: Catalogue,
    pub(super) playing: Vec<Playing>,
    pub(super) channel: u8,
    pub(super) list: List,
    pub(super) typing: Typing,
    pub(super) search: [String; 2],
    selected: [usize; 2],
    /// The first visible row of each list.
    first: [usize; 2],
    pub(super) layout: Layout,
    /// The row of the list that the mouse holds.
    pub(super) press: Option<Press>,
    /// An existing name; the next Enter replaces its file.
    pub(super) replace: Option<String>,
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
        let Desk { device, status, keys, kits, kit, channels, programs, make, library } = desk;
        // Text from devices must not control the terminal either.
        let device = printable(&device).into_owned();
        let mut playing: Vec<Playing> = (0..16).map(|_| Playing::new(&kit, None)).collect();
        channels.iter().for_each(|(channel, kit)| playing[usize::from(*channel)] = Playing::new(kit, None));
        let catalogue = Catalogue::read(library.as_ref());
        let message =
            catalogue.broken.first().map(|error| (printable(&error.to_string()).into_owned(), Instant::now()));
        let mut app = Self {
            device,
            status,
            keyboard: Keyboard::new(keys),
            kits,
            programs,
            make,
            library,
            catalogue,
            playing,
            channel: 0,
            list: List::Sounds,
            typing: Typing::Nothing,
            search: Default::default(),
            selected: [0; 2],
            first: [0; 2],
            layout: Layout::of(Rect::ZERO),
            press: None,
            replace: None,
            help: false,
            quit: false,
            load: Load::default(),
            snapshot: Snapshot::default(),
            peaks: [0.0; 2],
            message,
            ticked: Instant::now(),
        };
        app.show_all();
        app
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

    /// The sounds that match the search.
    pub(super) fn sounds(&self) -> Vec<Arc<Listed>> {
        self.catalogue.find(&self.search[List::Sounds as usize])
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

    /// The first visible row of the list.
    pub(super) fn first(&self) -> usize {
        self.first[self.list as usize]
    }

    /// Fits the view to a screen and scrolls the list to its selected row.
    pub(super) fn fit(&mut self, area: Rect) {
        self.layout = Layout::of(area);
        let (shown, selected) = (usize::from(self.layout.rows().height).max(1), self.selected().unwrap_or(0));
        let first = &mut self.first[self.list as usize];
        *first = (*first).clamp((selected + 1).saturating_sub(shown), selected);
    }

    fn rows(&self) -> usize {
        match self.list {
            List::Sounds => self.sounds().len(),
            List::Parameters => self.parameters().len(),
        }
    }

    /// Updates the state: meters fall, held notes end, and the song's program changes are shown.
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
        while let Some((channel, param, value)) = self.kits.next_moved() {
            self.playing[usize::from(channel)].values.set(param, value);
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

    pub(super) fn select(&mut self, rows: isize) {
        let last = self.rows().saturating_sub(1);
        let selected = self.selected().unwrap_or(0);
        self.selected[self.list as usize] = selected.saturating_add_signed(rows).min(last);
    }

    /// Shows the whole list. In the list of sounds, the playing sound is selected.
    pub(super) fn show_all(&mut self) {
        self.search[self.list as usize].clear();
        if self.list == List::Sounds {
            let playing = self.sounds().iter().position(|listed| printable(listed.name()) == self.playing().name);
            self.selected[List::Sounds as usize] = playing.unwrap_or(0);
        }
    }

    /// After a change of the search, selects the best match.
    pub(super) fn select_best(&mut self) {
        self.selected[self.list as usize] = 0;
    }

    /// Selects a visible row. Returns whether it was selected before; none if there is no such row.
    pub(super) fn point(&mut self, row: usize) -> Option<bool> {
        let row = self.first() + row;
        let before = self.selected().filter(|_| row < self.rows())?;
        self.selected[self.list as usize] = row;
        Some(row == before)
    }

    /// Shows the other list.
    pub(super) fn turn_list(&mut self) {
        self.list = if self.list == List::Sounds { List::Parameters } else { List::Sounds };
    }

    pub(super) fn load(&mut self) {
        let Some(listed) = self.selected().and_then(|row| self.sounds().get(row).cloned()) else { return };
        let kit = (self.make)(&listed.playable);
        if self.kits.send(self.channel, &kit) {
            let playing = &mut self.playing[usize::from(self.channel)];
            *playing = Playing { listed: Some(listed), ..Playing::new(&kit, playing.program) };
            let told = format!("channel {} plays ‘{}’", self.channel + 1, playing.name);
            self.tell(told);
        }
    }

    fn parameter(&self) -> Option<&'static ParamInfo> {
        let row = self.selected().filter(|_| self.list == List::Parameters)?;
        self.parameters().get(row).copied()
    }

    /// Changes the selected parameter by a number of steps, which are smaller if `fine`.
    pub(super) fn nudge(&mut self, steps: i32, fine: bool) {
        let Some(info) = self.parameter() else { return };
        let travel = if fine { 0.002 } else { 0.02 };
        let value = self.playing().values.get(info.param);
        let turned = (0..steps.abs()).fold(value, |value, _| info.stepped(value, steps > 0, travel));
        self.set(info, turned);
    }

    pub(super) fn reset(&mut self) {
        if let Some(info) = self.parameter() {
            self.set(info, info.default);
        }
    }

    pub(super) fn enter_value(&mut self, text: &str) {
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
