//! Keyboard focus: the host keeps it, except while the user types.

use nice_plug_egui::Frame;

/// Tracks which window has the keyboard focus. On X11 a focused window gets every key and cannot pass keys on to the
/// host, so the focus itself is given back. On Windows the library of the window, as corrected, passes on the keys that
/// nobody types here.
#[derive(Default)]
pub(crate) struct Focus {
    #[cfg(target_os = "linux")]
    before: before::Before,
}

impl Focus {
    /// Takes the keyboard while the user types, and gives it back to the host afterwards. To be called at the end of each
    /// pass, since the window takes the focus at each click.
    pub(crate) fn follow(&mut self, frame: &Frame, is_typing: bool, is_pressed: bool) {
        let window = frame.baseview_window();
        match (is_typing, window.has_focus()) {
            (true, false) => {
                // Without the focus nothing can be typed, but everything else works.
                let _ = window.focus();
            }
            // A window that loses the focus during a drag may lose the drag.
            _ if is_pressed => {}
            #[cfg(target_os = "linux")]
            (false, false) => drop(self.before.remember(window)),
            #[cfg(target_os = "linux")]
            (false, true) => drop(self.before.give_back(window)),
            _ => {}
        }
    }
}

#[cfg(target_os = "linux")]
mod before {
    use crate::editor::host::x11::{Display, id};
    use nice_plug_egui::baseview::WindowContext;
    use std::time::{Duration, Instant};

    /// Shortest time between two queries of the focused window.
    const INTERVAL: Duration = Duration::from_millis(200);

    /// The window that had the focus before this one.
    #[derive(Default)]
    pub(super) struct Before {
        display: Display,
        window: Option<u32>,
        asked: Option<Instant>,
    }

    impl Before {
        /// Remembers which window has the focus, if it is not this one.
        pub(super) fn remember(&mut self, window: &WindowContext) -> Option<()> {
            if self.asked.is_some_and(|asked| asked.elapsed() < INTERVAL) {
                return None;
            }
            self.asked = Some(Instant::now());
            let own = id(window)?;
            let focused = self.display.focused()?;
            self.window = Some(focused).filter(|focused| *focused > 1 && *focused != own).or(self.window);
            Some(())
        }

        /// Gives the focus to the window that had it before or, if there is none, to this window's parent. Keys then go
        /// to that window; but X11 still sends them to this window if it is inside that one and has the pointer.
        pub(super) fn give_back(&mut self, window: &WindowContext) -> Option<()> {
            let own = id(window)?;
            // Another window may have taken the focus meanwhile.
            if self.display.focused()? != own {
                return None;
            }
            if let Some(before) = self.window
                && self.display.give_focus(before).is_some()
            {
                return Some(());
            }
            let parent = self.display.parent(own)?;
            self.display.give_focus(parent)
        }
    }
}
