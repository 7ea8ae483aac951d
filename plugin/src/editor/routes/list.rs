//! All routes of a sound: as sentences by source or by target, which say what moves what and how far, or as a matrix.

use super::row::{self, About, Parts, verbs};
use super::{matrix, typed};
use crate::editor::controls::Controls;
use crate::editor::theme::{GAP, PADDING, SMALL, TITLE_HEIGHT, paint_panel};
use crate::editor::widgets::buttons::tab;
use crate::editor::widgets::text;
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};
use sprung::params::ParamInfo;
use sprung::patch::Patch;
use sprung::patch::routes::{MAX_ROUTES, Route, amount_param};

/// Least and greatest height of a sentence.
const ROW: [f32; 2] = [24.0, 30.0];

/// How routes are shown.
#[derive(Clone, Copy, Default, PartialEq)]
enum View {
    #[default]
    Sentences,
    Matrix,
    Targets,
}

/// The views with the names of their tabs.
const VIEWS: [(View, &str); 3] =
    [(View::Sentences, "Sentences"), (View::Matrix, "Matrix"), (View::Targets, "By target")];

/// What a macro does, such as `raises Decay, lowers Tilt`; none for another parameter, or where it has no routes.
pub(in crate::editor) fn effects(info: &ParamInfo, patch: &Patch, controls: &Controls) -> Option<String> {
    let own = patch.routes.iter().filter(|(_, route)| route.source.id() == info.id);
    let effect = |(place, route): (usize, Route)| {
        let amount = controls.heard(amount_param(place).info());
        format!("{} {}", verbs(&route, amount)[0], route.destination.info().name)
    };
    let all: Vec<String> = own.map(effect).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// The state of the list.
#[derive(Default)]
pub(in crate::editor) struct List {
    view: View,
    /// What is being typed as a new route.
    typed: String,
}

impl List {
    /// Shows all routes in a view, and a place to add one. Only those of a preset can be changed: a kit's sounds have routes of their own.
    pub(in crate::editor) fn show(&mut self, ui: &mut Ui, rect: Rect, about: About, controls: &mut Controls) {
        let (patch, _, is_editable) = about;
        let palette = controls.palette;
        paint_panel(ui.painter(), rect, palette);
        let inner = rect.shrink2(vec2(PADDING, 0.0));
        let title = Rect::from_min_size(inner.min + vec2(0.0, 2.0), vec2(inner.width(), TITLE_HEIGHT - 2.0));
        // The button of the manual is at the right end.
        let mut right = title.right() - TITLE_HEIGHT;
        for (this, name) in VIEWS.into_iter().rev() {
            let width = text::width(ui.painter(), name, SMALL + 1.0) + 2.0 * GAP;
            let place = title.with_max_x(right).with_min_x(right - width);
            if tab(ui, place, name, self.view == this, palette).clicked() {
                self.view = this;
            }
            right = place.left();
        }
        let left = line(ui, title, "WHAT MOVES WHAT", SMALL, palette.muted) + GAP;
        let count = patch.routes.iter().count();
        let counted = format!("{count} of {MAX_ROUTES}");
        let says: &[&str] = match (is_editable, count) {
            (false, _) => &[
                "of the pad that was struck or chosen last: Edit, on Kit, to change them",
                "of the chosen pad: Edit, on Kit, to change them",
                "of the chosen pad",
            ],
            (true, 0) => &[
                "nothing yet: drag a source to a knob, or type a route below",
                "nothing yet: drag a source to a knob",
                "nothing yet",
            ],
            (true, MAX_ROUTES) => &["all sixteen routes are taken", "all are taken"],
            (true, _) => &[&counted],
        };
        let place = title.with_min_x(left).with_max_x(right - GAP);
        let says = text::fitting(ui.painter(), says, SMALL, place.width());
        line(ui, place, says, SMALL, palette.muted);
        let below = Rect::from_min_max(title.left_bottom() + vec2(0.0, 3.0), inner.max - vec2(0.0, PADDING / 2.0));
        match self.view {
            View::Matrix if count > 0 => matrix::show(ui, below, about, controls),
            _ => self.sentences(ui, below, about, controls),
        }
    }

    /// Shows routes as sentences, by their places or by their targets, and a last one that is still to be made.
    fn sentences(&mut self, ui: &mut Ui, rect: Rect, about: About, controls: &mut Controls) {
        let (patch, _, is_editable) = about;
        let by_target = self.view == View::Targets;
        let mut routes: Vec<(usize, Route)> = patch.routes.iter().collect();
        if by_target {
            routes.sort_by_key(|(_, route)| route.destination as usize);
        }
        let has_empty = is_editable && routes.len() < MAX_ROUTES;
        let rows = routes.len() + usize::from(has_empty);
        let height = (rect.height() / rows.max(1) as f32).clamp(ROW[0], ROW[1]).floor();
        let scroll_bar = if rows as f32 * height > rect.height() { 2.0 * GAP } else { 0.0 };
        let mut inner = ui.new_child(UiBuilder::new().id_salt("routes").max_rect(rect));
        // That there are more must be seen.
        inner.spacing_mut().scroll.dormant_handle_opacity = 0.6;
        ScrollArea::vertical().auto_shrink(false).show(&mut inner, |ui| {
            let size = vec2(rect.width() - scroll_bar, rows as f32 * height);
            let (area, _) = ui.allocate_exact_size(size, Sense::hover());
            let row = |order: usize| {
                let corner = area.min + vec2(0.0, order as f32 * height);
                Rect::from_min_size(corner, vec2(size.x, height - 2.0))
            };
            for (order, (place, route)) in routes.iter().enumerate() {
                let is_again = by_target && order > 0 && routes[order - 1].1.destination == route.destination;
                let parts = Parts::of(row(order), by_target);
                row::show(ui, &parts, (*place, route), about, (by_target, is_again), controls);
            }
            if has_empty {
                typed::show(ui, &Parts::of(row(routes.len()), false), &mut self.typed, about, controls);
            }
        });
    }
}

/// Writes into a rectangle. Returns where the text ends.
fn line(ui: &Ui, rect: Rect, words: &str, size: f32, colour: egui::Color32) -> f32 {
    text::line(ui.painter(), rect, Align2::LEFT_CENTER, words, size, colour);
    rect.left() + text::width(ui.painter(), words, size)
}
