//! The forms of bodies in the picture: where their points are at rest, and which way they move.

use crate::outline::{BELL, BOWL, CYMBAL, GLASS, GONG, along};
use crate::view::{LOOK, TURN, View, lying};
use emath::{Pos2, Rect, Vec2, vec2};
use sprung::sound::bodies::{Model, Point};
use std::f32::consts::TAU;

/// How far above and below a line its places are still pointed at, in pixels: a string is thin.
const AROUND_LINE: f32 = 60.0;

/// The form of a body. The coordinates of its points are those of [`Model`]: `x` and `y` from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A string.
    Line,
    /// A bar or a tube, which lies in space.
    Rod,
    /// A head or a flat round plate.
    Round,
    /// A cymbal, with its small bell up.
    Cymbal,
    /// A gong, with its boss up.
    Gong,
    /// A plate, with the length of its side along `x` over that along `y`.
    Plate {
        /// Length over length.
        aspect: f32,
    },
    /// A bell, whose rim is below.
    Bell,
    /// A bell with a grip.
    HandBell,
    /// A bowl, whose rim is above.
    Bowl,
    /// A glass on its foot.
    Glass,
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
            Model::String => Self::Line,
            Model::Membrane | Model::Timpani(_) | Model::Disc { .. } => Self::Round,
            Model::Plate { aspect, .. } => Self::Plate { aspect: *aspect as f32 },
            Model::Bed(_) => Self::Plate { aspect: 1.5 },
            Model::ChurchBell => Self::Bell,
            Model::HandBell => Self::HandBell,
            Model::Glass { .. } => Self::Glass,
            Model::Bowl => Self::Bowl,
            Model::Mass | Model::Custom(_) => Self::Line,
            _ => Self::Rod,
        }
    }

    /// Whether all points lie along one line.
    pub fn is_line(self) -> bool {
        matches!(self, Self::Line | Self::Rod)
    }

    /// Whether it is a bell.
    pub fn is_bell(self) -> bool {
        matches!(self, Self::Bell | Self::HandBell)
    }

    /// Half its width, in the picture's unit.
    pub(crate) fn half_width(self) -> f32 {
        match self {
            Self::Plate { aspect } => across(aspect)[0],
            Self::Bell | Self::HandBell => 0.72,
            Self::Bowl => 0.96,
            Self::Glass => 0.53,
            _ => 1.0,
        }
    }

    /// Where another body is joined to it, at its right, with its right end displaced.
    pub(crate) fn joint(self, displacement: f32) -> [f32; 3] {
        match self {
            Self::Line => self.in_space(Point { x: 1.0, y: 0.0 }, displacement),
            Self::Rod => self.in_space(Point { x: 1.0, y: 0.0 }, displacement - 0.05),
            Self::Plate { .. } => self.in_space(Point { x: 1.0, y: 0.5 }, -0.02),
            Self::Bell | Self::HandBell => [0.7, 0.0, 0.05],
            Self::Bowl => [0.86, 0.0, 0.42],
            Self::Glass => [0.41, 0.0, 0.01],
            _ => [1.0, 0.0, -0.02],
        }
    }

    /// Whether one looks into it.
    pub(crate) fn is_open(self) -> bool {
        matches!(self, Self::Bowl | Self::Glass)
    }

    /// How many points a large picture has along `x` and along `y`.
    pub fn grid(self) -> [usize; 2] {
        match self {
            Self::Line => [97, 1],
            Self::Rod => [65, 1],
            Self::Round => [15, 61],
            Self::Cymbal | Self::Gong => [23, 61],
            Self::Plate { .. } => [31, 21],
            Self::Bell | Self::HandBell => [28, 81],
            Self::Bowl | Self::Glass => [20, 61],
        }
    }

    /// How many a picture of the size of a letter or two has.
    pub(crate) fn small_grid(self) -> [usize; 2] {
        match self {
            Self::Line => [33, 1],
            Self::Rod => [9, 1],
            Self::Round => [3, 25],
            Self::Cymbal | Self::Gong => [9, 25],
            Self::Plate { .. } => [9, 3],
            Self::Bell | Self::HandBell => [10, 25],
            Self::Bowl | Self::Glass => [8, 25],
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
        if self.is_bell() { (point.x * point.x) as f32 } else { 1.0 }
    }

    fn place(self, point: Point) -> Place {
        let (x, y) = (point.x as f32, point.y as f32);
        let up = [0.0, 0.0, 1.0];
        let turned = |[height, radius]: [f32; 2]| {
            // The default place of the strike is in front.
            let around = Vec2::angled(TAU * (y + 0.25));
            Place { at: [radius * around.x, radius * around.y, height], normal: [around.x, around.y, 0.0] }
        };
        match self {
            Self::Line => Place { at: [2.0 * x - 1.0, 0.0, 0.0], normal: up },
            Self::Rod => Place { at: lying([2.0 * x - 1.0, 0.0], 0.0), normal: up },
            Self::Round => Place { normal: up, ..turned([0.0, x]) },
            Self::Cymbal => Place { normal: up, ..turned([along(&CYMBAL, x)[0], x]) },
            Self::Gong => Place { normal: up, ..turned([along(&GONG, x)[0], x]) },
            Self::Plate { aspect } => {
                let [width, depth] = sides(aspect);
                Place { at: lying([(2.0 * x - 1.0) * width, (2.0 * y - 1.0) * depth], 0.0), normal: up }
            }
            Self::Bell | Self::HandBell => turned(along(&BELL, x)),
            Self::Bowl => turned(along(&BOWL, x)),
            Self::Glass => turned(along(&GLASS, x)),
        }
    }

    /// Where a point is in space: to the right, to the viewer, and up. The displacement is in the picture's unit.
    pub fn in_space(self, point: Point, displacement: f32) -> [f32; 3] {
        let Place { at, normal } = self.place(point);
        std::array::from_fn(|axis| at[axis] + normal[axis] * displacement)
    }

    /// Where a point is in the picture. The displacement is in the picture's unit.
    pub fn on(self, rect: Rect, point: Point, displacement: f32) -> Pos2 {
        self.view(rect).at(self.in_space(point, displacement))
    }

    /// How it is seen in a picture of this size.
    pub(crate) fn view(self, rect: Rect) -> View {
        let (unit, middle) = self.scale(rect);
        View { unit, origin: rect.center() + vec2(0.0, unit * middle * LOOK[1]) }
    }

    /// Size of the picture's unit in pixels, and the height in space that is shown in the middle.
    fn scale(self, rect: Rect) -> (f32, f32) {
        let [width, height] = [rect.width() / 2.0, rect.height() / 2.0];
        // Leaves room for displacements up and down, and for what belongs to a body beyond its points.
        match self {
            Self::Line => (width * 0.92, 0.0),
            Self::Rod => ((width * 0.94).min(height / 0.52), -0.05),
            Self::Round => ((width * 0.9).min(height / 0.8), 0.0),
            Self::Cymbal => ((width * 0.9).min(height / 0.8), 0.02),
            Self::Gong => ((width * 0.9).min(height / 0.86), -0.06),
            Self::Plate { aspect } => {
                let [across, down] = across(aspect);
                ((width * 0.95 / across).min(height / (0.28 + down * LOOK[0])), -0.02)
            }
            Self::Bell => ((width * 0.85).min(height / 0.92), 0.53),
            Self::HandBell => ((width * 0.85).min(height / 1.14), 0.8),
            Self::Bowl => ((width * 0.85).min(height / 1.05), 0.5),
            Self::Glass => ((width * 0.85).min(height / 1.04), 0.82),
        }
    }

    /// The size of a picture in which a unit of [`Form::Round`] has so many pixels.
    pub(crate) fn round_size(unit: f32) -> Vec2 {
        vec2(2.0 * unit / 0.9, 1.6 * unit)
    }

    /// The largest displacement that the picture shows, in its unit.
    pub fn reach(self, rect: Rect) -> f32 {
        match self {
            Self::Line => 0.39 * rect.height() / self.scale(rect).0,
            Self::Rod => 0.2,
            Self::Round | Self::Plate { .. } => 0.28,
            // More would bend a stiff disc out of all recognition.
            Self::Cymbal | Self::Gong => 0.14,
            Self::Bell | Self::HandBell | Self::Bowl => 0.16,
            Self::Glass => 0.1,
        }
    }

    /// Whether a point lies behind others, so that its lines are not drawn and it cannot be touched.
    pub fn is_behind(self, point: Point) -> bool {
        self.hides(&self.place(point))
    }

    fn hides(self, place: &Place) -> bool {
        (self.is_bell() || self.is_open()) && place.normal[1] < -0.05
    }

    /// The point at rest that is nearest to a place in the picture, and how far away it is in pixels.
    pub fn nearest(self, rect: Rect, place: Pos2) -> (Point, f32) {
        const STEPS: usize = 100;
        let rows = if self.is_line() { 1 } else { STEPS + 1 };
        let point = |step: usize| Point {
            x: (step % (STEPS + 1)) as f64 / STEPS as f64,
            y: (step / (STEPS + 1)) as f64 / STEPS as f64,
        };
        let view = self.view(rect);
        let far = |at: [f32; 3]| {
            let off = view.at(at) - place;
            // Near a line, only the distance in its direction counts.
            if self.is_line() {
                vec2(off.x, (off.y.abs() - (rect.height() / 2.0).min(AROUND_LINE)).max(0.0)).length()
            } else {
                off.length()
            }
        };
        let mut best = (Point { x: 0.0, y: 0.0 }, f32::INFINITY);
        for point in (0..(STEPS + 1) * rows).map(point) {
            let there = self.place(point);
            let distance = far(there.at);
            if distance < best.1 && !self.hides(&there) {
                best = (point, distance);
            }
        }
        best
    }
}

