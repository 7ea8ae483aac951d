//! Tells screen readers what the window shows and lets them act on it: AccessKit, on Linux by AT-SPI.
//!
//! egui describes its widgets to AccessKit, but only while a screen reader listens; an egui plugin passes the
//! description on to `accesskit_unix`, which speaks AT-SPI and returns requests at the next pass. AccessKit's thread
//! never ends, and its code must not be unloaded under it: so the plugin's library marks itself as not to be unloaded
//! (`keep`) before the first window starts the thread. Without a D-Bus session there is neither thread nor
//! mark. `plugin/tests/hosts/screen_reader` reads and turns a knob and presses a button over AT-SPI, and closes the
//! library each time.

use super::keep::keep_loaded;
use super::x11::Display;
use crate::lock::lock;
use accesskit_unix::Adapter;
use egui::accesskit::{ActionHandler, ActionRequest, ActivationHandler, DeactivationHandler, Rect, TreeUpdate};
use egui::{Context, Event, FullOutput, RawInput};
use nice_plug_egui::RepaintNotifier;
use nice_plug_egui::baseview::WindowContext;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// What screen readers ask for, from the thread that talks to them.
struct Requests {
    /// Whether a screen reader listens.
    is_listening: AtomicBool,
    actions: Mutex<Vec<ActionRequest>>,
    repaint: RepaintNotifier,
}

/// The end of [`Requests`] that AccessKit's thread has.
#[derive(Clone)]
struct Listener(Arc<Requests>);

impl Listener {
    fn set_listening(&self, is_listening: bool) {
        self.0.is_listening.store(is_listening, Relaxed);
        self.0.repaint.request_repaint();
    }
}

impl ActivationHandler for Listener {
    /// The tree of widgets follows with the next pass.
    fn request_initial_tree(&mut self) -> Option<TreeUpdate> {
        self.set_listening(true);
        None
    }
}

impl DeactivationHandler for Listener {
    fn deactivate_accessibility(&mut self) {
        self.set_listening(false);
    }
}

impl ActionHandler for Listener {
    fn do_action(&mut self, request: ActionRequest) {
        lock(&self.0.actions).push(request);
        self.0.repaint.request_repaint();
    }
}

/// A window's connection to screen readers. Nothing is computed for it unless one listens.
struct Accessibility {
    adapter: Adapter,
    requests: Arc<Requests>,
    display: Display,
    is_on: bool,
    has_focus: bool,
}

/// Connects a window to screen readers, if the user's session has a bus for them.
pub(crate) fn connect(context: &Context, repaint: RepaintNotifier) {
    // AccessKit's thread never ends: its code must stay where it is.
    if !has_session_bus() || !keep_loaded() {
        return;
    }
    let requests = Arc::new(Requests { is_listening: AtomicBool::new(false), actions: Mutex::default(), repaint });
    let listener = Listener(requests.clone());
    let adapter = Adapter::new(listener.clone(), listener.clone(), listener);
    let display = Display::default();
    context.add_plugin(Accessibility { adapter, requests, display, is_on: false, has_focus: false });
}

/// Tells screen readers where the window is on the screen. To be called in each pass.
pub(crate) fn place(context: &Context, window: &WindowContext) {
    context.with_plugin(|accessibility: &mut Accessibility| {
        if accessibility.is_on
            && let Some([left, top, right, bottom]) = accessibility.display.bounds(window)
        {
            let bounds = Rect { x0: left, y0: top, x1: right, y1: bottom };
            accessibility.adapter.set_root_window_bounds(bounds, bounds);
        }
    });
}

impl egui::Plugin for Accessibility {
    fn debug_name(&self) -> &'static str {
        "accessibility"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        let is_listening = self.requests.is_listening.load(Relaxed);
        if is_listening != self.is_on {
            self.is_on = is_listening;
            if is_listening { context.enable_accesskit() } else { context.disable_accesskit() }
        }
        // The lock is not held while AccessKit is called: its thread may hold one of its own, and wait for this one.
        let actions = std::mem::take(&mut *lock(&self.requests.actions));
        input.events.extend(actions.into_iter().map(Event::AccessKitActionRequest));
        if input.focused != self.has_focus {
            self.has_focus = input.focused;
            self.adapter.update_window_focus_state(input.focused);
        }
    }

    fn output_hook(&mut self, _: &Context, output: &mut FullOutput) {
        if let Some(mut update) = output.platform_output.accesskit_update.take() {
            let root = egui::accesskit_root_id().accesskit_id();
            if let Some((_, window)) = update.nodes.iter_mut().find(|(id, _)| *id == root) {
                window.set_label("Sprung");
            }
            self.adapter.update_if_active(|| update);
        }
    }
}

/// Whether the session has a D-Bus, where AT-SPI is found: at its address or, if none is set, in the user's folder for sockets.
/// An address that is set and empty means that there is none.
fn has_session_bus() -> bool {
    let folder = || std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    std::env::var_os("DBUS_SESSION_BUS_ADDRESS")
        .map_or_else(|| folder().is_some_and(|folder| folder.join("bus").exists()), |address| !address.is_empty())
}
