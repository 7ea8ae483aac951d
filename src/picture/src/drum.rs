//! The shell below the head of a drum, its hoop, and the wires of a snare drum.

use crate::figure::Drum;
use crate::form::Form;
use crate::light::Finish;
use crate::mesh::{ABOVE, Grid, Mesh, Moved};
use crate::view::{LOOK, View};
use emath::{Pos2, Rect, Vec2, vec2};
use std::f32::consts::TAU;

/// Flat pieces all round, and the height of the hoop.
const PIECES: usize = 32;
const HOOP: f32 = 0.1;
/// Where the wires lie in front of and behind the middle of the head.
const WIRES: [f32; 3] = [-0.45, 0.0, 0.45];

/// What a head is on that is not known to be a drum's.
pub(crate) const FRAME: Drum = Drum { depth: 0.26, size: 1.0, shell: "maple", has_wires: false };

/// Where the picture of the head is.
pub(crate) fn head(rect: Rect, drum: Drum) -> Rect {
    let [sine, cosine] = LOOK;
    let height = drum.depth * cosine;
    let unit = drum.size * (0.45 * rect.width()).min(0.45 * rect.height() / (sine + 0.5 * height));
    Rect::from_center_size(rect.center() - 0.5 * vec2(0.0, unit * height), Form::round_size(unit))
}

/// Adds the shell and the hoop.
pub(crate) fn add(mesh: &mut Mesh, drum: Drum, moved: &Moved) {
    let mut ring = |heights: &[f32], radii: &[f32], lift: f32, finish: Finish| {
        let columns = heights.len();
        let place = |number: usize| {
            let around = radii[number % columns] * Vec2::angled(TAU * (number / columns) as f32 / PIECES as f32);
            [around.x, around.y, heights[number % columns]]
        };
        let places = (0..columns * (PIECES + 1)).map(place).collect();
        let ring = Grid { is_closed: true, lift, ..Grid::new(places, columns) };
        mesh.add(&ring, |_, facet| finish.seen(facet, moved.still()));
    };
    ring(&[0.0, -drum.depth], &[0.97, 0.97], 0.0, Finish::of(drum.shell));
    ring(&[0.01, 0.01, -HOOP], &[0.94, 1.0, 1.0], ABOVE, Finish::of("aluminium"));
}

/// The wires of a snare drum as they are seen through its head.
pub(crate) fn wires(view: &View) -> impl Iterator<Item = Vec<Pos2>> {
    WIRES.into_iter().map(|y| [-0.94, 0.94].map(|side| view.at([side * (1.0 - y * y).sqrt(), y, 0.0])).to_vec())
}
