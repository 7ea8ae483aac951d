//! What the body is and what it is made of, each chosen by its picture.

use crate::editor::body::edit::BodyEdit;
use crate::editor::body::face;
use crate::editor::body::offer::{TAKES, offer, suggestion};
use crate::editor::body::origin::OriginShown;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, RADIUS, SMALL};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::text::line;
use egui::{Align2, Id, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use sprung::sound::bodies::{MATERIALS, Model};
use sprung_picture::play::{DISCS, MODELS};
use sprung_picture::{Figure, Origin, model_name, tint};

/// What a table of modes lacks here.
const LACKS: &str = "Modes alone, without a material or a place to strike.";

/// Columns of tiles, and of discs.
const COLUMNS: [usize; 2] = [3, 5];

/// The state of the column.
#[derive(Default)]
pub(super) struct Things {
    read: OriginShown,
    figures: Vec<Figure>,
}

impl Things {
    /// Shows the column. Returns the result of a change of the body, if there was one.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        is_tall: bool,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<Result<(), String>> {
        let origin = self.read.get(shown);
        if self.figures.is_empty() {
            self.figures = MODELS.iter().map(|(id, _)| Figure::tile(id)).collect();
        }
        let (changed, what) = if is_tall {
            self.tiles(ui, rect, &origin, shown, controls)?
        } else {
            let model = model_field(ui, rect.with_max_y(rect.top() + 22.0), &origin, controls);
            let below = rect.with_min_y(rect.top() + 28.0).with_max_y(rect.top() + 50.0);
            let now = origin.body().map(|body| body.material.id);
            let other = material_field(ui, below, now, &suggestion(&origin, shown).1, controls);
            let offers = matches!(origin, Origin::Table);
            let below = below.translate(vec2(0.0, 28.0)).with_max_y(rect.bottom());
            let made = offers.then(|| offer(ui, below, LACKS, (&origin, shown), controls)).flatten();
            model.or(other).or(made)?
        };
        Some(BodyEdit::make(&origin, changed, what, shown.loaded(), controls))
    }

    fn tiles(
        &self,
        ui: &Ui,
        rect: Rect,
        origin: &Origin,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<(Origin, String)> {
        let palette = controls.palette;
        let mut top = rect.top();
        let mut next = |height: f32| {
            let place = rect.with_min_y(top).with_max_y(top + height);
            top += height + GAP / 2.0;
            place
        };
        line(ui.painter(), next(14.0), Align2::LEFT_CENTER, "What it is", SMALL, palette.muted);
        let mut picked = None;
        let [columns, discs] = COLUMNS;
        let size = vec2((rect.width() - 8.0) / columns as f32, 52.0);
        let tiles = next(MODELS.len().div_ceil(columns) as f32 * (size.y + 4.0));
        let now = origin.body().map(|body| body.model.id());
        for (place, ((id, name), figure)) in MODELS.iter().zip(&self.figures).enumerate() {
            let offset = vec2((place % columns) as f32, (place / columns) as f32) * (size + vec2(4.0, 4.0));
            let tile = Rect::from_min_size(tiles.min + offset, size);
            let is_now = now == Some(id);
            let is_lit = is_now || origin.body().is_some_and(|body| is_kin(&body.model, id));
            let response = choice(ui, tile, ("thing", name), is_lit);
            let face = if is_lit || response.hovered() { palette.raised } else { palette.ground };
            ui.painter().rect(tile, RADIUS, face, edge(&response, is_lit, controls), StrokeKind::Inside);
            // A quarter of a pixel lower: edges on the centres of pixels are filled by some graphics drivers and not by others.
            let picture = tile.with_max_y(tile.bottom() - 15.0).shrink2(vec2(7.0, 4.0)).translate(vec2(0.0, 0.25));
            face::paint_still(ui.painter(), picture, figure, palette);
            let colour = if is_lit { palette.text } else { palette.muted };
            line(ui.painter(), tile.with_min_y(tile.bottom() - 16.0), Align2::CENTER_CENTER, name, SMALL, colour);
            if response.clicked() && !is_now {
                picked = Some((origin.with_model(false, Model::find(id)), format!("model {}", model_name(id))));
            }
        }
        picked = model_field(ui, next(20.0), origin, controls).or(picked);
        next(2.0);
        // A table of modes has no material: to choose one is to make it the body as which it is drawn.
        let (deed, suggested) = suggestion(origin, shown);
        let has_body = origin.body().is_some();
        let title = if has_body { "What it is made of" } else { "Modes alone, of no material yet" };
        line(ui.painter(), next(14.0), Align2::LEFT_CENTER, title, SMALL, palette.muted);
        if !has_body {
            let response = button(ui, next(20.0), &deed, &deed, Look::Main, palette);
            if response.hovered() {
                *controls.hint = Hint::new(&deed, "Of the material below that is clicked, or of the usual one.");
            }
            if response.clicked() {
                picked = Some((suggested.clone(), deed));
            }
        }
        let now = origin.body().map(|body| body.material.id);
        let pitch = rect.width() / discs as f32;
        let rows = next(2.0 * pitch);
        for (place, id) in DISCS.into_iter().enumerate() {
            let offset = vec2((place % discs) as f32 + 0.5, (place / discs) as f32 + 0.5) * pitch;
            let disc = Rect::from_center_size(rows.min + offset, vec2(pitch, pitch));
            let is_now = now == Some(id);
            let response = choice(ui, disc, ("material", id), is_now);
            if response.hovered() {
                *controls.hint = Hint::new(id, if now.is_some() { "Make it of this material." } else { TAKES });
            }
            let radius = 0.36 * pitch;
            ui.painter().circle(disc.center(), radius, tint(id), Stroke::new(1.0, palette.line));
            ui.painter().circle_filled(
                disc.center() - vec2(0.3, 0.3) * radius,
                0.22 * radius,
                palette.text.gamma_multiply(0.35),
            );
            if is_now || response.has_focus() {
                ui.painter().circle_stroke(disc.center(), radius + 2.5, edge(&response, is_now, controls));
            }
            if response.clicked() && !is_now {
                picked = made_of(&suggested, id).or(picked);
            }
        }
        material_field(ui, next(20.0), now, &suggested, controls).or(picked)
    }
}

/// A picture to click, which is chosen or not.
fn choice(ui: &Ui, rect: Rect, (kind, name): (&'static str, &str), is_now: bool) -> Response {
    let response = ui.interact(rect, Id::unique((kind, name)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, is_now, format!("{kind}: {name}")));
    response
}

fn edge(response: &Response, is_now: bool, controls: &Controls) -> Stroke {
    let palette = controls.palette;
    match (response.has_focus(), is_now) {
        (true, _) => Stroke::new(1.5, palette.text),
        (false, true) => Stroke::new(1.5, palette.accent),
        (false, false) => Stroke::new(1.0, palette.outline),
    }
}

/// Whether a model has no tile of its own, and that of `id` comes nearest.
fn is_kin(model: &Model, id: &str) -> bool {
    let kin = match model {
        Model::Marimba | Model::Vibraphone | Model::Xylophone | Model::Tine => "free_bar",
        Model::Timpani(_) => "membrane",
        Model::Plate { .. } | Model::Bed(_) => "free_plate",
        Model::Disc { .. } => "free_disc",
        Model::HandBell => "church_bell",
        Model::StoppedTube | Model::Cone { .. } | Model::TubularBell => "open_tube",
        _ => return false,
    };
    kin == id
}

/// The list of all models.
fn model_field(ui: &Ui, rect: Rect, origin: &Origin, controls: &Controls) -> Option<(Origin, String)> {
    let names: Vec<String> = Model::ALL.iter().map(|(id, _)| model_name(id)).collect();
    let now = origin.body().map_or("a table of modes".to_owned(), |body| model_name(body.model.id()));
    let picked = field(ui, rect, "All bodies", &now, &names, controls)?;
    let (_, model) = &Model::ALL[picked];
    Some((origin.with_model(false, Some(model)), format!("model {}", names[picked])))
}

/// The list of all materials, of which the body gets one; a table of modes has none now.
fn material_field(
    ui: &Ui,
    rect: Rect,
    now: Option<&str>,
    origin: &Origin,
    controls: &Controls,
) -> Option<(Origin, String)> {
    let now = now.map_or("choose a material".to_owned(), |id| id.replace('_', " "));
    let names: Vec<String> = MATERIALS.iter().map(|material| material.id.replace('_', " ")).collect();
    let picked = field(ui, rect, "All materials", &now, &names, controls)?;
    made_of(origin, MATERIALS[picked].id)
}

fn field(ui: &Ui, rect: Rect, name: &str, value: &str, names: &[String], controls: &Controls) -> Option<usize> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Field { id: Id::unique(name), name, value, is_default: true }.show(ui, rect, &names, controls.palette).1
}

/// The body of another material.
fn made_of(origin: &Origin, id: &str) -> Option<(Origin, String)> {
    Some((origin.of_material(id)?, format!("material {}", id.replace('_', " "))))
}
