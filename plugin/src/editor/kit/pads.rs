//! Pads as four rows of four or eight of eight: they play, are chosen, and are dragged onto each other.

use super::edit::name_of;
use super::keys::about;
use super::live::{About, Sounding, place};
use crate::editor::body::face;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::grid::velocity;
use crate::editor::keyboard::held_key::HeldKey;
use crate::editor::theme::{Palette, RADIUS, SMALL, TEXT};
use crate::editor::widgets::carried;
use crate::editor::widgets::text::{fitting, least_width, line, paragraph, width};
use crate::link::Link;
use crate::loaded::Loaded;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{
    Align2, Color32, DragAndDrop, Id, Key, Painter, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};
use sprung::internals::library::Listed;
use sprung::params::Param;
use sprung::sound::Pad;
use sprung::units::note_name;
use sprung_picture::{BodyShape, Figure, Pose};
use std::f32::consts::TAU;
use std::sync::Arc;

/// Pads in a row of the few and of the many.
pub(super) const ROWS: [u8; 2] = [4, 8];
/// Width of a pad below which it has a name alone: its sound's, or, if it is empty, its key's.
const NAMED: f32 = 60.0;
/// The gains at the ends of a pad's bar, in dB.
const GAINS: [f32; 2] = [-36.0, 12.0];
/// Radius of the ring around the number of a choke group.
const RING: f32 = 6.5;
/// How far a pad's face goes towards the colour of what sounds; and while its key is down, of one with a picture.
const LIT: f32 = 0.3;
const DOWN: f32 = 0.6;
/// Corners of a glow.
const CORNERS: usize = 24;

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
    Choose(u8),
    Strike(u8),
    /// The chosen one is to be swapped with the one that is clicked next, or no longer.
    Swapping,
    Swap([u8; 2]),
    /// The effects behind all pads are to be shown.
    Effects,
}

/// The state of the pads.
pub(super) struct Pads {
    /// Pads in a row.
    row: u8,
    /// The key of the first pad.
    first: u8,
    /// The key of the chosen pad.
    chosen: u8,
    /// Whether a click on another pad swaps it with the chosen one.
    is_swapping: bool,
    held: HeldKey,
}

