//! Modulation of the notes of a key or a channel.
//!
//! The wrapper knows single notes by their ids and all notes at once, and takes what a host sends to a key for all notes.
//! Such an event passes the wrapper as one of a single note, whose id is a number that no host uses
//! (`events::number_of_notes`).

use super::instance::Instance;
use crate::events::number_of_notes;
use clap_sys::events::clap_event_param_mod;
use clap_sys::ext::params::{
    CLAP_PARAM_IS_MODULATABLE_PER_CHANNEL, CLAP_PARAM_IS_MODULATABLE_PER_KEY, CLAP_PARAM_IS_MODULATABLE_PER_NOTE_ID,
    clap_param_info,
};
use clap_sys::plugin::clap_plugin;

/// Replaces the wrapper's `get_info`, so that parameters say that they can be modulated by key and channel.
pub(super) fn replace(own: &mut Instance) {
    if let Some(knobs) = &mut own.knobs {
        knobs.get_info = Some(get_info);
    }
}

/// What is modulated by note is modulated by key and channel as well.
unsafe extern "C" fn get_info(plugin: *const clap_plugin, index: u32, info: *mut clap_param_info) -> bool {
    // SAFETY: hosts pass the plugin that they got and room for the answer, on the main thread; the wrapper refuses null.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return false };
        let Some(get_info) = own.wrapper_knobs().and_then(|knobs| knobs.get_info) else { return false };
        if !get_info(own.wrapper(), index, info) {
            return false;
        }
        if (*info).flags & CLAP_PARAM_IS_MODULATABLE_PER_NOTE_ID != 0 {
            (*info).flags |= CLAP_PARAM_IS_MODULATABLE_PER_KEY | CLAP_PARAM_IS_MODULATABLE_PER_CHANNEL;
        }
        true
    }
}

/// An event for the notes of a key or a channel as one of a single note; none if it is for one note, or for all.
pub(super) fn translated(event: &clap_event_param_mod) -> Option<clap_event_param_mod> {
    let note_id = number_of_notes(event.channel, event.key).filter(|_| event.note_id == -1)?;
    Some(clap_event_param_mod { note_id, ..*event })
}
