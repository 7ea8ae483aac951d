//! A body as it is painted: lit from the left above, and glowing where it moves.

use crate::figure::{Drum, Figure, tint};
use crate::form::{Form, LOOK, VIEW};
use ecolor::{Color32, Rgba};
use emath::{Pos2, Rect, Vec2, vec2};
use sprung::sound::bodies::Point;
use std::f32::consts::{PI, TAU};

/// Where the light comes from: left, in front, above; a unit vector.
const LIGHT: [f32; 3] = [-0.5, 0.45, 0.74];
/// Share of the light that comes from everywhere.
const AMBIENT: f32 = 0.2;
/// Strength of highlights.
const GLOSS: f32 = 0.3;
/// Points across a tube: the share of its thickness above the middle, and its light.
const ROUND: [[f32; 2]; 4] = [[0.5, 0.62], [0.22, 1.15], [-0.2, 0.6], [-0.5, 0.22]];
/// Those across a bar, which is twice as wide as thick: its upper side as one looks down on it, and the side in front.
const FLAT: [[f32; 2]; 4] = [[1.25, 0.85], [-0.25, 1.1], [-0.25, 0.5], [-0.75, 0.38]];

/// How many flat pieces a drum's shell has, and where its wires lie in front of and behind the middle of its head.
const SHELL: usize = 16;
const WIRES: [f32; 3] = [-0.45, 0.0, 0.45];
/// Shortest line of an outline in pixels: one between two equal points has no direction.
const SHORTEST: f32 = 0.05;

/// A body as it is painted, in the order of its parts.
#[derive(Debug, Default)]
pub struct Picture {
    /// Points with their colours.
    pub vertices: Vec<(Pos2, Color32)>,
    /// Triangles between these, the farthest first.
    pub triangles: Vec<[u32; 3]>,
    /// Lines that are painted below the triangles, so that their outline is smooth where triangles are painted without smoothing.
    pub outline: Vec<([Pos2; 2], Color32)>,
    /// The edges of a surface.
    pub edges: Vec<Vec<Pos2>>,
    /// A string, from end to end; empty for all other bodies.
    pub string: Vec<Pos2>,
    /// Where it is struck.
    pub strike: Option<Pos2>,
}

