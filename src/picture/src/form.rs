//! The forms of bodies in the picture: where their points are at rest, and which way they move.

use emath::{Pos2, Rect, Vec2, pos2, vec2};
use sprung::sound::bodies::{Model, Point};
use std::f32::consts::TAU;

/// How steeply the picture looks down on a body: sine and cosine of the angle.
pub(crate) const LOOK: [f32; 2] = [0.5, 0.866];
/// The direction from which the picture looks.
pub(crate) const VIEW: [f32; 3] = [0.0, LOOK[1], LOOK[0]];
/// The outline of a bell from its crown to its rim: height and radius.
const BELL: [[f32; 2]; 8] =
    [[1.0, 0.0], [0.99, 0.24], [0.91, 0.35], [0.7, 0.39], [0.46, 0.44], [0.25, 0.52], [0.09, 0.62], [0.0, 0.72]];
/// The outline of a bowl or a glass, from the bottom to the rim.
const BOWL: [[f32; 2]; 8] =
    [[0.0, 0.0], [0.02, 0.3], [0.1, 0.56], [0.24, 0.74], [0.42, 0.86], [0.62, 0.92], [0.82, 0.95], [1.0, 0.96]];

/// The form of a body. The coordinates of its points are those of [`Model`]: `x` and `y` from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A string, a bar, the air in a tube.
    Line,
    /// A head or a round plate.
    Round,
    /// A plate, with the length of its side along `x` over that along `y`.
    Plate {
        /// Length over length.
        aspect: f32,
    },
    /// A bell, whose rim is below.
    Bell,
    /// A bowl or a glass, whose rim is above.
    Bowl,
}

/// A point in space, with the direction in which it moves.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [f32; 3],
    normal: [f32; 3],
}

impl Form {
    /// The form of a model.
    pub fn of(model: &Model) -> Self {
        match model {
            Model::Membrane | Model::Timpani(_) | Model::Disc { .. } => Self::Round,
            Model::Plate { aspect, .. } => Self::Plate { aspect: *aspect as f32 },
            Model::Bed(_) => Self::Plate { aspect: 1.5 },
            Model::ChurchBell | Model::HandBell => Self::Bell,
            Model::Glass { .. } | Model::Bowl => Self::Bowl,
            _ => Self::Line,
        }
    }

    /// How many points a picture has along `x` and along `y`.
    pub fn grid(self) -> [usize; 2] {
        match self {
            Self::Line => [97, 1],
            Self::Round => [15, 61],
            Self::Plate { .. } => [31, 21],
            Self::Bell | Self::Bowl => [22, 61],
        }
    }

    /// The points of a grid, those along `x` one after the other.
    pub fn points([columns, rows]: [usize; 2]) -> Vec<Point> {
        let share = |place: usize, count: usize| if count > 1 { place as f64 / (count - 1) as f64 } else { 0.0 };
        let point = |place: usize| Point { x: share(place % columns, columns), y: share(place / columns, rows) };
        (0..columns * rows).map(point).collect()
    }

    /// Factor for the drawn displacement at a point. A bell's crown hardly moves; its model does not contain this,
    /// since its modes were measured at the rim.
    pub fn weight(self, point: Point) -> f32 {
        if self == Self::Bell { (point.x * point.x) as f32 } else { 1.0 }
    }

    fn place(self, point: Point) -> Place {
        let (x, y) = (point.x as f32, point.y as f32);
        let turned = |[height, radius]: [f32; 2]| {
            // The default place of the strike is in front.
            let around = Vec2::angled(TAU * (y + 0.25));
            Place { at: [radius * around.x, radius * around.y, height], normal: [around.x, around.y, 0.0] }
        };
        match self {
            Self::Line => Place { at: [2.0 * x - 1.0, 0.0, 0.0], normal: [0.0, 0.0, 1.0] },
            Self::Round => Place { normal: [0.0, 0.0, 1.0], ..turned([0.0, x]) },
            Self::Plate { aspect } => {
                let [width, depth] = if aspect >= 1.0 { [1.0, 1.0 / aspect] } else { [aspect, 1.0] };
                Place { at: [(2.0 * x - 1.0) * width, (2.0 * y - 1.0) * depth, 0.0], normal: [0.0, 0.0, 1.0] }
            }
            Self::Bell => turned(along(&BELL, x)),
            Self::Bowl => turned(along(&BOWL, x)),
        }
    }

    /// Where a point is in space: to the right, to the viewer, and up. The displacement is in the picture's unit.
    pub fn in_space(self, point: Point, displacement: f32) -> [f32; 3] {
        let Place { at, normal } = self.place(point);
        std::array::from_fn(|axis| at[axis] + normal[axis] * displacement)
    }

