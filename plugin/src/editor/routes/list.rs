//! All routes of a sound as sentences: what moves what, and how far.

use super::{Ring, name, show as show_menu, source_name};
use crate::editor::controls::Controls;
use crate::editor::theme::{GAP, PADDING, SMALL, TEXT, TITLE_HEIGHT};
use crate::editor::widgets::{knob, text};
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};
use sprung::patch::Patch;
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Source, amount_param};
use sprung::preset::Guide;

/// Height of a sentence.
const ROW: f32 = 24.0;
/// Least width of a sentence with its bar and value.
const LEAST: f32 = 400.0;
const BAR: f32 = 130.0;
const VALUE: f32 = 52.0;

/// What a source does to its destination.
fn verb(route: &Route, amount: f32) -> &'static str {
    match route.source {
        Source::Key => "tilts",
        source if source.is_bipolar() => "sways",
        _ if amount < 0.0 => "lowers",
        _ => "raises",
    }
}

/// What stands behind the destination: the second source, and the curve.
fn details(route: &Route, guide: &Guide) -> String {
    let scale = route.scale.map_or(String::new(), |scale| format!(" times {}", source_name(scale, guide)));
    let curve = if route.response == Response::ALL[0] { "" } else { route.response.id() };
    if curve.is_empty() { scale } else { format!("{scale}, {curve}") }
}

/// Shows all places of routes. Only those of a preset `is_editable`: a kit's sounds have routes of their own.
pub(in crate::editor) fn show(
    ui: &mut Ui,
    rect: Rect,
    patch: &Patch,
    guide: &Guide,
    is_editable: bool,
    controls: &mut Controls,
) {
    let palette = controls.palette;
    palette.paint_panel(ui.painter(), rect);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = Rect::from_min_size(inner.min + vec2(0.0, 2.0), vec2(inner.width(), TITLE_HEIGHT - 2.0));
    line(ui, title, "WHAT MOVES WHAT", SMALL, palette.muted);
    let rows = ((rect.height() - TITLE_HEIGHT - PADDING / 2.0) / ROW).max(1.0) as usize;
    let columns = MAX_ROUTES.div_ceil(rows);
    let gaps = (columns - 1) as f32 * 2.0 * GAP;
    let width = ((inner.width() - gaps) / columns as f32).max(LEAST);
    let mut inner_ui = ui.new_child(UiBuilder::new().id_salt("routes").max_rect(inner.with_min_y(title.bottom())));
    ScrollArea::horizontal().auto_shrink(false).show(&mut inner_ui, |ui| {
        let size = vec2(columns as f32 * width + gaps, rows as f32 * ROW);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        for place in 0..MAX_ROUTES {
            let (column, row) = (place / rows, place % rows);
            let corner = area.min + vec2(column as f32 * (width + 2.0 * GAP), row as f32 * ROW);
            let cell = Rect::from_min_size(corner, vec2(width, ROW - 2.0));
            let value = cell.with_min_x(cell.right() - VALUE);
            let bar = cell.with_max_x(value.left()).with_min_x(value.left() - BAR);
            let sentence = cell.with_max_x(bar.left() - GAP);
            match patch.routes.get(place) {
                None => {
                    line(ui, sentence, &name(place, &patch.routes, guide), SMALL, palette.muted);
                }
                Some(route) => {
                    let info = amount_param(place).info();
                    let words = [
                        (source_name(route.source, guide), palette.modulation),
                        (format!(" {} ", verb(&route, controls.value(info))), palette.muted),
                        (route.destination.info().name.to_owned(), palette.text),
                        (details(&route, guide), palette.muted),
                    ];
                    let mut left = sentence.left();
                    for (word, colour) in words {
                        left = line(ui, sentence.with_min_x(left.min(sentence.right())), &word, TEXT, colour);
                    }
                    let ring = Ring::of(info, &patch.routes, controls);
                    knob::show_bar(ui, [bar, value], info, &ring, controls);
                }
            }
            if is_editable {
                show_menu(ui, sentence, place, &patch.routes, guide, controls);
            }
        }
    });
}

/// Writes into a rectangle. Returns where the text ends.
fn line(ui: &Ui, rect: Rect, words: &str, size: f32, colour: egui::Color32) -> f32 {
    text::line(ui.painter(), rect, Align2::LEFT_CENTER, words, size, colour);
    rect.left() + text::width(ui.painter(), words, size)
}
