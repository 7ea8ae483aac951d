//! The tags and moods of the sounds that are listed, in rows by what they say: chosen ones narrow the list.

use crate::editor::theme::{Palette, SMALL, TEXT};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{line, width};
use egui::scroll_area::ScrollBarVisibility;
use egui::{Align2, Color32, Id, Rect, ScrollArea, Sense, Stroke, Ui, UiBuilder, pos2, vec2};
use sprung::internals::library::{Listed, MOODS, tagged_material};
use sprung_picture::tint;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Height of a tag, and the space around its text and after it.
const HEIGHT: f32 = 20.0;
const AROUND: f32 = 14.0;
const SPACE: f32 = 4.0;
/// Width of a row's name, of the button that leads on, and of a disc with the space after it.
const NAME: f32 = 66.0;
const MORE: f32 = 16.0;
const DISC: f32 = 16.0;
/// Share of a row by which that button leads on.
const ON: f32 = 0.8;

/// What tags say.
const ROWS: [&str; 3] = ["Material", "Character", "Instrument"];
/// How it is played and how long it sounds, in the order in which they are shown; moods follow.
const CHARACTER: [&str; 9] = ["struck", "pluck", "bow", "breath", "noise", "short", "ringing", "long", "sustained"];

/// The material whose colour a tag has, if it is one of a material.
fn material(tag: &str) -> Option<&'static str> {
    if tag == "string" { Some("wire") } else { tagged_material(&[tag.to_owned()]) }
}

/// The row of a tag, and its place there; those of instruments have none.
fn place(tag: &str) -> (usize, usize) {
    match (material(tag), CHARACTER.iter().chain(&MOODS).position(|other| *other == tag)) {
        (Some(_), _) => (0, 0),
        (None, Some(place)) => (1, place),
        (None, None) => (2, 0),
    }
}

/// The tags that are chosen.
#[derive(Clone, Default, PartialEq)]
pub(super) struct Tags(Vec<String>);

impl Tags {
    /// Lets all sounds through.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether no tag is chosen.
    pub(super) fn are_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Keeps the sounds that have all chosen tags.
    pub(super) fn retain(&self, found: &mut Vec<Arc<Listed>>) {
        let has = |sound: &Listed, tag: &str| sound.has_tag(tag) || sound.moods().contains(&tag);
        found.retain(|sound| self.0.iter().all(|tag| has(sound, tag)));
    }

