//! Shows the body's motion in slow motion, and where it is struck.

use super::edit::rest;
use super::face;
use crate::editor::controls::gestures::touch;
use crate::editor::controls::shown::{Shown, Subject};
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::modes::table::replace;
use crate::editor::theme::RADIUS;
use crate::editor::widgets::outline;
use crate::loaded::Loaded;
use egui::{CursorIcon, Id, Rect, Role, Sense, Ui, WidgetInfo};
use sprung::params::Param;
use sprung::sound::bodies::Point;
use sprung_picture::{BodyShape, Form, Origin, Pose, REACH, Swing};
use std::sync::Arc;

/// A drag of the strike's place in progress.
struct Drag {
    point: Point,
    written: Option<Point>,
    /// The velocity of its first strike.
    velocity: Option<f32>,
    /// When the sound may be changed again.
    next: f64,
    /// The sound that was written last. If another sound is loaded, the drag is over.
    loaded: Arc<Loaded>,
}

/// The picture's state.
#[derive(Default)]
pub(crate) struct BodyView {
    shape: Option<(Subject, BodyShape)>,
    swing: Swing,
    drag: Option<Drag>,
}

impl BodyView {
    /// Drops the drag, if there is one.
    pub(crate) fn cancel(&mut self, controls: &mut Controls) {
        if self.drag.take().is_some() {
            controls.release();
            controls.history.cancel();
        }
    }

    /// Whether the body that was shown has a place to be struck at.
    pub(crate) fn has_place(&self, shown: &Shown, controls: &Controls) -> bool {
        self.shape.as_ref().is_some_and(|(_, shape)| strike(shape, shown, controls).is_some())
    }

