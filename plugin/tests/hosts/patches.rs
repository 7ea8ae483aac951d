//! Sounds to play, and how they are loaded into the plugin: as the state in a host's project.

use crate::host::Instance;
use sprung::params::Param;
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::{Playable, Preset};
use std::fs::File;
use std::path::Path;

/// Sounds that together use every exciter, few and many modes, both laws, and values between knob positions.
pub(crate) fn patches() -> Vec<(&'static str, Patch)> {
    let factory = |name: &'static str| (name, Preset::find(name).unwrap().patch.clone());
    let mut odd = Patch::default()
        .with(Param::MalletLevel, -60.0)
        .with(Param::PluckLevel, 0.0)
        .with(Param::Decay, 0.731_234_5)
        .with(Param::Mode, 2.0)
        .with(Param::Glide, 0.0503)
        .with(Param::Vibrato, 13.7)
        .with(Param::VibratoRate, 5.321)
        .with_route(0, Source::Pressure, Param::Damper, 33.3)
        .with_route(1, Source::Pressure, Param::Vibrato, 5.9)
        .with(Param::Gain, -7.77);
    odd.modes = ModeTable::new(&[
        Mode::UNIT,
        Mode { ratio: 2.756_1, level: 0.5, decay: 0.6, strike: 0.8, pan: -0.7 },
        Mode { ratio: 5.404, level: -0.25, decay: 0.3, strike: 0.0, pan: 0.7 },
    ]);
    vec![
        ("defaults", Patch::default()),
        factory("Marimba"),
        factory("Church Bell"),
        factory("Snare"),
        ("odd legato", odd.clone()),
        ("classic", odd.with(Param::Coefficients, 1.0).with(Param::Mode, 0.0)),
    ]
}

/// The state that contains a patch.
pub(crate) fn state(patch: &Patch) -> Vec<u8> {
    state_of_text(&Preset::new("Of a test", patch.clone()).to_toml())
}

/// The state that contains the text of a preset file.
pub(crate) fn state_of_text(preset: &str) -> Vec<u8> {
    let own = serde_json::json!({ "format": 1, "preset": preset, "seed": 0, "window": [880, 640] });
    enclosed(&own.to_string())
}

/// The kit in this repository, as the command reads it.
pub(crate) fn drums() -> Playable {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/kits/acoustic-kit.toml");
    let mut open = |path: &Path| Ok(File::open(path).expect("the file is there"));
    Playable::read(&path, &mut open).unwrap()
}

/// The state that contains a kit and its presets.
pub(crate) fn state_of_kit(kit: &Playable) -> Vec<u8> {
    let Playable::Kit(preset) = kit else { panic!("a kit") };
    let sounds = preset.sounds.iter().map(|(name, preset)| (name.clone(), preset.to_toml().into())).collect();
    let sounds = serde_json::Value::Object(sounds);
    let own = serde_json::json!(
        { "format": 1, "kit": kit.to_toml(), "sounds": sounds, "seed": 0, "window": [880, 640] }
    );
    enclosed(&own.to_string())
}

/// The plugin's own part of a state, inside the wrapper's part.
pub(crate) fn enclosed(own: &str) -> Vec<u8> {
    let whole = serde_json::json!({ "version": "0.1.0", "params": {}, "fields": { "sprung": own } }).to_string();
    let mut bytes = (whole.len() as u64).to_le_bytes().to_vec();
    bytes.extend(whole.as_bytes());
    bytes
}

/// The plugin's own part of a state saved by a CLAP host, which starts with its length.
pub(crate) fn own_part(state: &[u8]) -> serde_json::Value {
    own_part_of(&state[8..])
}

/// The plugin's own part of a state saved by a VST3 host.
pub(crate) fn own_part_of(state: &[u8]) -> serde_json::Value {
    let whole: serde_json::Value = serde_json::from_slice(state).unwrap();
    serde_json::from_str(whole["fields"]["sprung"].as_str().expect("the plugin keeps its own field")).unwrap()
}

/// The patch in a saved state.
pub(crate) fn patch_in(state: &[u8]) -> Patch {
    let own = own_part(state);
    Preset::parse(own["preset"].as_str().unwrap(), "the saved state").unwrap().patch
}

/// Loads a patch into an instance.
#[track_caller]
pub(crate) fn load(instance: &mut Instance, patch: &Patch) {
    assert!(instance.load(&state(patch)), "the plugin takes a state");
    assert_eq!(patch_in(&instance.save()), *patch, "it has the patch that was loaded, to the bit");
}
