//! The manual, shown over the window.

mod contents;
pub(super) mod text;

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, PADDING, Palette, RADIUS, SMALL, TEXT, font, paint_panel};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{line, name_field, paragraph};
use contents::{Entry, entries, first_with, has};
use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Align2, Color32, FontId, Id, Label, Rect, RichText, ScrollArea, Sense, Stroke, TextEdit, Ui, UiBuilder,
    pos2, vec2,
};
use sprung::internals::text::PAGES;
use text::{Block, Style, blocks, pieces};

/// Width of the list of pages.
const SIDE: f32 = 128.0;
/// Height of a line of the contents.
const ROW: f32 = 18.5;
/// Longest line of text, in points: longer lines are hard to read.
const WIDEST: f32 = 720.0;
/// Width of the scroll bar with a little space.
const BAR: f32 = 14.0;

/// The manual's state.
#[derive(Default)]
pub(super) struct Manual {
    page: usize,
    /// The contents, read when they are first shown.
    entries: Vec<Entry>,
    /// The words that are searched, and the pages that have them.
    words: String,
    found: Vec<usize>,
    /// Whether the text is to be scrolled to the words.
    seeks: bool,
}

impl Manual {
    /// Opens the page of this name.
    pub(super) fn open(&mut self, name: &str) {
        self.page = PAGES.iter().position(|(known, _)| *known == name).unwrap_or(0);
        self.words.clear();
    }

    /// Shows the manual. Returns whether the user closes it.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, controls: &mut Controls) -> bool {
        let palette = controls.palette;
        paint_panel(ui.painter(), rect, palette);
        let inner = rect.shrink(PADDING);
        let side = inner.with_max_x(inner.left() + SIDE);
        self.search(ui, side.with_max_y(side.top() + 22.0), palette);
        let close = Rect::from_min_max(pos2(side.left(), side.bottom() - 22.0), side.max);
        self.contents(ui, side.with_min_y(side.top() + 26.0).with_max_y(close.top() - 4.0), controls);
        let is_closed = button(ui, close, "Close", "Close the manual", Look::Plain, palette).clicked();
        ui.painter().vline(side.right() + GAP, inner.y_range(), Stroke::new(1.0, palette.line));
        let text = inner.with_min_x(side.right() + 2.0 * GAP);
        let mut child = ui.new_child(UiBuilder::new().id_salt("manual").max_rect(text));
        ScrollArea::vertical().id_salt(("manual", self.page)).auto_shrink(false).show(&mut child, |ui| {
            // The scroll bar is drawn over the text.
            ui.set_max_width((ui.available_width() - BAR).min(WIDEST));
            let blocks = blocks(PAGES[self.page].1);
            let sought = std::mem::take(&mut self.seeks).then(|| first_with(&blocks, &self.words)).flatten();
            for (place, block) in blocks.iter().enumerate() {
                let top = ui.cursor().min;
                show_block(ui, block, palette);
                if sought == Some(place) {
                    ui.scroll_to_rect(Rect::from_min_size(top, vec2(1.0, 1.0)), Some(Align::TOP));
                }
            }
        });
        is_closed
    }

    /// Shows the field of words to search for. The first page that has them is opened as they are typed.
    fn search(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) {
        let clear = rect.with_min_x(rect.right() - rect.height());
        let rest = if self.words.is_empty() { rect } else { rect.with_max_x(clear.left() - 4.0) };
        let edit = TextEdit::singleline(&mut self.words).id(Id::unique("manual words")).hint_text("Search");
        let response = ui.put(rest, edit.font(font(TEXT)).margin(vec2(6.0, 3.0)));
        name_field(&response, "Search the manual", &self.words);
        if rest != rect && button(ui, clear, "×", "Clear the search of the manual", Look::Plain, palette).clicked() {
            self.words.clear();
            response.request_focus();
        }
        if response.changed() {
            self.found = (0..PAGES.len()).filter(|place| has(PAGES[*place].1, &self.words)).collect();
            self.seeks = !self.words.trim().is_empty();
            if self.seeks && !self.found.contains(&self.page) {
                self.page = self.found.first().copied().unwrap_or(self.page);
            }
        }
    }

    /// Shows the pages by groups; while words are searched, those that have them.
    fn contents(&mut self, ui: &mut Ui, rect: Rect, controls: &mut Controls) {
        if self.entries.is_empty() {
            self.entries = entries();
        }
        let (palette, is_searching) = (controls.palette, !self.words.trim().is_empty());
        let mut child = ui.new_child(UiBuilder::new().id_salt("pages").max_rect(rect));
        ScrollArea::vertical().id_salt("pages").auto_shrink(false).show(&mut child, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            if is_searching && self.found.is_empty() {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), 40.0), Sense::hover());
                paragraph(ui.painter(), row, "No page has all of these words.", SMALL, palette.muted);
            }
            for entry in &self.entries {
                let (row, _) = match entry {
                    Entry::Group(_) if is_searching => continue,
                    Entry::Page(place, ..) if is_searching && !self.found.contains(place) => continue,
                    _ => ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover()),
                };
                match entry {
                    Entry::Group(name) => {
                        let place = row.with_min_x(row.left() + 2.0);
                        line(ui.painter(), place, Align2::LEFT_CENTER, name, SMALL, palette.muted);
                    }
                    Entry::Page(place, title, about) => {
                        let look = if *place == self.page { Look::On } else { Look::Off };
                        let response = button(ui, row, title, &format!("Manual: {}", PAGES[*place].0), look, palette);
                        if response.hovered() {
                            *controls.hint = Hint::new(title, about);
                        }
                        if response.clicked() {
                            (self.page, self.seeks) = (*place, is_searching);
                        }
                    }
                }
            }
        });
    }
}

