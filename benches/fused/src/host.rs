//! A clock, and where lines go: the system's, or JavaScript's around WebAssembly.

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

/// Hands a line over.
#[cfg(target_family = "wasm")]
pub(crate) fn print(line: &str) {
    // SAFETY: the line lies in memory while it is read, and is not kept.
    unsafe { host_print(line.as_ptr(), line.len()) }
}
