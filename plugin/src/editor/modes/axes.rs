//! The axes of the modes' picture: ratios in octaves from left to right, levels in decibels from bottom to top.

use egui::{Pos2, Rect, pos2};
use sprung::patch::Mode;
use sprung::units::{db_from_gain, gain_from_db, ratio_from_semitones, semitones_from_ratio};

/// How many decibels are on the axis.
const RANGE: f64 = 60.0;

/// The ranges of ratio and level that the picture shows, and its pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axes {
    pub(crate) rect: Rect,
    /// Semitones above ratio 1 at the left and right end.
    lowest: f64,
    highest: f64,
    /// The level at the upper end, in decibels.
    ceiling: f64,
}

impl Axes {
    /// Axes with room for all modes: at least two octaves, and 10 to 20 dB above the loudest mode, but not above 0 dB.
    pub(crate) fn around(modes: &[Mode], rect: Rect) -> Self {
        let ratios = || modes.iter().map(|mode| semitones_from_ratio(f64::from(mode.ratio)));
        let lowest = ratios().fold(0.0, f64::min) - 4.0;
        let highest = ratios().fold(20.0, f64::max) + 4.0;
        let loudest = modes.iter().fold(1e-3_f32, |loudest, mode| loudest.max(mode.level.abs()));
        let ceiling = ((db_from_gain(f64::from(loudest)) / 10.0).ceil() * 10.0 + 10.0).min(0.0);
        Self { rect, lowest, highest, ceiling }
    }

    /// The same axes on other pixels.
    pub(super) fn on(self, rect: Rect) -> Self {
        Self { rect, ..self }
    }

    /// The level at the lower end, in decibels.
    pub(super) fn floor(&self) -> f64 {
        self.ceiling - RANGE
    }

    /// Levels of the grid lines, in decibels.
    pub(super) fn decades(&self) -> impl Iterator<Item = f64> + use<> {
        let ceiling = self.ceiling;
        (0..=3).map(move |step| ceiling - 20.0 * f64::from(step))
    }

    pub(super) fn x(&self, ratio: f32) -> f32 {
        let share = (semitones_from_ratio(f64::from(ratio)) - self.lowest) / (self.highest - self.lowest);
        self.rect.left() + self.rect.width() * share as f32
    }

    /// The vertical position of a level in decibels, clamped to the range.
    pub(super) fn y_of_db(&self, db: f64) -> f32 {
        let share = (self.ceiling - db.clamp(self.floor(), self.ceiling)) / RANGE;
        self.rect.top() + self.rect.height() * share as f32
    }

    /// The vertical position of a level's absolute value.
    pub(super) fn y(&self, level: f32) -> f32 {
        self.y_of_db(db_from_gain(f64::from(level.abs())))
    }

    pub(crate) fn place(&self, mode: &Mode) -> Pos2 {
        pos2(self.x(mode.ratio), self.y(mode.level))
    }

    pub(super) fn ratio(&self, x: f32) -> f32 {
        let share = f64::from((x - self.rect.left()) / self.rect.width());
        ratio_from_semitones(self.lowest + share * (self.highest - self.lowest)) as f32
    }

    /// The level at a vertical position; 0 at the lower end.
    pub(crate) fn level(&self, y: f32) -> f32 {
        let db = self.ceiling - f64::from((y - self.rect.top()) / self.rect.height()) * RANGE;
        if db <= self.floor() { 0.0 } else { gain_from_db(db.min(0.0)) as f32 }
    }

    /// The powers of two that are on the axis.
    pub(super) fn octaves(&self) -> impl Iterator<Item = f32> + use<> {
        let (first, last) = ((self.lowest / 12.0).ceil() as i32, (self.highest / 12.0).floor() as i32);
        (first..=last).map(|octave| ratio_from_semitones(f64::from(octave) * 12.0) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    #[test]
    fn places_and_modes_go_both_ways() {
        let modes = [Mode::UNIT, Mode { ratio: 5.4, level: -0.125, ..Mode::UNIT }];
        let axes = Axes::around(&modes, Rect::from_min_size(pos2(10.0, 20.0), vec2(500.0, 200.0)));
        for mode in modes {
            let place = axes.place(&mode);
            assert!(axes.rect.contains(place), "{place:?}");
            assert!((axes.ratio(place.x) / mode.ratio - 1.0).abs() < 1e-4);
            assert!((axes.level(place.y) / mode.level.abs() - 1.0).abs() < 1e-4);
        }
        assert_eq!((axes.level(axes.rect.bottom()), axes.y(0.0)), (0.0, axes.rect.bottom()));
        assert_eq!(axes.octaves().collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
    }
}
