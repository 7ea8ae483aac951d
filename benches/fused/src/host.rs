//! A clock and the output of lines: the system's, or JavaScript's around WebAssembly.

/// Seconds since some moment.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn now() -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_secs_f64()
}

/// Writes a line.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn print(line: &str) {
    println!("{line}");
}

#[cfg(target_family = "wasm")]
#[link(wasm_import_module = "host")]
unsafe extern "C" {
    #[link_name = "now"]
    safe fn host_now() -> f64;
    #[link_name = "print"]
    fn host_print(line: *const u8, length: usize);
}

/// Seconds since some moment.
#[cfg(target_family = "wasm")]
pub(crate) fn now() -> f64 {
    host_now() / 1000.0
}

/// Passes a line to the page or script.
#[cfg(target_family = "wasm")]
pub(crate) fn print(line: &str) {
    // SAFETY: the line stays in memory while the host reads it, and the host does not keep it.
    unsafe { host_print(line.as_ptr(), line.len()) }
}
