//! The floor that the body stands on, which is its space: its far edge is dragged for the size, the floor itself for the mix.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text::{line, width};
use crate::editor::widgets::{knob, outline};
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, CursorIcon, Id, Painter, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use sprung::params::{Param, ParamInfo};
use sprung_picture::Floor;
use sprung_picture::play::FLOORS;

/// Movement of the pointer for the whole travel of the knob, in pixels, and how far from the far edge that is taken hold of.
const TRAVEL: f32 = 200.0;
const GRIP: f32 = 7.0;
/// The least side of a part of the floor that can be taken hold of, and how many there are at most.
const LEAST: f32 = 6.0;
const MOST: usize = 3;

/// What is done with the floor, and what a hint says of it.
const SIZE: (&str, &str) =
    ("The floor’s far edge", "Drag the floor’s far edge away for a larger space, nearer for a smaller one.");
const MIX: (&str, &str) = ("The floor", "Drag the floor up for more of the space, down for less.");

/// What the user does with the floor.
#[derive(Default)]
pub(super) struct Touched {
    pub(super) is_clicked: bool,
    pub(super) is_dragged: bool,
}

/// The floor of a stage, whose far edge stays within `middle`.
pub(in crate::editor) fn floor(stage: Rect, middle: Rect, controls: &Controls) -> Floor {
    Floor::of(stage, middle, has_space(controls).then(|| controls.position(Param::SpaceSize.info())))
}

/// Lets the user drag the floor beside a body that stands in `body`.
pub(super) fn touch(floor: &Floor, ui: &Ui, body: Rect, controls: &mut Controls) -> Touched {
    let mut touched = Touched::default();
    if !has_space(controls) {
        return touched;
    }
    let (painter, palette, [left, right]) = (ui.painter(), controls.palette, floor.ends);
    let edge = Rect::from_x_y_ranges(left..=right, floor.far - GRIP..=floor.far + GRIP);
    let front = floor.middle.with_min_y(edge.bottom()).with_max_y(floor.stage.bottom());
    for (part, place) in parts(ui, edge, body, SIZE) {
        let is_hot = part_of(ui, (place, part), Param::SpaceSize.info(), SIZE, &mut touched, controls);
        if is_hot {
            painter.hline(place.x_range(), place.center().y, Stroke::new(2.0, palette.text));
        }
        let grip = Rect::from_center_size(place.center(), vec2(28.0, 3.0));
        if part == 0 && place.contains_rect(grip) {
            painter.rect_filled(grip, 1.5, if is_hot { palette.text } else { palette.muted });
        }
    }
    for (part, place) in parts(ui, front, body, MIX) {
        part_of(ui, (place, part), Param::SpaceMix.info(), MIX, &mut touched, controls);
    }
    touched
}

/// Lets the user drag a part of the floor, of which the first can have the focus and has a name. Returns whether it is at hand.
fn part_of(
    ui: &Ui,
    (place, part): (Rect, usize),
    info: &'static ParamInfo,
    (name, help): (&'static str, &str),
    touched: &mut Touched,
    controls: &mut Controls,
) -> bool {
    let sense = if part == 0 { Sense::click_and_drag() } else { Sense::CLICK | Sense::DRAG };
    let mut response = ui.interact(place, id(name, part), sense);
    knob::drag(ui, &mut response, TRAVEL, info, controls);
    if part == 0 {
        knob::keys(ui, &response, info, controls);
        response.widget_info(|| {
            let mut about = WidgetInfo::slider(true, f64::from(controls.value(info)), name);
            about.current_text_value = Some(controls.text(info));
            about
        });
    }
    let is_hot = response.hovered() || response.dragged() || response.has_focus();
    if is_hot {
        *controls.hint = Hint::new(format!("{} {}", info.name, controls.text(info)), help);
    }
    if response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
    }
    outline(ui, &response, place, 3, controls.palette);
    touched.is_clicked |= response.clicked();
    touched.is_dragged |= response.dragged();
    is_hot
}

