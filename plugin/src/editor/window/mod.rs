//! An open window: what it shows in each pass.

mod header;
mod host;
mod kept;
mod keys;
mod meter;
mod presses;
mod reach;
mod requests;
mod status;
mod variation;
mod versions;

use crate::editor::binding;
use crate::editor::body::small::Small;
use crate::editor::browser::{self, Browser};
use crate::editor::controls::history::History;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, FRAME, Interaction, Said};
use crate::editor::devices;
use crate::editor::drops;
use crate::editor::drops::fitting::Fitting;
use crate::editor::host::extent;
use crate::editor::host::focus::Focus;
use crate::editor::keyboard::computer::ComputerKeyboard;
use crate::editor::keyboard::piano::Piano;
use crate::editor::keyboard::wheels::Wheels;
use crate::editor::kit::{self, KitPage};
use crate::editor::manual::Manual;
use crate::editor::motion::MotionPage;
use crate::editor::pages::{self, Pages};
use crate::editor::picker::{Picked, Picker};
use crate::editor::play::PlayPage;
use crate::editor::routes::{carry, learn};
use crate::editor::theme::layout::Layout;
use crate::editor::theme::{Theme, install_fonts};
use crate::link::joined;
use crate::lock::lock;
use crate::params::SprungParams;
use egui::{Event, Key, Popup, Ui};
pub(super) use header::Face;
use header::{Header, Request};
use meter::Meter;
use nice_plug_core::context::PluginApi;
use nice_plug_core::context::gui::GuiContext;
use presses::Presses;
use reach::Reach;
use sprung::internals::library::Library;
use status::{Load, StatusLine};
use std::collections::BTreeSet;
use std::hash::{BuildHasher as _, RandomState};
use std::mem::take;
use std::sync::{Arc, Mutex};
use versions::Versions;

/// Longest time in seconds by which moving pictures go on in one pass: after a pause they go on where they were.
const LONGEST: f32 = 0.25;

/// The view that is shown in place of modes and parameters.
#[derive(Clone, Copy, PartialEq)]
enum Over {
    Browser,
    Manual,
    Files,
    /// The program's devices.
    Devices,
}

/// What a window leaves to the next one when it is closed: its face; and the steps that can be undone, the two versions of the sound, and
/// how many states the host had loaded.
#[derive(Clone, Default)]
pub(super) struct Past(Arc<Mutex<(Face, Option<Steps>)>>);

type Steps = (History, Versions, u64);

/// An open window.
pub(super) struct Window {
    params: Arc<SprungParams>,
    past: Past,
    host: Option<GuiContext>,
    interaction: Interaction,
    history: History,
    shown: Shown,
    small: Small,
    browser: Browser,
    piano: Piano,
    wheels: Wheels,
    computer_keyboard: ComputerKeyboard,
    meter: Meter,
    load: Load,
    /// Sections that variations leave as they are, and the seed of the next one.
    locked: BTreeSet<&'static str>,
    seed: u64,
    focus: Focus,
    reach: Reach,
    face: Face,
    play: PlayPage,
    pages: Pages,
    motion: MotionPage,
    kit: KitPage,
    manual: Manual,
    fitting: Fitting,
    picker: Picker,
    over: Option<Over>,
    /// What was shown before the list of files.
    under: Option<Over>,
    versions: Versions,
    /// The context of a real window, and the zoom that it has, or will have with the first pass.
    context: Option<egui::Context>,
    zoom: f32,
    /// Width and height of the screen at 100 %, if they are known.
    screen: Option<[f64; 2]>,
    /// The time of the last pass.
    now: f64,
    /// How many states the host had loaded when the window last looked.
    loads: u64,
    /// The theme that was last applied to egui's own widgets.
    applied: Option<Theme>,
    /// What has been said since the last pass, even if it is what was said before.
    news: Option<Said>,
    message: Said,
    line: StatusLine,
}

/// The page of the manual that explains what is shown.
fn topic(over: Option<Over>, face: Face, pages: &Pages) -> &'static str {
    match (over, face) {
        (None, Face::Sound) => pages.topic(),
        (None, Face::Motion) => "modulation",
        (None, Face::Kit) => "kits",
        _ => "window",
    }
}

