//! Modulation of the notes of a key or a channel.
//!
//! The wrapper knows single notes by their ids and all notes at once, and takes what a host sends to a key for all notes.
//! Such an event passes the wrapper as one of a single note, whose id is a number that no host uses
//! (`events::number_of_notes`). The host's list of events is neither changed nor copied: the wrapper gets a list that asks the
//! host's, and that has room for one event. Real-time safe.

use super::instance::Instance;
use crate::events::number_of_notes;
use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD, clap_event_header, clap_event_param_mod, clap_input_events,
};
use clap_sys::ext::params::{
    CLAP_PARAM_IS_MODULATABLE_PER_CHANNEL, CLAP_PARAM_IS_MODULATABLE_PER_KEY, CLAP_PARAM_IS_MODULATABLE_PER_NOTE_ID,
    clap_param_info,
};
use clap_sys::plugin::clap_plugin;
use clap_sys::process::{CLAP_PROCESS_ERROR, clap_process, clap_process_status};
use std::mem::MaybeUninit;
use std::ptr;

/// Has an instance translate modulation, and say so of its parameters.
pub(super) fn replace(own: &mut Instance) {
    own.clap.process = Some(process);
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

/// A host's events, as the wrapper gets them.
struct Translated {
    events: *const clap_input_events,
    /// The event that was translated last. The wrapper is done with an event when it asks for the next one.
    event: MaybeUninit<clap_event_param_mod>,
}

unsafe extern "C" fn process(plugin: *const clap_plugin, process: *const clap_process) -> clap_process_status {
    // SAFETY: hosts pass the plugin that they got, and a description of the block that lives during the call, as do the lists of
    // this function. The wrapper refuses null.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return CLAP_PROCESS_ERROR };
        let Some(pass_on) = (*own.wrapper()).process else { return CLAP_PROCESS_ERROR };
        let Some(block) = process.as_ref().filter(|block| !block.in_events.is_null()) else {
            return pass_on(own.wrapper(), process);
        };
        let mut translated = Translated { events: block.in_events, event: MaybeUninit::uninit() };
        let list = clap_input_events { ctx: (&raw mut translated).cast(), size: Some(size), get: Some(get) };
        pass_on(own.wrapper(), &clap_process { in_events: &list, ..*block })
    }
}

unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
    // SAFETY: the list is that of `process`, and the host's list in it lives.
    unsafe {
        let events = (*(*list).ctx.cast::<Translated>()).events;
        (*events).size.map_or(0, |size| size(events))
    }
}

unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above. An event of this type and size is a `clap_event_param_mod`.
    unsafe {
        let own = (*list).ctx.cast::<Translated>();
        let events = (*own).events;
        let Some(get) = (*events).get else { return ptr::null() };
        let header = get(events, index);
        let is_modulation = |header: &clap_event_header| {
            (header.space_id, header.type_) == (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD)
                && header.size as usize >= size_of::<clap_event_param_mod>()
        };
        if !header.as_ref().is_some_and(is_modulation) {
            return header;
        }
        let event = *header.cast::<clap_event_param_mod>();
        match number_of_notes(event.channel, event.key).filter(|_| event.note_id == -1) {
            Some(note_id) => ptr::from_ref((*own).event.write(clap_event_param_mod { note_id, ..event })).cast(),
            None => header,
        }
    }
}
