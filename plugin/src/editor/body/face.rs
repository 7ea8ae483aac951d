//! Draws a body: its points at their present places, lit from the left above, and glowing where they move.

use super::figure::Figure;
use super::form::{Form, VIEW};
use crate::editor::theme::Palette;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Painter, Pos2, Rect, Rgba, Shape, Stroke, vec2};
use sprung::sound::bodies::Point;

/// Where the light comes from: left, in front, above; a unit vector.
const LIGHT: [f32; 3] = [-0.5, 0.45, 0.74];
/// Share of the light that comes from everywhere.
const AMBIENT: f32 = 0.2;
/// Strength of highlights.
const GLOSS: f32 = 0.3;
/// Points of a line that is as thick as a bar: the share of its thickness above the middle, and its light.
const ROUND: [[f32; 2]; 4] = [[0.5, 0.62], [0.22, 1.15], [-0.2, 0.6], [-0.5, 0.22]];

/// Paints the body. Displacements are in the picture's unit, none for a body at rest; `strike` is the place where the body is
/// struck.
pub(crate) fn paint(
    painter: &Painter,
    rect: Rect,
    figure: &Figure,
    displacements: &[f32],
    strike: Option<Point>,
    palette: &Palette,
) {
    let form = figure.form;
    let displaced = |number: usize| displacements.get(number).copied().unwrap_or(0.0);
    let place = |number: usize| form.on(rect, figure.points[number], displaced(number));
    let reach = form.reach(rect);
    let glow = |number: usize| (displaced(number).abs() / reach).min(1.0).sqrt() * 0.85;
    if form == Form::Line {
        let points: Vec<Pos2> = (0..figure.points.len()).map(place).collect();
        if figure.thickness == 0.0 {
            let rest = |x: f64| form.on(rect, Point { x, y: 0.0 }, 0.0);
            painter.line_segment([rest(0.0), rest(1.0)], Stroke::new(1.0, palette.line));
            for end in [points[0], points[points.len() - 1]] {
                painter.circle_filled(end, 3.0, palette.muted);
            }
            painter.add(Shape::line(points, Stroke::new(2.5, palette.accent)));
        } else {
            painter.add(ribbon(&points, figure.thickness * rect.height().min(rect.width()), glow, figure, palette));
        }
    } else {
        surface(painter, rect, figure, &displaced, glow, palette);
    }
    if let Some(strike) = strike {
        let nearest = (0..figure.points.len()).min_by(|a, b| {
            let far =
                |number: &usize| (form.on(rect, figure.points[*number], 0.0) - form.on(rect, strike, 0.0)).length();
            far(a).total_cmp(&far(b))
        });
        let moved = nearest.map_or(0.0, displaced);
        let at = form.on(rect, strike, moved);
        painter.circle(at, 5.5, palette.panel, Stroke::new(2.0, palette.text));
        painter.circle_filled(at, 1.8, palette.text);
    }
}

/// A colour in a light, 1 for that in which the material's colour is seen, with a highlight and a glow from 0 to 1.
fn lit(tint: Color32, light: f32, highlight: f32, glow: f32, palette: &Palette) -> Color32 {
    let lit = Rgba::from(tint) * light + Rgba::from(Color32::WHITE) * highlight;
    Color32::from(Rgba::from_rgb(lit.r().min(1.0), lit.g().min(1.0), lit.b().min(1.0)))
        .lerp_to_gamma(palette.accent, glow)
}

