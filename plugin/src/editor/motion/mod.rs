//! The face of what moves: sources that are dragged to knobs, routes as sentences, envelopes and oscillators that are drawn.

mod curve;
pub(super) mod sources;

use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::pages::sections::{Section, knobs, sections, show_title};
use crate::editor::routes::list::List;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, PADDING, TITLE_HEIGHT, paint_panel};
use crate::editor::widgets::buttons::help_tab;
use curve::Curve;
use egui::{Rect, Ui, pos2, vec2};
use sources::section_of;
use sprung::patch::routes::Source;

/// Share of the width that the sources have, and its least and greatest.
const SIDE: (f32, [f32; 2]) = (0.23, [140.0, 252.0]);
/// From this height of the face on, the chosen source has two rows of knobs.
const TALL: f32 = 420.0;

/// The state of the face.
pub(super) struct MotionPage {
    /// The source whose section is shown below the routes.
    chosen: Source,
    list: List,
    curve: Curve,
}

impl Default for MotionPage {
    fn default() -> Self {
        Self { chosen: Source::Lfo1, list: List::default(), curve: Curve::default() }
    }
}

impl MotionPage {
    /// Ends what the user is doing with the curve.
    pub(super) fn leave(&mut self) {
        self.curve.leave();
    }

    /// Shows the face.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, shown: &Shown, controls: &mut Controls) -> bool {
        let palette = controls.palette;
        let (share, [least, most]) = SIDE;
        let side = rect.with_max_x(rect.left() + (share * rect.width()).clamp(least, most));
        let rest = rect.with_min_x(side.right() + GAP);
        let rows = if rect.height() >= TALL { 2 } else { 1 };
        let foot = rest.with_min_y(rest.bottom() - TITLE_HEIGHT - rows as f32 * CELL_HEIGHT - PADDING);
        let list = rest.with_max_y(foot.top() - GAP);
        paint_panel(ui.painter(), side, palette);
        paint_panel(ui.painter(), foot, palette);
        if let Some(source) = sources::show(ui, side.shrink(PADDING), self.chosen, shown, controls) {
            self.chosen = source;
            self.leave();
        }
        let about = (shown.patch(), shown.guide(), shown.preset().is_some());
        self.list.show(ui, list, about, controls);
        let help = Rect::from_min_size(list.right_top() - vec2(22.0, 0.0), vec2(22.0, TITLE_HEIGHT));
        let asks = help_tab(ui, help, "modulation", controls);
        for section in sections(section_of(self.chosen).as_slice()) {
            self.show_section(ui, foot.shrink2(vec2(PADDING, 0.0)), section, rows, shown, controls);
        }
        asks
    }

    /// Shows the knobs of a section, and beside them its curve.
    fn show_section(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        section: Section,
        rows: usize,
        shown: &Shown,
        controls: &mut Controls,
    ) {
        let title = Rect::from_min_size(rect.min + vec2(0.0, 2.0), vec2(rect.width(), TITLE_HEIGHT - 2.0));
        show_title(ui.painter(), title, section, controls);
        let columns = section.len().div_ceil(rows);
        let [least, most] = CELL_WIDTH;
        let width = (0.5 * rect.width() / columns as f32).floor().clamp(least, most);
        let left = rect.right() - columns as f32 * width;
        let first = Rect::from_min_size(pos2(left, rect.top() + TITLE_HEIGHT), vec2(width, CELL_HEIGHT));
        let about = (shown.patch(), shown.guide());
        knobs(ui, first, columns, section, about, controls);
        let picture =
            Rect::from_min_max(pos2(rect.left(), first.top()), pos2(left - 2.0 * GAP, rect.bottom() - 2.0 * GAP));
        let notes = sources::notes_of(self.chosen, shown, controls);
        self.curve.show(ui, picture.shrink2(vec2(8.0, 6.0)), section, notes, controls);
    }
}
