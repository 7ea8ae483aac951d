//! Shows the body's motion in slow motion, and where it is struck and heard.

use super::edit::rest;
use super::face;
use super::handle::Handle;
use super::pointing::Pointing;
use super::tool;
use crate::editor::controls::gestures::touch;
use crate::editor::controls::shown::{Shown, Subject};
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::loaded::Loaded;
use egui::{CursorIcon, Pos2, Rect, Ui, Vec2, vec2};
use sprung::sound::bodies::Point;
use sprung_picture::{BodyShape, Origin, Pose, Swing};
use std::sync::Arc;

/// Height from which on the stage has room for larger handles with their names, and how much larger these are.
const NAMED: f32 = 220.0;
const LARGE: f32 = 1.4;
/// How far apart they are then, to the side or up and down.
const APART: Vec2 = vec2(90.0, 20.0);
/// What is said of ring and ear.
const STRIKES: &str = "Click, or drag the ring to another place.";
const LISTENS: &str = "Drag the ear to another place: it does not hear the modes that have a node there.";

/// A drag of a place in progress, by pointer or arrow keys.
struct Drag {
    handle: Handle,
    point: Point,
    written: Option<Point>,
    /// Whether the sound has been changed.
    is_changed: bool,
    /// Where the pointer took hold of it, and how far off that was; none if the arrow keys move it.
    from: Option<Pos2>,
    off: Vec2,
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
    /// The picture of the shape, and what the body takes of it.
    bounds: Option<(Rect, Rect)>,
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
        self.shape.as_ref().is_some_and(|(_, shape)| Handle::Strike.place(shape, shown, controls).is_some())
    }

    /// Around the body that was shown.
    pub(crate) fn bounds(&self) -> Rect {
        self.bounds.map_or(Rect::NOTHING, |(_, bounds)| bounds)
    }

    /// Shows the body of a sound, on the stage or in a smaller picture. Returns the caption.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        (rect, is_stage): (Rect, bool),
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
            _ => {
                self.bounds = None;
                BodyShape::of(&shown.patch().modes, shown.family(), shown.tags())
            }
        };
        let mut subject = shown.subject();
        let (mut lit, mut focused) = (None, None);
        if Handle::Strike.place(&shape, shown, controls).is_some() {
            let places = self.places(&shape, shown, controls);
            let held = self.drag.as_ref().map(|drag| (drag.handle, drag.off));
            let pointing = Pointing::read(ui, rect, &shape, places, held, controls.palette);
            self.touch(ui, &pointing, &mut shape, shown, audition, controls);
            let dragged = self.drag.as_ref().map(|drag| drag.handle);
            focused = pointing.focused;
            lit = dragged.or(pointing.at.map(|(handle, ..)| handle)).or(focused);
            // While a place is dragged, the shapes stay as they are.
            if let Some(drag) = &self.drag {
                subject.0 = drag.loaded.clone();
            }
        }
        let seconds = (!controls.params.view().less_motion).then_some(controls.seconds);
        let moved = self.swing.advance(seconds, &shape, energies, rect);
        let [strike, ear] = self.places(&shape, shown, controls);
        let (painter, palette, figure) = (ui.painter(), controls.palette, &shape.figure);
        let pose = Pose { displacements: &moved, nodal: shape.lines_of(energies), strike };
        let struck = face::paint(painter, rect, figure, &pose, palette);
        let place = shape.place(rect);
        let known = self.bounds.filter(|(picture, _)| *picture == place);
        let (_, bounds) = *self.bounds.insert(known.unwrap_or_else(|| (place, face::bounds(place, figure))));
        if shape.origin == Origin::Table && shown.preset().is_some() {
            face::paint_guess(painter, bounds, palette);
        }
        if is_stage {
            let inside = painter.with_clip_rect(rect.intersect(painter.clip_rect()));
            tool::paint(&inside, place, figure.form, strike, controls);
        }
        // What listens stands still beside what moves.
        let heard = ear.map(|ear| figure.form.on(place, ear, 0.0));
        let has_room = is_stage && rect.height() >= NAMED;
        // A name must not cover the other handle.
        let are_apart = struck.zip(heard).is_none_or(|(one, other)| {
            let off = (one - other).abs();
            off.x >= APART.x || off.y >= APART.y
        });
        let look = |handle| face::Look {
            size: if has_room { LARGE } else { 1.0 },
            is_named: has_room && are_apart || lit == Some(handle),
            is_focused: focused == Some(handle),
        };
        struck.into_iter().for_each(|at| face::paint_ring(painter, at, look(Handle::Strike), palette));
        heard.into_iter().for_each(|at| face::paint_ear(painter, at, look(Handle::Ear), palette));
        let caption = shape.caption.clone();
        self.shape = Some((subject, shape));
        caption
    }

    /// Where strike and ear are, or are dragged to.
    fn places(&self, shape: &BodyShape, shown: &Shown, controls: &Controls) -> [Option<Point>; 2] {
        Handle::ALL.map(|handle| {
            let dragged = self.drag.as_ref().filter(|drag| drag.handle == handle).map(|drag| drag.point);
            dragged.or_else(|| handle.place(shape, shown, controls))
        })
    }

    /// Lets pointer and arrow keys move the places of strike and ear.
    fn touch(
        &mut self,
        ui: &Ui,
        pointing: &Pointing,
        shape: &mut BodyShape,
        shown: &Shown,
        audition: &mut Audition,
        controls: &mut Controls,
    ) {
        let now = ui.input(|input| input.time);
        match pointing.at {
            Some((Handle::Strike, point, _)) => {
                let title = Handle::Strike.describe(point, shape).replacen("struck", "a click strikes", 1);
                *controls.hint = Hint::new(title, STRIKES);
            }
            Some((Handle::Ear, point, _)) => {
                let place = Handle::Ear.place(shape, shown, controls).unwrap_or(point);
                *controls.hint = Hint::new(Handle::Ear.describe(place, shape), LISTENS);
            }
            None => {}
        }
        let is_held = self.drag.is_some();
        if !is_held {
            self.drag = self.begun(ui, pointing, shape, shown, controls);
        }
        let Some(drag) = &mut self.drag else {
            // Beside the body, or by the keyboard.
            if pointing.is_clicked {
                audition.strike(shown.guide().home, velocity(ui), now, controls.params.link());
            }
            return;
        };
        let is_by_key = drag.from.is_none();
        let is_over = !(pointing.is_down || is_by_key && pointing.is_key_down);
        if is_by_key && pointing.steps != Vec2::ZERO {
            drag.point = drag.handle.stepped(drag.point, pointing.steps, shape);
        } else if let Some((_, point, pos)) = pointing.at.filter(|_| pointing.is_down)
            // The ear stays where it is until the pointer moves.
            && (drag.handle == Handle::Strike || drag.from != Some(pos))
        {
            drag.point = point;
        }
        let (handle, point) = (drag.handle, drag.point);
        if (is_over || now >= drag.next) && drag.written != Some(point) {
            let start = std::time::Instant::now();
            handle.write(point, is_by_key, &mut shape.origin, controls);
            drag.next = now + rest(start);
            (drag.written, drag.is_changed) = (Some(point), true);
            drag.loaded = controls.params.loaded();
        }
        if let Some(velocity) = drag.velocity.take() {
            audition.strike(shown.guide().home, velocity, now, controls.params.link());
        }
        if is_over {
            let is_changed = drag.is_changed;
            self.drag = None;
            // A note that begins in this pass is held for its while.
            if is_held {
                audition.release(controls.params.link());
            }
            if shape.origin == Origin::Table {
                controls.release();
            } else if is_changed {
                controls.history.end_of(&[], handle.describe(point, shape), controls.params);
                touch(controls.params, controls.host);
            }
            controls.history.cancel();
            return;
        }
        audition.repeat(shown.guide().home, now, controls.params.link());
        if !is_by_key {
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        ui.ctx().request_repaint();
    }

    /// The drag that begins in this pass.
    fn begun(
        &self,
        ui: &Ui,
        pointing: &Pointing,
        shape: &BodyShape,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<Drag> {
        let now = |handle: Handle| handle.place(shape, shown, controls);
        let (handle, point, written, from, off, velocity) = match (pointing.at, pointing.focused) {
            (Some((Handle::Ear, _, pos)), _) if pointing.is_pressed => {
                let (point, at) = (now(Handle::Ear)?, pointing.ear?);
                (Handle::Ear, point, Some(point), Some(pos), pos - at, velocity(ui))
            }
            (Some((Handle::Strike, point, pos)), _) if pointing.is_pressed => {
                (Handle::Strike, point, None, Some(pos), Vec2::ZERO, velocity(ui))
            }
            (_, Some(handle)) if pointing.steps != Vec2::ZERO => {
                let point = now(handle)?;
                (handle, point, Some(point), None, Vec2::ZERO, VELOCITY)
            }
            _ => return None,
        };
        controls.history.begin(controls.params);
        let (velocity, next, loaded) = (Some(velocity), ui.input(|input| input.time), shown.loaded().clone());
        Some(Drag { handle, point, written, is_changed: false, from, off, velocity, next, loaded })
    }
}

/// Added to the velocity for each pixel a second at which the pointer moves: 1500 give full velocity.
const PER_SPEED: f32 = 0.0002;

/// The velocity of a strike by a click: that of a pointer at rest, or more if it moves.
pub(crate) fn velocity(ui: &Ui) -> f32 {
    (VELOCITY + PER_SPEED * ui.input(|input| input.pointer.velocity().length())).min(1.0)
}
