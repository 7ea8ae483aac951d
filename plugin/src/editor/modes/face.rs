//! Draws the modes: for each a stem, its decay as a horizontal line, and its present level.

use super::axes::Axes;
use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::disc;
use crate::editor::widgets::text::line;
use egui::{Align2, Painter, Rect, Stroke, pos2, vec2};
use sprung::patch::Mode;
use sprung::units::{db_from_gain, semitones_from_ratio};

/// The contents of the picture.
pub(super) struct Face<'a> {
    pub(super) modes: &'a [Mode],
    /// T60 of a mode whose own factor is 1, in seconds.
    pub(super) decay: f32,
    /// Present squared amplitudes of the first modes.
    pub(super) energies: &'a [f32],
    /// The mode that is dragged or under the pointer.
    pub(super) selected: Option<usize>,
}

/// Length in pixels of the line for a decay time: 6 for each doubling from 20 ms on, within limits.
fn tail(seconds: f32) -> f32 {
    (semitones_from_ratio(f64::from(seconds.max(0.02) / 0.02)) as f32 / 2.0).clamp(2.0, 60.0)
}

pub(super) fn paint(painter: &Painter, axes: &Axes, palette: &Palette, face: &Face) {
    grid(painter, axes, palette);
    let painter = &painter.with_clip_rect(axes.rect.expand2(vec2(6.0, 6.0)).intersect(painter.clip_rect()));
    // Many modes get small circles and no decay lines, so that each stays visible.
    let room = axes.rect.width() / face.modes.len().max(1) as f32;
    let (is_dense, circle) = (room < 4.0, (room * 0.45).clamp(1.6, 4.0));
    let stem = Stroke::new(1.0, if is_dense { palette.line } else { palette.muted.gamma_multiply(0.6) });
    for (place, mode) in face.modes.iter().enumerate() {
        let top = axes.place(mode);
        painter.line_segment([pos2(top.x, axes.rect.bottom()), top], stem);
        let energy = face.energies.get(place).copied().unwrap_or(0.0);
        if energy > 0.0 {
            let db = db_from_gain(f64::from(energy)) / 2.0;
            if db > axes.floor() {
                let bar =
                    Rect::from_min_max(pos2(top.x - 1.5, axes.y_of_db(db)), pos2(top.x + 1.5, axes.rect.bottom()));
                painter.rect_filled(bar, 1.0, palette.accent);
            }
        }
    }
    for (place, mode) in face.modes.iter().enumerate() {
        let is_selected = face.selected == Some(place);
        let (top, radius) = (axes.place(mode), if is_selected { 4.5 } else { circle });
        let colour = if is_selected { palette.accent_text } else { palette.text };
        if !is_dense || is_selected {
            let end = top + vec2(radius + tail(mode.decay * face.decay), 0.0);
            painter.line_segment(
                [top + vec2(radius, 0.0), end],
                Stroke::new(1.0, colour.gamma_multiply(if is_selected { 1.0 } else { 0.45 })),
            );
        }
        disc(painter, top, radius, palette.panel, Stroke::new(1.5, colour));
        if mode.level < 0.0 && !is_dense {
            painter.line_segment([top - vec2(2.0, 0.0), top + vec2(2.0, 0.0)], Stroke::new(1.2, colour));
        }
        if is_selected {
            painter.circle_filled(top + vec2(mode.pan * (radius + 3.0), -radius - 4.0), 1.6, palette.accent_text);
        }
    }
}

fn grid(painter: &Painter, axes: &Axes, palette: &Palette) {
    let rect = axes.rect;
    for db in axes.decades() {
        let y = painter.round_to_pixel_center(axes.y_of_db(db));
        painter.hline(rect.x_range(), y, Stroke::new(1.0, palette.line));
        let label = Rect::from_min_max(pos2(rect.left() - 30.0, y - 7.0), pos2(rect.left() - 6.0, y + 7.0));
        line(painter, label, Align2::RIGHT_CENTER, &format!("{db}"), SMALL, palette.muted);
    }
    for ratio in axes.octaves() {
        let x = painter.round_to_pixel_center(axes.x(ratio));
        painter.vline(x, rect.y_range(), Stroke::new(1.0, palette.line.gamma_multiply(0.7)));
        let label = Rect::from_center_size(pos2(x, rect.bottom() + 9.0), vec2(40.0, 14.0));
        line(painter, label, Align2::CENTER_CENTER, &format!("{ratio}"), SMALL, palette.muted);
    }
}
