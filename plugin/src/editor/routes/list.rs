//! All routes of a sound: as sentences by source or by target, which say what moves what and how far, or as a matrix.

use super::{Ring, button, goes_both_ways, matrix, name, now, source_name};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, PADDING, RADIUS, SMALL, TEXT, TITLE_HEIGHT};
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::{knob, outline, text};
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};
use sprung::params::ParamInfo;
use sprung::patch::Patch;
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Source, amount_param};
use sprung::preset::Guide;

/// Height of a sentence.
const ROW: f32 = 24.0;
/// Least width of a sentence with its bar and value.
const LEAST: f32 = 300.0;
/// Width of a bar, as a share of the width of all.
const BAR: f32 = 0.25;
const VALUE: f32 = 52.0;

/// How routes are shown.
#[derive(Clone, Copy, Default, PartialEq)]
pub(in crate::editor) enum View {
    #[default]
    Sentences,
    Matrix,
    Targets,
}

/// The views with the names of their tabs.
const VIEWS: [(View, &str); 3] =
    [(View::Sentences, "Sentences"), (View::Matrix, "Matrix"), (View::Targets, "By target")];

/// What a source does to its destination, and what is done to that.
fn verbs(route: &Route, amount: f32) -> [&'static str; 2] {
    match route.source {
        _ if amount == 0.0 => ["leaves", "is left by"],
        Source::Key => ["tilts", "is tilted by"],
        _ if goes_both_ways(route) => ["sways", "is swayed by"],
        _ if amount < 0.0 => ["lowers", "is lowered by"],
        _ => ["raises", "is raised by"],
    }
}

