//! The piano keyboard: it shows the held keys, and plays those that are clicked.

use super::held_key::HeldKey;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::Palette;
use crate::editor::widgets::text::line;
use crate::link::Link;
use egui::{Align2, Id, Painter, Pos2, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use sprung::preset::Guide;
use sprung::units::note_name;

/// Desired width of a white key, in points.
const WIDTH: f32 = 22.0;
/// Width and height of a black key, as shares of a white key's.
const BLACK: [f32; 2] = [0.62, 0.62];
/// How far the colour of a key that the sound is not made for goes to that of the other keys.
const DIM: f32 = 0.25;
/// For each key of an octave, the number of white keys below it, and whether it is black.
const OCTAVE: [(usize, bool); 12] = [
    (0, false),
    (1, true),
    (1, false),
    (2, true),
    (2, false),
    (3, false),
    (4, true),
    (4, false),
    (5, true),
    (5, false),
    (6, true),
    (6, false),
];

/// The keyboard's state.
#[derive(Default)]
pub(crate) struct Piano {
    held: HeldKey,
}

/// The keys that are shown, and their place.
struct Keys {
    rect: Rect,
    lowest: u8,
    octaves: usize,
}

impl Keys {
    fn of(rect: Rect) -> Self {
        let octaves = ((rect.width() / WIDTH / 7.0) as usize).clamp(2, 10);
        // Around C4; the whole range if there is room for it.
        let lowest = 12 * (5_usize.saturating_sub(octaves / 2)).max(if octaves >= 10 { 0 } else { 1 });
        Self { rect, lowest: lowest.min(127) as u8, octaves }
    }

    fn keys(&self) -> impl Iterator<Item = u8> + use<> {
        let last = usize::from(self.lowest) + 12 * self.octaves;
        self.lowest..=last.min(127) as u8
    }

    /// Where a key is, and whether it is black.
    fn key(&self, key: u8) -> (Rect, bool) {
        let width = self.rect.width() / (7 * self.octaves + 1) as f32;
        let above = usize::from(key - self.lowest);
        let (whites, is_black) = OCTAVE[above % 12];
        let left = self.rect.left() + (7 * (above / 12) + whites) as f32 * width;
        if is_black {
            let size = vec2(width * BLACK[0], self.rect.height() * BLACK[1]);
            return (Rect::from_min_size(pos2(left - size.x / 2.0, self.rect.top()), size), true);
        }
        (Rect::from_min_size(pos2(left, self.rect.top()), vec2(width, self.rect.height())), false)
    }

    /// The key at a place, and the velocity of a click there, which rises from the key's upper to its lower edge.
    fn at(&self, place: Pos2) -> Option<(u8, f32)> {
        let found = |black: bool| {
            self.keys()
                .map(|key| (key, self.key(key)))
                .find(|(_, (rect, is_black))| *is_black == black && rect.contains(place))
        };
        let (key, (rect, _)) = found(true).or_else(|| found(false))?;
        Some((key, ((place.y - rect.top()) / rect.height()).clamp(0.05, 1.0)))
    }
}

impl Piano {
    /// Shows the keys; `down` has one bit for each held key, and `meant` for each that the sound is made for.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        [down, meant]: [u128; 2],
        guide: &Guide,
        controls: &mut Controls,
    ) {
        let keys = Keys::of(rect);
        let response = ui.interact(rect, Id::unique("piano"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Keyboard"));
        let touched = response.is_pointer_button_down_on().then(|| response.interact_pointer_pos()).flatten();
        let touched = touched.and_then(|place| keys.at(place));
        self.held.follow(touched, controls.params.link());
        if let Some((key, velocity)) = response.hover_pos().and_then(|place| keys.at(place)) {
            let range = match (guide.lowest, guide.highest) {
                // A kit has pads here and there.
                (0, 127) if meant >> key & 1 == 0 => "   nothing sounds here".to_owned(),
                (0, 127) => String::new(),
                (lowest, highest) => format!("   made for {} to {}", note_name(lowest), note_name(highest)),
            };
            let title = format!("{} at velocity {:.0}", note_name(key), velocity * 127.0);
            *controls.hint = Hint::new(title, format!("lower on the key is louder{range}"));
        }
        let down = down | self.held.key().map_or(0, |key| 1 << key);
        paint(ui.painter(), &keys, [down, meant], guide.home, controls.palette);
    }

    /// Releases the key that the mouse holds.
    pub(crate) fn release(&mut self, link: &Link) {
        self.held.release(link);
    }
}

fn paint(painter: &Painter, keys: &Keys, [down, meant]: [u128; 2], home: u8, palette: &Palette) {
    for black in [false, true] {
        for key in keys.keys() {
            let (rect, is_black) = keys.key(key);
            if is_black != black {
                continue;
            }
            let is_down = down >> key & 1 == 1;
            let is_meant = meant >> key & 1 == 1;
            let fill = match (is_down, is_black) {
                (true, _) => palette.accent,
                (_, true) if is_meant => palette.black_key,
                (_, false) if is_meant => palette.white_key,
                (_, true) => palette.black_key.lerp_to_gamma(palette.white_key, DIM),
                (_, false) => palette.white_key.lerp_to_gamma(palette.black_key, DIM),
            };
            let shape = if is_black { rect } else { rect.shrink2(vec2(0.5, 0.0)) };
            painter.rect_filled(shape, egui::CornerRadius { nw: 0, ne: 0, sw: 3, se: 3 }, fill);
            if is_black && is_meant && !is_down {
                let top = shape.with_max_y(shape.bottom() - 4.0).shrink2(vec2(2.0, 0.0));
                painter.rect_filled(top, 1.0, palette.black_key.lerp_to_gamma(palette.white_key, 0.1));
            }
            let label = Rect::from_min_max(pos2(rect.left(), rect.bottom() - 15.0), rect.max);
            if key % 12 == 0 && rect.width() >= 16.0 {
                let colour = if is_down { palette.on_accent } else { palette.key_text };
                line(painter, label, Align2::CENTER_CENTER, &note_name(key), 9.5, colour);
            }
            if key == home && !is_down {
                painter.circle_filled(pos2(rect.center().x, rect.bottom() - 18.0), 2.5, palette.accent);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_lie_in_order_and_the_lower_edge_is_loudest() {
        for width in [400.0, 624.0, 1084.0, 2600.0] {
            let keys = Keys::of(Rect::from_min_size(pos2(8.0, 100.0), vec2(width, 80.0)));
            let mut whites: Vec<(u8, Rect)> = keys
                .keys()
                .map(|key| (key, keys.key(key)))
                .filter(|(_, (_, black))| !black)
                .map(|(key, (rect, _))| (key, rect))
                .collect();
            assert!(keys.keys().any(|key| key == 60), "{width}: C4 is there");
            whites.sort_by(|a, b| a.1.left().total_cmp(&b.1.left()));
            assert!(
                whites.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1.right() <= pair[1].1.left() + 0.01)
            );
            for key in keys.keys() {
                let (rect, _) = keys.key(key);
                let (found, soft) = keys.at(rect.center_top() + vec2(0.0, 1.0)).unwrap();
                let (_, loud) = keys.at(rect.center_bottom() - vec2(0.0, 1.0)).unwrap();
                assert!(keys.rect.expand(0.1).contains_rect(rect), "{width}: {key} {rect:?}");
                assert!(
                    (found == key || !keys.key(key).1) && soft < 0.1 && loud > 0.9,
                    "{width}: {key} {found} {soft} {loud}"
                );
            }
        }
    }
}
