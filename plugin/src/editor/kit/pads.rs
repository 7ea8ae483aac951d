//! Pads as four rows of four or eight of eight: they play, are chosen, and are dragged onto each other.

use super::edit::name_of;
use super::keys::about;
use crate::editor::body::face;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::grid::velocity;
use crate::editor::keyboard::held_key::HeldKey;
use crate::editor::theme::{RADIUS, SMALL, TEXT};
use crate::editor::widgets::carried;
use crate::editor::widgets::text::{fitting, least_width, line, paragraph, width};
use crate::link::Link;
use crate::loaded::Loaded;
use egui::{Align2, DragAndDrop, Id, Key, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use sprung::internals::library::Listed;
use sprung::params::Param;
use sprung::sound::Pad;
use sprung::units::note_name;
use sprung_picture::Figure;
use std::sync::Arc;

/// Pads in a row of the few and of the many.
pub(super) const ROWS: [u8; 2] = [4, 8];
/// Width of a pad below which it has a name alone: its sound's, or, if it is empty, its key's.
const NAMED: f32 = 60.0;
/// The gains at the ends of a pad's bar, in dB.
const GAINS: [f32; 2] = [-36.0, 12.0];

/// What is being dragged; egui keeps it.
#[derive(Clone)]
pub(super) enum Carried {
    /// A pad of this kit.
    Pad(u8, Arc<Loaded>),
    Sound(Arc<Listed>),
}

/// What the user has done to a pad.
pub(super) enum Deed {
    /// Something was let go over it.
    Drop(Arc<Carried>, u8),
    Empty(u8),
    /// Its sound is to be edited.
    Edit(u8),
}

/// The state of the pads.
pub(super) struct Pads {
    /// Pads in a row.
    row: u8,
    /// The key of the first pad.
    first: u8,
    /// The key of the chosen pad.
    chosen: u8,
    held: HeldKey,
}

impl Default for Pads {
    fn default() -> Self {
        Self { row: ROWS[0], first: super::edit::FIRST, chosen: super::edit::FIRST, held: HeldKey::default() }
    }
}

impl Pads {
    /// The key of the chosen pad.
    pub(super) fn chosen(&self) -> u8 {
        self.chosen
    }

    /// Chooses a pad, and shows it.
    pub(super) fn choose(&mut self, key: u8) {
        self.chosen = key;
        if !(self.first..self.first + self.row * self.row).contains(&key) {
            self.first = key - key % 12;
        }
    }

    /// Pads in a row.
    pub(super) fn row(&self) -> u8 {
        self.row
    }

    /// Shows so many pads in a row, from the octave of this key on, and the chosen one in any case.
    pub(super) fn show_rows(&mut self, row: u8, lowest: u8) {
        (self.row, self.first) = (row, lowest - lowest % 12);
        self.choose(self.chosen);
    }

    /// The keys that are shown.
    pub(super) fn keys(&self) -> [u8; 2] {
        [self.first, (self.first + self.row * self.row - 1).min(127)]
    }

    /// Shows pads this many octaves higher, if there are keys.
    pub(super) fn go(&mut self, octaves: i16) {
        let first = i16::from(self.first) + 12 * octaves;
        self.first = u8::try_from(first).ok().filter(|first| *first < 128).unwrap_or(self.first);
    }

    /// Releases the key that the mouse holds.
    pub(super) fn release(&mut self, link: &Link) {
        self.held.release(link);
    }

    /// Shows the pads; `down` has one bit for each held key, `figures` are those of the kit's sounds.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (shown, figures, down): (&Shown, &[Figure], u128),
        controls: &mut Controls,
    ) -> Option<Deed> {
        let group = controls.value(Param::Choke.info());
        let kit = &shown.loaded().kit;
        let choke = |key: u8| kit.pad(key).map_or(0, |pad| kit.choke(pad, group));
        let (pointer, is_released) = ui.input(|input| (input.pointer.latest_pos(), input.pointer.any_released()));
        let carried = DragAndDrop::payload::<Carried>(ui.ctx());
        let empties = ui.input(|input| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace));
        let size = rect.size() / f32::from(self.row);
        let (mut touched, mut deed, chosen) = (None, None, self.chosen);
        for key in self.first..=self.keys()[1] {
            let (column, row) = ((key - self.first) % self.row, self.row - 1 - (key - self.first) / self.row);
            let cell = Rect::from_min_size(rect.min + vec2(f32::from(column), f32::from(row)) * size, size).shrink(2.0);
            let response = ui.interact(cell, Id::unique(("pad", key)), Sense::click_and_drag());
            let pad = kit.pad(key);
            let name = pad.map(|pad| shown.pad_name(pad)).unwrap_or_default();
            let is_chosen = key == chosen;
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, true, is_chosen, format!("Pad {} {name}", note_name(key)).trim())
            });
            let is_under = pointer.is_some_and(|at| cell.contains(at));
            if is_under {
                *controls.hint = Hint::new(note_name(key), about(key, shown, group));
            }
            if response.is_pointer_button_down_on() && carried.is_none() && pad.is_some() {
                if is_under {
                    touched = pointer.map(|at| (key, velocity(cell, at)));
                } else {
                    DragAndDrop::set_payload(ui.ctx(), Carried::Pad(key, shown.loaded().clone()));
                }
            }
            // At the end, so that what is typed for another pad has been taken by then.
            if response.clicked() || response.drag_stopped() && is_under {
                self.chosen = key;
            }
            if empties && response.has_focus() && pad.is_some() {
                deed = Some(Deed::Empty(key));
            }
            if let Some(carried) = carried.as_ref().filter(|_| is_under && is_released) {
                deed = Some(Deed::Drop(carried.clone(), key));
            }
            let group = choke(key);
            let face = Face {
                key,
                name: &name,
                pad,
                figure: pad.and_then(|pad| figures.get(pad.sound)),
                group,
                is_down: down >> key & 1 == 1 || self.held.key() == Some(key),
                is_chosen,
                is_mate: group > 0 && group == choke(chosen),
                is_aim: is_under && carried.is_some(),
                has_focus: response.has_focus(),
            };
            face.paint(ui, cell, controls);
        }
        self.held.follow(touched, controls.params.link());
        if let Some(carried) = carried {
            let name = match &*carried {
                Carried::Pad(key, _) => name_of(*key),
                Carried::Sound(sound) => sound.name().to_owned(),
            };
            carried::paint(ui, &name, controls.palette.accent, controls.palette);
        }
        deed
    }
}

