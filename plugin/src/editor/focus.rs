//! Keyboard focus: the host keeps it, except while the user types.

use nice_plug_egui::Frame;

/// Tracks which window has the keyboard focus. On X11 a focused window gets every key and cannot pass keys on to the
/// host, so the focus itself is given back.
#[derive(Default)]
pub(super) struct Focus {
    #[cfg(target_os = "linux")]
    x11: x11::Focus,
}

impl Focus {
    /// Takes the keyboard while the user types, and gives it back to the host afterwards. To be called at the end of each
    /// pass, since the window takes the focus at each click.
    pub(super) fn follow(&mut self, frame: &Frame, is_typing: bool, is_pressed: bool) {
        let window = frame.baseview_window();
        match (is_typing, window.has_focus()) {
            (true, false) => {
                // Without the focus nothing can be typed, but everything else works.
                let _ = window.focus();
            }
            #[cfg(target_os = "linux")]
            (false, false) => drop(self.x11.remember(window)),
            // A window that loses the focus during a drag may lose the drag.
            #[cfg(target_os = "linux")]
            (false, true) if !is_pressed => drop(self.x11.give_back(window)),
            _ => {}
        }
    }
}

#[cfg(target_os = "linux")]
mod x11 {
    use nice_plug_egui::baseview::WindowContext;
    use raw_window_handle::{HasWindowHandle as _, RawWindowHandle};
    use std::time::{Duration, Instant};
    use x11rb::CURRENT_TIME;
    use x11rb::protocol::xproto::{ConnectionExt as _, InputFocus};
    use x11rb::rust_connection::RustConnection;

    /// Shortest time between two queries of the focused window.
    const INTERVAL: Duration = Duration::from_millis(200);

    #[derive(Default)]
    pub(super) struct Focus {
        screen: Option<RustConnection>,
        /// The window that had the focus before this one.
        before: Option<u32>,
        asked: Option<Instant>,
    }

    impl Focus {
        /// Remembers which window has the focus, if it is not this one.
        pub(super) fn remember(&mut self, window: &WindowContext) -> Option<()> {
            if self.asked.is_some_and(|asked| asked.elapsed() < INTERVAL) {
                return None;
            }
            self.asked = Some(Instant::now());
            let own = id(window)?;
            let focus = self.screen()?.get_input_focus().ok()?.reply().ok()?.focus;
            // X11: 0 means no window, 1 means the window under the pointer.
            self.before = Some(focus).filter(|focus| *focus > 1 && *focus != own).or(self.before);
            Some(())
        }

        /// Gives the focus to the window that had it before or, if there is none, to this window's parent. Keys then go
        /// to that window; but X11 still sends them to this window if it is inside that one and has the pointer.
        pub(super) fn give_back(&mut self, window: &WindowContext) -> Option<()> {
            let (own, before) = (id(window)?, self.before);
            let screen = self.screen()?;
            // Another window may have taken the focus meanwhile.
            if screen.get_input_focus().ok()?.reply().ok()?.focus != own {
                return None;
            }
            let give = |to: u32| screen.set_input_focus(InputFocus::PARENT, to, CURRENT_TIME).ok()?.check().ok();
            if before.and_then(give).is_some() {
                return Some(());
            }
            let around = screen.query_tree(own).ok()?.reply().ok()?;
            if around.parent == around.root { None } else { give(around.parent) }
        }

        fn screen(&mut self) -> Option<&RustConnection> {
            if self.screen.is_none() {
                self.screen = Some(x11rb::connect(None).ok()?.0);
            }
            self.screen.as_ref()
        }
    }

    /// The window's X11 id.
    fn id(window: &WindowContext) -> Option<u32> {
        match window.platform_handle().window_handle().ok()?.as_raw() {
            RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok(),
            RawWindowHandle::Xcb(handle) => Some(handle.window.get()),
            _ => None,
        }
    }
}
