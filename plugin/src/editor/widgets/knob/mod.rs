//! A knob with its name and value: dragged, turned by the wheel or by keys, reset, or typed into.

pub(crate) mod face;
pub(super) mod menu;

use super::text::line;
use super::typing::{type_value, typed};
use crate::editor::controls::{Controls, naming};
use crate::editor::routes::Ring;
use crate::editor::routes::carry::{self, Halo};
use crate::editor::theme::SMALL;
use crate::editor::widgets::disc;
use crate::marks::Mark;
use egui::accesskit::{Action, ActionData};
use egui::{Align2, CursorIcon, Event, EventFilter, Id, Key, Rect, Response, Sense, Stroke, Ui};
use egui::{WidgetInfo, pos2, vec2};
use face::Face;
use sprung::params::{ParamInfo, Unit};

/// Mouse movement for the whole travel of a knob, in pixels.
pub(super) const TRAVEL: f32 = 220.0;
/// Share of the travel for one step of the wheel or of an arrow key.
const STEP: f64 = 0.01;
/// Seconds for which the pointer rests on a knob before the wheel turns it, where the wheel may be meant to scroll.
const REST: f32 = 0.25;
/// How much is left of a knob that cannot take the source that is being dragged.
pub(super) const CLOSED: f32 = 0.35;
/// Factor for all movements while Shift is held.
pub(super) const FINE: f64 = 0.1;

/// Height of its name, and of its value.
const LINE: f32 = 13.0;

/// Where the parts of a knob are in its cell.
struct Parts {
    face: Rect,
    name: Rect,
    value: Rect,
}

impl Parts {
    /// For a face of this width and height.
    fn of(cell: Rect, side: f32) -> Self {
        let line = |top: f32| Rect::from_min_size(pos2(cell.left(), cell.top() + top), vec2(cell.width(), LINE));
        let centre = pos2(cell.center().x, cell.top() + side / 2.0 + 1.0);
        Self { face: Rect::from_center_size(centre, vec2(side, side)), name: line(side), value: line(side + LINE) }
    }
}

/// Where the name is in a cell, for a face of this width.
pub(crate) fn name_rect(cell: Rect, side: f32) -> Rect {
    Parts::of(cell, side).name
}

/// Where the face is in the part of a cell that is turned.
#[cfg(test)]
pub(crate) fn face_in(turned: Rect) -> Rect {
    Parts::of(turned, turned.height() - LINE).face
}

/// The widget's id. A parameter has one widget in a window.
pub(super) fn id(info: &ParamInfo) -> Id {
    Id::unique(("knob", info.id))
}

/// What is drawn of a parameter after the user's actions on it.
struct Turned {
    text: String,
    mark: Option<Mark>,
    is_hovered: bool,
    is_focused: bool,
    halo: Halo,
}

/// Lets the user turn a parameter in one place and type its value in another; `travel` pixels turn it from end to end.
fn turn(ui: &Ui, turned: Rect, value: Rect, travel: f32, info: &'static ParamInfo, controls: &mut Controls) -> Turned {
    let mut response = ui.interact(turned, id(info), Sense::click_and_drag());
    let value_response = ui.interact(value, id(info).with("value"), Sense::click()).on_hover_cursor(CursorIcon::Text);
    value_response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, format!("Type {}", info.name)));
    drag(ui, &mut response, travel, info, controls);
    wheel(ui, &response, info, controls);
    keys(ui, &response, info, controls);
    let asks = response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if asks || value_response.clicked() {
        type_value(info, controls);
    }
    if response.double_clicked() {
        controls.set(info, info.default);
    }
    response.context_menu(|ui| menu::show(ui, info, controls));

    let text = controls.text(info);
    response.widget_info(|| {
        let mut about = WidgetInfo::slider(true, f64::from(controls.value(info)), info.name);
        about.current_text_value = Some(text.clone());
        about
    });
    let halo = carry::aim(ui, turned.union(value), info, controls);
    let is_hovered = response.hovered() || response.dragged() || value_response.hovered();
    let (mark, said) = controls.mark(info);
    if is_hovered {
        let newest = controls.modulated(info).next();
        let now = newest.map_or(String::new(), |value| format!(" › {}", info.format(value)));
        controls.explain(format!("{} {text}{now}{said}", info.name), info);
    }
    Turned { text, mark, is_hovered, is_focused: response.has_focus(), halo }
}

