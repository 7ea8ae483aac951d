//! Tubes: a round wall, and the open end at the right.

use crate::figure::{CAP, Figure, Tube};
use crate::light::{Facet, Finish};
use crate::mesh::{ABOVE, Grid, Mesh, Moved};
use crate::view::lying;
use ecolor::Color32;
use emath::Vec2;
use std::f32::consts::TAU;

/// Thickness of the wall, as a share of the radius.
const WALL: f32 = 0.14;

/// The half of a ring round a tube that is seen.
pub(crate) fn around(tube: &Tube, share: f32, up: f32) -> [[f32; 3]; 9] {
    std::array::from_fn(|step| {
        // From the far upper side to the near lower one.
        let around = 1.01 * radius(tube, share) * Vec2::angled(TAU * (step as f32 / 16.0 - 0.16));
        lying([2.0 * share - 1.0, around.x], up - around.y)
    })
}

fn radius(tube: &Tube, share: f32) -> f32 {
    let [left, right] = tube.radius;
    let flare = (tube.mouth() - right) * (0..3).fold(share, |power, _| power * power);
    left + (right - left) * share + flare
}

/// Adds a tube.
pub(crate) fn add_tube(mesh: &mut Mesh, figure: &Figure, tube: &Tube, moved: &Moved) {
    let columns = figure.points.len();
    let last = columns - 1;
    let rows = if figure.is_large() { 33 } else { 13 };
    let share = |column: usize| figure.points[column].x as f32;
    let radius = |share: f32| radius(tube, share);
    let ring = |along: f32, radius: f32, row: usize, up: f32| {
        let around = radius * Vec2::angled(-TAU * row as f32 / (rows - 1) as f32);
        lying([along, around.x], up + around.y)
    };
    let grid = |columns: usize, place: &dyn Fn(usize, usize) -> [f32; 3]| {
        let places = (0..columns * rows).map(|number| place(number % columns, number / columns));
        Grid { is_closed: true, ..Grid::new(places.collect(), columns) }
    };
    let wall =
        grid(columns, &|column, row| ring(2.0 * share(column) - 1.0, radius(share(column)), row, moved.by(column)));
    let finish = figure.finish;
    mesh.add(&wall, |number, facet| finish.seen(facet, moved.glow(number % columns)));
    if tube.has_cap {
        let wide = CAP * tube.radius[0];
        let cap =
            grid(3, &|column, row| ring([-1.0, -1.0, -0.93][column], [0.0, wide, wide][column], row, moved.by(0)));
        let cap = Grid { lift: 0.05, ..cap };
        mesh.add(&cap, |_, facet| finish.seen(facet, moved.still()));
        let face = grid(2, &|column, row| ring(-0.93, [wide, tube.radius[0]][column], row, moved.by(0)));
        mesh.add(&Grid { lift: 0.05, ..face }, |_, facet| finish.seen(facet, moved.still()));
    }
    let mouth = radius(1.0);
    let rim = grid(2, &|column, row| ring(1.0, mouth * [1.0, 1.0 - WALL][column], row, moved.by(last)));
    let bright = |facet: &Facet, glow| finish.seen(facet, glow).lerp_to_gamma(Color32::WHITE, 0.15);
    mesh.add(&Grid { lift: ABOVE, ..rim }, |_, facet| bright(facet, moved.glow(last)));
    let inside = grid(2, &|column, row| ring(1.0, mouth * [1.0 - WALL, 0.0][column], row, moved.by(last)));
    let dark = Finish { tint: finish.tint, ..Finish::of("rubber") };
    mesh.add(&Grid { lift: ABOVE, ..inside }, |number, _| {
        // The light falls on the wall inside at the far lower side.
        let around = Vec2::angled(-TAU * (number / 2) as f32 / (rows - 1) as f32);
        let light = if number % 2 == 0 { 0.1 + 0.22 * (-around.y - 0.3 * around.x).max(0.0) } else { 0.05 };
        Color32::BLACK.lerp_to_gamma(dark.tint, light)
    });
}