impl Window {
    /// A window that stores the user's sounds in a library; `None` if the system names no folder for user data.
    pub(super) fn new(params: Arc<SprungParams>, library: Option<Library>, past: Past) -> Self {
        let shown = Shown::new(&params);
        let zoom = extent::factor(params.view());
        let (face, steps) = take(&mut *lock(&past.0));
        let (history, versions, loads) = steps.filter(|(.., loads)| *loads == params.loads()).unwrap_or_else(|| {
            (History::of_loaded(kept::is_nowhere(&params, library.as_ref())), Versions::default(), params.loads())
        });
        Self {
            params,
            past,
            host: None,
            interaction: Interaction::default(),
            history,
            shown,
            small: Small::default(),
            browser: Browser::new(library),
            piano: Piano::default(),
            wheels: Wheels::default(),
            computer_keyboard: ComputerKeyboard::default(),
            meter: Meter::default(),
            load: Load::default(),
            locked: BTreeSet::new(),
            // A different seed in each window.
            seed: RandomState::new().hash_one(0_u8),
            focus: Focus::default(),
            reach: Reach::default(),
            face,
            play: PlayPage::default(),
            pages: Pages::default(),
            motion: MotionPage::default(),
            kit: KitPage::default(),
            manual: Manual::default(),
            fitting: Fitting::default(),
            picker: Picker::default(),
            over: None,
            under: None,
            versions,
            context: None,
            zoom,
            screen: None,
            now: 0.0,
            loads,
            applied: None,
            news: None,
            message: Ok(String::new()),
            line: StatusLine::default(),
        }
    }

    /// Shows another face.
    pub(super) fn turn_to(&mut self, face: Face) {
        (self.face, self.over) = (face, None);
    }

    /// Prepares the window for being shown by a host.
    pub(super) fn open(&mut self, host: GuiContext) {
        self.host = Some(host);
        let read = self.params.read_controllers(self.browser.library());
        self.news = Some(read.map(|()| String::new()).map_err(|error| error.to_string()));
        self.applied = None;
    }

