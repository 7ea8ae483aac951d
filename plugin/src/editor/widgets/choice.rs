//! A parameter that is one of several names: a field that opens a list.

use super::knob::{self, keys, wheel};
use super::text::line;
use crate::editor::controls::Controls;
use crate::editor::routes::carry;
use crate::editor::theme::{KNOB, Palette, SMALL};
use crate::editor::widgets::knob::{face, menu};
use egui::{
    Align2, Id, Popup, Rect, Response, ScrollArea, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use sprung::params::ParamInfo;

/// Space inside a field around its text, and in a cell beside it.
pub(crate) const AROUND: f32 = 15.0;
pub(crate) const BESIDE: f32 = 3.0;

/// Shows a choice in a cell of the size of a knob's, called `name`.
pub(crate) fn show(ui: &mut Ui, cell: Rect, info: &'static ParamInfo, name: &str, controls: &mut Controls) {
    let centre = pos2(cell.center().x, cell.top() + KNOB / 2.0 + 1.0);
    let rect = Rect::from_center_size(centre, vec2(cell.width() - BESIDE, 22.0));
    let value = controls.text(info);
    let is_default = controls.value(info) == info.default;
    let field = Field { id: knob::id(info), name: info.name, value: &value, is_default };
    // In a kit, how far each pad's own choice goes on.
    let ways: Vec<String> = (0..info.choices.len()).map(|place| controls.written(info, place as f32)).collect();
    let ways: Vec<&str> = ways.iter().map(String::as_str).collect();
    let opacity = ui.opacity();
    if carry::is_closed(ui, info) {
        ui.multiply_opacity(knob::CLOSED);
    }
    let (response, picked) = field.show(ui, rect, &ways, controls.palette);
    wheel(ui, &response, info, controls);
    keys(ui, &response, info, controls);
    if let Some(place) = picked {
        controls.set(info, place as f32);
    }
    response.context_menu(|ui| menu::show(ui, info, controls));
    let (mark, said) = controls.mark(info);
    if response.hovered() {
        controls.explain(format!("{} {value}{said}", info.name), info);
    }
    face::paint_mark(ui.painter(), rect.center_bottom(), mark.as_ref(), controls.palette);
    line(ui.painter(), knob::name_rect(cell, KNOB), Align2::CENTER_CENTER, name, SMALL, controls.palette.text);
    ui.set_opacity(opacity);
}

/// A field that shows one of several names, and opens the list of them.
pub(crate) struct Field<'a> {
    pub(crate) id: Id,
    /// Its name for accessibility, also shown at the top of its list.
    pub(crate) name: &'a str,
    pub(crate) value: &'a str,
    pub(crate) is_default: bool,
}

impl Field<'_> {
    /// Shows the field. Returns the index of the name that was picked.
    pub(crate) fn show(&self, ui: &Ui, rect: Rect, names: &[&str], palette: &Palette) -> (Response, Option<usize>) {
        let Self { id, name, value, is_default } = *self;
        let response = ui.interact(rect, id, Sense::click());
        response.widget_info(|| {
            let mut about = WidgetInfo::labeled(egui::Role::ComboBox, true, name);
            about.current_text_value = Some(value.to_owned());
            about
        });
        let mut picked = None;
        // The menu of a right click already uses the default id.
        Popup::menu(&response).id(response.id.with("list")).show(|ui| {
            ui.set_min_width(110.0);
            ui.label(name);
            ScrollArea::vertical().max_height(0.85 * ui.ctx().content_rect().height()).show(ui, |ui| {
                for (place, choice) in names.iter().enumerate() {
                    if ui.selectable_label(*choice == value, *choice).clicked() {
                        picked = Some(place);
                        ui.close();
                    }
                }
            });
        });
        let outline = if response.hovered() || response.has_focus() { palette.muted } else { palette.line };
        ui.painter().rect(rect, 4.0, palette.raised, Stroke::new(1.0, outline), StrokeKind::Inside);
        let mark = pos2(rect.right() - 7.0, rect.center().y);
        let points = vec![mark + vec2(-3.0, -1.5), mark + vec2(3.0, -1.5), mark + vec2(0.0, 2.5)];
        ui.painter().add(Shape::convex_polygon(points, palette.muted, Stroke::NONE));
        let inside = Rect::from_min_max(rect.min + vec2(4.0, 0.0), rect.max - vec2(AROUND - 4.0, 0.0));
        let colour = if is_default { palette.text } else { palette.accent_text };
        line(ui.painter(), inside, Align2::LEFT_CENTER, value, SMALL, colour);
        (response, picked)
    }
}
