//! A host that carries out the window's requests and records them.

#![allow(unsafe_code, reason = "the wrapper's interface is unsafe")]

use nice_plug_core::context::PluginApi;
use nice_plug_core::context::gui::{GuiContext, GuiContextInner};
use nice_plug_core::params::internals::ParamPtr;
use nice_plug_core::plugin::PluginState;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// A message of the window about a parameter, by the parameter's name.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Call {
    Begin(String),
    Set(String, f32),
    End(String),
    Menu(String, [i32; 2]),
}

/// A host that carries out the window's requests.
#[derive(Default)]
pub(super) struct FakeHost {
    calls: Mutex<Vec<Call>>,
    /// Whether it plays the part of the standalone program.
    pub(super) is_alone: AtomicBool,
    /// Whether it has a menu for parameters.
    pub(super) has_menu: AtomicBool,
}

impl FakeHost {
    pub(super) fn context(self: &Arc<Self>) -> GuiContext {
        GuiContext::new(self.clone())
    }

    /// The messages since the last call.
    pub(super) fn calls(&self) -> Vec<Call> {
        std::mem::take(&mut self.calls.lock().unwrap())
    }

    fn record(&self, calls: Call) {
        self.calls.lock().unwrap().push(calls);
    }
}

impl GuiContextInner for FakeHost {
    fn plugin_api(&self) -> PluginApi {
        if self.is_alone.load(Relaxed) { PluginApi::Standalone } else { PluginApi::Clap }
    }

    unsafe fn raw_begin_set_parameter(&self, param: ParamPtr) {
        // SAFETY: the parameters live as long as the window.
        self.record(Call::Begin(unsafe { param.name() }.to_owned()));
    }

    unsafe fn raw_set_parameter_normalized(&self, param: ParamPtr, normalized: f32) {
        // SAFETY: as above; a host sets parameters in this way.
        unsafe { param._internal_set_normalized_value(normalized) };
        self.record(Call::Set(unsafe { param.name() }.to_owned(), normalized));
    }

    unsafe fn raw_end_set_parameter(&self, param: ParamPtr) {
        // SAFETY: as above.
        self.record(Call::End(unsafe { param.name() }.to_owned()));
    }

    fn has_host_menu(&self) -> bool {
        self.has_menu.load(Relaxed)
    }

    unsafe fn raw_show_host_menu(&self, param: ParamPtr, x: i32, y: i32) {
        // SAFETY: as above.
        self.record(Call::Menu(unsafe { param.name() }.to_owned(), [x, y]));
    }

    fn get_state(&self) -> PluginState {
        unreachable!("the window does not use it")
    }

    fn set_state(&self, _: PluginState) {
        unreachable!("the window does not use it")
    }

    fn request_restart(&self) {
        unreachable!("the window does not use it")
    }
}
