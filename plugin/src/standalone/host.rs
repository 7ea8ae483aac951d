//! The window's host in the standalone program: it sets parameters at once, and records nothing.

#![allow(unsafe_code, reason = "the wrapper's interface is unsafe")]

use nice_plug_core::context::PluginApi;
use nice_plug_core::context::gui::{GuiContext, GuiContextInner};
use nice_plug_core::params::internals::ParamPtr;
use nice_plug_core::plugin::PluginState;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Stands for the missing host.
pub(super) struct Alone;

impl Alone {
    pub(super) fn context() -> GuiContext {
        GuiContext::new(Arc::new(Self))
    }
}

impl GuiContextInner for Alone {
    fn plugin_api(&self) -> PluginApi {
        PluginApi::Standalone
    }

    unsafe fn raw_begin_set_parameter(&self, _: ParamPtr) {}

    unsafe fn raw_set_parameter_normalized(&self, param: ParamPtr, normalized: f32) {
        // SAFETY: the window holds the parameters as long as it is open. The audio thread reads them before each block.
        unsafe { param._internal_set_normalized_value(normalized) };
    }

    unsafe fn raw_end_set_parameter(&self, _: ParamPtr) {}

    // The window has the state itself, and does not ask for it.
    fn get_state(&self) -> PluginState {
        PluginState { version: String::new(), params: BTreeMap::new(), fields: BTreeMap::new() }
    }

    fn set_state(&self, _: PluginState) {}

    fn request_restart(&self) {}
}
