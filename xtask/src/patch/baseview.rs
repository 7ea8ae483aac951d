//! The library below the wrapper's window: a window that has been closed is gone, its thread and all that it held.

use super::edit::{Edit, edit};

const EGL: &str = "src/wrappers/egl.rs";
const EVENT_LOOP: &str = "src/platform/x11/event_loop.rs";
const WINDOW_THREAD: &str = "src/platform/x11/window_thread.rs";

pub(super) const EDITS: &[Edit] = &[
    // Closing asks the window's thread to end, then to show the window, and waits for the thread only if it has answered.
    // A thread that ended first is not waited for: it takes OpenGL down beside the next window's, or while the host
    // unloads the plugin. Nor may a panic of that thread be passed on: CLAP's calls end the host then.
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
    // A loop forgets what was asked before it began. Whoever closes a window so early waits for its thread, too.
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
    // libEGL keeps something for every thread that uses it. As libglvnd 1.6 has it, what tidies that up when a thread
    // ends stays registered after the library was unloaded, which takes one of the process's 1,024 keys each time.
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
];
