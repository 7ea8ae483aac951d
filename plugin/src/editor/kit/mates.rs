//! The other pads of the chosen one's choke group, as little pictures with names.

use super::live::About;
use crate::editor::body::face;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::outline;
use crate::editor::widgets::text::line;
use egui::{Align2, Id, Rect, Role, Sense, Ui, WidgetInfo, vec2};
use sprung::params::Param;

/// The least width of a pad, and that of its picture.
const LEAST: f32 = 84.0;
const PICTURE: f32 = 26.0;

/// Shows as many as there is room for. Returns the key of the one that was clicked.
pub(super) fn show(ui: &Ui, rect: Rect, about: &About, controls: &mut Controls) -> Option<u8> {
    let (palette, kit) = (controls.palette, &about.shown.loaded().kit);
    let group = controls.value(Param::Choke.info());
    let own = kit.pad(about.key).map_or(0, |pad| kit.choke(pad, group));
    let is_mate = |key: &u8| *key != about.key && kit.pad(*key).is_some_and(|pad| kit.choke(pad, group) == own);
    let mates: Vec<u8> = (0..128).filter(|key| own > 0 && is_mate(key)).collect();
    if mates.is_empty() {
        let text = if own == 0 { "In a group, pads silence each other." } else { "No other pad is in this group." };
        line(ui.painter(), rect, Align2::LEFT_CENTER, text, SMALL, palette.muted);
        return None;
    }
    let columns = ((rect.width() / LEAST) as usize).max(2);
    let size = vec2(rect.width() / columns as f32, rect.height());
    let cell = |place: usize| Rect::from_min_size(rect.min + vec2(place as f32 * size.x, 0.0), size);
    let seen = if mates.len() > columns { columns - 1 } else { mates.len() };
    let mut clicked = None;
    for (place, key) in mates.iter().take(seen).enumerate() {
        let (Some(pad), at) = (kit.pad(*key), cell(place)) else { continue };
        let name = about.shown.pad_name(pad);
        let response = ui.interact(at, Id::unique(("mate", *key)), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Choose {name}")));
        if response.hovered() {
            *controls.hint = Hint::new(&name, "Of the same choke group: a click chooses it.");
        }
        if let Some(figure) = about.bodies.figure(pad.sound) {
            face::paint_still(
                ui.painter(),
                at.with_max_x(at.left() + PICTURE).shrink2(vec2(1.0, 3.0)),
                figure,
                palette,
            );
        }
        let text = at.with_min_x(at.left() + PICTURE + 3.0).with_max_x(at.right() - 2.0);
        let colour = if response.hovered() { palette.accent_text } else { palette.text };
        line(ui.painter(), text, Align2::LEFT_CENTER, &name, SMALL, colour);
        outline(ui, &response, at, 3, palette);
        if response.clicked() {
            clicked = Some(*key);
        }
    }
    if mates.len() > seen {
        let text = format!("and {} more", mates.len() - seen);
        line(ui.painter(), cell(seen), Align2::LEFT_CENTER, &text, SMALL, palette.muted);
    }
    clicked
}
