//! The parameters by section, some sections on each page.

use super::curves;
use crate::editor::controls::Controls;
use crate::editor::lamps::{self, Lamp};
use crate::editor::routes::Ring;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, KNOB, PADDING, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::choice;
use crate::editor::widgets::knob;
use crate::editor::widgets::text::line;
use egui::{Align2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};
use sprung::params::{PARAMS, ParamInfo, Unit};
use sprung::patch::Patch;
use sprung::patch::routes::amount_param;
use sprung::preset::Guide;

/// The sections of each page, in the order in which sound is made.
pub(super) const PAGES: [&[&str]; 4] = [
    &["Mallet", "Pluck", "Noise", "Bow", "Breath", "Input", "Strike"],
    &["Body", "Rattle", "Pitch"],
    &["Soundbox", "Strings", "Tremolo", "Drive", "Tone", "Space", "Output"],
    &["Voices", "Control"],
];
/// How much of the brightness is left of a part that is off.
const OFF: f32 = 0.6;

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
    (patch, guide, is_preset): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    // What a route can raise is not off.
    let is_raised = |lamp: &Lamp| {
        let routes = patch.routes.iter().filter(|(_, route)| lamp.params().any(|param| param == route.destination));
        routes.map(|(place, _)| controls.value(amount_param(place).info())).any(|amount| amount != 0.0)
    };
    let acts = |lamp: &Lamp| !is_preset || lamp.is_on(controls) || is_raised(lamp);
    let is_on = |section: Section| lamps::of(section[0].section).is_none_or(acts);
    let shown: Vec<(Section, bool)> = sections(names)
        .map(|section| (section, is_on(section)))
        .filter(|(section, is_on)| *is_on || section[0].section == selected)
        .collect();
    let rows = (((rect.height() - TITLE_HEIGHT - PADDING) / CELL_HEIGHT) as usize).max(1);
    let columns = |section: Section| section.len().div_ceil(rows);
    let count: usize = shown.iter().map(|(section, _)| columns(section)).sum();
    let gaps = shown.len() as f32 * (2.0 * PADDING + GAP) - GAP;
    let [least, most] = CELL_WIDTH;
    let cell_width = ((rect.width() - gaps) / count.max(1) as f32).floor().clamp(least, most);
    let width = count as f32 * cell_width + gaps;
    let mut inner = ui.new_child(UiBuilder::new().id_salt("sections").max_rect(rect));
    ScrollArea::horizontal().id_salt(names).auto_shrink(false).show(&mut inner, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(width, rect.height()), egui::Sense::hover());
        let mut left = area.left();
        for (section, is_on) in shown {
            ui.set_opacity(if is_on { 1.0 } else { OFF });
            let size = vec2(columns(section) as f32 * cell_width + 2.0 * PADDING, area.height());
            let panel = Rect::from_min_size(pos2(left, area.top()), size);
            left = panel.right() + GAP;
            if is_new && section[0].section == selected {
                ui.scroll_to_rect(panel, None);
            }
            let palette = controls.palette;
            palette.paint_panel(ui.painter(), panel);
            let title = Rect::from_min_size(panel.min + vec2(PADDING, 2.0), vec2(size.x - PADDING, TITLE_HEIGHT - 2.0));
            line(ui.painter(), title, Align2::LEFT_CENTER, &section[0].section.to_uppercase(), SMALL, palette.muted);
            // A picture in the last row if it has room for one, otherwise a small one beside the title.
            let free = (columns(section) - section.len() % columns(section)) % columns(section);
            let picture = if free > 0 {
                let row = panel.top() + TITLE_HEIGHT + (section.len() / columns(section)) as f32 * CELL_HEIGHT;
                let left = panel.right() - PADDING - free as f32 * cell_width;
                let place = Rect::from_min_size(pos2(left, row), vec2(free as f32 * cell_width, KNOB + 14.0));
                place.shrink2(vec2(6.0, 2.0))
            } else {
                let width = (0.45 * size.x).min(76.0);
                let corner = panel.right_top() + vec2(-width - PADDING, 4.0);
                Rect::from_min_size(corner, vec2(width, TITLE_HEIGHT - 6.0))
            };
            curves::paint(ui.painter(), picture, section, controls);
            let grid = Rect::from_min_size(panel.min + vec2(PADDING, TITLE_HEIGHT), vec2(cell_width, CELL_HEIGHT));
            knobs(ui, grid, columns(section), section, (patch, guide), controls);
        }
    });
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
        let cell = Rect::from_min_size(first.min + offset, first.size() - vec2(0.0, 4.0)).shrink2(vec2(1.0, 0.0));
        let ring = Ring::of(info, &patch.routes, controls);
        let name = short_name(info, guide);
        if info.unit == Unit::Choice {
            choice::show(ui, cell, info, &name, controls);
        } else {
            knob::show(ui, cell, info, &name, &ring, controls);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::motion::sources::section_of;
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
