//! The sounds that can be put on a kit's pads: a click puts one on the chosen pad, and each can be dragged to any.

use super::pads::Carried;
use crate::editor::body::face;
use crate::editor::browser::sounds::{Category, Sounds};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::list;
use crate::editor::widgets::text::{line, name_field, paragraph, width};
use egui::{Align2, Id, Rect, Role, Sense, TextEdit, Ui, WidgetInfo, vec2};
use sprung::internals::library::Listed;
use sprung::preset::{Family, Playable};
use std::sync::Arc;

/// Height of a row, and width of the picture in it.
const ROW: f32 = 24.0;
const PICTURE: f32 = 30.0;

/// Height of the title, of the field for words, and of a chip; space inside a chip and between chips.
const TITLE: f32 = 18.0;
const FIELD: f32 = 22.0;
const CHIP: f32 = 20.0;
const INSIDE: f32 = 10.0;
const SPACE: f32 = 4.0;
/// Height of the page from which on the list has a title.
const TALL: f32 = 400.0;

/// Which sounds are listed.
#[derive(Clone, Copy, Default, PartialEq)]
enum Only {
    #[default]
    All,
    Drums,
    Metal,
    Yours,
}

impl Only {
    const ALL: [(Self, &str, &str); 4] = [
        (Self::All, "all", "All sounds"),
        (Self::Drums, "drums", "Only drums, hats, cymbals and other percussion"),
        (Self::Metal, "metal", "Only metal"),
        (Self::Yours, "yours", "Only your own sounds"),
    ];

    fn has(self, sound: &Listed) -> bool {
        use Family::{Cymbal, HandDrum, Hat, Kick, Percussion, Snare, Tom};
        let drums = [Kick, Snare, Tom, Hat, Cymbal, HandDrum, Percussion];
        match self {
            Self::All => true,
            Self::Drums => sound.family().is_some_and(|family| drums.contains(&family)),
            Self::Metal => sound.has_tag("metal"),
            Self::Yours => sound.path.is_some(),
        }
    }
}

/// The list of sounds.
#[derive(Default)]
pub(super) struct SoundList {
    words: String,
    only: Only,
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
        let title = if rect.height() >= TALL { TITLE } else { 0.0 };
        if title > 0.0 {
            let at = rect.with_max_y(rect.top() + TITLE - 4.0);
            let named = line(ui.painter(), at, Align2::LEFT_CENTER, "Sounds", TEXT, palette.text);
            let at = at.with_min_x(named.right() + SPACE);
            line(ui.painter(), at, Align2::RIGHT_CENTER, "drag onto a pad", SMALL, palette.muted);
        }
        let field = Rect::from_min_size(rect.min + vec2(0.0, title), vec2(rect.width(), FIELD));
        let clear = field.with_min_x(field.right() - field.height());
        let rest = if self.words.is_empty() { field } else { field.with_max_x(clear.left() - 4.0) };
        let edit = TextEdit::singleline(&mut self.words).id(Id::unique("kit sounds")).hint_text("Sounds for pads");
        let response = ui.put(rest, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
        name_field(&response, "Search for sounds", &self.words);
        if rest != field && button(ui, clear, "×", "Clear the search for sounds", Look::Plain, palette).clicked() {
            self.words.clear();
            response.request_focus();
        }
        let chips = self.chips(ui, rect.with_min_y(field.bottom() + SPACE), controls);
        let only = self.only;
        let is_meant = |sound: &Listed| matches!(sound.playable, Playable::Preset(_)) && only.has(sound);
        let mut found = sounds.find(Category::All, &self.words, &[]);
        found.retain(|sound| is_meant(sound));
        let mut below = rect.with_min_y(chips + SPACE);
        if found.is_empty() && only == Only::Yours && self.words.is_empty() {
            paragraph(ui.painter(), below, Category::Own.invitation(), SMALL, palette.muted);
            return None;
        }
        if found.is_empty() {
            let (near, says) = sounds.nearest(&self.words, is_meant);
            found = near;
            below.min.y += paragraph(ui.painter(), below, says, SMALL, palette.muted) + 4.0;
        }
        let mut clicked = None;
        list::show(ui, below, "kit sounds", [rect.width(), ROW], found.len(), |ui, place, cell| {
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

    /// Shows the chips that choose which sounds are listed, in as many rows as they need. Returns where these end.
    fn chips(&mut self, ui: &Ui, rect: Rect, controls: &mut Controls) -> f32 {
        let mut corner = rect.min;
        for (only, text, help) in Only::ALL {
            let size = vec2(width(ui.painter(), text, TEXT).ceil() + INSIDE, CHIP);
            if corner.x + size.x > rect.right() {
                corner = egui::pos2(rect.left(), corner.y + CHIP + SPACE);
            }
            let look = if only == self.only { Look::On } else { Look::Off };
            let response = button(ui, Rect::from_min_size(corner, size), text, help, look, controls.palette);
            if response.hovered() {
                *controls.hint = Hint::new(text, help);
            }
            if response.clicked() {
                self.only = only;
            }
            corner.x += size.x + SPACE;
        }
        corner.y + CHIP
    }
}
