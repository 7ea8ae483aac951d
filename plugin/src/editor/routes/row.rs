//! A route as a sentence: what moves what, how far, by which curve and times what. Each part opens its menu.

use super::{
    Ring, amount_text, becomes, change, curve_menu, goes_both_ways, now, remove, scale_menu, source_menu, source_name,
    target_menu, words,
};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{Palette, SMALL, TEXT};
use crate::editor::widgets::knob::face;
use crate::editor::widgets::text::line;
use crate::editor::widgets::{knob, outline};
use egui::{
    Align2, Color32, Id, Painter, Popup, Pos2, Rect, Response as Touch, Role, Sense, Shape, Stroke, StrokeKind, Ui,
    WidgetInfo, pos2, vec2,
};
use sprung::engine::SoundingNote;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::patch::routes::{Response, Route, Source, amount_param};
use sprung::preset::Guide;

/// From this width on, a row has a picture of its knob, and a word before what multiplies it.
const WIDE: f32 = 600.0;
/// Height of what names a source.
const CHIP: f32 = 20.0;
const SPACE: f32 = 6.0;
const ROUND: u8 = 10;
/// Radius of the picture of a knob.
const KNOB: f32 = 9.0;
/// Points of the picture of a curve.
const POINTS: usize = 12;

/// The sound whose routes are shown, and whether they can be changed.
pub(super) type About<'a> = (&'a Patch, &'a Guide, bool);

/// What a source does to its destination, and what is done to that.
pub(super) fn verbs(route: &Route, amount: f32) -> [&'static str; 2] {
    use Source::{Alternation, Lfo1, Lfo2, Lfo3, Random};
    let moves_alone = |source| matches!(source, Alternation | Lfo1 | Lfo2 | Lfo3 | Random);
    match (route.source, route.scale) {
        _ if amount == 0.0 => ["leaves", "is left by"],
        (source, _) if moves_alone(source) => ["sways", "is swayed by"],
        (_, Some(scale)) if moves_alone(scale) => ["sways", "is swayed by"],
        _ if goes_both_ways(route) => ["tilts", "is tilted by"],
        _ if amount < 0.0 => ["lowers", "is lowered by"],
        _ => ["raises", "is raised by"],
    }
}

/// Where the parts of a row are.
pub(super) struct Parts {
    pub(super) source: Rect,
    pub(super) verb: Rect,
    pub(super) target: Rect,
    pub(super) bar: Rect,
    pub(super) value: Rect,
    pub(super) curve: Rect,
    pub(super) times: Rect,
    pub(super) remove: Rect,
    is_wide: bool,
}

impl Parts {
    /// In a row, with the target first or the source.
    pub(super) fn of(row: Rect, by_target: bool) -> Self {
        let is_wide = row.width() >= WIDE;
        let [source, value, curve, times] = if is_wide { [98.0, 56.0, 26.0, 124.0] } else { [78.0, 48.0, 22.0, 14.0] };
        let verb = match (is_wide, by_target) {
            (_, false) => 40.0,
            (true, true) => 68.0,
            (false, true) => 58.0,
        };
        let ends = [16.0, times, curve, value].into_iter().scan(row.right(), |right, width| {
            let place = row.with_max_x(*right).with_min_x(*right - width);
            *right = place.left() - SPACE;
            Some(place)
        });
        let [remove, times, curve, value] = array(ends);
        let target = (0.45 * (value.left() - row.left() - source - verb - 4.0 * SPACE)).clamp(70.0, 168.0);
        let widths = if by_target { [target, verb, source] } else { [source, verb, target] };
        let starts = widths.into_iter().scan(row.left(), |left, width| {
            let place = row.with_min_x(*left).with_max_x(*left + width);
            *left = place.right() + SPACE;
            Some(place)
        });
        let [first, verb, last] = array(starts);
        let (source, target) = if by_target { (last, first) } else { (first, last) };
        let bar = row.with_min_x(last.right() + 2.0 * SPACE).with_max_x(value.left() - SPACE);
        Self { source, verb, target, bar, value, curve, times, remove, is_wide }
    }
}

fn array<const N: usize>(mut places: impl Iterator<Item = Rect>) -> [Rect; N] {
    std::array::from_fn(|_| places.next().unwrap_or(Rect::NOTHING))
}