impl Picture {
    /// The picture of a figure in a rectangle. Displacements of its points are in the form's unit, none for a body at rest. What moves
    /// takes on the colour `glow`. Allocates.
    pub fn of(rect: Rect, figure: &Figure, displacements: &[f32], strike: Option<Point>, glow: Color32) -> Self {
        let form = figure.form;
        let mut picture = Self::default();
        let rect = figure.drum.map_or(rect, |drum| picture.shell(rect, drum));
        let displaced = |number: usize| displacements.get(number).copied().unwrap_or(0.0);
        let reach = form.reach(rect);
        let share = |number: usize| (displaced(number).abs() / reach).min(1.0).sqrt() * 0.85;
        let colour = |number: usize, light: f32, highlight: f32| {
            lit(figure.tint, light, highlight).lerp_to_gamma(glow, share(number))
        };
        if form == Form::Line {
            let place = |number: usize| form.on(rect, figure.points[number], displaced(number));
            let points: Vec<Pos2> = (0..figure.points.len()).map(place).collect();
            if figure.thickness == 0.0 {
                picture.string = points;
            } else {
                let across = if figure.is_round { &ROUND } else { &FLAT };
                picture.bar(&points, across, figure.thickness * rect.height().min(rect.width()), colour);
            }
        } else {
            picture.surface(rect, figure, &displaced, colour);
        }
        if figure.drum.is_some_and(|drum| drum.has_wires) {
            let wire = |y: f32| [-1.0, 1.0].map(|side| on_head(rect, [side * (1.0 - y * y).sqrt(), y]));
            picture.edges.extend(WIRES.map(|y| wire(y).to_vec()));
        }
        picture.strike = strike.map(|strike| {
            let at = |point| form.on(rect, point, 0.0);
            let far = |number: &usize| (at(figure.points[*number]) - at(strike)).length();
            let nearest = (0..figure.points.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            form.on(rect, strike, nearest.map_or(0.0, displaced))
        });
        picture
    }

    /// The same body, with its lowest point at this height.
    pub fn standing(mut self, floor: f32) -> Self {
        let points = || self.vertices.iter().map(|(at, _)| at).chain(&self.string);
        let down = vec2(0.0, floor - points().fold(f32::NEG_INFINITY, |lowest, at| lowest.max(at.y)));
        let vertices = self.vertices.iter_mut().map(|(at, _)| at);
        let edges = self.edges.iter_mut().flatten().chain(&mut self.string).chain(&mut self.strike);
        let outline = self.outline.iter_mut().flat_map(|(ends, _)| ends);
        vertices.chain(edges).chain(outline).for_each(|at| *at += down);
        self
    }

    /// The shell of a drum. Returns the place of its head.
    fn shell(&mut self, rect: Rect, drum: Drum) -> Rect {
        let [sine, cosine] = LOOK;
        let height = drum.depth * cosine;
        let unit = drum.size * (0.45 * rect.width()).min(0.45 * rect.height() / (sine + 0.5 * height));
        let down = vec2(0.0, unit * height);
        let head = Rect::from_center_size(rect.center() - 0.5 * down, Form::round_size(unit));
        let rim = |step: usize| Vec2::angled(PI * step as f32 / SHELL as f32);
        for step in 0..=SHELL {
            let (at, next) = (rim(step), 2 * step as u32);
            let light = AMBIENT + (LIGHT[0] * at.x + LIGHT[1] * at.y).max(0.0) * (1.0 - AMBIENT) + 0.25;
            let colour = lit(tint(drum.shell), light, 0.0);
            let top = on_head(head, at.into());
            self.vertices.extend([(top, colour), (top + down, colour)]);
            if step < SHELL {
                self.triangles.extend([[next, next + 1, next + 3], [next, next + 3, next + 2]]);
            }
        }
        self.edges.push((0..=SHELL).map(|step| on_head(head, rim(step).into()) + down).collect());
        head
    }

    /// A thick line, with these points across.
    fn bar(
        &mut self,
        points: &[Pos2],
        across: &[[f32; 2]],
        thickness: f32,
        colour: impl Fn(usize, f32, f32) -> Color32,
    ) {
        for (number, point) in points.iter().enumerate() {
            for [up, light] in across {
                self.vertices.push((*point - vec2(0.0, up * thickness), colour(number, *light, 0.0)));
            }
        }
        let across = across.len() as u32;
        for first in (0..(points.len() as u32 - 1) * across).filter(|first| (first + 1) % across > 0) {
            self.triangles.push([first, first + 1, first + across + 1]);
            self.triangles.push([first, first + across + 1, first + across]);
        }
        let sides = (0..points.len() as u32 - 1).flat_map(|point| [point * across, (point + 1) * across - 1]);
        self.outline_along(sides.map(|from| [from, from + across]));
    }

    /// Adds lines between vertices to the outline.
    fn outline_along(&mut self, lines: impl Iterator<Item = [u32; 2]>) {
        let vertices = &self.vertices;
        let lines = lines.map(|ends| ends.map(|end| vertices[end as usize]));
        let lines = lines.filter(|[from, to]| (to.0 - from.0).length() > SHORTEST);
        self.outline.extend(lines.map(|[from, to]| ([from.0, to.0], from.1)));
    }

    /// Adds the lines of a grid of vertices to the outline that have a patch seen from the front on one side only.
    fn outline_grid(&mut self, first: u32, [columns, rows]: [usize; 2]) {
        let vertex = |column: usize, row: usize| first + (row * columns + column) as u32;
        let is_front = |column: usize, row: usize| {
            let at = |column: usize, row: usize| self.vertices[vertex(column, row) as usize].0;
            let [one, other] = [at(column + 1, row + 1) - at(column, row), at(column, row + 1) - at(column + 1, row)];
            one.x * other.y > one.y * other.x
        };
        // Beyond the ends of the grid there is none.
        let patch = |column: usize, row: usize| (column + 1 < columns && row + 1 < rows).then(|| is_front(column, row));
        let mut lines = Vec::new();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let (here, above) = (patch(column, row), row.checked_sub(1).and_then(|row| patch(column, row)));
            let left = column.checked_sub(1).and_then(|column| patch(column, row));
            if column + 1 < columns && here != above {
                lines.push([vertex(column, row), vertex(column + 1, row)]);
            }
            if row + 1 < rows && here != left {
                lines.push([vertex(column, row), vertex(column, row + 1)]);
            }
        }
        self.outline_along(lines.into_iter());
    }

