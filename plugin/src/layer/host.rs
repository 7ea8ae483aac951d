//! The host of an instance: its extensions, and a call on its main thread.

use clap_sys::host::clap_host;
use std::ffi::CStr;
use std::ptr::NonNull;

/// A host, which outlives the instances that it has made.
#[derive(Clone, Copy)]
pub(super) struct Host(NonNull<clap_host>);

// SAFETY: `ask_for_call` may be called on any thread; all else is called on the main thread, as its documentation says.
unsafe impl Send for Host {}

impl Host {
    /// None for null.
    ///
    /// # Safety
    /// The host follows CLAP and outlives the value.
    pub(super) unsafe fn new(host: *const clap_host) -> Option<Self> {
        NonNull::new(host.cast_mut()).map(Self)
    }

    pub(super) fn as_ptr(self) -> *const clap_host {
        self.0.as_ptr()
    }

    /// The host's extension with the first of these ids that it has. To be called on the main thread, not before `init`.
    ///
    /// # Safety
    /// `T` is the type that CLAP has for these ids.
    pub(super) unsafe fn extension<'a, T>(self, ids: &[&CStr]) -> Option<&'a T> {
        // SAFETY: the host lives, and what it returns is null or its extension, which lives as long as the host.
        unsafe {
            let get = (*self.as_ptr()).get_extension?;
            ids.iter().find_map(|id| get(self.as_ptr(), id.as_ptr()).cast::<T>().as_ref())
        }
    }

    /// Asks the host to call `on_main_thread` soon. May be called on any thread.
    pub(super) fn ask_for_call(self) {
        // SAFETY: the host lives.
        unsafe {
            if let Some(request) = (*self.as_ptr()).request_callback {
                request(self.as_ptr());
            }
        }
    }
}
