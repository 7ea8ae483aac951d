//! Bars, plates and boxes: an upper face that bends, and the sides in front and at the right end below it.

use crate::figure::{BLOCK, Bar, Figure};
use crate::light::{Facet, Finish, Gloss};
use crate::mesh::{ABOVE, Grid, Mesh, Moved};
use crate::view::lying;
use ecolor::Color32;
use emath::Vec2;
use std::f32::consts::TAU;

/// How far the edges of a bar's upper face are rounded off.
const BEVEL: f32 = 0.014;
/// Where the holes for the cord are: where the lowest mode of a free bar does not move.
const HOLES: [f32; 2] = [-0.552, 0.552];

/// Adds a bar.
pub(crate) fn add_bar(mesh: &mut Mesh, figure: &Figure, bar: &Bar, moved: &Moved) {
    let columns = figure.points.len();
    let finish = figure.finish;
    let along = |column: usize| 2.0 * figure.points[column].x as f32 - 1.0;
    let seen = |number: usize, facet: &Facet| grained(&finish, facet, moved.glow(number % columns));
    let grid = |rows: usize, place: &dyn Fn(usize, usize) -> [f32; 3]| {
        let places = (0..columns * rows).map(|number| place(number % columns, number / columns));
        Grid::new(places.collect(), columns)
    };
    let rows = if figure.is_large() { 11 } else { 4 };
    // In a small picture, it would be a line of broken pixels.
    let bevelled = if figure.is_large() { BEVEL } else { 0.0 };
    let half = bar.width - bevelled;
    let top = grid(rows, &|column, row| {
        let across = 2.0 * row as f32 / (rows - 1) as f32 - 1.0;
        lying([along(column), across * half], moved.by(column) - 0.02 * across * across)
    });
    mesh.add(&top, seen);
    if bevelled > 0.0 {
        let bevel = grid(2, &|column, row| {
            let out = row as f32 * bevelled;
            lying([along(column), half + out], moved.by(column) - 0.02 - out)
        });
        mesh.add(&bevel, seen);
    }
    let front = grid(3, &|column, row| {
        let from = 0.02 + bevelled;
        let down = from + (thickness(bar, along(column)) - from) * row as f32 / 2.0;
        lying([along(column), bar.width], moved.by(column) - down)
    });
    mesh.add(&front, seen);
    let last = columns - 1;
    let end = |number: usize| {
        let (across, down) = (1.0 - (number % 5) as f32 / 2.0, (number / 5) as f32);
        let up = moved.by(last) - 0.02 * across * across - down * (bar.thickness[0] - 0.02 * across * across);
        lying([1.0, across * bar.width], up)
    };
    let end = Grid::new((0..10).map(end).collect(), 5);
    mesh.add(&end, |_, facet| grained(&finish, facet, moved.glow(last)));
    if bar.has_holes {
        for hole in HOLES {
            let nearest = ((hole + 1.0) / 2.0 * last as f32).round() as usize;
            add_hole(mesh, [hole, 0.0], moved.by(nearest) + 0.002, 0.03 + 0.1 * bar.width, figure.is_large());
        }
    }
    if bar.is_clamped {
        let (width, depth, up) = BLOCK;
        add_block(mesh, &Finish::of("maple"), [[-1.0, -0.78], [-width, width]], [up, -depth], moved);
    }
}

/// A line across a bar and down its front.
pub(crate) fn across(bar: &Bar, along: f32, up: f32) -> [[f32; 3]; 6] {
    let top = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|share| lying([along, share * bar.width], up - 0.02 * share * share));
    let below = lying([along, bar.width], up - thickness(bar, along));
    [top[0], top[1], top[2], top[3], top[4], below]
}

/// The thickness of a bar at a place.
fn thickness(bar: &Bar, along: f32) -> f32 {
    let [end, middle] = bar.thickness;
    // The arch below a bar ends before its ends.
    let share = (1.0 - along * along / 0.52).max(0.0);
    end + (middle - end) * share * share * (3.0 - 2.0 * share)
}

