//! The field in which a parameter's value is typed.

use super::text::{name_field, take_over};
use crate::editor::controls::{Controls, Typing};
use crate::editor::theme::{SMALL, font};
use egui::{Align2, Id, Key, Rect, TextEdit, Ui, vec2};
use sprung::params::ParamInfo;

/// Opens the field of a parameter.
pub(super) fn type_value(info: &'static ParamInfo, controls: &mut Controls) {
    let text = controls.text(info);
    let index = info.param as usize;
    controls.interaction.typing = Some(Typing { index, text, is_open: false, complaint: None });
}

/// Shows the field for a value while one is typed. Enter sets the value, Escape keeps the old one.
/// Returns whether one is typed.
pub(super) fn typed(ui: &mut Ui, rect: Rect, field: Id, info: &'static ParamInfo, controls: &mut Controls) -> bool {
    let Some(mut typing) = controls.interaction.typing.take_if(|typing| typing.index == info.param as usize) else {
        return false;
    };
    let edit = TextEdit::singleline(&mut typing.text).id(field).font(font(SMALL)).margin(vec2(2.0, 0.0));
    let place = rect.expand2(vec2(6.0, 2.0));
    ui.painter().rect_filled(place, 3.0, controls.palette.raised);
    let response = ui.put(place, edit.frame(egui::Frame::NONE).align(Align2::CENTER_CENTER));
    name_field(&response, info.name, &typing.text);
    if !typing.is_open {
        typing.is_open = true;
        take_over(ui, field, &typing.text);
    } else if response.lost_focus() {
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            return true;
        }
        match controls.read(info, &typing.text) {
            Ok(value) if value == controls.value(info) => return true,
            Ok(value) => {
                controls.set(info, value);
                return true;
            }
            // A click elsewhere closes the field, even if its text is not a value.
            Err(_) if !ui.input(|input| input.key_pressed(Key::Enter)) => return true,
            Err(complaint) => {
                typing.complaint = Some(format!("{}: {complaint}", info.name));
                response.request_focus();
            }
        }
    }
    controls.interaction.typing = Some(typing);
    true
}
