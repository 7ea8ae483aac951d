//! The sources of routes: each can be dragged to a knob; a click shows the knobs of those that have any.

use super::curve::paint_notes;
use crate::editor::controls::naming::{self, macro_number};
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::pages::curves;
use crate::editor::pages::sections::{Section, sections};
use crate::editor::routes::{OF_KITS, source_name};
use crate::editor::theme::{RADIUS, SMALL, TEXT};
use crate::editor::widgets::text::{fitting, least_width, line, width};
use egui::{
    Align2, Color32, CursorIcon, Id, Key, Mesh, Painter, Pos2, Rect, Response, Role, ScrollArea, Sense, Stroke,
    StrokeKind, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use sprung::engine::SoundingNote;
use sprung::params::{PARAMS, ParamInfo};
use sprung::patch::routes::{Route, Source};
use std::f32::consts::TAU;

/// The sources that have a curve, with their sections.
const DRAWN: [(Source, &str); 5] = [
    (Source::Lfo1, "LFO 1"),
    (Source::Lfo2, "LFO 2"),
    (Source::Lfo3, "LFO 3"),
    (Source::Envelope1, "Envelope 1"),
    (Source::Envelope2, "Envelope 2"),
];
/// Height of a source with a curve, in a list that is so high and in one that is not, and of a source without.
const TILES: [f32; 2] = [46.0, 34.0];
const TALL: f32 = 480.0;
const CHIP: f32 = 20.0;
/// How many macros stand side by side, where all of their names are whole.
const MACROS: [f32; 3] = [4.0, 3.0, 2.0];
/// The space around the name of one.
const BESIDE: f32 = 8.0;
/// How much is left of the curve of a source that moves nothing.
const UNUSED: f32 = 0.5;
const SPACE: f32 = 4.0;
/// Height of a title, and the space around the text of a source.
const TITLE: f32 = 18.0;
const AROUND: f32 = 14.0;
/// What is said before sources in a line.
const DRAG: &str = "drag to a knob";
/// Width of the mark of a source that has routes.
const DOT: f32 = 10.0;
/// Radius of the pie of its value.
const PIE: f32 = 3.5;

/// The section whose curve a source has.
fn drawn(source: Source) -> Option<&'static str> {
    DRAWN.iter().find(|(own, _)| *own == source).map(|(_, section)| *section)
}

/// The section whose knobs a source has.
pub(in crate::editor) fn section_of(source: Source) -> Option<&'static str> {
    drawn(source).or(source.id().starts_with("macro").then_some("Macros"))
}

/// The knob of a macro; none for another source.
fn macro_of(source: Source) -> Option<&'static ParamInfo> {
    PARAMS.iter().find(|info| info.id == source.id() && macro_number(info).is_some())
}

/// How many routes a source has.
fn routes_of(source: Source, shown: &Shown) -> usize {
    let is_of = |(_, route): &(usize, Route)| route.source == source || route.scale == Some(source);
    shown.patch().routes.iter().filter(is_of).count()
}

/// The notes that move a source which routes read; others stand still.
pub(super) fn notes_of<'a>(source: Source, shown: &Shown, controls: &Controls<'a>) -> &'a [SoundingNote] {
    if routes_of(source, shown) > 0 { controls.notes } else { &[] }
}

/// The name of a source. Macros have one that the sound gives them, under a title of their own.
fn name(source: Source, shown: &Shown) -> String {
    let own = drawn(source).or_else(|| shown.guide().macro_name(source.id()));
    own.map_or_else(|| source_name(source, shown.guide()), str::to_owned)
}

/// Width of a source without a picture.
fn chip_width(ui: &Ui, (source, name): (Source, &str), shown: &Shown) -> f32 {
    width(ui.painter(), name, TEXT) + AROUND + if routes_of(source, shown) > 0 { DOT } else { 0.0 }
}

