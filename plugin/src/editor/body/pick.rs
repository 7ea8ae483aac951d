//! What a body is and what it is made of as pictures to be clicked: a tile for each kind of body, a disc for each material.

use super::face;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{RADIUS, SMALL};
use crate::editor::widgets::text::line;
use egui::style::ScrollAnimation;
use egui::{Align2, Color32, Id, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, vec2};
use sprung::sound::bodies::Model;
use sprung_picture::play::{DISCS, MODELS};
use sprung_picture::{Figure, tint};

/// Height of a tile from which on it has a name.
const NAMED: f32 = 40.0;
/// Space between tiles.
pub(crate) const BETWEEN: f32 = 4.0;

/// The figures of the tiles.
#[derive(Default)]
pub(crate) struct Tiles(Vec<Figure>);

impl Tiles {
    /// Shows all tiles from a corner on, of this size and in so many columns, as [`Tiles::show`] does each.
    pub(crate) fn show_all(
        &mut self,
        ui: &Ui,
        (corner, size, columns): (Pos2, Vec2, usize),
        now: (Option<&Model>, bool),
        controls: &mut Controls,
    ) -> Option<&'static str> {
        let mut picked = None;
        for place in 0..MODELS.len() {
            let offset = vec2((place % columns) as f32, (place / columns) as f32) * (size + Vec2::splat(BETWEEN));
            let tile = Rect::from_min_size(corner + offset, size);
            picked = self.show(ui, tile, place, now, controls).or(picked);
        }
        picked
    }

    /// Shows the tile at this place among them, lit for the model of a body, and scrolled to if that `is_new`. Returns the model's id if
    /// another is clicked.
    fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        place: usize,
        (now, is_new): (Option<&Model>, bool),
        controls: &mut Controls,
    ) -> Option<&'static str> {
        if self.0.is_empty() {
            self.0 = MODELS.iter().map(|(id, _)| Figure::tile(id)).collect();
        }
        let (palette, (id, name)) = (controls.palette, MODELS[place]);
        let is_now = now.is_some_and(|model| model.id() == id);
        let is_lit = is_now || now.is_some_and(|model| is_kin(model, id));
        let response = choice(ui, rect, ("body", name), is_lit, is_new);
        if response.hovered() {
            *controls.hint = Hint::new(name, "Make the body this.");
        }
        let face = if is_lit || response.hovered() { palette.raised } else { palette.ground };
        ui.painter().rect(rect, RADIUS, face, edge(&response, is_lit, controls), StrokeKind::Inside);
        let (below, around) =
            if rect.height() >= NAMED { (15.0, [0.13 * rect.width(), 4.0]) } else { (0.0, [4.0, 3.0]) };
        // A quarter of a pixel lower: edges on the centres of pixels are filled by some graphics drivers and not by others.
        let picture = rect.with_max_y(rect.bottom() - below).shrink2(around.into()).translate(vec2(0.0, 0.25));
        face::paint_still(ui.painter(), picture, &self.0[place], palette);
        if below > 0.0 {
            let colour = if is_lit { palette.text } else { palette.muted };
            line(ui.painter(), rect.with_min_y(rect.bottom() - 16.0), Align2::CENTER_CENTER, name, SMALL, colour);
        }
        (response.clicked() && !is_now).then_some(id)
    }
}

/// Shows the discs of all materials from a corner on, in places of this size and in so many columns, as [`disc`] does each. Returns the
/// material that is chosen.
pub(crate) fn discs(
    ui: &Ui,
    (corner, size, columns): (Pos2, Vec2, usize),
    (now, is_new, help): (Option<&str>, bool, &str),
    controls: &mut Controls,
) -> Option<&'static str> {
    let mut picked = None;
    for (place, id) in DISCS.into_iter().enumerate() {
        let offset = vec2((place % columns) as f32, (place / columns) as f32) * size;
        let at = Rect::from_min_size(corner + offset, size);
        if disc(ui, at, id, (now == Some(id), is_new, help), controls) {
            picked = Some(id);
        }
    }
    picked
}

/// Shows the disc of a material, scrolled to if it `is_now` that of the body and that `is_new`; `help` is what choosing it does. Returns
/// whether it is chosen and was not.
fn disc(ui: &Ui, rect: Rect, id: &str, (is_now, is_new, help): (bool, bool, &str), controls: &mut Controls) -> bool {
    let palette = controls.palette;
    let response = choice(ui, rect, ("material", id), is_now, is_new);
    if response.hovered() {
        *controls.hint = Hint::new(id, help);
    }
    let radius = 0.36 * rect.width().min(rect.height());
    ui.painter().circle(rect.center(), radius, tint(id), Stroke::new(1.0, palette.line));
    let light = rect.center() - vec2(0.3, 0.3) * radius;
    ui.painter().circle_filled(light, 0.22 * radius, tint(id).lerp_to_gamma(Color32::WHITE, 0.5));
    if is_now || response.has_focus() {
        ui.painter().circle_stroke(rect.center(), radius + 2.5, edge(&response, is_now, controls));
    }
    response.clicked() && !is_now
}

/// A picture to click, which is chosen or not.
fn choice(ui: &Ui, rect: Rect, (kind, name): (&'static str, &str), is_now: bool, is_new: bool) -> Response {
    let response = ui.interact(rect, Id::unique((kind, name)), Sense::click());
    // In a row that scrolls, what is chosen or has the focus is to be seen.
    if is_new && is_now || response.gained_focus() {
        ui.scroll_to_rect_animation(rect, None, ScrollAnimation::none());
    }
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
