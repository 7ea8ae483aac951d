//! Windows: where a program with a window writes its messages.
//!
//! Windows gives such a program no console, and opens none beside its window.

#![expect(unsafe_code, reason = "functions of the system")]

const ATTACH_PARENT_PROCESS: u32 = u32::MAX;
const MB_ICONERROR: u32 = 0x10;

#[link(name = "kernel32")]
unsafe extern "system" {
    safe fn AttachConsole(process: u32) -> i32;
    safe fn GetConsoleWindow() -> isize;
}

#[link(name = "user32")]
unsafe extern "system" {
    fn MessageBoxW(owner: isize, text: *const u16, caption: *const u16, kind: u32) -> i32;
}

/// Writes to the console of the shell that has started this program, if a shell did. Output that the shell sends to a file or to
/// another program still goes there.
pub(super) fn attach() {
    AttachConsole(ATTACH_PARENT_PROCESS);
}

/// Shows why the program ends where no console can: if it was started by a click.
pub(super) fn show(message: &str) {
    if GetConsoleWindow() != 0 {
        return;
    }
    let [text, caption] = [message, "Sprung"].map(|text| text.encode_utf16().chain([0]).collect::<Vec<u16>>());
    // SAFETY: both texts end with zero and live until the box is closed; no window owns the box.
    unsafe { MessageBoxW(0, text.as_ptr(), caption.as_ptr(), MB_ICONERROR) };
}
