//! A drag over the modes: of one mode, or of a pencil that draws the levels of all modes that it passes.

use super::axes::Axes;
use super::snap::Snap;
use super::table::clamped;
use crate::loaded::Loaded;
use egui::{Modifiers, Pos2, Vec2};
use sprung::patch::Mode;
use std::sync::Arc;

/// The shortest time between two changes of the sound during a drag, in seconds.
const CHANGES: f64 = 0.04;
/// How far from the pencil a mode may be for its level to be drawn, in pixels.
const BREADTH: f32 = 2.0;

/// The property of a mode that a drag changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Property {
    LevelAndRatio,
    Decay,
    Pan,
}

/// What is dragged.
enum Held {
    /// A mode: its place in the table, what it was before the drag, and how far the pointer has moved since.
    Mode { place: usize, property: Property, before: Mode, moved: Vec2 },
    /// A pencil, with its last place.
    Pencil { at: Pos2 },
}

/// A drag in progress.
pub(super) struct Drag {
    held: Held,
    /// The modes as dragged, and those that were loaded last.
    modes: Vec<Mode>,
    written: Vec<Mode>,
    /// The sound that was loaded last. If another sound is loaded, the drag is over.
    loaded: Arc<Loaded>,
    written_at: f64,
}

/// A movement of the pointer.
pub(super) struct Step {
    /// Its place; none while it is outside the window.
    pub(super) to: Option<Pos2>,
    pub(super) by: Vec2,
    pub(super) is_fine: bool,
}

impl Drag {
    fn new(held: Held, modes: Vec<Mode>, loaded: Arc<Loaded>, now: f64) -> Self {
        Self { held, written: modes.clone(), modes, loaded, written_at: now }
    }

    /// The drag of one of the modes of a sound. Alt drags its decay, Ctrl its pan.
    pub(super) fn of_mode(place: usize, modes: &[Mode], keys: Modifiers, loaded: Arc<Loaded>, now: f64) -> Self {
        let property = match (keys.alt, keys.ctrl) {
            (true, _) => Property::Decay,
            (_, true) => Property::Pan,
            _ => Property::LevelAndRatio,
        };
        let modes = clamped(modes);
        Self::new(Held::Mode { place, property, before: modes[place], moved: Vec2::ZERO }, modes, loaded, now)
    }

    /// A pencil that is put down.
    pub(super) fn of_pencil(at: Pos2, modes: &[Mode], loaded: Arc<Loaded>, now: f64) -> Self {
        Self::new(Held::Pencil { at }, clamped(modes), loaded, now)
    }

    pub(super) fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// The place in the table of the mode that is dragged.
    pub(super) fn place(&self) -> Option<usize> {
        match self.held {
            Held::Mode { place, .. } => Some(place),
            Held::Pencil { .. } => None,
        }
    }

    pub(super) fn is_of(&self, loaded: &Arc<Loaded>) -> bool {
        Arc::ptr_eq(&self.loaded, loaded)
    }

    /// Follows the pointer.
    pub(super) fn follow(&mut self, Step { to, by, is_fine }: Step, axes: &Axes, snap: Snap) {
        match &mut self.held {
            Held::Mode { place, property, before, moved } => {
                *moved += if is_fine { by * 0.1 } else { by };
                self.modes[*place] = dragged_to(*before, *property, *moved, axes, snap);
            }
            Held::Pencil { at } => {
                if let Some(to) = to {
                    draw(&mut self.modes, [*at, to], axes);
                    *at = to;
                }
            }
        }
    }

    /// The modes, if they differ from what was loaded last, and the sound may change again or must.
    pub(super) fn due(&mut self, now: f64, is_over: bool) -> Option<&[Mode]> {
        if !(is_over || now - self.written_at >= CHANGES) || self.modes == self.written {
            return None;
        }
        self.written_at = now;
        self.written.clone_from(&self.modes);
        Some(&self.modes)
    }

    /// Takes note of the sound that was loaded for the drag.
    pub(super) fn set_loaded(&mut self, loaded: Arc<Loaded>) {
        self.loaded = loaded;
    }

    /// What it is called when it is undone.
    pub(super) fn name(&self) -> String {
        self.place().map_or("drawn levels".to_owned(), |place| format!("mode {:.3}", self.modes[place].ratio))
    }
}

/// A mode after the pointer has moved.
fn dragged_to(before: Mode, property: Property, moved: Vec2, axes: &Axes, snap: Snap) -> Mode {
    let mut mode = before;
    match property {
        Property::LevelAndRatio => {
            let to = axes.place(&before) + moved;
            if moved.x != 0.0 {
                mode.ratio = snap.nearest(axes.ratio(to.x));
            }
            if moved.y != 0.0 {
                mode.level = axes.level(to.y).copysign(before.level);
            }
        }
        // An octave of T60 for 30 pixels.
        Property::Decay => {
            let octaves = f64::from((moved.x - moved.y) / 30.0);
            mode.decay *= sprung::units::ratio_from_semitones(12.0 * octaves) as f32;
        }
        Property::Pan => mode.pan += moved.x / 60.0,
    }
    mode.clamped()
}

/// Sets the levels of the modes below and above a line that was drawn to the line's height. Inverted modes stay inverted.
fn draw(modes: &mut [Mode], line: [Pos2; 2], axes: &Axes) {
    let [left, right] = if line[0].x <= line[1].x { line } else { [line[1], line[0]] };
    for mode in modes {
        let x = axes.x(mode.ratio);
        if (left.x - BREADTH..=right.x + BREADTH).contains(&x) {
            let share = ((x - left.x) / (right.x - left.x).max(1e-3)).clamp(0.0, 1.0);
            mode.level = axes.level(left.y + share * (right.y - left.y)).copysign(mode.level);
            *mode = mode.clamped();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Rect, pos2, vec2};

    #[test]
    fn a_line_sets_the_levels_of_the_modes_that_it_passes_and_of_no_others() {
        let mode = |ratio: f32, level: f32| Mode { ratio, level, ..Mode::UNIT };
        let before = [mode(1.0, 0.5), mode(2.0, -0.5), mode(4.0, 0.25), mode(8.0, 0.25)];
        let axes = Axes::around(&before, Rect::from_min_size(pos2(10.0, 20.0), vec2(500.0, 200.0)));
        let at = |ratio: f32, y: f32| pos2(axes.x(ratio), y);
        for line in [[at(1.5, 60.0), at(5.0, 120.0)], [at(5.0, 120.0), at(1.5, 60.0)]] {
            let mut modes = before;
            draw(&mut modes, line, &axes);
            assert_eq!((modes[0], modes[3]), (before[0], before[3]));
            assert!(modes[1].level < 0.0 && modes[2].level > 0.0, "signs stay: {modes:?}");
            let heights = [1, 2].map(|place: usize| axes.y(modes[place].level));
            let share = |ratio: f32| (axes.x(ratio) - axes.x(1.5)) / (axes.x(5.0) - axes.x(1.5));
            for (height, ratio) in heights.into_iter().zip([2.0, 4.0]) {
                assert!((height - (60.0 + 60.0 * share(ratio))).abs() < 0.1, "{height} at {ratio}");
            }
        }
        let mut modes = before;
        draw(&mut modes, [at(4.0, 100.0), at(4.0, 100.0)], &axes);
        assert!((axes.y(modes[2].level) - 100.0).abs() < 0.1, "a pencil that is only put down draws too");
    }
}
