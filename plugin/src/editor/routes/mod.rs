//! Routes: their names, and the menus that make, change and remove them.

pub(super) mod carry;
pub(super) mod learn;
pub(super) mod list;
mod matrix;

use crate::editor::controls::gestures;
use crate::editor::controls::{Controls, Said, moved_in};
use crate::loaded::positions_of;
use egui::{Button, Id, Popup, Rect, Role, ScrollArea, Sense, Ui, WidgetInfo};
use sprung::engine::SoundingNote;
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::Patch;
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Routes, Source, amount_param};
use sprung::preset::{Guide, Playable};

/// The amount of a new route, in per cent.
const AMOUNT: f32 = 25.0;

/// Why a route cannot be added.
pub(super) const OF_KITS: &str = "a kit’s sounds have routes of their own";
const ALL_TAKEN: &str = "all sixteen routes are taken";

/// The name of a source as shown to the user, such as `LFO 1`; for a macro, the preset's name for it: a macro *Pressure* is not the
/// pressure of the keys.
pub(super) fn source_name(source: Source, guide: &Guide) -> String {
    if let Some(name) = guide.macro_name(source.id()) {
        return format!("macro {name}");
    }
    let mut name = source.id().replace('_', " ").replace("lfo", "LFO");
    if let Some(number) = name.find(|letter: char| letter.is_ascii_digit()) {
        name.insert(number, ' ');
    }
    name
}

/// The name of a route, such as `wheel › Vibrato`; of an empty place, what a click on it does.
pub(super) fn name(place: usize, routes: &Routes, guide: &Guide) -> String {
    let Some(Route { source, destination, scale, .. }) = routes.get(place) else {
        return "add a route".to_owned();
    };
    let scale = scale.map_or(String::new(), |scale| format!(" × {}", source_name(scale, guide)));
    format!("{}{scale} › {}", source_name(source, guide), destination.info().name)
}

/// Whether a route moves its parameter to both sides.
fn goes_both_ways(route: &Route) -> bool {
    route.source.is_bipolar() || route.scale.is_some_and(Source::is_bipolar)
}

/// The modulation of a parameter, as a knob shows it.
#[derive(Default)]
pub(super) struct Ring {
    /// The parts of its travel that routes can move it to: by each amount, to both sides if the source has both.
    pub(super) ranges: Vec<[f32; 2]>,
    /// The modulated position in each sounding note, the newest note first.
    pub(super) marks: Vec<f32>,
}

impl Ring {
    pub(super) fn of(info: &ParamInfo, routes: &Routes, controls: &Controls) -> Self {
        // Where the knob says by how much a value is moved, the value itself has no place on it.
        if controls.own(info).is_some() {
            return Self::default();
        }
        let position = controls.position(info);
        let range = |(place, route): (usize, Route)| {
            let amount = controls.value(amount_param(place).info()) / 100.0;
            let from = if goes_both_ways(&route) { position - amount } else { position };
            [from, position + amount].map(|end| end.clamp(0.0, 1.0))
        };
        let these = routes.iter().filter(|(_, route)| route.destination == info.param);
        let ranges = these.map(range).filter(|[from, to]| from != to).collect();
        let marks = controls.modulated(info).map(|value| info.normalise(value) as f32).collect();
        Self { ranges, marks }
    }
}

/// Where each sounding note is on the bar of a route, from 0 to 1, the newest note first.
fn now(place: usize, route: &Route, controls: &Controls) -> Vec<f32> {
    let info = amount_param(place).info();
    let amount = |note: &SoundingNote| moved_in(note, info).unwrap_or(controls.heard(info));
    let on_bar = |note: &SoundingNote| (0.5 + 0.5 * note.travel(route, amount(note))).clamp(0.0, 1.0);
    controls.notes.iter().map(on_bar).collect()
}

