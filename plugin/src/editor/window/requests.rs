//! The user's requests, carried out.

use super::header::{Face, Request};
use super::variation::{Variation, VariationRequest};
use super::{Over, Window, topic};
use crate::editor::browser::Aim;
use crate::editor::controls::files::remake;
use crate::editor::controls::history::History;
use crate::editor::host::extent;
use crate::editor::kit::edit::put_back;
use crate::params::SprungParams;
use crate::state::View;
use egui::Ui;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::Playable;

impl Window {
    /// Brings back what there was before sounds were tried.
    fn give_up(&mut self, host: &GuiContext) {
        if self.history.trial() == 0 {
            return;
        }
        while self.history.trial() > 0 && self.history.undo_name().is_some() {
            self.go_back(History::undo, host, None);
        }
        while self.history.trial() < 0 && self.history.redo_name().is_some() {
            self.go_back(History::redo, host, None);
        }
        self.news = Some(Ok(format!("‘{}’ is back as it was", self.params.name())));
    }

    /// Replaces the sound by a random variation.
    fn vary(&mut self, variation: Variation, host: &GuiContext) {
        let Playable::Preset(preset) = self.params.state().playable else {
            self.news = Some(Err("a kit’s sounds cannot be varied together: load one of them".to_owned()));
            return;
        };
        self.seed = self.seed.wrapping_add(1);
        match variation.of(&preset, self.seed, &self.locked) {
            Some(varied) => {
                self.news = Some(Ok(String::new()));
                self.history.begin(&self.params);
                remake(Playable::Preset(varied), &self.params, host);
                self.history.end(variation.name(), &self.params);
            }
            None => self.news = Some(Err("every variation that was tried is silent: unlock more sections".to_owned())),
        }
    }

    /// Undoes or redoes a step, which may exchange the two versions.
    fn go_back(
        &mut self,
        go: impl FnOnce(&mut History, &SprungParams, &GuiContext) -> bool,
        host: &GuiContext,
        told: Option<String>,
    ) {
        // What was said of the step is no longer so.
        self.news = told.map(Ok);
        let now = (self.params.state(), self.history.is_changed());
        if go(&mut self.history, &self.params, host) {
            self.versions.have_swapped(now);
        }
    }

    pub(super) fn carry_out(&mut self, request: Request, ui: &Ui, host: &GuiContext) {
        match request {
            Request::Show(face) => self.turn_to(face),
            Request::PutBack => {
                if let Some(key) = put_back(&mut self.history, &self.params, host) {
                    self.turn_to(Face::Kit);
                    self.kit.choose(key);
                }
            }
            Request::GiveUp => {
                self.over = None;
                self.give_up(host);
                self.history.take_chosen();
            }
            Request::Browse | Request::Save => {
                if self.over != Some(Over::Browser) {
                    self.history.begin_trial();
                }
                let closes = self.over == Some(Over::Browser) && request == Request::Browse;
                self.over = (!closes).then_some(Over::Browser);
                self.news = Some(Ok(String::new()));
                self.browser.open(&self.params.name(), if request == Request::Save { Aim::Save } else { Aim::Find });
            }
            Request::Undo => {
                let told = self.history.undo_name().map(|name| format!("taken back: {name}"));
                self.go_back(History::undo, host, told);
            }
            Request::Redo => {
                let told = self.history.redo_name().map(|name| format!("done again: {name}"));
                self.go_back(History::redo, host, told);
            }
            Request::Zoom(zoom) => {
                self.params.set_view(|view| view.zoom = extent::fitted(View { zoom, ..*view }, self.screen).zoom);
                ui.ctx().set_zoom_factor(extent::factor(self.params.view()));
            }
            Request::Manual if self.over == Some(Over::Manual) => self.over = None,
            Request::Manual => {
                self.manual.open(topic(self.over, self.face, &self.pages));
                self.over = Some(Over::Manual);
            }
            Request::Devices => self.over = Some(Over::Devices),
            Request::Theme(theme) => self.params.set_view(|view| view.theme = theme),
            Request::LessMotion(less) => self.params.set_view(|view| view.less_motion = less),
            Request::Star => {
                let message = self.browser.turn_favourite(&self.params.name());
                self.news = Some(message.map_or(Ok(String::new()), Err));
            }
            Request::Step(places) => {
                let is_open = self.over == Some(Over::Browser);
                self.browser.step(ui, places, (&mut self.history, &self.params, host), is_open);
            }
            Request::Swap => self.versions.swap(&mut self.history, &self.params, host),
            Request::Variation(VariationRequest::Lock(section)) => {
                if !self.locked.remove(section) {
                    self.locked.insert(section);
                }
            }
            Request::Variation(VariationRequest::Vary(variation)) => self.vary(variation, host),
            Request::Copy => self.versions.copy((self.params.state(), self.history.is_changed())),
        }
    }
}