    /// Shows the chosen tags and those that narrow the list further, those of instruments in the order in which they are frequent: by
    /// rows with names, or all in one row that is low. A click chooses a tag, or lets go of it.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, found: &[Arc<Listed>], palette: &Palette) {
        let all = self.all(found);
        let rows = if rect.height() < height(false) { 1 } else { ROWS.len() };
        let mut clicked = None;
        for (row, name) in ROWS.into_iter().enumerate().take(rows) {
            let top = rect.top() + row as f32 * (HEIGHT + SPACE);
            let mut at = Rect::from_min_max(pos2(rect.left(), top), pos2(rect.right(), top + HEIGHT));
            let is_whole = rows == 1;
            let tags: Vec<&str> =
                all.iter().filter(|(of, _)| is_whole || *of == row).map(|(_, tag)| tag.as_str()).collect();
            if !is_whole && !tags.is_empty() {
                line(ui.painter(), at, Align2::LEFT_CENTER, name, SMALL, palette.muted);
            }
            if !is_whole {
                at.min.x += NAME;
            }
            clicked = self.row(ui, at, name, &tags, palette).or(clicked);
        }
        if let Some(tag) = clicked {
            let before = self.0.len();
            self.0.retain(|chosen| *chosen != tag);
            if self.0.len() == before {
                self.0.push(tag);
            }
        }
    }

    /// Shows a row of tags, which scrolls if it is longer. Returns the tag that was clicked.
    fn row(&self, ui: &mut Ui, rect: Rect, name: &str, tags: &[&str], palette: &Palette) -> Option<String> {
        let wide = |tag: &str| width(ui.painter(), tag, TEXT) + AROUND + material(tag).map_or(0.0, |_| DISC);
        let widths: Vec<f32> = tags.iter().map(|tag| wide(tag)).collect();
        let whole = widths.iter().sum::<f32>() + tags.len().saturating_sub(1) as f32 * SPACE;
        let is_long = whole > rect.width();
        let rest = rect.with_max_x(rect.right() - if is_long { MORE + SPACE } else { 0.0 });
        let mut clicked = None;
        let mut inner = ui.new_child(UiBuilder::new().id_salt(("tags", name)).max_rect(rest));
        // The wheel scrolls what is wide, too.
        inner.style_mut().always_scroll_the_only_direction = true;
        let id = Id::unique(("tags", name));
        let mut area = ScrollArea::horizontal().id_salt("tags").auto_shrink(false);
        area = area.scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
        if let Some(offset) = ui.data_mut(|data| data.remove_temp(id)) {
            area = area.horizontal_scroll_offset(offset);
        }
        let area = area.show(&mut inner, |ui| {
            let (area, _) = ui.allocate_exact_size(vec2(whole.max(1.0), rect.height()), Sense::hover());
            let mut left = area.left();
            for (tag, width) in tags.iter().zip(&widths) {
                let place = Rect::from_min_size(pos2(left, area.top()), vec2(*width, HEIGHT));
                left = place.right() + SPACE;
                let look = if self.0.iter().any(|chosen| chosen == tag) { Look::On } else { Look::Off };
                if show_tag(ui, place, tag, look, palette) {
                    clicked = Some((*tag).to_owned());
                }
            }
        });
        if is_long {
            let more = rect.with_min_x(rect.right() - MORE);
            let (offset, seen) = (area.state.clamped_offset().x, area.inner_rect.width());
            let is_end = offset >= whole - seen - 1.0;
            let (text, about) = if is_end { ("‹", "First") } else { ("›", "More") };
            let about = format!("{about} tags: {}", name.to_lowercase());
            if button(ui, more, text, &about, Look::Plain, palette).clicked() {
                let offset = if is_end { 0.0 } else { offset + ON * seen };
                ui.data_mut(|data| data.insert_temp(id, offset));
                ui.ctx().request_repaint();
            }
        }
        clicked
    }

    /// The chosen tags, and those that some of the sounds have and others have not, with their rows and in their order.
    fn all(&self, found: &[Arc<Listed>]) -> Vec<(usize, String)> {
        let mut counts = BTreeMap::<String, usize>::new();
        for sound in found {
            let mut own: Vec<String> = sound.tags().iter().map(|tag| tag.to_lowercase()).collect();
            own.extend(sound.moods().iter().map(|mood| (*mood).to_owned()));
            own.sort_unstable();
            own.dedup();
            own.into_iter().for_each(|tag| *counts.entry(tag).or_default() += 1);
        }
        counts.retain(|_, count| *count < found.len());
        counts.extend(self.0.iter().map(|chosen| (chosen.clone(), usize::MAX)));
        let mut all: Vec<_> = counts.into_iter().map(|(tag, count)| (place(&tag), tag, count)).collect();
        all.sort_by_key(|(place, _, count)| (*place, std::cmp::Reverse(*count)));
        all.into_iter().map(|((row, _), tag, _)| (row, tag)).collect()
    }
}

/// Shows a tag, that of a material with a disc of its colour. Returns whether it was clicked.
fn show_tag(ui: &Ui, rect: Rect, tag: &str, look: Look, palette: &Palette) -> bool {
    let Some(material) = material(tag) else {
        return button(ui, rect, tag, &format!("Only {tag}"), look, palette).clicked();
    };
    let response = button(ui, rect, "", &format!("Only {tag}"), look, palette);
    let centre = pos2(rect.left() + 6.0 + 0.5 * DISC, rect.center().y);
    ui.painter().circle(centre, 5.5, tint(material), Stroke::new(1.0, palette.line));
    ui.painter().circle_filled(centre - vec2(1.6, 1.6), 1.3, tint(material).lerp_to_gamma(Color32::WHITE, 0.5));
    let colour = if look == Look::On { palette.on_accent } else { palette.text };
    let text = rect.with_min_x(centre.x + 0.5 * DISC + 1.0);
    line(ui.painter(), text, Align2::LEFT_CENTER, tag, TEXT, colour);
    response.clicked()
}

/// Height of the tags, in a list that is low or in one that is not.
pub(super) const fn height(is_low: bool) -> f32 {
    (if is_low { 1.0 } else { ROWS.len() as f32 }) * (HEIGHT + SPACE)
}
