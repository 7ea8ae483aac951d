//! What a host's project keeps: the preset as its file would be, and where the knobs stand.

use crate::slate::Loaded;
use nice_plug::prelude::PluginState;
use serde::{Deserialize, Serialize};
use sprung::params::retired::Retired;
use sprung::params::{PARAMS, Unit};
use sprung::patch::Patch;
use sprung::preset::{Preset, Replaced};
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
        let mut rebased = vec![];
        let note = &mut |replaced: Replaced| rebased.extend(replaced.rebased);
        let preset = Preset::parse_old(&saved.preset, "the state's preset", note).map_err(|error| error.to_string())?;
        let mut state = Self::from_preset(preset, saved.seed, saved.window);
        for (id, position) in &saved.positions {
            // The position of a knob that is gone; the preset's value has become a route.
            if Retired::from_id(id).is_some() {
                continue;
            }
            let index = PARAMS.iter().position(|info| info.id == id);
            let index = index.ok_or_else(|| format!("positions: there is no parameter ‘{id}’"))?;
            if !(0.0..=1.0).contains(position) || matches!(PARAMS[index].unit, Unit::Count | Unit::Choice) {
                return Err(format!("positions.{id}: {position} is not a position of that knob: expected 0 to 1"));
            }
            // Where a route moves a parameter from another value now, the knob stands at that value.
            if !rebased.contains(&PARAMS[index].param) {
                state.loaded.positions[index] = *position;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{Knob, SprungParams};
    use nice_plug::prelude::{Param as _, Params as _};
    use nice_plug_core::plugin::ParamValue;
    use proptest::prelude::*;
    use sprung::params::{PARAM_COUNT, Param};
    use std::path::Path;

    /// A state as the wrapper makes it.
    fn wrapped(params: &SprungParams) -> PluginState {
        let value = |knob: &Knob| match knob {
            Knob::Continuous(knob) => ParamValue::F32(knob.unmodulated_plain_value()),
            Knob::Stepped(knob) => ParamValue::I32(knob.unmodulated_plain_value()),
        };
        let values = PARAMS.iter().zip(params.knobs()).map(|(info, knob)| (info.id.to_owned(), value(knob)));
        let fields = params.serialize_fields();
        PluginState { version: env!("CARGO_PKG_VERSION").to_owned(), params: values.collect(), fields }
    }

    /// A sound with a value in each kind of parameter that its knob's position would not give, and a knob at a
    /// position that its value would not give.
    fn odd() -> State {
        let bell = Preset::find("Church Bell").unwrap();
        let patch = bell.patch.with(Param::Decay, 0.123_456_79).with(Param::Fine, -0.1).with(Param::Voices, 7.0);
        let mut state = State::from_preset(Preset { patch, ..bell.clone() }, 42, [1000, 500]);
        state.loaded.positions[Param::Gain as usize] = 0.123_456_78;
        state
    }

    #[test]
    fn a_state_is_read_back_exactly_and_unchanged() {
        let (params, other) = (SprungParams::default(), SprungParams::default());
        assert_eq!(params.state(), State::default());
        params.load(odd());
        assert_eq!(params.state(), odd());
        let mut state = wrapped(&params);
        let text = serde_json::to_string(&state).unwrap();
        filter(&mut state);
        assert!(state.params.is_empty(), "the wrapper sets nothing by itself");
        other.deserialize_fields(&state.fields);
        assert_eq!(other.state(), odd());
        assert_eq!(serde_json::to_string(&wrapped(&other)).unwrap(), text);
    }

    #[test]
    fn what_cannot_be_read_says_why_and_changes_nothing() {
        let json = odd().to_json();
        let change = |from: &str, to: &str| {
            assert!(json.contains(from), "{from} in {json}");
            json.replacen(from, to, 1)
        };
        for (bad, why) in [
            (String::new(), "not a state of Sprung: EOF"),
            ("[]".to_owned(), "not a state of Sprung"),
            (change("\"format\":1", "\"format\":2"), "state format 2 is unknown: this version reads 1"),
            (change("\"seed\":42", "\"seed\":-1"), "not a state of Sprung: invalid value"),
            (change("\"seed\":42", "\"sead\":42"), "not a state of Sprung: unknown field `sead`"),
            (change("[1000,500]", "[1000,0]"), "window: [1000, 0] is out of range: expected 320 to 8192"),
            (change("[1000,500]", "[1000]"), "not a state of Sprung: invalid length 1"),
            (change("\"gain\":0.12345678", "\"gain\":1.5"), "positions.gain: 1.5 is not a position of that knob"),
            (change("\"gain\":0.12345678", "\"gain\":null"), "not a state of Sprung: invalid type: null"),
            (change("\"gain\":0.12345678", "\"mode\":0.5"), "positions.mode: 0.5 is not a position of that knob"),
            (change("\"gain\":0.12345678", "\"gian\":0.5"), "positions: there is no parameter ‘gian’"),
            (change("format = 3", "format = 9"), "the state's preset: format 9 is of a newer version"),
            (change("decay = 0.12345679", "decay = nan"), "the state's preset: params.decay: NaN is out of range"),
            (change("decay = 0.12345679", "decya = 1"), "the state's preset: unknown key ‘params.decya’"),
            (change("ratio = ", "ratio = -"), "the state's preset: modes[0].ratio: -"),
        ] {
            let error = State::parse(&bad).unwrap_err();
            assert!(error.starts_with(why), "{error}");
            let params = SprungParams::default();
            params.load(odd());
            let mut state = wrapped(&SprungParams::default());
            state.fields.insert(FIELD.to_owned(), bad);
            filter(&mut state);
            assert!(state.params.is_empty() && state.fields.is_empty());
            params.deserialize_fields(&state.fields);
            assert_eq!(params.state(), odd());
        }
    }

    #[test]
    fn parameters_that_a_state_does_not_name_have_their_defaults() {
        let params = SprungParams::default();
        params.load(odd());
        let old = r#"{"format":1,"preset":"format = 1\nname = \"Old\"\n[params]\ngain = -3","window":[880,640]}"#;
        params.deserialize_fields(&BTreeMap::from([(FIELD.to_owned(), old.to_owned())]));
        assert_eq!(params.state().loaded, Loaded::new(Patch::default().with(Param::Gain, -3.0), 0));
        assert_eq!(params.about().name, "Old");
    }

    /// Each released version leaves here a state that it wrote, and the preset that was in it.
    #[test]
    fn states_of_all_versions_load() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/states");
        let own = folder.join(concat!(env!("CARGO_PKG_VERSION"), ".json"));
        if !own.exists() {
            let params = SprungParams::default();
            params.load(odd());
            std::fs::write(&own, serde_json::to_string_pretty(&wrapped(&params)).unwrap()).unwrap();
            std::fs::write(own.with_extension("toml"), odd().preset().to_toml()).unwrap();
            panic!("{} was not there; it has been written for this version, to be committed", own.display());
        }
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "json") {
                continue;
            }
            let mut state: PluginState = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
            let params = SprungParams::default();
            filter(&mut state);
            params.deserialize_fields(&state.fields);
            let expected = Preset::load(&path.with_extension("toml")).unwrap();
            let State { loaded, about } = params.state();
            assert_eq!((loaded.patch, &about.name), (expected.patch, &expected.name), "{}", path.display());
            assert_eq!((loaded.seed, about.window), (42, [1000, 500]), "{}", path.display());
            assert_eq!(loaded.positions[Param::Gain as usize], 0.123_456_78, "{}", path.display());
        }
    }

    proptest! {
        #[test]
        fn knobs_come_back_to_where_they_stood(
            positions in proptest::collection::vec(0.0..=1.0f32, PARAM_COUNT),
        ) {
            let mut state = State::default();
            for (index, info) in PARAMS.iter().enumerate() {
                let value = info.denormalise(f64::from(positions[index]));
                state.loaded.patch.set(info.param, value);
                let stepped = matches!(info.unit, Unit::Count | Unit::Choice);
                state.loaded.positions[index] = if stepped { info.normalise(value) as f32 } else { positions[index] };
            }
            let json = state.to_json();
            let (params, read) = (SprungParams::default(), State::parse(&json).map_err(TestCaseError::fail)?);
            prop_assert_eq!(&read, &state);
            params.load(read);
            prop_assert_eq!(params.state().to_json(), json);
        }

        #[test]
        fn random_text_is_refused(text in "\\PC*") {
            prop_assert!(State::parse(&text).is_err());
        }
    }
}
