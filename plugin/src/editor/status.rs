//! The lowest line of the window: what is under the pointer, the last message, and what the engine does.

use super::controls::Hint;
use super::text::{line, width};
use super::theme::{Palette, SMALL};
use egui::{Align2, Rect, Ui, pos2};

/// Shows the line. A message stays until the next one; a hint hides it as long as the pointer is there.
pub(super) fn show(ui: &Ui, rect: Rect, hint: Option<&Hint>, message: &str, right: &str, palette: &Palette) {
    let painter = ui.painter();
    let right_width = width(painter, right, SMALL);
    line(painter, rect, Align2::RIGHT_CENTER, right, SMALL, palette.muted);
    let left = rect.with_max_x(rect.right() - right_width - 16.0);
    match hint {
        Some(Hint { title, help }) => {
            let title = line(painter, left, Align2::LEFT_CENTER, title, SMALL, palette.text);
            let rest = Rect::from_min_max(pos2(title.right() + 10.0, left.top()), left.max);
            line(painter, rest, Align2::LEFT_CENTER, help, SMALL, palette.muted);
        }
        None => {
            line(painter, left, Align2::LEFT_CENTER, message, SMALL, palette.warning);
        }
    }
}
