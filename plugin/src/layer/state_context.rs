//! CLAP's state contexts: a state for a preset leaves out size, zoom and theme of the window, and does not bring them.
//!
//! For a duplicate and for a project, and for contexts that this version does not know, the state is that of `clap.state`:
//! nothing in it belongs to one instance alone, and each context's states can be loaded in any other.

use super::instance::Instance;
use clap_sys::ext::state::{CLAP_EXT_STATE, clap_plugin_state};
use clap_sys::ext::state_context::{CLAP_STATE_CONTEXT_FOR_PRESET, clap_plugin_state_context};
use clap_sys::plugin::clap_plugin;
use clap_sys::stream::{clap_istream, clap_ostream};

pub(super) static STATE_CONTEXT: clap_plugin_state_context =
    clap_plugin_state_context { save: Some(save), load: Some(load) };

/// Runs `work` with the wrapper's plugin and its extension for states. False if there is none.
///
/// # Safety
/// A host passes the plugin that it got, on the main thread.
unsafe fn with_state(
    plugin: *const clap_plugin,
    context: u32,
    work: impl FnOnce(*const clap_plugin, &clap_plugin_state) -> bool,
) -> bool {
    // SAFETY: as the caller promises, and this is the id's type.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return false };
        let Some(state) = own.of_wrapper::<clap_plugin_state>(CLAP_EXT_STATE) else { return false };
        own.params.for_preset(context == CLAP_STATE_CONTEXT_FOR_PRESET, || work(own.wrapper(), state))
    }
}

unsafe extern "C" fn save(plugin: *const clap_plugin, stream: *const clap_ostream, context: u32) -> bool {
    // SAFETY: hosts pass what CLAP says; the wrapper refuses a stream that is null.
    unsafe { with_state(plugin, context, |wrapper, state| state.save.is_some_and(|save| save(wrapper, stream))) }
}

unsafe extern "C" fn load(plugin: *const clap_plugin, stream: *const clap_istream, context: u32) -> bool {
    // SAFETY: as above.
    unsafe { with_state(plugin, context, |wrapper, state| state.load.is_some_and(|load| load(wrapper, stream))) }
}
