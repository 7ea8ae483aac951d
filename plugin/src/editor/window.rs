//! The contents of the window.

use super::browser::Browser;
use super::buttons::tab;
use super::controls::{Controls, Hands};
use super::files::{load, summary};
use super::focus::Focus;
use super::header::{self, Header, Wish};
use super::history::{History, restore};
use super::layout::Layout;
use super::meter::Meter;
use super::modes::ModesView;
use super::motion::Motion;
use super::piano::Piano;
use super::shown::Shown;
use super::theme::{GAP, LEAST_SIZE, Theme};
use super::{sections, status};
use crate::params::SprungParams;
use crate::state::{State, View, WINDOW_RANGE};
use egui::{Key, Rect, Ui, pos2, vec2};
use nice_plug_core::context::gui::GuiContext;
use nice_plug_egui::baseview::{HandlerError, WindowSize};
use nice_plug_egui::resizable_window::ResizableWindow;
use nice_plug_egui::{Frame, KeyCapture, NiceEguiApp};
use sprung::preset::library::Library;
use sprung::preset::{Playable, Preset};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

/// Between two pictures while something moves.
const FRAME: Duration = Duration::from_millis(16);

/// An open window.
pub(super) struct Window {
    params: Arc<SprungParams>,
    host: Option<GuiContext>,
    hands: Hands,
    history: History,
    shown: Shown,
    browser: Browser,
    modes: ModesView,
    motion: Motion,
    piano: Piano,
    meter: Meter,
    focus: Focus,
    /// The page of sections.
    page: usize,
    is_browsing: bool,
    /// The other one of two versions of the sound.
    other: Option<State>,
    is_b: bool,
    /// The theme that egui's own widgets have.
    applied: Option<Theme>,
    message: String,
}

impl Window {
    /// A window that keeps the user's sounds in a library; none if the system has no place for one.
    pub(super) fn new(params: Arc<SprungParams>, library: Option<Library>) -> Self {
        let shown = Shown::new(&params);
        Self {
            params,
            host: None,
            hands: Hands::default(),
            history: History::default(),
            shown,
            browser: Browser::new(library),
            modes: ModesView::default(),
            motion: Motion::default(),
            piano: Piano::default(),
            meter: Meter::default(),
            focus: Focus::default(),
            page: 0,
            is_browsing: false,
            other: None,
            is_b: false,
            applied: None,
            message: String::new(),
        }
    }

    /// Prepares for being shown in a host.
    pub(super) fn open(&mut self, host: GuiContext) {
        self.host = Some(host);
        self.applied = None;
    }

    /// Shows the window and does what the user asks for.
    pub(super) fn contents(&mut self, ui: &mut Ui, host: &GuiContext) {
        let params = self.params.clone();
        let view = params.view();
        if self.applied != Some(view.theme) {
            self.applied = Some(view.theme);
            view.theme.apply(ui.ctx());
        }
        let palette = view.theme.palette();
        self.shown.refresh(&params);
        let window = ui.ctx().content_rect();
        ui.painter().rect_filled(window, 0.0, palette.ground);
        let layout = Layout::of(window);
        let telemetry = &params.link().telemetry;
        let (snapshot, is_silent) = (telemetry.snapshot(), telemetry.is_silent());
        let energies: Vec<f32> = snapshot.masses.iter().map(|mass| if is_silent { 0.0 } else { mass.energy }).collect();
        let levels = self.meter.levels(telemetry.take_peaks(), ui.input(|input| input.stable_dt));
        if !is_silent || self.meter.is_moving() {
            ui.ctx().request_repaint_after(FRAME);
        }
        let mut hint = None;
        let name = params.name();
        let mut controls = Controls {
            params: &params,
            host,
            palette,
            hands: &mut self.hands,
            history: &mut self.history,
            hint: &mut hint,
        };
        let header = Header {
            name: &name,
            words: &self.shown.words(),
            is_changed: controls.history.undo_name().is_some(),
            is_browsing: self.is_browsing,
            is_b: self.is_b,
            view,
            levels,
        };
        let wish = header::show(ui, layout.header, &header, &mut controls);
        if self.is_browsing {
            self.modes.cancel(&mut controls);
            if let Some(message) = self.browser.show(ui, layout.page(), &mut controls) {
                self.message = message;
            }
            if ui.input(|input| input.key_pressed(Key::Escape)) {
                self.is_browsing = false;
            }
        } else {
            let (patch, guide) = (self.shown.patch(), self.shown.guide());
            let is_editable = self.shown.preset().is_some();
            self.modes.show(ui, layout.modes, &self.shown, &energies, &mut controls);
            self.motion.show(ui, layout.motion, &energies, self.modes.selected(), telemetry, &controls);
            show_tabs(ui, layout.tabs, &mut self.page, &controls);
            sections::show(ui, layout.sections, self.page, (patch, guide, is_editable), &mut controls);
        }
        self.browser.follow_time(ui.input(|input| input.time), &controls);
        let down = (0..16).fold(0, |down, channel| down | telemetry.keys(channel));
        self.piano.show(ui, layout.piano, down, self.shown.guide(), &mut controls);
        let complaint = controls.hands.typing.as_ref().and_then(|typing| typing.complaint.clone());
        let complaints = || summary(&params.complaints()).unwrap_or_default();
        let message = if self.message.is_empty() { complaints() } else { self.message.clone() };
        let message = complaint.unwrap_or(message);
        let engine = engine(if is_silent { 0 } else { snapshot.voices }, params.link().sample_rate());
        status::show(ui, layout.status, hint.as_ref(), &message, &engine, palette);
        if let Some(wish) = wish {
            self.grant(wish, ui, host);
        }
    }

