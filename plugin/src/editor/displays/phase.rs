//! The phase plane: one mass in slow motion, which the user can pull and release.

use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, FRAME, Hint};
use crate::editor::keyboard::audition::Audition;
use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::line;
use crate::link::Touch;
use egui::{Align2, CursorIcon, Id, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};
use sprung::engine::SoundingNote;
use std::collections::VecDeque;
use std::f32::consts::TAU;

/// Turns per second on the phase plane: slow motion, since the eye cannot follow the true motion.
const TURNS: f32 = 1.0;
/// Length of the trail, in turns, and the points of a turn.
const TRAIL: f32 = 1.75;
const POINTS: f32 = 240.0;
/// The smallest amplitude that is heard when the mass is released.
const LEAST: f32 = 0.03;
/// Longest time from the release to the sound, in seconds.
const WAIT: f32 = 0.3;

/// The picture's state.
pub(super) struct Phase {
    /// In radians.
    angle: f32,
    /// Points of the unit disk, the newest one at the end, each with the turns from the one before.
    trail: VecDeque<(Pos2, f32)>,
    /// The radius of the newest point.
    radius: f32,
    /// The greatest energy since the mass was at rest.
    greatest: f32,
    /// The radius that shows the greatest energy: 1, or how far the mass was pulled.
    full: f32,
    /// Seconds since the mass was let go, while it has not moved yet.
    waiting: Option<f32>,
    mode: usize,
    /// Where the mass is held, in the unit disk.
    pulled: Option<Vec2>,
}

impl Default for Phase {
    fn default() -> Self {
        let trail = VecDeque::new();
        Self { angle: 0.0, trail, radius: 0.0, greatest: 0.0, full: 1.0, waiting: None, mode: 0, pulled: None }
    }
}

impl Phase {
    /// Ends the pull without a sound.
    pub(super) fn cancel(&mut self) {
        self.pulled = None;
    }