/// What is painted of a pad.
struct Face<'a> {
    key: u8,
    name: &'a str,
    pad: Option<&'a Pad>,
    figure: Option<&'a Figure>,
    group: u8,
    is_down: bool,
    is_chosen: bool,
    /// Whether it and the chosen pad silence each other.
    is_mate: bool,
    /// Whether something would be dropped on it.
    is_aim: bool,
    has_focus: bool,
}

impl Face<'_> {
    fn paint(&self, ui: &Ui, rect: Rect, controls: &Controls) {
        let (painter, palette) = (ui.painter(), controls.palette);
        let (fill, text, muted) = match (self.is_down, self.pad) {
            (true, Some(_)) => (palette.accent, palette.on_accent, palette.on_accent),
            (_, Some(_)) => (palette.raised, palette.text, palette.muted),
            (_, None) => (palette.panel, palette.muted, palette.muted),
        };
        let edge = match (self.is_aim || self.is_chosen, self.has_focus, self.is_mate) {
            (_, true, _) => Stroke::new(1.5, palette.text),
            (true, ..) => Stroke::new(1.5, palette.accent),
            (.., true) => Stroke::new(1.5, palette.text),
            _ => Stroke::new(1.0, if self.pad.is_some() { palette.outline } else { palette.line }),
        };
        painter.rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
        if rect.width() < NAMED && self.pad.is_some() {
            paragraph(painter, rect.shrink2(vec2(2.5, 1.0)), self.name, 0.8 * SMALL, text);
            return;
        }
        let inside = rect.shrink2(vec2(6.0, 3.0));
        let top = inside.with_max_y(inside.top() + 14.0);
        line(painter, top, Align2::LEFT_CENTER, &note_name(self.key), SMALL, muted);
        if self.group > 0 {
            let colour = if self.is_down { palette.on_accent } else { palette.text };
            line(painter, top, Align2::RIGHT_CENTER, &self.group.to_string(), SMALL, colour);
        }
        let Some(pad) = self.pad else {
            let text = fitting(painter, &["Drop a sound here", "Drop here", "empty", ""], SMALL, inside.width());
            line(painter, inside, Align2::CENTER_CENTER, text, SMALL, muted);
            return;
        };
        let bar = inside.with_min_y(inside.bottom() - 3.0);
        let is_long = least_width(painter, self.name, TEXT) > inside.width();
        let height = if is_long { 28.0 } else { 16.0 };
        let named =
            Rect::from_min_max(pos2(inside.left(), bar.top() - 1.0 - height), pos2(inside.right(), bar.top() - 1.0));
        // Words stay whole.
        let is_wide = |word: &str| width(painter, word, SMALL) > inside.width();
        let size = if self.name.split(' ').any(is_wide) { 0.8 * SMALL } else { SMALL };
        match is_long {
            true => _ = paragraph(painter, named, self.name, size, text),
            false => _ = line(painter, named, Align2::LEFT_CENTER, self.name, TEXT, text),
        }
        let picture = Rect::from_min_max(top.left_bottom(), named.right_top()).shrink(2.0);
        if let Some(figure) = self.figure.filter(|_| picture.height() >= 10.0) {
            let side = vec2(picture.width().min(2.0 * picture.height()), picture.height());
            face::paint_still(painter, Rect::from_center_size(picture.center(), side), figure, palette);
        }
        // Its level as a bar, and its place between left and right as a dot.
        let split = bar.left() + 0.62 * bar.width();
        let (level, place) = (bar.with_max_x(split - 4.0), bar.with_min_x(split + 4.0));
        for groove in [level, place] {
            painter.rect_filled(groove, 1.0, palette.line);
        }
        let share = ((pad.gain_db - GAINS[0]) / (GAINS[1] - GAINS[0])).clamp(0.0, 1.0);
        let colour = if self.is_down { palette.on_accent } else { palette.accent };
        painter.rect_filled(level.with_max_x(level.left() + share * level.width()), 1.0, colour);
        painter.circle_filled(place.center() + vec2(0.5 * pad.pan * place.width(), 0.0), 2.5, text);
    }
}