    /// Loads the factory sound some places further in the list.
    fn step(&mut self, places: isize, host: &GuiContext) {
        let Some(preset) = neighbour(&self.params.name(), places) else { return };
        self.history.begin(&self.params);
        load(Playable::Preset(preset.clone()), &self.params, host);
        self.history.end(preset.name.as_str(), &self.params);
    }

    /// Undoes or redoes a step, which may bring the other one of the two versions.
    fn go_back(&mut self, go: impl FnOnce(&mut History, &SprungParams, &GuiContext) -> bool, host: &GuiContext) {
        let now = self.params.state();
        if go(&mut self.history, &self.params, host) {
            self.other = Some(now);
            self.is_b = !self.is_b;
        }
    }

    fn grant(&mut self, wish: Wish, ui: &Ui, host: &GuiContext) {
        match wish {
            Wish::Browse | Wish::Save => {
                self.is_browsing = !self.is_browsing || wish == Wish::Save;
                self.message.clear();
                self.browser.open(&self.params.name());
            }
            Wish::Undo => self.go_back(History::undo, host),
            Wish::Redo => self.go_back(History::redo, host),
            Wish::Zoom(zoom) => {
                self.params.set_view(|view| view.zoom = zoom);
                ui.ctx().set_zoom_factor(zoom as f32 / 100.0);
            }
            Wish::Theme(theme) => self.params.set_view(|view| view.theme = theme),
            Wish::Step(places) => self.step(places, host),
            Wish::Swap => {
                self.history.begin(&self.params);
                let now = self.params.state();
                if let Some(other) = self.other.replace(now) {
                    restore(other, &self.params, host);
                }
                self.is_b = !self.is_b;
                self.history.end_swap(if self.is_b { "version B" } else { "version A" }, &self.params);
            }
            Wish::Copy => self.other = Some(self.params.state()),
        }
    }
}

/// The factory sound some places after the one of this name, in the order of the list.
fn neighbour(name: &str, places: isize) -> Option<&'static Preset> {
    let all = Preset::factory();
    let place = all.iter().position(|preset| preset.name == name).unwrap_or(0);
    all.get((place as isize + places).rem_euclid(all.len() as isize) as usize)
}

/// What the engine does.
fn engine(voices: u32, sample_rate: u32) -> String {
    let plural = if voices == 1 { "" } else { "s" };
    match sample_rate {
        0 => "not playing".to_owned(),
        rate => format!("{voices} voice{plural}   {} kHz", f64::from(rate) / 1000.0),
    }
}

fn show_tabs(ui: &Ui, rect: Rect, page: &mut usize, controls: &Controls) {
    let mut left = rect.left();
    for (place, name) in sections::pages().enumerate() {
        let width = super::text::width(ui.painter(), name, super::theme::TEXT) + 2.0 * GAP;
        let place_of_tab = Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height() - 2.0));
        left = place_of_tab.right() + GAP / 2.0;
        if tab(ui, place_of_tab, name, place == *page, controls.palette).clicked() {
            *page = place;
        }
    }
}

impl NiceEguiApp for Window {
    fn build(&mut self, context: egui::Context, host: GuiContext, _: &mut Frame) -> Result<(), HandlerError> {
        self.open(host);
        context.set_zoom_factor(self.params.view().zoom as f32 / 100.0);
        Ok(())
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut Frame) {
        let Some(host) = self.host.clone() else { return };
        let least = LEAST_SIZE.map(|side| side as f32);
        ResizableWindow::new("sprung").min_size(least.into()).show(ui, |ui| self.contents(ui, &host));
        // Keys go to the host, except while the user is typing.
        let typing = ui.ctx().egui_wants_keyboard_input();
        frame.set_key_capture(if typing { KeyCapture::CaptureAll } else { KeyCapture::IgnoreAll });
        let is_pressed = ui.input(|input| input.pointer.any_down());
        self.focus.follow(frame, typing, is_pressed);
    }

    fn resized(&mut self, size: WindowSize) {
        let [least, most] = WINDOW_RANGE;
        let side = |side: f64| (side.round() as u32).clamp(least, most);
        let size = [side(size.logical.width), side(size.logical.height)];
        self.params.set_view(|view: &mut View| view.size = size);
    }
}

/// A window is dropped when it is closed: nothing else tells it so.
impl Drop for Window {
    fn drop(&mut self) {
        let link = self.params.link();
        self.piano.release(link);
        self.browser.release(link);
        self.modes.release(link);
        if let Some(host) = self.host.take() {
            let end = || self.hands.gestures.end(&self.params, &host);
            // The wrapper panics if the plugin itself is dropped; then nobody waits for the end of a gesture.
            let _ = catch_unwind(AssertUnwindSafe(end));
        }
    }
}
