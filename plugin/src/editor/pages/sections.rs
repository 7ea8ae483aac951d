//! The parameters of a section: their names, their knobs, and a picture of what they do together.

use super::curves;
use crate::editor::body::face;
use crate::editor::controls::Controls;
use crate::editor::lamps;
use crate::editor::play::stage;
use crate::editor::routes::Ring;
use crate::editor::theme::{GAP, KNOB, SMALL};
use crate::editor::widgets::choice;
use crate::editor::widgets::knob;
use crate::editor::widgets::text::{fitting, line};
use egui::{Align2, Painter, Rect, Ui, vec2};
use sprung::params::{Choice as _, PARAMS, Param, ParamInfo, Space, Unit};
use sprung::patch::Patch;
use sprung::preset::Guide;
use sprung_picture::Figure;

/// Least width of a cell, in which each name and each choice is whole, and the space at its left and right.
pub(super) const LEAST: f32 = 73.0;
const BESIDE: f32 = 3.0;
/// Said of the knobs of a kit.
pub(in crate::editor) const ADDED: &str = "added to what each pad has";
/// Said below a picture of nothing.
const CHOOSE: &str = "none: choose a type";

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

/// Whether a section has a picture.
pub(super) fn has_picture(section: Section) -> bool {
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
            stage::paint(&stage::floor(floor, rect, controls), &painter, 0.0, controls);
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
        let cell = Rect::from_min_size(first.min + offset, first.size() - vec2(0.0, 4.0));
        knob_at(ui, cell, info, (patch, guide), controls);
    }
}

/// Shows a parameter in a cell.
pub(super) fn knob_at(
    ui: &mut Ui,
    cell: Rect,
    info: &'static ParamInfo,
    (patch, guide): (&Patch, &Guide),
    controls: &mut Controls,
) {
    let ring = Ring::of(info, (&patch.routes, guide), controls);
    let (name, cell) = (short_name(info, guide), cell.shrink2(vec2(BESIDE, 0.0)));
    lamps::dimmed(ui, cell, info, patch, controls, |ui, controls| {
        if info.unit == Unit::Choice {
            choice::show(ui, cell, info, &name, controls);
        } else {
            knob::show(ui, (cell, KNOB), info, &name, &ring, controls);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::motion::sources::section_of;
    use crate::editor::pages::parts::groups;
    use crate::editor::pages::path::PATH;
    use crate::editor::widgets::text;
    use sprung::patch::routes::Source;

    /// The sections of sources, whose knobs are on the face of what moves, as those of routes are.
    fn moving() -> Vec<&'static str> {
        let mut moving: Vec<&str> = Source::ALL.iter().filter_map(|source| section_of(*source)).collect();
        moving.dedup();
        moving
    }

    /// The knobs of all parts of the sound's way.
    fn parts() -> impl Iterator<Item = &'static ParamInfo> {
        let parts = PATH.into_iter().flatten().copied().flatten().copied();
        parts.flat_map(groups).flat_map(|(_, knobs)| knobs)
    }

    #[test]
    fn every_parameter_is_in_one_place() {
        let elsewhere = [&moving()[..], &["Routes"]].concat();
        let mut found: Vec<&str> = parts().chain(sections(&elsewhere).flatten()).map(|info| info.id).collect();
        let mut all: Vec<&str> = PARAMS.iter().map(|info| info.id).collect();
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all);
        assert_eq!(sections(&elsewhere).count(), elsewhere.len());
    }

    #[test]
    fn names_and_choices_are_whole_in_the_smallest_cell() {
        let context = egui::Context::default();
        let mut cut = Vec::new();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let width = |text: &str| text::least_width(ui.painter(), text, SMALL);
            for info in parts() {
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
