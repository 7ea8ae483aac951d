//! One instance of the plugin, on the thread that created it: parameters, state, activation.

use super::calls::{Calls, Host, MainThreadCalls, PresetCall};
use super::{Timed, bundle};
use clack_extensions::params::{ParamInfoBuffer, ParamInfoFlags, PluginParams};
use clack_extensions::state::PluginState;
use clack_host::factory::plugin::PluginFactory;
use clack_host::prelude::*;
use std::ffi::{CStr, CString};
use std::sync::atomic::Ordering;

/// A parameter as the host sees it.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    pub(crate) id: ClapId,
    pub(crate) name: String,
    pub(crate) module: String,
    pub(crate) flags: ParamInfoFlags,
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) default: f64,
}

/// An instance that is not processing, or whose audio part is on another thread.
pub(crate) struct Instance {
    pub(crate) clack: PluginInstance<Host>,
}

/// Opens `Sprung.clap`.
#[allow(unsafe_code)]
pub(crate) fn open() -> PluginEntry {
    // SAFETY: the library is the one that this repository builds; its entry follows CLAP.
    unsafe { PluginEntry::load(bundle::clap()) }.unwrap_or_else(|error| panic!("{}: {error}", bundle::clap().display()))
}

impl Instance {
    /// A new instance in a host with the thread-check extension.
    pub(crate) fn new() -> Self {
        Self::of(&open(), true)
    }

    /// A new instance of Sprung Multi, the second plugin of the library.
    pub(crate) fn multi() -> Self {
        Self::at(&open(), true, 1)
    }

    /// A new instance from a library that is already open.
    pub(crate) fn of(entry: &PluginEntry, tells_threads: bool) -> Self {
        Self::at(entry, tells_threads, 0)
    }

    /// A new instance of the effect, Sprung Resonator.
    pub(crate) fn resonator(entry: &PluginEntry) -> Self {
        Self::at(entry, true, 2)
    }

    /// Instances of all plugins of the library.
    pub(crate) fn of_each(entry: &PluginEntry) -> [Self; 3] {
        [0, 1, 2].map(|index| Self::at(entry, true, index))
    }

    fn at(entry: &PluginEntry, tells_threads: bool, index: u32) -> Self {
        let factory = entry.get_factory::<PluginFactory>().expect("the file has plugins");
        let id: &CStr = factory.plugin_descriptor(index).and_then(|descriptor| descriptor.id()).expect("it has one");
        let info = HostInfo::new("Sprung's tests", "Sprung", "", env!("CARGO_PKG_VERSION")).unwrap();
        let clack = PluginInstance::<Host>::new(
            |_| Calls::new(tells_threads),
            |_| MainThreadCalls::default(),
            entry,
            id,
            &info,
        );
        Self { clack: clack.expect("the plugin can be instantiated") }
    }

    /// Makes the calls on the main thread that the plugin has requested. Fails if it requested something it never
    /// needs.
    #[track_caller]
    pub(crate) fn run_callbacks(&mut self) {
        if self.clack.access_shared_handler(|calls| calls.callback.swap(false, Ordering::Acquire)) {
            self.clack.call_on_main_thread_callback();
        }
        let restarts = self.clack.access_shared_handler(|calls| calls.restarts.load(Ordering::Relaxed));
        assert_eq!(restarts, 0, "nothing about the plugin needs a restart");
        assert_eq!(self.clack.access_handler(|calls| calls.latencies.get()), 0, "the latency does not change");
    }

    /// Number of flushes that the plugin has requested since the last call of this method.
    pub(crate) fn flushes(&self) -> u32 {
        self.clack.access_shared_handler(|calls| calls.flushes.swap(0, Ordering::Relaxed))
    }

    /// The size that the plugin has requested for its window since the last call of this method.
    pub(crate) fn requested_size(&self) -> Option<[u32; 2]> {
        self.clack.access_shared_handler(|calls| calls.resize.lock().unwrap().take())
    }

    /// From now on, the host refuses to resize its window.
    pub(crate) fn refuse_sizes(&self) {
        self.clack.access_shared_handler(|calls| calls.refuses_sizes.store(true, Ordering::Relaxed));
    }

    /// Number of rescans of parameter values that the plugin has requested since the last call of this method.
    pub(crate) fn rescans(&self) -> u32 {
        self.clack.access_handler(|calls| calls.rescans.take())
    }

    /// The parameters for which the plugin has asked for a menu since the last call of this method, and where in its window.
    pub(crate) fn menus(&self) -> Vec<(u32, [i32; 2])> {
        self.clack.access_handler(|calls| calls.menus.take())
    }

