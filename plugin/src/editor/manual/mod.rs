//! The manual, shown over the window.

pub(super) mod text;

use crate::editor::theme::{GAP, PADDING, Palette, RADIUS, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use egui::text::{LayoutJob, TextFormat};
use egui::{Align2, Color32, FontId, Label, Rect, RichText, ScrollArea, Sense, Stroke, Ui, UiBuilder, pos2, vec2};
use sprung::internals::text::PAGES;
use text::{Block, Style, blocks, pieces};

/// Width of the list of pages.
const SIDE: f32 = 112.0;
/// Longest line of text, in points: longer lines are hard to read.
const WIDEST: f32 = 720.0;
/// Width of the scroll bar with a little space.
const BAR: f32 = 14.0;

/// The manual's state: the page that is shown.
#[derive(Default)]
pub(super) struct Manual {
    page: usize,
}

impl Manual {
    /// Opens the page of this name.
    pub(super) fn open(&mut self, name: &str) {
        self.page = PAGES.iter().position(|(known, _)| *known == name).unwrap_or(0);
    }

    /// Shows the manual. Returns whether the user closes it.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) -> bool {
        palette.paint_panel(ui.painter(), rect);
        let inner = rect.shrink(PADDING);
        let side = inner.with_max_x(inner.left() + SIDE);
        let close = Rect::from_min_max(pos2(side.left(), side.bottom() - 22.0), side.max);
        let is_closed = button(ui, close, "Close", "Close the manual", Look::Plain, palette).clicked();
        let list = side.with_max_y(close.top() - 4.0);
        let mut child = ui.new_child(UiBuilder::new().id_salt("pages").max_rect(list));
        ScrollArea::vertical().id_salt("pages").auto_shrink(false).show(&mut child, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (place, (name, _)) in PAGES.iter().enumerate() {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
                let look = if place == self.page { Look::On } else { Look::Off };
                if button(ui, row, name, &format!("Manual: {name}"), look, palette).clicked() {
                    self.page = place;
                }
            }
        });
        ui.painter().vline(side.right() + GAP, inner.y_range(), Stroke::new(1.0, palette.line));
        let text = inner.with_min_x(side.right() + 2.0 * GAP);
        let mut child = ui.new_child(UiBuilder::new().id_salt("manual").max_rect(text));
        ScrollArea::vertical().id_salt(("manual", self.page)).auto_shrink(false).show(&mut child, |ui| {
            // The scroll bar is drawn over the text.
            ui.set_max_width((ui.available_width() - BAR).min(WIDEST));
            for block in blocks(PAGES[self.page].1) {
                show_block(ui, &block, palette);
            }
        });
        is_closed
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
