//! What VST3 projects contain: the plugin's class id, its parameters' ids, and states of every version.

use crate::patches::own_part_of;
use crate::vst3_host::{Module, Vst3};
use sprung::params::PARAMS;
use sprung::patch::Patch;
use sprung::preset::Preset;

/// The number that identifies a parameter in VST3 projects, from its id in the table. Pinned.
fn number(id: &str) -> u32 {
    id.bytes().fold(0_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte.into())) & (u32::MAX >> 1)
}

pub(crate) fn parameters_have_the_numbers_of_their_ids() {
    // `Vst3::new` requests the class by its pinned id.
    let plugin = Vst3::new(&Module::open());
    for (index, info) in (0..).zip(PARAMS) {
        let expected = Some((number(info.id), info.name.to_owned()));
        assert_eq!(plugin.parameter(index), expected, "{}", info.id);
    }
    assert_eq!(number("gain"), 3_165_055, "the rule itself is pinned");
    let count = plugin.parameter_count();
    assert_eq!(count as usize, PARAMS.len() + 16 * 130);
    assert!(plugin.parameter(count - 1).is_some());
    assert_eq!([plugin.parameter(count), plugin.parameter(-1)], [None, None], "one past the last is none");
}

pub(crate) fn states_of_all_versions_load() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/states");
    let module = Module::open();
    let mut versions = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        versions += 1;
        let preset = std::fs::read_to_string(path.with_extension("toml")).expect("each lies beside its preset");
        let patch = Preset::parse(&preset, "the preset").unwrap().patch;
        assert_ne!(patch, Patch::default(), "{}: it would not show if nothing was loaded", path.display());
        let (plugin, state) = (Vst3::new(&module), std::fs::read(&path).unwrap());
        assert!(plugin.load(&state), "{}", path.display());
        for info in PARAMS {
            // A knob may have been saved at a position other than the one that its value alone would give.
            let saved = own_part_of(&state)["positions"][info.id].as_f64();
            let expected = saved.unwrap_or_else(|| info.normalise(patch.get(info.param)));
            let position = plugin.position(number(info.id));
            assert!((position - expected).abs() < 1e-6, "{}: {} is at {position}", path.display(), info.id);
        }
        // The saved state contains the patch to the bit.
        let saved = own_part_of(&plugin.save());
        let found = Preset::parse(saved["preset"].as_str().unwrap(), "the saved state").unwrap().patch;
        assert_eq!(found, patch, "{}", path.display());
    }
    assert!(versions > 0, "{}: no states", folder.display());
}
