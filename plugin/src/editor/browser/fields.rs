//! The browser's list of categories, and its search.

use super::finding::Finding;
use super::list::ROW;
use super::sounds::Category;
use crate::editor::theme::{Palette, SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{line, name_field, take_over, width};
use egui::{Align2, Id, Margin, Rect, ScrollArea, Sense, TextEdit, Ui, UiBuilder, vec2};

/// The widget of the search.
pub(super) fn search_field() -> Id {
    Id::unique("search")
}

impl Finding {
    /// Shows the categories, of which a click chooses one.
    pub(super) fn show_categories(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) {
        let mut inner = ui.new_child(UiBuilder::new().id_salt("categories").max_rect(rect));
        ScrollArea::vertical().id_salt("categories").auto_shrink(false).show(&mut inner, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let compared = self.likeness.found.as_ref().map(|(name, _)| (Category::Like, format!("Like {name}")));
            for (category, name) in compared.into_iter().chain(Category::all().map(|each| (each, each.name()))) {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
                let look = if category == self.category { Look::On } else { Look::Off };
                if button(ui, row.shrink2(vec2(0.0, 1.0)), &name, &format!("Show {name}"), look, palette).clicked()
                    && self.category != category
                {
                    self.choose(category);
                }
                if matches!(category, Category::Kits) {
                    ui.add_space(6.0);
                }
            }
        });
    }

    /// Shows the search, and how many sounds there are. Returns whether it has lost the focus by a click elsewhere.
    pub(super) fn show_search(&mut self, ui: &mut Ui, rect: Rect, count: &str, palette: &Palette) -> bool {
        let (field, words) = (search_field(), &mut self.words);
        let rect = rect.with_max_y(rect.top() + 22.0);
        let clear = rect.with_min_x(rect.right() - rect.height());
        let rest = if words.is_empty() { rect } else { rect.with_max_x(clear.left() - 4.0) };
        let edit = TextEdit::singleline(words).id(field).hint_text("Search, or a file’s whole path");
        // Not under the words.
        let counted = width(ui.painter(), count, SMALL) as i8;
        let margin = Margin { left: 6, right: counted + 12, top: 3, bottom: 3 };
        let response = ui.put(rest, edit.font(font(TEXT)).margin(margin));
        let told = rest.shrink2(vec2(6.0, 0.0));
        line(ui.painter(), told, Align2::RIGHT_CENTER, count, SMALL, palette.muted);
        name_field(&response, "Search", words);
        if rest != rect && button(ui, clear, "×", "Clear the search", Look::Plain, palette).clicked() {
            words.clear();
            self.searches = true;
        }
        if std::mem::take(&mut self.searches) {
            take_over(ui, field, words);
        }
        response.lost_focus() && response.clicked_elsewhere()
    }
}
