//! The way of the sound in a small window, from the keys to the output: rows of names with lamps, one of which is chosen.

use super::parts::Part;
use super::spot::{LAMP, Spot};
use crate::editor::controls::Controls;
use crate::editor::lamps;
use crate::editor::theme::{GAP, SMALL, TEXT, paint_panel};
use crate::editor::widgets::text;
use egui::{Rect, Stroke, Ui, pos2, vec2};

/// Parts by panel and column, in the order in which the sound takes its way through them.
pub(super) const PATH: [&[&[Part]]; 4] = [
    &[&["Pitch", "Voices", "Tuning"], &["Strike"]],
    &[&["Mallet", "Pluck", "Noise"], &["Bow", "Breath", "Input"]],
    &[&["Body", "Rattle"]],
    &[&["Soundbox", "Strings", "Tremolo"], &["Drive", "Tone", "Space"], &["Output"]],
];

/// Width from which on the text is larger.
const WIDE: f32 = 900.0;
/// Parts in a column.
const ROWS: usize = 3;
/// Space below the panels.
const BELOW: f32 = 5.0;
/// Space inside a panel at the left and right.
const MARGIN: f32 = 4.0;

/// Shows the path of a preset, or of a kit, which has no lamps, with one part chosen. Returns the part that is clicked, and where the
/// middle of the chosen one is.
pub(super) fn show(ui: &Ui, rect: Rect, chosen: Part, controls: &mut Controls) -> (Option<Part>, f32) {
    let palette = controls.palette;
    let size = if rect.width() < WIDE { SMALL } else { TEXT };
    let row_height = ((rect.height() - BELOW) / ROWS as f32).floor();
    let width = |column: &[Part]| {
        let texts = column.iter().map(|name| text::width(ui.painter(), name, size));
        (indent(column) + texts.fold(0.0, f32::max) + 2.0 * MARGIN).ceil()
    };
    let whole = |panel: &&[&[Part]]| panel.iter().map(|column| width(column)).sum::<f32>() + 2.0 * MARGIN;
    let widths: Vec<f32> = PATH.iter().map(whole).collect();
    let rest = rect.width() - widths.iter().sum::<f32>();
    let gap = (rest / (PATH.len() - 1) as f32).max(GAP / 2.0);
    let (mut left, mut clicked, mut middle) = (rect.left(), None, rect.center().x);
    for (place, (panel, panel_width)) in PATH.iter().zip(widths).enumerate() {
        let height = ROWS as f32 * row_height + 2.0;
        let frame = Rect::from_min_size(pos2(left, rect.top()), vec2(panel_width, height));
        paint_panel(ui.painter(), frame, palette);
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
                let rect = Rect::from_min_size(corner, vec2(column_width, row_height));
                let name = rect.with_min_x(rect.left() + indent(column));
                let lamp = lamps::of(part).filter(|_| controls.is_preset);
                let spot = Spot { part, title: part, rect, name, size, is_tile: false, lamp };
                if spot.show(ui, *part == chosen, controls) {
                    clicked = Some(*part);
                }
                if *part == chosen {
                    middle = rect.center().x;
                }
            }
            column_left += column_width;
        }
    }
    (clicked, middle)
}

/// How far from the left of a column the names begin.
fn indent(column: &[Part]) -> f32 {
    if column.iter().any(|name| lamps::of(name).is_some()) { LAMP } else { 2.0 * MARGIN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::pages::parts::groups;
    use sprung::params::PARAMS;

    #[test]
    fn every_lamp_is_on_the_way_and_every_part_has_something_to_set() {
        let parts = || PATH.into_iter().flatten().copied().flatten().copied();
        for section in PARAMS.chunk_by(|a, b| a.section == b.section).map(|rows| rows[0].section) {
            assert!(parts().any(|part| part == section) || lamps::of(section).is_none(), "{section}");
        }
        for part in parts().filter(|part| *part != "Tuning") {
            assert!(groups(part).iter().any(|(_, knobs)| !knobs.is_empty()), "{part}");
        }
    }
}