/// Shows these sources in a line, as many as there is room for, with what to do with them before; the last ends at the right.
pub(in crate::editor) fn show_line(ui: &Ui, rect: Rect, sources: &[Source], shown: &Shown, controls: &mut Controls) {
    let title = if shown.preset().is_some() { DRAG } else { "of each sound its own" };
    let mut left = rect.left() + width(ui.painter(), title, SMALL) + 3.0 * SPACE;
    let mut places = Vec::new();
    for source in sources {
        let name = name(*source, shown);
        let wide = chip_width(ui, (*source, &name), shown);
        if left + wide > rect.right() {
            break;
        }
        places.push((*source, name, Rect::from_min_size(pos2(left, rect.center().y - CHIP / 2.0), vec2(wide, CHIP))));
        left += wide + SPACE;
    }
    let Some((.., last)) = places.last() else { return };
    let by = vec2(rect.right() - last.right(), 0.0);
    line(ui.painter(), rect.translate(by), Align2::LEFT_CENTER, title, SMALL, controls.palette.muted);
    for (source, name, place) in &places {
        show_source(ui, place.translate(by), (*source, name), None, shown, controls);
    }
}

/// The width of a line that has all of these sources.
pub(in crate::editor) fn line_width(ui: &Ui, sources: &[Source], shown: &Shown) -> f32 {
    let wide = |source: &Source| SPACE + chip_width(ui, (*source, &name(*source, shown)), shown);
    (width(ui.painter(), DRAG, SMALL) + 3.0 * SPACE + sources.iter().map(wide).sum::<f32>()).ceil()
}

/// Shows the sources. Returns the one with knobs that was clicked.
pub(super) fn show(ui: &mut Ui, rect: Rect, chosen: Source, shown: &Shown, controls: &mut Controls) -> Option<Source> {
    let mut clicked = None;
    let mut inner = ui.new_child(UiBuilder::new().id_salt("sources").max_rect(rect));
    ScrollArea::vertical().id_salt("sources").auto_shrink(false).show(&mut inner, |ui| {
        let names: Vec<(Source, String)> = Source::ALL.iter().map(|source| (*source, name(*source, shown))).collect();
        let whole = ui.available_width() - SPACE;
        let is_macro = |source: Source| section_of(source) == Some("Macros");
        let played = names.iter().filter(|(source, _)| section_of(*source).is_none());
        let macros = names.iter().filter(|(source, _)| is_macro(*source));
        let mut places = Vec::new();
        let mut top = TITLE;
        let tile = if rect.height() >= TALL { TILES[0] } else { TILES[1] };
        for (source, name) in names.iter().filter(|(source, _)| drawn(*source).is_some()) {
            places.push((*source, name, Rect::from_min_size(pos2(0.0, top), vec2(whole, tile))));
            top += tile + SPACE;
        }
        let drags: &[&str] = match shown.preset() {
            Some(_) => &["Drag one to a knob, on any page", "Drag one to a knob"],
            None => &["A kit’s sounds have them"],
        };
        let drags = fitting(ui.painter(), drags, SMALL, whole);
        let mut titles = vec![(drags, 0.0), ("Played", top)];
        top += TITLE;
        let mut left = 0.0;
        for (source, name) in played {
            let size = vec2(chip_width(ui, (*source, name), shown).min(whole), CHIP);
            if left > 0.0 && left + size.x > whole {
                (left, top) = (0.0, top + CHIP + SPACE);
            }
            places.push((*source, name, Rect::from_min_size(pos2(left, top), size)));
            left += size.x + SPACE;
        }
        top += CHIP + SPACE;
        let names =
            if shown.preset().is_some() { &["Macros: right click names one", "Macros"][..] } else { &["Macros"] };
        titles.push((fitting(ui.painter(), names, SMALL, whole), top));
        top += TITLE;
        let macros: Vec<&(Source, String)> = macros.collect();
        let longest =
            macros.iter().map(|(_, name)| least_width(ui.painter(), of_macro(name), TEXT)).fold(0.0, f32::max);
        let wide = |columns: f32| ((whole + SPACE) / columns).floor() - SPACE;
        let fits = |columns: &f32| wide(*columns) >= longest + BESIDE;
        let columns = MACROS.into_iter().find(fits).unwrap_or(MACROS[MACROS.len() - 1]);
        let size = vec2(wide(columns), CHIP);
        for (order, (source, name)) in macros.into_iter().enumerate() {
            let [column, row] = [order as f32 % columns, (order as f32 / columns).floor()];
            let corner = pos2(column * (size.x + SPACE), top + row * (CHIP + SPACE));
            places.push((*source, name, Rect::from_min_size(corner, size)));
        }
        top += (8.0 / columns).ceil() * (CHIP + SPACE);
        let (area, _) = ui.allocate_exact_size(vec2(whole, top), Sense::hover());
        let offset = area.min.to_vec2();
        for (title, top) in titles {
            let place = Rect::from_min_size(pos2(0.0, top), vec2(whole, TITLE - 2.0)).translate(offset);
            line(ui.painter(), place, Align2::LEFT_CENTER, title, SMALL, controls.palette.muted);
        }
        for (source, name, place) in places {
            let place = place.translate(offset);
            let knob = macro_of(source);
            // Where the macros are chosen, it is typed at the knob.
            let is_here = section_of(chosen) != Some("Macros");
            if is_here && knob.is_some_and(|info| naming::field(ui, place, info, controls)) {
                continue;
            }
            let response = show_source(ui, place, (source, name), Some(source == chosen), shown, controls);
            if response.clicked() {
                clicked = section_of(source).map(|_| source).or(clicked);
            }
            let is_asked = response.has_focus() && ui.input(|input| input.key_pressed(Key::F2));
            if let Some(info) = knob.filter(|_| response.secondary_clicked() || is_asked) {
                naming::begin(info, controls);
            }
        }
    });
    clicked
}

