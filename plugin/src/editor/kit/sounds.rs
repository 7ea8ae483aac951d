//! The sounds that can be put on a kit's pads: a click puts one on the chosen pad, and each can be dragged to any.

use super::pads::Carried;
use crate::editor::body::face;
use crate::editor::browser::sounds::{Category, Sounds};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::list;
use crate::editor::widgets::text::{line, name_field, paragraph};
use egui::{Align2, Id, Rect, Role, Sense, TextEdit, Ui, WidgetInfo, vec2};
use sprung::internals::library::Listed;
use sprung::preset::Playable;
use std::sync::Arc;

/// Height of a row, and width of the picture in it.
const ROW: f32 = 24.0;
const PICTURE: f32 = 30.0;

/// The list of sounds.
#[derive(Default)]
pub(super) struct SoundList {
    words: String,
}

impl SoundList {
    /// Forgets the search.
    pub(super) fn leave(&mut self) {
        self.words.clear();
    }

    /// Shows the list. Returns the sound that was clicked.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        sounds: &Sounds,
        controls: &mut Controls,
    ) -> Option<Arc<Listed>> {
        let palette = controls.palette;
        let field = rect.with_max_y(rect.top() + 22.0);
        let clear = field.with_min_x(field.right() - field.height());
        let rest = if self.words.is_empty() { field } else { field.with_max_x(clear.left() - 4.0) };
        let edit = TextEdit::singleline(&mut self.words).id(Id::unique("kit sounds")).hint_text("Sounds for pads");
        let response = ui.put(rest, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
        name_field(&response, "Search for sounds", &self.words);
        if rest != field && button(ui, clear, "×", "Clear the search for sounds", Look::Plain, palette).clicked() {
            self.words.clear();
            response.request_focus();
        }
        let is_preset = |sound: &Listed| matches!(sound.playable, Playable::Preset(_));
        let mut found = sounds.find(Category::All, &self.words, &[]);
        found.retain(|sound| is_preset(sound));
        let mut below = rect.with_min_y(field.bottom() + 6.0);
        if found.is_empty() {
            let (near, says) = sounds.nearest(&self.words, is_preset);
            found = near;
            below.min.y += paragraph(ui.painter(), below, says, SMALL, palette.muted) + 4.0;
        }
        let mut clicked = None;
        list::show(ui, below, "kit sounds", [rect.width(), ROW], (found.len(), None), |ui, place, cell| {
            let (sound, row) = (&found[place], cell.with_max_y(cell.bottom() - ui.spacing().item_spacing.y));
            let id = Id::unique(("kit sound", sound.name(), &sound.path));
            let response = ui.interact(row, id, Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, format!("Put {}", sound.name())));
            if response.hovered() || response.has_focus() {
                ui.painter().rect_filled(row, 3.0, palette.raised);
                *controls.hint = Hint::new(sound.name(), "Drag it to a pad; a click puts it on the chosen one.");
            }
            if response.clicked() {
                clicked = Some(sound.clone());
            }
            response.dnd_set_drag_payload(Carried::Sound(sound.clone()));
            let picture = row.with_max_x(row.left() + PICTURE);
            if let Some(figure) = sounds.figure(sound) {
                face::paint_still(ui.painter(), picture.shrink2(vec2(2.0, 3.0)), figure, palette);
            }
            let name = row.with_min_x(picture.right() + 4.0);
            line(ui.painter(), name, Align2::LEFT_CENTER, sound.name(), TEXT, palette.text);
        });
        clicked
    }
}
