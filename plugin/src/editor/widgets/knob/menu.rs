//! The menu of a parameter: type, reset, a controller, modulate, and the host's own menu.

use crate::editor::binding;
use crate::editor::controls::naming::{self, macro_number};
use crate::editor::controls::{Controls, gestures};
use crate::editor::routes;
use crate::editor::routes::learn;
use crate::editor::widgets::typing::type_value;
use egui::{Context, Pos2, Ui};
use sprung::params::{ParamInfo, Unit};
use sprung::preset::Playable;

/// The menu of a right click.
pub(crate) fn show(ui: &mut Ui, info: &'static ParamInfo, controls: &mut Controls) {
    ui.label(info.name);
    if let (Some(mark), _) = controls.mark(info) {
        ui.label(mark.text());
    }
    if info.unit != Unit::Choice && ui.button("Type a value").clicked() {
        type_value(info, controls);
        ui.close();
    }
    if controls.is_preset && macro_number(info).is_some() && ui.button(format!("Name {}", info.name)).clicked() {
        naming::begin(info, controls);
        ui.close();
    }
    if ui.button(format!("Reset to {}", controls.written(info, info.default))).clicked() {
        controls.set(info, info.default);
        ui.close();
    }
    binding::menu(ui, info, controls);
    routes::menu(ui, info, controls);
    let has_routes = matches!(controls.params.state().playable, Playable::Preset(_));
    if info.is_modulatable() && has_routes && ui.button("Learn a route").clicked() {
        learn::begin(info, controls);
        ui.close();
    }
    host_menu(ui, info, controls);
}

/// The entry that opens the host's own menu of the parameter, if it has one.
fn host_menu(ui: &mut Ui, info: &'static ParamInfo, controls: &Controls) {
    let place = ui.next_widget_position();
    if controls.host.has_host_menu() && ui.button("Host menu").clicked() {
        gestures::show_host_menu(controls.params, controls.host, info, in_window(ui.ctx(), place));
        ui.close();
    }
}

/// A place in the window in the units of the host's window system: pixels, on macOS points.
fn in_window(context: &Context, place: Pos2) -> [i32; 2] {
    let native = if cfg!(target_os = "macos") { context.native_pixels_per_point().unwrap_or(1.0) } else { 1.0 };
    let scale = context.pixels_per_point() / native;
    [place.x, place.y].map(|number| (number * scale).round() as i32)
}
