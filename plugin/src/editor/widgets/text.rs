//! Lines of text. A line that does not fit is drawn smaller and, if that is not enough, cut off.

use crate::editor::theme::font;
use egui::text::{CCursor, CCursorRange, LayoutJob, TextWrapping};
use egui::text_edit::TextEditState;
use egui::{Align2, Color32, Id, Key, Painter, Rect, Response, Ui, WidgetInfo};

/// Factors for the size of text that would be too wide: the first with which it fits, or else the last.
const SHRINK: [f32; 3] = [1.0, 0.9, 0.82];

/// Draws a line of text into a rectangle, aligned within it. Returns its place.
pub(crate) fn line(painter: &Painter, rect: Rect, align: Align2, text: &str, size: f32, colour: Color32) -> Rect {
    let sizes = SHRINK.map(|factor| size * factor);
    let fits = sizes.into_iter().find(|size| width(painter, text, *size) <= rect.width());
    let size = fits.unwrap_or(sizes[SHRINK.len() - 1]);
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font(size), colour);
    job.wrap = TextWrapping::truncate_at_width(rect.width());
    let galley = painter.layout_job(job);
    let place = align.align_size_within_rect(galley.size(), rect);
    painter.galley(place.min, galley, colour);
    place
}

/// The width of a line of text.
pub(crate) fn width(painter: &Painter, text: &str, size: f32) -> f32 {
    painter.layout_no_wrap(text.to_owned(), font(size), Color32::WHITE).size().x
}

/// The least width in which [`line()`] draws a text whole.
pub(crate) fn least_width(painter: &Painter, text: &str, size: f32) -> f32 {
    width(painter, text, SHRINK[SHRINK.len() - 1] * size)
}

/// The first of some texts that fits into this room, or else the last.
pub(crate) fn fitting<'a>(painter: &Painter, texts: &[&'a str], size: f32, room: f32) -> &'a str {
    let found = texts.iter().find(|text| width(painter, text, size) <= room);
    found.or(texts.last()).copied().unwrap_or_default()
}

/// Draws lines of text that are broken to the width of a rectangle, from its top. Returns their height.
pub(crate) fn paragraph(painter: &Painter, rect: Rect, text: &str, size: f32, colour: Color32) -> f32 {
    let galley = painter.layout(text.to_owned(), font(size), colour, rect.width());
    let height = galley.size().y;
    painter.with_clip_rect(rect.intersect(painter.clip_rect())).galley(rect.min, galley, colour);
    height
}

/// Whether Enter ended the typing in a text field.
pub(crate) fn is_entered(response: &Response) -> bool {
    response.lost_focus() && response.ctx.input(|input| input.key_pressed(Key::Enter))
}

/// Gives a text field the focus, with its text selected, so that what is typed replaces it.
pub(crate) fn take_over(ui: &Ui, field: Id, text: &str) {
    ui.memory_mut(|memory| memory.request_focus(field));
    let mut state = TextEditState::load(ui.ctx(), field).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    state.cursor.set_char_range(Some(CCursorRange::two(CCursor::default(), end)));
    state.store(ui.ctx(), field);
}

/// Sets the name and content of a text field for accessibility.
pub(crate) fn name_field(response: &Response, name: &str, text: &str) {
    response.widget_info(|| {
        let mut about = WidgetInfo::text_edit(true, "", text, "");
        about.label = Some(name.to_owned());
        about
    });
}