/// Shows a parameter's knob in a cell, its face as wide as `side`, under the title `name`; `ring` shows its modulation.
pub(crate) fn show(
    ui: &mut Ui,
    (cell, side): (Rect, f32),
    info: &'static ParamInfo,
    name: &str,
    ring: &Ring,
    controls: &mut Controls,
) {
    let parts = Parts::of(cell, side);
    let turned = turn(ui, cell.with_max_y(parts.value.top()), parts.value, TRAVEL, info, controls);
    let movers = if turned.is_hovered { ring.movers(info, controls) } else { None };
    if let (Some(movers), Some(hint)) = (movers, controls.hint.as_mut()) {
        hint.help = format!("Moved by {movers}. {}", hint.help);
    }
    let palette = controls.palette;
    let opacity = ui.opacity();
    if turned.halo == Halo::Closed {
        ui.multiply_opacity(CLOSED);
    }
    let neutral = info.normalise(info.default) as f32;
    let is_relative = controls.own(info).is_some();
    let shown = |position| if is_relative { face::around(neutral, position) } else { position };
    let (position, offset) = (controls.position(info), controls.params.knobs()[info.param as usize].offset());
    let face = Face {
        position: shown(position),
        origin: shown(neutral),
        offset: shown(position + offset) - shown(position),
        ring,
        is_hovered: turned.is_hovered,
        is_focused: turned.is_focused,
    };
    face::paint_halo(ui.painter(), parts.face, turned.halo, palette);
    face::paint(ui.painter(), parts.face, palette, &face);
    // In the gap of the arc.
    face::paint_mark(ui.painter(), parts.face.center_bottom() - vec2(0.0, 3.0), turned.mark.as_ref(), palette);
    if !naming::field(ui, parts.name, info, controls) {
        line(ui.painter(), parts.name, Align2::CENTER_CENTER, name, SMALL, palette.text);
    }
    show_value(ui, parts.value, Align2::CENTER_CENTER, info, &turned, controls);
    ui.set_opacity(opacity);
}

/// Shows a parameter as a bar from the position of zero, or as far to both sides, with its value beside it in these words; `ring` shows
/// its modulation, and `now` are places on the bar that the sounding notes have reached, the newest note's first.
pub(crate) fn show_bar(
    ui: &mut Ui,
    [bar, value]: [Rect; 2],
    info: &'static ParamInfo,
    (ring, now): (&Ring, &[f32]),
    (is_both, text): (bool, String),
    controls: &mut Controls,
) {
    let mut turned = turn(ui, bar, value, bar.width(), info, controls);
    turned.text = text;
    let palette = controls.palette;
    let opacity = ui.opacity();
    if turned.halo == Halo::Closed {
        ui.multiply_opacity(CLOSED);
    }
    let track = Rect::from_center_size(bar.center(), vec2(bar.width(), 4.0));
    let x = |position: f32| bar.left() + position * bar.width();
    let [zero, end] = [info.normalise(0.0) as f32, controls.position(info)].map(x);
    let begin = if is_both { 2.0 * zero - end } else { zero };
    let colour = if turned.is_hovered { palette.muted.gamma_multiply(0.55) } else { palette.line };
    ui.painter().rect_filled(track, 2.0, colour);
    ui.painter().rect_filled(track.with_min_x(begin.min(end)).with_max_x(begin.max(end)), 2.0, palette.modulation);
    ui.painter().vline(zero, bar.y_range().shrink(4.0), Stroke::new(1.0, palette.muted));
    for range in &ring.ranges {
        let [from, to] = range.map(x);
        let above = bar.center().y - 5.0;
        ui.painter().hline(from.min(to)..=from.max(to), above, Stroke::new(1.5, palette.modulation));
    }
    face::paint_bar_halo(ui.painter(), bar, turned.halo, palette);
    let edge = if turned.is_focused || turned.is_hovered { palette.text } else { palette.modulation };
    let radius = (0.6 * bar.height()).min(5.0);
    ui.painter().circle(pos2(end, bar.center().y), radius, palette.panel, Stroke::new(1.8, edge));
    let offset = controls.params.knobs()[info.param as usize].offset();
    let host = (offset.abs() > 1e-4).then_some((controls.position(info) + offset).clamp(0.0, 1.0));
    for mark in ring.marks.iter().copied().chain(host) {
        ui.painter().circle_filled(pos2(x(mark), bar.center().y), 3.0, palette.modulation);
    }
    for (order, place) in now.iter().enumerate().rev() {
        let radius = if order == 0 { 2.6 } else { 1.8 };
        disc(ui.painter(), pos2(x(*place), bar.center().y), radius, palette.text, Stroke::new(0.8, palette.panel));
    }
    face::paint_mark(ui.painter(), bar.center_bottom() - vec2(0.0, 2.0), turned.mark.as_ref(), palette);
    show_value(ui, value, Align2::RIGHT_CENTER, info, &turned, controls);
    ui.set_opacity(opacity);
}

/// Shows the value, or the field in which it is typed.
fn show_value(
    ui: &mut Ui,
    rect: Rect,
    align: Align2,
    info: &'static ParamInfo,
    turned: &Turned,
    controls: &mut Controls,
) {
    let colour = if turned.is_hovered { controls.palette.text } else { controls.palette.muted };
    if !typed(ui, rect, id(info).with("field"), info, controls) {
        line(ui.painter(), rect, align, &turned.text, SMALL, colour);
    }
}

/// Takes what the wheel has turned, in steps, and whether Shift is held: the page must not move as well.
pub(super) fn take_wheel(ui: &Ui) -> (f64, bool) {
    ui.input_mut(|input| {
        input.smooth_scroll_delta = egui::Vec2::ZERO;
        let mut steps = 0.0;
        input.events.retain(|event| {
            let Event::MouseWheel { unit, delta, .. } = event else { return true };
            let points = if *unit == egui::MouseWheelUnit::Point { 20.0 } else { 1.0 };
            steps += f64::from(delta.y + delta.x) / points;
            false
        });
        (steps, input.modifiers.shift)
    })
}

