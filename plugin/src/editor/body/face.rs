//! Draws a body: its points at their present places, coloured by their displacement.

use super::form::Form;
use super::shape::BodyShape;
use crate::editor::theme::Palette;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke};
use sprung::sound::bodies::Point;

/// Paints the body. Displacements are in the picture's unit; `strike` is the place where the body is struck.
pub(super) fn paint(
    painter: &Painter,
    rect: Rect,
    shape: &BodyShape,
    displacements: &[f32],
    strike: Option<Point>,
    palette: &Palette,
) {
    let form = shape.form;
    let place = |number: usize| form.on(rect, shape.points[number], displacements[number]);
    if form == Form::Line {
        let rest = |x: f64| form.on(rect, Point { x, y: 0.0 }, 0.0);
        painter.line_segment([rest(0.0), rest(1.0)], Stroke::new(1.0, palette.line));
        let points: Vec<Pos2> = (0..shape.points.len()).map(place).collect();
        for end in [points[0], points[points.len() - 1]] {
            painter.circle_filled(end, 3.0, palette.muted);
        }
        painter.add(Shape::line(points, Stroke::new(2.5, palette.accent)));
    } else {
        surface(painter, rect, shape, displacements, palette);
    }
    if let Some(strike) = strike {
        let nearest = (0..shape.points.len()).min_by(|a, b| {
            let far =
                |number: &usize| (form.on(rect, shape.points[*number], 0.0) - form.on(rect, strike, 0.0)).length();
            far(a).total_cmp(&far(b))
        });
        let moved = nearest.map_or(0.0, |nearest| displacements[nearest]);
        let at = form.on(rect, strike, moved);
        painter.circle(at, 5.5, palette.panel, Stroke::new(2.0, palette.text));
        painter.circle_filled(at, 1.8, palette.text);
    }
}

/// Positive displacements get the accent's colour, negative ones the colour of modulation: both can be told apart
/// without red and green.
fn colour(displacement: f32, reach: f32, palette: &Palette) -> Color32 {
    let share = (displacement / reach).clamp(-1.0, 1.0);
    let towards = if share >= 0.0 { palette.accent } else { palette.modulation };
    palette.raised.lerp_to_gamma(towards, share.abs().sqrt() * 0.85)
}

fn surface(painter: &Painter, rect: Rect, shape: &BodyShape, displacements: &[f32], palette: &Palette) {
    let (form, [columns, rows]) = (shape.form, shape.form.grid());
    let reach = form.reach(rect);
    let vertex = |number: usize| Vertex {
        pos: form.on(rect, shape.points[number], displacements[number]),
        uv: WHITE_UV,
        color: colour(displacements[number], reach, palette),
    };
    let mut mesh = Mesh { vertices: (0..columns * rows).map(vertex).collect(), ..Mesh::default() };
    // The farthest patches are painted first.
    let mut patches: Vec<usize> =
        (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column)).collect();
    let depth = |patch: &usize| {
        let is_behind = form.is_behind(shape.points[*patch]);
        (if is_behind { -1e6 } else { 0.0 }) + form.on(rect, shape.points[*patch], 0.0).y
    };
    patches.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    for patch in &patches {
        let corners = [*patch, patch + 1, patch + columns + 1, patch + columns].map(|corner| corner as u32);
        mesh.add_triangle(corners[0], corners[1], corners[2]);
        mesh.add_triangle(corners[0], corners[2], corners[3]);
    }
    painter.add(mesh);
    let at = |column: usize, row: usize| {
        let number = row * columns + column;
        form.on(rect, shape.points[number], displacements[number])
    };
    let thin = Stroke::new(1.0, palette.text.gamma_multiply(0.22));
    let edge = Stroke::new(1.6, palette.text.gamma_multiply(0.75));
    let is_hidden = |column: usize, row: usize| form.is_behind(shape.points[row * columns + column]);
    let lines = |points: Vec<(usize, usize)>, stroke: Stroke, all: bool| {
        // Lines behind the body are not drawn, except a rim.
        for run in points.chunk_by(|a, b| all || is_hidden(a.0, a.1) == is_hidden(b.0, b.1)) {
            if all || !is_hidden(run[0].0, run[0].1) {
                painter.add(Shape::line(run.iter().map(|(column, row)| at(*column, *row)).collect(), stroke));
            }
        }
    };
    let is_plate = matches!(form, Form::Plate { .. });
    for column in (0..columns).step_by(2) {
        lines((0..rows).map(|row| (column, row)).collect(), thin, false);
    }
    for row in (0..rows - usize::from(!is_plate)).step_by(if is_plate { 2 } else { 4 }) {
        lines((0..columns).map(|column| (column, row)).collect(), thin, false);
    }
    // The far side of a bell's rim is behind the bell; a bowl is open.
    lines((0..rows).map(|row| (columns - 1, row)).collect(), edge, form != Form::Bell);
    if is_plate {
        lines((0..rows).map(|row| (0, row)).collect(), edge, true);
        lines((0..columns).map(|column| (column, 0)).collect(), edge, true);
        lines((0..columns).map(|column| (column, rows - 1)).collect(), edge, true);
    }
}