    /// Where a point is in the picture. The displacement is in the picture's unit.
    pub fn on(self, rect: Rect, point: Point, displacement: f32) -> Pos2 {
        let [x, y, z] = self.in_space(point, displacement);
        let [sine, cosine] = LOOK;
        let (unit, middle) = self.scale(rect);
        match self {
            Self::Line => pos2(rect.center().x + x * unit, rect.center().y - z * unit),
            _ => pos2(rect.center().x + x * unit, rect.center().y + unit * (y * sine - (z - middle) * cosine)),
        }
    }

    /// Size of the picture's unit in pixels, and the height in space that is shown in the middle.
    fn scale(self, rect: Rect) -> (f32, f32) {
        let [width, height] = [rect.width() / 2.0, rect.height() / 2.0];
        match self {
            Self::Line => (width * 0.92, 0.0),
            // Leaves room for displacements up and down.
            Self::Round => ((width * 0.9).min(height / 0.8), 0.0),
            Self::Plate { .. } => ((width * 0.9).min(height / 0.8), 0.0),
            Self::Bell => ((width * 0.85).min(height / 0.9), 0.5),
            Self::Bowl => ((width * 0.85).min(height / 1.05), 0.5),
        }
    }

    /// The size of a picture in which a unit of [`Form::Round`] has so many pixels.
    pub(crate) fn round_size(unit: f32) -> Vec2 {
        vec2(2.0 * unit / 0.9, 1.6 * unit)
    }

    /// The largest displacement that the picture shows, in its unit.
    pub fn reach(self, rect: Rect) -> f32 {
        match self {
            Self::Line => 0.34 * rect.height() / self.scale(rect).0,
            Self::Round | Self::Plate { .. } => 0.28,
            Self::Bell | Self::Bowl => 0.16,
        }
    }

    /// Whether a point lies behind others, so that its lines are not drawn and it cannot be touched.
    pub fn is_behind(self, point: Point) -> bool {
        matches!(self, Self::Bell | Self::Bowl) && self.place(point).normal[1] < -0.05
    }

    /// The point at rest that is nearest to a place in the picture, and how far away it is in pixels.
    pub fn nearest(self, rect: Rect, place: Pos2) -> (Point, f32) {
        const STEPS: usize = 100;
        let rows = if self == Self::Line { 1 } else { STEPS + 1 };
        let point = |step: usize| Point {
            x: (step % (STEPS + 1)) as f64 / STEPS as f64,
            y: (step / (STEPS + 1)) as f64 / STEPS as f64,
        };
        let points = (0..(STEPS + 1) * rows).map(point).filter(|point| !self.is_behind(*point));
        let far = |point: &Point| {
            let off = self.on(rect, *point, 0.0) - place;
            // Along a line, only the distance in the line's direction counts.
            if self == Self::Line {
                vec2(off.x, (off.y.abs() - rect.height() / 2.0).max(0.0)).length()
            } else {
                off.length()
            }
        };
        let mut best = (Point { x: 0.0, y: 0.0 }, f32::INFINITY);
        for point in points {
            let distance = far(&point);
            if distance < best.1 {
                best = (point, distance);
            }
        }
        best
    }
}

/// The point of the outline at a share of its length, on a smooth curve through all of its points (Catmull and Rom).
fn along(outline: &[[f32; 2]], share: f32) -> [f32; 2] {
    let place = share.clamp(0.0, 1.0) * (outline.len() - 1) as f32;
    let before = (place as usize).min(outline.len() - 2);
    let t = place - before as f32;
    std::array::from_fn(|axis| {
        let at = |place: usize| outline[place.min(outline.len() - 1)][axis];
        let [a, b, c, d] = [at(before.saturating_sub(1)), at(before), at(before + 1), at(before + 2)];
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_in_the_picture_and_found_again() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(360.0, 240.0));
        for form in
            [Form::Line, Form::Round, Form::Plate { aspect: 2.0 }, Form::Plate { aspect: 0.5 }, Form::Bell, Form::Bowl]
        {
            for point in Form::points(form.grid()) {
                for displacement in [-1.0, 0.0, 1.0] {
                    let at = form.on(rect, point, displacement * form.reach(rect));
                    assert!(rect.contains(at), "{form:?} {point:?} {displacement}: {at:?}");
                }
                let at = form.on(rect, point, 0.0);
                if !form.is_behind(point) {
                    let (found, distance) = form.nearest(rect, at);
                    assert!(
                        distance < 6.0 && (form.on(rect, found, 0.0) - at).length() < 6.0,
                        "{form:?} {point:?} {found:?}"
                    );
                    let is_edge = matches!(form, Form::Plate { .. }) && point.y == 1.0;
                    assert!(!is_edge || found.y == 1.0, "{form:?} {point:?} {found:?}");
                }
            }
        }
    }
}
