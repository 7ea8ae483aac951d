//! A choice as a row of chips, as many as there is room for, with all others in a list at its end.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::{AROUND, Field};
use crate::editor::widgets::text::width;
use egui::{Id, Rect, Ui, pos2, vec2};

/// Space around a chip's text, and between chips.
const INSIDE: f32 = 9.0;
const SPACE: f32 = 3.0;
/// What is written on the list while a chip is lit.
const MORE: &str = "more";

/// One of several, of which one is chosen.
pub(super) struct Chips<'a> {
    pub(super) title: &'a str,
    pub(super) help: &'a str,
    /// What can be chosen, as the list has it.
    pub(super) names: &'a [String],
    pub(super) chosen: usize,
    /// The first that has a chip, and the chips' texts.
    pub(super) first: usize,
    pub(super) texts: &'a [String],
    /// The one whose chip is lit.
    pub(super) lit: usize,
}

impl Chips<'_> {
    /// Shows the row. Returns the place of the one that was picked.
    pub(super) fn show(&self, ui: &Ui, rect: Rect, controls: &mut Controls) -> Option<usize> {
        let palette = controls.palette;
        let chip = |text: &str| width(ui.painter(), text, SMALL + 1.0).ceil() + INSIDE;
        let list = self.texts.iter().map(|text| width(ui.painter(), text, SMALL)).fold(0.0, f32::max);
        let list = list.max(width(ui.painter(), MORE, SMALL)).ceil() + AROUND + 6.0;
        let end = rect.right() - list;
        let (mut left, mut picked, mut is_seen) = (rect.left(), None, false);
        for (place, text) in self.texts.iter().enumerate() {
            let at = Rect::from_min_size(pos2(left, rect.top()), vec2(chip(text), rect.height()));
            if at.right() + SPACE > end {
                break;
            }
            left = at.right() + SPACE;
            let is_lit = self.first + place == self.lit;
            is_seen |= is_lit;
            let look = if is_lit { Look::On } else { Look::Off };
            let response = button(ui, at, text, &format!("{} {text}", self.title), look, palette);
            if response.hovered() {
                *controls.hint = Hint::new(format!("{} {}", self.title, self.names[self.first + place]), self.help);
            }
            if response.clicked() && !is_lit {
                picked = Some(self.first + place);
            }
        }
        let words: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let value = if is_seen { MORE } else { words[self.chosen] };
        let name = format!("{} of the pad", self.title);
        let field = Field { id: Id::unique(("pad", self.title)), name: &name, value, is_default: is_seen };
        let (response, listed) = field.show(ui, rect.with_min_x(left), &words, palette);
        if response.hovered() {
            *controls.hint = Hint::new(format!("{} {}", self.title, words[self.chosen]), self.help);
        }
        listed.or(picked)
    }
}
