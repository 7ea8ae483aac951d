//! Draws the last frames of the sound as a waveform, and their spectrum.

use super::spectrum::{self, FLOOR};
use crate::editor::controls::Controls;
use crate::editor::theme::{GAP, Palette, SMALL};
use crate::editor::widgets::text::line;
use egui::{Align2, Painter, Rect, Shape, Stroke, StrokeKind, Ui, pos2, vec2};
use sprung::internals::display::SCOPE_FRAMES;
use sprung::units::semitones_from_ratio;

/// Number of frames that the waveform shows: half of those stored, so that it can begin at a zero crossing.
const SHOWN: usize = SCOPE_FRAMES / 2;

/// Lowest and highest frequency of the spectrum, in Hz.
const RANGE: [f64; 2] = [20.0, 20_000.0];

/// Shows both. Returns what is said of them.
pub(crate) fn show(ui: &Ui, rect: Rect, controls: &Controls) -> String {
    let link = controls.params.link();
    let rate = link.sample_rate();
    paint(ui.painter(), rect, &link.telemetry.scope().read(), rate, controls.palette);
    if rate == 0 { String::new() } else { format!("{:.0} ms", SHOWN as f32 * 1000.0 / rate as f32) }
}

/// Draws both; the spectrum only if the sample rate is known. The spectrum is below the waveform if there is room,
/// otherwise to its right.
fn paint(painter: &Painter, rect: Rect, frames: &[f32; SCOPE_FRAMES], rate: u32, palette: &Palette) {
    if rate == 0 {
        return waveform(painter, rect, frames, palette);
    }
    let (first, second) = if rect.height() < 130.0 {
        let middle = rect.center().x;
        (rect.with_max_x(middle - GAP), rect.with_min_x(middle + GAP))
    } else {
        let middle = rect.top() + 0.45 * rect.height();
        (rect.with_max_y(middle - GAP / 2.0), rect.with_min_y(middle + GAP / 2.0))
    };
    waveform(painter, first, frames, palette);
    levels(painter, second, &spectrum::levels(frames), f64::from(rate), palette);
}

fn waveform(painter: &Painter, rect: Rect, frames: &[f32; SCOPE_FRAMES], palette: &Palette) {
    let grid = Stroke::new(1.0, palette.line);
    painter.hline(rect.x_range(), painter.round_to_pixel_center(rect.center().y), grid);
    painter.rect_stroke(rect, 2.0, grid, StrokeKind::Inside);
    let peak = trace(painter, rect, frames, palette);
    let text = if peak > 1e-6 {
        format!("peak {:.1} dBFS", sprung::units::db_from_gain(f64::from(peak)))
    } else {
        "Play a note to see it.".to_owned()
    };
    line(painter, rect.shrink(4.0), Align2::RIGHT_TOP, &text, SMALL, palette.muted);
}

/// Draws the waveform alone. Returns its peak.
pub(crate) fn trace(painter: &Painter, rect: Rect, frames: &[f32; SCOPE_FRAMES], palette: &Palette) -> f32 {
    // Starts at a rising zero crossing, so that the picture of a steady tone stands still.
    let start = (1..SHOWN).find(|frame| frames[frame - 1] < 0.0 && frames[*frame] >= 0.0).unwrap_or(0);
    let shown = &frames[start..start + SHOWN];
    let peak = shown.iter().fold(0.0_f32, |peak, frame| peak.max(frame.abs()));
    let scale = 0.9 * rect.height() / 2.0 / peak.clamp(0.01, 1.0).max(peak);
    let point = |(number, frame): (usize, &f32)| {
        let x = rect.left() + rect.width() * number as f32 / (SHOWN - 1) as f32;
        pos2(x, (rect.center().y - frame * scale).clamp(rect.top(), rect.bottom()))
    };
    painter.add(Shape::line(shown.iter().enumerate().map(point).collect(), Stroke::new(1.5, palette.accent)));
    peak
}

/// Draws the levels of bands of equal width in Hz on a logarithmic frequency axis.
fn levels(painter: &Painter, rect: Rect, levels: &[f32], rate: f64, palette: &Palette) {
    let area = rect.with_max_y(rect.bottom() - 14.0);
    let octaves = semitones_from_ratio(RANGE[1] / RANGE[0]);
    let x = |hertz: f64| area.left() + area.width() * (semitones_from_ratio(hertz / RANGE[0]) / octaves) as f32;
    let y = |db: f32| area.top() + area.height() * (db / FLOOR).clamp(0.0, 1.0);
    let grid = Stroke::new(1.0, palette.line);
    for (hertz, name) in [(100.0, "100"), (1_000.0, "1 k"), (10_000.0, "10 kHz")] {
        let x = painter.round_to_pixel_center(x(hertz));
        painter.vline(x, area.y_range(), grid);
        let label = Rect::from_center_size(pos2(x, rect.bottom() - 6.0), vec2(44.0, 12.0));
        line(painter, label, Align2::CENTER_CENTER, name, SMALL, palette.muted);
    }
    for db in [-30.0, -60.0] {
        painter.hline(area.x_range(), painter.round_to_pixel_center(y(db)), grid);
    }
    painter.rect_stroke(area, 2.0, grid, StrokeKind::Inside);
    // The highest level in each column of pixels; bands that are farther apart are joined by a straight line.
    let mut points: Vec<egui::Pos2> = Vec::with_capacity(area.width() as usize + 2);
    for (band, db) in levels.iter().enumerate().skip(1) {
        let hertz = band as f64 * rate / (2 * levels.len()) as f64;
        if !(RANGE[0]..=RANGE[1]).contains(&hertz) {
            continue;
        }
        let point = pos2(x(hertz), y(*db));
        match points.last_mut() {
            Some(last) if point.x - last.x < 1.0 => last.y = last.y.min(point.y),
            _ => points.push(point),
        }
    }
    for pair in points.windows(2).filter(|pair| pair.iter().any(|point| point.y < area.bottom())) {
        let [one, other] = [pair[0], pair[1]];
        let ground = vec![one, other, pos2(other.x, area.bottom()), pos2(one.x, area.bottom())];
        painter.add(Shape::convex_polygon(ground, palette.accent.gamma_multiply(0.25), Stroke::NONE));
    }
    painter.add(Shape::line(points, Stroke::new(1.3, palette.accent)));
}
