//! Bodies that are turned round an axis: heads, discs, cymbals, gongs, bells, bowls and glasses.

use crate::figure::{Build, Figure};
use crate::form::Form;
use crate::light::{Facet, Finish};
use crate::mesh::{Grid, Mesh, Moved};
use crate::outline::{CROWN, GRIP, STEM, along};
use ecolor::Color32;
use emath::Vec2;
use std::f32::consts::TAU;

/// How far the rim of a gong is bent down, and how far the middle of its edge is drawn in.
const RIM: [f32; 2] = [0.17, 0.02];
/// Thickness of a cymbal's edge.
const EDGE: f32 = 0.03;

/// Adds the surface of a body, and what belongs to it.
pub(crate) fn add(mesh: &mut Mesh, figure: &Figure, moved: &Moved) {
    let (form, [columns, rows]) = (figure.form, figure.grid);
    let places = |number: usize| form.in_space(figure.points[number], moved.by(number));
    let is_turned = matches!(form, Form::Cymbal | Form::Gong) || form == Form::Round && figure.build != Build::Thin;
    let surface = Grid {
        is_closed: true,
        has_two_sides: form.is_open(),
        is_turned,
        ..Grid::new((0..columns * rows).map(places).collect(), columns)
    };
    let rim = |row: usize| row * columns + columns - 1;
    let (depth, drawn_in) = match (form, figure.build) {
        (Form::Gong, _) => (RIM[0], RIM[1]),
        (Form::Cymbal, _) => (EDGE, 0.0),
        (Form::Round, Build::Slab(thickness)) => (thickness, 0.0),
        _ => (0.0, 0.0),
    };
    if depth > 0.0 {
        let steps = if form == Form::Gong { 4 } else { 2 };
        let edge = |number: usize| {
            let [x, y, z] = surface.places[rim(number / steps)];
            let share = (number % steps) as f32 / (steps - 1) as f32;
            let wide = 1.0 - drawn_in * share * share;
            [x * wide, y * wide, z - depth * share]
        };
        let edge = Grid { is_closed: true, ..Grid::new((0..steps * rows).map(edge).collect(), steps) };
        mesh.add(&edge, |number, facet| figure.finish.seen(facet, moved.glow(rim(number / steps))));
    }
    // Rings that the lathe has left.
    let ring = |column: usize| if is_turned && figure.is_large() { 0.03 * ((7 * column) % 5) as f32 } else { 0.0 };
    mesh.add(&surface, |number, facet| {
        figure.finish.seen(facet, moved.glow(number)).lerp_to_gamma(Color32::BLACK, ring(number % columns))
    });
    let mut turned =
        |outline: &[[f32; 2]], finish: Finish| turn(mesh, outline, figure, |facet| finish.seen(facet, moved.still()));
    match form {
        Form::Bell => turned(&CROWN, figure.finish),
        Form::HandBell => turned(&GRIP, Finish::of("rosewood")),
        Form::Glass => turned(&STEM, figure.finish),
        _ => {}
    }
}

/// Adds a part of its own, with its outline from above.
fn turn(mesh: &mut Mesh, outline: &[[f32; 2]], figure: &Figure, colour: impl Fn(&Facet) -> Color32) {
    let columns = if figure.is_large() { 2 * outline.len() + 1 } else { outline.len() };
    let rows = if figure.is_large() { 33 } else { 13 };
    let place = |number: usize| {
        let [height, radius] = along(outline, (number % columns) as f32 / (columns - 1) as f32);
        let around = radius * Vec2::angled(TAU * (number / columns) as f32 / (rows - 1) as f32);
        [around.x, around.y, height]
    };
    let part = Grid { is_closed: true, ..Grid::new((0..columns * rows).map(place).collect(), columns) };
    mesh.add(&part, |_, facet| colour(facet));
}