/// Shows a source, which can be chosen by a click or is only dragged.
fn show_source(
    ui: &Ui,
    rect: Rect,
    (source, name): (Source, &str),
    chosen: Option<bool>,
    shown: &Shown,
    controls: &mut Controls,
) -> Response {
    let palette = controls.palette;
    // What a click does nothing with is no stop for Tab.
    let (sense, is_chosen) = (chosen.map_or(Sense::DRAG, |_| Sense::click_and_drag()), chosen == Some(true));
    let response = ui.interact(rect, Id::unique(("source", source.id())), sense);
    let (used, is_preset) = (routes_of(source, shown), shown.preset().is_some());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, format!("Source {name}")));
    if is_preset {
        response.dnd_set_drag_payload(source);
    }
    if response.hovered() {
        let routes = match used {
            0 => "It moves nothing yet.".to_owned(),
            1 => "It has one route.".to_owned(),
            count => format!("It has {count} routes."),
        };
        let names = if section_of(source) == Some("Macros") { " Right click, or F2: its name." } else { "" };
        let drags = if is_preset { "Drag it to a knob; held over a tab, it opens that page." } else { OF_KITS };
        *controls.hint = Hint::new(name, format!("{routes} {drags}{names}"));
        if is_preset {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
    }
    let edge = match (response.has_focus(), is_chosen) {
        (true, _) => Stroke::new(1.5, palette.text),
        (_, true) => Stroke::new(1.5, palette.modulation),
        _ if used > 0 => Stroke::new(1.0, palette.modulation.gamma_multiply(0.55)),
        _ => Stroke::new(1.0, palette.line),
    };
    let fill = if response.hovered() { palette.raised } else { palette.panel };
    ui.painter().rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
    let colour = if used > 0 || is_chosen { palette.text } else { palette.muted };
    if let (Some(info), Some(_)) = (macro_of(source), chosen) {
        paint_macro(ui.painter(), rect, (info, name), colour, controls);
        return response;
    }
    let mut inside = rect.shrink2(vec2(6.0, 2.0));
    let section = drawn(source).filter(|_| rect.height() > CHIP);
    let is_tall = rect.height() >= TILES[0];
    let words = if is_tall { inside.with_max_y(rect.center().y + 1.0) } else { inside };
    if used > 0 {
        let now = controls.notes.first().map(|note| note.sources[source as usize]);
        paint_pie(ui.painter(), words.left_center() + vec2(3.0, 0.0), now, palette.modulation);
        inside.min.x += DOT;
    }
    let named = line(ui.painter(), words.with_min_x(inside.left()), Align2::LEFT_CENTER, name, TEXT, colour);
    for section in sections(section.as_slice()) {
        if is_tall {
            let below = inside.with_min_y(rect.center().y + 3.0).with_max_x(inside.center().x);
            line(ui.painter(), below, Align2::LEFT_CENTER, &about(section, used, controls), SMALL, palette.muted);
        }
        let picture = inside.with_min_x((named.right() + 10.0).max(inside.center().x)).shrink2(vec2(0.0, 5.0));
        let mut painter = ui.painter().clone();
        painter.multiply_opacity(if used > 0 || is_chosen { 1.0 } else { UNUSED });
        curves::paint(&painter, picture, section, controls);
        paint_notes(ui, picture, section, notes_of(source, shown, controls), controls);
    }
    response
}

