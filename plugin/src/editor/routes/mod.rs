//! Routes: their names, and the menus that make, change and remove them.

pub(super) mod carry;
pub(super) mod learn;
pub(super) mod list;
mod matrix;
mod row;
mod typed;

use crate::editor::controls::gestures;
use crate::editor::controls::{Controls, Said, moved_in};
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

/// Whether a source can move a parameter.
fn can_move(source: Source, info: &ParamInfo) -> bool {
    Route::linear(source, info.param).is_possible()
}

/// The first place without a route.
fn free_place(routes: &Routes) -> Option<usize> {
    (0..MAX_ROUTES).find(|place| routes.get(*place).is_none())
}

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

/// A route in words, such as `wheel › Vibrato`.
pub(super) fn words(route: &Route, guide: &Guide) -> String {
    let Route { source, destination, scale, .. } = route;
    let scale = scale.map_or(String::new(), |scale| format!(" × {}", source_name(scale, guide)));
    format!("{}{scale} › {}", source_name(*source, guide), destination.info().name)
}

/// Whether a route moves its parameter to both sides.
fn goes_both_ways(route: &Route) -> bool {
    route.source.is_bipolar() || route.scale.is_some_and(Source::is_bipolar)
}

/// An amount as text, with its sign: what goes to both sides has both.
fn amount_text(route: &Route, amount: f32, info: &ParamInfo) -> String {
    match goes_both_ways(route) {
        true if amount > 0.0 => format!("±{}", info.format(amount)),
        true if amount < 0.0 => format!("∓{}", info.format(-amount)),
        false if amount > 0.0 => format!("+{}", info.format(amount)),
        _ => info.format(amount),
    }
}

/// The modulation of a parameter, as a knob shows it.
#[derive(Default)]
pub(super) struct Ring<'a> {
    /// The parts of its travel that routes can move it to: by each amount, to both sides if the source has both.
    pub(super) ranges: Vec<[f32; 2]>,
    /// The modulated position in each sounding note, the newest note first.
    pub(super) marks: Vec<f32>,
    /// The routes, and the names of their sources; none where nothing is said of them.
    routes: Option<(&'a Routes, &'a Guide)>,
}

impl<'a> Ring<'a> {
    pub(super) fn of(info: &ParamInfo, (routes, guide): (&'a Routes, &'a Guide), controls: &Controls) -> Self {
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
        let ranges = to(info, routes).map(range).filter(|[from, to]| from != to).collect();
        let marks = controls.modulated(info).map(|value| info.normalise(value) as f32).collect();
        Self { ranges, marks, routes: Some((routes, guide)) }
    }

    /// What moves a parameter and how far, in words; none if nothing does.
    pub(super) fn movers(&self, info: &ParamInfo, controls: &Controls) -> Option<String> {
        let (routes, guide) = self.routes?;
        let mover = |(place, route): (usize, Route)| {
            let (info, amount) = (amount_param(place).info(), controls.value(amount_param(place).info()));
            (amount != 0.0)
                .then(|| format!("{} {}", source_name(route.source, guide), amount_text(&route, amount, info)))
        };
        let movers: Vec<String> = to(info, routes).filter_map(mover).collect();
        (!movers.is_empty()).then(|| movers.join(", "))
    }
}

/// The routes that move a parameter.
fn to(info: &ParamInfo, routes: &Routes) -> impl Iterator<Item = (usize, Route)> {
    routes.iter().filter(|(_, route)| route.destination == info.param)
}

/// Where each sounding note is on the bar of a route, from 0 to 1, the newest note first.
fn now(place: usize, route: &Route, controls: &Controls) -> Vec<f32> {
    let info = amount_param(place).info();
    let amount = |note: &SoundingNote| moved_in(note, info).unwrap_or(controls.heard(info));
    let on_bar = |note: &SoundingNote| (0.5 + 0.5 * note.travel(route, amount(note))).clamp(0.0, 1.0);
    controls.notes.iter().map(on_bar).collect()
}

/// The step that gives a place another route, in words.
fn becomes(route: &Route, guide: &Guide) -> String {
    let curve = match route.response {
        Response::Linear => String::new(),
        curve => format!(", {}", curve.id()),
    };
    format!("{}{curve}", words(route, guide))
}

/// Makes a place a button that opens the menu of a route.
fn button(
    ui: &Ui,
    rect: Rect,
    (place, route): (usize, &Route),
    guide: &Guide,
    controls: &mut Controls,
) -> egui::Response {
    let response = ui.interact(rect, Id::unique(("route", place)), Sense::click());
    let label = format!("Route {}: {}", place + 1, words(route, guide));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    Popup::menu(&response).show(|ui| {
        ui.set_min_width(140.0);
        let mut wanted = None;
        ui.menu_button("Source", |ui| wanted = wanted.or(source_menu(ui, route, guide)));
        ui.menu_button("Destination", |ui| wanted = wanted.or(target_menu(ui, route)));
        ui.menu_button("Multiplied by", |ui| wanted = wanted.or(scale_menu(ui, route, guide)));
        ui.menu_button("Response", |ui| wanted = wanted.or(curve_menu(ui, route)));
        if let Some(route) = wanted {
            change(place, Some(route), None, becomes(&route, guide), controls);
            ui.close();
        }
        if ui.button("Remove").clicked() {
            remove(place, route, guide, controls);
            ui.close();
        }
    });
    response
}

/// Removes a route.
fn remove(place: usize, route: &Route, guide: &Guide, controls: &mut Controls) {
    change(place, None, None, format!("removed {}", words(route, guide)), controls);
}

