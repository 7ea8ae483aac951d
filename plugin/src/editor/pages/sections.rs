//! The parameters by section, some sections on each page.

use super::curves;
use crate::editor::body::face;
use crate::editor::controls::Controls;
use crate::editor::lamps::{self, Lamp, has_effect, is_raised};
use crate::editor::play::stage::Floor;
use crate::editor::routes::Ring;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, KNOB, PADDING, RADIUS, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::choice;
use crate::editor::widgets::knob;
use crate::editor::widgets::text::{fitting, line};
use egui::{Align2, Painter, Rect, ScrollArea, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2};
use sprung::params::{Choice as _, PARAMS, Param, ParamInfo, Space, Unit};
use sprung::patch::Patch;
use sprung::preset::Guide;
use sprung_picture::Figure;

/// The sections of each page, in the order in which sound is made.
pub(super) const PAGES: [&[&str]; 4] = [
    &["Mallet", "Pluck", "Noise", "Bow", "Breath", "Input", "Strike"],
    &["Body", "Rattle", "Pitch"],
    &["Soundbox", "Strings", "Tremolo", "Drive", "Tone", "Space", "Output"],
    &["Voices", "Control"],
];
/// Width of a picture at the left of the knobs, with the gap after it; and the least of one in their last row.
const PICTURE: f32 = 132.0;
const SMALLEST: f32 = 50.0;
/// Least width of a cell, in which each name and each choice is whole, and the space at its left and right.
const LEAST: f32 = 73.0;
const BESIDE: f32 = 3.0;
/// Said of the knobs of a kit.
pub(in crate::editor) const ADDED: &str = "added to what each pad has";
/// Said below a picture of nothing.
const CHOOSE: &str = "none: choose a type";
/// How much of the brightness is left of a part that is off, and of a knob that has no effect.
const OFF: f32 = 0.7;

/// Whether a page shows a section.
pub(super) fn shows(page: usize, section: &str) -> bool {
    PAGES.get(page).is_some_and(|sections| sections.contains(&section))
}

/// The parameters of a section.
pub(in crate::editor) type Section = &'static [ParamInfo];

/// The sections of these names.
pub(in crate::editor) fn sections(names: &[&str]) -> impl Iterator<Item = Section> {
    PARAMS.chunk_by(|a, b| a.section == b.section).filter(|rows| names.contains(&rows[0].section))
}

/// The name of a parameter within its section: without the section's name, and for a macro, the preset's name for it.
fn short_name(info: &ParamInfo, guide: &Guide) -> String {
    if let Some(name) = guide.macro_name(info.id) {
        return name.to_owned();
    }
    let rest = info.name.strip_prefix(info.section).unwrap_or(info.name).trim();
    let mut letters = rest.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None if info.unit == Unit::Choice => "Type".to_owned(),
        None if info.unit == Unit::Count => "Number".to_owned(),
        None => "Level".to_owned(),
    }
}

