//! States that are read back exactly, states of old versions, and states that can be read only in part.

use super::*;
use crate::params::{Knob, SprungParams};
use nice_plug::prelude::{Param as _, Params as _};
use nice_plug_core::plugin::ParamValue;
use proptest::prelude::*;
use sprung::params::{PARAM_COUNT, Param};
use std::path::Path;

/// A state as the wrapper stores it.
fn wrapped(params: &SprungParams) -> PluginState {
    let value = |knob: &Knob| match knob {
        Knob::Continuous(knob) => ParamValue::F32(knob.unmodulated_plain_value()),
        Knob::Stepped(knob) => ParamValue::I32(knob.unmodulated_plain_value()),
    };
    let values = PARAMS.iter().zip(params.knobs()).map(|(info, knob)| (info.id.to_owned(), value(knob)));
    let fields = params.serialize_fields();
    PluginState { version: env!("CARGO_PKG_VERSION").to_owned(), params: values.collect(), fields }
}

fn odd_view() -> View {
    View { size: [1000, 500], zoom: 150, theme: Theme::Light, less_motion: true }
}

/// A sound with, for each kind of parameter, a value that cannot be restored from its knob position, and with a knob
/// position that does not follow from its value.
fn odd() -> State {
    let bell = Preset::find("Glockenspiel").unwrap();
    let patch = bell.patch.clone().with(Param::Decay, 0.123_456_79).with(Param::Fine, -0.1).with(Param::Voices, 7.0);
    let mut state = State::new(Playable::Preset(Preset { patch, ..bell.clone() }), 42, odd_view());
    state.positions[Param::Gain as usize] = 0.123_456_78;
    state
}

#[test]
fn a_state_is_read_back_exactly_and_unchanged() {
    let (params, other) = (SprungParams::default(), SprungParams::default());
    assert_eq!(params.state(), State::default());
    params.load(odd().into());
    assert_eq!(params.state(), odd());
    let mut state = wrapped(&params);
    let text = serde_json::to_string(&state).unwrap();
    filter(&mut state);
    assert!(state.params.is_empty(), "the wrapper sets nothing by itself");
    other.deserialize_fields(&state.fields);
    assert_eq!(other.state(), odd());
    assert_eq!(serde_json::to_string(&wrapped(&other)).unwrap(), text);
}

/// A kit with factory presets and one of its own, whose values differ from those of its files.
fn odd_kit() -> State {
    let text = "kit = 1\nname = \"Odd\"\nvoices = 9\nkeys = [{ key = 36, sound = \"Kick\", pan = -0.3 },\
        { key = 38, sound = \"mine.toml\", choke = 2 }, { key = 40, sound = \"Kick\", pitch = 50.5 }]";
    let Playable::Preset(bell) = odd().playable else { panic!("a preset") };
    let mut find = |name: &str| Preset::find(name).cloned().or_else(|_| Ok(bell.clone()));
    let mut state = State::new(Playable::parse(text, "x", &mut find).unwrap(), 42, odd_view());
    assert_eq!(state.values.get(Param::Voices), 9.0);
    for (param, value) in [(Param::Decay, 0.123_456_79), (Param::Mode, 1.0), (Param::Voices, 3.0)] {
        state.values.set(param, value);
    }
    state.positions = positions_of(&state.values);
    state.positions[Param::Gain as usize] = 0.123_456_78;
    state
}

#[test]
fn a_kit_is_kept_with_its_presets() {
    let (params, other) = (SprungParams::default(), SprungParams::default());
    params.load(odd_kit().into());
    assert_eq!(params.state(), odd_kit());
    let json = params.state().to_json();
    let read = State::parse(&json).unwrap();
    assert_eq!(read, odd_kit().into());
    other.load(read);
    assert_eq!(other.state().to_json(), json);
    assert_eq!(*other.loaded(), odd_kit().loaded());
    other.load(odd().into());
    assert_eq!(other.state(), odd(), "a preset after a kit");

    let mut saved: Map<String, Value> = serde_json::from_str(&json).unwrap();
    let text = saved["kit"].as_str().unwrap();
    let text = text.replace("[sounds.\"mine.toml\"", "[sounds.\"none.toml\"");
    saved["kit"] = change(&text, "[sounds.Kick.params]\n", "[sounds.Kick.params]\ngain_boost = 99\n").into();
    saved["values"]["mode"] = 7.into();
    let Read { state, complaints } = State::parse(&serde_json::to_string(&saved).unwrap()).unwrap();
    let Playable::Kit(kit) = &state.playable else { panic!("a kit") };
    assert_eq!(kit.pads.iter().map(|(key, _)| *key).collect::<Vec<_>>(), [36, 40]);
    assert_eq!((state.values.get(Param::Mode), state.values.get(Param::Voices)), (0.0, 3.0));
    let starts = [
        "sounds.Kick: unknown key ‘params.gain_boost’",
        "keys[1].sound: preset: there is no factory preset",
        "sounds.none.toml: no key plays it",
        "values.mode: ‘7’",
    ];
    assert_eq!(complaints.len(), starts.len(), "{complaints:?}");
    assert!(complaints.iter().zip(starts).all(|(line, start)| line.starts_with(start)), "{complaints:?}");
}