fn mono(size: f32) -> FontId {
    FontId::monospace(size)
}

/// Lays out a line, with its Markdown marks turned into fonts and colours.
fn job(text: &str, size: f32, colour: Color32, palette: &Palette, width: f32) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = width;
    for (style, piece) in pieces(text) {
        let (font, colour) = match style {
            Style::Plain => (font(size), colour),
            Style::Strong => (font(size), palette.accent_text),
            Style::Code => (mono(size - 0.5), palette.accent_text),
        };
        job.append(&piece, 0.0, TextFormat { line_height: Some(size * 1.4), ..TextFormat::simple(font, colour) });
    }
    job
}

fn show_block(ui: &mut Ui, block: &Block, palette: &Palette) {
    let width = ui.available_width();
    match block {
        Block::Title(text) => {
            ui.label(RichText::new(text).font(font(22.0)).color(palette.accent_text));
            ui.add_space(6.0);
        }
        Block::Heading(text) => {
            ui.add_space(10.0);
            ui.label(RichText::new(text).font(font(16.0)).color(palette.text));
            ui.add_space(3.0);
        }
        Block::Paragraph(text) => {
            ui.label(job(text, TEXT + 0.5, palette.text, palette, width));
            ui.add_space(6.0);
        }
        Block::Item(mark, text) => {
            ui.horizontal_top(|ui| {
                ui.label(RichText::new(mark).font(font(TEXT + 0.5)).color(palette.muted));
                // In a row, a text goes on in one line unless it is told to wrap.
                ui.add(Label::new(job(text, TEXT + 0.5, palette.text, palette, width)).wrap());
            });
            ui.add_space(3.0);
        }
        Block::Code(text) => {
            egui::Frame::new().fill(palette.raised).corner_radius(RADIUS).inner_margin(8.0).show(ui, |ui| {
                ui.set_width(width - 16.0);
                ui.label(RichText::new(text).font(mono(TEXT - 0.5)).color(palette.text));
            });
            ui.add_space(8.0);
        }
        Block::Table(rows) => {
            table(ui, rows, width, palette);
            ui.add_space(8.0);
        }
    }
}

/// A table whose column widths follow their longest cells, within limits.
fn table(ui: &mut Ui, rows: &[Vec<String>], width: f32, palette: &Palette) {
    let columns = rows[0].len().max(1);
    let length = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(1).clamp(6, 44)
            as f32
    };
    let total: f32 = (0..columns).map(length).sum();
    for (number, row) in rows.iter().enumerate() {
        let colour = if number == 0 { palette.muted } else { palette.text };
        let galleys: Vec<_> = row
            .iter()
            .enumerate()
            .map(|(column, cell)| {
                let wide = width * length(column) / total;
                (wide, ui.painter().layout_job(job(cell, TEXT - 0.5, colour, palette, wide - 12.0)))
            })
            .collect();
        let height = galleys.iter().map(|(_, galley)| galley.size().y).fold(0.0, f32::max) + 5.0;
        let (place, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, row.join(", ")));
        let mut left = place.left();
        for (wide, galley) in galleys {
            let at = Align2::LEFT_TOP.align_size_within_rect(galley.size(), place.with_min_x(left));
            ui.painter().galley(at.min + vec2(0.0, 2.0), galley, colour);
            left += wide;
        }
        ui.painter().hline(place.x_range(), place.bottom(), Stroke::new(1.0, palette.line));
    }
}
