//! The state that a host stores in its project: the text of the preset or kit, and the knob positions.
//!
//! A kit's presets are in its text: a project must not depend on files that may disappear.
//!
//! The state is JSON inside the wrapper's JSON. `filter_state` removes the wrapper's own list of parameters, so that
//! everything is loaded at once from this text, or nothing if it is no state at all. If a state is newer or damaged,
//! everything that can be read is loaded, the rest gets its defaults, and the window and the log report what was not
//! understood. Presets and kits have one reader, which collects errors (`src/preset/complaints.rs`): files and commands
//! report the first as an error, `sprung presets check` reports all, states are loaded in spite of them.
//! `plugin/tests/states` has a state of each released version.

use crate::editor::theme::{self, Theme};
use crate::loaded::{Loaded, positions_of};
use nice_plug::prelude::{PluginState, nice_error};
use serde::Serialize;
use serde_json::{Map, Value};
use sprung::params::{PARAM_COUNT, PARAMS, Param, Unit, Values};
use sprung::patch::Patch;
use sprung::patch::routes::amount_param;
use sprung::preset::{KitPreset, Playable, Preset};
use sprung::units::note_name;
use sprung_picture::play::EXCITERS;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The wrapper's name for the state.
pub(crate) const FIELD: &str = "sprung";

/// The wrapper's name for a mark in states of the effect, whose sounds are loaded without changes.
pub(crate) const EFFECT_FIELD: &str = "resonator";

/// The state format that is read and written.
const FORMAT: u64 = 1;

/// The keys of a state.
const KEYS: [&str; 11] =
    ["format", "preset", "kit", "values", "positions", "pad", "seed", "window", "zoom", "theme", "less_motion"];

/// Size and look of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    /// Width and height at a zoom of 100 %.
    pub(crate) size: [u32; 2],
    /// In per cent.
    pub(crate) zoom: u32,
    pub(crate) theme: Theme,
    /// Whether bodies stay at their greatest bend, for eyes that slow swinging tires.
    pub(crate) less_motion: bool,
}

/// The view of a new window.
pub(crate) const VIEW: View = View { size: theme::SIZE, zoom: 100, theme: Theme::Dark, less_motion: false };

/// Smallest and largest width and height of a window.
pub(crate) const WINDOW_RANGE: [u32; 2] = [320, 8192];

/// A pad whose sound is edited: the key, and the kit as it was heard.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EditedPad {
    pub(crate) key: u8,
    pub(crate) kit: Arc<KitPreset>,
}

impl EditedPad {
    /// The pad in words, such as `pad C2 of Acoustic Kit`.
    pub(crate) fn name(&self) -> String {
        format!("pad {} of {}", note_name(self.key), self.kit.name)
    }
}

/// The whole state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    /// The preset or kit. A preset's patch has the values below.
    pub(crate) playable: Playable,
    /// The pad to which the preset can be put back, if it was taken from one.
    pub(crate) pad: Option<EditedPad>,
    /// The parameters of the preset or kit.
    pub(crate) values: Values,
    /// The knob positions.
    pub(crate) positions: [f32; PARAM_COUNT],
    /// Seed of all random numbers.
    pub(crate) seed: u64,
    /// Size, zoom, theme and motion of the window.
    pub(crate) view: View,
}

/// A state that was read, with a line for each part that was not understood.
#[derive(Debug, PartialEq)]
pub(crate) struct Read {
    pub(crate) state: State,
    pub(crate) complaints: Vec<String>,
}

/// The JSON of a pad whose sound is edited: its key, and the text of a kit file with all of its presets.
#[derive(Serialize)]
struct SavedPad {
    key: u8,
    kit: String,
}

/// The JSON of a state.
#[derive(Serialize)]
struct Saved {
    format: u64,
    /// The text of a preset file.
    #[serde(skip_serializing_if = "Option::is_none")]
    preset: Option<String>,
    /// The text of a kit file with all of its presets, if there is no preset.
    #[serde(skip_serializing_if = "Option::is_none")]
    kit: Option<String>,
    /// Values that differ from those of the kit's files, by parameter id.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    values: BTreeMap<&'static str, f32>,
    /// Knob positions that differ from those of the values, by parameter id.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    positions: BTreeMap<&'static str, f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pad: Option<SavedPad>,
    seed: u64,
    window: [u32; 2],
    /// Left out at 100 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    zoom: Option<u32>,
    /// Left out if it is the default theme.
    #[serde(skip_serializing_if = "Option::is_none")]
    theme: Option<&'static str>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    less_motion: bool,
}