#[test]
fn a_pad_is_read_only_beside_a_preset_and_its_lines_say_whose_they_are() {
    let edited = odd_kit().of_pad(36).unwrap().to_json();
    let mut saved: Map<String, Value> = serde_json::from_str(&odd_kit().to_json()).unwrap();
    saved.insert("pad".to_owned(), serde_json::from_str::<Value>(&edited).unwrap()["pad"].clone());
    let Read { state, complaints } = State::parse(&serde_json::to_string(&saved).unwrap()).unwrap();
    assert_eq!((state, complaints.len()), (odd_kit(), 1), "{complaints:?}");
    assert!(complaints[0].starts_with("pad: expected a preset"), "{complaints:?}");
    let newer = change(&edited, "[sounds.Kick.params]\\n", "[sounds.Kick.params]\\ngain_boost = 99\\n");
    let Read { state, complaints } = State::parse(&newer).unwrap();
    assert!(state.pad.is_some() && complaints.len() == 1, "{complaints:?}");
    assert!(complaints[0].starts_with("pad: sounds.Kick: unknown key"), "{complaints:?}");
}

#[test]
fn a_kit_whose_sounds_are_driven_is_not_driven_again() {
    let input = |kit: &KitPreset| kit.sounds.iter().map(|(_, preset)| preset.patch.get(Param::InputLevel)).collect();
    let driven = odd_kit().driven();
    assert_eq!(driven.values.get(Param::InputLevel), 0.0);
    let back = State::new(driven.into_sound(), 0, VIEW).driven();
    let Playable::Kit(kit) = back.into_sound() else { panic!("a kit") };
    let inputs: Vec<f32> = input(&kit);
    assert_eq!(inputs, [0.0, 0.0]);
}

/// Replaces a part of a state's JSON.
fn change(json: &str, from: &str, to: &str) -> String {
    assert!(json.contains(from), "{from} in {json}");
    json.replacen(from, to, 1)
}

fn fields(json: String) -> BTreeMap<String, String> {
    BTreeMap::from([(FIELD.to_owned(), json)])
}

#[test]
fn what_is_no_state_at_all_says_why_and_changes_nothing() {
    let json = odd().to_json();
    for (bad, why) in [
        (String::new(), "not a state of Sprung: EOF"),
        ("[]".to_owned(), "not a state of Sprung"),
        ("{}".to_owned(), "not a state of Sprung: there is neither a preset nor a kit"),
        (change(&json, "\"preset\":", "\"present\":"), "not a state of Sprung: there is neither"),
        (change(&json, "format = 1", "format = "), "the state's preset:"),
        (change(&json, "format = 1", "fermat = 4"), "the state's preset: there is no ‘format’"),
    ] {
        let error = State::parse(&bad).unwrap_err();
        assert!(error.starts_with(why), "{error}");
        let params = SprungParams::default();
        params.load(odd().into());
        let mut state = wrapped(&SprungParams::default());
        state.fields = fields(bad);
        filter(&mut state);
        assert!(state.params.is_empty() && state.fields.is_empty());
        params.deserialize_fields(&state.fields);
        assert_eq!(params.state(), odd());
    }
}

