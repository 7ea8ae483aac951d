//! The floor that a body stands on, which is its space: nothing, a plate, springs, or a room.

use emath::{Pos2, Rect, Vec2, pos2, vec2};
use sprung::params::Param;
use std::f32::consts::TAU;

/// Height of the floor's far edge, as a share of the stage's, and how much higher it is for each share of the travel by which the space
/// is larger than usual.
const HORIZON: f32 = 0.64;
const FARTHER: f32 = 0.24;

/// Where the floor is on a stage.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// All of the picture.
    pub stage: Rect,
    /// The part of it that nothing covers.
    pub middle: Rect,
    /// The height of the floor's far edge.
    pub far: f32,
    /// The ends of that, from left to right.
    pub ends: [f32; 2],
}

impl Floor {
    /// The floor of a stage, whose far edge stays within `middle`, for the position of the knob of the space's size if there is one.
    pub fn of(stage: Rect, middle: Rect, size: Option<f32>) -> Self {
        let usual = Param::SpaceSize.info().normalise(Param::SpaceSize.info().default) as f32;
        let larger = size.map_or(0.0, |size| size - usual);
        let edge = 0.36 * stage.width();
        // Not under the words at the sides.
        let ends = [(stage.center().x - edge).max(middle.left()), (stage.center().x + edge).min(middle.right())];
        Self { stage, middle, far: stage.top() + (HORIZON - FARTHER * larger) * stage.height(), ends }
    }

    /// How strongly the waves of a space glow that is mixed in by a share, and how much of that is by the level that sounds, a share of
    /// the 60 dB below full scale; all from 0 to 1.
    pub fn glow(mix: f32, level: f32) -> [f32; 2] {
        let rest = 0.15 + 0.6 * mix;
        let glow = (level * mix.sqrt()).clamp(0.0, 1.0);
        [rest + (1.0 - rest) * glow, glow]
    }

    /// The part of the stage in which it lies.
    pub fn lying(&self) -> Rect {
        self.stage.with_min_y(self.far)
    }

    /// The ends of its far edge, and the corners in front, around it.
    pub fn corners(&self) -> [Pos2; 4] {
        let [left, right] = self.ends;
        [pos2(left, self.far), pos2(right, self.far), self.stage.right_bottom(), self.stage.left_bottom()]
    }

    /// The shadow of a body where there is no space, around it.
    pub fn shadow(&self) -> Vec<Pos2> {
        self.circle(0.14 * self.stage.width(), 0.22, 32)
    }

    /// The lines of a space, by its value: a sheet's waves, which reach beyond where it is [`Self::lying`]; coils; or the edges of a room.
    pub fn lines(&self, space: usize) -> Vec<Vec<Pos2>> {
        match space {
            1 => (1..=5).map(|ring| self.circle(ring as f32 * 0.095 * self.middle.width(), 0.26, 48)).collect(),
            2 => {
                let depth = self.stage.bottom() - self.far;
                (0..3).map(|coil| self.coil(self.far + depth * (0.2 + 0.22 * coil as f32))).collect()
            }
            3 => self.room(),
            _ => vec![],
        }
    }

    /// A circle that lies on the floor below the body, as flat as it is seen; its end is its beginning.
    fn circle(&self, radius: f32, flatness: f32, corners: usize) -> Vec<Pos2> {
        let centre = pos2(self.middle.center().x, self.stage.top() + 0.84 * self.stage.height());
        let round = |corner: usize| Vec2::angled(TAU * (corner % corners) as f32 / corners as f32);
        (0..=corners).map(|corner| centre + vec2(1.0, flatness) * (radius * round(corner))).collect()
    }

    fn coil(&self, y: f32) -> Vec<Pos2> {
        let [left, right] = self.ends;
        let point = |step: usize| {
            let off = 5.0 * Vec2::angled(TAU * step as f32 / 6.0).y;
            pos2(left + (right - left) * step as f32 / 240.0, y + off)
        };
        (0..=240).map(point).collect()
    }

    fn room(&self) -> Vec<Vec<Pos2>> {
        let (stage, far, [left, right]) = (self.stage, self.far, self.ends);
        let top = stage.top() + 0.06 * stage.height();
        let board = |share: f32| {
            vec![pos2(left + (right - left) * share, far), pos2(stage.left() + stage.width() * share, stage.bottom())]
        };
        let mut lines = vec![
            vec![pos2(left, far), pos2(left, top), pos2(right, top), pos2(right, far)],
            vec![pos2(left, top), stage.left_top()],
            vec![pos2(right, top), stage.right_top()],
        ];
        lines.extend([0.2, 0.4, 0.6, 0.8].map(board));
        lines
    }
}
