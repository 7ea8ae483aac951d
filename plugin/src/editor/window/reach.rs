//! Scrolls what has got the focus into view, on whatever page and in whatever list it is.

use egui::accesskit::{Action, ActionRequest, TreeId};
use egui::{Event, Id, Ui};

/// What had the focus in the last pass.
#[derive(Default)]
pub(super) struct Reach(Option<Id>);

impl Reach {
    /// Asks a widget that is hidden and has got the focus to be scrolled to, as screen readers ask: each widget of egui's answers
    /// to that by itself. To be called before the widgets.
    pub(super) fn follow(&mut self, ui: &Ui) {
        let focused = ui.memory(|memory| memory.focused());
        if std::mem::replace(&mut self.0, focused) == focused {
            return;
        }
        let hidden = focused.filter(|id| {
            let widget = ui.ctx().read_response(*id);
            widget.is_some_and(|widget| !widget.interact_rect.contains_rect(widget.rect))
        });
        ui.input_mut(|input| {
            input.events.extend(hidden.map(|id| {
                let (action, target_node) = (Action::ScrollIntoView, id.accesskit_id());
                Event::AccessKitActionRequest(ActionRequest {
                    action,
                    target_tree: TreeId::ROOT,
                    target_node,
                    data: None,
                })
            }));
        });
    }
}
