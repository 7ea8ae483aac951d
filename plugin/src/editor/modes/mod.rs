//! The modes of the sound: shows them with their present levels, and lets the user change them.

pub(super) mod axes;
mod drag;
mod face;
mod snap;
pub(super) mod table;

use crate::editor::controls::gestures::touch;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{fitting, line};
use crate::link::Link;
use axes::Axes;
use drag::{Drag, Step};
use egui::{Align2, CursorIcon, Id, PointerButton, Popup, Pos2, Rect, Response, Role, Sense, Ui, WidgetInfo, vec2};
use face::Face;
use snap::Snap;
use sprung::params::Param;
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};
use table::{clamped, phases, replace};

/// Greatest distance from a mode's circle at which it can be grabbed, in pixels.
const REACH: f32 = 14.0;

/// The state of the modes' picture.
#[derive(Default)]
pub(super) struct ModesView {
    axes: Option<Axes>,
    drag: Option<Drag>,
    snap: Snap,
    /// The mode that was touched last, and how many modes the sound had.
    selected: Option<(usize, usize)>,
    audition: Audition,
}

impl ModesView {
    /// The mode that was touched last.
    pub(super) fn selected(&self) -> Option<usize> {
        self.selected.map(|(mode, _)| mode)
    }

    /// Drops the drag, if there is one, and releases the key, which a double click holds too.
    pub(super) fn cancel(&mut self, controls: &mut Controls) {
        if self.drag.is_some() {
            controls.history.cancel();
        }
        self.release(controls.params.link());
    }

    /// Ends the drag, if there is one, and releases its key.
    pub(super) fn release(&mut self, link: &Link) {
        self.drag = None;
        self.audition.release(link);
    }