/// Shows a route. The name of a target `is_again` that of the row above.
pub(super) fn show(
    ui: &mut Ui,
    parts: &Parts,
    (place, route): (usize, &Route),
    (patch, guide, is_editable): About,
    (by_target, is_again): (bool, bool),
    controls: &mut Controls,
) {
    let palette = controls.palette;
    let (info, number) = (amount_param(place).info(), place + 1);
    let amount = controls.heard(info);
    let mut wanted = None;
    let [does, is_done] = verbs(route, amount);
    let verb = if by_target { is_done } else { does };
    let target = |ui: &mut Ui, wanted: &mut Option<Route>, controls: &mut Controls| {
        let name = route.destination.info().name;
        let label = format!("Target of route {number}: {name}");
        let help = "Click: another knob.";
        if let Some(touch) = part(ui, parts.target, label, is_editable, (route, guide, help), controls) {
            *wanted = wanted.or(chosen(&touch, |ui| target_menu(ui, route)));
        }
        paint_target(ui.painter(), parts, route.destination, is_again, controls);
    };
    let source = |ui: &mut Ui, wanted: &mut Option<Route>, controls: &mut Controls| {
        let label = format!("Route {number}: {}", words(route, guide));
        let help = "Click: another source.";
        paint_chip(ui.painter(), parts.source, &short_name(route.source, guide), palette);
        if let Some(touch) = part(ui, chip(parts.source), label, is_editable, (route, guide, help), controls) {
            *wanted = wanted.or(chosen(&touch, |ui| source_menu(ui, route, guide)));
        }
    };
    if by_target {
        target(ui, &mut wanted, controls);
    }
    source(ui, &mut wanted, controls);
    line(ui.painter(), parts.verb, Align2::LEFT_CENTER, verb, TEXT, palette.muted);
    if !by_target {
        target(ui, &mut wanted, controls);
    }
    let text = amount_text(route, amount, info);
    if is_editable {
        let (ring, now) = (Ring::of(info, (&patch.routes, guide), controls), now(place, route, controls));
        let shown = (goes_both_ways(route), text);
        knob::show_bar(ui, [parts.bar, parts.value], info, (&ring, &now), shown, controls);
    } else {
        paint_still(ui.painter(), parts.bar, route, amount, palette);
        line(ui.painter(), parts.value, Align2::RIGHT_CENTER, &text, SMALL, palette.muted);
    }
    let label = format!("Curve of route {number}: {}", route.response.id());
    let help = "Click: how the amount follows the source.";
    let touch = part(ui, parts.curve, label, is_editable, (route, guide, help), controls);
    paint_curve(ui.painter(), parts.curve, route.response, palette);
    if let Some(touch) = touch {
        wanted = wanted.or(chosen(&touch, |ui| curve_menu(ui, route)));
    }
    let scale = route.scale.map_or("nothing".to_owned(), |scale| source_name(scale, guide));
    let label = format!("Multiplier of route {number}: {scale}");
    let help = "Click: a second source, by which the first is multiplied.";
    let touch = part(ui, parts.times, label, is_editable, (route, guide, help), controls);
    paint_times(ui.painter(), parts, route.scale.map(|scale| short_name(scale, guide)), palette);
    if let Some(touch) = touch {
        wanted = wanted.or(chosen(&touch, |ui| scale_menu(ui, route, guide)));
    }
    if let Some(route) = wanted {
        change(place, Some(route), None, becomes(&route, guide), controls);
    }
    let label = format!("Remove route {number}");
    if let Some(touch) = part(ui, parts.remove, label, is_editable, (route, guide, "Click: remove it."), controls) {
        let colour = if touch.hovered() { palette.text } else { palette.muted };
        line(ui.painter(), parts.remove, Align2::CENTER_CENTER, "×", TEXT, colour);
        if touch.clicked() {
            remove(place, route, guide, controls);
        }
    }
}

/// Makes a part of a sentence a button, if the sentence can be changed.
fn part(
    ui: &Ui,
    rect: Rect,
    label: String,
    is_editable: bool,
    (route, guide, help): (&Route, &Guide, &str),
    controls: &mut Controls,
) -> Option<Touch> {
    if !is_editable {
        return None;
    }
    let touch = ui.interact(rect, Id::unique(("route", label.split(':').next())), Sense::click());
    touch.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    if touch.hovered() {
        *controls.hint = Hint::new(words(route, guide), help);
        ui.painter().rect_stroke(rect, ROUND, Stroke::new(1.0, controls.palette.line), StrokeKind::Outside);
    }
    outline(ui, &touch, rect.expand(1.0), ROUND, controls.palette);
    Some(touch)
}

/// The menu of a part. Returns the route that is chosen in it.
fn chosen(touch: &Touch, show: impl FnOnce(&mut Ui) -> Option<Route>) -> Option<Route> {
    let shown = Popup::menu(touch).show(|ui| {
        let wanted = show(ui);
        if wanted.is_some() {
            ui.close();
        }
        wanted
    });
    shown.and_then(|shown| shown.inner)
}

/// The place of a chip in a part of a row.
pub(super) fn chip(part: Rect) -> Rect {
    Rect::from_center_size(part.center(), vec2(part.width(), CHIP))
}

/// The name of a source on a chip: a macro's own.
pub(super) fn short_name(source: Source, guide: &Guide) -> String {
    guide.macro_name(source.id()).map_or_else(|| source_name(source, guide), str::to_owned)
}

/// Paints the name of a source.
pub(super) fn paint_chip(painter: &Painter, part: Rect, name: &str, palette: &Palette) {
    let chip = chip(part);
    let edge = Stroke::new(1.0, palette.modulation.gamma_multiply(0.35));
    painter.rect(chip, ROUND, palette.modulation.gamma_multiply(0.14), edge, StrokeKind::Inside);
    painter.circle_filled(chip.left_center() + vec2(9.0, 0.0), 2.5, palette.modulation);
    let inside = chip.with_min_x(chip.left() + 15.0).with_max_x(chip.right() - 5.0);
    line(painter, inside, Align2::LEFT_CENTER, name, TEXT, palette.text);
}