/// A line as thick as a bar, round to the light.
fn ribbon(points: &[Pos2], thickness: f32, glow: impl Fn(usize) -> f32, figure: &Figure, palette: &Palette) -> Mesh {
    let mut mesh = Mesh::default();
    for (number, point) in points.iter().enumerate() {
        for [up, light] in ROUND {
            let (pos, color) =
                (*point - vec2(0.0, up * thickness), lit(figure.tint, light, 0.0, glow(number), palette));
            mesh.vertices.push(Vertex { pos, uv: WHITE_UV, color });
        }
    }
    let across = ROUND.len() as u32;
    for first in (0..(points.len() as u32 - 1) * across).filter(|first| (first + 1) % across > 0) {
        mesh.add_triangle(first, first + 1, first + across + 1);
        mesh.add_triangle(first, first + across + 1, first + across);
    }
    mesh
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The light on a piece of surface with two edges from its corner, seen from either side, and its highlight.
fn light(along: [f32; 3], across: [f32; 3]) -> [f32; 2] {
    let axis = |n: usize| {
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        along[u] * across[v] - along[v] * across[u]
    };
    let normal: [f32; 3] = std::array::from_fn(axis);
    let length = dot(normal, normal).sqrt().max(1e-9).copysign(dot(normal, VIEW));
    let normal = normal.map(|axis| axis / length);
    let half: [f32; 3] = std::array::from_fn(|axis| LIGHT[axis] + VIEW[axis]);
    let glance = dot(normal, half).max(0.0) / dot(half, half).sqrt();
    // Its sixteenth power.
    let highlight = (0..4).fold(glance, |power, _| power * power);
    [AMBIENT + (1.0 - AMBIENT) * 1.25 * dot(normal, LIGHT).max(0.0), GLOSS * highlight]
}

fn surface(
    painter: &Painter,
    rect: Rect,
    figure: &Figure,
    displaced: &impl Fn(usize) -> f32,
    glow: impl Fn(usize) -> f32,
    palette: &Palette,
) {
    let (form, [columns, rows]) = (figure.form, figure.grid);
    let places: Vec<[f32; 3]> =
        (0..columns * rows).map(|number| form.in_space(figure.points[number], displaced(number))).collect();
    let is_closed = !matches!(form, Form::Plate { .. });
    let vertex = |number: usize| {
        let (column, row) = (number % columns, number / columns);
        let between = |a: usize, b: usize| std::array::from_fn(|axis| places[b][axis] - places[a][axis]);
        // The first point of a turned form is the same all round: the next ones have its light.
        let column = if is_closed { column.max(1) } else { column };
        let [left, right] = [column.saturating_sub(1), (column + 1).min(columns - 1)];
        let [above, below] = match is_closed {
            true => [(row + rows - 2) % (rows - 1), (row + 1) % (rows - 1)],
            false => [row.saturating_sub(1), (row + 1).min(rows - 1)],
        };
        let [light, highlight] = light(
            between(row * columns + left, row * columns + right),
            between(above * columns + column, below * columns + column),
        );
        let pos = form.on(rect, figure.points[number], displaced(number));
        Vertex { pos, uv: WHITE_UV, color: lit(figure.tint, light, highlight, glow(number), palette) }
    };
    let mut mesh = Mesh { vertices: (0..columns * rows).map(vertex).collect(), ..Mesh::default() };
    // The farthest patches are painted first.
    let mut patches: Vec<usize> =
        (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column)).collect();
    let nearness = |patch: &usize| dot(places[*patch], VIEW) + dot(places[patch + columns + 1], VIEW);
    patches.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
    for patch in &patches {
        let corners = [*patch, patch + 1, patch + columns + 1, patch + columns].map(|corner| corner as u32);
        mesh.add_triangle(corners[0], corners[1], corners[2]);
        mesh.add_triangle(corners[0], corners[2], corners[3]);
    }
    painter.add(mesh);
    let at = |column: usize, row: usize| {
        let number = row * columns + column;
        form.on(rect, figure.points[number], displaced(number))
    };
    let edge = Stroke::new(1.2, palette.text.gamma_multiply(0.5));
    let is_hidden = |(column, row): &(usize, usize)| form.is_behind(figure.points[row * columns + column]);
    let line = |points: Vec<(usize, usize)>| {
        // The far side of a bell's rim is behind the bell; a bowl is open.
        for run in points.chunk_by(|a, b| form != Form::Bell || is_hidden(a) == is_hidden(b)) {
            if form != Form::Bell || !is_hidden(&run[0]) {
                painter.add(Shape::line(run.iter().map(|(column, row)| at(*column, *row)).collect(), edge));
            }
        }
    };
    line((0..rows).map(|row| (columns - 1, row)).collect());
    if !is_closed {
        line((0..rows).map(|row| (0, row)).collect());
        line((0..columns).map(|column| (column, 0)).collect());
        line((0..columns).map(|column| (column, rows - 1)).collect());
    }
}
