//! Keeps the plugin's code loaded where a thread may outlive the plugin.

use std::sync::OnceLock;

/// Keeps this code loaded for as long as the process runs. Returns whether that was possible.
pub(crate) fn keep_loaded() -> bool {
    static IS_KEPT: OnceLock<bool> = OnceLock::new();
    *IS_KEPT.get_or_init(mark)
}

/// Marks the library that has this code as not to be unloaded. A program never is.
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "there is no safe way to ask the system's loader")]
fn mark() -> bool {
    use std::ffi::c_void;
    use std::ptr;
    let about = |address: *const c_void| {
        let mut about = libc::Dl_info {
            dli_fname: ptr::null(),
            dli_fbase: ptr::null_mut(),
            dli_sname: ptr::null(),
            dli_saddr: ptr::null_mut(),
        };
        // SAFETY: `about` is the loader's own structure.
        (unsafe { libc::dladdr(address, &mut about) } != 0).then_some(about)
    };
    let Some(here) = about(mark as *const c_void) else { return false };
    // SAFETY: the process's own table has no state.
    let headers = unsafe { libc::getauxval(libc::AT_PHDR) };
    if about(ptr::without_provenance(headers as usize)).is_some_and(|program| program.dli_fbase == here.dli_fbase) {
        return true;
    }
    // SAFETY: the name is valid while this library is loaded, which is not opened anew (`RTLD_NOLOAD`), so none of its
    // initialisers runs.
    unsafe { !libc::dlopen(here.dli_fname, libc::RTLD_NOW | libc::RTLD_NOLOAD | libc::RTLD_NODELETE).is_null() }
}

#[cfg(not(target_os = "linux"))]
fn mark() -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_stays_where_it_is() {
        assert_eq!(keep_loaded(), cfg!(target_os = "linux"));
    }
}
