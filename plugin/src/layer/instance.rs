//! A plugin as hosts get it: the wrapper's, with what the layer knows beside it.

use super::host::Host;
use crate::params::SprungParams;
use clap_sys::ext::note_name::{CLAP_EXT_NOTE_NAME, clap_host_note_name};
use clap_sys::ext::params::{CLAP_EXT_PARAMS, clap_plugin_params};
use clap_sys::plugin::clap_plugin;
use sprung::internals::learned::Takeover;
use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_void};
use std::sync::Arc;

/// A plugin of the wrapper with the layer around it.
#[repr(C)]
pub(super) struct Instance {
    /// The wrapper's plugin, some of whose functions are replaced. It comes first, so that a pointer to it is one to the whole.
    pub(super) clap: clap_plugin,
    wrapper: *const clap_plugin,
    pub(super) host: Host,
    pub(super) params: Arc<SprungParams>,
    /// The wrapper's extension for parameters, one of whose functions may be replaced.
    pub(super) knobs: Option<clap_plugin_params>,
    /// Which controllers have hold of their parameters. For the audio thread alone.
    pub(super) takeover: RefCell<Takeover>,
}

impl Instance {
    /// Puts the layer around a plugin of the wrapper: hosts get what is returned. `replace` gives it other functions.
    ///
    /// # Safety
    /// The wrapper has just made the plugin, for this host, and nobody else uses it.
    pub(super) unsafe fn around(
        wrapper: *const clap_plugin,
        host: Host,
        params: Arc<SprungParams>,
        replace: impl FnOnce(&mut Self),
    ) -> *const clap_plugin {
        params.callback().connect(Box::new(move || host.ask_for_call()));
        // SAFETY: the plugin lives until it is destroyed.
        let functions = unsafe { *wrapper };
        let clap = clap_plugin { destroy: Some(destroy), on_main_thread: Some(on_main_thread), ..functions };
        let mut own = Box::new(Self { clap, wrapper, host, params, knobs: None, takeover: RefCell::default() });
        own.knobs = own.wrapper_knobs().copied();
        replace(&mut own);
        Box::into_raw(own).cast()
    }

    /// The instance of a plugin that a host has. None for null.
    ///
    /// # Safety
    /// The plugin was returned by [`Instance::around`] and is not destroyed while the result is used.
    pub(super) unsafe fn of<'a>(plugin: *const clap_plugin) -> Option<&'a Self> {
        // SAFETY: as the caller promises; `clap` is the first field.
        unsafe { plugin.cast::<Self>().as_ref() }
    }

    /// The plugin as the wrapper knows it.
    pub(super) fn wrapper(&self) -> *const clap_plugin {
        self.wrapper
    }

    /// The wrapper's extension with this id.
    pub(super) fn wrapper_extension(&self, id: *const c_char) -> *const c_void {
        // SAFETY: the wrapper's plugin lives as long as this, and the wrapper refuses null.
        unsafe { (*self.wrapper).get_extension.map_or(std::ptr::null(), |get| get(self.wrapper, id)) }
    }

    /// The wrapper's extension for parameters.
    pub(super) fn wrapper_knobs(&self) -> Option<&clap_plugin_params> {
        // SAFETY: this is the id's type.
        unsafe { self.of_wrapper(CLAP_EXT_PARAMS) }
    }

    /// The wrapper's extension with this id, if it has it.
    ///
    /// # Safety
    /// `T` is the type that CLAP has for this id.
    pub(super) unsafe fn of_wrapper<T>(&self, id: &CStr) -> Option<&T> {
        // SAFETY: extensions live as long as the plugin.
        unsafe { self.wrapper_extension(id.as_ptr()).cast::<T>().as_ref() }
    }
}

unsafe extern "C" fn destroy(plugin: *const clap_plugin) {
    if plugin.is_null() {
        return;
    }
    // SAFETY: a host destroys a plugin once, and does not use it afterwards.
    let own = unsafe { Box::from_raw(plugin.cast_mut().cast::<Instance>()) };
    // Threads that outlive the instance must not call its host.
    own.params.callback().disconnect();
    // SAFETY: as above.
    unsafe {
        if let Some(destroy) = (*own.wrapper).destroy {
            destroy(own.wrapper);
        }
    }
}

unsafe extern "C" fn on_main_thread(plugin: *const clap_plugin) {
    // SAFETY: hosts pass the plugin that they got, on the main thread.
    unsafe {
        let Some(own) = Instance::of(plugin) else { return };
        if let Some(on_main_thread) = (*own.wrapper).on_main_thread {
            on_main_thread(own.wrapper);
        }
        if own.params.callback().take_new_names()
            && let Some(extension) = own.host.extension::<clap_host_note_name>(&[CLAP_EXT_NOTE_NAME])
            && let Some(changed) = extension.changed
        {
            changed(own.host.as_ptr());
        }
    }
}
