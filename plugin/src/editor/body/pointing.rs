//! What pointer and arrow keys do with the places of a body.

use super::handle::{Handle, arrows};
use crate::editor::theme::{Palette, RADIUS};
use crate::editor::widgets::outline;
use egui::{EventFilter, Id, Key, Pos2, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo};
use sprung::sound::bodies::Point;
use sprung_picture::{BodyShape, REACH};

/// How far from the middle of the ear it is taken hold of, in pixels.
pub(super) const EAR: f32 = 13.0;
/// The keys that move a place that has the focus.
const ARROWS: [Key; 4] = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];

/// What the user does with a body in a pass.
pub(super) struct Pointing {
    /// The handle at the pointer, the place there, and the pointer; none beside the body.
    pub(super) at: Option<(Handle, Point, Pos2)>,
    /// Where the ear is in the picture.
    pub(super) ear: Option<Pos2>,
    /// Whether the body or one of its handles is held by the pointer, has just been pressed, or was clicked, also by the keyboard.
    pub(super) is_down: bool,
    pub(super) is_pressed: bool,
    pub(super) is_clicked: bool,
    /// The handle that has the focus, the steps of the arrow keys that were pressed, and whether one of these keys is down.
    pub(super) focused: Option<Handle>,
    pub(super) steps: Vec2,
    pub(super) is_key_down: bool,
}

impl Pointing {
    /// Reads what the user does with a body in a picture whose strike and ear are at these places. What is `held` stays in hand, as far
    /// from the pointer as it was taken hold of.
    pub(super) fn read(
        ui: &Ui,
        rect: Rect,
        shape: &BodyShape,
        places: [Option<Point>; 2],
        held: Option<(Handle, Vec2)>,
        palette: &Palette,
    ) -> Self {
        let shown = places.map(|place| place.map(|place| shape.figure.form.on(shape.place(rect), place, 0.0)));
        let around = |at: Pos2| Rect::from_center_size(at, Vec2::splat(2.0 * EAR));
        let areas = [Some((rect, "body")), shown[1].map(|at| (around(at), "ear"))];
        let responses: Vec<(Handle, Response)> = Handle::ALL
            .into_iter()
            .zip(areas)
            .filter_map(|(handle, area)| {
                let (area, id) = area?;
                Some((handle, ui.interact(area, Id::unique(id), Sense::click_and_drag())))
            })
            .collect();
        for ((handle, response), place) in responses.iter().zip(places) {
            response.widget_info(|| {
                let mut about = WidgetInfo::labeled(Role::Canvas, true, handle.name());
                about.current_text_value = place.map(|place| handle.describe(place, shape));
                about
            });
        }
        let each = || responses.iter().map(|(_, response)| response);
        let pressed = each().find(|response| response.is_pointer_button_down_on());
        let clicked = each().find(|response| response.clicked());
        let touched = pressed.or(clicked).and_then(Response::interact_pointer_pos);
        let is_down = pressed.is_some_and(|response| response.interact_pointer_pos().is_some());
        let far = |handle: usize, pos: Pos2| shown[handle].map_or(f32::INFINITY, |at| (at - pos).length());
        let at = touched.or_else(|| each().find_map(|response| response.hover_pos())).and_then(|pos| {
            let is_ear = far(1, pos) <= EAR && far(1, pos) < far(0, pos);
            let under = if is_ear { Handle::Ear } else { Handle::Strike };
            let (handle, off) = held.unwrap_or((under, Vec2::ZERO));
            let (point, distance) = shape.nearest(rect, pos - off);
            let is_at = distance <= REACH || is_ear || held.is_some();
            is_at.then(|| (handle, handle.confined(point, shape), pos))
        });
        // A press and its release may come between two passes.
        let is_pressed =
            ui.input(|input| clicked.is_some() && input.pointer.any_click() || is_down && input.pointer.any_pressed());
        let focused = responses.iter().find(|(_, response)| response.has_focus());
        if let Some((_, response)) = focused {
            let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        }
        if let Some((_, body)) = responses.first() {
            outline(ui, body, rect, RADIUS, palette);
        }
        Self {
            at,
            ear: shown[1],
            is_down,
            is_pressed,
            is_clicked: clicked.is_some(),
            focused: focused.map(|(handle, _)| *handle),
            steps: focused.map_or(Vec2::ZERO, |_| arrows(ui)),
            is_key_down: focused.is_some() && ui.input(|input| ARROWS.iter().any(|key| input.key_down(*key))),
        }
    }
}