/// What is said of a source with a curve: how an oscillator goes round, and how many routes an envelope has.
fn about(section: Section, used: usize, controls: &Controls) -> String {
    let [rate, sync, shape] = [0, 1, 2].map(|row| &section[row]);
    match (section[0].section.starts_with("LFO"), used) {
        (true, _) if controls.heard(sync) > 0.0 => format!("{}, {}", controls.text(shape), controls.text(sync)),
        (true, _) => format!("{}, {}", controls.text(shape), controls.text(rate)),
        (false, 0) => "not used".to_owned(),
        (false, 1) => "1 route".to_owned(),
        (false, count) => format!("{count} routes"),
    }
}

/// What stands on a macro: its name, or else its number.
fn of_macro(name: &str) -> &str {
    name.strip_prefix("macro ").unwrap_or(name)
}

/// Paints a macro over its value.
fn paint_macro(painter: &Painter, rect: Rect, (info, name): (&ParamInfo, &str), colour: Color32, controls: &Controls) {
    let inside = rect.shrink2(vec2(BESIDE / 2.0, 1.0));
    line(painter, inside, Align2::CENTER_CENTER, of_macro(name), TEXT, colour);
    let under = Rect::from_min_max(rect.left_bottom() + vec2(3.0, -4.0), rect.right_bottom() - vec2(3.0, 2.0));
    let end = under.left() + under.width() * controls.position(info);
    painter.rect_filled(under.with_max_x(end), 1.0, controls.palette.accent);
}

/// Paints the mark of a source that has routes: a disc, or while a note sounds, a pie of its value there.
fn paint_pie(painter: &Painter, centre: Pos2, now: Option<f32>, colour: Color32) {
    let Some(share) = now.map(|value| value.abs().min(1.0)) else {
        painter.circle_filled(centre, 2.5, colour);
        return;
    };
    painter.circle_stroke(centre, PIE, Stroke::new(1.0, colour));
    let corners = (20.0 * share).ceil() as u32;
    if corners == 0 {
        return;
    }
    let corner = |n: u32| centre + PIE * egui::Vec2::angled(TAU * (share * n as f32 / corners as f32 - 0.25));
    let mut pie = Mesh::default();
    pie.colored_vertex(centre, colour);
    (0..=corners).for_each(|n| pie.colored_vertex(corner(n), colour));
    (1..=corners).for_each(|n| pie.add_triangle(0, n, n + 1));
    painter.add(pie);
}
