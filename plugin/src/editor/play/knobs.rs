//! The knobs that matter: the macros that have names, with a place to name another, the essential ones, and the gain.

use crate::editor::controls::naming::{self, macro_number};
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::lamps;
use crate::editor::motion::sources;
use crate::editor::pages::sections::ADDED;
use crate::editor::routes::Ring;
use crate::editor::routes::list::effects;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, KNOB, PADDING, SMALL, paint_panel};
use crate::editor::widgets::knob;
use crate::editor::widgets::text::line;
use egui::{Align2, Id, Rect, Role, ScrollArea, Sense, Shape, Stroke, Ui, UiBuilder, Vec2, WidgetInfo, vec2};
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::routes::Source;
use sprung_picture::play::{ESSENTIALS, needs_space};
use std::f32::consts::TAU;

/// What players move most, to be dragged to these knobs or, by way of a tab, to any.
pub(super) const SOURCES: [Source; 6] =
    [Source::Velocity, Source::Pressure, Source::Wheel, Source::Lfo1, Source::Envelope1, Source::Random];

/// The title of the macros, and of the essential knobs, beside which these sources stand.
const MACROS: &str = "MACROS";
const ESSENTIAL: &str = "ESSENTIALS";

/// How many dashes the place has where a macro is added, and the share of its round that they take.
const DASHES: usize = 14;
const DASH: f32 = 0.6;

/// Height of a cell whose knob's face is so wide.
pub(super) fn cell_height(side: f32) -> f32 {
    CELL_HEIGHT - KNOB + side
}

/// Shows the macros that have names, the essential knobs and the gain, with a title so high and faces so wide.
pub(super) fn show(ui: &mut Ui, rect: Rect, [title, side]: [f32; 2], shown: &Shown, controls: &mut Controls) {
    let palette = controls.palette;
    paint_panel(ui.painter(), rect, palette);
    // Each sound of a kit has others.
    let naming = controls.interaction.naming.as_ref().map(|naming| naming.info.param);
    let has_name = |info: &ParamInfo| shown.guide().macro_name(info.id).is_some();
    let named = |info: &&'static ParamInfo| shown.preset().is_some() && (has_name(info) || naming == Some(info.param));
    let macros: Vec<(&'static ParamInfo, String)> = PARAMS
        .iter()
        .filter(named)
        .map(|info| (info, shown.guide().macro_name(info.id).unwrap_or_default().to_owned()))
        .collect();
    let next = next(shown, controls);
    let has_space = controls.value(Param::Space.info()) > 0.0;
    let matters = |param: &Param| has_space || !needs_space(*param);
    let essentials = ESSENTIALS.into_iter().filter(|(param, _)| matters(param));
    let essentials = essentials.map(|(param, name)| (param.info(), name.to_owned()));
    let gain = (Param::Gain.info(), "Gain".to_owned());
    // In a kit, apart from those that are the kit's own.
    let (added, essentials): (Vec<_>, Vec<_>) = essentials.partition(|(info, _)| controls.own(info).is_some());
    let (added, output) =
        if added.is_empty() { (added, vec![gain]) } else { ([added, vec![gain]].concat(), Vec::new()) };
    let groups = [(MACROS, macros), (ADDED, added), (ESSENTIAL, essentials), ("OUTPUT", output)];
    let adds = |name: &str| name == MACROS && next.is_some();
    let cells = |(name, knobs): &(&str, Vec<_>)| knobs.len() + usize::from(adds(name));
    let count: usize = groups.iter().map(cells).sum();
    let spaces = groups.iter().filter(|group| cells(group) > 0).count().saturating_sub(1) as f32;
    let inside = rect.shrink(PADDING);
    let room = inside.width() - spaces * 2.0 * GAP;
    let width = (room / count as f32).floor().clamp(CELL_WIDTH[0], CELL_WIDTH[1] + 12.0);
    // What is left over stands between the groups, so that the last ends at the right.
    let gap = (2.0 * GAP + (room - count as f32 * width).max(0.0) / spaces.max(1.0)).floor();
    let mut inner = ui.new_child(UiBuilder::new().id_salt("play knobs").max_rect(inside));
    ScrollArea::horizontal().id_salt("play").auto_shrink(false).show(&mut inner, |ui| {
        let size = vec2(count as f32 * width + spaces * gap, inside.height());
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        let mut corner = area.min;
        for group in groups.into_iter().filter(|group| cells(group) > 0) {
            let (wide, (name, knobs)) = (cells(&group) as f32 * width, group);
            if title > 0.0 {
                let place = Rect::from_min_size(corner, vec2(wide, title - 4.0));
                let named = line(ui.painter(), place, Align2::LEFT_CENTER, name, SMALL, palette.muted);
                if name == ESSENTIAL && shown.preset().is_some() {
                    let place = place.with_min_x(named.right() + 2.0 * GAP).with_max_x(place.right() + gap - GAP);
                    sources::show_line(ui, place, &SOURCES, shown, controls);
                }
            }
            for (info, name) in knobs {
                let cell = Rect::from_min_size(corner + vec2(0.0, title), vec2(width, cell_height(side) - 4.0));
                let ring = Ring::of(info, (&shown.patch().routes, shown.guide()), controls);
                lamps::dimmed(ui, cell, info, shown.patch(), controls, |ui, controls| {
                    knob::show(ui, (cell.shrink2(vec2(1.0, 0.0)), side), info, &name, &ring, controls);
                });
                if ui.rect_contains_pointer(cell)
                    && let Some(effects) = effects(info, shown.patch(), controls)
                {
                    *controls.hint = Hint::new(format!("{name} {}", controls.text(info)), format!("It {effects}."));
                }
                corner.x += width;
            }
            if let Some(info) = next.filter(|_| adds(name)) {
                let cell = Rect::from_min_size(corner + vec2(0.0, title), vec2(width, cell_height(side) - 4.0));
                add(ui, cell, side, info, controls);
                corner.x += width;
            }
            corner.x += gap;
        }
    });
}

/// The macro that gets a name next: the first without one that moves something, or else the first without one. None in a kit, while one
/// is being named, and when all have names.
fn next(shown: &Shown, controls: &Controls) -> Option<&'static ParamInfo> {
    shown.preset().filter(|_| controls.interaction.naming.is_none())?;
    let is_unnamed = |info: &&ParamInfo| macro_number(info).is_some() && shown.guide().macro_name(info.id).is_none();
    let moves = |info: &&&ParamInfo| {
        let is_of = |source: Source| source.id() == info.id;
        let mut routes = shown.patch().routes.iter();
        routes.any(|(_, route)| is_of(route.source) || route.scale.is_some_and(is_of))
    };
    let unnamed: Vec<&ParamInfo> = PARAMS.iter().filter(is_unnamed).collect();
    unnamed.iter().find(moves).or(unnamed.first()).copied()
}

