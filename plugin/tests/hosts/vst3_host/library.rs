//! The open library of the bundle, with the functions that the format requires of it on each system.

#[cfg(unix)]
use libloading::os::unix as system;
#[cfg(windows)]
use libloading::os::windows as system;
use std::path::Path;
use vst3::Steinberg::IPluginFactory;

/// The function that a host calls first. On Windows it has no parameter, and ignores what it is given.
const ENTRY: &[u8] = if cfg!(windows) { b"InitDll" } else { b"ModuleEntry" };

/// The function that a host calls last.
const EXIT: &[u8] = if cfg!(windows) { b"ExitDll" } else { b"ModuleExit" };

/// The open library.
pub(super) struct Library(system::Library);

impl Library {
    pub(super) fn open(path: &Path) -> Self {
        // SAFETY: the library is our own. Its first function has this type.
        unsafe {
            let library = system::Library::new(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let handle = library.into_raw();
            let library = Self(system::Library::from_raw(handle));
            let entry = library.0.get::<extern "C" fn(_) -> bool>(ENTRY).expect("the first function");
            assert!(entry(handle));
            library
        }
    }

    /// A reference to the plugin's factory.
    pub(super) fn factory(&self) -> *mut IPluginFactory {
        // SAFETY: the library has this function with this type.
        unsafe { self.0.get::<extern "system" fn() -> *mut IPluginFactory>(b"GetPluginFactory") }.expect("it")()
    }
}

impl Drop for Library {
    fn drop(&mut self) {
        // SAFETY: the library has this function with this type, and is not used afterwards.
        assert!(unsafe { self.0.get::<extern "C" fn() -> bool>(EXIT) }.expect("the last function")());
    }
}
