//! The floor that the body stands on, which is its space, and the place of the body.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text::{line, width};
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use sprung::params::Param;
use sprung_picture::play::FLOORS;
use std::f32::consts::TAU;

/// Height of the floor's far edge, as a share of the stage's.
const HORIZON: f32 = 0.64;

/// Paints the floor, with waves as far as the space is mixed in.
pub(in crate::editor) fn paint_floor(painter: &Painter, stage: Rect, middle: Rect, controls: &Controls) {
    let palette = controls.palette;
    let far = stage.top() + HORIZON * stage.height();
    let edge = 0.36 * stage.width();
    // Not under the words at the sides.
    let [left, right] = [(stage.center().x - edge).max(middle.left()), (stage.center().x + edge).min(middle.right())];
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
    let space = controls.value(Param::Space.info());
    let mix = if space > 0.0 { controls.value(Param::SpaceMix.info()) / 100.0 } else { 0.0 };
    let line = Stroke::new(1.2, palette.line.lerp_to_gamma(palette.accent, 0.15 + 0.6 * mix));
    let centre = pos2(middle.center().x, stage.top() + 0.84 * stage.height());
    match space as usize {
        1 => (1..=5).for_each(|ring| {
            let ring = circle(centre, ring as f32 * 0.095 * middle.width(), 0.26, 48);
            painter.add(Shape::closed_line(ring, line));
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

/// Shows what the body can stand on. Returns where that ends.
pub(super) fn show_spaces(ui: &Ui, rect: Rect, controls: &mut Controls) -> f32 {
    let palette = controls.palette;
    let title = "It stands on";
    let place =
        line(ui.painter(), rect.with_max_x(rect.left() + 84.0), Align2::LEFT_CENTER, title, SMALL, palette.muted);
    let mut left = place.right() + 10.0;
    let now = controls.value(Param::Space.info()) as usize;
    for (space, name) in FLOORS.into_iter().enumerate() {
        let size = vec2(width(ui.painter(), name, SMALL + 1.0) + 14.0, rect.height());
        let place = Rect::from_min_size(pos2(left, rect.top()), size);
        left = place.right() + 2.0;
        let response = tab(ui, place, name, space == now, palette);
        if response.hovered() {
            let help = if space == 0 { "No reverb." } else { "A reverb made of masses, in which the sound rings on." };
            *controls.hint = Hint::new(format!("Space: {name}"), help);
        }
        if response.clicked() {
            controls.set(Param::Space.info(), space as f32);
        }
    }
    left
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
