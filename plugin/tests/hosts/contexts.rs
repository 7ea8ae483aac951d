//! States for projects, for duplicates and for presets.

use crate::host::{Instance, open};
use crate::patches::{drums, enclosed, own_part, state_of_kit};
use clack_extensions::state_context::{PluginStateContext, StateContextType};
use serde_json::{Value, json};
use sprung::preset::Preset;

const OTHERS: [StateContextType; 2] = [StateContextType::ForDuplicate, StateContextType::ForProject];

fn save(instance: &mut Instance, context: StateContextType) -> Vec<u8> {
    let handle = instance.clack.plugin_handle();
    let states: PluginStateContext = handle.get_extension().expect("there are contexts");
    let mut bytes = Vec::new();
    states.save(&handle, &mut bytes, context).expect("it can be saved");
    bytes
}

fn load(instance: &mut Instance, bytes: &[u8], context: StateContextType) -> bool {
    let handle = instance.clack.plugin_handle();
    let states: PluginStateContext = handle.get_extension().expect("there are contexts");
    let taken = states.load(&handle, &mut &*bytes, context).is_ok();
    instance.run_callbacks();
    taken
}

/// A state with a window of its own.
fn state(sound: &str, [width, height]: [u32; 2], zoom: u32, theme: &str) -> Vec<u8> {
    let preset = Preset::find(sound).unwrap().to_toml();
    let window = [width, height];
    let own = json!({
        "format": 1, "preset": preset, "seed": 0, "window": window, "zoom": zoom, "theme": theme,
    });
    enclosed(&own.to_string())
}

/// The window in a saved state.
fn window(state: &[u8]) -> Value {
    let own = own_part(state);
    json!([own["window"], own["zoom"], own["theme"]])
}

fn name(state: &[u8]) -> String {
    Preset::parse(own_part(state)["preset"].as_str().unwrap(), "a state").unwrap().name
}

pub(crate) fn a_preset_neither_has_nor_brings_the_window() {
    let for_preset = StateContextType::ForPreset;
    for mut instance in Instance::of_each(&open()) {
        let fresh = window(&instance.save());
        assert!(instance.load(&state("Marimba", [900, 700], 150, "light")));
        let own = json!([[900, 700], 150, "light"]);
        assert_eq!(window(&instance.save()), own);
        let preset = save(&mut instance, for_preset);
        assert_eq!((window(&preset), name(&preset)), (fresh, "Marimba".to_owned()));
        assert_eq!(window(&instance.save()), own, "saving a preset changes nothing");
        let other = state("Church Bell", [1_300, 800], 75, "high-contrast");
        assert!(load(&mut instance, &other, for_preset));
        let saved = instance.save();
        assert_eq!((window(&saved), name(&saved)), (own.clone(), "Church Bell".to_owned()));
        assert!(!load(&mut instance, b"no state", for_preset));
        assert_eq!(instance.save(), saved, "what is no state changes nothing");
        assert!(instance.load(&other), "and the next project brings its window");
        assert_eq!(window(&instance.save()), json!([[1_300, 800], 75, "high-contrast"]));
    }
}

pub(crate) fn all_other_contexts_are_alike() {
    // They save kits alike.
    let kits = [Some(state_of_kit(&drums())), None, None];
    for (mut instance, kit) in Instance::of_each(&open()).into_iter().zip(kits) {
        for state in kit.into_iter().chain([state("Marimba", [900, 700], 150, "light")]) {
            assert!(instance.load(&state));
            let saved = instance.save();
            for context in OTHERS {
                assert_eq!(save(&mut instance, context), saved, "{context:?}");
                assert!(load(&mut instance, &self::state("Kick", [640, 400], 100, "dark"), context));
                assert!(load(&mut instance, &saved, context));
                assert_eq!(instance.save(), saved, "{context:?}");
            }
        }
    }
}
