//! Buttons where there is no body to change: one makes a table of modes a body, one edits a kit's pad.

use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::kit::edit::{EDITS, take};
use crate::editor::theme::{GAP, SMALL};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::paragraph;
use egui::{Rect, Shape, Ui};
use sprung_picture::{Origin, model_name, or_suggested, suggested_body, with_article};

/// What stands in place of a body's name where there is none.
pub(crate) const NO_BODY: &str = "modes alone";
/// What comes of a body for a table of modes.
pub(crate) const TAKES: &str = "What was fixed becomes a body, to be struck elsewhere and made of anything.";
/// Widest button.
const WIDEST: f32 = 188.0;

/// Says what a table of modes lacks, and offers to put the body in its place as which it is drawn.
pub(crate) fn offer(
    ui: &Ui,
    rect: Rect,
    text: &str,
    (origin, shown): (&Origin, &Shown),
    controls: &mut Controls,
) -> Option<(Origin, String)> {
    let (deed, suggested) = suggestion(origin, shown);
    let name = suggested.body().map_or(String::new(), |body| model_name(body.model.id()));
    say(ui, rect, text, [&deed, TAKES], controls).then(|| (suggested, format!("model {name}")))
}

/// What is done to make a table of modes the body as which it is drawn, and that body; another origin stays as it is.
pub(crate) fn suggestion(origin: &Origin, shown: &Shown) -> (String, Origin) {
    let suggested = suggested_body(shown.family(), shown.tags());
    let name = with_article(&model_name(suggested.model.id()));
    (format!("Make it {name}"), or_suggested(origin, shown.family(), shown.tags()))
}

/// Says that a kit's sounds have bodies of their own, and offers to edit the pad that is shown.
pub(crate) fn offer_pad(ui: &Ui, rect: Rect, shown: &Shown, controls: &mut Controls) {
    let text = "The sounds of a kit have bodies of their own. Edit a pad to change its body.";
    let deed = format!("Edit {}", shown.sound_name());
    if say(ui, rect, text, [&deed, EDITS], controls) {
        take(shown.guide().home, controls);
    }
}

/// Shows a text with a button below it. Returns whether that is clicked.
fn say(ui: &Ui, rect: Rect, text: &str, [deed, help]: [&str; 2], controls: &mut Controls) -> bool {
    let palette = controls.palette;
    // On the stage, a room's walls are behind the text.
    let ground = ui.painter().add(Shape::Noop);
    let top = rect.top() + paragraph(ui.painter(), rect, text, SMALL, palette.muted) + GAP / 2.0;
    ui.painter().set(ground, Shape::rect_filled(rect.with_max_y(top), 0.0, palette.panel));
    let place = rect.with_min_y(top).with_max_y(top + 22.0).with_max_x(rect.right().min(rect.left() + WIDEST));
    let response = button(ui, place, deed, deed, Look::Main, palette);
    if response.hovered() {
        *controls.hint = Hint::new(deed, help);
    }
    response.clicked()
}
