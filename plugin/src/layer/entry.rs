//! The library's entry for CLAP hosts, and its plugins.

use super::discovery::DISCOVERY;
use super::extensions;
use super::host::Host;
use super::input;
use super::instance::Instance;
use super::modulation;
use super::published::published;
use crate::multi::SprungMulti;
use crate::plugin::Sprung;
use crate::resonator::Resonator;
use clap_sys::entry::clap_plugin_entry;
use clap_sys::factory::plugin_factory::{CLAP_PLUGIN_FACTORY_ID, clap_plugin_factory};
use clap_sys::factory::preset_discovery::{CLAP_PRESET_DISCOVERY_FACTORY_ID, CLAP_PRESET_DISCOVERY_FACTORY_ID_COMPAT};
use clap_sys::host::clap_host;
use clap_sys::plugin::{clap_plugin, clap_plugin_descriptor};
use clap_sys::version::CLAP_VERSION;
use nice_plug::prelude::ClapPlugin;
use nice_plug::wrapper::clap::{PluginDescriptor, Wrapper};
use nice_plug::wrapper::setup_logger;
use std::ffi::{CStr, c_char, c_void};
use std::ptr;
use std::sync::{Arc, OnceLock};

/// What hosts find in the library.
pub(crate) const ENTRY: clap_plugin_entry = clap_plugin_entry {
    clap_version: CLAP_VERSION,
    init: Some(init),
    deinit: Some(deinit),
    get_factory: Some(get_factory),
};

static FACTORY: clap_plugin_factory = clap_plugin_factory {
    get_plugin_count: Some(count),
    get_plugin_descriptor: Some(get_descriptor),
    create_plugin: Some(create),
};

/// A plugin of the library.
struct Kind {
    descriptor: PluginDescriptor,
    /// Makes one for a host, which is not null.
    make: unsafe fn(*const clap_host) -> *const clap_plugin,
}

impl Kind {
    fn of<P: ClapPlugin>() -> Self {
        Self { descriptor: PluginDescriptor::for_plugin::<P>(), make: make::<P> }
    }
}

/// The plugins in the order in which hosts list them.
fn kinds() -> &'static [Kind; 3] {
    static KINDS: OnceLock<[Kind; 3]> = OnceLock::new();
    KINDS.get_or_init(|| [Kind::of::<Sprung>(), Kind::of::<SprungMulti>(), Kind::of::<Resonator>()])
}

/// Makes a plugin of the wrapper.
///
/// # Safety
/// The host follows CLAP and outlives the plugin.
unsafe fn make<P: ClapPlugin>(host: *const clap_host) -> *const clap_plugin {
    // SAFETY: as the caller promises. The wrapper's `destroy` takes the reference back that is given away here.
    unsafe { (*Arc::into_raw(Wrapper::<P>::new(host))).clap_plugin.as_ptr() }
}

extern "C" fn init(_: *const c_char) -> bool {
    setup_logger::<Sprung>();
    setup_logger::<SprungMulti>();
    setup_logger::<Resonator>();
    true
}

extern "C" fn deinit() {}

unsafe extern "C" fn get_factory(id: *const c_char) -> *const c_void {
    if id.is_null() {
        return ptr::null();
    }
    // SAFETY: ids end with a null.
    let id = unsafe { CStr::from_ptr(id) };
    if id == CLAP_PLUGIN_FACTORY_ID {
        (&raw const FACTORY).cast()
    } else if [CLAP_PRESET_DISCOVERY_FACTORY_ID, CLAP_PRESET_DISCOVERY_FACTORY_ID_COMPAT].contains(&id) {
        (&raw const DISCOVERY).cast()
    } else {
        ptr::null()
    }
}

unsafe extern "C" fn count(_: *const clap_plugin_factory) -> u32 {
    kinds().len() as u32
}

unsafe extern "C" fn get_descriptor(_: *const clap_plugin_factory, index: u32) -> *const clap_plugin_descriptor {
    kinds().get(index as usize).map_or(ptr::null(), |kind| kind.descriptor.clap_plugin_descriptor())
}

unsafe extern "C" fn create(
    _: *const clap_plugin_factory,
    host: *const clap_host,
    id: *const c_char,
) -> *const clap_plugin {
    // SAFETY: hosts pass themselves, who outlive their plugins, and an id that ends with a null; null is refused.
    unsafe {
        let Some(of) = Host::new(host).filter(|_| !id.is_null()) else { return ptr::null() };
        let Some(kind) = kinds().iter().find(|kind| kind.descriptor.clap_id() == CStr::from_ptr(id)) else {
            return ptr::null();
        };
        match published(|| (kind.make)(host)) {
            (plugin, Some(params)) => Instance::around(plugin, of, params, |own| {
                own.clap.get_extension = Some(extensions::get);
                own.clap.process = Some(input::process);
                modulation::replace(own);
            }),
            (plugin, None) => plugin,
        }
    }
}
