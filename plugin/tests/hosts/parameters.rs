//! Every parameter of the table as a host sees it: id, name, range, conversion to and from text, value.

use crate::host::{Address, Instance, Parameter, Sent, open};
use clack_extensions::params::ParamInfoFlags;
use clack_extensions::remote_controls::{PluginRemoteControls, RemoteControlsPageBuffer};
use clack_host::prelude::*;
use sprung::params::{Change, PARAMS, Param, ParamInfo, Unit};
use sprung::preset::Preset;
use std::collections::BTreeSet;

/// Knob positions that are tried for each parameter.
const POSITIONS: [f64; 9] = [0.0, 1.0, 0.5, 0.25, 0.1, 0.333_333, 0.9, 0.01, 0.618];

/// The rows of the table, each with the parameter that the host sees.
fn rows(instance: &mut Instance) -> Vec<(&'static ParamInfo, Parameter)> {
    let parameters = instance.parameters();
    let find = |info: &'static ParamInfo| {
        let found: Vec<_> = parameters.iter().filter(|parameter| parameter.name == info.name).collect();
        assert_eq!(found.len(), 1, "{} parameters are called ‘{}’", found.len(), info.name);
        (info, found[0].clone())
    };
    PARAMS.iter().map(find).collect()
}

/// Whether the host's values of the parameter are steps.
pub(crate) fn is_stepped(info: &ParamInfo) -> bool {
    matches!(info.unit, Unit::Count | Unit::Choice)
}

/// The host's value for a parameter's value: a knob position, or a step.
pub(crate) fn host_value(info: &ParamInfo, value: f32) -> f64 {
    if is_stepped(info) { f64::from(value - info.min) } else { info.normalise(value) }
}

/// The parameter's value for a host's value, which the wrapper passes in single precision.
fn table_value(info: &ParamInfo, value: f64) -> f32 {
    if is_stepped(info) { info.min + value as f32 } else { info.denormalise(f64::from(value as f32)) }
}

/// Values that hosts may send for a parameter.
fn host_values(info: &ParamInfo) -> Vec<f64> {
    if is_stepped(info) { (0..=(info.max - info.min) as u32).map(f64::from).collect() } else { POSITIONS.to_vec() }
}

/// The value of a parameter in a new instance, which is a sound to begin with.
fn first_value(info: &ParamInfo) -> f32 {
    Preset::find("Church Bell").unwrap().patch.values.get(info.param)
}

