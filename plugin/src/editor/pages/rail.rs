//! The line of sources below the chosen part: each is dragged to a knob above it.

use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::motion::sources;
use egui::{Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};
use sprung::patch::routes::Source;

/// What is in the line: what is played, as players come by it, and what moves by itself. Macros are on Motion.
const SOURCES: [Source; 15] = [
    Source::Velocity,
    Source::Key,
    Source::Random,
    Source::Alternation,
    Source::Pressure,
    Source::Wheel,
    Source::Breath,
    Source::Expression,
    Source::Timbre,
    Source::Bend,
    Source::Lfo1,
    Source::Lfo2,
    Source::Lfo3,
    Source::Envelope1,
    Source::Envelope2,
];

/// Shows the line, which scrolls where it is too long.
pub(super) fn show(ui: &mut Ui, rect: Rect, shown: &Shown, controls: &mut Controls) {
    let mut inner = ui.new_child(UiBuilder::new().id_salt("rail").max_rect(rect));
    ScrollArea::horizontal().id_salt("rail").auto_shrink(false).show(&mut inner, |ui| {
        let width = sources::line_width(ui, &SOURCES, shown).max(rect.width());
        let (line, _) = ui.allocate_exact_size(vec2(width, rect.height()), Sense::hover());
        sources::show_line(ui, line, &SOURCES, shown, controls);
    });
}