    /// Shows the body of a sound. Returns the caption.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        shown: &Shown,
        energies: &[f32],
        audition: &mut Audition,
        controls: &mut Controls,
    ) -> String {
        if self.drag.as_ref().is_some_and(|drag| !Arc::ptr_eq(&drag.loaded, shown.loaded())) {
            self.cancel(controls);
            audition.release(controls.params.link());
        }
        let mut shape = match self.shape.take() {
            Some((subject, shape)) if subject == shown.subject() => shape,
            _ => BodyShape::of(&shown.patch().modes, shown.family(), shown.tags()),
        };
        let mut subject = shown.subject();
        if strike(&shape, shown, controls).is_some() {
            self.touch(ui, rect, &mut shape, shown, audition, controls);
            // While the strike is dragged, the shapes stay as they are.
            if let Some(drag) = &self.drag {
                subject.0 = drag.loaded.clone();
            }
        }
        let seconds = (!controls.params.view().less_motion).then_some(controls.seconds);
        let moved = self.swing.advance(seconds, &shape, energies, rect);
        let place = self.drag.as_ref().map(|drag| drag.point).or(strike(&shape, shown, controls));
        let pose = Pose { displacements: &moved, nodal: shape.lines_of(energies), strike: place };
        face::paint(ui.painter(), rect, &shape.figure, &pose, controls.palette);
        if shape.origin == Origin::Table && shown.preset().is_some() {
            face::paint_guess(ui.painter(), rect, &shape.figure, controls.palette);
        }
        let caption = shape.caption.clone();
        self.shape = Some((subject, shape));
        caption
    }

    /// Follows the pointer, which moves the place of the strike.
    fn touch(
        &mut self,
        ui: &Ui,
        rect: Rect,
        shape: &mut BodyShape,
        shown: &Shown,
        audition: &mut Audition,
        controls: &mut Controls,
    ) {
        let response = ui.interact(rect, Id::unique("body"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Struck body"));
        let now = ui.input(|input| input.time);
        let pointer = response.interact_pointer_pos().filter(|_| response.is_pointer_button_down_on());
        // Pressed and let go between two passes.
        let is_clicked = response.clicked() && ui.input(|input| input.pointer.any_click());
        let found = pointer
            .or(response.interact_pointer_pos())
            .or(response.hover_pos())
            .map(|pointer| shape.nearest(rect, pointer));
        let point = found.map(|(point, _)| shape.confined(point));
        if let Some(point) = point.filter(|_| found.is_some_and(|(_, distance)| distance <= REACH)) {
            let title = describe(point, shape).replacen("struck", "a click strikes", 1);
            *controls.hint = Hint::new(title, "Click, or drag the ring to another place.");
        }
        let is_held = self.drag.is_some();
        let is_pressed = is_clicked || pointer.is_some() && ui.input(|input| input.pointer.any_pressed());
        if is_pressed && self.drag.is_none() && found.is_some_and(|(_, distance)| distance <= REACH) {
            controls.history.begin(controls.params);
            if let Some(point) = point {
                let (loaded, velocity) = (shown.loaded().clone(), Some(velocity(ui)));
                self.drag = Some(Drag { point, written: None, velocity, next: now, loaded });
            }
        }
        outline(ui, &response, rect, RADIUS, controls.palette);
        let Some(drag) = &mut self.drag else {
            // Beside the body, or by the keyboard.
            if response.clicked() {
                audition.strike(shown.guide().home, velocity(ui), now, controls.params.link());
            }
            return;
        };
        let is_over = pointer.is_none();
        if let Some(point) = point.filter(|_| !is_over) {
            drag.point = point;
        }
        let drag_point = drag.point;
        if (is_over || now >= drag.next) && drag.written != Some(drag.point) {
            let start = std::time::Instant::now();
            write(drag.point, &mut shape.origin, controls);
            drag.next = now + rest(start);
            drag.written = Some(drag.point);
            drag.loaded = controls.params.loaded();
        }
        if let Some(velocity) = drag.velocity.take() {
            audition.strike(shown.guide().home, velocity, now, controls.params.link());
        }
        if is_over {
            self.drag = None;
            // A note that begins in this pass is held for its while.
            if is_held {
                audition.release(controls.params.link());
            }
            if shape.origin == Origin::Table {
                controls.release();
            } else {
                controls.history.end_of(&[], describe(drag_point, shape), controls.params);
                touch(controls.params, controls.host);
            }
            controls.history.cancel();
            return;
        }
        audition.repeat(shown.guide().home, now, controls.params.link());
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        ui.ctx().request_repaint();
    }
}

/// Added to the velocity for each pixel a second at which the pointer moves: 1500 give full velocity.
const PER_SPEED: f32 = 0.0002;

/// The velocity of a strike by a click: that of a pointer at rest, or more if it moves.
pub(crate) fn velocity(ui: &Ui) -> f32 {
    (VELOCITY + PER_SPEED * ui.input(|input| input.pointer.velocity().length())).min(1.0)
}

/// The exciter that has a place, for a table of modes: the pluck if it is on, or else the bow if it is on.
fn exciter(controls: &Controls) -> Option<Param> {
    let levels = [(Param::PluckLevel, Param::PluckPosition), (Param::BowLevel, Param::BowPosition)];
    levels.into_iter().find(|(level, _)| controls.value(level.info()) > level.info().min).map(|(_, place)| place)
}

/// Where the sound is struck; none if the place is unknown or cannot be changed.
fn strike(shape: &BodyShape, shown: &Shown, controls: &Controls) -> Option<Point> {
    shown.preset()?;
    match shape.origin.body() {
        Some(body) => Some(body.strike),
        None if shape.figure.form.is_line() => {
            Some(Point { x: f64::from(controls.value(exciter(controls)?.info())) / 100.0, y: 0.0 })
        }
        None => None,
    }
}

fn describe(point: Point, shape: &BodyShape) -> String {
    let [x, y] = [point.x, point.y].map(|share| share * 100.0);
    match shape.figure.form {
        Form::Line | Form::Rod => format!("struck at {x:.1} %"),
        Form::Bell | Form::HandBell => format!("struck at {:.0}° round it", 3.6 * y),
        Form::Plate { .. } => format!("struck at {x:.0} %, {y:.0} %"),
        _ => format!("struck at {x:.0} %, {:.0}° round it", 3.6 * y),
    }
}

/// Changes the place of the strike in the sound.
fn write(point: Point, origin: &mut Origin, controls: &mut Controls) {
    if *origin == Origin::Table {
        if let Some(param) = exciter(controls) {
            controls.turn(param.info(), param.info().normalise(100.0 * point.x as f32));
        }
        return;
    }
    if let Some(modes) = origin.struck_at(point) {
        replace(modes, controls);
    }
}
