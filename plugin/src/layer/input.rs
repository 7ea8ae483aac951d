//! A host's events on their way to the wrapper: modulation is translated, and bound controllers turn their knobs.
//!
//! The host's list is neither changed nor copied: the wrapper gets a list that asks the host's, and that has room for one
//! event. A controller's movement becomes the parameter's new value in the same place, which is told to the host as well, as a
//! gesture of its own, so that it can show and record it. Real-time safe.

use super::indication::number;
use super::instance::Instance;
use super::modulation;
use clap_sys::events::*;
use clap_sys::plugin::clap_plugin;
use clap_sys::process::{CLAP_PROCESS_ERROR, clap_process, clap_process_status};
use sprung::engine::EventKind;
use sprung::engine::midi::parse_message;
use sprung::internals::learned::Movement;
use sprung::params::{ParamInfo, Unit};
use std::ptr;

/// A host's events, as the wrapper gets them.
struct Input<'a> {
    own: &'a Instance,
    events: *const clap_input_events,
    told: *const clap_output_events,
    /// The number of the event that was asked for last, and what was given for it. The wrapper is done with an event when it
    /// asks for another one; it asks twice for one at which it divides the block.
    last: Option<(u32, Given)>,
    /// The first frame of the part of the block that the wrapper is about to play.
    part: u32,
}

/// What the wrapper is given in place of a host's event.
#[derive(Clone, Copy)]
enum Given {
    /// The event itself.
    Same(*const clap_event_header),
    Modulation(clap_event_param_mod),
    /// A value, and whether the host has been told.
    Value(clap_event_param_value, bool),
    Nothing,
}

pub(super) unsafe extern "C" fn process(
    plugin: *const clap_plugin,
    process: *const clap_process,
) -> clap_process_status {
    // SAFETY: hosts pass the plugin that they got, and a description of the block that lives during the call, as do the lists of
    // this function. The wrapper refuses null.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return CLAP_PROCESS_ERROR };
        let Some(pass_on) = (*own.wrapper()).process else { return CLAP_PROCESS_ERROR };
        let Some(block) = process.as_ref().filter(|block| !block.in_events.is_null()) else {
            return pass_on(own.wrapper(), process);
        };
        let mut input = Input { own, events: block.in_events, told: block.out_events, last: None, part: 0 };
        let list = clap_input_events { ctx: (&raw mut input).cast(), size: Some(size), get: Some(get) };
        pass_on(own.wrapper(), &clap_process { in_events: &list, ..*block })
    }
}

unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
    // SAFETY: the list is that of `process`, and the host's list in it lives.
    unsafe {
        let events = (*(*list).ctx.cast::<Input>()).events;
        (*events).size.map_or(0, |size| size(events))
    }
}

unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above.
    unsafe {
        let input = &mut *(*list).ctx.cast::<Input>();
        let Some(ask) = (*input.events).get else { return ptr::null() };
        let is_again = input.last.is_some_and(|(last, _)| last == index);
        if !is_again {
            input.last = Some((index, given(input.own, ask(input.events, index))));
        }
        let Some((_, given)) = &mut input.last else { return ptr::null() };
        let event: *const clap_event_header = match given {
            Given::Same(event) => *event,
            Given::Modulation(event) => &raw const event.header,
            Given::Value(event, _) => &raw const event.header,
            Given::Nothing => ptr::null(),
        };
        if is_again && let Some(event) = event.as_ref() {
            input.part = event.time;
        }
        // Not before the notes that end until then.
        if let Given::Value(event, is_told) = given
            && event.header.time <= input.part
            && !std::mem::replace(is_told, true)
        {
            tell(input.told, event);
        }
        event
    }
}

/// What the wrapper gets for a host's event.
///
/// # Safety
/// It is null or an event that lives.
unsafe fn given(own: &Instance, event: *const clap_event_header) -> Given {
    // SAFETY: as the caller promises; events of these types and sizes are of these structures.
    unsafe {
        let Some(header) = event.as_ref().filter(|header| header.space_id == CLAP_CORE_EVENT_SPACE_ID) else {
            return Given::Same(event);
        };
        match header.type_ {
            CLAP_EVENT_PARAM_MOD if header.size as usize >= size_of::<clap_event_param_mod>() => {
                modulation::translated(&*event.cast()).map_or(Given::Same(event), Given::Modulation)
            }
            CLAP_EVENT_MIDI if header.size as usize >= size_of::<clap_event_midi>() => {
                let midi: &clap_event_midi = &*event.cast();
                turned(own, midi).unwrap_or(Given::Same(event))
            }
            _ => Given::Same(event),
        }
    }
}

/// What becomes of a MIDI message that is a bound controller's; none for all others.
fn turned(own: &Instance, midi: &clap_event_midi) -> Option<Given> {
    let (_, EventKind::Control { controller, value: at }) = parse_message(&midi.data)? else { return None };
    // Nobody else has it: a host calls `process` on one thread at a time.
    let mut takeover = own.takeover.try_borrow_mut().ok()?;
    match takeover.follow(own.params.learned(), controller, at, |info| own.params.present(info)) {
        Movement::Free => None,
        Movement::Nothing => Some(Given::Nothing),
        Movement::Turns(info) => Some(Given::Value(value_of(info, at, midi.header.time), false)),
    }
}

/// The event that moves a parameter's knob to a position.
fn value_of(info: &ParamInfo, at: f32, time: u32) -> clap_event_param_value {
    // The wrapper counts the steps of a parameter that has some.
    let value = match info.unit {
        Unit::Count | Unit::Choice => info.denormalise(at.into()) - info.min,
        _ => at,
    };
    clap_event_param_value {
        header: header::<clap_event_param_value>(CLAP_EVENT_PARAM_VALUE, time),
        param_id: number(info.id),
        cookie: ptr::null_mut(),
        note_id: -1,
        port_index: -1,
        channel: -1,
        key: -1,
        value: value.into(),
    }
}

fn header<T>(type_: u16, time: u32) -> clap_event_header {
    let (size, space_id) = (size_of::<T>() as u32, CLAP_CORE_EVENT_SPACE_ID);
    clap_event_header { size, time, space_id, type_, flags: CLAP_EVENT_IS_LIVE }
}

/// Tells the host that a knob has been turned. What it has no room for is lost.
///
/// # Safety
/// It is null or a list of the host's that lives.
unsafe fn tell(list: *const clap_output_events, event: &clap_event_param_value) {
    // SAFETY: as the caller promises.
    unsafe {
        let Some(list) = list.as_ref() else { return };
        let Some(push) = list.try_push else { return };
        let gesture = |type_| clap_event_param_gesture {
            header: header::<clap_event_param_gesture>(type_, event.header.time),
            param_id: event.param_id,
        };
        if push(list, &gesture(CLAP_EVENT_PARAM_GESTURE_BEGIN).header) {
            push(list, &event.header);
            push(list, &gesture(CLAP_EVENT_PARAM_GESTURE_END).header);
        }
    }
}
