//! Gives each press and release of the pointer a pass of its own.

use egui::{Context, Event, Plugin, RawInput, Ui};
use std::mem::take;

/// Events that may wait. With more, the window is too slow for passes of their own.
const MOST: usize = 32;

/// What came after a press or a release waits for the next pass. egui looks for what is under the pointer where it is at the end of a
/// pass: of a quick drag it would take what it comes to for what was pressed, and a key that is let go in the same pass would not
/// sound.
#[derive(Default)]
pub(super) struct Presses {
    later: Vec<Event>,
}

impl Plugin for Presses {
    fn debug_name(&self) -> &'static str {
        "presses"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        let mut events = take(&mut self.later);
        events.append(&mut input.events);
        let press = events.iter().position(|event| matches!(event, Event::PointerButton { .. }));
        if let Some(press) = press.filter(|_| events.len() <= MOST) {
            self.later = events.split_off(press + 1);
        }
        input.events = events;
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if !self.later.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Modifiers, PointerButton, pos2};

    #[test]
    fn a_pass_ends_with_a_press() {
        let button = |x, pressed| Event::PointerButton {
            pos: pos2(x, 0.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let moved = |x| Event::PointerMoved(pos2(x, 0.0));
        let mut presses = Presses::default();
        let mut pass = |events: &[Event]| {
            let mut input = RawInput { events: events.to_vec(), ..RawInput::default() };
            presses.input_hook(&Context::default(), &mut input);
            input.events
        };
        assert_eq!(
            pass(&[moved(1.0), button(1.0, true), moved(2.0), button(2.0, false)]),
            [moved(1.0), button(1.0, true)]
        );
        assert_eq!(pass(&[moved(3.0)]), [moved(2.0), button(2.0, false)]);
        assert_eq!(pass(&[]), [moved(3.0)]);
        assert_eq!(pass(&[]), []);
    }
}
