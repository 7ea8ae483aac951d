//! Places of the parts of the window.

use crate::editor::theme::{GAP, HEADER_HEIGHT, PATH_HEIGHT, PICTURED_PATH, RAIL_HEIGHT, STATUS_HEIGHT};
use egui::{Rect, pos2, vec2};

/// The parts of the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) header: Rect,
    pub(crate) path: Rect,
    /// What is shown of the chosen part of the path, with the notch between the two above it.
    pub(crate) part: Rect,
    /// The line of sources.
    pub(crate) rail: Rect,
    /// Left of the keys; without width where there is no room for wheels.
    pub(crate) wheels: Rect,
    pub(crate) piano: Rect,
    pub(crate) status: Rect,
}

/// Width of two wheels with a gap beside each, as wide as their names, and the least width of a window that has them: beside them
/// there is room for five octaves. From this height on, such a window has pictures of the parts of the sound's way.
const WHEELS: f32 = 72.0;
const LEAST_WIDTH_WITH_WHEELS: f32 = 900.0;
const LEAST_HEIGHT_WITH_PICTURES: f32 = 620.0;

impl Layout {
    /// Divides a window.
    pub(crate) fn of(window: Rect) -> Self {
        let inner = window.shrink(GAP);
        let is_wide = window.width() >= LEAST_WIDTH_WITH_WHEELS;
        let header = Rect::from_min_max(inner.min, pos2(inner.right(), inner.top() + HEADER_HEIGHT));
        let status = Rect::from_min_max(pos2(inner.left(), inner.bottom() - STATUS_HEIGHT), inner.max);
        let bottom = status.top() - GAP / 2.0;
        let piano_height = (inner.height() * 0.115).clamp(40.0, 96.0);
        let keys = Rect::from_min_max(pos2(inner.left(), bottom - piano_height), pos2(inner.right(), bottom));
        let (wheels, piano) = keys.split_left_right_at_x(inner.left() + if is_wide { WHEELS } else { 0.0 });
        let page = Rect::from_min_max(header.left_bottom(), keys.right_top()).shrink2(vec2(0.0, GAP));
        let (share, [least, most]) = PICTURED_PATH;
        let has_pictures = is_wide && window.height() >= LEAST_HEIGHT_WITH_PICTURES;
        let height = if has_pictures { (share * page.height()).clamp(least, most).round() } else { PATH_HEIGHT };
        let path = page.with_max_y(page.top() + height);
        let rail = page.with_min_y(page.bottom() - RAIL_HEIGHT);
        let top = path.bottom() + GAP;
        // Smaller than the smallest window, there is none.
        let part = page.with_min_y(top).with_max_y((rail.top() - GAP / 2.0).max(top));
        Self { header, path, part, rail, wheels, piano, status }
    }

    /// The area between header and piano, for a page such as the browser.
    pub(crate) fn page(&self) -> Rect {
        self.path.with_max_y(self.rail.bottom())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::theme::{LEAST_SIZE, SIZE};

    #[test]
    fn parts_are_apart_inside_the_window_and_large_enough() {
        for [width, height] in [LEAST_SIZE, SIZE, [2000, 400], [640, 1600], [2600, 1600]] {
            let window = Rect::from_min_size(pos2(0.0, 0.0), vec2(width as f32, height as f32));
            let layout = Layout::of(window);
            let Layout { header, path, part, rail, wheels, piano, status } = layout;
            assert_eq!(wheels.width() > 0.0, width >= 900, "{width} × {height}: {wheels:?}");
            assert!(window.contains_rect(wheels) && !wheels.shrink(0.01).intersects(piano), "{wheels:?}");
            let parts = [header, path, part, rail, piano, status];
            for (place, part) in parts.iter().enumerate() {
                assert!(window.contains_rect(*part), "{width} × {height}: part {place} {part:?}");
                assert!(part.width() > 100.0 && part.height() >= 18.0, "{width} × {height}: part {place} {part:?}");
                for other in &parts[place + 1..] {
                    assert!(!part.shrink(0.01).intersects(*other), "{width} × {height}: {part:?} {other:?}");
                }
            }
            assert!(part.height() >= 160.0, "{width} × {height}: {part:?}");
        }
    }
}
