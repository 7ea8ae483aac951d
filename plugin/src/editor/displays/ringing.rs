//! The decay of the modes: the level of each over the last seconds.

use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::line;
use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};
use sprung::units::db_from_gain;
use std::collections::VecDeque;

/// The time that is shown, in seconds.
const SPAN: f64 = 4.0;
/// The shortest time between two stored moments, in seconds.
const STEP: f64 = 1.0 / 40.0;
/// Moments farther apart than this are not joined by a line, in seconds.
const GAP: f64 = 0.25;
/// The level range that is shown, in decibels.
const RANGE: f32 = 60.0;

/// The moments of the last seconds.
#[derive(Default)]
pub(super) struct Ringing {
    /// Time in seconds, and the energies of the modes: the oldest first.
    moments: VecDeque<(f64, Vec<f32>)>,
}

/// The level of an energy, in decibels.
fn level(energy: f32) -> f32 {
    if energy > 0.0 { (db_from_gain(f64::from(energy)) / 2.0) as f32 } else { f32::NEG_INFINITY }
}

impl Ringing {
    /// Stores the energies of a moment, and drops moments that are too old.
    pub(super) fn note(&mut self, now: f64, energies: &[f32]) {
        self.moments.retain(|(time, _)| (now - SPAN..=now).contains(time));
        if self.moments.back().is_none_or(|(last, _)| now - last >= STEP) {
            self.moments.push_back((now, energies.to_vec()));
        }
    }

    /// The level at the upper edge: that of the loudest mode, rounded up to 10 dB.
    fn ceiling(&self) -> f32 {
        let loudest = self.moments.iter().flat_map(|(_, energies)| energies).fold(0.0_f32, |most, one| most.max(*one));
        // A negative zero would be written with its sign.
        ((level(loudest) / 10.0).ceil() * 10.0).clamp(-60.0, 20.0) + 0.0
    }

    /// The curve of a mode's level within a rectangle, as lines that are interrupted where the level is below the
    /// range.
    fn lines(&self, mode: usize, ceiling: f32, rect: Rect) -> Vec<Vec<Pos2>> {
        let last = self.moments.back().map_or(0.0, |(time, _)| *time);
        let (mut lines, mut before) = (vec![Vec::new()], f64::NEG_INFINITY);
        for (time, energies) in &self.moments {
            let db = level(energies.get(mode).copied().unwrap_or(0.0));
            // While another page was shown, nothing was stored.
            if time - std::mem::replace(&mut before, *time) > GAP {
                lines.push(Vec::new());
            }
            if db <= ceiling - RANGE {
                lines.push(Vec::new());
            } else if let Some(line) = lines.last_mut() {
                let x = rect.right() - rect.width() * ((last - time) / SPAN) as f32;
                line.push(pos2(x, rect.top() + rect.height() * (ceiling - db) / RANGE));
            }
        }
        lines.retain(|line| line.len() > 1);
        lines
    }

    pub(super) fn paint(&self, painter: &Painter, rect: Rect, selected: Option<usize>, palette: &Palette) {
        let area = Rect::from_min_max(rect.min + vec2(24.0, 0.0), rect.max - vec2(0.0, 14.0));
        let (grid, ceiling) = (Stroke::new(1.0, palette.line), self.ceiling());
        for below in [0.0, 20.0, 40.0, 60.0] {
            let y = painter.round_to_pixel_center(area.top() + area.height() * below / RANGE);
            painter.hline(area.x_range(), y, grid);
            let label = Rect::from_min_max(pos2(rect.left() - 4.0, y - 7.0), pos2(area.left() - 4.0, y + 7.0));
            line(
                painter,
                label,
                Align2::RIGHT_CENTER,
                &format!("{}", ceiling - below).replace('-', "−"),
                SMALL,
                palette.muted,
            );
        }
        for second in 0..SPAN as u32 {
            let x = painter.round_to_pixel_center(area.right() - area.width() * second as f32 / SPAN as f32);
            painter.vline(x, area.y_range(), grid);
            let text = if second == 0 { "now".to_owned() } else { format!("−{second} s") };
            let label = Rect::from_center_size(pos2(x.min(area.right() - 12.0), rect.bottom() - 6.0), vec2(40.0, 12.0));
            line(painter, label, Align2::CENTER_CENTER, &text, SMALL, palette.muted);
        }
        painter.rect_stroke(area, 2.0, grid, StrokeKind::Inside);
        let count = self.moments.iter().map(|(_, energies)| energies.len()).max().unwrap_or(0);
        for mode in (0..count).filter(|mode| Some(*mode) != selected) {
            // Higher modes are fainter, so that the low ones, which last longest, stay visible.
            let colour = palette.accent.gamma_multiply(0.35 + 0.6 / (1.0 + mode as f32 / 6.0));
            for line in self.lines(mode, ceiling, area) {
                painter.add(Shape::line(line, Stroke::new(1.2, colour)));
            }
        }
        if (0..count).all(|mode| self.lines(mode, ceiling, area).is_empty()) {
            let says = "Play a note: each mode is a line as it dies away.";
            line(painter, area.shrink(4.0), Align2::CENTER_CENTER, says, SMALL, palette.muted);
        }
        for line in selected.iter().flat_map(|mode| self.lines(*mode, ceiling, area)) {
            painter.add(Shape::line(line, Stroke::new(2.2, palette.text)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_that_falls_by_a_rate_is_a_straight_line_which_leaves_at_the_left() {
        let mut ringing = Ringing::default();
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(400.0, 120.0));
        let mut energy = 1.0;
        for step in 0..=100 {
            // A fall by 0.4 dB in each step.
            ringing.note(f64::from(step) * 0.03, &[energy, 0.0]);
            energy *= sprung::units::gain_from_db(-0.8) as f32;
        }
        let lines = ringing.lines(0, ringing.ceiling(), rect);
        assert_eq!(
            (lines.len(), ringing.lines(1, ringing.ceiling(), rect).len()),
            (1, 0),
            "a mode at rest has no line"
        );
        let line = &lines[0];
        assert_eq!(line.len(), 101);
        for (step, point) in line.iter().enumerate() {
            let expected = pos2(110.0 + 3.0 * step as f32, 20.0 + 0.8 * step as f32);
            assert!((*point - expected).length() < 0.02, "{step}: {point:?} {expected:?}");
        }
        ringing.note(1000.0, &[1.0]);
        assert!(ringing.lines(0, ringing.ceiling(), rect).is_empty(), "what is too old is forgotten");
    }
}