#[test]
fn what_can_be_read_is_taken_over_and_the_rest_is_told() {
    let json = odd().to_json();
    let with = |param: Param, value: f32| {
        let mut state = odd();
        state.values.set(param, value);
        state.positions[param as usize] = positions_of(&state.values)[param as usize];
        let Playable::Preset(preset) = &mut state.playable else { panic!("a preset") };
        preset.patch.values = state.values;
        state
    };
    let sized = |size| State { view: View { size, ..odd_view() }, ..odd() };
    let knob = || State { positions: positions_of(&odd().values), ..odd() };
    let default = Param::Decay.info().default;
    for (from, to, expected, why) in [
        ("\"format\":1", "\"format\":2", odd(), "state format 2 is of a newer version: this one reads 1"),
        ("{\"format\":1,", "{", odd(), "state format null is unknown"),
        ("\"seed\":42", "\"seed\":-1", State { seed: 0, ..odd() }, "seed: -1 is none"),
        ("\"seed\":42", "\"sead\":42", State { seed: 0, ..odd() }, "unknown key ‘sead’"),
        ("[1000,500]", "[1000,0]", sized(VIEW.size), "window: [1000,0] is out of range: expected two"),
        ("[1000,500]", "[1000]", sized(VIEW.size), "window: [1000] is out of range"),
        (
            "\"zoom\":150",
            "\"zoom\":10",
            State { view: View { zoom: 100, ..odd_view() }, ..odd() },
            "zoom: 10 is out of",
        ),
        (
            "\"light\"",
            "\"pink\"",
            State { view: View { theme: VIEW.theme, ..odd_view() }, ..odd() },
            "theme: there is none",
        ),
        ("{\"gain\":0.12345678}", "[]", knob(), "positions: expected numbers by parameter, found []"),
        ("\"gain\":0.12345678", "\"gain\":1.5", knob(), "positions.gain: 1.5 is not a position of that knob"),
        ("\"gain\":0.12345678", "\"gain\":null", knob(), "positions.gain: expected a number, found null"),
        ("\"gain\":0.12345678", "\"mode\":0.5", knob(), "positions.mode: 0.5 is not a position of that knob"),
        ("\"gain\":0.12345678", "\"gian\":0.5", knob(), "positions: there is no parameter ‘gian’"),
        ("format = 1", "format = 9", odd(), "format 9 is of a newer version"),
        ("decay = 0.12345679", "decay = nan", with(Param::Decay, default), "params.decay: NaN is out of range"),
        ("decay = 0.12345679", "decya = 1", with(Param::Decay, default), "unknown key ‘params.decya’"),
    ] {
        let params = SprungParams::default();
        let mut state = wrapped(&SprungParams::default());
        state.fields = fields(change(&json, from, to));
        filter(&mut state);
        params.deserialize_fields(&state.fields);
        assert_eq!(params.state(), expected, "{why}");
        let complaints = params.complaints();
        assert!(complaints.len() == 1 && complaints[0].starts_with(why), "{complaints:?}");
        params.load(odd().into());
        assert!(params.complaints().is_empty(), "of the last state only");
    }
}

#[test]
fn parameters_that_a_state_does_not_name_have_their_defaults() {
    let params = SprungParams::default();
    params.load(odd().into());
    let short = r#"{"format":1,"preset":"format = 1\nname = \"Short\"\n[params]\ngain = -3","window":[880,640]}"#;
    params.deserialize_fields(&fields(short.to_owned()));
    let patch = Patch::default().with(Param::Gain, -3.0);
    let preset = Preset::new("Short", patch);
    assert_eq!(params.state(), State::new(Playable::Preset(preset), 0, View { size: [880, 640], ..VIEW }));
    assert!(params.complaints().is_empty());
}

/// For each released version, the folder has a state written by that version, and the preset in that state.
#[test]
fn states_of_all_versions_load() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/states");
    let own = folder.join(concat!(env!("CARGO_PKG_VERSION"), ".json"));
    if !own.exists() {
        let params = SprungParams::default();
        params.load(odd().into());
        std::fs::write(&own, serde_json::to_string_pretty(&wrapped(&params)).unwrap()).unwrap();
        std::fs::write(own.with_extension("toml"), odd().playable.to_toml()).unwrap();
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
        let State { playable, positions, seed, view, .. } = params.state();
        assert_eq!(playable, Playable::Preset(expected), "{}", path.display());
        assert_eq!((seed, view.size), (42, [1000, 500]), "{}", path.display());
        assert_eq!(positions[Param::Gain as usize], 0.123_456_78, "{}", path.display());
    }
}

proptest! {
    // Each case has a position for every parameter.
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn knobs_come_back_to_where_they_stood(
        positions in proptest::collection::vec(0.0..=1.0f32, PARAM_COUNT),
    ) {
        let mut state = State::default();
        for (index, info) in PARAMS.iter().enumerate() {
            let value = info.denormalise(f64::from(positions[index]));
            state.values.set(info.param, value);
            let stepped = matches!(info.unit, Unit::Count | Unit::Choice);
            state.positions[index] = if stepped { info.normalise(value) as f32 } else { positions[index] };
        }
        let Playable::Preset(preset) = &mut state.playable else { panic!("a preset") };
        preset.patch.values = state.values;
        let json = state.to_json();
        let (params, read) = (SprungParams::default(), State::parse(&json).map_err(TestCaseError::fail)?);
        prop_assert_eq!(&read, &state.into());
        params.load(read);
        prop_assert_eq!(params.state().to_json(), json);
    }

    #[test]
    fn random_text_is_refused(text in "\\PC*") {
        prop_assert!(State::parse(&text).is_err());
    }
}