impl Default for State {
    fn default() -> Self {
        Self::new(Playable::Preset(Preset::new("Init", Patch::default())), 0, VIEW)
    }
}

impl From<State> for Read {
    fn from(state: State) -> Self {
        Self { state, complaints: Vec::new() }
    }
}

impl State {
    /// The state of a new instance: a body that invites to strike it, and not the one plain mass of [`State::default`].
    pub(crate) fn inviting() -> Self {
        let bell = Playable::find("Church Bell").expect("a test plays every factory sound by its name");
        Self::new(bell, 0, VIEW)
    }

    /// The state of a preset or kit, with all knobs at the positions of its values.
    pub(crate) fn new(playable: Playable, seed: u64, view: View) -> Self {
        let values = match &playable {
            Playable::Preset(preset) => preset.patch.values,
            Playable::Kit(kit) => *kit.kit().values(),
        };
        Self { playable, pad: None, values, positions: positions_of(&values), seed, view }
    }

    /// The state of a sound as a resonator. A sound that no incoming sound drives has it at 0 dB, and nothing else moves its
    /// masses, by a route neither; one that has an input level stays as its author has made it. In a kit, the knobs move each
    /// sound by as much, so that what a route or a louder exciter adds may stay; if any sound has an input level, all stay.
    pub(crate) fn driven(mut self) -> Self {
        let input = Param::InputLevel;
        let is_driven = |values: &Values| values.get(input) > input.info().min;
        let is_any_driven = match &self.playable {
            Playable::Preset(_) => false,
            Playable::Kit(kit) => kit.sounds.iter().any(|(_, preset)| is_driven(&preset.patch.values)),
        };
        if is_driven(&self.values) || is_any_driven {
            return self;
        }
        let levels = EXCITERS.iter().flat_map(|exciter| std::iter::once(exciter.level).chain(exciter.also));
        let others: Vec<Param> = levels.filter(|level| *level != input).collect();
        let mut set = vec![(input, 0.0)];
        set.extend(others.iter().map(|param| (*param, param.info().min)));
        if let Playable::Preset(preset) = &self.playable {
            let routes = preset.patch.routes.iter().filter(|(_, route)| others.contains(&route.destination));
            set.extend(routes.map(|(place, _)| (amount_param(place), 0.0)));
        }
        for (param, value) in set {
            self.values.set(param, value);
            self.positions[param as usize] = param.info().normalise(value) as f32;
        }
        if let Playable::Preset(preset) = &mut self.playable {
            preset.patch.values = self.values;
        }
        self
    }

    /// The sound as it is heard, to be saved: a kit has the values of its knobs in its sounds.
    pub(crate) fn into_sound(self) -> Playable {
        match self.playable {
            Playable::Kit(kit) if *kit.kit().values() != self.values => Playable::Kit(kit.with_values(&self.values)),
            as_it_is => as_it_is,
        }
    }

    /// The state with the sound of a kit's pad alone, as it is heard, to be edited. None if the key has no pad.
    pub(crate) fn of_pad(self, key: u8) -> Option<Self> {
        let Self { values, seed, view, .. } = self;
        let Playable::Kit(kit) = self.into_sound() else { return None };
        // One sound is heard with the kit's effects; several keep those that they have now, whatever becomes of this one.
        let kit = if kit.sounds.len() == 1 { kit.with_values(&values) } else { kit.with_effects(&values) };
        let (_, pad) = kit.pads.iter().find(|(own, _)| *own == key)?;
        let (_, preset) = kit.sounds.get(pad.sound)?.clone();
        let pad = Some(EditedPad { key, kit: Arc::new(kit) });
        Some(Self { pad, ..Self::new(Playable::Preset(preset), seed, view) })
    }

    /// The part of the state for the audio thread. Computes the sounds.
    pub(crate) fn loaded(&self) -> Loaded {
        let Self { playable, values, positions, seed, .. } = self;
        Loaded { kit: playable.kit(), values: *values, positions: *positions, seed: *seed }
    }

