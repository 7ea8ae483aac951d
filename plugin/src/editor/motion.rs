//! What moves: one mass in slow motion on its phase plane, or the waveform.

use super::buttons::tab;
use super::controls::Controls;
use super::text::line;
use super::theme::{PADDING, Palette, SMALL, TITLE_HEIGHT};
use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, pos2, vec2};
use sprung::engine::Telemetry;
use sprung::engine::scope::SCOPE_FRAMES;
use std::collections::VecDeque;
use std::f32::consts::TAU;

/// Turns per second of the mass on its phase plane: that of slow motion, since the true motion cannot be seen.
const TURNS: f32 = 1.0;
/// How many points of its way are shown.
const TRAIL: usize = 420;
/// Frames of the waveform that are shown: half of those kept, so that it can begin at a zero.
const SHOWN: usize = SCOPE_FRAMES / 2;

#[derive(Clone, Copy, PartialEq, Default)]
enum Picture {
    #[default]
    Phase,
    Scope,
}

/// The pictures' memory.
#[derive(Default)]
pub(super) struct Motion {
    picture: Picture,
    /// In radians.
    angle: f32,
    /// Points of the unit disk, the last one at the end.
    trail: VecDeque<Pos2>,
    /// The greatest energy since the mass was at rest.
    greatest: f32,
    mode: usize,
}

impl Motion {
    /// Shows the picture; `selected` is the mode whose mass is shown, or that with the most energy.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        energies: &[f32],
        selected: Option<usize>,
        telemetry: &Telemetry,
        controls: &Controls,
    ) {
        let palette = controls.palette;
        palette.paint_panel(ui.painter(), rect);
        let mut left = rect.left() + PADDING;
        for (picture, name, width) in [(Picture::Phase, "Phase", 48.0), (Picture::Scope, "Scope", 48.0)] {
            let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), vec2(width, TITLE_HEIGHT));
            left = place.right() + 4.0;
            if tab(ui, place, name, picture == self.picture, palette).clicked() {
                self.picture = picture;
            }
        }
        let caption = Rect::from_min_max(
            pos2(left + 4.0, rect.top() + 2.0),
            pos2(rect.right() - PADDING, rect.top() + 2.0 + TITLE_HEIGHT),
        );
        let area = Rect::from_min_max(pos2(rect.left(), rect.top() + TITLE_HEIGHT + 4.0), rect.max).shrink(PADDING);
        let text = match self.picture {
            Picture::Phase => {
                self.advance(ui, energies, selected);
                self.phase(ui.painter(), area, palette);
                format!("mode {} in slow motion, {TURNS} turn a second", self.mode + 1)
            }
            Picture::Scope => {
                let rate = controls.params.link().sample_rate();
                scope(ui.painter(), area, &telemetry.scope().read(), palette);
                if rate == 0 { String::new() } else { format!("{:.0} ms", SHOWN as f32 * 1000.0 / rate as f32) }
            }
        };
        line(ui.painter(), caption, Align2::RIGHT_CENTER, &text, SMALL, palette.muted);
    }

    /// Moves the mass on.
    fn advance(&mut self, ui: &Ui, energies: &[f32], selected: Option<usize>) {
        let energy = |mode: usize| energies.get(mode).copied().unwrap_or(0.0);
        let loudest = (0..energies.len()).max_by(|a, b| energy(*a).total_cmp(&energy(*b))).unwrap_or(0);
        let mode = selected.filter(|mode| *mode < energies.len()).unwrap_or(loudest);
        // The loudest one is followed only when the other has almost died away, so that the picture does not jump.
        if mode != self.mode && (selected.is_some() || energy(self.mode) < 0.01 * energy(mode)) {
            (self.greatest, self.mode) = (0.0, mode);
            self.trail.clear();
        }
        let now = energy(self.mode);
        if now <= 1e-12 {
            self.greatest = 0.0;
            self.trail.pop_front();
            return;
        }
        self.greatest = self.greatest.max(now);
        let radius = (now / self.greatest).sqrt();
        let turned = TAU * TURNS * ui.input(|input| input.stable_dt.min(0.1));
        // Points between two passes, so that the way is round.
        for step in 1..=4 {
            let along = Vec2::angled(-self.angle - turned * step as f32 / 4.0);
            self.trail.push_back((along * radius).to_pos2());
        }
        self.angle = (self.angle + turned) % TAU;
        while self.trail.len() > TRAIL {
            self.trail.pop_front();
        }
    }

    fn phase(&self, painter: &Painter, rect: Rect, palette: &Palette) {
        let (centre, radius) = (rect.center(), rect.width().min(rect.height()) / 2.0 - 4.0);
        let grid = Stroke::new(1.0, palette.line);
        painter.hline(rect.x_range(), painter.round_to_pixel_center(centre.y), grid);
        painter.vline(painter.round_to_pixel_center(centre.x), rect.y_range(), grid);
        painter.circle_stroke(centre, radius, grid);
        line(painter, rect.translate(vec2(-2.0, -8.0)), Align2::RIGHT_CENTER, "x", SMALL, palette.muted);
        line(painter, rect.translate(vec2(8.0, 0.0)), Align2::CENTER_TOP, "v", SMALL, palette.muted);
        let place = |point: &Pos2| centre + point.to_vec2() * radius;
        let points: Vec<Pos2> = self.trail.iter().map(place).collect();
        let count = points.len().max(1) as f32;
        for (number, pair) in points.windows(2).enumerate() {
            let age = number as f32 / count;
            let colour = palette.accent.gamma_multiply(0.08 + 0.9 * age * age);
            painter.line_segment([pair[0], pair[1]], Stroke::new(1.6, colour));
        }
        let mass = points.last().copied().unwrap_or(centre);
        painter.circle(mass, 7.0, palette.accent, Stroke::new(1.5, palette.panel));
    }
}

fn scope(painter: &Painter, rect: Rect, frames: &[f32; SCOPE_FRAMES], palette: &Palette) {
    let grid = Stroke::new(1.0, palette.line);
    painter.hline(rect.x_range(), painter.round_to_pixel_center(rect.center().y), grid);
    painter.rect_stroke(rect, 2.0, grid, egui::StrokeKind::Inside);
    // From a rising zero on, so that the picture of a steady tone stands still.
    let start = (1..SHOWN).find(|frame| frames[frame - 1] < 0.0 && frames[*frame] >= 0.0).unwrap_or(0);
    let shown = &frames[start..start + SHOWN];
    let peak = shown.iter().fold(0.0_f32, |peak, frame| peak.max(frame.abs()));
    let scale = 0.9 * rect.height() / 2.0 / peak.clamp(0.01, 1.0).max(peak);
    let point = |(number, frame): (usize, &f32)| {
        let x = rect.left() + rect.width() * number as f32 / (SHOWN - 1) as f32;
        pos2(x, (rect.center().y - frame * scale).clamp(rect.top(), rect.bottom()))
    };
    painter.add(Shape::line(shown.iter().enumerate().map(point).collect(), Stroke::new(1.5, palette.accent)));
    if peak > 1e-6 {
        let text = format!("peak {:.1} dBFS", sprung::units::db_from_gain(f64::from(peak)));
        line(painter, rect.shrink(4.0), Align2::RIGHT_TOP, &text, SMALL, palette.muted);
    }
}
