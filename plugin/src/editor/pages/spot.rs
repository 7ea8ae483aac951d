//! A part of the sound's way where it is drawn: it can be chosen by a click, and its lamp switches it.

use super::parts::{self, Part};
use crate::editor::controls::{Controls, Hint};
use crate::editor::lamps::{self, Lamp};
use crate::editor::routes::carry;
use crate::editor::theme::{RADIUS, paint_panel};
use crate::editor::widgets::{outline, text};
use egui::{Align2, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};

/// Width of the place of a lamp, left of its part's name.
pub(super) const LAMP: f32 = 16.0;

/// A part where it is drawn.
pub(super) struct Spot {
    pub(super) part: Part,
    /// Its name as it is written.
    pub(super) title: &'static str,
    pub(super) rect: Rect,
    /// The place of the name. That of the lamp is left of it.
    pub(super) name: Rect,
    pub(super) size: f32,
    /// Whether it has a face while it is not chosen.
    pub(super) is_tile: bool,
    pub(super) lamp: Option<&'static Lamp>,
}

impl Spot {
    pub(super) fn is_on(&self, controls: &Controls) -> bool {
        self.lamp.is_none_or(|lamp| lamp.is_on(controls))
    }

    /// Shows it. Returns whether it is clicked, or a source is held over it.
    pub(super) fn show(&self, ui: &Ui, is_chosen: bool, controls: &mut Controls) -> bool {
        let Self { part, rect, .. } = *self;
        let palette = controls.palette;
        let response = ui.interact(rect, Id::unique(("part", part)), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_chosen, part));
        if self.is_tile {
            paint_panel(ui.painter(), rect, palette);
        }
        if is_chosen {
            ui.painter().rect(rect, RADIUS, palette.raised, Stroke::new(1.5, palette.accent), StrokeKind::Inside);
        }
        outline(ui, &response, rect, RADIUS, palette);
        let is_on = self.is_on(controls);
        let mut is_hovered = response.hovered();
        if let Some(lamp) = self.lamp {
            let place = self.name.with_min_x(self.name.left() - LAMP).with_max_x(self.name.left());
            is_hovered |= lamp.show(ui, place, controls).hovered();
        }
        if is_hovered {
            let help = match self.lamp {
                Some(lamp) if is_on => format!("{} Its lamp switches it off.", lamp.help),
                Some(lamp) => format!("{} Its lamp switches it on.", lamp.help),
                None => lamps::of(part).map_or(parts::help(part), |lamp| lamp.help).to_owned(),
            };
            *controls.hint = Hint::new(part, help);
        }
        let colour = if is_on || is_chosen || is_hovered { palette.text } else { palette.muted };
        text::line(ui.painter(), self.name, Align2::LEFT_CENTER, self.title, self.size, colour);
        response.clicked() || !is_chosen && carry::dwells(ui, rect, controls)
    }
}
