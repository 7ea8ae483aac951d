//! Grids of places in space, which become triangles, the farthest first, and the lines of their outline.

use crate::light::{Facet, cross, dot, unit};
use crate::view::{VIEW, View};
use ecolor::Color32;
use emath::Pos2;

/// Shortest line of an outline in pixels: one between two equal points has no direction.
const SHORTEST: f32 = 0.05;

/// The lift of what is always seen.
pub(crate) const ABOVE: f32 = 8.0;

/// A part of a body: a grid of places, those of a row one after the other, whose rows turn to the left of its columns as seen from outside.
pub(crate) struct Grid {
    pub places: Vec<[f32; 3]>,
    pub columns: usize,
    /// Whether the last row is the first one again.
    pub is_closed: bool,
    /// Whether both of its sides are seen; otherwise, only that which faces outwards.
    pub has_two_sides: bool,
    /// Whether its rows are grooves of a lathe.
    pub is_turned: bool,
    /// How much nearer to the viewer it is than its places say.
    pub lift: f32,
}

impl Grid {
    /// A grid that is seen from outside.
    pub(crate) fn new(places: Vec<[f32; 3]>, columns: usize) -> Self {
        Self { places, columns, is_closed: false, has_two_sides: false, is_turned: false, lift: 0.0 }
    }

    fn rows(&self) -> usize {
        self.places.len() / self.columns
    }

    fn facet(&self, number: usize) -> Facet {
        let (columns, rows) = (self.columns, self.rows());
        let (column, row) = (number % columns, number / columns);
        let between = |a: usize, b: usize| std::array::from_fn(|axis| self.places[b][axis] - self.places[a][axis]);
        let [above, below] = match self.is_closed {
            true => [(row + rows - 2) % (rows - 1), (row + 1) % (rows - 1)],
            false => [row.saturating_sub(1), (row + 1).min(rows - 1)],
        };
        // A first point that is the same in all rows has no direction: the next ones have its light.
        let is_point = self.is_closed && self.places[row * columns + column] == self.places[below * columns + column];
        let column = if is_point { column.checked_sub(1).unwrap_or(1) } else { column };
        let [left, right] = [column.saturating_sub(1), (column + 1).min(columns - 1)];
        let across = between(above * columns + column, below * columns + column);
        let mut normal = unit(cross(between(row * columns + left, row * columns + right), across));
        if self.has_two_sides && dot(normal, VIEW) < 0.0 {
            normal = normal.map(|axis| -axis);
        }
        Facet { at: self.places[number], normal, groove: self.is_turned.then(|| unit(across)) }
    }
}

/// How far the points of a body are displaced.
#[derive(Clone, Copy)]
pub(crate) struct Moved<'a> {
    pub displacements: &'a [f32],
    /// The displacement that glows most.
    pub reach: f32,
    /// The colour of what moves.
    pub glow: Color32,
}

impl Moved<'_> {
    /// The displacement of a point, 0 at rest.
    pub(crate) fn by(&self, point: usize) -> f32 {
        self.displacements.get(point).copied().unwrap_or(0.0)
    }

    /// With which colour a point glows, and how much.
    pub(crate) fn glow(&self, point: usize) -> (Color32, f32) {
        (self.glow, (self.by(point).abs() / self.reach).min(1.0) * 0.8)
    }

    /// The glow of what does not move.
    pub(crate) fn still(&self) -> (Color32, f32) {
        (self.glow, 0.0)
    }
}

/// What is painted of parts.
pub(crate) struct Mesh {
    pub view: View,
    pub vertices: Vec<(Pos2, Color32)>,
    /// Lines below the triangles.
    pub outline: Vec<([Pos2; 2], Color32)>,
    /// Patches with four corners, and how near they are.
    patches: Vec<(f32, [u32; 4])>,
}

impl Mesh {
    pub(crate) fn new(view: View) -> Self {
        Self { view, vertices: Vec::new(), outline: Vec::new(), patches: Vec::new() }
    }

    /// Adds a part, with a colour for each of its places.
    pub(crate) fn add(&mut self, grid: &Grid, colour: impl Fn(usize, &Facet) -> Color32) {
        let (columns, rows) = (grid.columns, grid.rows());
        let first = self.vertices.len();
        self.vertices.extend(grid.places.iter().map(|place| (self.view.at(*place), Color32::TRANSPARENT)));
        let mut is_used = vec![false; grid.places.len()];
        let corners = |column: usize, row: usize| {
            let at = row * columns + column;
            [at, at + 1, at + columns + 1, at + columns]
        };
        let is_front = |column: usize, row: usize| {
            let [a, b, c, d] = corners(column, row).map(|corner| self.vertices[first + corner].0);
            (c - a).x * (d - b).y > (c - a).y * (d - b).x
        };
        let fronts: Vec<bool> =
            (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| is_front(column, row))).collect();
        let front = |column: usize, row: usize| fronts[row * (columns - 1) + column];
        for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
            if grid.has_two_sides || front(column, row) {
                let corners = corners(column, row);
                corners.iter().for_each(|corner| is_used[*corner] = true);
                let nearness = dot(grid.places[corners[0]], VIEW) + dot(grid.places[corners[2]], VIEW);
                self.patches.push((nearness + grid.lift, corners.map(|corner| (first + corner) as u32)));
            }
        }
        // Light is slow: only what is seen has some.
        for (number, (_, seen)) in self.vertices[first..].iter_mut().enumerate().filter(|(number, _)| is_used[*number])
        {
            *seen = colour(number, &grid.facet(number));
        }
        self.add_outline(grid, first, &front);
    }

    /// Adds the lines of a grid that have a patch seen from the front on one side only.
    fn add_outline(&mut self, grid: &Grid, first: usize, front: &impl Fn(usize, usize) -> bool) {
        let (columns, rows) = (grid.columns, grid.rows());
        // Beyond the ends of the grid there is none, unless it goes round.
        let patch = |column: Option<usize>, row: Option<usize>| {
            let (column, row) = (column.filter(|column| *column + 1 < columns)?, row?);
            (row + 1 < rows).then(|| front(column, row))
        };
        let before = |row: usize| row.checked_sub(1).or(grid.is_closed.then(|| rows - 2));
        let is_seen = |one: Option<bool>, other: Option<bool>| {
            let shown = |side: Option<bool>| side.is_some_and(|side| side || grid.has_two_sides);
            one != other && (shown(one) || shown(other))
        };
        // The last row of a part that goes round is its first.
        let last = rows - usize::from(grid.is_closed);
        for (row, column) in (0..last).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let here = patch(Some(column), Some(row));
            let from = first + row * columns + column;
            let mut line = |to: usize| {
                let [from, to] = [self.vertices[from], self.vertices[to]];
                if (to.0 - from.0).length() > SHORTEST {
                    self.outline.push(([from.0, to.0], from.1));
                }
            };
            if column + 1 < columns && is_seen(here, patch(Some(column), before(row))) {
                line(from + 1);
            }
            if row + 1 < rows && is_seen(here, patch(column.checked_sub(1), Some(row))) {
                line(from + columns);
            }
        }
    }

    /// The triangles, the farthest first.
    pub(crate) fn triangles(&mut self) -> Vec<[u32; 3]> {
        self.patches.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        self.patches.iter().flat_map(|(_, [a, b, c, d])| [[*a, *b, *c], [*a, *c, *d]]).collect()
    }
}
