//! The way of the sound as one picture, from the keys to the output: parts with lamps, one of which is shown below.

use super::sections;
use crate::editor::body::face;
use crate::editor::controls::{Controls, Hint};
use crate::editor::lamps::{self, Lamp};
use crate::editor::routes::carry;
use crate::editor::theme::{GAP, RADIUS, SMALL, TEXT};
use crate::editor::widgets::{outline, text};
use egui::{Align2, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use sprung_picture::Figure;

/// A part: its name, which is that of its section if it has one, and the page that shows it.
pub(super) type Part = (&'static str, usize);

/// Parts by panel and column, in the order in which the sound takes its way through them.
const PATH: [&[&[Part]]; 4] = [
    &[&[("Pitch", 1), ("Voices", 3), ("Tuning", 5)]],
    &[&[("Mallet", 0), ("Pluck", 0), ("Noise", 0)], &[("Bow", 0), ("Breath", 0), ("Input", 0)]],
    &[&[("Body", 1), ("Model", 4), ("Rattle", 1)]],
    &[&[("Soundbox", 2), ("Strings", 2), ("Tremolo", 2)], &[("Drive", 2), ("Tone", 2), ("Space", 2)], &[("Output", 2)]],
];

/// Width from which on the text is larger.
const WIDE: f32 = 900.0;
/// Parts in a column, and the height of one that has a picture.
const ROWS: usize = 3;
const PICTURED: f32 = 28.0;
/// Space for the edges of a panel, and below it.
const BELOW: f32 = 5.0;
/// Width of a picture, and of that of the body.
const PICTURE: f32 = 44.0;
const BODY: f32 = 112.0;
/// Space inside a panel at the left and right.
const MARGIN: f32 = 4.0;
/// Width of the place of a lamp.
const LAMP: f32 = 16.0;

#[cfg(test)]
fn parts() -> impl Iterator<Item = Part> {
    PATH.into_iter().flatten().copied().flatten().copied()
}

/// A part of each page, in the order of the pages.
#[cfg(test)]
pub(in crate::editor) fn names() -> impl Iterator<Item = &'static str> {
    (0..6).filter_map(|page| parts().find(|part| part.1 == page)).map(|(name, _)| name)
}

/// Shows the path of a preset, or of a kit, which has no lamps, with one part selected. Returns the part that is clicked.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    selected: &str,
    (is_preset, figure): (bool, &Figure),
    controls: &mut Controls,
) -> Option<Part> {
    let palette = controls.palette;
    let size = if rect.width() < WIDE { SMALL } else { TEXT };
    let row_height = ((rect.height() - BELOW) / ROWS as f32).floor();
    let is_tall = row_height >= PICTURED;
    let picture = if is_tall { PICTURE } else { 0.0 };
    let width = |column: &[Part]| {
        let texts = column.iter().map(|(name, _)| text::width(ui.painter(), name, size));
        (indent(column) + texts.fold(0.0, f32::max) + 2.0 * MARGIN + picture).ceil()
    };
    let body = |panel: &[&[Part]]| if is_tall && panel[0][0].0 == "Body" { BODY } else { 0.0 };
    let whole = |panel: &&[&[Part]]| panel.iter().map(|column| width(column)).sum::<f32>() + body(panel) + 2.0 * MARGIN;
    let widths: Vec<f32> = PATH.iter().map(whole).collect();
    let rest = rect.width() - widths.iter().sum::<f32>();
    let gap = (rest / (PATH.len() - 1) as f32).clamp(GAP / 2.0, 12.0 * GAP);
    let (mut left, mut clicked) = (rect.left(), None);
    for (place, (panel, panel_width)) in PATH.iter().zip(widths).enumerate() {
        let height = ROWS as f32 * row_height + 2.0;
        let frame = Rect::from_min_size(pos2(left, rect.top()), vec2(panel_width, height));
        palette.paint_panel(ui.painter(), frame);
        if place < PATH.len() - 1 {
            let wire = [frame.right_center(), frame.right_center() + vec2(gap, 0.0)];
            ui.painter().line_segment(wire, Stroke::new(2.0, palette.accent));
        }
        left = frame.right() + gap;
        let mut column_left = frame.left() + MARGIN;
        for column in *panel {
            let column_width = width(column);
            for (row, part) in column.iter().enumerate() {
                let corner = pos2(column_left, frame.top() + 1.0 + row as f32 * row_height);
                let item = Rect::from_min_size(corner, vec2(column_width, row_height));
                let text = item.with_min_x(item.left() + indent(column)).with_max_x(item.right() - picture);
                let lamp = lamps::of(part.0).filter(|_| is_preset);
                let is_clicked = show_part(ui, [item, text], part.0, lamp, (selected, size), controls);
                clicked = is_clicked.then_some(*part).or(clicked);
                // A part that is off is no more than its name.
                if is_tall && lamp.is_none_or(|lamp| lamp.is_on(controls)) && !matches!(part.0, "Body" | "Input") {
                    // A floor is painted beyond its place.
                    let around = if part.0 == "Space" { vec2(11.0, 12.0) } else { vec2(5.0, 6.0) };
                    let place = item.with_min_x(text.right()).shrink2(around);
                    let section = sections::sections(&[part.0]).next();
                    section.and_then(|section| sections::picture(ui.painter(), place, section, figure, controls));
                }
            }
            column_left += column_width;
        }
        if body(panel) > 0.0 {
            let place = frame.with_min_x(column_left).shrink2(vec2(GAP, GAP / 2.0));
            face::paint_still(ui.painter(), place, figure, palette);
        }
    }
    clicked
}

