//! Edits of the library below the wrapper's window: windows are drawn and end whole, and hosts on Windows get their keys.

use super::edit::{Edit, edit};

const EGL: &str = "src/wrappers/egl.rs";
const EVENT_LOOP: &str = "src/platform/x11/event_loop.rs";
const PRESENT: &str = "src/platform/x11/present.rs";
const WIN32_HANDLE: &str = "src/wrappers/win32/window/handle.rs";
const WIN32_WINDOW: &str = "src/platform/win/window.rs";
const WINDOW_THREAD: &str = "src/platform/x11/window_thread.rs";

pub(super) const EDITS: &[Edit] = &[
    // Closing asks the event loop to stop and then sends it `Show`; it waits for the thread only if the loop answers. If the loop
    // has already stopped, the thread is not waited for, and it closes OpenGL while the next window opens, or while the host
    // unloads the plugin. A panic of that thread must not be passed on either, because in a CLAP call it ends the host.
    edit(
        WINDOW_THREAD,
        "        if let Err(e) = self.run_until_closed() {
            warn!(\"Error while closing window: {}\", e)
        }
",
        "        if let Some(thread) = self.event_loop_handle.take() {
            if thread.join().is_err() {
                warn!(\"The window's thread has panicked\")
            }
        }
",
    ),
    // An event loop loses requests made before it starts, so it also looks for a stop request when it is idle. Otherwise, closing
    // a window so early would wait for its thread for ever.
    edit(
        EVENT_LOOP,
        "    fn handle_idle(&mut self) {
",
        "    fn handle_idle(&mut self) {
        if self.shared.main_thread_shared.is_stop_host_requested() {
            self.stop_now();
            return;
        }

",
    ),
    // A window asks the screen for the moment to draw, and asks again only after an answer. It listens for answers from when it is
    // mapped. If it asked before, because the host takes longer to show it than the first timer takes, the answer was lost, and the
    // window stayed empty.
    edit(
        PRESENT,
        "    draw_now: bool,
    last_requested_serial",
        "    draw_now: bool,
    hears_answers: bool,
    last_requested_serial",
    ),
    edit(
        PRESENT,
        "Self { draw_now: false, last_requested_serial: None, last_received_present: None }",
        "Self {
            draw_now: false,
            hears_answers: false,
            last_requested_serial: None,
            last_received_present: None,
        }",
    ),
    edit(
        PRESENT,
        "    pub fn handle_window_mapped(
        &self, shared",
        "    pub fn handle_window_mapped(
        &mut self, shared",
    ),
    edit(
        PRESENT,
        "        if window.present_supported() && window.present_select_input()? {
",
        "        if window.present_supported() && window.present_select_input()? {
            self.hears_answers = true;
",
    ),
    edit(
        PRESENT,
        "        if !shared.present_notify_requested.get() {
            return Ok(());
        }
",
        "        if !shared.present_notify_requested.get() {
            return Ok(());
        }

        if window.present_supported() && !self.hears_answers {
            return Ok(());
        }
",
    ),
    // libEGL keeps data for every thread that uses it. In libglvnd 1.6, the function that frees this data when a thread
    // ends stays registered after the library was unloaded, and each time uses up one of the process's 1,024 keys.
    edit(
        EGL,
        "    _library: Library,
",
        "    // Never unloaded: threads that end may still call into it.
    _library: ManuallyDrop<Library>,
",
    ),
    edit(
        EGL,
        "EglInner { _library: library, functions }",
        "EglInner { _library: ManuallyDrop::new(library), functions }",
    ),
    edit(
        EGL,
        "use std::ffi::{c_void, CStr};
",
        "use std::ffi::{c_void, CStr};
use std::mem::ManuallyDrop;
",
    ),
    // Windows: SetFocus returns null if no window had the focus, and also if it fails. What is to tell these apart is the
    // thread's last error, which it does not always set. So the error of an earlier call was taken for a failure.
    edit(
        WIN32_HANDLE,
        "        let previous = unsafe { SetFocus(self.as_raw()) };
",
        "        // SAFETY: This function is always safe to call
        unsafe { SetLastError(0) };
        let previous = unsafe { SetFocus(self.as_raw()) };
",
    ),
    // Windows sends keys to the window that has the focus and to no other, and a click gives it to this window. What the
    // handler answers was dropped, so that the host never heard of a key that the handler had ignored, such as Space for its
    // transport. Posted, and not sent, the key goes through the host's own loop of messages, where hosts look for shortcuts.
    edit(
        WIN32_WINDOW,
        "            if let Some(event) = opt_event {
                window_bv.handle_event(Event::Keyboard(event));
            }
",
        "            if let Some(event) = opt_event {
                let status = window_bv.handle_event(Event::Keyboard(event));
                if status == EventStatus::Ignored && window.post_to_parent(msg, wparam, lparam) {
                    // If it were handled here as well, Alt+F4 would ask the host to close twice.
                    return Some(0);
                }
            }
",
    ),
    edit(
        WIN32_HANDLE,
        "    pub fn get_focused_window() -> HWND {
",
        "    /// Posts a message to the window around this one. Returns false if there is none, or if it takes no message.
    pub fn post_to_parent(&self, message: u32, wparam: WPARAM, lparam: LPARAM) -> bool {
        // SAFETY: This type guarantees the HWND is safe to use.
        let parent = unsafe { GetParent(self.as_raw()) };
        // Posted to null, a message would go to the thread.
        // SAFETY: Keyboard messages have no pointers.
        !parent.is_null() && unsafe { PostMessageW(parent, message, wparam, lparam) } != 0
    }

    pub fn get_focused_window() -> HWND {
",
    ),
    edit(WIN32_HANDLE, "    DestroyWindow, GetWindowLongPtrW,", "    DestroyWindow, GetParent, GetWindowLongPtrW,"),
];