    /// How often the plugin has said that keys have other names, since the last call of this method.
    pub(crate) fn renamings(&mut self) -> u32 {
        self.run_callbacks();
        self.clack.access_handler(|calls| calls.renamings.take())
    }

    /// What the plugin has said of presets that it was to load, since the last call of this method.
    pub(crate) fn preset_calls(&self) -> Vec<PresetCall> {
        self.clack.access_handler(|calls| calls.presets.take())
    }

    /// All parameters, in the plugin's order.
    pub(crate) fn parameters(&mut self) -> Vec<Parameter> {
        let handle = self.clack.plugin_handle();
        let params: PluginParams = handle.get_extension().expect("there are parameters");
        let text = |bytes: &[u8]| std::str::from_utf8(bytes).expect("names are UTF-8").to_owned();
        let mut buffer = ParamInfoBuffer::new();
        (0..params.count(&handle))
            .map(|index| {
                let info = params.get_info(&handle, index, &mut buffer).expect("every index below the count is known");
                Parameter {
                    id: info.id,
                    name: text(info.name),
                    module: text(info.module),
                    flags: info.flags,
                    min: info.min_value,
                    max: info.max_value,
                    default: info.default_value,
                }
            })
            .collect()
    }

    /// The host's id of a parameter of the table.
    pub(crate) fn id(&mut self, param: sprung::params::Param) -> ClapId {
        let name = param.info().name;
        self.parameters().iter().find(|parameter| parameter.name == name).unwrap_or_else(|| panic!("no ‘{name}’")).id
    }

    /// The plugin's current value of a parameter.
    pub(crate) fn value(&mut self, id: ClapId) -> Option<f64> {
        let handle = self.clack.plugin_handle();
        let params: PluginParams = handle.get_extension().expect("there are parameters");
        params.get_value(&handle, id)
    }

    /// A value of a parameter as text.
    pub(crate) fn text(&mut self, id: ClapId, value: f64) -> Option<String> {
        let handle = self.clack.plugin_handle();
        let params: PluginParams = handle.get_extension().expect("there are parameters");
        let mut buffer = [0; 256];
        let text = params.value_to_text(&handle, id, value, &mut buffer).ok()?;
        Some(std::str::from_utf8(text).expect("text is UTF-8").to_owned())
    }

    /// The value that the plugin reads from typed text.
    pub(crate) fn parse(&mut self, id: ClapId, text: &str) -> Option<f64> {
        let handle = self.clack.plugin_handle();
        let params: PluginParams = handle.get_extension().expect("there are parameters");
        params.text_to_value(&handle, id, &CString::new(text).unwrap())
    }

    /// Sends parameter changes while the plugin does not process.
    pub(crate) fn flush(&mut self, events: &[Timed]) {
        let mut buffer = EventBuffer::new();
        events.iter().for_each(|timed| timed.sent.push(0, &mut buffer));
        let mut handle = self.clack.inactive_plugin_handle().expect("the plugin is not active");
        let params: PluginParams = handle.get_extension().expect("there are parameters");
        params.flush(&mut handle, &InputEvents::from_buffer(&buffer), &mut OutputEvents::void());
    }

    /// The state as the plugin saves it.
    pub(crate) fn save(&mut self) -> Vec<u8> {
        let handle = self.clack.plugin_handle();
        let state: PluginState = handle.get_extension().expect("there is state");
        let mut bytes = Vec::new();
        state.save(&handle, &mut bytes).expect("state can be saved at any time");
        bytes
    }

    /// Loads a state. Returns whether the plugin accepted it.
    pub(crate) fn load(&mut self, bytes: &[u8]) -> bool {
        let handle = self.clack.plugin_handle();
        let state: PluginState = handle.get_extension().expect("there is state");
        let taken = state.load(&handle, &mut &*bytes).is_ok();
        self.run_callbacks();
        taken
    }

    /// Loads a state through a stream that delivers only a few bytes at a time.
    pub(crate) fn load_in_pieces(&mut self, bytes: &[u8], piece: usize) -> bool {
        let handle = self.clack.plugin_handle();
        let state: PluginState = handle.get_extension().expect("there is state");
        state.load(&handle, &mut Pieces { bytes, piece }).is_ok()
    }
}

/// A reader that returns only a few bytes at a time.
struct Pieces<'a> {
    bytes: &'a [u8],
    piece: usize,
}

impl std::io::Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let len = buffer.len().min(self.piece).min(self.bytes.len());
        buffer[..len].copy_from_slice(&self.bytes[..len]);
        self.bytes = &self.bytes[len..];
        Ok(len)
    }
}