/// How far from the left of a column the names begin.
fn indent(column: &[Part]) -> f32 {
    if column.iter().any(|(name, _)| lamps::of(name).is_some()) { LAMP } else { 2.0 * MARGIN }
}

/// Shows a part in a place, and its name in a part of it. Returns whether it is clicked.
fn show_part(
    ui: &Ui,
    [rect, text]: [Rect; 2],
    name: &str,
    lamp: Option<&Lamp>,
    (selected, size): (&str, f32),
    controls: &mut Controls,
) -> bool {
    let (palette, is_selected) = (controls.palette, name == selected);
    let response = ui.interact(rect, Id::unique(("part", name)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_selected, name));
    if is_selected {
        ui.painter().rect(rect, RADIUS, palette.raised, Stroke::new(1.0, palette.accent), StrokeKind::Inside);
    }
    outline(ui, &response, rect, RADIUS, palette);
    let is_on = lamp.is_none_or(|lamp| lamp.is_on(controls));
    let mut is_hovered = response.hovered();
    if let Some(lamp) = lamp {
        is_hovered |= lamp.show(ui, rect.with_max_x(rect.left() + LAMP), controls).hovered();
        if is_hovered {
            let does = if is_on { "switches it off" } else { "switches it on" };
            *controls.hint = Hint::new(name, format!("{} Its lamp {does}.", lamp.help));
        }
    }
    let colour = if is_on || is_selected || is_hovered { palette.text } else { palette.muted };
    text::line(ui.painter(), text, Align2::LEFT_CENTER, name, size, colour);
    response.clicked() || !is_selected && carry::dwells(ui, rect, controls)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::PARAMS;

    #[test]
    fn every_lamp_is_on_the_way_and_every_part_on_the_page_of_its_section() {
        for section in PARAMS.chunk_by(|a, b| a.section == b.section).map(|rows| rows[0].section) {
            let part = parts().find(|(name, _)| *name == section);
            assert!(part.is_some() || lamps::of(section).is_none(), "{section}");
            assert!(part.is_none_or(|(_, page)| sections::shows(page, section)), "{section}");
        }
    }
}
