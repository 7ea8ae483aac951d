//! CLAP's preset loading: a host has a sound of the factory loaded by its load key, or one of the user's by its file.

use super::c::{string, text};
use super::instance::Instance;
use super::place::Place;
use crate::files;
use clap_sys::ext::params::{CLAP_EXT_PARAMS, CLAP_PARAM_RESCAN_VALUES, clap_host_params};
use clap_sys::ext::preset_load::{
    CLAP_EXT_PRESET_LOAD, CLAP_EXT_PRESET_LOAD_COMPAT, clap_host_preset_load, clap_plugin_preset_load,
};
use clap_sys::plugin::clap_plugin;
use sprung::preset::Playable;
use std::ffi::c_char;

pub(super) static PRESET_LOAD: clap_plugin_preset_load = clap_plugin_preset_load { from_location: Some(from_location) };

/// Why a sound is not loaded: the system's number for it, or 0, and a message.
type Complaint = (i32, String);

/// Loads a sound, and tells the host that it is loaded, or why not.
unsafe extern "C" fn from_location(
    plugin: *const clap_plugin,
    kind: u32,
    location: *const c_char,
    load_key: *const c_char,
) -> bool {
    // SAFETY: hosts pass the plugin that they got and strings that end with a null, on the main thread; the ids are those of
    // the types.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return false };
        let listener: Option<&clap_host_preset_load> =
            own.host.extension(&[CLAP_EXT_PRESET_LOAD, CLAP_EXT_PRESET_LOAD_COMPAT]);
        match find(kind, location, load_key) {
            Ok(playable) => {
                own.params.load_for_host(playable);
                let knobs: Option<&clap_host_params> = own.host.extension(&[CLAP_EXT_PARAMS]);
                if let Some(rescan) = knobs.and_then(|params| params.rescan) {
                    rescan(own.host.as_ptr(), CLAP_PARAM_RESCAN_VALUES);
                }
                if let Some(loaded) = listener.and_then(|listener| listener.loaded) {
                    loaded(own.host.as_ptr(), kind, location, load_key);
                }
                true
            }
            Err((os_error, message)) => {
                if let Some(on_error) = listener.and_then(|listener| listener.on_error) {
                    let message = string(&message);
                    on_error(own.host.as_ptr(), kind, location, load_key, os_error, message.as_ptr());
                }
                false
            }
        }
    }
}

/// The sound that a host names.
///
/// # Safety
/// The strings are null or end with a null.
unsafe fn find(kind: u32, location: *const c_char, load_key: *const c_char) -> Result<Playable, Complaint> {
    let complain = |message: String| (0, message);
    // SAFETY: as the caller promises.
    let (place, key) = unsafe { (Place::of(kind, location).map_err(complain)?, text(load_key).unwrap_or_default()) };
    match (place, key) {
        (Place::Factory, "") => Err(complain("expected the name of a factory sound as the load key".to_owned())),
        (Place::Factory, name) => Playable::find(name).map_err(|error| complain(error.to_string())),
        (Place::File(path), "") => files::read(path).map_err(|error| (files::number(&error), error.to_string())),
        (Place::File(path), key) => {
            Err(complain(format!("{path}: there is no ‘{key}’ in it: a file has one sound, without a load key")))
        }
    }
}
