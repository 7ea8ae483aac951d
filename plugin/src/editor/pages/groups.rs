//! The knobs of a part in groups: a row for each where they are high enough, and otherwise columns, which scroll.

use super::parts::Group;
use super::sections::{LEAST, knob_at};
use crate::editor::controls::Controls;
use crate::editor::theme::{GAP, SMALL};
use crate::editor::widgets::text::line;
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};
use sprung::patch::Patch;
use sprung::preset::Guide;

/// Width of the titles before rows, and height of those above columns.
const TITLES: f32 = 58.0;
const TITLE: f32 = 14.0;
/// Least and greatest height of a row, and width of a column.
const HEIGHTS: [f32; 2] = [61.0, 78.0];
const WIDEST: f32 = 92.0;
/// Height of a knob with its name and value.
const CELL: f32 = 61.0;

/// The width that groups take as rows, as wide as they may be.
pub(super) fn width(groups: &[Group]) -> f32 {
    titles(groups) + longest(groups) as f32 * WIDEST
}

/// The least width that groups take without scrolling, if they are so high.
pub(super) fn least_width(groups: &[Group], height: f32) -> f32 {
    let rows = titles(groups) + longest(groups) as f32 * LEAST;
    if least_height(groups) <= height { rows } else { columns(groups, height, LEAST) }
}

/// The least height that groups take as rows.
pub(super) fn least_height(groups: &[Group]) -> f32 {
    groups.len() as f32 * HEIGHTS[0]
}

fn titles(groups: &[Group]) -> f32 {
    if groups.iter().any(|(title, _)| !title.is_empty()) { TITLES } else { 0.0 }
}

fn longest(groups: &[Group]) -> usize {
    groups.iter().map(|(_, knobs)| knobs.len()).max().unwrap_or(0).max(1)
}

/// How many rows of columns there are, with room for titles above them.
fn rows_in(height: f32) -> usize {
    (((height - TITLE) / HEIGHTS[0]) as usize).max(1)
}

/// The width of groups as columns of this width.
fn columns(groups: &[Group], height: f32, cell: f32) -> f32 {
    let count: usize = groups.iter().map(|(_, knobs)| knobs.len().div_ceil(rows_in(height))).sum();
    count as f32 * cell + groups.len().saturating_sub(1) as f32 * 2.0 * GAP
}

/// Shows the knobs.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    groups: &[Group],
    (patch, guide): (&Patch, &Guide),
    controls: &mut Controls,
) {
    let muted = controls.palette.muted;
    let aside = titles(groups);
    let height = (rect.height() / groups.len() as f32).min(HEIGHTS[1]);
    let wide = ((rect.width() - aside) / longest(groups) as f32).floor().min(WIDEST);
    if height >= HEIGHTS[0] && wide >= LEAST {
        // A page of its own, which is as large as its place: here, the wheel has nothing to scroll.
        let ui = &mut ui.new_child(UiBuilder::new().id_salt("groups").max_rect(rect));
        for (row, (title, knobs)) in groups.iter().enumerate() {
            let top = rect.top() + row as f32 * height + (height - CELL) / 2.0;
            let first = Rect::from_min_size(pos2(rect.left() + aside, top), vec2(wide, CELL));
            let place = first.with_min_x(rect.left()).with_max_x(first.left() - 4.0).with_max_y(first.top() + 34.0);
            line(ui.painter(), place, Align2::LEFT_CENTER, title, SMALL, muted);
            for (column, info) in knobs.iter().enumerate() {
                let cell = first.translate(vec2(column as f32 * wide, 0.0));
                knob_at(ui, cell, info, (patch, guide), controls);
            }
        }
        return;
    }
    let rows = rows_in(rect.height());
    let gaps = columns(groups, rect.height(), 0.0);
    let count = (columns(groups, rect.height(), 1.0) - gaps).max(1.0);
    let wide = ((rect.width() - gaps) / count).floor().clamp(LEAST, WIDEST);
    let above = if rect.height() >= TITLE + CELL { TITLE } else { 0.0 };
    let mut inner = ui.new_child(UiBuilder::new().id_salt("groups").max_rect(rect));
    ScrollArea::horizontal().id_salt(groups[0].1[0].section).auto_shrink(false).show(&mut inner, |ui| {
        let size = vec2(columns(groups, rect.height(), wide), rect.height());
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        let mut left = area.left();
        for (title, knobs) in groups {
            let across = knobs.len().div_ceil(rows);
            let place = Rect::from_min_size(pos2(left, area.top()), vec2(across as f32 * wide, above));
            if above > 0.0 {
                line(ui.painter(), place.translate(vec2(4.0, 0.0)), Align2::LEFT_CENTER, title, SMALL, muted);
            }
            for (number, info) in knobs.iter().enumerate() {
                let corner = pos2(left + (number % across) as f32 * wide, place.bottom());
                let down = (number / across) as f32 * HEIGHTS[0];
                let cell = Rect::from_min_size(corner + vec2(0.0, down), vec2(wide, CELL));
                knob_at(ui, cell, info, (patch, guide), controls);
            }
            left = place.right() + 2.0 * GAP;
        }
    });
}