/// Paints the floor. Its waves glow as far as the space is mixed in, and by the level that sounds, from 0 to 1.
pub(in crate::editor) fn paint(floor: &Floor, painter: &Painter, level: f32, controls: &Controls) {
    let palette = controls.palette;
    let near = palette.raised.lerp_to_gamma(palette.panel, 0.2);
    let colours = [palette.panel, palette.panel, near, near];
    let vertices = floor.corners().into_iter().zip(colours).map(|(pos, color)| Vertex { pos, uv: WHITE_UV, color });
    let ground = Mesh { vertices: vertices.collect(), indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() };
    let painter = painter.with_clip_rect(floor.stage.shrink(1.0).intersect(painter.clip_rect()));
    painter.add(ground);
    let [left, right, ..] = floor.corners();
    painter.line_segment([left, right], Stroke::new(1.0, palette.line));
    let space = controls.value(Param::Space.info()) as usize;
    if space == 0 {
        painter.add(Shape::convex_polygon(floor.shadow(), palette.ground.gamma_multiply(0.7), Stroke::NONE));
        return;
    }
    let mix = controls.value(Param::SpaceMix.info()) / 100.0;
    let [strength, glow] = Floor::glow(mix, level);
    let line = Stroke::new(1.2 + glow, palette.line.lerp_to_gamma(palette.accent, strength));
    // The waves of a plate lie on it; the walls of a room stand.
    let clip = if space == 1 { floor.lying() } else { floor.stage };
    let painter = painter.with_clip_rect(painter.clip_rect().intersect(clip));
    floor.lines(space).into_iter().for_each(|points| {
        painter.add(Shape::line(points, line));
    });
}

/// Whether there is a space.
fn has_space(controls: &Controls) -> bool {
    controls.value(Param::Space.info()) > 0.0
}

fn id(name: &'static str, part: usize) -> Id {
    Id::unique((name, part))
}

/// The parts in which an area beside a body is taken hold of, with their numbers. One that is being dragged stays in hand, even if the
/// floor moves so that there are fewer.
fn parts(ui: &Ui, area: Rect, body: Rect, (name, _): (&'static str, &str)) -> Vec<(usize, Rect)> {
    let mut parts: Vec<(usize, Rect)> = beside(area, body).into_iter().enumerate().collect();
    let is_held = |part: &usize| ui.ctx().is_being_dragged(id(name, *part));
    parts.extend((parts.len()..MOST).find(is_held).map(|part| (part, area)));
    parts
}

/// The parts of an area beside a body and below it that are large enough to be taken hold of, the largest first; all of it, if the body is
/// elsewhere.
fn beside(area: Rect, body: Rect) -> Vec<Rect> {
    let body = body.intersect(area);
    if !body.is_positive() {
        return vec![area];
    }
    let below = Rect::from_min_max(body.left_bottom(), pos2(body.right(), area.bottom()));
    let mut parts = vec![area.with_min_x(body.right()), area.with_max_x(body.left()), below];
    parts.retain(|part| part.width().min(part.height()) >= LEAST);
    parts.sort_by(|one, other| other.area().total_cmp(&one.area()));
    parts
}

/// Shows what the body can stand on. Returns where that ends, and whether another was chosen.
pub(super) fn show_spaces(ui: &Ui, rect: Rect, controls: &mut Controls) -> (f32, bool) {
    let palette = controls.palette;
    let title = "Reverb";
    let place =
        line(ui.painter(), rect.with_max_x(rect.left() + 84.0), Align2::LEFT_CENTER, title, SMALL, palette.muted);
    let mut left = place.right() + 10.0;
    let now = controls.value(Param::Space.info()) as usize;
    let mut is_other = false;
    for (space, name) in FLOORS.into_iter().enumerate() {
        let size = vec2(width(ui.painter(), name, SMALL + 1.0) + 14.0, rect.height());
        let place = Rect::from_min_size(pos2(left, rect.top()), size);
        left = place.right() + 2.0;
        let response = tab(ui, place, name, space == now, palette);
        if response.hovered() {
            let help = if space == 0 { "No reverb." } else { "A reverb made of masses, in which the sound rings on." };
            *controls.hint = Hint::new(format!("Space: {name}"), help);
        }
        if response.clicked() && space != now {
            controls.set(Param::Space.info(), space as f32);
            is_other = true;
        }
    }
    (left, is_other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::{Choice, Space};

    #[test]
    fn every_space_is_a_floor() {
        assert_eq!(FLOORS[1..].iter().map(|name| name.to_lowercase()).collect::<Vec<_>>(), Space::NAMES[1..]);
        assert_eq!(FLOORS.len(), Space::ALL.len());
    }
}
