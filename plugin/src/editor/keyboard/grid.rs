//! All 128 keys as a grid of cells that play and light up.

use super::held_key::HeldKey;
use crate::editor::controls::Controls;
use crate::editor::theme::SMALL;
use crate::editor::widgets::list::is_near;
use crate::editor::widgets::text::{line, width};
use crate::link::Link;
use egui::style::ScrollAnimation;
use egui::{
    Align, Align2, Id, Pos2, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use sprung::units::note_name;

/// The smallest width and height of a cell.
const LEAST: f32 = 70.0;
const HEIGHT: f32 = 18.0;
/// Width in a cell beside its text: the note's name with the space around both; and, in some cells, a number.
const BESIDE: f32 = 36.0;
const NUMBER: f32 = 14.0;
/// The key that is centred when the grid is opened.
const MIDDLE: u8 = 54;

/// The contents of a cell.
#[derive(Default)]
pub(crate) struct Cell {
    pub(crate) text: String,
    /// Whether the key plays anything.
    pub(crate) is_on: bool,
    /// A number in its corner; 0 is none.
    pub(crate) group: u8,
    /// Whether the cell belongs together with the cell under the pointer.
    pub(crate) is_marked: bool,
    pub(crate) is_chosen: bool,
}

/// The grid's state.
#[derive(Default)]
pub(crate) struct KeyGrid {
    held: HeldKey,
    /// The key under the pointer, in the last pass.
    hovered: Option<u8>,
    /// Whether the grid has been shown since it was opened.
    is_seen: bool,
}

impl KeyGrid {
    /// The key under the pointer.
    pub(crate) fn hovered(&self) -> Option<u8> {
        self.hovered
    }

    /// To be called when the page is left: releases the key that the mouse holds.
    pub(crate) fn release(&mut self, link: &Link) {
        self.is_seen = false;
        self.held.release(link);
    }

    /// Shows the cells of all keys; `down` has one bit for each held key. A click plays the key, louder towards the
    /// lower edge. Returns the key that was clicked.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        name: &str,
        down: u128,
        cell: &dyn Fn(u8) -> Cell,
        controls: &Controls,
    ) -> Option<u8> {
        // A row is an octave, half or a third of one: the most keys of which each has room for the longest text.
        let of = |cell: Cell| {
            let number = if cell.group > 0 { NUMBER } else { 0.0 };
            width(ui.painter(), &cell.text, SMALL) + number + BESIDE
        };
        let longest = (0..128).map(|key| of(cell(key))).fold(0.0, f32::max);
        let least = LEAST.max(longest);
        let columns = [12, 6, 4].into_iter().find(|columns| rect.width() / *columns as f32 >= least).unwrap_or(4);
        let rows = 128_usize.div_ceil(columns);
        let height = (rect.height() / rows as f32).max(HEIGHT);
        let (mut hovered, mut touched, mut clicked) = (None, None, None);
        let mut inner = ui.new_child(UiBuilder::new().id_salt(("keys", name)).max_rect(rect));
        ScrollArea::vertical().id_salt(("keys", name)).auto_shrink(false).show(&mut inner, |ui| {
            let whole = ui.available_width();
            let (area, _) = ui.allocate_exact_size(vec2(whole, rows as f32 * height), Sense::hover());
            for key in 0..128_u8 {
                // The lowest keys are at the bottom, as in sequencers.
                let (column, row) = (usize::from(key) % columns, rows - 1 - usize::from(key) / columns);
                let size = vec2(whole / columns as f32, height);
                let corner = area.min + vec2(column as f32 * size.x, row as f32 * size.y);
                let place = Rect::from_min_size(corner, size).shrink(1.0);
                if key == MIDDLE && !self.is_seen {
                    ui.scroll_to_rect_animation(place, Some(Align::Center), ScrollAnimation::none());
                }
                if !is_near(ui, place) {
                    continue;
                }
                let shown = cell(key);
                let response = ui.interact(place, Id::unique((name, key)), Sense::click_and_drag());
                let label = format!("{name} {} {}", note_name(key), shown.text);
                let is_down = down >> key & 1 == 1 || self.held.key() == Some(key);
                response.widget_info(|| WidgetInfo::selected(Role::Button, shown.is_on, is_down, &label));
                if response.hovered() {
                    hovered = Some(key);
                }
                if response.clicked() {
                    clicked = Some(key);
                }
                if response.is_pointer_button_down_on() {
                    let at = response.interact_pointer_pos();
                    touched = Some((key, at.map_or(0.8, |at| velocity(place, at))));
                }
                paint(ui, place, key, &shown, is_down, controls);
            }
        });
        (self.hovered, self.is_seen) = (hovered, true);
        self.held.follow(touched, controls.params.link());
        clicked
    }
}

/// The velocity of a click on a cell, as on the keyboard.
pub(crate) fn velocity(cell: Rect, at: Pos2) -> f32 {
    ((at.y - cell.top()) / cell.height()).clamp(0.05, 1.0)
}

fn paint(ui: &Ui, rect: Rect, key: u8, cell: &Cell, is_down: bool, controls: &Controls) {
    let (painter, palette) = (ui.painter(), controls.palette);
    let (fill, text, muted) = match (is_down, cell.is_on) {
        (true, _) => (palette.accent, palette.on_accent, palette.on_accent),
        (_, true) => (palette.raised, palette.text, palette.muted),
        (_, false) => (palette.panel, palette.muted, palette.muted),
    };
    let edge = match (cell.is_chosen, cell.is_marked) {
        (true, _) => Stroke::new(1.5, palette.accent),
        (_, true) => Stroke::new(1.5, palette.modulation),
        _ => Stroke::new(1.0, palette.outline),
    };
    painter.rect(rect, 3.0, fill, edge, StrokeKind::Inside);
    let inside = rect.shrink2(vec2(4.0, 0.0));
    let note = line(painter, inside, Align2::LEFT_CENTER, &note_name(key), SMALL, muted);
    let mut rest = Rect::from_min_max(pos2(note.right().max(rect.left() + 24.0) + 4.0, rect.top()), inside.max);
    if cell.group > 0 {
        let number = rest.with_min_x(rest.right() - NUMBER);
        let colour = if is_down { palette.on_accent } else { palette.modulation };
        line(painter, number, Align2::RIGHT_CENTER, &cell.group.to_string(), SMALL, colour);
        rest.max.x = number.left();
    }
    line(painter, rest, Align2::LEFT_CENTER, &cell.text, SMALL, text);
}