/// Paints a target with a picture of its knob, if there is room.
pub(super) fn paint_target(painter: &Painter, parts: &Parts, target: Param, is_again: bool, controls: &Controls) {
    let (info, palette, mut place) = (target.info(), controls.palette, parts.target);
    if parts.is_wide {
        let centre = place.left_center() + vec2(KNOB + 2.0, 1.0);
        let origin = info.normalise(info.default) as f32;
        face::paint_small(painter, centre, KNOB, [origin, controls.position(info)], palette);
        place.min.x += 2.0 * KNOB + SPACE + 2.0;
    }
    let colour = if is_again { palette.muted } else { palette.text };
    line(painter, place, Align2::LEFT_CENTER, info.name, TEXT, colour);
}

/// Paints the bar of an amount that cannot be changed here.
fn paint_still(painter: &Painter, bar: Rect, route: &Route, amount: f32, palette: &Palette) {
    let by = 0.005 * amount * bar.width();
    let [begin, end] = [if goes_both_ways(route) { -by } else { 0.0 }, by].map(|by| bar.center().x + by);
    let track = Rect::from_center_size(bar.center(), vec2(bar.width(), 4.0));
    painter.rect_filled(track, 2.0, palette.line);
    painter.rect_filled(track.with_min_x(begin.min(end)).with_max_x(begin.max(end)), 2.0, palette.modulation);
    painter.vline(bar.center().x, bar.y_range().shrink(4.0), Stroke::new(1.0, palette.muted));
}

/// Paints the second source of a route: as a dot where there is no room for its name.
fn paint_times(painter: &Painter, parts: &Parts, scale: Option<String>, palette: &Palette) {
    let place = parts.times;
    if !parts.is_wide {
        let colour = if scale.is_some() { palette.modulation } else { Color32::TRANSPARENT };
        let edge = if scale.is_some() { palette.modulation } else { palette.empty_edge() };
        painter.circle(place.center(), 3.5, colour, Stroke::new(1.0, edge));
        return;
    }
    let times = if scale.is_some() { "times" } else { "times …" };
    let word = line(painter, place, Align2::LEFT_CENTER, times, SMALL, palette.muted);
    if let Some(scale) = scale {
        paint_chip(painter, place.with_min_x(word.right() + SPACE), &scale, palette);
    }
}

/// Paints a curve from 0 to 1.
fn paint_curve(painter: &Painter, rect: Rect, response: Response, palette: &Palette) {
    let frame = Rect::from_center_size(rect.center(), vec2(rect.width(), CHIP));
    painter.rect(frame, 4.0, palette.raised, Stroke::new(1.0, palette.outline), StrokeKind::Inside);
    let place = frame.shrink(4.0);
    let point = |step: usize| -> Pos2 {
        let share = step as f32 / POINTS as f32;
        // What the engine makes of a source with this value.
        let mut note = SoundingNote::default();
        note.sources[Source::Velocity as usize] = share;
        let bent = note.travel(&Route { response, ..Route::linear(Source::Velocity, Param::Decay) }, 100.0);
        pos2(place.left() + share * place.width(), place.bottom() - bent * place.height())
    };
    painter.add(Shape::line((0..=POINTS).map(point).collect(), Stroke::new(1.5, palette.modulation)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_row_do_not_overlap() {
        for width in [420.0, 460.0, 599.0, 600.0, 800.0] {
            for by_target in [false, true] {
                let row = Rect::from_min_size(pos2(10.0, 0.0), vec2(width, 26.0));
                let Parts { source, verb, target, bar, value, curve, times, remove, .. } = Parts::of(row, by_target);
                let first = if by_target { [target, verb, source] } else { [source, verb, target] };
                let places = [&first[..], &[bar, value, curve, times, remove]].concat();
                assert!(places.windows(2).all(|pair| pair[0].right() < pair[1].left()), "{places:?}");
                assert!(row.contains_rect(first[0]) && row.contains_rect(remove) && bar.width() > 60.0, "{bar:?}");
            }
        }
    }

    #[test]
    fn what_moves_by_itself_sways_and_what_is_held_tilts() {
        let verb = |source, scale, amount| verbs(&Route { scale, ..Route::linear(source, Param::Decay) }, amount)[0];
        assert_eq!(verb(Source::Velocity, None, 20.0), "raises");
        assert_eq!(verb(Source::Velocity, None, -20.0), "lowers");
        assert_eq!(verb(Source::Timbre, None, 20.0), "tilts");
        assert_eq!(verb(Source::Lfo1, Some(Source::Wheel), 20.0), "sways");
        assert_eq!(verb(Source::Wheel, Some(Source::Lfo1), 20.0), "sways");
        assert_eq!(verb(Source::Wheel, None, 0.0), "leaves");
    }
}
