//! The names of keys, which hosts show in drum editors and on piano rolls.

use crate::host::{Instance, open};
use crate::patches::{drums, load, patches, state, state_of_kit};
use clack_extensions::note_name::{NoteNameBuffer, PluginNoteName};
use clack_host::events::Match;
use sprung::preset::{Playable, Preset};

/// The names of keys as a host reads them.
fn names(instance: &mut Instance) -> Vec<(u16, String)> {
    let handle = instance.clack.plugin_handle();
    let names: PluginNoteName = handle.get_extension().expect("there are note names");
    let count = names.count(&handle) as u32;
    let mut buffer = NoteNameBuffer::new();
    assert!(names.get(&handle, count, &mut buffer).is_none(), "beyond the last");
    let mut read = |index| {
        let name = names.get(&handle, index, &mut buffer).expect("a known name");
        assert_eq!((name.port, name.channel), (Match::All, Match::All));
        let Match::Specific(key) = name.key else { panic!("each name is of a key") };
        (key, String::from_utf8(name.name.to_vec()).expect("names are UTF-8"))
    };
    (0..count).map(&mut read).collect()
}

fn kit() -> sprung::preset::KitPreset {
    let Playable::Kit(kit) = drums() else { panic!("a kit") };
    kit
}

pub(crate) fn pads_have_their_names_at_their_keys() {
    let mut kit = kit();
    kit.pads[0].1.name = "♪".repeat(100);
    let long = kit.pads[0].1.name.clone();
    for mut instance in Instance::of_each(&open()) {
        assert_eq!(names(&mut instance), [], "a preset has no names");
        assert!(instance.load(&state_of_kit(&Playable::Kit(kit.clone()))));
        let found = names(&mut instance);
        assert_eq!(found.len(), kit.pads.len());
        assert!(found.is_sorted_by(|one, next| one.0 < next.0), "in the order of the keys");
        for (key, pad) in &kit.pads {
            let of_sound = &kit.sounds[pad.sound].1.name;
            let expected = if pad.name.is_empty() { of_sound } else { &pad.name };
            let (_, name) = found.iter().find(|(other, _)| *other == u16::from(*key)).expect("each pad has a name");
            // CLAP has room for 255 bytes.
            assert!(name == expected || (*expected == long && long.starts_with(name) && name.len() == 255), "{name}");
        }
        assert!(instance.load(&state(&Preset::find("Marimba").unwrap().patch)));
        assert_eq!(names(&mut instance), [], "names go with their kit");
    }
}

pub(crate) fn the_host_is_told_when_names_change() {
    let mut instance = Instance::new();
    instance.renamings();
    let mut other = kit();
    other.pads[3].1.name = "Another".to_owned();
    let (first, second) = (state_of_kit(&drums()), state_of_kit(&Playable::Kit(other)));
    for (state, times) in [(&first, 1), (&first, 0), (&second, 1), (&first, 1)] {
        assert!(instance.load(state));
        assert_eq!(instance.renamings(), times);
    }
    for ((name, patch), times) in patches().iter().zip([1, 0, 0]) {
        load(&mut instance, patch);
        assert_eq!(instance.renamings(), times, "{name}");
    }
    assert!(!instance.load(b"no state"));
    assert_eq!(instance.renamings(), 0);
}
