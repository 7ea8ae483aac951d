//! What the computer's keys ask of the window, in the program alone.

use super::header::Request;
use crate::editor::theme::ZOOMS;
use egui::{Key, Modifiers, Ui};

/// What was asked for at this zoom in per cent, if anything; `is_list` says that a list of sounds or files is open, `is_typing` that a
/// field has the keys.
pub(super) fn asked(is_list: bool, zoom: u32, is_typing: bool, ui: &Ui) -> Option<Request> {
    let larger = ZOOMS.into_iter().find(|other| *other > zoom).unwrap_or(zoom);
    let smaller = ZOOMS.into_iter().rev().find(|other| *other < zoom).unwrap_or(zoom);
    // With Shift first: a shortcut without it is also found with it.
    let shortcuts = [
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z, Request::Redo),
        (Modifiers::COMMAND, Key::Y, Request::Redo),
        (Modifiers::COMMAND, Key::Z, Request::Undo),
        (Modifiers::COMMAND, Key::Num0, Request::Zoom(100)),
        (Modifiers::COMMAND, Key::Plus, Request::Zoom(larger)),
        (Modifiers::COMMAND, Key::Equals, Request::Zoom(larger)),
        (Modifiers::COMMAND, Key::Minus, Request::Zoom(smaller)),
        (Modifiers::NONE, Key::F1, Request::Manual),
        (Modifiers::NONE, Key::Slash, Request::Browse),
    ];
    // A field that is typed into has steps of its own, and a text may have a slash.
    let is_typed = |request: &Request| is_typing && matches!(request, Request::Undo | Request::Redo | Request::Browse);
    let found = shortcuts.into_iter().find(|(modifiers, key, request)| {
        !is_typed(request) && ui.input_mut(|input| input.consume_key(*modifiers, *key))
    });
    let request = found.map(|(_, _, request)| request)?;
    let is_taken = match request {
        Request::Zoom(_) => false,
        // A list of sounds that is open is not closed by it, and a path begins with it.
        Request::Browse if is_list => true,
        // What is being dragged is no step yet: the one before, or its page, would go from under it.
        _ => ui.input(|input| input.pointer.any_down()),
    };
    (!is_taken).then_some(request)
}
