//! What moves the body, as tiles: a click lets one that is off act alone, its lamp adds it to the others.

use crate::editor::controls::{Controls, Hint};
use crate::editor::lamps::{Lamp, MOVERS};
use crate::editor::theme::{GAP, RADIUS, SMALL, TEXT};
use crate::editor::widgets::mover;
use crate::editor::widgets::text::line;
use egui::{Align2, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

/// Shows the tiles. Returns whether one was clicked.
pub(super) fn show(ui: &Ui, rect: Rect, is_tall: bool, controls: &mut Controls) -> bool {
    let palette = controls.palette;
    let top = if is_tall { 18.0 } else { 0.0 };
    if is_tall {
        let title = rect.with_max_y(rect.top() + 14.0);
        line(ui.painter(), title, Align2::LEFT_CENTER, "What moves it", SMALL, palette.muted);
    }
    let room = (rect.height() - top - 26.0) / MOVERS.len() as f32 - GAP / 2.0;
    let height = room.min(46.0);
    let mut is_clicked = false;
    for (place, mover) in MOVERS.iter().enumerate() {
        let Lamp { section: name, param, help, .. } = *mover;
        let corner = rect.min + vec2(0.0, top + place as f32 * (height + GAP / 2.0));
        let tile = Rect::from_min_size(corner, vec2(rect.width(), height));
        let is_on = mover.is_on(controls);
        let response = ui.interact(tile, Id::unique(("mover", name)), Sense::click());
        let label = if is_on { format!("Hear {name}") } else { format!("{name} alone") };
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_on, &label));
        let lamp = Rect::from_center_size(tile.right_top() + vec2(-9.0, 0.5 * height.min(20.0)), vec2(18.0, 20.0));
        // One that acts already is only heard: whoever clicks it does not mean to lose the others.
        is_clicked |= response.clicked();
        if response.clicked() && !is_on {
            act_alone(mover, controls);
        }
        let is_hovered = response.hovered();
        let edge = match (is_on, response.has_focus()) {
            (_, true) => Stroke::new(1.5, palette.text),
            (true, false) => Stroke::new(1.0, palette.accent),
            (false, false) => Stroke::new(1.0, palette.outline),
        };
        let face = if is_on || is_hovered { palette.raised } else { palette.ground };
        ui.painter().rect(tile, RADIUS, face, edge, StrokeKind::Inside);
        let colour = if is_on { palette.accent } else { palette.muted };
        let [wide, edge] = if is_tall { [36.0, 9.0] } else { [28.0, 5.0] };
        let picture = Rect::from_min_size(tile.min, vec2(wide, height)).shrink(edge);
        mover::paint(ui.painter(), picture, param, colour, palette);
        let text = if is_on || is_hovered { palette.text } else { palette.muted };
        line(ui.painter(), tile.with_min_x(tile.left() + wide + 6.0), Align2::LEFT_CENTER, name, TEXT, text);
        let is_hovered = mover.show(ui, lamp, controls).hovered() || is_hovered;
        if is_hovered {
            let deeds = if is_on { "Click: hear it. Its lamp: off." } else { "Click: it alone. Its lamp: it too." };
            *controls.hint = Hint::new(name, format!("{help} {deeds}"));
        }
    }
    is_clicked
}

/// Lets an exciter that is off act and no other, as one step that can be undone.
fn act_alone(mover: &Lamp, controls: &mut Controls) {
    let is_wanted = |other: &Lamp| other.param == mover.param;
    let changed: Vec<&Lamp> = MOVERS.iter().filter(|other| is_wanted(other) != other.is_on(controls)).collect();
    let values = changed.into_iter().flat_map(|other| other.switched(controls)).collect();
    controls.set_all(format!("{} alone", mover.section), values);
}