/// Shows a page of sections of a patch, whole for a kit: of parts of a preset that are off, only the selected one, which `is_new` if it must be scrolled to.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    names: &'static [&'static str],
    (selected, is_new): (&str, bool),
    (patch, guide, is_preset, figure): (&Patch, &Guide, bool, &Figure),
    controls: &mut Controls,
) {
    // What a route can raise is not off.
    let acts = |lamp: &Lamp| !is_preset || lamp.is_on(controls) || is_raised(lamp.params(), patch, controls);
    let is_on = |section: Section| lamps::of(section[0].section).is_none_or(acts);
    let shown: Vec<(Section, bool)> = sections(names)
        .map(|section| (section, is_on(section)))
        .filter(|(section, is_on)| *is_on || section[0].section == selected)
        .collect();
    let rows = (((rect.height() - TITLE_HEIGHT - PADDING) / CELL_HEIGHT) as usize).max(1);
    let columns = |section: Section| section.len().div_ceil(rows);
    let count: usize = shown.iter().map(|(section, _)| columns(section)).sum();
    let gaps = shown.len() as f32 * (2.0 * PADDING + GAP) - GAP;
    let (least, most) = (LEAST, CELL_WIDTH[1]);
    // Pictures at the left of the knobs where there is room, the selected part's first.
    let room = (rect.width() - gaps - count as f32 * least) / PICTURE;
    let pictures = if rows > 1 { room.max(0.0) as usize } else { 0 };
    let is_other = |(section, _): &&(Section, bool)| section[0].section != selected;
    let (others, first): (Vec<_>, Vec<_>) =
        shown.iter().filter(|(section, _)| has_picture(section)).partition(is_other);
    let large: Vec<&str> = first.iter().chain(&others).take(pictures).map(|(section, _)| section[0].section).collect();
    let aside = large.len() as f32 * PICTURE;
    let cell_width = ((rect.width() - gaps - aside) / count.max(1) as f32).floor().clamp(least, most);
    let width = count as f32 * cell_width + gaps + aside;
    let mut inner = ui.new_child(UiBuilder::new().id_salt("sections").max_rect(rect));
    ScrollArea::horizontal().id_salt(names).auto_shrink(false).show(&mut inner, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(width, rect.height()), egui::Sense::hover());
        let mut left = area.left();
        for (section, is_on) in shown {
            ui.set_opacity(if is_on { 1.0 } else { OFF });
            let is_large = large.contains(&section[0].section);
            let aside = if is_large { PICTURE } else { 0.0 };
            let size = vec2(columns(section) as f32 * cell_width + 2.0 * PADDING + aside, area.height());
            let panel = Rect::from_min_size(pos2(left, area.top()), size);
            left = panel.right() + GAP;
            if is_new && section[0].section == selected {
                ui.scroll_to_rect(panel, None);
            }
            let palette = controls.palette;
            palette.paint_panel(ui.painter(), panel);
            if section[0].section == selected {
                let edge = Stroke::new(1.0, palette.accent.gamma_multiply(0.6));
                ui.painter().rect_stroke(panel, RADIUS, edge, StrokeKind::Inside);
            }
            let title = Rect::from_min_size(panel.min + vec2(PADDING, 2.0), vec2(size.x - PADDING, TITLE_HEIGHT - 2.0));
            show_title(ui.painter(), title, section, controls);
            if is_large {
                let side = PICTURE - GAP;
                let height = (panel.height() - TITLE_HEIGHT - PADDING).min(1.15 * side);
                let place = Rect::from_min_size(panel.min + vec2(PADDING, TITLE_HEIGHT), vec2(side, height));
                curves::frame(ui.painter(), place, palette, |place| {
                    picture(ui.painter(), place, section, figure, controls)
                });
            }
            // A picture in the last row if it has room for one.
            let free = (columns(section) - section.len() % columns(section)) % columns(section);
            if free > 0 && !is_large {
                let row = panel.top() + TITLE_HEIGHT + (section.len() / columns(section)) as f32 * CELL_HEIGHT;
                let left = panel.right() - PADDING - free as f32 * cell_width;
                let place = Rect::from_min_size(pos2(left, row), vec2(free as f32 * cell_width, KNOB + 14.0));
                let picture = place.shrink2(vec2(6.0, 2.0));
                if picture.width() > SMALLEST {
                    curves::paint(ui.painter(), picture, section, controls);
                }
            }
            let corner = panel.min + vec2(PADDING + aside, TITLE_HEIGHT);
            let grid = Rect::from_min_size(corner, vec2(cell_width, CELL_HEIGHT));
            knobs(ui, grid, columns(section), section, (patch, guide), controls);
        }
    });
}

/// Shows the name of a section, and where its knobs move each pad's own values, that they do.
pub(in crate::editor) fn show_title(painter: &Painter, rect: Rect, section: Section, controls: &Controls) {
    let muted = controls.palette.muted;
    let name = line(painter, rect, Align2::LEFT_CENTER, &section[0].section.to_uppercase(), SMALL, muted);
    if section.iter().any(|info| controls.own(info).is_some()) {
        let rest = rect.with_min_x(name.right() + GAP);
        let says = fitting(painter, &[ADDED, "added to each pad", "added", ""], SMALL, rest.width());
        line(painter, rest, Align2::LEFT_CENTER, says, SMALL, controls.palette.accent_text);
    }
}

/// Whether a section has a large picture.
fn has_picture(section: Section) -> bool {
    !matches!(section[0].section, "Input" | "Voices" | "Control")
}

