//! What the body is and what it is made of, each chosen by its picture.

use crate::editor::body::edit::BodyEdit;
use crate::editor::body::offer::{NO_BODY, TAKES, suggestion};
use crate::editor::body::origin::OriginShown;
use crate::editor::body::pick::{BETWEEN, Tiles, discs};
use crate::editor::controls::shown::{Shown, Subject};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::text::line;
use egui::scroll_area::ScrollBarVisibility;
use egui::{Align2, Id, Pos2, Rect, ScrollArea, Sense, Ui, UiBuilder, Vec2, vec2};
use sprung::sound::bodies::{MATERIALS, Model};
use sprung_picture::play::{DISCS, MODELS};
use sprung_picture::{Origin, model_name};

/// Columns of tiles, and of discs, where they stand in rows.
const COLUMNS: [usize; 2] = [3, 5];
/// Size of a tile, and of the place of a disc, where all are in one row that scrolls: not a whole number of them, so that one sees that
/// there are more.
const TILE: Vec2 = vec2(36.0, 42.0);
const DISC: f32 = 24.0;
/// Height of a list, and the space between parts.
const LIST: f32 = 20.0;
const SPACE: f32 = BETWEEN;

/// The state of the column.
#[derive(Default)]
pub(super) struct Things {
    read: OriginShown,
    pictures: Tiles,
    /// The sound whose body and material have been scrolled to.
    scrolled: Option<Subject>,
}

/// What is chosen: another body, and what is done to make it that.
type Picked = Option<(Origin, String)>;

impl Things {
    /// Shows the column. Returns the result of a change of the body, if there was one.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        is_tall: bool,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<Result<(), String>> {
        let origin = self.read.get(shown);
        let (changed, what) = self.parts(ui, rect, is_tall, &origin, shown, controls)?;
        Some(BodyEdit::make(&origin, changed, what, shown.loaded(), controls))
    }

    /// Shows bodies and materials: in rows with titles, or where there is less room, in one row each that scrolls.
    fn parts(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        is_tall: bool,
        origin: &Origin,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Picked {
        let palette = controls.palette;
        let mut top = rect.top();
        let mut next = |height: f32| {
            let place = rect.with_min_y(top).with_max_y(top + height);
            top += height + SPACE;
            place
        };
        let [columns, columns_of_discs] = COLUMNS;
        // A table of modes has no material: to choose one is to make it the body as which it is drawn.
        let (deed, suggested) = suggestion(origin, shown);
        let now = origin.body().map(|body| body.material.id);
        let is_new = self.scrolled.as_ref() != Some(&shown.subject());
        let mut tiles = |ui: &Ui, corner: Pos2, size: Vec2, columns: usize, controls: &mut Controls| {
            let now = (origin.body().map(|body| &body.model), is_new);
            let id = self.pictures.show_all(ui, (corner, size, columns), now, controls)?;
            Some((origin.with_model(false, Model::find(id)), format!("model {}", model_name(id))))
        };
        let help = if now.is_some() { "Make it of this material." } else { TAKES };
        let materials = |ui: &Ui, corner: Pos2, pitch: f32, columns: usize, controls: &mut Controls| {
            let id = discs(ui, (corner, Vec2::splat(pitch), columns), (now, is_new, help), controls)?;
            made_of(&suggested, id)
        };
        let mut picked = if is_tall {
            line(ui.painter(), next(14.0), Align2::LEFT_CENTER, "What it is", SMALL, palette.muted);
            let size = vec2((rect.width() - 8.0) / columns as f32, 52.0);
            let place = next(MODELS.len().div_ceil(columns) as f32 * (size.y + SPACE));
            tiles(ui, place.min, size, columns, controls)
        } else {
            let width = MODELS.len() as f32 * (TILE.x + SPACE) - SPACE;
            scrolling(ui, next(TILE.y), "bodies", width, |ui, at| tiles(ui, at, TILE, MODELS.len(), controls))
        };
        picked = model_field(ui, next(LIST), origin, controls).or(picked);
        if is_tall {
            next(2.0);
            let title = if now.is_some() { "What it is made of" } else { "What it is to be made of" };
            line(ui.painter(), next(14.0), Align2::LEFT_CENTER, title, SMALL, palette.muted);
        }
        let chosen = if is_tall {
            let pitch = rect.width() / columns_of_discs as f32;
            materials(ui, next(2.0 * pitch).min, pitch, columns_of_discs, controls)
        } else {
            let width = DISCS.len() as f32 * DISC;
            scrolling(ui, next(DISC), "materials", width, |ui, at| materials(ui, at, DISC, DISCS.len(), controls))
        };
        self.scrolled = Some(shown.subject());
        let place = next(LIST);
        if let Some(now) = now {
            return material_field(ui, place, now, origin, controls).or(chosen).or(picked);
        }
        let response = button(ui, place, &deed, &deed, Look::Main, palette);
        if response.hovered() {
            *controls.hint = Hint::new(&deed, "Of its usual material, or of the one above that is clicked.");
        }
        if response.clicked() {
            picked = Some((suggested, deed));
        }
        chosen.or(picked)
    }
}

/// Shows what is as wide as `width` in a place where it scrolls to the side.
fn scrolling(ui: &mut Ui, rect: Rect, name: &str, width: f32, show: impl FnOnce(&Ui, Pos2) -> Picked) -> Picked {
    let mut inner = ui.new_child(UiBuilder::new().id_salt(name).max_rect(rect));
    let area = ScrollArea::horizontal().id_salt(name).auto_shrink(false);
    let area = area.scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    area.show(&mut inner, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(width, rect.height()), Sense::hover());
        show(ui, area.min)
    })
    .inner
}

/// The list of all models.
fn model_field(ui: &Ui, rect: Rect, origin: &Origin, controls: &Controls) -> Picked {
    let names: Vec<String> = Model::ALL.iter().map(|(id, _)| model_name(id)).collect();
    let now = origin.body().map_or(NO_BODY.to_owned(), |body| model_name(body.model.id()));
    let picked = field(ui, rect, "All bodies", &now, &names, controls)?;
    let (_, model) = &Model::ALL[picked];
    Some((origin.with_model(false, Some(model)), format!("model {}", names[picked])))
}

/// The list of all materials, of which the body gets one.
fn material_field(ui: &Ui, rect: Rect, now: &str, origin: &Origin, controls: &Controls) -> Picked {
    let now = now.replace('_', " ");
    let names: Vec<String> = MATERIALS.iter().map(|material| material.id.replace('_', " ")).collect();
    let picked = field(ui, rect, "All materials", &now, &names, controls)?;
    made_of(origin, MATERIALS[picked].id)
}

fn field(ui: &Ui, rect: Rect, name: &str, value: &str, names: &[String], controls: &Controls) -> Option<usize> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Field { id: Id::unique(name), name, value, is_default: true }.show(ui, rect, &names, controls.palette).1
}

/// The body of another material.
fn made_of(origin: &Origin, id: &str) -> Picked {
    Some((origin.of_material(id)?, format!("material {}", id.replace('_', " "))))
}
