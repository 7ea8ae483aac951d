//! Sources that are dragged to knobs, of any face, which they then modulate. egui keeps what is dragged.

use super::{AMOUNT, add, source_name};
use crate::editor::controls::{Controls, Said};
use crate::editor::theme::RADIUS;
use crate::editor::widgets::carried;
use egui::{DragAndDrop, Rect, Stroke, StrokeKind, Ui};
use sprung::params::ParamInfo;
use sprung::patch::routes::Source;
use sprung::preset::Guide;

/// How long a source is held over a tab until that is opened, in seconds.
const DWELL: f64 = 0.3;

/// Whether a source is held over this place long enough to see what is behind it.
pub(in crate::editor) fn dwells(ui: &Ui, rect: Rect, controls: &mut Controls) -> bool {
    if !is_over(ui, rect) {
        return false;
    }
    let now = ui.input(|input| input.time);
    let here = controls.interaction.dwell.filter(|(place, _)| *place == rect);
    let (_, since) = *controls.interaction.dwell.insert(here.unwrap_or((rect, now)));
    now - since >= DWELL
}

/// Takes a source that is let go over the place of a parameter.
pub(in crate::editor) fn aim(ui: &Ui, rect: Rect, info: &'static ParamInfo, controls: &mut Controls) {
    if info.is_modulatable() && is_over(ui, rect) {
        controls.interaction.aim = Some(info);
        let edge = Stroke::new(1.5, controls.palette.modulation);
        ui.painter().rect_stroke(rect, RADIUS, edge, StrokeKind::Inside);
    }
}

/// Whether a source is held over a place.
fn is_over(ui: &Ui, rect: Rect) -> bool {
    DragAndDrop::has_payload_of_type::<Source>(ui.ctx())
        && ui.input(|input| input.pointer.latest_pos()).is_some_and(|at| rect.intersect(ui.clip_rect()).contains(at))
}

/// Shows the source at the pointer, and makes a route when it is let go over a knob. To be called after all knobs. Returns a message.
pub(in crate::editor) fn follow(ui: &Ui, guide: &Guide, controls: &mut Controls) -> Option<Said> {
    let aim = controls.interaction.aim.take();
    let Some(source) = DragAndDrop::payload::<Source>(ui.ctx()) else {
        controls.interaction.dwell = None;
        return None;
    };
    if ui.input(|input| input.pointer.any_released()) {
        return aim.map(|info| add(*source, info, AMOUNT, controls));
    }
    let pointer = ui.input(|input| input.pointer.latest_pos());
    controls.interaction.dwell =
        controls.interaction.dwell.filter(|(place, _)| pointer.is_some_and(|at| place.contains(at)));
    carried::paint(ui, &source_name(*source, guide), controls.palette.modulation, controls.palette);
    // A tab is opened by holding it there, without a movement.
    ui.ctx().request_repaint();
    None
}
