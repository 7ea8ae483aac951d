//! The extensions of a plugin: those of the layer, and all others from the wrapper.

use super::indication::INDICATION;
use super::instance::Instance;
use super::note_names::NOTE_NAMES;
use super::preset_load::PRESET_LOAD;
use super::state_context::STATE_CONTEXT;
use clap_sys::ext::note_name::CLAP_EXT_NOTE_NAME;
use clap_sys::ext::param_indication::{CLAP_EXT_PARAM_INDICATION, CLAP_EXT_PARAM_INDICATION_COMPAT};
use clap_sys::ext::params::{CLAP_EXT_PARAMS, clap_plugin_params};
use clap_sys::ext::preset_load::{CLAP_EXT_PRESET_LOAD, CLAP_EXT_PRESET_LOAD_COMPAT};
use clap_sys::ext::state_context::CLAP_EXT_STATE_CONTEXT;
use clap_sys::plugin::clap_plugin;
use std::ffi::{CStr, c_char, c_void};
use std::ptr;

/// The plugin's function that returns its extensions. Null for those that neither layer nor wrapper has.
pub(super) unsafe extern "C" fn get(plugin: *const clap_plugin, id: *const c_char) -> *const c_void {
    // SAFETY: hosts pass the plugin that they got.
    let Some(own) = (unsafe { Instance::of(plugin) }) else { return ptr::null() };
    if id.is_null() {
        return ptr::null();
    }
    // SAFETY: ids end with a null.
    let name = unsafe { CStr::from_ptr(id) };
    let is = |ids: &[&CStr]| ids.contains(&name);
    if is(&[CLAP_EXT_NOTE_NAME]) {
        (&raw const NOTE_NAMES).cast()
    } else if is(&[CLAP_EXT_PRESET_LOAD, CLAP_EXT_PRESET_LOAD_COMPAT]) {
        (&raw const PRESET_LOAD).cast()
    } else if is(&[CLAP_EXT_STATE_CONTEXT]) {
        (&raw const STATE_CONTEXT).cast()
    } else if is(&[CLAP_EXT_PARAM_INDICATION, CLAP_EXT_PARAM_INDICATION_COMPAT]) {
        (&raw const INDICATION).cast()
    } else if let (true, Some(knobs)) = (is(&[CLAP_EXT_PARAMS]), &own.knobs) {
        (knobs as *const clap_plugin_params).cast()
    } else {
        own.wrapper_extension(id)
    }
}
