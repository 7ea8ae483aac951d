//! The layer as a host in C calls it, also wrongly, where a host in Rust cannot look or would not go.

use super::entry::ENTRY;
use super::indication::number;
use super::instance::Instance;
use crate::marks::{Automation, Mapping, Mark};
use clap_sys::audio_buffer::clap_audio_buffer;
use clap_sys::color::clap_color;
use clap_sys::events::*;
use clap_sys::ext::note_name::{CLAP_EXT_NOTE_NAME, clap_plugin_note_name};
use clap_sys::ext::param_indication::{
    CLAP_EXT_PARAM_INDICATION, CLAP_EXT_PARAM_INDICATION_COMPAT, clap_plugin_param_indication,
};
use clap_sys::ext::params::{CLAP_EXT_PARAMS, clap_plugin_params};
use clap_sys::ext::preset_load::{CLAP_EXT_PRESET_LOAD, clap_plugin_preset_load};
use clap_sys::ext::state_context::{CLAP_EXT_STATE_CONTEXT, clap_plugin_state_context};
use clap_sys::factory::plugin_factory::{CLAP_PLUGIN_FACTORY_ID, clap_plugin_factory};
use clap_sys::factory::preset_discovery::*;
use clap_sys::host::clap_host;
use clap_sys::plugin::clap_plugin;
use clap_sys::process::{CLAP_PROCESS_ERROR, clap_process};
use clap_sys::version::CLAP_VERSION;
use sprung::internals::learned::Controllers;
use sprung::params::{PARAM_COUNT, PARAMS, Param};
use sprung::preset::Playable;
use std::ffi::{CStr, c_void};
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// A host that has no extensions at all, and no functions if `is_bare`.
fn host(is_bare: bool) -> clap_host {
    unsafe extern "C" fn none(_: *const clap_host, _: *const std::ffi::c_char) -> *const c_void {
        null()
    }
    unsafe extern "C" fn count(host: *const clap_host) {
        // SAFETY: a test's host lives, and its data is a count or null.
        if let Some(count) = unsafe { (*host).host_data.cast::<AtomicU32>().as_ref() } {
            count.fetch_add(1, Relaxed);
        }
    }
    let nothing: Option<unsafe extern "C" fn(*const clap_host)> = (!is_bare).then_some(count);
    let text = c"test".as_ptr();
    clap_host {
        clap_version: CLAP_VERSION,
        host_data: null_mut(),
        name: text,
        vendor: text,
        url: text,
        version: text,
        get_extension: if is_bare { None } else { Some(none) },
        request_restart: nothing,
        request_process: nothing,
        request_callback: nothing,
    }
}

fn factory<'a, T>(id: &CStr) -> &'a T {
    // SAFETY: tests ask for the type of the id.
    unsafe { ENTRY.get_factory.unwrap()(id.as_ptr()).cast::<T>().as_ref() }.unwrap()
}

fn create(host: &clap_host, id: &CStr) -> *const clap_plugin {
    let factory: &clap_plugin_factory = factory(CLAP_PLUGIN_FACTORY_ID);
    // SAFETY: the host outlives the plugin.
    let plugin = unsafe { factory.create_plugin.unwrap()(factory, host, id.as_ptr()) };
    assert!(!plugin.is_null(), "{id:?}");
    plugin
}

fn extension<'a, T>(plugin: *const clap_plugin, id: &CStr) -> &'a T {
    // SAFETY: as in `factory`.
    unsafe { (*plugin).get_extension.unwrap()(plugin, id.as_ptr()).cast::<T>().as_ref() }.unwrap()
}

/// Destroys a plugin.
fn destroy(plugin: *const clap_plugin) {
    // SAFETY: it is not used afterwards.
    unsafe { (*plugin).destroy.unwrap()(plugin) };
}

const IDS: [&CStr; 3] = [c"org.sprung.sprung", c"org.sprung.sprung-multi", c"org.sprung.resonator"];