/// Draws the picture of a section, if it has one. Returns what it shows.
pub(super) fn picture(
    painter: &Painter,
    rect: Rect,
    section: Section,
    figure: &Figure,
    controls: &Controls,
) -> Option<String> {
    match section[0].param {
        Param::Decay => {
            face::paint_still(painter, rect, figure, controls.palette);
            Some("the body".to_owned())
        }
        Param::Space => {
            let (space, material) = (Param::Space.info(), Param::SpaceMaterial.info());
            let kind = Space::from_value(controls.value(space));
            let is_room = kind == Space::Room;
            // Of a floor without walls, the picture has no more above than is needed.
            let above = if is_room { 0.0 } else { 0.9 * rect.height() };
            let (frame, floor) = (rect.expand(6.0), rect.with_min_y(rect.top() - above).expand(6.0));
            let painter = painter.with_clip_rect(frame.intersect(painter.clip_rect()));
            Floor::of(floor, rect, controls).paint(&painter, 0.0, controls);
            if kind == Space::None {
                return Some(CHOOSE.to_owned());
            }
            let of = if is_room { String::new() } else { format!(" of {}", controls.text(material)) };
            Some(format!("{}{of}", controls.text(space)))
        }
        _ => curves::paint(painter, rect, section, controls).or_else(|| Some(CHOOSE.to_owned())),
    }
}

/// Shows the parameters of a section in columns, from a first cell on.
pub(in crate::editor) fn knobs(
    ui: &mut Ui,
    first: Rect,
    columns: usize,
    section: Section,
    (patch, guide): (&Patch, &Guide),
    controls: &mut Controls,
) {
    for (place, info) in section.iter().enumerate() {
        let offset = vec2((place % columns) as f32 * first.width(), (place / columns) as f32 * first.height());
        let cell = Rect::from_min_size(first.min + offset, first.size() - vec2(0.0, 4.0)).shrink2(vec2(BESIDE, 0.0));
        let ring = Ring::of(info, &patch.routes, controls);
        let name = short_name(info, guide);
        let opacity = ui.opacity();
        ui.set_opacity(if has_effect(info, patch, controls) { opacity } else { opacity.min(OFF) });
        if info.unit == Unit::Choice {
            choice::show(ui, cell, info, &name, controls);
        } else {
            knob::show(ui, (cell, KNOB), info, &name, &ring, controls);
        }
        ui.set_opacity(opacity);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::motion::sources::section_of;
    use crate::editor::widgets::text;
    use sprung::patch::routes::Source;

    #[test]
    fn every_parameter_is_on_one_page() {
        // Those of sources are on the face of what moves, as are the routes.
        let mut moving: Vec<&str> = Source::ALL.iter().filter_map(|source| section_of(*source)).collect();
        moving.dedup();
        let pages = || PAGES.into_iter().chain([&moving[..], &["Routes"]]);
        let mut found: Vec<&str> = pages().flat_map(sections).flatten().map(|info| info.id).collect();
        let mut all: Vec<&str> = PARAMS.iter().map(|info| info.id).collect();
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all);
        for names in pages() {
            assert_eq!(sections(names).count(), names.len(), "{names:?}");
        }
    }

    #[test]
    fn names_and_choices_are_whole_in_the_smallest_cell() {
        let context = egui::Context::default();
        let mut cut = Vec::new();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let width = |text: &str| text::least_width(ui.painter(), text, SMALL);
            for info in PAGES.into_iter().flat_map(sections).flatten() {
                let name = short_name(info, &Guide::default());
                let wide = info
                    .choices
                    .iter()
                    .filter(|choice| width(choice) > LEAST - 2.0 * BESIDE - choice::BESIDE - choice::AROUND);
                cut.extend((width(&name) > LEAST - 2.0 * BESIDE).then(|| name.clone()));
                cut.extend(wide.map(|choice| format!("{name}: {choice}")));
            }
        });
        output.textures_delta.clear();
        assert!(cut.is_empty(), "{cut:?}");
    }

    #[test]
    fn names_do_not_repeat_their_section() {
        let short = |id: &str| {
            let info = PARAMS.iter().find(|info| info.id == id).unwrap();
            short_name(info, &Guide { macros: vec!["Shine".to_owned()], ..Guide::default() })
        };
        let cases = [("mallet_level", "Level"), ("envelope2_attack", "Attack"), ("gain", "Gain"), ("space", "Type")];
        for (id, name) in
            cases.into_iter().chain([("macro1", "Shine"), ("macro2", "Macro 2"), ("strings_level", "Level")])
        {
            assert_eq!(short(id), name, "{id}");
        }
    }
}
