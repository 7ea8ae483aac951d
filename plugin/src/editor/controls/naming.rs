//! Names of macros: a field in which one is typed, and its step.

use super::{Controls, Naming, Said, gestures};
use crate::editor::theme::{SMALL, font};
use crate::editor::widgets::text::{name_field, take_over};
use egui::{Align2, Frame, Id, Key, Rect, TextEdit, Ui, vec2};
use sprung::params::{Param, ParamInfo};
use sprung::patch::routes::macro_param;
use sprung::preset::Playable;

/// The longest name that is typed, in characters: more is cut off on every page.
const LONGEST: usize = 24;

/// The number of a macro, counted from 0; none for another parameter.
pub(crate) fn macro_number(info: &ParamInfo) -> Option<usize> {
    (info.param as usize).checked_sub(Param::Macro1 as usize).filter(|number| macro_param(*number).is_some())
}

/// Opens the field for the name of a macro of the loaded preset.
pub(crate) fn begin(info: &'static ParamInfo, controls: &mut Controls) {
    if let Playable::Preset(preset) = controls.params.state().playable {
        let text = preset.guide.macro_name(info.id).unwrap_or_default().to_owned();
        controls.interaction.naming = Some(Naming { info, text, is_open: false });
    }
}

/// Shows the field while the name of this macro is typed: Enter or a click elsewhere gives it, Escape keeps the old one. Returns
/// whether one is typed.
pub(crate) fn field(ui: &mut Ui, rect: Rect, info: &'static ParamInfo, controls: &mut Controls) -> bool {
    let Some(mut naming) = controls.interaction.naming.take_if(|naming| naming.info.param == info.param) else {
        return false;
    };
    let id = Id::unique(("name", info.id));
    let edit = TextEdit::singleline(&mut naming.text).id(id).font(font(SMALL)).margin(vec2(3.0, 0.0));
    ui.painter().rect_filled(rect, 3.0, controls.palette.raised);
    let edit = edit.char_limit(LONGEST).frame(Frame::NONE);
    let response = ui.put(rect, edit.align(Align2::LEFT_CENTER));
    name_field(&response, &format!("Name of {}", info.name), &naming.text);
    if response.lost_focus() {
        if !ui.input(|input| input.key_pressed(Key::Escape)) {
            controls.interaction.said = rename(info, &naming.text, controls);
        }
        return true;
    }
    if !std::mem::replace(&mut naming.is_open, true) {
        take_over(ui, id, &naming.text);
    } else if !response.has_focus() {
        // It was left by way of another page.
        return true;
    }
    controls.interaction.naming = Some(naming);
    true
}

/// Names a macro of the loaded preset, as one step; an empty name takes its name from it. Returns a message if that changes anything.
pub(crate) fn rename(info: &ParamInfo, name: &str, controls: &mut Controls) -> Option<Said> {
    let number = macro_number(info)?;
    let name: String = name.trim().chars().filter(|letter| !letter.is_control()).collect();
    controls.history.begin(controls.params);
    let mut is_other = false;
    gestures::change(controls.params, controls.host, |mut state| {
        let Playable::Preset(preset) = &mut state.playable else { return None };
        let names = &mut preset.guide.macros;
        names.resize(names.len().max(number + 1), String::new());
        is_other = std::mem::replace(&mut names[number], name.clone()) != name;
        let used = names.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
        names.truncate(used);
        is_other.then_some(state)
    });
    if !is_other {
        controls.history.cancel();
        return None;
    }
    let said = match &*name {
        "" => format!("took its name from macro {}", number + 1),
        name => format!("named macro {} {name}", number + 1),
    };
    controls.history.end(said.clone(), controls.params);
    Some(Ok(said))
}
