//! Places of the view's parts on the screen, for drawing and for the mouse.

use ratatui::layout::{Constraint, Layout as Split, Margin, Position, Rect};

/// Width of a white key of the piano, in columns. Black keys are drawn over the white ones.
const KEY_WIDTH: u16 = 3;

/// Semitones from the lowest key of the piano to the highest.
pub(super) const KEYS: u8 = 28;

/// The parts of a screen.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) head: Rect,
    pub(super) masses: Rect,
    pub(super) list: Rect,
    pub(super) piano: Rect,
    pub(super) foot: Rect,
}

impl Layout {
    pub(super) fn of(area: Rect) -> Self {
        let piano = if area.height >= 20 { 4 } else { 2 };
        let rows = [Constraint::Length(2), Constraint::Min(1), Constraint::Length(piano), Constraint::Length(1)];
        let [head, middle, piano, foot] = Split::vertical(rows).areas(area);
        let list = (area.width * 2 / 5).clamp(20, 44);
        let [masses, list] = Split::horizontal([Constraint::Min(1), Constraint::Length(list)]).areas(middle);
        Self { head, masses, list, piano, foot }
    }

    /// The rows of the list, inside its border.
    pub(super) fn rows(&self) -> Rect {
        self.list.inner(Margin::new(1, 1))
    }
}

pub(super) fn is_black(key: u8) -> bool {
    matches!(key % 12, 1 | 3 | 6 | 8 | 10)
}

/// The keys of the piano with their places, from the lowest on, as many as fit: first the white ones, then the black
/// ones, which lie over them.
pub(super) fn keys(area: Rect, lowest: u8) -> impl Iterator<Item = (u8, Rect)> {
    let whites_before = move |key: u8| (lowest..key).filter(|key| !is_black(*key)).count() as u16;
    let place = move |key: u8| {
        let x = area.x + KEY_WIDTH * whites_before(key);
        let rect = match is_black(key) {
            true => Rect::new(x.saturating_sub(2), area.y, 2, area.height / 2),
            false => Rect::new(x, area.y, KEY_WIDTH, area.height),
        };
        (key, rect)
    };
    let all = lowest..=lowest.saturating_add(KEYS).min(127);
    let ordered = all.clone().filter(|key| !is_black(*key)).chain(all.filter(|key| is_black(*key)));
    ordered.map(place).filter(move |(_, rect)| rect.x >= area.x && rect.x + 2 <= area.right())
}

/// The key of the piano at a place, and its velocity 0–1, which is greater further down.
pub(super) fn key_at(area: Rect, lowest: u8, at: Position) -> Option<(u8, f32)> {
    let (key, rect) = keys(area, lowest).filter(|(_, rect)| rect.contains(at)).last()?;
    Some((key, f32::from(at.y - rect.y + 1) / f32::from(rect.height)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_keys_lie_over_white_ones_and_lower_is_louder() {
        let area = Rect::new(0, 10, 80, 4);
        let at = |x, y| key_at(area, 60, Position::new(x, y));
        assert_eq!([at(0, 10), at(0, 13)], [Some((60, 0.25)), Some((60, 1.0))]);
        assert_eq!([at(1, 10), at(1, 12)], [Some((61, 0.5)), Some((60, 0.75))], "C sharp ends half way down");
        assert_eq!(at(3, 13), Some((62, 1.0)));
        assert_eq!([at(79, 13), at(0, 9), at(0, 14)], [None; 3]);
        assert_eq!(keys(Rect::new(0, 0, 300, 4), 12).count(), 29);
        assert!(keys(area, 120).all(|(key, _)| key < 128));
    }
}