    /// Shows the mass of the mode `selected`, or of the mode with the most energy. Returns the caption.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (energies, selected): (&[f32], Option<usize>),
        shown: &Shown,
        audition: &mut Audition,
        controls: &mut Controls,
    ) -> String {
        let (centre, radius) = (rect.center(), rect.width().min(rect.height()) / 2.0 - 4.0);
        self.pull(ui, rect, radius, shown, audition, controls);
        self.advance(energies, selected, controls.seconds);
        if !self.trail.is_empty() {
            ui.ctx().request_repaint_after(FRAME);
        }
        self.paint(ui.painter(), rect, (centre, radius), controls.palette);
        match self.pulled {
            Some(pulled) => format!("mode {}, pulled by {:.0} %", self.mode + 1, amplitude(pulled) * 100.0),
            None => format!("mode {}, in slow motion", self.mode + 1),
        }
    }

    /// Follows the pointer: a drag pulls the mass, and when it is released, its mode is heard, the louder the farther it was
    /// pulled.
    fn pull(
        &mut self,
        ui: &Ui,
        rect: Rect,
        radius: f32,
        shown: &Shown,
        audition: &mut Audition,
        controls: &mut Controls,
    ) {
        let response = ui.interact(rect, Id::unique("phase"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Phase plane"));
        let pointer = response.interact_pointer_pos().filter(|_| response.is_pointer_button_down_on());
        if response.hovered() || pointer.is_some() {
            *controls.hint =
                Hint::new("The mass", "Pull it and let go: you hear this mode alone, the louder the farther.");
            ui.ctx().set_cursor_icon(if pointer.is_some() { CursorIcon::Grabbing } else { CursorIcon::Grab });
        }
        if let Some(pointer) = pointer {
            let pulled = (pointer - rect.center()) / radius;
            self.pulled = Some(pulled / pulled.length().max(1.0));
            return;
        }
        let Some(pulled) = self.pulled.take().filter(|pulled| amplitude(*pulled) >= LEAST) else { return };
        let (mode, amplitude) = (self.mode as u16, amplitude(pulled));
        self.trail.clear();
        // The mass continues from where it was released.
        self.angle = (-pulled.angle()).rem_euclid(TAU);
        (self.greatest, self.full, self.waiting) = (0.0, amplitude, Some(0.0));
        let (home, link) = (shown.guide().home, controls.params.link());
        // A released note of the home key is probably the last one that was pulled: it is held again.
        let is_held = |note: &SoundingNote| link.telemetry.keys(note.channel) >> note.key & 1 == 1;
        let is_pushed = |note: &&SoundingNote| shown.shows(note.key) && (is_held(note) || note.key != home);
        match controls.notes.first().filter(is_pushed) {
            Some(SoundingNote { channel, key, .. }) => {
                link.play(Touch::Nudge { channel: *channel, key: *key, mode, amplitude });
            }
            None => audition.wake(home, (mode, amplitude), ui.input(|input| input.time), link),
        }
        ui.ctx().request_repaint();
    }

    /// Advances the mass by some seconds.
    fn advance(&mut self, energies: &[f32], selected: Option<usize>, seconds: f32) {
        let energy = |mode: usize| energies.get(mode).copied().unwrap_or(0.0);
        let loudest = (0..energies.len()).max_by(|a, b| energy(*a).total_cmp(&energy(*b))).unwrap_or(0);
        let mode = selected.filter(|mode| *mode < energies.len()).unwrap_or(loudest);
        // Without a selection, the picture changes to the loudest mode only when the present one has almost died away,
        // so that it does not jump.
        if mode != self.mode && (selected.is_some() || energy(self.mode) < 0.01 * energy(mode)) {
            (self.greatest, self.full, self.mode) = (0.0, 1.0, mode);
            self.trail.clear();
        }
        let now = energy(self.mode);
        if now <= 1e-12 {
            // The sound takes a moment to come; if it does not, nothing plays.
            self.waiting = self.waiting.map(|passed| passed + seconds).filter(|passed| *passed < WAIT);
            if self.waiting.is_none() {
                (self.greatest, self.full) = (0.0, 1.0);
            }
            self.shorten(self.trail_turns() - TURNS * seconds);
            return;
        }
        self.waiting = None;
        if now > self.greatest {
            if self.greatest > 0.0 {
                self.full = (self.full * (now / self.greatest).sqrt()).min(1.0);
            }
            self.greatest = now;
        }
        let radius = self.full * (now / self.greatest).sqrt();
        let before = if self.trail.is_empty() { radius } else { self.radius };
        let turns = TURNS * seconds;
        // Points between two passes, so that the trail is as round and as long at any number of pictures a second.
        let steps = (turns * POINTS).round().max(1.0) as u16;
        for step in 1..=steps {
            let share = f32::from(step) / f32::from(steps);
            let along = Vec2::angled(-self.angle - TAU * turns * share);
            let point = along * egui::lerp(before..=radius, share);
            self.trail.push_back((point.to_pos2(), turns / f32::from(steps)));
        }
        self.radius = radius;
        self.angle = (self.angle + TAU * turns) % TAU;
        self.shorten(TRAIL);
    }

    /// The length of the trail in turns.
    fn trail_turns(&self) -> f32 {
        self.trail.iter().map(|(_, turns)| turns).sum()
    }

    /// Shortens the trail from its old end to this many turns.
    fn shorten(&mut self, turns: f32) {
        let mut excess = self.trail_turns() - turns;
        while excess > 1e-4
            && let Some((_, oldest)) = self.trail.pop_front()
        {
            excess -= oldest;
        }
    }

    fn paint(&self, painter: &Painter, rect: Rect, (centre, radius): (Pos2, f32), palette: &Palette) {
        let grid = Stroke::new(1.0, palette.line);
        painter.hline(rect.x_range(), painter.round_to_pixel_center(centre.y), grid);
        painter.vline(painter.round_to_pixel_center(centre.x), rect.y_range(), grid);
        painter.circle_stroke(centre, radius, grid);
        line(painter, rect.translate(vec2(-2.0, -8.0)), Align2::RIGHT_CENTER, "x", SMALL, palette.muted);
        line(painter, rect.translate(vec2(8.0, 0.0)), Align2::CENTER_TOP, "v", SMALL, palette.muted);
        let place = |(point, _): &(Pos2, f32)| centre + point.to_vec2() * radius;
        let points: Vec<Pos2> = self.trail.iter().map(place).collect();
        let count = points.len().max(1) as f32;
        for (number, pair) in points.windows(2).enumerate() {
            let age = number as f32 / count;
            let colour = palette.accent.gamma_multiply(0.08 + 0.9 * age * age);
            painter.line_segment([pair[0], pair[1]], Stroke::new(1.6, colour));
        }
        let mass = match self.pulled {
            Some(pulled) => centre + pulled * radius,
            None => points.last().copied().unwrap_or(centre),
        };
        if self.pulled.is_some() {
            painter.line_segment([centre, mass], Stroke::new(1.5, palette.text));
        }
        painter.circle(mass, 7.0, palette.accent, Stroke::new(1.5, palette.panel));
    }
}

/// The amplitude of a mass that was pulled this far.
fn amplitude(pulled: Vec2) -> f32 {
    pulled.length().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a mass that decays leaves behind in three seconds, at this many pictures a second.
    fn trail(rate: u16) -> Phase {
        let mut phase = Phase::default();
        let (mut energy, seconds) = (1.0, 1.0 / f32::from(rate));
        for _ in 0..3 * rate {
            phase.advance(&[energy], None, seconds);
            energy -= energy * seconds;
        }
        phase
    }

    #[test]
    fn the_trail_is_a_smooth_spiral_of_the_same_length_at_any_number_of_pictures_a_second() {
        for rate in [4, 7, 12, 30, 60, 144] {
            let phase = trail(rate);
            let turns = phase.trail_turns();
            assert!((TRAIL - 0.01..=TRAIL + 0.01).contains(&turns), "{rate}: {turns} turns");
            let points: Vec<Vec2> = phase.trail.iter().map(|(point, _)| point.to_vec2()).collect();
            for pair in points.windows(2) {
                let angle = (-pair[1].angle() + pair[0].angle()).rem_euclid(TAU);
                assert!(angle < 1.6 * TAU / POINTS, "{rate}: a corner of {angle}");
                let shrinks = pair[0].length() - pair[1].length();
                assert!((-1e-6..0.004).contains(&shrinks), "{rate}: a step of {shrinks}");
            }
        }
    }

    #[test]
    fn the_trail_is_gone_soon_after_the_sound() {
        for rate in [4, 60] {
            let mut phase = trail(rate);
            for _ in 0..2 * rate {
                phase.advance(&[0.0], None, 1.0 / f32::from(rate));
            }
            assert!(phase.trail.is_empty(), "{rate}");
        }
    }
}