    fn surface(
        &mut self,
        rect: Rect,
        figure: &Figure,
        displaced: &impl Fn(usize) -> f32,
        colour: impl Fn(usize, f32, f32) -> Color32,
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
            (form.on(rect, figure.points[number], displaced(number)), colour(number, light, highlight))
        };
        let before = self.vertices.len() as u32;
        self.vertices.extend((0..columns * rows).map(vertex));
        // The farthest patches are painted first.
        let mut patches: Vec<usize> =
            (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column)).collect();
        let nearness = |patch: &usize| dot(places[*patch], VIEW) + dot(places[patch + columns + 1], VIEW);
        patches.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        for patch in &patches {
            let corners = [*patch, patch + 1, patch + columns + 1, patch + columns];
            let corners = corners.map(|corner| before + corner as u32);
            self.triangles.push([corners[0], corners[1], corners[2]]);
            self.triangles.push([corners[0], corners[2], corners[3]]);
        }
        self.outline_grid(before, figure.grid);
        let at = |column: usize, row: usize| {
            let number = row * columns + column;
            form.on(rect, figure.points[number], displaced(number))
        };
        let is_hidden = |(column, row): &(usize, usize)| form.is_behind(figure.points[row * columns + column]);
        let mut edge = |points: Vec<(usize, usize)>| {
            // The far side of a bell's rim is behind the bell; a bowl is open.
            for run in points.chunk_by(|a, b| form != Form::Bell || is_hidden(a) == is_hidden(b)) {
                if form != Form::Bell || !is_hidden(&run[0]) {
                    self.edges.push(run.iter().map(|(column, row)| at(*column, *row)).collect());
                }
            }
        };
        edge((0..rows).map(|row| (columns - 1, row)).collect());
        if !is_closed {
            edge((0..rows).map(|row| (0, row)).collect());
            edge((0..columns).map(|column| (column, 0)).collect());
            edge((0..columns).map(|column| (column, rows - 1)).collect());
        }
    }
}

/// A place on a drum's head at rest, whose radius is 1: to the right, and to the viewer.
fn on_head(rect: Rect, [x, y]: [f32; 2]) -> Pos2 {
    let turn = Vec2::new(x, y).angle() / TAU - 0.25;
    Form::Round.on(rect, Point { x: Vec2::new(x, y).length().into(), y: turn.into() }, 0.0)
}

/// A colour in a light, 1 for that in which the material's colour is seen, with a highlight.
fn lit(tint: Color32, light: f32, highlight: f32) -> Color32 {
    let lit = Rgba::from(tint) * light + Rgba::from(Color32::WHITE) * highlight;
    Color32::from(Rgba::from_rgb(lit.r().min(1.0), lit.g().min(1.0), lit.b().min(1.0)))
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

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::preset::Preset;

    #[test]
    fn an_outline_reaches_as_far_as_its_body() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        for name in ["Marimba", "Gong", "Church Bell", "Metal Plate", "Singing Bowl"] {
            let Preset { patch, guide, tags, .. } = Preset::find(name).unwrap();
            let figure = crate::small_figure(&patch.modes, guide.family, tags);
            let moved: Vec<f32> = (0..figure.points.len()).map(|number| (number % 7) as f32).collect();
            for displacements in [&[], &moved[..]] {
                let picture = Picture::of(rect, &figure, displacements, None, Color32::WHITE);
                let places: Vec<Pos2> = picture.vertices.iter().map(|(at, _)| *at).collect();
                let ends: Vec<Pos2> = picture.outline.iter().flat_map(|(ends, _)| *ends).collect();
                assert_eq!(Rect::from_points(&ends), Rect::from_points(&places), "{name}");
            }
        }
    }
}
