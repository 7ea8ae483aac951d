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
use sprung::preset::{Playable, Preset};

impl Window {
    /// Loads the factory sound at this distance in the list.
    fn step(&mut self, places: isize, host: &GuiContext) {
        let (all, name) = (Preset::factory(), self.params.name());
        // From a sound that is not in the list, the next is its first and the one before its last.
        let place = all.iter().position(|preset| preset.name == name).map(|place| place as isize);
        let place = place.unwrap_or(if places > 0 { -1 } else { 0 }) + places;
        let preset = all[place.rem_euclid(all.len() as isize) as usize].clone();
        self.history.load(Playable::Preset(preset), &self.params, host);
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
            Request::Browse | Request::Save => {
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
            Request::Step(places) => self.step(places, host),
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
