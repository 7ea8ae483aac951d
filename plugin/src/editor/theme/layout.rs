//! Places of the parts of the window.

use crate::editor::theme::{CELL_HEIGHT, GAP, HEADER_HEIGHT, PADDING, PATH_HEIGHTS, STATUS_HEIGHT, TITLE_HEIGHT};
use egui::{Rect, pos2};

/// The parts of the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) header: Rect,
    pub(crate) modes: Rect,
    pub(crate) displays: Rect,
    pub(crate) path: Rect,
    pub(crate) sections: Rect,
    /// Left of the keys; without width where there is no room for wheels.
    pub(crate) wheels: Rect,
    pub(crate) piano: Rect,
    pub(crate) status: Rect,
}

/// Width of two wheels with a gap beside each, as wide as their names, and the least width of a window that has them: beside them
/// there is room for five octaves. From this height on, such a window has pictures of the parts of the sound's way.
const WHEELS: f32 = 72.0;
const LEAST_WIDTH_WITH_WHEELS: f32 = 900.0;
const LEAST_HEIGHT_WITH_PICTURES: f32 = 680.0;

/// The height of sections with this many rows of knobs.
fn section_height(rows: usize) -> f32 {
    TITLE_HEIGHT + rows as f32 * CELL_HEIGHT + PADDING
}

impl Layout {
    /// Divides a window.
    pub(crate) fn of(window: Rect) -> Self {
        let inner = window.shrink(GAP);
        let is_wide = window.width() >= LEAST_WIDTH_WITH_WHEELS;
        let mut top = inner.top();
        let mut bottom = inner.bottom();
        let header = Rect::from_min_max(inner.min, pos2(inner.right(), top + HEADER_HEIGHT));
        top = header.bottom() + GAP;
        let status = Rect::from_min_max(pos2(inner.left(), bottom - STATUS_HEIGHT), inner.max);
        bottom = status.top() - GAP / 2.0;
        let piano_height = (inner.height() * 0.115).clamp(40.0, 96.0);
        let keys = Rect::from_min_max(pos2(inner.left(), bottom - piano_height), pos2(inner.right(), bottom));
        let (wheels, piano) = keys.split_left_right_at_x(inner.left() + if is_wide { WHEELS } else { 0.0 });
        bottom = piano.top() - GAP;
        let path_height = PATH_HEIGHTS[usize::from(is_wide && window.height() >= LEAST_HEIGHT_WITH_PICTURES)];
        // As many rows of knobs as leave the upper half at least a third of the window.
        let room = bottom - top - path_height - GAP;
        let rows = (1..=3).rev().find(|rows| room - section_height(*rows) >= inner.height() * 0.3).unwrap_or(1);
        // Smaller than the smallest window, the header stays free.
        let sections_top = (bottom - section_height(rows)).max(top + path_height);
        let sections = Rect::from_min_max(pos2(inner.left(), sections_top), pos2(inner.right(), bottom));
        bottom = sections.top();
        let path = Rect::from_min_max(pos2(inner.left(), bottom - path_height), pos2(inner.right(), bottom));
        bottom = path.top() - GAP / 2.0;
        let split = inner.left() + ((inner.width() - GAP) * 0.65).round();
        let modes = Rect::from_min_max(pos2(inner.left(), top), pos2(split, bottom));
        let displays = Rect::from_min_max(pos2(split + GAP, top), pos2(inner.right(), bottom));
        Self { header, modes, displays, path, sections, wheels, piano, status }
    }

    /// The area between header and piano, for a page such as the browser.
    pub(crate) fn page(&self) -> Rect {
        Rect::from_min_max(self.modes.min, pos2(self.header.right(), self.piano.top() - GAP))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::theme::{LEAST_SIZE, SIZE};
    use egui::vec2;

    #[test]
    fn parts_are_apart_inside_the_window_and_large_enough() {
        for [width, height] in [LEAST_SIZE, SIZE, [2000, 400], [640, 1600], [2600, 1600]] {
            let window = Rect::from_min_size(pos2(0.0, 0.0), vec2(width as f32, height as f32));
            let layout = Layout::of(window);
            let Layout { header, modes, displays, path, sections, wheels, piano, status } = layout;
            assert_eq!(wheels.width() > 0.0, width >= 900, "{width} × {height}: {wheels:?}");
            assert!(window.contains_rect(wheels) && !wheels.shrink(0.01).intersects(piano), "{wheels:?}");
            let parts = [header, modes, displays, path, sections, piano, status];
            for (place, part) in parts.iter().enumerate() {
                assert!(window.contains_rect(*part), "{width} × {height}: part {place} {part:?}");
                assert!(part.width() > 100.0 && part.height() >= 18.0, "{width} × {height}: part {place} {part:?}");
                for other in &parts[place + 1..] {
                    assert!(!part.shrink(0.01).intersects(*other), "{width} × {height}: {part:?} {other:?}");
                }
            }
            assert!(modes.height() >= 100.0, "{width} × {height}: {modes:?}");
        }
    }
}
