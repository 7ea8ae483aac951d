//! The level of the sound, as a bar for each channel with a mark at its peak, and in figures.

use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Painter, Rect, Stroke, StrokeKind, pos2, vec2};
use sprung::units::db_from_gain;

/// Decibels below full scale that the bars show.
const RANGE: f32 = 60.0;
/// The least number of decibels that the limiter takes off to be shown.
const LEAST: f32 = 0.1;
/// How fast the bars fall, as a share of their length per second.
const FALL: f32 = 0.7;
/// Seconds for which the mark of a peak stays.
const STAYS: f32 = 1.0;
/// Width and height from which on there are figures below the bars.
const FIGURES: [f32; 2] = [90.0, 28.0];
/// Height of the figures, and of a bar.
const LINE: f32 = 12.0;
const BAR: f32 = 6.0;

/// The level of a channel, as shares of the bar. Above 1, the sound is above full scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Level {
    pub(super) now: f32,
    /// The mark at the last peak.
    pub(super) peak: f32,
    /// Seconds since that.
    age: f32,
}

/// Levels that rise at once and fall slowly, and marks that stay for a while before they do.
#[derive(Default)]
pub(super) struct Meter([Level; 2]);

impl Meter {
    /// The levels after some seconds in which the sound had these peaks.
    pub(super) fn levels(&mut self, peaks: [f32; 2], seconds: f32) -> [Level; 2] {
        for (level, peak) in self.0.iter_mut().zip(peaks) {
            let db = db_from_gain(f64::from(peak)) as f32;
            level.now = (level.now - FALL * seconds).max((db / RANGE + 1.0).clamp(0.0, 1.2));
            level.age += seconds;
            if level.now >= level.peak {
                (level.peak, level.age) = (level.now, 0.0);
            } else if level.age > STAYS {
                level.peak = (level.peak - FALL * seconds).max(level.now);
            }
        }
        self.0
    }

    pub(super) fn is_moving(&self) -> bool {
        self.0.iter().any(|level| level.now.max(level.peak) > 0.0)
    }
}

/// A share of the bar in decibels.
fn decibels(share: f32) -> f32 {
    RANGE * (share - 1.0)
}

/// Levels in figures, and by how many decibels the limiter lowers them.
pub(super) fn figures(levels: [Level; 2], lowered: f32) -> String {
    let figure = |level: Level| match decibels(level.now) {
        db if level.now > 0.0 => format!("{db:.1} dB"),
        _ => "silent".to_owned(),
    };
    let [left, right] = levels.map(figure);
    let limited = if lowered >= LEAST { format!("; the limiter takes {lowered:.1} dB off") } else { String::new() };
    format!("left {left}, right {right}; 0 dB is full scale{limited}")
}

pub(super) fn paint(painter: &Painter, rect: Rect, levels: [Level; 2], lowered: f32, palette: &Palette) {
    let [least_width, least_height] = FIGURES;
    let has_figures = rect.width() >= least_width && rect.height() >= least_height;
    let (bars, below) = rect.split_top_bottom_at_y(rect.bottom() - if has_figures { LINE } else { 0.0 });
    if has_figures {
        let peak = levels.iter().map(|level| level.peak).fold(0.0, f32::max);
        let peak = if peak > 0.0 { format!("{:.1} dB", decibels(peak)).replace('-', "−") } else { String::new() };
        let limited = if lowered >= LEAST { format!("limiter −{lowered:.1} dB") } else { String::new() };
        line(painter, below, Align2::RIGHT_CENTER, &limited, SMALL, palette.text);
        let room = below.width() - width(painter, &limited, SMALL);
        if width(painter, &peak, SMALL) < room {
            line(painter, below, Align2::LEFT_CENTER, &peak, SMALL, palette.muted);
        }
    } else if lowered >= LEAST {
        // From the right, where the level would be: a quarter of the bars is 15 dB.
        let length = (lowered / RANGE).min(1.0) * rect.width();
        let line = Rect::from_center_size(bars.center(), vec2(bars.width(), 2.0));
        painter.rect_filled(line.with_min_x(bars.right() - length), 0.0, palette.text);
    }
    let apart = if has_figures { 4.0 } else { 4.5 };
    for (level, offset) in levels.into_iter().zip([-apart, apart]) {
        let centre = pos2(bars.center().x, bars.center().y + offset);
        let bar = Rect::from_center_size(centre, vec2(bars.width(), BAR));
        painter.rect(bar, 3.0, palette.raised, Stroke::new(1.0, palette.empty_edge()), StrokeKind::Inside);
        let colour = if level.now > 1.0 { palette.warning } else { palette.level };
        painter.rect_filled(bar.with_max_x(bar.left() + bar.width() * level.now.clamp(0.0, 1.0)), 3.0, colour);
        if level.now > 1.0 {
            // A shape as well as a colour, for users who cannot tell the two colours apart.
            painter.rect_filled(bar.with_min_x(bar.right() - 8.0), 0.0, palette.text);
        } else if level.peak > level.now {
            let x = bar.left() + 1.0 + (bar.width() - 2.0) * level.peak.min(1.0);
            painter.vline(x, bar.y_range(), Stroke::new(2.0, palette.text));
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
        assert_eq!((left.now, right.now), (1.0, 0.0));
        let [left, _] = meter.levels([0.0; 2], 0.1);
        assert!((left.now - 0.93).abs() < 1e-6 && meter.is_moving());
        assert!(meter.levels([1.5; 2], 0.1)[0].now > 1.0, "above full scale");
        assert!(!meter.levels([f32::NAN; 2], 0.1)[1].now.is_nan());
    }

    #[test]
    fn the_mark_of_a_peak_stays_for_a_second_and_then_falls() {
        let mut meter = Meter::default();
        meter.levels([0.5, 0.5], 0.02);
        let peak = meter.0[0].peak;
        for _ in 0..9 {
            assert_eq!(meter.levels([0.01, 0.0], 0.1)[0].peak, peak);
        }
        assert!(meter.levels([0.01, 0.0], 0.2)[0].peak < peak);
        for _ in 0..20 {
            meter.levels([0.0; 2], 0.1);
        }
        assert!(!meter.is_moving(), "nothing moves in silence");
    }

    #[test]
    fn levels_are_told_in_decibels() {
        let levels = Meter::default().levels([0.5, 0.0], 0.02);
        assert_eq!(figures(levels, 0.0), "left -6.0 dB, right silent; 0 dB is full scale");
        assert!(figures(levels, 2.04).ends_with("; the limiter takes 2.0 dB off"));
    }
}
