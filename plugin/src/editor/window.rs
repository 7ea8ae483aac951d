//! The contents of the window.

use super::presets::Presets;
use super::rows::Rows;
use crate::params::SprungParams;
use crate::state::WINDOW_RANGE;
use egui::{RichText, ScrollArea, Ui, vec2};
use nice_plug_core::context::gui::GuiContext;
use nice_plug_egui::baseview::{HandlerError, WindowSize};
use nice_plug_egui::resizable_window::ResizableWindow;
use nice_plug_egui::{Frame, KeyCapture, NiceEguiApp};
use sprung::params::PARAMS;
use std::sync::Arc;

/// Smallest width and height at which the window can be used.
pub(super) const LEAST_SIZE: [u32; 2] = [480, 320];

/// An open window.
pub(super) struct Window {
    params: Arc<SprungParams>,
    host: Option<GuiContext>,
    presets: Presets,
    rows: Rows,
}

impl Window {
    pub(super) fn new(params: Arc<SprungParams>) -> Self {
        Self { params, host: None, presets: Presets::default(), rows: Rows::default() }
    }
}

impl NiceEguiApp for Window {
    fn build(&mut self, _: egui::Context, host: GuiContext, _: &mut Frame) -> Result<(), HandlerError> {
        self.host = Some(host);
        Ok(())
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut Frame) {
        let Some(host) = self.host.clone() else { return };
        // Keys go to the host, except while the user is typing.
        let typing = ui.ctx().egui_wants_keyboard_input();
        frame.set_key_capture(if typing { KeyCapture::CaptureAll } else { KeyCapture::IgnoreAll });
        let least = LEAST_SIZE.map(|side| side as f32);
        ResizableWindow::new("sprung").min_size(least.into()).show(ui, |ui| {
            egui::Frame::new().inner_margin(12.0).show(ui, |ui| {
                self.presets.show(ui, &self.params, &host);
                ui.separator();
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    for section in PARAMS.chunk_by(|a, b| a.section == b.section) {
                        ui.add_space(6.0);
                        ui.label(RichText::new(section[0].section).strong());
                        egui::Grid::new(section[0].section)
                            .num_columns(2)
                            .min_col_width(140.0)
                            .spacing(vec2(16.0, 4.0))
                            .show(ui, |ui| {
                                for info in section {
                                    self.rows.show(ui, &self.params, &host, info);
                                    ui.end_row();
                                }
                            });
                    }
                });
            });
        });
    }

    fn resized(&mut self, size: WindowSize) {
        let [least, most] = WINDOW_RANGE;
        let side = |side: f64| (side.round() as u32).clamp(least, most);
        self.params.set_window([side(size.logical.width), side(size.logical.height)]);
    }

    fn editor_closed(&mut self) {
        self.host = None;
    }
}
