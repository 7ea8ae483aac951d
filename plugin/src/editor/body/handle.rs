//! The places of a body that can be taken hold of: where it is struck, and where it is heard.

use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::modes::table::replace;
use egui::{Vec2, vec2};
use sprung::params::Param;
use sprung::sound::bodies::Point;
use sprung_picture::{BodyShape, Form, Origin};

/// How far an arrow key moves a place, as a share of the body's length or of the way round it.
const STEP: f64 = 0.01;

/// A place that can be taken hold of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Handle {
    /// Where the body is struck.
    Strike,
    /// Where it is heard.
    Ear,
}

impl Handle {
    pub(super) const ALL: [Self; 2] = [Self::Strike, Self::Ear];

    /// Its name for accessibility.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Strike => "Struck body",
            Self::Ear => "Ear",
        }
    }

    /// Where it is; none if the sound has no such place, or if it cannot be changed.
    pub(super) fn place(self, shape: &BodyShape, shown: &Shown, controls: &Controls) -> Option<Point> {
        shown.preset()?;
        match (self, shape.origin.body()) {
            (Self::Strike, Some(body)) => Some(body.strike),
            (Self::Strike, None) if shape.figure.form.is_line() => {
                Some(Point { x: f64::from(controls.value(exciter(controls)?.info())) / 100.0, y: 0.0 })
            }
            // Where only the second of two bodies is heard, the place on the first does nothing.
            (Self::Ear, Some(body)) if shape.origin.pair().is_none_or(|pair| pair.heard < 1.0) => Some(body.pickup),
            _ => None,
        }
    }

    /// The place nearest to a point to which it can be moved.
    pub(super) fn confined(self, point: Point, shape: &BodyShape) -> Point {
        shape.confined(point, |body| if self == Self::Ear { body.pickup } else { body.strike })
    }

    /// The place so many steps of the arrow keys to the right and down from another.
    pub(super) fn stepped(self, from: Point, steps: Vec2, shape: &BodyShape) -> Point {
        let [right, down] = [steps.x, steps.y].map(|steps| STEP * f64::from(steps));
        // In front of a round body, on the side that one sees, the way round it leads to the left.
        let round = (from.y - right).rem_euclid(1.0);
        let (x, y) = match shape.figure.form {
            Form::Line | Form::Rod => (from.x + right, from.y),
            Form::Plate { .. } => (from.x + right, from.y + down),
            Form::Round | Form::Cymbal | Form::Gong => (from.x + down, round),
            Form::Bell | Form::HandBell => (from.x, round),
            Form::Bowl | Form::Glass => (from.x - down, round),
        };
        // On a string that has no body, the place is counted from the nearer end.
        let most = if shape.origin.body().is_some() { 1.0 } else { 0.5 };
        self.confined(Point { x: x.clamp(0.0, most), y: y.clamp(0.0, 1.0) }, shape)
    }

    /// Where it is, in words.
    pub(super) fn describe(self, point: Point, shape: &BodyShape) -> String {
        let what = if self == Self::Ear { "heard" } else { "struck" };
        let [x, y] = [point.x, point.y].map(|share| share * 100.0);
        match shape.figure.form {
            Form::Line | Form::Rod => format!("{what} at {x:.1} %"),
            Form::Bell | Form::HandBell => format!("{what} at {:.0}° round it", 3.6 * y),
            Form::Plate { .. } => format!("{what} at {x:.0} %, {y:.0} %"),
            _ => format!("{what} at {x:.0} %, {:.0}° round it", 3.6 * y),
        }
    }

    /// Changes the place in the sound. The turns of a knob by keys, which follow each other, become one step to undo.
    pub(super) fn write(self, point: Point, is_by_key: bool, origin: &mut Origin, controls: &mut Controls) {
        if let Some(body) = origin.body_mut() {
            *(if self == Self::Ear { &mut body.pickup } else { &mut body.strike }) = point;
            if let Ok(Some(modes)) = origin.modes() {
                replace(modes, controls);
            }
        } else if let Some(info) = exciter(controls).map(Param::info) {
            let position = info.normalise(100.0 * point.x as f32);
            if is_by_key { controls.nudge(info, position) } else { controls.turn(info, position) }
        }
    }
}

/// The arrow keys that were pressed, as steps to the right and down; those with Shift are ten times finer.
pub(super) fn arrows(ui: &egui::Ui) -> Vec2 {
    use egui::Key::{ArrowDown, ArrowLeft, ArrowRight, ArrowUp};
    ui.input(|input| {
        let pressed = |key| input.num_presses(key) as f32;
        let steps = vec2(pressed(ArrowRight) - pressed(ArrowLeft), pressed(ArrowDown) - pressed(ArrowUp));
        if input.modifiers.shift { 0.1 * steps } else { steps }
    })
}

/// The exciter that has a place, for a table of modes: the pluck if it is on, or else the bow if it is on.
fn exciter(controls: &Controls) -> Option<Param> {
    let levels = [(Param::PluckLevel, Param::PluckPosition), (Param::BowLevel, Param::BowPosition)];
    levels.into_iter().find(|(level, _)| controls.value(level.info()) > level.info().min).map(|(_, place)| place)
}