/// Makes the place of a route's sentence a button that opens its menu.
fn button(
    ui: &Ui,
    rect: Rect,
    place: usize,
    routes: &Routes,
    guide: &Guide,
    controls: &mut Controls,
) -> egui::Response {
    let response = ui.interact(rect, Id::unique(("route", place)), Sense::click());
    let label = format!("Route {}: {}", place + 1, name(place, routes, guide));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    Popup::menu(&response).show(|ui| {
        ui.set_min_width(140.0);
        let route = routes.get(place);
        let base = route.unwrap_or(Route::linear(Source::Velocity, Param::MalletHardness));
        let mut wanted = None;
        ui.menu_button("Source", |ui| {
            let is_here = |source| route.is_some_and(|route| route.source == source);
            wanted = wanted.or(sources(ui, guide, is_here).map(|source| Some(Route { source, ..base })));
        });
        ui.menu_button("Destination", |ui| {
            wanted = wanted.or(destinations(ui).map(|destination| Some(Route { destination, ..base })));
        });
        if route.is_some() {
            ui.menu_button("Multiplied by", |ui| {
                if ui.button("nothing").clicked() {
                    wanted = Some(Some(Route { scale: None, ..base }));
                }
                let is_here = |source| base.scale == Some(source);
                wanted = wanted.or(sources(ui, guide, is_here).map(|scale| Some(Route { scale: Some(scale), ..base })));
            });
            ui.menu_button("Response", |ui| {
                for response in Response::ALL {
                    if ui.selectable_label(base.response == *response, response.id()).clicked() {
                        wanted = Some(Some(Route { response: *response, ..base }));
                    }
                }
            });
            if ui.button("Remove").clicked() {
                wanted = Some(None);
            }
        }
        if let Some(route) = wanted {
            change(place, route, None, controls);
            ui.close();
        }
    });
    response
}

/// The part of a knob's menu that adds a route to its parameter from a chosen source.
pub(super) fn menu(ui: &mut Ui, info: &'static ParamInfo, controls: &mut Controls) {
    if !info.is_modulatable() {
        return;
    }
    ui.menu_button("Modulate by", |ui| {
        let Playable::Preset(preset) = controls.params.state().playable else {
            ui.label(OF_KITS);
            return;
        };
        if preset.patch.routes.iter().count() == MAX_ROUTES {
            ui.label(ALL_TAKEN);
            return;
        }
        let routes = &preset.patch.routes;
        let is_here =
            |source| routes.iter().any(|(_, route)| (route.source, route.destination) == (source, info.param));
        if let Some(source) = sources(ui, &preset.guide, is_here) {
            controls.interaction.said = Some(add(source, info, AMOUNT, controls));
            ui.close();
        }
    });
}

/// Adds a route from a source to a parameter, unless there is one. Returns a message.
fn add(source: Source, info: &'static ParamInfo, amount: f32, controls: &mut Controls) -> Said {
    let Playable::Preset(preset) = controls.params.state().playable else { return Err(OF_KITS.to_owned()) };
    let routes = &preset.patch.routes;
    let name = source_name(source, &preset.guide);
    if let Some((place, _)) = routes.iter().find(|(_, route)| route.source == source && route.destination == info.param)
    {
        return Ok(format!("{name} modulates {} already: route {}", info.name, place + 1));
    }
    let Some(place) = (0..MAX_ROUTES).find(|place| routes.get(*place).is_none()) else {
        return Err(ALL_TAKEN.to_owned());
    };
    change(place, Some(Route::linear(source, info.param)), Some(amount), controls);
    Ok(format!("{name} modulates {}: route {}", info.name, place + 1))
}

/// A list of all sources, in which some are marked. Returns the one that is clicked.
fn sources(ui: &mut Ui, guide: &Guide, is_marked: impl Fn(Source) -> bool) -> Option<Source> {
    let mut chosen = None;
    ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
        for source in Source::ALL {
            if ui.add(Button::selectable(is_marked(*source), source_name(*source, guide))).clicked() {
                chosen = Some(*source);
            }
        }
    });
    chosen
}

fn destinations(ui: &mut Ui) -> Option<Param> {
    let mut chosen = None;
    for section in PARAMS.chunk_by(|a, b| a.section == b.section) {
        if !section.iter().any(ParamInfo::is_modulatable) {
            continue;
        }
        ui.menu_button(section[0].section, |ui| {
            for info in section.iter().filter(|info| info.is_modulatable()) {
                if ui.button(info.name).clicked() {
                    chosen = Some(info.param);
                }
            }
        });
    }
    chosen
}

/// Sets or removes a route, and optionally sets its amount. A new route never takes what a former one has left in its place.
fn change(place: usize, route: Option<Route>, amount: Option<f32>, controls: &mut Controls) {
    controls.history.begin(controls.params);
    gestures::change(controls.params, controls.host, |mut state| {
        let Playable::Preset(preset) = &mut state.playable else { return None };
        let patch: &mut Patch = &mut preset.patch;
        let param = amount_param(place);
        let amount = match (patch.routes.get(place), route) {
            (_, None) => Some(param.info().default),
            (None, Some(_)) => amount.or(Some(AMOUNT)),
            (Some(_), Some(_)) => amount,
        };
        patch.routes.set(place, route);
        if let Some(amount) = amount {
            patch.set(param, amount);
            state.values = patch.values;
            state.positions[param as usize] = positions_of(&patch.values)[param as usize];
        }
        Some(state)
    });
    let name = route.map_or("remove a route".to_owned(), |route| format!("route to {}", route.destination.info().name));
    controls.history.end(name, controls.params);
}
