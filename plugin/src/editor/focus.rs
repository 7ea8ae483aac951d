//! The keyboard belongs to the host, apart from the time in which the user types.

use nice_plug_egui::Frame;

/// Who has the keyboard. On X11 a window that has taken the focus gets every key, and cannot hand keys on to the host's
/// window: so the focus itself is handed back.
#[derive(Default)]
pub(super) struct Focus {
    #[cfg(target_os = "linux")]
    screen: Option<x11rb::rust_connection::RustConnection>,
}

impl Focus {
    /// Takes the keyboard while the user types, and gives it back to the host's window afterwards. To be called at the end
    /// of each pass, since the window takes the focus at each click.
    pub(super) fn follow(&mut self, frame: &Frame, is_typing: bool) {
        let window = frame.baseview_window();
        match (is_typing, window.has_focus()) {
            (true, false) => {
                // Without the focus nothing can be typed, but everything else works.
                let _ = window.focus();
            }
            #[cfg(target_os = "linux")]
            (false, true) => drop(self.give_back(window)),
            _ => {}
        }
    }

    /// Gives the focus to the window around this one; none if there is no other than the whole screen.
    #[cfg(target_os = "linux")]
    fn give_back(&mut self, window: &nice_plug_egui::baseview::WindowContext) -> Option<()> {
        use raw_window_handle::{HasWindowHandle as _, RawWindowHandle};
        use x11rb::CURRENT_TIME;
        use x11rb::protocol::xproto::{ConnectionExt as _, InputFocus};

        let handle = window.platform_handle();
        let id = match handle.window_handle().ok()?.as_raw() {
            RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok()?,
            RawWindowHandle::Xcb(handle) => handle.window.get(),
            _ => return None,
        };
        if self.screen.is_none() {
            self.screen = Some(x11rb::connect(None).ok()?.0);
        }
        let screen = self.screen.as_ref()?;
        // Another window may have taken it meanwhile.
        if screen.get_input_focus().ok()?.reply().ok()?.focus != id {
            return None;
        }
        let around = screen.query_tree(id).ok()?.reply().ok()?;
        if around.parent != around.root {
            screen.set_input_focus(InputFocus::PARENT, around.parent, CURRENT_TIME).ok()?.check().ok()?;
        }
        Some(())
    }
}
