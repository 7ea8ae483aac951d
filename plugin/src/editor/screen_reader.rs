//! Tells screen readers what the window shows, and does what they ask for: in the program on Linux, by AT-SPI.
//!
//! Not in a host: the library that speaks to AT-SPI has a thread that never ends, so the plugin could not be unloaded.

use accesskit_unix::Adapter;
use egui::accesskit::{ActionHandler, ActionRequest, ActivationHandler, DeactivationHandler, TreeUpdate};
use egui::{Context, Event, FullOutput, Plugin, RawInput};
use std::sync::{Arc, Mutex, PoisonError};

/// What screen readers have asked for, and not been given yet.
type Requests = Arc<Mutex<Vec<ActionRequest>>>;

/// From now on, screen readers are told what is in this context's window.
pub(super) fn attach(context: &Context) {
    let requests = Requests::default();
    let reader = || Reader { context: context.clone(), requests: requests.clone() };
    let mut adapter = Adapter::new(reader(), reader(), reader());
    adapter.update_window_focus_state(true);
    context.add_plugin(Teller { adapter, requests });
}

/// The window's side: gives trees, and takes requests.
struct Teller {
    adapter: Adapter,
    requests: Requests,
}

impl Plugin for Teller {
    fn debug_name(&self) -> &'static str {
        "screen reader"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        for event in &input.events {
            if let Event::WindowFocused(is_focused) = event {
                self.adapter.update_window_focus_state(*is_focused);
            }
        }
        let requests = std::mem::take(&mut *self.requests.lock().unwrap_or_else(PoisonError::into_inner));
        input.events.extend(requests.into_iter().map(Event::AccessKitActionRequest));
    }

    fn output_hook(&mut self, _: &Context, output: &mut FullOutput) {
        if let Some(update) = output.platform_output.accesskit_update.take() {
            self.adapter.update_if_active(|| update);
        }
    }
}

/// The screen readers' side, on the library's thread.
struct Reader {
    context: Context,
    requests: Requests,
}

impl ActivationHandler for Reader {
    /// The next pass gives the tree: none is made before somebody asks.
    fn request_initial_tree(&mut self) -> Option<TreeUpdate> {
        self.context.enable_accesskit();
        self.context.request_repaint();
        None
    }
}

impl ActionHandler for Reader {
    fn do_action(&mut self, request: ActionRequest) {
        self.requests.lock().unwrap_or_else(PoisonError::into_inner).push(request);
        self.context.request_repaint();
    }
}

impl DeactivationHandler for Reader {
    fn deactivate_accessibility(&mut self) {
        self.context.disable_accesskit();
    }
}