#[test]
fn marks_come_to_their_knobs_in_all_plugins() {
    let host = host(false);
    for id in IDS {
        let plugin = create(&host, id);
        // SAFETY: all that is passed is what CLAP says, or null.
        unsafe {
            assert!((*plugin).init.unwrap()(plugin));
            let marks: &clap_plugin_param_indication = extension(plugin, CLAP_EXT_PARAM_INDICATION);
            let old = extension(plugin, CLAP_EXT_PARAM_INDICATION_COMPAT);
            assert!(std::ptr::eq(marks, old));
            let (map, automate) = (marks.set_mapping.unwrap(), marks.set_automation.unwrap());
            let params: &clap_plugin_params = extension(plugin, CLAP_EXT_PARAMS);
            let own = Instance::of(plugin).unwrap().params.clone();
            let colour = clap_color { alpha: 255, red: 1, green: 2, blue: 3 };
            let clear = clap_color { alpha: 0, ..colour };
            let mut known = 0;
            for index in 0..params.count.unwrap()(plugin) {
                let mut info = zeroed();
                assert!(params.get_info.unwrap()(plugin, index, &mut info));
                map(plugin, info.id, true, &colour, c"Knob".as_ptr(), null());
                automate(plugin, info.id, 2, &clear);
                let name = CStr::from_ptr(info.name.as_ptr()).to_str().unwrap();
                let Some(row) = PARAMS.iter().find(|row| row.name == name) else { continue };
                let mapping = Mapping { colour: Some([1, 2, 3]), label: "Knob".into(), description: String::new() };
                let automation = Some((Automation::Playing, None));
                assert_eq!(own.mark_of(row.param as usize), Some(Mark { mapping: Some(mapping), automation }));
                map(plugin, info.id, false, null(), null(), null());
                automate(plugin, info.id, 99, null());
                assert_eq!(own.mark_of(row.param as usize), None);
                known += 1;
            }
            assert_eq!(known, PARAM_COUNT);
            // Neither plugins nor parameters that are none do harm.
            map(null(), 0, true, null(), null(), null());
            automate(null(), 0, 1, null());
            map(plugin, 12_345, true, &colour, c"\xff".as_ptr(), null());
            assert!((0..PARAM_COUNT).all(|index| own.mark_of(index).is_none()));
        }
        destroy(plugin);
    }
}

#[test]
fn null_is_refused_everywhere() {
    // SAFETY: null is what is tested; all else is as CLAP says.
    unsafe {
        assert!(ENTRY.get_factory.unwrap()(null()).is_null());
        assert!(ENTRY.get_factory.unwrap()(c"clap.no-factory".as_ptr()).is_null());
        let plugins: &clap_plugin_factory = factory(CLAP_PLUGIN_FACTORY_ID);
        let host = host(true);
        for (host, id) in [(null(), IDS[0].as_ptr()), (&raw const host, null()), (&raw const host, c"x".as_ptr())] {
            assert!(plugins.create_plugin.unwrap()(plugins, host, id).is_null());
        }
        let plugin = create(&host, IDS[0]);
        let clap = *plugin;
        assert!(clap.get_extension.unwrap()(plugin, null()).is_null());
        assert!(clap.get_extension.unwrap()(null(), CLAP_EXT_NOTE_NAME.as_ptr()).is_null());
        assert!(clap.get_extension.unwrap()(plugin, c"clap.no-extension".as_ptr()).is_null());
        clap.on_main_thread.unwrap()(null());
        clap.destroy.unwrap()(null());
        let names: &clap_plugin_note_name = extension(plugin, CLAP_EXT_NOTE_NAME);
        let mut name = zeroed();
        assert_eq!(names.count.unwrap()(null()), 0);
        let (get, loads) = (names.get.unwrap(), extension::<clap_plugin_preset_load>(plugin, CLAP_EXT_PRESET_LOAD));
        let load = loads.from_location.unwrap();
        // A host that can do nothing still has a kit loaded.
        assert!(load(plugin, 1, null(), c"Acoustic Kit".as_ptr()), "a host without any function");
        assert!(names.count.unwrap()(plugin) > 0 && get(plugin, 0, &mut name));
        assert!(!get(plugin, 0, null_mut()) && !get(null(), 0, &mut name) && !get(plugin, u32::MAX, &mut name));
        clap.on_main_thread.unwrap()(plugin);
        for kind in 0..3 {
            assert!(!load(plugin, kind, null(), null()) && !load(null(), kind, null(), null()), "kind {kind}");
        }
        let states: &clap_plugin_state_context = extension(plugin, CLAP_EXT_STATE_CONTEXT);
        for context in 0..5 {
            assert!(!states.save.unwrap()(null(), null(), context) && !states.load.unwrap()(null(), null(), context));
        }
        destroy(plugin);
        let sounds: &clap_preset_discovery_factory = factory(CLAP_PRESET_DISCOVERY_FACTORY_ID);
        assert!(std::ptr::eq(sounds, factory(CLAP_PRESET_DISCOVERY_FACTORY_ID_COMPAT)));
        let indexer: clap_preset_discovery_indexer = zeroed();
        let id = (*sounds.get_descriptor.unwrap()(sounds, 0)).id;
        let make = sounds.create.unwrap();
        assert!(sounds.get_descriptor.unwrap()(sounds, 1).is_null());
        for (indexer, id) in [(null(), id), (&raw const indexer, null()), (&raw const indexer, c"x".as_ptr())] {
            assert!(make(sounds, indexer, id).is_null());
        }
        let provider = make(sounds, &indexer, id);
        let get = (*provider).get_metadata.unwrap();
        assert!(
            !(*provider).init.unwrap()(null()) && !(*provider).init.unwrap()(provider),
            "an indexer that takes none"
        );
        let receiver: clap_preset_discovery_metadata_receiver = zeroed();
        assert!(!get(provider, 1, null(), null()));
        assert!(get(provider, 1, null(), &receiver), "a receiver that takes none");
        assert!(!get(provider, 0, null(), &receiver) && !get(provider, 7, null(), &receiver));
        (*provider).destroy.unwrap()(null());
        (*provider).destroy.unwrap()(provider);
    }
}

