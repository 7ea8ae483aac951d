//! Damaged states, states of other versions and non-states: what can be read is used, and nothing else changes.

use crate::host::Instance;
use crate::host::reference::{assert_same_bits, render};
use crate::patches::{enclosed, load, own_part, patch_in, patches, state_of_text};
use crate::state::{FRAMES, RATE, strike, values};
use sprung::internals::random::{key, uniform};
use sprung::params::Param;
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};

fn broken_states(saved: &[u8]) -> Vec<(&'static str, Vec<u8>)> {
    let own = own_part(saved);
    let changed = |change: fn(&mut serde_json::Value)| {
        let mut own = own.clone();
        change(&mut own);
        enclosed(&own.to_string())
    };
    let stream = key(5, 5);
    vec![
        ("nothing", Vec::new()),
        ("three bytes", saved[..3].to_vec()),
        ("a length alone", saved[..8].to_vec()),
        ("cut off", saved[..saved.len() / 2].to_vec()),
        ("zeros", vec![0; 4096]),
        ("a length beyond all memory", [&u64::MAX.to_le_bytes()[..], &saved[8..]].concat()),
        ("noise", (0..4096).map(|n| (uniform(stream, n) * 128.0) as i8 as u8).collect()),
        ("another program's JSON", [&7_u64.to_le_bytes()[..], b"{\"a\":1}"].concat()),
        ("its own part is no JSON", enclosed("sprung")),
        ("its own part is a list", enclosed("[]")),
        ("no preset", changed(|own| drop(own.as_object_mut().unwrap().remove("preset")))),
        ("a preset that is no TOML", state_of_text("= = =")),
        ("a preset without a format", state_of_text("name = \"Broken\"\n")),
    ]
}

/// States of which a part is unreadable, each with the patch that the plugin must make from the rest.
fn states_in_part(saved: &[u8], patch: &Patch) -> Vec<(&'static str, Vec<u8>, Patch)> {
    let own = own_part(saved);
    let changed = |change: fn(&mut serde_json::Value)| {
        let mut own = own.clone();
        change(&mut own);
        (enclosed(&own.to_string()), patch.clone())
    };
    let preset = |modes: &str, params: &str| {
        let text = format!("format = 1\nname = \"Broken\"\nmodes = [{modes}]\n\n[params]\ndecay = 2.5\n{params}\n");
        let mut rest = Patch::default().with(Param::Decay, 2.5);
        if modes.matches("ratio = 2").count() > 0 {
            rest.modes = ModeTable::new(&vec![Mode { ratio: 2.0, ..Mode::UNIT }; modes.matches("ratio = 2").count()]);
        }
        (state_of_text(&text), rest)
    };
    let all = [
        ("a format of the future", changed(|own| own["format"] = 99.into())),
        ("no format", changed(|own| drop(own.as_object_mut().unwrap().remove("format")))),
        ("a seed that is a text", changed(|own| own["seed"] = "zero".into())),
        ("a window without a width", changed(|own| own["window"] = serde_json::json!([0, 640]))),
        ("something of the future", changed(|own| own["scenes"] = serde_json::json!([0, 640]))),
        ("a value out of range", preset("", "gain = 999.0")),
        ("a value that is no number", preset("", "gain = nan")),
        ("an unknown parameter", preset("", "gian = 1.0")),
        ("a mode out of range", preset("{ ratio = -1.0 }, { ratio = 2.0 }", "")),
        ("a mode that is no number", preset("{ ratio = 2.0, level = nan }", "")),
        ("too many modes", preset(&"{ ratio = 2.0 }, ".repeat(MAX_MODES + 1), "")),
    ];
    all.into_iter().map(|(what, (state, rest))| (what, state, rest)).collect()
}

pub(crate) fn what_can_be_read_of_a_state_is_taken_over() {
    let mut source = Instance::new();
    let patch = patches().swap_remove(4).1;
    load(&mut source, &patch);
    let saved = source.save();
    for (what, bytes, expected) in states_in_part(&saved, &patch) {
        let mut instance = Instance::new();
        assert!(instance.load(&bytes), "{what}");
        assert_eq!(patch_in(&instance.save()), expected, "{what}");
    }
}

pub(crate) fn what_is_no_state_changes_nothing() {
    let mut source = Instance::new();
    let patch = patches().swap_remove(4).1;
    load(&mut source, &patch);
    let saved = source.save();
    let set = values(&mut source);
    for (what, bytes) in broken_states(&saved) {
        source.load(&bytes);
        assert_eq!(source.save(), saved, "{what}, while inactive");
        assert_eq!(values(&mut source), set, "{what}: values");
    }
    let mut player = source.play(RATE, 480);
    for (what, bytes) in broken_states(&saved) {
        player.instance.load(&bytes);
        player.render(&[], 480, || 480);
        assert_eq!(player.instance.save(), saved, "{what}, while active");
    }
    let (sent, events) = strike();
    player.audio.reset();
    let found = player.render(&sent, FRAMES, || 480).channels;
    assert_same_bits("after them all", &found, &render(&patch, RATE, &events, FRAMES));
}

/// One to three bytes of a state are changed. Whether or not the plugin accepts it, it never has half a patch.
pub(crate) fn damaged_states_never_leave_half_a_patch() {
    let mut source = Instance::new();
    load(&mut source, &patches()[1].1);
    let saved = source.save();
    let stream = key(9, 9);
    for n in 0..300 {
        let mut bytes = saved.clone();
        for hit in 0..1 + n % 3 {
            let place = 8 + ((uniform(stream, 4 * n + hit) + 1.0) / 2.0 * (saved.len() - 8) as f32) as usize;
            bytes[place] = bytes[place].wrapping_add(1 + (n as u8 % 200));
        }
        let mut instance = Instance::new();
        let before = instance.save();
        instance.load(&bytes);
        let after = instance.save();
        // Either the state was refused, or the plugin now has a complete patch that it saves and loads.
        if after != before {
            let mut again = Instance::new();
            assert!(again.load(&after), "damage {n}");
            assert_eq!(again.save(), after, "damage {n}");
        }
    }
}
