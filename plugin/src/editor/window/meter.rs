//! The level of the sound, as a bar for each channel.

use crate::editor::theme::Palette;
use egui::{Painter, Rect, Stroke, StrokeKind, pos2, vec2};
use sprung::units::db_from_gain;

/// Decibels below full scale that the bars show.
const RANGE: f32 = 60.0;
/// The least number of decibels that the limiter takes off to be shown.
const LEAST: f32 = 0.1;
/// How fast the bars fall, as a share of their length per second.
const FALL: f32 = 0.7;

/// Levels that rise at once and fall slowly, as shares of the bar. Above 1, the sound is above full scale.
#[derive(Default)]
pub(super) struct Meter([f32; 2]);

impl Meter {
    /// The levels after some seconds in which the sound had these peaks.
    pub(super) fn levels(&mut self, peaks: [f32; 2], seconds: f32) -> [f32; 2] {
        for (level, peak) in self.0.iter_mut().zip(peaks) {
            let db = db_from_gain(f64::from(peak)) as f32;
            *level = (*level - FALL * seconds).max((db / RANGE + 1.0).clamp(0.0, 1.2));
        }
        self.0
    }

    pub(super) fn is_moving(&self) -> bool {
        self.0.iter().any(|level| *level > 0.0)
    }
}

/// Levels in figures, and by how many decibels the limiter lowers them.
pub(super) fn figures(levels: [f32; 2], lowered: f32) -> String {
    let figure = |level: f32| match RANGE * (level - 1.0) {
        db if level > 0.0 => format!("{db:.1} dB"),
        _ => "silent".to_owned(),
    };
    let [left, right] = levels.map(figure);
    let limited = if lowered >= LEAST { format!("; the limiter takes {lowered:.1} dB off") } else { String::new() };
    format!("left {left}, right {right}; 0 dB is full scale{limited}")
}

pub(super) fn paint(painter: &Painter, rect: Rect, levels: [f32; 2], lowered: f32, palette: &Palette) {
    if lowered >= LEAST {
        // From the right, where the level would be: a quarter of the bars is 15 dB.
        let length = (lowered / RANGE).min(1.0) * rect.width();
        let line = Rect::from_center_size(rect.center(), vec2(rect.width(), 2.0));
        painter.rect_filled(line.with_min_x(rect.right() - length), 0.0, palette.text);
    }
    for (level, offset) in levels.into_iter().zip([-4.5, 4.5]) {
        let centre = pos2(rect.center().x, rect.center().y + offset);
        let bar = Rect::from_center_size(centre, vec2(rect.width(), 6.0));
        painter.rect(bar, 3.0, palette.raised, Stroke::new(1.0, palette.empty_edge()), StrokeKind::Inside);
        let colour = if level > 1.0 { palette.warning } else { palette.level };
        painter.rect_filled(bar.with_max_x(bar.left() + bar.width() * level.clamp(0.0, 1.0)), 3.0, colour);
        if level > 1.0 {
            // A shape as well as a colour, for users who cannot tell the two colours apart.
            painter.rect_filled(bar.with_min_x(bar.right() - 8.0), 0.0, palette.text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_rise_at_once_and_fall_slowly() {
        let mut meter = Meter::default();
        assert!(!meter.is_moving());
        let [left, right] = meter.levels([1.0, 0.0], 0.02);
        assert_eq!((left, right), (1.0, 0.0));
        let [left, _] = meter.levels([0.0; 2], 0.1);
        assert!((left - 0.93).abs() < 1e-6 && meter.is_moving());
        assert!(meter.levels([1.5; 2], 0.1)[0] > 1.0, "above full scale");
        assert!(!meter.levels([f32::NAN; 2], 0.1)[1].is_nan());
    }

    #[test]
    fn levels_are_told_in_decibels() {
        let levels = Meter::default().levels([0.5, 0.0], 0.02);
        assert_eq!(figures(levels, 0.0), "left -6.0 dB, right silent; 0 dB is full scale");
        assert!(figures(levels, 2.04).ends_with("; the limiter takes 2.0 dB off"));
    }
}