#[test]
fn the_host_is_asked_when_names_change_and_never_after_the_instance() {
    let asked = AtomicU32::new(0);
    let host = Box::new(clap_host { host_data: (&raw const asked).cast_mut().cast(), ..host(false) });
    let plugin = create(&host, IDS[0]);
    // SAFETY: the plugin lives.
    let params = unsafe { Instance::of(plugin) }.unwrap().params.clone();
    let load = |name: &str| params.load_for_host(Playable::find(name).unwrap());
    for (name, times) in [("Acoustic Kit", 1), ("Acoustic Kit", 1), ("Kick", 2), ("Snare", 2), ("Brush Kit", 3)] {
        load(name);
        assert_eq!(asked.load(Relaxed), times, "names change with {name}, or not");
    }
    assert!(params.callback().take_new_names() && !params.callback().take_new_names());
    destroy(plugin);
    drop(host);
    load("Acoustic Kit");
    assert_eq!(asked.load(Relaxed), 3);
}

/// What a host is told of a parameter: the type of the event, its frame and, of values, the value.
type Told = Vec<(u16, u32, Option<f64>)>;

/// Plays a block with movements of controller 21, each with its frame. Returns what the host is told of a parameter.
fn turn(plugin: *const clap_plugin, movements: &[(u32, u8)], param: u32) -> Told {
    unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
        // SAFETY: the list's context are the events below.
        unsafe { (*(*list).ctx.cast::<Vec<clap_event_midi>>()).len() as u32 }
    }
    unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
        // SAFETY: as above.
        unsafe { &raw const (&(*(*list).ctx.cast::<Vec<clap_event_midi>>()))[index as usize].header }
    }
    unsafe extern "C" fn try_push(list: *const clap_output_events, event: *const clap_event_header) -> bool {
        // SAFETY: the list's context is `told` below, and events have the structures of their types.
        unsafe {
            let (param, told) = &mut *(*list).ctx.cast::<(u32, Told)>();
            let value = match (*event).type_ {
                CLAP_EVENT_PARAM_VALUE => {
                    let event: &clap_event_param_value = &*event.cast();
                    (event.param_id == *param).then_some(Some(event.value))
                }
                CLAP_EVENT_PARAM_GESTURE_BEGIN | CLAP_EVENT_PARAM_GESTURE_END => {
                    ((*event.cast::<clap_event_param_gesture>()).param_id == *param).then_some(None)
                }
                _ => None,
            };
            told.extend(value.map(|value| ((*event).type_, (*event).time, value)));
            true
        }
    }
    let midi = |&(time, position): &(u32, u8)| clap_event_midi {
        header: clap_event_header {
            size: size_of::<clap_event_midi>() as u32,
            time,
            space_id: CLAP_CORE_EVENT_SPACE_ID,
            type_: CLAP_EVENT_MIDI,
            flags: 0,
        },
        port_index: 0,
        data: [0xB3, 21, position],
    };
    let mut events: Vec<_> = movements.iter().map(midi).collect();
    let mut told: (u32, Told) = (param, Vec::new());
    let mut sound = [[0.0_f32; 64]; 2];
    let [left, right] = &mut sound;
    let mut channels = [left.as_mut_ptr(), right.as_mut_ptr()];
    // SAFETY: all that is passed is what CLAP says, and lives during the call.
    unsafe {
        let in_events = clap_input_events { ctx: (&raw mut events).cast(), size: Some(size), get: Some(get) };
        let out_events = clap_output_events { ctx: (&raw mut told).cast(), try_push: Some(try_push) };
        let mut output = clap_audio_buffer { data32: channels.as_mut_ptr(), channel_count: 2, ..zeroed() };
        let block = clap_process {
            frames_count: 64,
            audio_outputs: &raw mut output,
            audio_outputs_count: 1,
            in_events: &raw const in_events,
            out_events: &raw const out_events,
            ..zeroed()
        };
        assert_ne!((*plugin).process.unwrap()(plugin, &block), CLAP_PROCESS_ERROR);
    }
    told.1
}