/// Adds a plate or a box.
pub(crate) fn add_slab(mesh: &mut Mesh, figure: &Figure, thickness: f32, moved: &Moved) {
    let [columns, rows] = figure.grid;
    let places = (0..columns * rows).map(|number| figure.form.in_space(figure.points[number], moved.by(number)));
    let top = Grid::new(places.collect(), columns);
    // A flat face shines in stripes.
    let seen = |number: usize, facet: &Facet| {
        let colour = grained(&figure.finish, facet, moved.glow(number));
        let shine = 0.5 + 0.5 * Vec2::angled(4.2 * facet.at[0] - 2.4 * facet.at[1] + 0.8).y;
        let strength = if matches!(figure.finish.gloss, Gloss::Metal | Gloss::Glass) { 0.24 } else { 0.0 };
        colour.lerp_to_gamma(Color32::WHITE, strength * shine * shine * (1.0 - moved.glow(number).1))
    };
    let mut side = |edge: Vec<usize>| {
        let count = edge.len();
        let place = |number: usize| {
            let [x, y, z] = top.places[edge[number % count]];
            [x, y, z - thickness * (number / count) as f32]
        };
        mesh.add(&Grid::new((0..2 * count).map(place).collect(), count), |number, facet| {
            seen(edge[number % count], facet)
        });
    };
    side((0..columns).map(|column| (rows - 1) * columns + column).collect());
    side((0..rows).rev().map(|row| row * columns + columns - 1).collect());
    mesh.add(&top, seen);
    if thickness > 0.2 {
        add_hole(mesh, [0.25, 0.0], 0.002, 0.2, true);
    }
}

/// Adds a box between these places along and across, and these heights.
fn add_block(mesh: &mut Mesh, finish: &Finish, [along, across]: [[f32; 2]; 2], [top, below]: [f32; 2], moved: &Moved) {
    let faces = [
        [
            lying([along[0], across[0]], top),
            lying([along[1], across[0]], top),
            lying([along[0], across[1]], top),
            lying([along[1], across[1]], top),
        ],
        [
            lying([along[0], across[1]], top),
            lying([along[1], across[1]], top),
            lying([along[0], across[1]], below),
            lying([along[1], across[1]], below),
        ],
        [
            lying([along[1], across[1]], top),
            lying([along[1], across[0]], top),
            lying([along[1], across[1]], below),
            lying([along[1], across[0]], below),
        ],
    ];
    for face in faces {
        mesh.add(&Grid { lift: ABOVE, ..Grid::new(face.to_vec(), 2) }, |_, facet| {
            grained(finish, facet, moved.still())
        });
    }
}

/// Adds a dark hole in an upper face.
fn add_hole(mesh: &mut Mesh, [along, across]: [f32; 2], up: f32, radius: f32, is_large: bool) {
    let rows = if is_large { 17 } else { 7 };
    let place = |number: usize| {
        let around = (number % 2) as f32 * radius * Vec2::angled(TAU * (number / 2) as f32 / (rows - 1) as f32);
        lying([along + around.x, across + around.y], up)
    };
    let hole = Grid { lift: ABOVE, is_closed: true, ..Grid::new((0..2 * rows).map(place).collect(), 2) };
    mesh.add(&hole, |_, _| Color32::from_gray(18));
}

/// The colour of a facet, with the grain of wood along it.
fn grained(finish: &Finish, facet: &Facet, glow: (Color32, f32)) -> Color32 {
    let colour = finish.seen(facet, glow);
    if finish.gloss != Gloss::Wood {
        return colour;
    }
    let [x, y, z] = facet.at;
    let across = 31.0 * y - 11.0 * x + 23.0 * z;
    let wave = |phase: f32| Vec2::angled(phase).y;
    let grain = wave(across + 0.6 * wave(5.0 * x)) * wave(2.3 * across + 1.7 * wave(3.0 * x));
    colour.lerp_to_gamma(Color32::BLACK, 0.09 * (1.0 + grain))
}