    /// Writes the state as JSON. [`State::parse`] gives exactly the same state.
    pub(crate) fn to_json(&self) -> String {
        let own = positions_of(&self.values);
        let positions = changes(|param| self.positions[param as usize], |param| own[param as usize]);
        let mut saved = Saved {
            format: FORMAT,
            preset: None,
            kit: None,
            values: BTreeMap::new(),
            positions,
            pad: self.pad.as_ref().map(|pad| SavedPad { key: pad.key, kit: pad.kit.to_whole_toml() }),
            seed: self.seed,
            window: self.view.size,
            zoom: Some(self.view.zoom).filter(|zoom| *zoom != VIEW.zoom),
            theme: Some(self.view.theme).filter(|theme| *theme != VIEW.theme).map(Theme::id),
            less_motion: self.view.less_motion,
        };
        match &self.playable {
            Playable::Preset(preset) => saved.preset = Some(preset.to_toml()),
            Playable::Kit(kit) => {
                let of_files = *kit.kit().values();
                saved.kit = Some(kit.to_whole_toml());
                saved.values = changes(|param| self.values.get(param), |param| of_files.get(param));
            }
        }
        serde_json::to_string(&saved).unwrap_or_default()
    }

    /// Reads as much of a state as possible, of this or another version. Parameters that are missing or cannot be read
    /// get their defaults.
    ///
    /// # Errors
    /// The reason why the text is no state at all: it is not JSON, or has neither a preset nor a kit.
    pub(crate) fn parse(json: &str) -> Result<Read, String> {
        let saved: Map<String, Value> =
            serde_json::from_str(json).map_err(|error| format!("not a state of Sprung: {error}"))?;
        let mut complaints = vec![];
        let format = saved.get("format").unwrap_or(&Value::Null);
        match format.as_u64() {
            Some(FORMAT) => {}
            Some(newer) if newer > FORMAT => {
                complaints.push(format!("state format {newer} is of a newer version: this one reads {FORMAT}"));
            }
            _ => complaints.push(format!("state format {format} is unknown: this version reads {FORMAT}")),
        }
        let unknown = saved.keys().filter(|key| !KEYS.contains(&key.as_str()));
        complaints.extend(unknown.map(|key| format!("unknown key ‘{key}’")));
        let playable = read_playable(&saved, &mut complaints)?;
        let seed = match saved.get("seed") {
            None => Some(0),
            Some(seed) => seed.as_u64().or_else(|| {
                complaints.push(format!("seed: {seed} is none: expected a whole number"));
                None
            }),
        };
        let view = read_view(&saved, &mut complaints);
        let mut state = Self::new(playable, seed.unwrap_or(0), view);
        if let Some(pad) = saved.get("pad") {
            match &state.playable {
                Playable::Preset(_) => state.pad = read_pad(pad, &mut complaints),
                Playable::Kit(_) => complaints.push("pad: expected a preset beside it, found a kit".to_owned()),
            }
        }
        if let Playable::Kit(_) = state.playable {
            for (param, value) in numbers(&saved, "values", &mut complaints) {
                match param.info().check(value) {
                    Ok(value) => state.values.set(param, value),
                    Err(complaint) => complaints.push(format!("values.{}: {complaint}", param.info().id)),
                }
            }
            state.positions = positions_of(&state.values);
        }
        for (param, position) in numbers(&saved, "positions", &mut complaints) {
            let info = param.info();
            if !(0.0..=1.0).contains(&position) || matches!(info.unit, Unit::Count | Unit::Choice) {
                let complaint = format!("{position} is not a position of that knob: expected 0 to 1");
                complaints.push(format!("positions.{}: {complaint}", info.id));
            } else {
                state.positions[param as usize] = position;
            }
        }
        Ok(Read { state, complaints })
    }
}

/// The values of `now` that differ from `before`, by parameter id.
fn changes(now: impl Fn(Param) -> f32, before: impl Fn(Param) -> f32) -> BTreeMap<&'static str, f32> {
    let changed = PARAMS.iter().filter(|info| now(info.param) != before(info.param));
    changed.map(|info| (info.id, now(info.param))).collect()
}

