//! The floor that the body stands on, which is its space: its far edge is dragged for the size, the floor itself for the mix.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text::{line, width};
use crate::editor::widgets::{knob, outline};
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, CursorIcon, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use sprung::params::{Param, ParamInfo};
use sprung_picture::play::FLOORS;
use std::f32::consts::TAU;

/// Height of the floor's far edge, as a share of the stage's, and how much higher it is for each share of the travel by which the space
/// is larger than usual.
const HORIZON: f32 = 0.64;
const FARTHER: f32 = 0.24;
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

/// Where the floor is on a stage.
pub(in crate::editor) struct Floor {
    stage: Rect,
    middle: Rect,
    /// The height of its far edge, and the ends of that.
    far: f32,
    ends: [f32; 2],
}

/// What the user does with the floor.
#[derive(Default)]
pub(super) struct Touched {
    pub(super) is_clicked: bool,
    pub(super) is_dragged: bool,
}

impl Floor {
    /// The floor of a stage, whose far edge stays within `middle`.
    pub(in crate::editor) fn of(stage: Rect, middle: Rect, controls: &Controls) -> Self {
        let size = Param::SpaceSize.info();
        let larger =
            if has_space(controls) { controls.position(size) - size.normalise(size.default) as f32 } else { 0.0 };
        let edge = 0.36 * stage.width();
        // Not under the words at the sides.
        let ends = [(stage.center().x - edge).max(middle.left()), (stage.center().x + edge).min(middle.right())];
        Self { stage, middle, far: stage.top() + (HORIZON - FARTHER * larger) * stage.height(), ends }
    }

    /// Lets the user drag the floor beside a body that stands in `body`.
    pub(super) fn touch(&self, ui: &Ui, body: Rect, controls: &mut Controls) -> Touched {
        let mut touched = Touched::default();
        if !has_space(controls) {
            return touched;
        }
        let (painter, palette, [left, right]) = (ui.painter(), controls.palette, self.ends);
        let edge = Rect::from_x_y_ranges(left..=right, self.far - GRIP..=self.far + GRIP);
        let front = self.middle.with_min_y(edge.bottom()).with_max_y(self.stage.bottom());
        for (part, place) in parts(ui, edge, body, SIZE) {
            let is_hot = Self::part(ui, (place, part), Param::SpaceSize.info(), SIZE, &mut touched, controls);
            if is_hot {
                painter.hline(place.x_range(), place.center().y, Stroke::new(2.0, palette.text));
            }
            let grip = Rect::from_center_size(place.center(), vec2(28.0, 3.0));
            if part == 0 && place.contains_rect(grip) {
                painter.rect_filled(grip, 1.5, if is_hot { palette.text } else { palette.muted });
            }
        }
        for (part, place) in parts(ui, front, body, MIX) {
            Self::part(ui, (place, part), Param::SpaceMix.info(), MIX, &mut touched, controls);
        }
        touched
    }

    /// Lets the user drag a part of the floor, of which the first can have the focus and has a name. Returns whether it is at hand.
    fn part(
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
    pub(in crate::editor) fn paint(&self, painter: &Painter, level: f32, controls: &Controls) {
        let (palette, stage, middle, far) = (controls.palette, self.stage, self.middle, self.far);
        let [left, right] = self.ends;
        let corner = |pos: Pos2, color: Color32| Vertex { pos, uv: WHITE_UV, color };
        let near = palette.raised.lerp_to_gamma(palette.panel, 0.2);
        let mut floor = Mesh::default();
        floor.vertices.extend([
            corner(pos2(left, far), palette.panel),
            corner(pos2(right, far), palette.panel),
            corner(stage.right_bottom(), near),
            corner(stage.left_bottom(), near),
        ]);
        floor.add_triangle(0, 1, 2);
        floor.add_triangle(0, 2, 3);
        let painter = painter.with_clip_rect(stage.shrink(1.0).intersect(painter.clip_rect()));
        painter.add(floor);
        painter.line_segment([pos2(left, far), pos2(right, far)], Stroke::new(1.0, palette.line));
        let mix = if has_space(controls) { controls.value(Param::SpaceMix.info()) / 100.0 } else { 0.0 };
        let rest = 0.15 + 0.6 * mix;
        let glow = (level * mix.sqrt()).clamp(0.0, 1.0);
        let colour = palette.line.lerp_to_gamma(palette.accent, rest + (1.0 - rest) * glow);
        let line = Stroke::new(1.2 + glow, colour);
        let centre = pos2(middle.center().x, stage.top() + 0.84 * stage.height());
        match controls.value(Param::Space.info()) as usize {
            1 => (1..=5).for_each(|ring| {
                let ring = circle(centre, ring as f32 * 0.095 * middle.width(), 0.26, 48);
                let lying = painter.with_clip_rect(painter.clip_rect().intersect(stage.with_min_y(far)));
                lying.add(Shape::closed_line(ring, line));
            }),
            2 => (0..3).for_each(|coil| {
                spring(&painter, [left, right], far + (stage.bottom() - far) * (0.2 + 0.22 * coil as f32), line)
            }),
            3 => room(&painter, stage, [left, right], far, line),
            _ => {
                let shadow = circle(centre, 0.14 * stage.width(), 0.22, 32);
                painter.add(Shape::convex_polygon(shadow, palette.ground.gamma_multiply(0.7), Stroke::NONE));
            }
        }
    }
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

/// The corners of a circle that lies on the floor, as flat as it is seen.
fn circle(centre: Pos2, radius: f32, flatness: f32, corners: usize) -> Vec<Pos2> {
    let round = |corner: usize| egui::Vec2::angled(TAU * corner as f32 / corners as f32);
    (0..corners).map(|corner| centre + vec2(1.0, flatness) * (radius * round(corner))).collect()
}

fn spring(painter: &Painter, [left, right]: [f32; 2], y: f32, stroke: Stroke) {
    let point = |step: usize| {
        pos2(left + (right - left) * step as f32 / 240.0, y + 5.0 * egui::Vec2::angled(TAU * step as f32 / 6.0).y)
    };
    painter.add(Shape::line((0..=240).map(point).collect(), stroke));
}

fn room(painter: &Painter, stage: Rect, [left, right]: [f32; 2], far: f32, stroke: Stroke) {
    let top = stage.top() + 0.06 * stage.height();
    painter.add(Shape::line(vec![pos2(left, far), pos2(left, top), pos2(right, top), pos2(right, far)], stroke));
    painter.line_segment([pos2(left, top), stage.left_top()], stroke);
    painter.line_segment([pos2(right, top), stage.right_top()], stroke);
    for share in [0.2, 0.4, 0.6, 0.8] {
        let from = pos2(left + (right - left) * share, far);
        painter.line_segment([from, pos2(stage.left() + stage.width() * share, stage.bottom())], stroke);
    }
}

/// Shows what the body can stand on. Returns where that ends, and whether another was chosen.
pub(super) fn show_spaces(ui: &Ui, rect: Rect, controls: &mut Controls) -> (f32, bool) {
    let palette = controls.palette;
    let title = "It stands on";
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