/// What a macro does, such as `raises Decay, lowers Tilt`; none for another parameter, or where it has no routes.
pub(in crate::editor) fn effects(info: &ParamInfo, patch: &Patch, controls: &Controls) -> Option<String> {
    let own = patch.routes.iter().filter(|(_, route)| route.source.id() == info.id);
    let effect = |(place, route): (usize, Route)| {
        let amount = controls.heard(amount_param(place).info());
        format!("{} {}", verbs(&route, amount)[0], route.destination.info().name)
    };
    let all: Vec<String> = own.map(effect).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// What stands behind the destination: the second source, and the curve.
fn details(route: &Route, guide: &Guide) -> String {
    let scale = route.scale.map_or(String::new(), |scale| format!(" times {}", source_name(scale, guide)));
    match route.response {
        Response::Linear => scale,
        curve => format!("{scale}, {}", curve.id()),
    }
}

/// Shows all routes in a view, and a place to add one. Only those of a preset `is_editable`: a kit's sounds have routes of their own.
pub(in crate::editor) fn show(
    ui: &mut Ui,
    rect: Rect,
    view: &mut View,
    (patch, guide, is_editable): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    let palette = controls.palette;
    palette.paint_panel(ui.painter(), rect);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = Rect::from_min_size(inner.min + vec2(0.0, 2.0), vec2(inner.width(), TITLE_HEIGHT - 2.0));
    // The button of the manual is at the right end.
    let mut right = title.right() - TITLE_HEIGHT;
    for (this, name) in VIEWS.into_iter().rev() {
        let width = text::width(ui.painter(), name, SMALL + 1.0) + 2.0 * GAP;
        let place = title.with_max_x(right).with_min_x(right - width);
        if tab(ui, place, name, *view == this, palette).clicked() {
            *view = this;
        }
        right = place.left();
    }
    let left = line(ui, title, "WHAT MOVES WHAT", SMALL, palette.muted) + GAP;
    let says: &[&str] = match (is_editable, patch.routes.iter().next()) {
        (false, _) => &[
            "of the pad that was struck or chosen last: Edit, on Kit, to change them",
            "of the chosen pad: Edit, on Kit, to change them",
            "of the chosen pad",
        ],
        (true, None) => {
            &["nothing yet: drag a source to a knob, or add a route below", "nothing yet: drag a source to a knob"]
        }
        (true, Some(_)) => &[""],
    };
    let place = title.with_min_x(left).with_max_x(right - GAP);
    let says = text::fitting(ui.painter(), says, SMALL, place.width());
    line(ui, place, says, SMALL, palette.muted);
    let below = Rect::from_min_max(title.left_bottom() + vec2(0.0, 3.0), inner.max - vec2(0.0, PADDING / 2.0));
    match view {
        View::Matrix if patch.routes.iter().next().is_some() => {
            matrix::show(ui, below, (patch, guide, is_editable), controls);
        }
        _ => sentences(ui, below, *view == View::Targets, (patch, guide, is_editable), controls),
    }
}

/// Shows routes as sentences, by their places or by their targets.
fn sentences(
    ui: &mut Ui,
    rect: Rect,
    by_target: bool,
    (patch, guide, is_editable): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    let palette = controls.palette;
    let visible = (rect.height() / ROW).max(1.0) as usize;
    let free = (0..MAX_ROUTES).find(|place| is_editable && patch.routes.get(*place).is_none());
    let target = |place: usize| patch.routes.get(place).map(|route| route.destination as usize);
    let mut places: Vec<usize> = patch.routes.iter().map(|(place, _)| place).collect();
    if by_target {
        places.sort_by_key(|place| target(*place));
    }
    places.extend(free);
    // As many columns as the rows need; where fewer fit, the rows are scrolled.
    let most = ((rect.width() + 2.0 * GAP) / (LEAST + 2.0 * GAP)).max(1.0) as usize;
    let columns = places.len().div_ceil(visible).clamp(1, most);
    let rows = places.len().div_ceil(columns);
    let gaps = (columns - 1) as f32 * 2.0 * GAP;
    let scroll_bar = if rows > visible { 2.0 * GAP } else { 0.0 };
    let width = (rect.width() - gaps - scroll_bar) / columns as f32;
    let mut inner_ui = ui.new_child(UiBuilder::new().id_salt("routes").max_rect(rect));
    // That there are more must be seen.
    inner_ui.spacing_mut().scroll.dormant_handle_opacity = 0.6;
    ScrollArea::vertical().auto_shrink(false).show(&mut inner_ui, |ui| {
        let size = vec2(rect.width() - scroll_bar, rows as f32 * ROW);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        for (order, place) in places.iter().copied().enumerate() {
            let (column, row) = (order / rows, order % rows);
            let corner = area.min + vec2(column as f32 * (width + 2.0 * GAP), row as f32 * ROW);
            let cell = Rect::from_min_size(corner, vec2(width, ROW - 2.0));
            let value = cell.with_min_x(cell.right() - VALUE);
            let bar = cell.with_max_x(value.left()).with_min_x(value.left() - (BAR * width).round());
            let sentence = cell.with_max_x(bar.left() - GAP);
            if is_editable {
                let response = button(ui, sentence, place, &patch.routes, guide, controls);
                if response.hovered() {
                    ui.painter().rect_filled(sentence.expand2(vec2(4.0, 0.0)), RADIUS, palette.raised);
                    let name = name(place, &patch.routes, guide);
                    *controls.hint = Hint::new(name, "Click: source, destination, multiplier and response.");
                }
                outline(ui, &response, sentence.expand2(vec2(4.0, 0.0)), RADIUS, palette);
            }
            match patch.routes.get(place) {
                None => {
                    let left = MAX_ROUTES - patch.routes.iter().count();
                    let words = format!("+ {}: {left} of {MAX_ROUTES} are free", name(place, &patch.routes, guide));
                    line(ui, sentence, &words, SMALL, palette.muted);
                }
                Some(route) => {
                    let info = amount_param(place).info();
                    let amount = controls.heard(info);
                    let source = (source_name(route.source, guide), palette.modulation);
                    let [does, is_done] = verbs(&route, amount).map(|verb| (format!(" {verb} "), palette.muted));
                    let is_first = order == 0 || target(places[order - 1]) != target(place);
                    // A target is named once, and again in grey.
                    let colour = if by_target && !is_first { palette.muted } else { palette.text };
                    let target = (route.destination.info().name.to_owned(), colour);
                    let details = (details(&route, guide), palette.muted);
                    let words =
                        if by_target { [target, is_done, source, details] } else { [source, does, target, details] };
                    let mut left = sentence.left();
                    for (word, colour) in words {
                        left = line(ui, sentence.with_min_x(left.min(sentence.right())), &word, TEXT, colour);
                    }
                    if is_editable {
                        let ring = Ring::of(info, &patch.routes, controls);
                        let now = now(place, &route, controls);
                        knob::show_bar(ui, [bar, value], info, (&ring, &now), controls);
                    } else {
                        let text = info.format(amount);
                        text::line(ui.painter(), value, Align2::RIGHT_CENTER, &text, SMALL, palette.muted);
                    }
                }
            }
        }
    });
}

/// Writes into a rectangle. Returns where the text ends.
fn line(ui: &Ui, rect: Rect, words: &str, size: f32, colour: egui::Color32) -> f32 {
    text::line(ui.painter(), rect, Align2::LEFT_CENTER, words, size, colour);
    rect.left() + text::width(ui.painter(), words, size)
}
