//! The parameters by section, some sections on each page.

use super::curves;
use crate::editor::controls::Controls;
use crate::editor::routes;
use crate::editor::routes::Ring;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, KNOB, PADDING, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::choice;
use crate::editor::widgets::knob;
use crate::editor::widgets::text::line;
use egui::{Align2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};
use sprung::params::{PARAMS, ParamInfo, Unit};
use sprung::patch::Patch;
use sprung::patch::routes::place_of_amount;
use sprung::preset::Guide;

/// Pages with the sections on them, in the order in which sound is made. The last one has all other sections too.
const PAGES: [(&str, &[&str]); 6] = [
    ("Exciters", &["Mallet", "Pluck", "Noise", "Bow", "Breath", "Rattle", "Input", "Strike"]),
    ("Body, Pitch", &["Body", "Pitch"]),
    ("Modulation", &["Macros", "LFO 1", "LFO 2", "LFO 3", "Envelope 1", "Envelope 2"]),
    ("Routes", &["Routes"]),
    ("Space, Output", &["Strings", "Tremolo", "Drive", "Tone", "Space", "Output"]),
    ("Voices", &["Voices", "Control"]),
];

/// The names of the pages.
pub(super) fn pages() -> impl Iterator<Item = &'static str> {
    PAGES.iter().map(|(name, _)| *name)
}

/// The parameters of a section.
type Section = &'static [ParamInfo];

/// The sections of a page.
fn sections(page: usize) -> impl Iterator<Item = Section> {
    let page_of =
        |section: &str| PAGES.iter().position(|(_, names)| names.contains(&section)).unwrap_or(PAGES.len() - 1);
    PARAMS.chunk_by(|a, b| a.section == b.section).filter(move |rows| page_of(rows[0].section) == page)
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

/// Shows a page of sections of a patch. `is_editable` is false for kits, whose sounds have routes of their own.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    page: usize,
    (patch, guide, is_editable): (&Patch, &Guide, bool),
    controls: &mut Controls,
) {
    let rows = (((rect.height() - TITLE_HEIGHT - PADDING) / CELL_HEIGHT) as usize).max(1);
    let columns = |section: Section| section.len().div_ceil(rows);
    let count: usize = sections(page).map(columns).sum();
    let gaps = sections(page).count() as f32 * (2.0 * PADDING + GAP) - GAP;
    let [least, most] = CELL_WIDTH;
    let is_routes = sections(page).all(|section| section[0].section == "Routes");
    let most = if is_routes { f32::INFINITY } else { most };
    let cell_width = ((rect.width() - gaps) / count.max(1) as f32).floor().clamp(least, most);
    let cell_width = if is_routes { cell_width.max(110.0) } else { cell_width };
    let width = count as f32 * cell_width + gaps;
    let mut inner = ui.new_child(UiBuilder::new().id_salt("sections").max_rect(rect));
    ScrollArea::horizontal().id_salt(page).auto_shrink(false).show(&mut inner, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(width, rect.height()), egui::Sense::hover());
        let mut left = area.left();
        for section in sections(page) {
            let size = vec2(columns(section) as f32 * cell_width + 2.0 * PADDING, area.height());
            let panel = Rect::from_min_size(pos2(left, area.top()), size);
            left = panel.right() + GAP;
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
            for (place, info) in section.iter().enumerate() {
                let (column, row) = (place % columns(section), place / columns(section));
                let offset = vec2(column as f32 * cell_width, row as f32 * CELL_HEIGHT);
                let corner = panel.min + vec2(PADDING, TITLE_HEIGHT) + offset;
                let cell = Rect::from_min_size(corner, vec2(cell_width, CELL_HEIGHT - 4.0)).shrink2(vec2(1.0, 0.0));
                let ring = Ring::of(info, &patch.routes, controls);
                match place_of_amount(info.param) {
                    Some(place) => {
                        let name = routes::name(place, &patch.routes, guide);
                        // The amount of a free place means nothing.
                        match patch.routes.get(place) {
                            Some(_) => knob::show(ui, cell, info, &name, &ring, controls),
                            None => knob::show_none(ui.painter(), cell, &name, palette),
                        }
                        if is_editable {
                            routes::show(ui, knob::name_rect(cell), place, &patch.routes, guide, controls);
                        }
                    }
                    None if info.unit == Unit::Choice => {
                        choice::show(ui, cell, info, &short_name(info, guide), controls);
                    }
                    None => knob::show(ui, cell, info, &short_name(info, guide), &ring, controls),
                }
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_is_on_one_page() {
        let mut found: Vec<&str> = (0..PAGES.len()).flat_map(sections).flatten().map(|info| info.id).collect();
        let mut all: Vec<&str> = PARAMS.iter().map(|info| info.id).collect();
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all);
        for (page, (name, names)) in PAGES.iter().enumerate() {
            let found: Vec<&str> = sections(page).map(|section| section[0].section).collect();
            assert!(names.iter().all(|name| found.contains(name)), "{name}: {found:?}");
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
