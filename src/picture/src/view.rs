//! How the picture looks on space: to the right, to the viewer, and up.

use emath::{Pos2, vec2};

/// How steeply the picture looks down on a body: sine and cosine of the angle.
pub(crate) const LOOK: [f32; 2] = [0.5, 0.866];
/// The direction from which the picture looks.
pub(crate) const VIEW: [f32; 3] = [0.0, LOOK[1], LOOK[0]];
/// Which way bars, tubes and plates lie, whose right end is nearer to the viewer: cosine and sine of the angle.
pub(crate) const TURN: [f32; 2] = [0.94, 0.34];

/// How places in space are seen in a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Where the origin of space is.
    pub origin: Pos2,
    /// Size of the unit in pixels.
    pub unit: f32,
}

impl View {
    /// Where a place in space is in the picture.
    pub(crate) fn at(&self, [x, y, z]: [f32; 3]) -> Pos2 {
        self.origin + self.unit * vec2(x, y * LOOK[0] - z * LOOK[1])
    }
}

/// A place of a body that lies turned: along it, across it to the viewer, and up.
pub(crate) fn lying([along, across]: [f32; 2], up: f32) -> [f32; 3] {
    let [cosine, sine] = TURN;
    [along * cosine - across * sine, along * sine + across * cosine, up]
}