/// The route with another source, if one is chosen.
fn source_menu(ui: &mut Ui, route: &Route, guide: &Guide) -> Option<Route> {
    let with = |source| Route { source, ..*route };
    sources(ui, guide, |source| source == route.source, |source| with(source).is_possible()).map(with)
}

/// The route to another destination, if one is chosen.
fn target_menu(ui: &mut Ui, route: &Route) -> Option<Route> {
    let with = |destination| Route { destination, ..*route };
    destinations(ui, |destination| with(destination).is_possible()).map(with)
}

/// The route with another multiplier or none, if that is chosen.
fn scale_menu(ui: &mut Ui, route: &Route, guide: &Guide) -> Option<Route> {
    if ui.add(Button::selectable(route.scale.is_none(), "nothing")).clicked() {
        return Some(Route { scale: None, ..*route });
    }
    let with = |scale| Route { scale: Some(scale), ..*route };
    sources(ui, guide, |scale| route.scale == Some(scale), |scale| with(scale).is_possible()).map(with)
}

/// The route with another curve, if one is chosen.
fn curve_menu(ui: &mut Ui, route: &Route) -> Option<Route> {
    let chosen = |response: &&Response| {
        let is_here = route.response == **response;
        ui.add(Button::selectable(is_here, response.id())).clicked()
    };
    Response::ALL.iter().find(chosen).map(|response| Route { response: *response, ..*route })
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
        let can = |source| can_move(source, info);
        if let Some(source) = sources(ui, &preset.guide, is_here, can) {
            controls.interaction.said = Some(add(Route::linear(source, info.param), AMOUNT, controls));
            ui.close();
        }
    });
}

/// The place of a route that moves the same by the same, whatever its curve.
fn place_of(route: &Route, routes: &Routes) -> Option<usize> {
    let mut all = routes.iter();
    all.find(|(_, other)| Route { response: route.response, ..*other } == *route).map(|(place, _)| place)
}

/// Adds a route with an amount, unless there is one. Returns a message.
fn add(route: Route, amount: f32, controls: &mut Controls) -> Said {
    let Playable::Preset(preset) = controls.params.state().playable else { return Err(OF_KITS.to_owned()) };
    let (routes, info) = (&preset.patch.routes, route.destination.info());
    let name = source_name(route.source, &preset.guide);
    if let Some(place) = place_of(&route, routes) {
        let by = controls.text(amount_param(place).info());
        return Ok(format!("{name} moves {} already, by {by}: rest on the knob with it to change that", info.name));
    }
    if !route.is_possible() {
        return Err(format!("{name} is each note’s own, and {} is of all notes", info.name));
    }
    let Some(place) = free_place(routes) else {
        return Err(ALL_TAKEN.to_owned());
    };
    let scale = route.scale.map_or(String::new(), |scale| format!(" times {}", source_name(scale, &preset.guide)));
    let by = amount_param(place).info().format(amount);
    let name = format!("{name}{scale} moves {} by {by}", info.name);
    change(place, Some(route), Some(amount), name.clone(), controls);
    Ok(name)
}

/// A list of all sources, in which some are marked, and some cannot be chosen. Returns the one that is clicked.
fn sources(
    ui: &mut Ui,
    guide: &Guide,
    is_marked: impl Fn(Source) -> bool,
    is_possible: impl Fn(Source) -> bool,
) -> Option<Source> {
    let mut chosen = None;
    ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
        for source in Source::ALL.iter().copied() {
            let choice = Button::selectable(is_marked(source), source_name(source, guide));
            if ui.add_enabled(is_possible(source), choice).clicked() {
                chosen = Some(source);
            }
        }
    });
    chosen
}

/// The possible destinations by section. Returns the one that is clicked.
fn destinations(ui: &mut Ui, is_possible: impl Fn(Param) -> bool) -> Option<Param> {
    let mut chosen = None;
    for section in PARAMS.chunk_by(|a, b| a.section == b.section) {
        let possible: Vec<&ParamInfo> = section.iter().filter(|info| is_possible(info.param)).collect();
        if possible.is_empty() {
            continue;
        }
        ui.menu_button(section[0].section, |ui| {
            for info in possible {
                if ui.button(info.name).clicked() {
                    chosen = Some(info.param);
                }
            }
        });
    }
    chosen
}

/// Sets or removes a route, and optionally sets its amount, as one step of this name. A new route never takes what a former one has
/// left in its place.
fn change(place: usize, route: Option<Route>, amount: Option<f32>, name: String, controls: &mut Controls) {
    let is_new = controls.params.loaded().kit.sounds()[0].patch().routes.get(place).is_none();
    let info = amount_param(place).info();
    let amount = match route {
        None => Some(info.default),
        Some(_) if is_new => amount.or(Some(AMOUNT)),
        Some(_) => amount,
    };
    controls.history.begin(controls.params);
    put(place, route, amount.map(|amount| (amount, info.normalise(amount) as f32)), controls);
    controls.history.end(name, controls.params);
}

/// Sets or removes a route, and gives its amount a value and a position. It becomes no step.
fn put(place: usize, route: Option<Route>, amount: Option<(f32, f32)>, controls: &mut Controls) {
    gestures::change(controls.params, controls.host, |mut state| {
        let Playable::Preset(preset) = &mut state.playable else { return None };
        let patch: &mut Patch = &mut preset.patch;
        patch.routes.set(place, route);
        if let Some((value, position)) = amount {
            patch.set(amount_param(place), value);
            state.values = patch.values;
            state.positions[amount_param(place) as usize] = position;
        }
        Some(state)
    });
}