#[test]
fn a_bound_controller_turns_its_knob_and_the_host_is_told_but_nothing_jumps() {
    let host = host(false);
    let plugin = create(&host, IDS[0]);
    // SAFETY: all that is passed is what CLAP says.
    let params = unsafe {
        assert!((*plugin).init.unwrap()(plugin));
        assert!((*plugin).activate.unwrap()(plugin, 48_000.0, 1, 64) && (*plugin).start_processing.unwrap()(plugin));
        Instance::of(plugin).unwrap().params.clone()
    };
    let told = |time: u32, value: f64| {
        [
            (CLAP_EVENT_PARAM_GESTURE_BEGIN, None),
            (CLAP_EVENT_PARAM_VALUE, Some(value)),
            (CLAP_EVENT_PARAM_GESTURE_END, None),
        ]
        .map(|(kind, value)| (kind, time, value))
        .to_vec()
    };
    let at = |position: u8| f32::from(position) / 127.0;
    let (tilt, mode) = (&params.knobs()[Param::Tilt as usize], &params.knobs()[Param::Mode as usize]);
    tilt.turn(0.5);
    params.learned().publish(&Controllers::from([(21, Param::Tilt)]));
    assert_eq!(turn(plugin, &[(0, 10), (20, 40)], number("tilt")), []);
    assert_eq!(tilt.position(), 0.5, "it is not there yet");
    let expected = [told(0, at(70).into()), told(7, at(100).into()), told(7, at(99).into())].concat();
    assert_eq!(turn(plugin, &[(0, 70), (7, 100), (7, 99)], number("tilt")), expected, "once, at their frames");
    assert_eq!(tilt.position(), at(99));
    tilt.turn(0.1);
    assert_eq!(turn(plugin, &[(63, 98)], number("tilt")), [], "something else has moved it");
    params.learned().publish(&Controllers::from([(21, Param::Mode)]));
    assert_eq!(turn(plugin, &[(5, 0), (6, 127)], number("mode")), [told(5, 0.0), told(6, 2.0)].concat(), "steps");
    assert_eq!((mode.position(), tilt.position()), (1.0, 0.1));
    params.learned().listen();
    assert_eq!(turn(plugin, &[(0, 0)], number("mode")), []);
    assert_eq!(
        (params.learned().heard(), mode.position()),
        (Some(21), 1.0),
        "whoever listens hears it, and nobody else"
    );
    params.learned().stop();
    params.learned().publish(&Controllers::new());
    assert_eq!(turn(plugin, &[(0, 0)], number("mode")), [], "forgotten");
    // SAFETY: as above.
    unsafe {
        (*plugin).stop_processing.unwrap()(plugin);
        (*plugin).deactivate.unwrap()(plugin);
    }
    destroy(plugin);
}