/// Songs and automation contain the host's ids: each is the hash of the table's id that the wrapper has always used.
pub(crate) fn ids_are_those_of_the_table_for_ever() {
    let hash = |id: &str| {
        let sum = id.bytes().fold(0_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
        sum & !(1 << 31)
    };
    for (info, parameter) in rows(&mut Instance::new()) {
        assert_eq!(parameter.id.get(), hash(info.id), "{}", info.id);
    }
    assert_eq!(hash("gain"), 3_165_055, "the hash itself");
}

pub(crate) fn all_of_the_table_is_told() {
    let mut instance = Instance::new();
    assert_eq!(instance.parameters().len(), PARAMS.len(), "the table and nothing else");
    for (info, parameter) in rows(&mut instance) {
        let id = info.id;
        assert_eq!(parameter.module, info.section, "{id}");
        let travel = if is_stepped(info) { f64::from(info.max - info.min) } else { 1.0 };
        assert_eq!((parameter.min, parameter.max), (0.0, travel), "{id}");
        assert!((parameter.default - host_value(info, first_value(info))).abs() < 1e-6, "{id}: {}", parameter.default);
        let has = |flag| parameter.flags.contains(flag);
        assert_eq!(has(ParamInfoFlags::IS_STEPPED), is_stepped(info), "{id}");
        assert!(has(ParamInfoFlags::IS_AUTOMATABLE | ParamInfoFlags::IS_MODULATABLE), "{id}");
        let by_note = matches!(info.change, Change::Smoothed(_));
        for by in [
            ParamInfoFlags::IS_MODULATABLE_PER_NOTE_ID,
            ParamInfoFlags::IS_MODULATABLE_PER_KEY,
            ParamInfoFlags::IS_MODULATABLE_PER_CHANNEL,
        ] {
            assert_eq!(has(by), by_note, "{id}");
        }
        let odd = ParamInfoFlags::IS_HIDDEN | ParamInfoFlags::IS_READONLY | ParamInfoFlags::IS_BYPASS;
        assert!(!parameter.flags.intersects(odd), "{id}");
    }
}

pub(crate) fn a_new_instance_has_the_defaults() {
    let mut instance = Instance::new();
    for (info, parameter) in rows(&mut instance) {
        let value = instance.value(parameter.id).unwrap();
        assert_eq!(value as f32, parameter.default as f32, "{}", info.id);
        assert_eq!(instance.text(parameter.id, value).unwrap(), info.format(first_value(info)), "{}", info.id);
    }
}

pub(crate) fn texts_and_values_go_both_ways() {
    let mut instance = Instance::new();
    for (info, parameter) in rows(&mut instance) {
        for value in host_values(info) {
            let text = instance.text(parameter.id, value).unwrap();
            assert_eq!(text, info.format(table_value(info, value)), "{} at {value}", info.id);
            let read = instance.parse(parameter.id, &text).unwrap_or_else(|| panic!("{}: ‘{text}’", info.id));
            assert!((0.0..=parameter.max).contains(&read), "{}: {read}", info.id);
            assert_eq!(instance.text(parameter.id, read).unwrap(), text, "{} at {value}", info.id);
            let again = instance.parse(parameter.id, &text).unwrap();
            assert_eq!(again.to_bits(), read.to_bits(), "{}: ‘{text}’ is not read the same twice", info.id);
        }
        for position in [-1.0, 2.0 * parameter.max, 1e300, -1e300] {
            let text = instance.text(parameter.id, position).unwrap();
            assert!(info.parse(&text).is_ok(), "{}: {position} becomes ‘{text}’", info.id);
        }
    }
}

pub(crate) fn what_people_type_is_understood_or_refused() {
    let mut instance = Instance::new();
    for (param, text, expected) in [
        (Param::Decay, "250 ms", Some(0.25)),
        (Param::Decay, " 1.5 s", Some(1.5)),
        (Param::Decay, "0.25", Some(0.25)),
        (Param::Tuning, "A4", Some(440.0)),
        (Param::Tune, "1 oct", Some(12.0)),
        (Param::Gain, "-12dB", Some(-12.0)),
        (Param::MalletPulse, "Contact", Some(1.0)),
        (Param::Voices, "8", Some(8.0)),
        (Param::Decay, "soon", None),
        (Param::Decay, "", None),
        (Param::Decay, "3 Hz", None),
        (Param::Gain, "NaN", None),
        (Param::Gain, "99 dB", None),
        (Param::Voices, "2.5", None),
        (Param::Mode, "solo", None),
    ] {
        let id = instance.id(param);
        let read = instance.parse(id, text).map(|value| table_value(param.info(), value));
        assert_eq!(read, expected, "{} ‘{text}’", param.info().id);
    }
    let unknown = ClapId::new(12_345);
    assert_eq!(instance.parse(unknown, "1"), None);
    assert_eq!(instance.text(unknown, 0.5), None);
    assert_eq!(instance.value(unknown), None);
}

/// A flush without processing, before the first activation and after it.
pub(crate) fn a_flush_sets_values() {
    let mut instance = Instance::new();
    for round in 0..2 {
        for (info, parameter) in rows(&mut instance) {
            for value in host_values(info) {
                instance.flush(&[Sent::Value(parameter.id, value).at(0)]);
                let found = instance.value(parameter.id).unwrap();
                assert_eq!(found as f32, value as f32, "{} in round {round}", info.id);
            }
        }
        let mut player = instance.play(48_000.0, 64);
        player.render(&[], 64, || 64);
        instance = player.stop();
    }
}

pub(crate) fn senseless_values_and_unknown_ids_change_nothing_else() {
    let mut instance = Instance::new();
    let before = instance.save();
    let unknown = ClapId::new(12_345);
    let mut events = vec![Sent::Value(unknown, 0.3), Sent::Modulate(unknown, Address::id(3), 0.3)];
    for (_, parameter) in rows(&mut instance) {
        events.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|value| Sent::Value(parameter.id, value)));
        events.push(Sent::Foreign(parameter.id, parameter.max - parameter.default));
    }
    let events: Vec<_> = events.into_iter().map(|sent| sent.at(0)).collect();
    instance.flush(&events);
    assert_eq!(instance.save(), before, "in a flush");
    let mut player = instance.play(48_000.0, 64);
    player.render(&events, 64, || 64);
    let mut instance = player.stop();
    assert_eq!(instance.save(), before, "in a block");
    for (info, parameter) in rows(&mut instance) {
        for (wild, expected) in [(1e9, parameter.max), (-1e9, 0.0)] {
            instance.flush(&[Sent::Value(parameter.id, wild).at(0)]);
            assert_eq!(instance.value(parameter.id), Some(expected), "{}", info.id);
        }
    }
}

/// For hardware controllers, and hosts that group parameters: the first page has what one turns first, and after that each
/// parameter is on exactly one page. The effect's own parameters come before.
pub(crate) fn remote_control_pages_begin_with_what_one_turns_first_and_have_every_parameter_once() {
    for (instance, own_pages) in Instance::of_each(&open()).iter_mut().zip([0, 0, 1]) {
        pages_of(instance, own_pages);
    }
}

fn pages_of(instance: &mut Instance, own_pages: u32) {
    let rows = rows(instance);
    let handle = instance.clack.plugin_handle();
    let pages: PluginRemoteControls = handle.get_extension().expect("there are pages");
    let mut buffer = RemoteControlsPageBuffer::new();
    let mut found = Vec::new();
    let mut page_ids = BTreeSet::new();
    for index in 0..pages.count(&handle) {
        let page = pages.get(&handle, index, &mut buffer).expect("a known page");
        assert!(page_ids.insert(page.page_id.get()), "two pages have the same id");
        let id = |id: &ClapId| rows.iter().find(|(_, parameter)| parameter.id == *id).map(|(info, _)| info.id);
        if index < own_pages {
            assert_eq!(page.page_name, b"Resonator");
            assert_eq!(page.param_ids.iter().flatten().map(id).collect::<Vec<_>>(), [None; 3]);
            continue;
        }
        if index == own_pages {
            let ids: Vec<_> = page.param_ids.iter().flatten().filter_map(id).collect();
            assert_eq!(ids, ["macro1", "macro2", "macro3", "macro4", "decay", "tilt", "space_mix", "gain"]);
            continue;
        }
        assert!(index > own_pages + 1 || page.page_name == b"Macros");
        for id in page.param_ids.iter().flatten() {
            let (info, parameter) = rows.iter().find(|(_, parameter)| parameter.id == *id).expect("a known parameter");
            let section = String::from_utf8_lossy(page.section_name);
            let name = String::from_utf8_lossy(page.page_name);
            assert!(section == info.section || name.starts_with(info.section), "{} on ‘{section}/{name}’", info.id);
            found.push(parameter.id.get());
        }
    }
    let different: BTreeSet<_> = found.iter().collect();
    assert_eq!((found.len(), different.len()), (PARAMS.len(), PARAMS.len()));
}
