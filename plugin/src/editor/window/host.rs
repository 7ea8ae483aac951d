//! The window in its host: how it is made, resized and dropped.

use super::Window;
use crate::editor::binding;
#[cfg(target_os = "linux")]
use crate::editor::host::accessibility;
use crate::editor::host::extent;
use crate::editor::theme::{LEAST_SIZE, Theme};
use crate::lock::lock;
use crate::state::{View, WINDOW_RANGE};
use egui::{Rgba, Ui, ViewportCommand, vec2};
use nice_plug_core::context::PluginApi;
use nice_plug_core::context::gui::GuiContext;
use nice_plug_egui::baseview::{HandlerError, WindowSize};
use nice_plug_egui::resizable_window::ResizableWindow;
use nice_plug_egui::{Frame, KeyCapture, NiceEguiApp};
use std::mem::take;
use std::panic::{AssertUnwindSafe, catch_unwind};

impl NiceEguiApp for Window {
    fn build(&mut self, context: egui::Context, host: GuiContext, frame: &mut Frame) -> Result<(), HandlerError> {
        #[cfg(target_os = "linux")]
        accessibility::connect(&context, self.params.link().repaint.clone());
        self.open(host);
        self.params.extent().set(frame.baseview_window().size());
        self.screen = self.params.extent().screen();
        self.context = Some(context);
        Ok(())
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut Frame) {
        let Some(host) = self.host.clone() else { return };
        let least = LEAST_SIZE.map(|side| side as f32);
        frame.set_clear_color(ground(self.params.view().theme));
        ResizableWindow::new("sprung").min_size(least.into()).show(ui, |ui| self.contents(ui, &host));
        // Keys go to the host, except while the user is typing.
        let typing = ui.ctx().egui_wants_keyboard_input();
        frame.set_key_capture(if typing { KeyCapture::CaptureAll } else { KeyCapture::IgnoreAll });
        if host.plugin_api() != PluginApi::Standalone {
            let is_pressed = ui.input(|input| input.pointer.any_down());
            self.focus.follow(frame, typing, is_pressed);
        }
        #[cfg(target_os = "linux")]
        accessibility::place(ui.ctx(), frame.baseview_window());
        if self.params.link().is_closing() {
            frame.baseview_window().request_close();
        }
    }

    fn resized(&mut self, size: WindowSize) {
        let Some(context) = &self.context else { return };
        // Before the first pass, egui has not applied the zoom yet, and this size comes without it.
        let scale_factor = size.scale_factor / f64::from(context.zoom_factor());
        self.params.extent().set(WindowSize { scale_factor, ..size });
        let [least, most] = WINDOW_RANGE;
        let side = |side: u32| {
            let logical = f64::from(side) / (scale_factor * f64::from(self.zoom));
            (logical.round() as u32).clamp(least, most)
        };
        let size = [side(size.physical.width), side(size.physical.height)];
        // A window that is smaller only because of its zoom gets its size back with another zoom.
        let is_cut =
            |view: &View| extent::fitted(*view, self.screen).size.iter().zip(size).all(|(a, b)| a.abs_diff(b) < 2);
        self.params.set_view(|view: &mut View| view.size = if is_cut(view) { view.size } else { size });
    }

    fn zoom_factor_changed(&mut self, zoom: f32) {
        self.zoom = zoom;
        let fitted = extent::fitted(self.params.view(), self.screen);
        if let Some(context) = &self.context {
            let [width, height] = fitted.size.map(|side| side as f32);
            context.send_viewport_cmd(ViewportCommand::InnerSize(vec2(width, height)));
            context.request_repaint();
        }
    }
}

/// The colour that the window is cleared with: the renderer takes its numbers as they are, without conversion.
fn ground(theme: Theme) -> Rgba {
    let [red, green, blue, _] = theme.palette().ground.to_array().map(|part| f32::from(part) / 255.0);
    Rgba::from_rgb(red, green, blue)
}

/// Dropping the window is the only sign that it was closed: held keys and the gesture are ended here, and the next window goes on with
/// what can be undone.
impl Drop for Window {
    fn drop(&mut self) {
        let link = self.params.link();
        self.params.extent().close();
        self.piano.release(link);
        self.wheels.release(link);
        self.computer_keyboard.release(link);
        self.browser.release(link);
        self.play.release(link);
        self.pages.release(link);
        self.kit.release(link);
        binding::stop(&self.params, &mut self.interaction.binding);
        if let Some(host) = self.host.take() {
            let end = || self.interaction.gestures.end(&self.params, &host);
            // The wrapper panics if the plugin itself is being dropped; then the host no longer waits for the gesture's
            // end.
            let _ = catch_unwind(AssertUnwindSafe(end));
        }
        self.history.end("the last change", &self.params);
        self.versions.rest();
        let steps = (take(&mut self.history), take(&mut self.versions), self.loads);
        *lock(&self.past.0) = (self.face, Some(steps));
    }
}