/// The preset or kit of a state.
fn read_playable(saved: &Map<String, Value>, complaints: &mut Vec<String>) -> Result<Playable, String> {
    let text = |key: &str| saved.get(key).and_then(Value::as_str);
    let read = match (text("preset"), text("kit")) {
        (Some(preset), _) => {
            let read = Preset::parse_lenient(preset, "the state's preset");
            read.map(|(preset, lines)| (Playable::Preset(preset), lines))
        }
        (None, Some(kit)) => Playable::parse_lenient(kit, "the state's kit", &mut |name| Preset::find(name).cloned()),
        (None, None) => return Err("not a state of Sprung: there is neither a preset nor a kit".to_owned()),
    };
    let (playable, lines) = read.map_err(|error| error.to_string())?;
    complaints.extend(lines);
    Ok(playable)
}

/// The pad from which the preset was taken.
fn read_pad(pad: &Value, complaints: &mut Vec<String>) -> Option<EditedPad> {
    let key = pad.get("key").and_then(Value::as_u64).and_then(|key| u8::try_from(key).ok());
    let text = pad.get("kit").and_then(Value::as_str).unwrap_or_default();
    let read = Playable::parse_lenient(text, "the pad's kit", &mut |name| Preset::find(name).cloned());
    match (key, read) {
        (Some(key), Ok((Playable::Kit(kit), lines))) if kit.pads.iter().any(|(own, _)| *own == key) => {
            complaints.extend(lines.into_iter().map(|line| format!("pad: {line}")));
            Some(EditedPad { key, kit: Arc::new(kit) })
        }
        _ => {
            complaints.push("pad: expected a key and a kit that has a pad on it".to_owned());
            None
        }
    }
}

/// Size, zoom, theme and motion of the window. Parts that are missing or cannot be read are as in a new window.
fn read_view(saved: &Map<String, Value>, complaints: &mut Vec<String>) -> View {
    let mut view = VIEW;
    let [least, most] = WINDOW_RANGE;
    if let Some(window) = saved.get("window") {
        let read = serde_json::from_value::<[u32; 2]>(window.clone()).ok();
        match read.filter(|sides| sides.iter().all(|side| (least..=most).contains(side))) {
            Some(size) => view.size = size,
            None => complaints
                .push(format!("window: {window} is out of range: expected two numbers from {least} to {most}")),
        }
    }
    let [least, most] = theme::ZOOM_RANGE;
    if let Some(zoom) = saved.get("zoom") {
        match zoom.as_u64().and_then(|zoom| u32::try_from(zoom).ok()).filter(|zoom| (least..=most).contains(zoom)) {
            Some(zoom) => view.zoom = zoom,
            None => {
                complaints.push(format!("zoom: {zoom} is out of range: expected a whole number from {least} to {most}"))
            }
        }
    }
    if let Some(theme) = saved.get("theme") {
        match Theme::ALL.into_iter().find(|known| theme.as_str() == Some(known.id())) {
            Some(theme) => view.theme = theme,
            None => complaints.push(format!("theme: there is none called {theme}")),
        }
    }
    if let Some(less) = saved.get("less_motion") {
        match less.as_bool() {
            Some(less) => view.less_motion = less,
            None => complaints.push(format!("less_motion: {less} is no switch: expected true or false")),
        }
    }
    view
}

/// The numbers by parameter id in a part of the state.
fn numbers(saved: &Map<String, Value>, key: &str, complaints: &mut Vec<String>) -> Vec<(Param, f32)> {
    let numbers = match saved.get(key) {
        None => return Vec::new(),
        Some(Value::Object(numbers)) => numbers,
        Some(other) => {
            complaints.push(format!("{key}: expected numbers by parameter, found {other}"));
            return Vec::new();
        }
    };
    let mut read = vec![];
    for (id, number) in numbers {
        match (Param::from_id(id), number.as_f64()) {
            (None, _) => complaints.push(format!("{key}: there is no parameter ‘{id}’")),
            (Some(_), None) => complaints.push(format!("{key}.{id}: expected a number, found {number}")),
            (Some(param), Some(number)) => read.push((param, number as f32)),
        }
    }
    read
}

/// Removes everything from the wrapper's state that [`State::parse`] cannot read. Then the wrapper sets no parameter by
/// itself, and data that is not a state changes nothing.
pub(crate) fn filter(state: &mut PluginState) {
    let is_state = |json: &str| State::parse(json).inspect_err(|error| nice_error!("{error}")).is_ok();
    state.params.clear();
    state.fields.retain(|name, json| name == FIELD && is_state(json));
}

#[cfg(test)]
mod tests;
