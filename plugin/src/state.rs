//! What a host's project keeps: the preset as its file would be, and where the knobs stand.

use crate::slate::Loaded;
use nice_plug::prelude::PluginState;
use serde::{Deserialize, Serialize};
use sprung::params::{PARAMS, Unit};
use sprung::patch::Patch;
use sprung::preset::Preset;
use std::collections::BTreeMap;

/// The wrapper's name for what is kept.
pub(crate) const FIELD: &str = "sprung";

/// The format that this version writes.
const FORMAT: u32 = 1;

/// Width and height of a new window.
pub(crate) const WINDOW: [u32; 2] = [880, 640];

/// Smallest and largest width and height of a window.
pub(crate) const WINDOW_RANGE: [u32; 2] = [320, 8192];

/// What is kept besides the patch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct About {
    /// As in [`Preset`].
    pub(crate) name: String,
    pub(crate) author: String,
    pub(crate) tags: Vec<String>,
    pub(crate) comment: String,
    /// Width and height of the window.
    pub(crate) window: [u32; 2],
}

/// All that is kept.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) loaded: Loaded,
    pub(crate) about: About,
}

/// The JSON of a state.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    format: u32,
    /// A preset file's text.
    preset: String,
    /// Knob positions that are not exactly those of the preset's values, by parameter id.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    positions: BTreeMap<String, f32>,
    #[serde(default)]
    seed: u64,
    window: [u32; 2],
}

impl Default for State {
    fn default() -> Self {
        Self::from_preset(
            Preset {
                name: "Init".to_owned(),
                author: String::new(),
                tags: Vec::new(),
                comment: String::new(),
                patch: Patch::default(),
            },
            0,
            WINDOW,
        )
    }
}

impl State {
    /// A preset with each knob where its value is.
    pub(crate) fn from_preset(preset: Preset, seed: u64, window: [u32; 2]) -> Self {
        let Preset { name, author, tags, comment, patch } = preset;
        Self { loaded: Loaded::new(patch, seed), about: About { name, author, tags, comment, window } }
    }

    /// The preset in it.
    pub(crate) fn preset(&self) -> Preset {
        let About { name, author, tags, comment, .. } = self.about.clone();
        Preset { name, author, tags, comment, patch: self.loaded.patch }
    }

    /// Writes the state so that [`State::parse`] gives it back exactly.
    pub(crate) fn to_json(&self) -> String {
        let own = Loaded::new(self.loaded.patch, 0).positions;
        let moved = PARAMS.iter().enumerate().filter(|(index, _)| self.loaded.positions[*index] != own[*index]);
        let saved = Saved {
            format: FORMAT,
            preset: self.preset().to_toml(),
            positions: moved.map(|(index, info)| (info.id.to_owned(), self.loaded.positions[index])).collect(),
            seed: self.loaded.seed,
            window: self.about.window,
        };
        serde_json::to_string(&saved).unwrap_or_default()
    }

    /// Reads a state of this version or an older one. Parameters that it does not name have their defaults.
    ///
    /// # Errors
    /// Says what is wrong with anything else.
    pub(crate) fn parse(json: &str) -> Result<Self, String> {
        let saved: Saved = serde_json::from_str(json).map_err(|error| format!("not a state of Sprung: {error}"))?;
        if saved.format != FORMAT {
            return Err(format!("state format {} is unknown: this version reads {FORMAT}", saved.format));
        }
        let [least, most] = WINDOW_RANGE;
        if saved.window.iter().any(|side| !(least..=most).contains(side)) {
            return Err(format!("window: {:?} is out of range: expected {least} to {most}", saved.window));
        }
        let preset = Preset::parse(&saved.preset, "the state's preset").map_err(|error| error.to_string())?;
        let mut state = Self::from_preset(preset, saved.seed, saved.window);
        for (id, position) in &saved.positions {
            let index = PARAMS.iter().position(|info| info.id == id);
            let index = index.ok_or_else(|| format!("positions: there is no parameter ‘{id}’"))?;
            if !(0.0..=1.0).contains(position) || matches!(PARAMS[index].unit, Unit::Count | Unit::Choice) {
                return Err(format!("positions.{id}: {position} is not a position of that knob: expected 0 to 1"));
            }
            state.loaded.positions[index] = *position;
        }
        Ok(state)
    }
}

/// Leaves of a wrapper's state what [`State::parse`] can read, and nothing else: then the wrapper touches no
/// parameter by itself, and what cannot be read changes nothing.
pub(crate) fn filter(state: &mut PluginState) {
    state.params.clear();
    state.fields.retain(|name, json| name == FIELD && State::parse(json).is_ok());
}
