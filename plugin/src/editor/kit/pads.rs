//! Sixteen pads as four rows of four: they play, are chosen, and are dragged onto each other.

use super::edit::name_of;
use super::keys::about;
use crate::editor::body::face;
use crate::editor::body::figure::Figure;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::grid::velocity;
use crate::editor::keyboard::held_key::HeldKey;
use crate::editor::theme::{RADIUS, SMALL, TEXT};
use crate::editor::widgets::text::line;
use crate::link::Link;
use egui::{Align2, Id, Key, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use sprung::params::Param;
use sprung::preset::catalogue::Listed;
use sprung::sound::Pad;
use sprung::units::note_name;
use std::sync::Arc;

/// Pads in a row, and in all.
const ROW: u8 = 4;
const COUNT: u8 = ROW * ROW;
/// The gains at the ends of a pad's bar, in dB.
const GAINS: [f32; 2] = [-36.0, 12.0];

/// What is being dragged.
#[derive(Clone)]
pub(super) enum Carried {
    Pad(u8),
    Sound(Arc<Listed>),
}

/// What the user has done to a pad.
pub(super) enum Deed {
    /// Something was let go over it.
    Drop {
        carried: Carried,
        key: u8,
    },
    Empty(u8),
}

/// The state of the pads.
pub(super) struct Pads {
    /// The key of the first pad.
    first: u8,
    /// The key of the chosen pad.
    chosen: u8,
    held: HeldKey,
}

impl Default for Pads {
    fn default() -> Self {
        Self { first: super::edit::FIRST, chosen: super::edit::FIRST, held: HeldKey::default() }
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
        if !(self.first..self.first + COUNT).contains(&key) {
            self.first = key - key % 12;
        }
    }

    /// The keys that are shown.
    pub(super) fn keys(&self) -> [u8; 2] {
        [self.first, (self.first + COUNT - 1).min(127)]
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
        carried: &mut Option<Carried>,
        controls: &mut Controls,
    ) -> Option<Deed> {
        let group = controls.value(Param::Choke.info());
        let kit = &shown.loaded().kit;
        let choke = |key: u8| kit.pad(key).map_or(0, |pad| kit.choke(pad, group));
        let pointer = ui.input(|input| input.pointer.latest_pos());
        let size = rect.size() / f32::from(ROW);
        let (mut touched, mut deed, mut over) = (None, None, None);
        for key in self.first..=self.keys()[1] {
            let (column, row) = ((key - self.first) % ROW, ROW - 1 - (key - self.first) / ROW);
            let cell = Rect::from_min_size(rect.min + vec2(f32::from(column), f32::from(row)) * size, size).shrink(2.0);
            let response = ui.interact(cell, Id::unique(("pad", key)), Sense::click_and_drag());
            let pad = kit.pad(key);
            let name = pad.map(|pad| shown.pad_name(pad)).unwrap_or_default();
            let is_chosen = key == self.chosen;
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, true, is_chosen, format!("Pad {} {name}", note_name(key)).trim())
            });
            let is_under = pointer.is_some_and(|at| cell.contains(at));
            if is_under {
                over = Some(key);
                *controls.hint = Hint::new(note_name(key), about(key, shown, group));
            }
            if response.is_pointer_button_down_on() && carried.is_none() {
                self.chosen = key;
                if is_under && pad.is_some() {
                    touched = pointer.map(|at| (key, velocity(cell, at)));
                } else if pad.is_some() {
                    *carried = Some(Carried::Pad(key));
                }
            } else if response.clicked() {
                self.chosen = key;
            }
            let pressed = |key| ui.input(|input| input.key_pressed(key));
            if response.has_focus() && (pressed(Key::Delete) || pressed(Key::Backspace)) && pad.is_some() {
                deed = Some(Deed::Empty(key));
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
                is_mate: group > 0 && group == choke(self.chosen),
                is_aim: is_under && carried.is_some(),
                has_focus: response.has_focus(),
            };
            face.paint(ui, cell, controls);
        }
        self.held.follow(touched, controls.params.link());
        if ui.input(|input| input.pointer.any_released()) {
            let dropped = carried.take().zip(over);
            deed = dropped.map(|(carried, key)| Deed::Drop { carried, key }).or(deed);
        }
        if let (Some(carried), Some(at)) = (&carried, pointer) {
            let name = match carried {
                Carried::Pad(key) => name_of(*key),
                Carried::Sound(sound) => sound.name().to_owned(),
            };
            paint_carried(ui, Rect::from_min_size(at + vec2(10.0, -10.0), vec2(120.0, 22.0)), &name, controls);
            ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
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
            (.., true) => Stroke::new(1.5, palette.modulation),
            _ => Stroke::new(1.0, if self.pad.is_some() { palette.outline } else { palette.line }),
        };
        painter.rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
        let inside = rect.shrink2(vec2(6.0, 3.0));
        let top = inside.with_max_y(inside.top() + 14.0);
        line(painter, top, Align2::LEFT_CENTER, &note_name(self.key), SMALL, muted);
        if self.group > 0 {
            let colour = if self.is_down { palette.on_accent } else { palette.modulation };
            line(painter, top, Align2::RIGHT_CENTER, &self.group.to_string(), SMALL, colour);
        }
        let Some(pad) = self.pad else { return };
        let bar = inside.with_min_y(inside.bottom() - 3.0);
        let named = Rect::from_min_max(pos2(inside.left(), bar.top() - 17.0), pos2(inside.right(), bar.top() - 1.0));
        line(painter, named, Align2::LEFT_CENTER, self.name, TEXT, text);
        let picture = Rect::from_min_max(top.left_bottom(), named.right_top()).shrink(2.0);
        if let Some(figure) = self.figure.filter(|_| picture.height() >= 10.0) {
            let side = vec2(picture.width().min(2.0 * picture.height()), picture.height());
            face::paint(painter, Rect::from_center_size(picture.center(), side), figure, &[], None, palette);
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

/// The name of what is being dragged, beside the pointer.
fn paint_carried(ui: &Ui, rect: Rect, name: &str, controls: &Controls) {
    let palette = controls.palette;
    let painter = ui.ctx().layer_painter(egui::LayerId::new(egui::Order::Tooltip, Id::unique("carried")));
    painter.rect(rect, RADIUS, palette.raised, Stroke::new(1.0, palette.accent), StrokeKind::Inside);
    line(&painter, rect.shrink2(vec2(6.0, 0.0)), Align2::LEFT_CENTER, name, TEXT, palette.text);
}