/// Shows the place where a macro is added, by its name.
fn add(ui: &Ui, cell: Rect, side: f32, info: &'static ParamInfo, controls: &mut Controls) {
    let palette = controls.palette;
    let response = ui.interact(cell, Id::unique("add a macro"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Add a macro"));
    let is_hot = response.hovered() || response.has_focus();
    let colour = if is_hot { palette.text } else { palette.muted };
    let centre = cell.center_top() + vec2(0.0, side / 2.0 + 1.0);
    let radius = side / 2.0 - 5.0;
    for dash in 0..DASHES {
        let at = |share: f32| centre + radius * Vec2::angled(TAU * (dash as f32 + share * DASH) / DASHES as f32);
        let points = (0..=3).map(|step| at(step as f32 / 3.0)).collect();
        ui.painter().add(Shape::line(points, Stroke::new(1.2, colour)));
    }
    for arm in [vec2(0.3 * radius, 0.0), vec2(0.0, 0.3 * radius)] {
        ui.painter().line_segment([centre - arm, centre + arm], Stroke::new(1.2, colour));
    }
    line(ui.painter(), knob::name_rect(cell, side), Align2::CENTER_CENTER, "add", SMALL, colour);
    if response.has_focus() {
        ui.painter().circle_stroke(centre, radius + 3.0, Stroke::new(1.5, palette.text));
    }
    if is_hot {
        let help = "Type a name: the macro stands here then. Drag it to knobs on Motion; its menu names it again.";
        *controls.hint = Hint::new(format!("Name {}", info.name), help);
    }
    if response.clicked() {
        naming::begin(info, controls);
    }
}
