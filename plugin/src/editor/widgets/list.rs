//! Long lists: only the rows are made that can be seen or reached.

use egui::{Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};

/// Whether a row can be seen, or is just beyond the edge: Tab leads there, and then it is scrolled to.
pub(crate) fn is_near(ui: &Ui, row: Rect) -> bool {
    ui.is_rect_visible(row.expand(4.0 * row.height()))
}

/// How many cells of this width are beside each other, in as many columns as there is room for.
pub(crate) fn columns(rect: Rect, width: f32) -> usize {
    ((rect.width() / width) as usize).max(1)
}

/// Shows the cells of a list by rows, in as many columns of this width as there is room for.
pub(crate) fn show(
    ui: &mut Ui,
    rect: Rect,
    name: &'static str,
    [width, height]: [f32; 2],
    count: usize,
    mut cell: impl FnMut(&Ui, usize, Rect),
) {
    let columns = columns(rect, width);
    scrolled(ui, rect, name, count.div_ceil(columns) as f32 * height, |ui, area| {
        let size = vec2(area.width() / columns as f32, height);
        for place in 0..count {
            let corner = area.min + vec2((place % columns) as f32, (place / columns) as f32) * size;
            let at = Rect::from_min_size(corner, size);
            if is_near(ui, at) {
                cell(ui, place, at);
            }
        }
    });
}

/// Shows an area of this height, which scrolls within `rect`.
pub(crate) fn scrolled(ui: &mut Ui, rect: Rect, name: &'static str, height: f32, show: impl FnOnce(&Ui, Rect)) {
    let mut inner = ui.new_child(UiBuilder::new().id_salt(name).max_rect(rect));
    ScrollArea::vertical().id_salt(name).auto_shrink(false).show(&mut inner, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        show(ui, area);
    });
}
