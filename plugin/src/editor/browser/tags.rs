//! The tags of the sounds that are listed: chosen ones narrow the list.

use crate::editor::theme::{Palette, TEXT};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::width;
use egui::{Rect, Ui, vec2};
use sprung::internals::library::Listed;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Height of a tag, and the space around its text and after it.
const HEIGHT: f32 = 20.0;
const AROUND: f32 = 14.0;
const SPACE: f32 = 4.0;

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
        found.retain(|sound| self.0.iter().all(|tag| sound.has_tag(tag)));
    }

    /// Shows the chosen tags, and as many as there is room for of those that narrow the list further, the most frequent first. A click
    /// chooses a tag, or lets go of it.
    pub(super) fn show(&mut self, ui: &Ui, rect: Rect, found: &[Arc<Listed>], palette: &Palette) {
        let mut corner = rect.min;
        let mut clicked = None;
        let chosen = self.0.iter().map(|tag| (tag.clone(), Look::On));
        let others = self.others(found).into_iter().map(|tag| (tag, Look::Off));
        for (tag, look) in chosen.chain(others) {
            let place = Rect::from_min_size(corner, vec2(width(ui.painter(), &tag, TEXT) + AROUND, HEIGHT));
            if place.right() > rect.right() {
                continue;
            }
            if button(ui, place, &tag, &format!("Only {tag}"), look, palette).clicked() {
                clicked = Some((tag, look));
            }
            corner.x = place.right() + SPACE;
        }
        match clicked {
            Some((tag, Look::On)) => self.0.retain(|chosen| *chosen != tag),
            Some((tag, _)) => self.0.push(tag),
            None => {}
        }
    }

    /// The tags that some of the sounds have and others have not, the most frequent first.
    fn others(&self, found: &[Arc<Listed>]) -> Vec<String> {
        let mut counts = BTreeMap::<String, usize>::new();
        for tag in found.iter().flat_map(|sound| sound.tags()) {
            *counts.entry(tag.to_lowercase()).or_default() += 1;
        }
        counts.retain(|tag, count| *count < found.len() && !self.0.contains(tag));
        let mut others: Vec<_> = counts.into_iter().collect();
        others.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        others.into_iter().map(|(tag, _)| tag).collect()
    }
}

/// Height of the row of tags.
pub(super) const fn height() -> f32 {
    HEIGHT + SPACE
}