/// Half the sides of a plate.
fn sides(aspect: f32) -> [f32; 2] {
    if aspect >= 1.0 { [1.0, 1.0 / aspect] } else { [aspect, 1.0] }
}

/// Half the width and depth of a plate as it lies.
fn across(aspect: f32) -> [f32; 2] {
    let [x, y] = sides(aspect);
    [x * TURN[0] + y * TURN[1], x * TURN[1] + y * TURN[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use emath::pos2;

    #[test]
    fn every_point_is_in_the_picture_and_found_again() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(360.0, 240.0));
        let forms = [
            Form::Line,
            Form::Rod,
            Form::Round,
            Form::Cymbal,
            Form::Gong,
            Form::Plate { aspect: 2.0 },
            Form::Plate { aspect: 0.5 },
            Form::Bell,
            Form::HandBell,
            Form::Bowl,
            Form::Glass,
        ];
        for form in forms {
            for (index, point) in Form::points(form.grid()).into_iter().enumerate() {
                for displacement in [-1.0, 0.0, 1.0] {
                    let at = form.on(rect, point, displacement * form.reach(rect));
                    assert!(rect.contains(at), "{form:?} {point:?} {displacement}: {at:?}");
                }
                // Each search looks at ten thousand points. No grid has columns by the eleven, so that all columns have their turn.
                if index % 11 == 0 && !form.is_behind(point) {
                    let at = form.on(rect, point, 0.0);
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