impl Default for Pads {
    fn default() -> Self {
        let first = super::edit::FIRST;
        Self { row: ROWS[0], first, chosen: first, is_swapping: false, held: HeldKey::default() }
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

    /// Whether a click on another pad swaps it with the chosen one.
    pub(super) fn is_swapping(&self) -> bool {
        self.is_swapping
    }

    /// Lets the next click on another pad swap it with the chosen one, or no longer.
    pub(super) fn swap_next(&mut self, is_swapping: bool) {
        self.is_swapping = is_swapping;
    }

    /// Shows the pads from a key on.
    pub(super) fn show_from(&mut self, first: u8) {
        self.first = first;
    }

    /// Releases the key that the mouse holds.
    pub(super) fn release(&mut self, link: &Link) {
        self.held.release(link);
    }

    /// Shows the pads; `down` has one bit for each held key.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (kit, down): (&About, u128),
        controls: &mut Controls,
    ) -> Option<Deed> {
        let group = controls.value(Param::Choke.info());
        let (shown, pads) = (kit.shown, &kit.shown.loaded().kit);
        let choke = |key: u8| pads.pad(key).map_or(0, |pad| pads.choke(pad, group));
        let (pointer, is_released) = ui.input(|input| (input.pointer.latest_pos(), input.pointer.any_released()));
        let carried = DragAndDrop::payload::<Carried>(ui.ctx());
        let empties = ui.input(|input| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace));
        self.is_swapping &= !ui.input(|input| input.key_pressed(Key::Escape));
        let size = rect.size() / f32::from(self.row);
        let (mut touched, mut deed, chosen) = (None, None, self.chosen);
        for key in self.first..=self.keys()[1] {
            let (column, row) = ((key - self.first) % self.row, self.row - 1 - (key - self.first) / self.row);
            let cell = Rect::from_min_size(rect.min + vec2(f32::from(column), f32::from(row)) * size, size).shrink(2.0);
            let response = ui.interact(cell, Id::unique(("pad", key)), Sense::click_and_drag());
            let pad = pads.pad(key);
            let name = pad.map(|pad| shown.pad_name(pad)).unwrap_or_default();
            let is_chosen = key == chosen;
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, true, is_chosen, format!("Pad {} {name}", note_name(key)).trim())
            });
            let is_under = pointer.is_some_and(|at| cell.contains(at));
            if is_under {
                *controls.hint = Hint::new(note_name(key), about(key, shown, group));
            }
            if response.is_pointer_button_down_on() && carried.is_none() && pad.is_some() && !self.is_swapping {
                if is_under {
                    touched = pointer.map(|at| (key, velocity(cell, at)));
                } else {
                    DragAndDrop::set_payload(ui.ctx(), Carried::Pad(key, shown.loaded().clone()));
                }
            }
            if response.clicked() || response.drag_stopped() && is_under {
                if self.is_swapping && !is_chosen {
                    deed = Some(Deed::Swap([chosen, key]));
                } else {
                    // At the end, so that what is typed for another pad has been taken by then.
                    self.chosen = key;
                }
                self.is_swapping = false;
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
                figure: pad.and_then(|pad| kit.bodies.figure(pad.sound)),
                group,
                is_down: down >> key & 1 == 1 || self.held.key() == Some(key),
                sounding: kit.live.of(key).and_then(|sounding| Some((sounding, kit.bodies.shape(pad?.sound)?))),
                is_chosen,
                is_mate: group > 0 && group == choke(chosen),
                is_aim: is_under && (carried.is_some() || self.is_swapping),
                has_focus: response.has_focus(),
            };
            face.paint(ui, cell, controls);
        }
        self.held.follow(touched, controls.params.link());
        if self.is_swapping {
            let name = pads.pad(chosen).map_or_else(|| name_of(chosen), |pad| shown.pad_name(pad));
            *controls.hint = Hint::new(format!("Swap {name} with …"), "Click the other pad. Esc cancels.");
        }
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
    /// What sounds on it, with the shapes of its body's modes.
    sounding: Option<(&'a Sounding, &'a BodyShape)>,
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
        let is_named_alone = rect.width() < NAMED;
        let strength = self.sounding.map_or(0.0, |(pad, _)| pad.strength);
        // A pad that has only a name shows by its face alone that its key is down.
        let lit = match (self.is_down, is_named_alone) {
            (true, true) => 1.0,
            (true, false) => LIT * strength.max(DOWN),
            (false, _) => LIT * strength,
        };
        let (fill, text, muted) = match self.pad {
            Some(_) if lit >= 1.0 => (palette.accent, palette.on_accent, palette.on_accent),
            Some(_) => (palette.raised.lerp_to_gamma(palette.accent, lit), palette.text, palette.muted),
            None => (palette.panel, palette.muted, palette.muted),
        };
        // On a lit face, the second rank would be too faint.
        let muted = if lit > 0.0 && lit < 1.0 { palette.text } else { muted };
        let edge = match (self.is_aim || self.is_chosen, self.has_focus, self.is_mate) {
            (_, true, _) => Stroke::new(1.5, palette.text),
            (true, ..) => Stroke::new(1.5, palette.accent),
            (.., true) => Stroke::new(1.5, palette.text),
            _ => Stroke::new(1.0, if self.pad.is_some() { palette.outline } else { palette.line }),
        };
        painter.rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
        if is_named_alone && self.pad.is_some() {
            paragraph(painter, rect.shrink2(vec2(2.5, 1.0)), self.name, 0.8 * SMALL, text);
            return;
        }
        let inside = rect.shrink2(vec2(6.0, 3.0));
        let top = inside.with_max_y(inside.top() + 14.0);
        line(painter, top, Align2::LEFT_CENTER, &note_name(self.key), SMALL, muted);
        if self.group > 0 {
            let place = Rect::from_center_size(top.right_center() - vec2(RING - 1.0, -1.0), Vec2::splat(2.0 * RING));
            let colour = if self.is_chosen { palette.on_accent } else { text };
            match self.is_chosen {
                true => _ = painter.circle_filled(place.center(), RING, palette.accent),
                false => _ = painter.circle_stroke(place.center(), RING, Stroke::new(1.0, text)),
            }
            line(painter, place, Align2::CENTER_CENTER, &self.group.to_string(), 0.9 * SMALL, colour);
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
            let at = place(picture);
            paint_glow(painter, picture.expand(4.0), strength, palette);
            match self.sounding {
                Some((pad, shape)) => {
                    let displacements = &pad.displacements_of(figure, shape, at);
                    let _ = face::paint(painter, at, figure, &Pose { displacements, ..Pose::default() }, palette);
                }
                None => face::paint_still(painter, at, figure, palette),
            }
        }
        // Its level as a bar, and its place between left and right as a dot.
        let split = bar.left() + 0.62 * bar.width();
        let (level, width) = (bar.with_max_x(split - 4.0), bar.with_min_x(split + 4.0));
        for groove in [level, width] {
            painter.rect_filled(groove, 1.0, palette.line);
        }
        let share = ((pad.gain_db - GAINS[0]) / (GAINS[1] - GAINS[0])).clamp(0.0, 1.0);
        painter.rect_filled(level.with_max_x(level.left() + share * level.width()), 1.0, palette.accent);
        painter.circle_filled(width.center() + vec2(0.5 * pad.pan * width.width(), 0.0), 2.5, text);
    }
}

/// Paints a light behind a body that sounds, from 0 to 1.
pub(super) fn paint_glow(painter: &Painter, rect: Rect, strength: f32, palette: &Palette) {
    if strength <= 0.01 {
        return;
    }
    let colour = palette.accent.gamma_multiply(0.35 * strength.min(1.0));
    let vertex = |pos: Pos2, color: Color32| Vertex { pos, uv: WHITE_UV, color };
    let mut glow = Mesh::default();
    glow.vertices.push(vertex(rect.center(), colour));
    let corner = |corner: usize| rect.center() + Vec2::angled(TAU * corner as f32 / CORNERS as f32) * rect.size() / 2.0;
    glow.vertices.extend((0..CORNERS).map(|place| vertex(corner(place), Color32::TRANSPARENT)));
    (1..=CORNERS as u32).for_each(|place| glow.add_triangle(0, place, place % CORNERS as u32 + 1));
    painter.add(glow);
}
