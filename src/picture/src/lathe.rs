//! Bodies that are turned round an axis: heads, discs, cymbals, gongs, bells, bowls and glasses.

use crate::figure::{Build, Figure};
use crate::form::Form;
use crate::light::Finish;
use crate::mesh::{ABOVE, Grid, Mesh, Moved};
use crate::outline::{CROWN, GRIP, ROD, STEM, along};
use ecolor::Color32;
use emath::Vec2;
use std::f32::consts::TAU;

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
    let mut band = |heights: &[f32], radii: &[f32], finish: Finish| {
        let steps = heights.len();
        let place = |number: usize| {
            let [x, y, z] = surface.places[rim(number / steps)];
            let radius = radii[number % steps];
            [x * radius, y * radius, z + heights[number % steps]]
        };
        let band = Grid { is_closed: true, ..Grid::new((0..steps * rows).map(place).collect(), steps) };
        mesh.add(&band, |number, facet| finish.seen(facet, moved.glow(rim(number / steps))));
    };
    match (form, figure.build) {
        (Form::Gong, _) => band(&[0.0, -0.06, -0.12, -0.17], &[1.0, 1.0, 0.99, 0.975], figure.finish),
        (Form::Cymbal, Build::Hat) => {
            band(&[-0.08, -0.08, -0.11], &[0.95, 1.0, 1.0], figure.finish);
            band(&[-0.03, -0.08], &[0.96, 0.96], Finish::of("rubber"));
            band(&[0.0, -0.03], &[1.0, 1.0], figure.finish);
        }
        (Form::Cymbal, _) => band(&[0.0, -0.03], &[1.0, 1.0], figure.finish),
        (Form::Round, Build::Slab(thickness)) => band(&[0.0, -thickness], &[1.0, 1.0], figure.finish),
        _ => {}
    }
    // Rings that the lathe has left.
    let ring = |column: usize| if is_turned && figure.is_large() { 0.03 * ((7 * column) % 5) as f32 } else { 0.0 };
    mesh.add(&surface, |number, facet| {
        figure.finish.seen(facet, moved.glow(number)).lerp_to_gamma(Color32::BLACK, ring(number % columns))
    });
    let (outline, finish, lift): (&[[f32; 2]], _, _) = match form {
        Form::Bell => (&CROWN, figure.finish, ABOVE),
        Form::HandBell => (&GRIP, Finish::of("rosewood"), ABOVE),
        Form::Glass => (&STEM, figure.finish, -ABOVE),
        Form::Cymbal if figure.build == Build::Hat => (&ROD, Finish::of("steel"), ABOVE),
        _ => return,
    };
    mesh.add(&turned(outline, lift, figure.is_large()), |_, facet| finish.seen(facet, moved.still()));
}

/// A part of its own, with its outline from above.
fn turned(outline: &[[f32; 2]], lift: f32, is_large: bool) -> Grid {
    let (columns, rows) = if is_large { (2 * outline.len() + 1, 33) } else { (outline.len(), 13) };
    let place = |number: usize| {
        let [height, radius] = along(outline, (number % columns) as f32 / (columns - 1) as f32);
        let around = radius * Vec2::angled(TAU * (number / columns) as f32 / (rows - 1) as f32);
        [around.x, around.y, height]
    };
    Grid { is_closed: true, lift, ..Grid::new((0..columns * rows).map(place).collect(), columns) }
}
