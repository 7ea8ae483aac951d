//! The program's arguments and output: the command line and stdout, or JavaScript around WebAssembly.

/// The requested cases.
pub(crate) struct Asked {
    /// The first case, by number.
    pub(crate) first: usize,
    /// Step from one case to the next.
    pub(crate) step: usize,
    /// Seconds of each song; 0 leaves the songs out.
    pub(crate) song_seconds: usize,
}

/// Reads the command line: `FIRST STEP SONG_SECONDS`.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn asked() -> Asked {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("arguments are whole numbers"));
    let mut next = |otherwise| numbers.next().unwrap_or(otherwise);
    Asked { first: next(0), step: next(1), song_seconds: next(1000) }
}

/// Writes a line to stdout.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn print(line: &str) {
    println!("{line}");
}

#[cfg(target_family = "wasm")]
#[link(wasm_import_module = "host")]
unsafe extern "C" {
    /// An argument by number: first, step, song_seconds.
    #[link_name = "argument"]
    safe fn host_argument(number: u32) -> u32;
    /// Prints a line of UTF-8 in the module's memory.
    #[link_name = "print"]
    fn host_print(line: *const u8, length: usize);
}

/// Reads the arguments from the page or script that runs the module.
#[cfg(target_family = "wasm")]
pub(crate) fn asked() -> Asked {
    let number = |place| host_argument(place) as usize;
    Asked { first: number(0), step: number(1), song_seconds: number(2) }
}

/// Passes a line to the page or script.
#[cfg(target_family = "wasm")]
pub(crate) fn print(line: &str) {
    // SAFETY: the line stays in memory while the host reads it, and the host does not keep it.
    unsafe { host_print(line.as_ptr(), line.len()) }
}
