//! All routes of a sound as a matrix: sources that move something downwards, and what they move to the right.

use super::{AMOUNT, Ring, add, amount_text, button, can_move, goes_both_ways, now, source_name, words};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, RADIUS, SMALL, TEXT};
use crate::editor::widgets::text::{line, paragraph};
use crate::editor::widgets::{knob, outline};
use egui::{
    Align2, Id, Pos2, Rect, Role, ScrollArea, Sense, Shape, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::patch::routes::{Route, Source, amount_param};
use sprung::preset::Guide;

/// Height of the names of what is moved, of a row, and of the value in it.
const HEAD: f32 = 30.0;
const ROW: [f32; 2] = [28.0, 32.0];
const VALUE: f32 = 14.0;
/// Width of the names of sources, and the least and greatest width of a column.
const SOURCES: f32 = 104.0;
const COLUMN: [f32; 2] = [68.0, 116.0];
/// Width of the mark that opens a route's menu.
const MARK: f32 = 14.0;

/// Shows the matrix. Of an editable sound each empty cell can be clicked, which makes a route.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    (patch, guide, is_editable): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    let palette = controls.palette;
    let routes: Vec<(usize, Route)> = patch.routes.iter().collect();
    let sources: Vec<Source> =
        Source::ALL.iter().copied().filter(|source| routes.iter().any(|(_, route)| route.source == *source)).collect();
    let mut targets: Vec<Param> = routes.iter().map(|(_, route)| route.destination).collect();
    targets.sort_unstable_by_key(|target| *target as usize);
    targets.dedup();
    let [least, most] = COLUMN;
    let width = ((rect.width() - SOURCES - 2.0 * GAP) / targets.len() as f32).clamp(least, most);
    let [lowest, highest] = ROW;
    let row_height = ((rect.height() - HEAD) / sources.len() as f32).clamp(lowest, highest);
    let mut inner = ui.new_child(UiBuilder::new().id_salt("matrix").max_rect(rect));
    // That there are more must be seen.
    inner.spacing_mut().scroll.dormant_handle_opacity = 0.6;
    ScrollArea::both().auto_shrink(false).show(&mut inner, |ui| {
        let size = vec2(SOURCES + width * targets.len() as f32, HEAD + row_height * sources.len() as f32);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        let cell = |column: usize, row: usize| {
            let corner = area.min + vec2(SOURCES + width * column as f32, HEAD + row_height * row as f32);
            Rect::from_min_size(corner, vec2(width, row_height)).shrink(1.5)
        };
        for (column, target) in targets.iter().enumerate() {
            let place = cell(column, 0).with_min_y(area.top()).with_max_y(area.top() + HEAD - 2.0);
            paragraph(ui.painter(), place, target.info().name, SMALL, palette.text);
        }
        for (row, source) in sources.iter().enumerate() {
            let place = cell(0, row).with_min_x(area.left()).with_max_x(area.left() + SOURCES - GAP);
            line(ui.painter(), place, Align2::LEFT_CENTER, &source_name(*source, guide), TEXT, palette.modulation);
            for (column, target) in targets.iter().enumerate() {
                let place = cell(column, row);
                let is_here = |route: &Route| route.source == *source && route.destination == *target;
                let here: Vec<&(usize, Route)> = routes.iter().filter(|(_, route)| is_here(route)).collect();
                ui.painter().rect_filled(place, RADIUS, if here.is_empty() { palette.panel } else { palette.raised });
                if here.is_empty() && is_editable && can_move(*source, target.info()) {
                    show_empty(ui, place, *source, *target, guide, controls);
                }
                // Two routes differ in their multiplier or response.
                let share = place.width() / here.len().max(1) as f32;
                for (order, (number, route)) in here.iter().enumerate() {
                    let left = place.left() + share * order as f32;
                    let part = place.with_min_x(left).with_max_x(left + share).shrink2(vec2(4.0, 2.0));
                    show_route(ui, part, (*number, route), (patch, guide, is_editable), controls);
                }
            }
        }
    });
}

/// Shows a cell that a click fills with a route.
fn show_empty(ui: &Ui, rect: Rect, source: Source, target: Param, guide: &Guide, controls: &mut Controls) {
    let palette = controls.palette;
    let response = ui.interact(rect, Id::unique(("cell", source.id(), target.info().id)), Sense::click());
    let words = format!("{} › {}", source_name(source, guide), target.info().name);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Add {words}")));
    ui.painter().rect_stroke(rect, RADIUS, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    if response.hovered() {
        line(ui.painter(), rect, Align2::CENTER_CENTER, "+", TEXT, palette.text);
        *controls.hint = Hint::new(words, "Click: make this route.");
    }
    outline(ui, &response, rect, RADIUS, palette);
    if response.clicked() {
        controls.interaction.said = Some(add(Route::linear(source, target), AMOUNT, controls));
    }
}

/// Shows a route: its amount as a bar and as a number, and a mark that opens its menu.
fn show_route(
    ui: &mut Ui,
    rect: Rect,
    (place, route): (usize, &Route),
    (patch, guide, is_editable): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    let palette = controls.palette;
    let info = amount_param(place).info();
    let (above, bar) = rect.split_top_bottom_at_y(rect.top() + VALUE);
    if !is_editable {
        let text = info.format(controls.heard(info));
        line(ui.painter(), rect, Align2::CENTER_CENTER, &text, SMALL, palette.muted);
        return;
    }
    let (value, mark) = above.split_left_right_at_x(above.right() - MARK);
    let response = button(ui, mark, (place, route), guide, controls);
    if response.hovered() {
        *controls.hint = Hint::new(words(route, guide), "Click: source, destination, multiplier and response.");
    }
    let colour = if response.hovered() { palette.text } else { palette.muted };
    let corner = |x: f32, y: f32| -> Pos2 { pos2(mark.right() - 4.0 + x, mark.center().y + y) };
    let triangle = vec![corner(-4.0, -2.0), corner(4.0, -2.0), corner(0.0, 3.0)];
    ui.painter().add(Shape::convex_polygon(triangle, colour, Stroke::NONE));
    outline(ui, &response, mark, RADIUS, palette);
    let (ring, now) = (Ring::of(info, (&patch.routes, guide), controls), now(place, route, controls));
    let shown = (goes_both_ways(route), amount_text(route, controls.value(info), info));
    knob::show_bar(ui, [bar, value], info, (&ring, &now), shown, controls);
}