    /// Shows the window, over the theme's ground, and carries out the user's requests.
    pub(super) fn contents(&mut self, ui: &mut Ui, host: &GuiContext) {
        let (params, over) = (self.params.clone(), self.over);
        let view = params.view();
        if self.applied.is_none() {
            install_fonts(ui.ctx());
            ui.ctx().add_plugin(Presses::default());
            // Its keys would change the zoom and not the state.
            ui.ctx().options_mut(|options| options.zoom_with_keyboard = false);
        }
        if self.applied != Some(view.theme) {
            self.applied = Some(view.theme);
            view.theme.apply(ui.ctx());
        }
        let palette = view.theme.palette();
        self.reach.follow(ui);
        self.shown.refresh(&params);
        self.follow_loads();
        let window = ui.ctx().content_rect();
        let layout = Layout::of(window);
        let telemetry = &params.link().telemetry;
        let (snapshot, is_silent) = (telemetry.snapshot(), telemetry.is_silent());
        let energies: Vec<f32> = snapshot.masses.iter().map(|mass| if is_silent { 0.0 } else { mass.energy }).collect();
        let now = ui.input(|input| input.time);
        let seconds = ((now - std::mem::replace(&mut self.now, now)) as f32).clamp(0.0, LONGEST);
        let levels = self.meter.levels(telemetry.take_peaks(), seconds);
        if !is_silent || self.meter.is_moving() {
            ui.ctx().request_repaint_after(FRAME);
        }
        let notes: Vec<_> = snapshot.notes.into_iter().flatten().filter(|_| !is_silent).collect();
        if let Some(newest) = notes.first() {
            self.shown.follow(newest.key);
        }
        let has_moved = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
        self.interaction.is_scrolling &= !has_moved;
        let mut hint = None;
        let (name, pad) = (params.name(), params.pad().map(|pad| pad.name()));
        let mut controls = Controls {
            params: &params,
            is_preset: self.shown.preset().is_some(),
            moved: self.shown.one_of_several(),
            host,
            palette,
            interaction: &mut self.interaction,
            history: &mut self.history,
            hint: &mut hint,
            seconds,
            notes: &notes,
        };
        // What is open over the page, or typed there, takes Escape for itself.
        let is_busy = Popup::is_any_open(ui.ctx()) || controls.interaction.waits();
        let header = Header {
            name: &name,
            words: &self.shown.words(),
            figure: self.small.get(&self.shown),
            is_favourite: self.browser.is_favourite(&name),
            pad: pad.as_deref(),
            is_changed: controls.history.is_changed(),
            is_browsing: self.over == Some(Over::Browser),
            face: self.over.is_none().then_some(self.face),
            is_b: self.versions.is_b,
            versions_differ: self.versions.differ(&params),
            view,
            screen: self.screen,
            locked: &self.locked,
            levels,
            lowered: if is_silent { 0.0 } else { snapshot.lowered },
        };
        let request = header::show(ui, layout.header, &header, &mut controls);
        let down = (0..16).fold(0, |down, channel| down | telemetry.keys(channel));
        let voices = if is_silent { 0 } else { snapshot.voices };
        let seen = self.over.is_none().then_some(self.face);
        if seen != Some(Face::Sound) {
            self.pages.leave(&mut controls);
        }
        if seen != Some(Face::Play) {
            self.play.leave(&mut controls);
        }
        if seen != Some(Face::Kit) {
            self.kit.leave(&mut controls);
        }
        if seen != Some(Face::Motion) {
            self.motion.leave();
        }
        // The browser has knobs, too.
        if !matches!(self.over, None | Some(Over::Browser)) {
            (controls.interaction.typing, controls.interaction.naming) = (None, None);
        }
        let (mut reads, mut picked) = (false, Vec::new());
        match self.over {
            Some(Over::Browser) => {
                if let Some((message, is_done)) = self.browser.show(ui, layout.page(), &self.shown, &mut controls) {
                    self.news = Some(message);
                    self.over = self.over.filter(|_| !is_done);
                    if self.browser.is_stale() {
                        self.shown.read_again(&params);
                    }
                }
            }
            Some(Over::Manual) => {
                if self.manual.show(ui, layout.page(), &mut controls) {
                    self.over = None;
                }
            }
            Some(Over::Devices) => {
                if devices::show(ui, layout.page(), &mut controls) {
                    self.over = None;
                }
            }
            Some(Over::Files) => {
                if let Some(done) = self.picker.show(ui, layout.page(), self.browser.library(), &mut controls) {
                    self.over = None;
                    match done {
                        Picked::Files(files) => picked = files,
                        Picked::Saved(message) => {
                            self.news = Some(Ok(message));
                            // It may be one of the user's sounds.
                            self.browser.forget();
                        }
                        Picked::Nothing => self.over = self.under,
                    }
                }
            }
            None if self.face == Face::Play => {
                let level = levels[0].now.max(levels[1].now).min(1.0);
                let sounding = (&energies[..], level);
                if let Some(message) = self.play.show(ui, layout.page(), &self.shown, sounding, &mut controls) {
                    self.news = Some(Err(message));
                }
            }
            None if self.face == Face::Motion => {
                reads = self.motion.show(ui, layout.page(), &self.shown, &mut controls);
            }
            None if self.face == Face::Kit => {
                let (page, others) = (layout.page(), (down, &energies[..], &mut self.browser));
                match self.kit.show(ui, page, &mut self.shown, others, &mut controls) {
                    Some(kit::Request::Edit) => self.face = Face::Sound,
                    Some(kit::Request::Effects) => {
                        self.pages.select("Space");
                        self.face = Face::Sound;
                    }
                    request => reads = request.is_some(),
                }
            }
            None => match self.pages.show(ui, &layout, &self.shown, (&energies, down, voices), &mut controls) {
                Some(pages::Request::Manual) => reads = true,
                Some(pages::Request::Say(message)) => self.news = Some(message),
                None => {}
            },
        }
        if reads {
            self.manual.open(topic(self.over, self.face, &self.pages));
            self.over = Some(Over::Manual);
        }
        let is_escaped = ui.input(|input| input.key_pressed(Key::Escape)) && !is_busy;
        let gives_up = (is_escaped && self.over == Some(Over::Browser)).then_some(Request::GiveUp);
        let gives_up = gives_up.filter(|_| !self.browser.takes_escape());
        if is_escaped && self.over != Some(Over::Browser) {
            self.over = if matches!(self.over, Some(Over::Files)) { self.under } else { None };
        }
        if let Some(pick) = controls.interaction.pick.take() {
            self.picker.open(pick, self.browser.library());
            (self.under, self.over) = (self.over, Some(Over::Files));
        }
        if self.over != Some(Over::Files) {
            self.picker.close();
        }
        picked.extend(drops::dropped(ui));
        let (recordings, files): (Vec<_>, Vec<_>) = picked.into_iter().partition(|path| drops::is_recording(path));
        let mut said = Vec::new();
        for path in files {
            said.push(drops::take(&path, self.browser.library(), &mut controls));
            self.browser.forget();
        }
        if !recordings.is_empty() {
            said.push(self.fitting.begin(recordings));
        }
        if !said.is_empty() {
            said.extend(controls.history.take_lost().map(Ok));
            self.news = Some(joined(said).unwrap_or(Ok(String::new())));
        }
        if let Some(message) = self.fitting.show(ui, layout.page(), &mut controls) {
            self.news = Some(message);
        }
        self.browser.follow_time(now, &controls);
        self.wheels.show(ui, layout.wheels, &mut controls);
        self.piano.show(ui, layout.piano, [down, self.shown.keys()], self.shown.guide(), &mut controls);
        // In a plugin, the computer's keyboard belongs to the host.
        let is_alone = host.plugin_api() == PluginApi::Standalone;
        let is_typing = ui.ctx().egui_wants_keyboard_input();
        let is_list = matches!(self.over, Some(Over::Browser | Over::Files));
        let by_key = is_alone.then(|| keys::asked(is_list, view.zoom, is_typing, ui)).flatten();
        let played = is_alone.then(|| self.computer_keyboard.follow(ui, params.link())).flatten();
        let bound = binding::follow(ui, self.browser.library(), &mut controls);
        let learnt = bound.or_else(|| learn::follow(ui, &mut controls));
        let learnt = learnt.or_else(|| carry::follow(ui, self.shown.guide(), &mut controls));
        let learnt = learnt.or_else(|| controls.interaction.said.take());
        // Knobs have taken the wheel that was theirs.
        let is_wheel = |event: &Event| matches!(event, Event::MouseWheel { .. });
        controls.interaction.is_scrolling |= ui.input(|input| input.events.iter().any(is_wheel));
        // What is dragged may have gone with its page.
        if !ui.input(|input| input.pointer.any_down()) {
            controls.release();
        }
        if let Some(messages) = learnt.or_else(|| params.link().take_messages()).or(played.map(Ok)) {
            self.news = Some(messages);
        }
        if let Some(news) = self.news.take() {
            self.message = news;
            self.line.restart();
        }
        let complaint = controls.interaction.typing.as_ref().and_then(|typing| typing.complaint.clone());
        let is_quiet = self.message.as_ref().is_ok_and(String::is_empty);
        let complaints = || status::summary(&params.complaints()).filter(|_| is_quiet);
        let message = complaint.or_else(complaints).map_or_else(|| self.message.clone(), Err);
        let sample_rate = params.link().sample_rate();
        let load = self.load.share(now, telemetry, sample_rate);
        let engine = status::engine(voices, load, sample_rate);
        let waits = self.interaction.learning.is_some() || self.interaction.binding.is_some();
        // In a host, keys come here only while something has the focus.
        let has_keys = self.over == Some(Over::Browser) && (is_alone || is_typing);
        let rest = if has_keys { browser::KEYS } else { "" };
        let has_stayed = self.line.show(ui, layout.status, (hint.as_ref(), rest), &message, &engine, palette);
        if has_stayed && !waits {
            self.message = Ok(String::new());
            // It is still painted.
            ui.ctx().request_repaint();
        }
        let by_program = || params.link().devices.is_wanted().then_some(Request::Devices);
        if let Some(request) = request.or(gives_up).or(by_key).or_else(by_program) {
            self.carry_out(request, ui, host);
        }
        if self.over != over {
            // The knob into which one types has gone with its page.
            (self.interaction.typing, self.interaction.naming) = (None, None);
        }
        if let Some(message) = self.history.take_lost() {
            self.news = Some(Ok(message));
            ui.ctx().request_repaint();
        }
        // What is only tried is not kept yet.
        if self.over != Some(Over::Browser)
            && let (Some(name), Some(library)) = (self.history.take_chosen(), self.browser.library())
            && let Err(error) = library.note_recent(&name)
        {
            self.news = Some(Err(error.to_string()));
        }
    }

    /// Begins anew after the host has loaded a state: steps and versions of the sound before it would bring that sound
    /// back into a project that the host believes to be another.
    fn follow_loads(&mut self) {
        let loads = self.params.loads();
        if std::mem::replace(&mut self.loads, loads) != loads {
            let history = History::of_loaded(kept::is_nowhere(&self.params, self.browser.library()));
            (self.history, self.versions) = (history, Versions::default());
            self.interaction.switched_off.clear();
            (self.interaction.typing, self.interaction.naming) = (None, None);
            self.news = Some(Ok(String::new()));
        }
    }
}
