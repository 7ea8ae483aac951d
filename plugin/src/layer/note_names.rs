//! CLAP's note names: those of a kit's pads at their keys.
//!
//! A preset has none, since all of its keys play one sound.
//!
//! The host is told when another sound with other names is loaded (`instance`), whoever has loaded it.

use super::c::fill;
use super::instance::Instance;
use clap_sys::ext::note_name::{clap_note_name, clap_plugin_note_name};
use clap_sys::plugin::clap_plugin;
use clap_sys::string_sizes::CLAP_NAME_SIZE;

pub(super) static NOTE_NAMES: clap_plugin_note_name = clap_plugin_note_name { count: Some(count), get: Some(get) };

unsafe extern "C" fn count(plugin: *const clap_plugin) -> u32 {
    // SAFETY: hosts pass the plugin that they got, on the main thread.
    unsafe { Instance::of(plugin) }.map_or(0, |own| own.params.note_names().len() as u32)
}

unsafe extern "C" fn get(plugin: *const clap_plugin, index: u32, into: *mut clap_note_name) -> bool {
    // SAFETY: as above.
    let Some(own) = (unsafe { Instance::of(plugin) }) else { return false };
    let names = own.params.note_names();
    let Some((key, name)) = names.get(index as usize).filter(|_| !into.is_null()) else { return false };
    // −1: every port and every channel.
    let mut told = clap_note_name { name: [0; CLAP_NAME_SIZE], port: -1, key: i16::from(*key), channel: -1 };
    fill(&mut told.name, name);
    // SAFETY: it is not null, so it has room for a name.
    unsafe { into.write(told) };
    true
}