/// Lets the user turn a parameter by dragging: `travel` pixels turn it from end to end.
pub(crate) fn drag(ui: &Ui, response: &mut Response, travel: f32, info: &'static ParamInfo, controls: &mut Controls) {
    let index = info.param as usize;
    if response.drag_started() {
        controls.interaction.dragged = f64::from(controls.position(info));
    }
    if response.dragged() {
        let moved = response.drag_delta();
        let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
        let dragged = controls.interaction.dragged + f64::from((moved.x - moved.y) / travel) * fine;
        controls.interaction.dragged = dragged.clamp(0.0, 1.0);
        let position = rounded(info, controls.interaction.dragged);
        if moved != egui::Vec2::ZERO && position as f32 != controls.position(info) {
            controls.turn(info, position);
        }
        ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
    }
    if response.drag_stopped() && controls.interaction.gestures.moving() == Some(index) {
        controls.release();
    }
}

/// The nearest position that the parameter can take.
fn rounded(info: &ParamInfo, position: f64) -> f64 {
    if info.unit == Unit::Count { info.normalise(info.denormalise(position)) } else { position }
}

/// Moves a knob by a number of steps, as one gesture.
fn step(info: &'static ParamInfo, steps: f64, controls: &mut Controls) {
    let position = f64::from(controls.position(info));
    let wanted = match info.unit {
        Unit::Count | Unit::Choice => {
            let whole = if steps > 0.0 { steps.ceil() } else { steps.floor() };
            info.normalise(info.clamp(controls.value(info) + whole as f32))
        }
        _ => (position + STEP * steps).clamp(0.0, 1.0),
    };
    if wanted as f32 != position as f32 {
        controls.nudge(info, wanted);
    }
}

/// Turns by the wheel while the pointer is over the knob. Where the page can be scrolled, only once the pointer has rested there: a
/// wheel that has begun to scroll goes on doing so, whatever knobs come under the pointer.
pub(super) fn wheel(ui: &Ui, response: &Response, info: &'static ParamInfo, controls: &mut Controls) {
    let can_scroll = !ui.clip_rect().expand(1.0).contains_rect(ui.min_rect());
    let has_rested = || ui.input(|input| input.pointer.time_since_last_movement()) >= REST;
    if !response.hovered() || can_scroll && (controls.interaction.is_scrolling || !has_rested()) {
        return;
    }
    let (steps, fine) = take_wheel(ui);
    if steps == 0.0 {
        return;
    }
    if !matches!(info.unit, Unit::Count | Unit::Choice) {
        return step(info, if fine { steps * FINE } else { steps }, controls);
    }
    // A touchpad sends parts of a step.
    let index = info.param as usize;
    let before = controls.interaction.scrolled.filter(|(knob, _)| *knob == index).map_or(0.0, |(_, part)| part);
    let sum = before + steps;
    controls.interaction.scrolled = Some((index, sum.fract()));
    if sum.trunc() != 0.0 {
        step(info, sum.trunc(), controls);
    }
}

/// Handles the arrow keys, the keys that reset, and the actions of a screen reader, which is told the value.
pub(crate) fn keys(ui: &Ui, response: &Response, info: &'static ParamInfo, controls: &mut Controls) {
    ui.ctx().accesskit_node_builder(response.id, |node| {
        let value = controls.value(info);
        node.set_description(controls.text(info));
        node.set_numeric_value(value.into());
        node.set_min_numeric_value(info.min.into());
        node.set_max_numeric_value(info.max.into());
        node.add_action(Action::SetValue);
        if value < info.max {
            node.add_action(Action::Increment);
        }
        if value > info.min {
            node.add_action(Action::Decrement);
        }
    });
    let mut steps = ui.input(|input| {
        let asked = |action| input.num_accesskit_action_requests(response.id, action) as f64;
        asked(Action::Increment) - asked(Action::Decrement)
    });
    let mut wanted = None;
    ui.input(|input| {
        for request in input.accesskit_action_requests(response.id, Action::SetValue) {
            if let Some(ActionData::NumericValue(value)) = request.data {
                wanted = Some(value as f32);
            }
        }
    });
    if response.has_focus() {
        let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        let (by, resets) = ui.input(|input| {
            let pressed = |key| input.num_presses(key) as f64;
            let fine = if input.modifiers.shift { FINE } else { 1.0 };
            let by = pressed(Key::ArrowUp) - pressed(Key::ArrowDown)
                + 10.0 * (pressed(Key::PageUp) - pressed(Key::PageDown));
            (by * fine, input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace))
        });
        steps += by;
        if resets {
            wanted = Some(info.default);
        }
    }
    if steps != 0.0 {
        step(info, steps, controls);
    }
    if let Some(value) = wanted {
        controls.set(info, info.clamp(value));
    }
}