    /// Shows the modes of a sound, and beside its tabs what can be done with them; changes are played on its home key. The modes of kits
    /// cannot be changed.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        [head, rect]: [Rect; 2],
        shown: &Shown,
        energies: &[f32],
        controls: &mut Controls,
    ) {
        let palette = controls.palette;
        let (patch, is_editable) = (shown.patch(), shown.preset().is_some());
        self.selected.take_if(|(_, count)| *count != patch.modes.as_slice().len());
        self.audition.follow_time(ui.input(|input| input.time), controls.params.link());
        let is_other = |drag: &Drag| !drag.is_of(&controls.params.loaded());
        if !is_editable || self.drag.as_ref().is_some_and(is_other) {
            self.cancel(controls);
        }
        self.title(ui, head, patch, is_editable, controls);
        let area = Rect::from_min_max(rect.min + vec2(28.0, 6.0), rect.max - vec2(4.0, 16.0));
        let axes = match self.axes.filter(|_| self.drag.is_some()) {
            Some(axes) => axes.on(area),
            None => Axes::around(patch.modes.as_slice(), area),
        };
        self.axes = Some(axes);
        let response = ui.interact(area.expand(8.0), Id::unique("modes"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Modes of the body"));
        if is_editable {
            self.edit(ui, &response, &axes, shown, controls);
        }
        let pointer = response.hover_pos();
        let hovered = pointer.and_then(|pointer| nearest(patch.modes.as_slice(), &axes, pointer));
        let modes = self.drag.as_ref().map_or(patch.modes.as_slice(), Drag::modes);
        let selected = self.drag.as_ref().map_or(hovered, Drag::place);
        if let Some(mode) = selected.and_then(|place| modes.get(place).map(|mode| (place, mode))) {
            *controls.hint = describe(mode, controls.heard(Param::Decay.info()), is_editable);
        } else if pointer.is_some() {
            let help = "Double-click where there is none to add a mode; drag with the right button to draw levels.";
            *controls.hint = Hint::new(format!("{} modes", modes.len()), if is_editable { help } else { "" });
        }
        let decay = controls.heard(Param::Decay.info());
        face::paint(ui.painter(), &axes, palette, &Face { modes, decay, energies, selected });
    }

    fn title(&mut self, ui: &Ui, rect: Rect, patch: &Patch, is_editable: bool, controls: &Controls) {
        let palette = controls.palette;
        let snap = rect.with_min_x(rect.right() - 78.0);
        let rest = rect.with_max_x(snap.left() - 8.0);
        let help = match (is_editable, patch.modes.origin().is_some()) {
            (false, _) => ["of the pad that was struck or chosen last", "of the chosen pad", ""],
            (true, true) => ["from a model; the first change makes them a table of their own", "from a model", ""],
            (true, false) => [
                "drag: level, ratio   Alt: decay   Ctrl: pan   Shift: fine   right-drag: draw   double-click: add, remove",
                "drag: level, ratio   Alt: decay   Ctrl: pan",
                "",
            ],
        };
        let help = fitting(ui.painter(), &help, SMALL, rest.width());
        line(ui.painter(), rest, Align2::LEFT_CENTER, help, SMALL, palette.muted);
        let look = if self.snap == Snap::Off { Look::Plain } else { Look::Main };
        let response = button(ui, snap, self.snap.name(), "Snap", look, palette);
        Popup::menu(&response).show(|ui| {
            ui.set_min_width(90.0);
            for snap in Snap::ALL {
                if ui.selectable_label(snap == self.snap, snap.name()).clicked() {
                    self.snap = snap;
                    ui.close();
                }
            }
        });
    }

    fn edit(&mut self, ui: &Ui, response: &Response, axes: &Axes, shown: &Shown, controls: &mut Controls) {
        let (patch, home) = (shown.patch(), shown.guide().home);
        let modes = patch.modes.as_slice();
        let (now, modifiers, delta) = ui.input(|input| (input.time, input.modifiers, input.pointer.delta()));
        let start = ui.input(|input| input.pointer.press_origin());
        if let Some(start) = start
            && response.drag_started()
        {
            let (is_right, loaded) = (response.dragged_by(PointerButton::Secondary), shown.loaded().clone());
            let mode = nearest(modes, axes, start).filter(|_| !is_right);
            self.drag = match mode {
                Some(mode) => Some(Drag::of_mode(mode, modes, modifiers, loaded, now)),
                None => is_right.then(|| Drag::of_pencil(start, modes, loaded, now)),
            };
            if self.drag.is_some() {
                controls.history.begin(controls.params);
                self.selected = mode.map(|mode| (mode, modes.len())).or(self.selected);
            }
        }
        if let Some(drag) = &mut self.drag {
            let is_over = !response.dragged();
            // The response knows no place after the pointer has left the window, even when it is back.
            let to = ui.input(|input| input.pointer.interact_pos());
            drag.follow(Step { to, by: delta, is_fine: modifiers.shift }, axes, self.snap);
            if let Some(modes) = drag.due(now, is_over)
                && let Some(loaded) = replace(ModeTable::new(modes).with_phases(&phases(&patch.modes)), controls)
            {
                drag.set_loaded(loaded);
            }
            if !is_over {
                self.audition.repeat(home, now, controls.params.link());
            }
            ui.ctx().set_cursor_icon(if drag.place().is_some() { CursorIcon::Grabbing } else { CursorIcon::Crosshair });
            ui.ctx().request_repaint();
            if is_over {
                self.audition.release(controls.params.link());
                controls.history.end_of(&[], drag.name(), controls.params);
                touch(controls.params, controls.host);
                self.drag = None;
            }
        }
        if response.double_clicked()
            && let Some(pointer) = response.interact_pointer_pos()
            && self.add_or_remove(pointer, axes, patch, controls)
        {
            self.audition.strike(home, VELOCITY, now, controls.params.link());
        }
    }

    /// Removes the mode at a place, or adds one where there is none. Returns whether the modes have changed.
    fn add_or_remove(&mut self, pointer: Pos2, axes: &Axes, patch: &Patch, controls: &mut Controls) -> bool {
        let (mut modes, mut phases) = (clamped(patch.modes.as_slice()), phases(&patch.modes));
        let name = match nearest(&modes, axes, pointer) {
            // A body has at least one mode.
            Some(_) if modes.len() == 1 => return false,
            Some(place) => {
                if !phases.is_empty() {
                    phases.remove(place);
                }
                format!("remove mode {:.3}", modes.remove(place).ratio)
            }
            None if modes.len() >= MAX_MODES => return false,
            None => {
                let ratio = self.snap.nearest(axes.ratio(pointer.x));
                // The new mode gets the other properties of the nearest one, such as its decay.
                let distance = |mode: &Mode| (mode.ratio / ratio).max(ratio / mode.ratio);
                let like = modes.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let like = like.unwrap_or(Mode::UNIT);
                if !phases.is_empty() {
                    phases.push(0.0);
                }
                modes.push(Mode { ratio, level: axes.level(pointer.y), ..like }.clamped());
                format!("add mode {ratio:.3}")
            }
        };
        self.selected = None;
        controls.history.begin(controls.params);
        replace(ModeTable::new(&modes).with_phases(&phases), controls);
        controls.history.end_of(&[], name, controls.params);
        touch(controls.params, controls.host);
        true
    }
}

/// The mode whose circle is nearest to a place, within reach.
fn nearest(modes: &[Mode], axes: &Axes, place: Pos2) -> Option<usize> {
    let distances = modes.iter().map(|mode| axes.place(mode).distance(place)).enumerate();
    distances.filter(|(_, distance)| *distance <= REACH).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(mode, _)| mode)
}

fn describe((place, mode): (usize, &Mode), decay: f32, is_editable: bool) -> Option<Hint> {
    let db = sprung::units::db_from_gain(f64::from(mode.level.abs()));
    let seconds = Param::Decay.info().format(mode.decay * decay);
    let title = format!("Mode {}", place + 1);
    let pan = if mode.pan == 0.0 { String::new() } else { format!("   pan {:.0} %", mode.pan * 100.0) };
    let sign = if mode.level < 0.0 { ", inverted" } else { "" };
    let help = format!("ratio {:.3}   {db:.1} dB{sign}   T60 {seconds}{pan}", mode.ratio);
    let how = if is_editable { "   Alt-drag: T60   Ctrl-drag: pan   double-click: remove" } else { "" };
    Hint::new(title, help + how)
}
