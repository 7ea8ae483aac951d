//! The sounding voices with their notes, and the channels with held keys; with MPE, each note has a channel of its own.

use crate::editor::controls::Controls;
use crate::editor::theme::{PADDING, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::text::{line, paragraph};
use egui::{Align2, Color32, Painter, Rect, Stroke, StrokeKind, pos2, vec2};
use sprung::params::Param;
use sprung::units::note_name;

/// From this width on, in points, the notes are listed beside the channels.
const WIDE: f32 = 500.0;
/// Height of a row of the list.
const ROW: f32 = 16.0;

/// Shows the panel; `voices` is the number of sounding voices.
pub(super) fn show(painter: &Painter, rect: Rect, voices: u32, controls: &Controls) {
    let palette = controls.palette;
    let mut inner = rect;
    if rect.width() >= WIDE {
        let list = inner.with_min_x(rect.center().x + PADDING);
        inner.set_right(rect.center().x - PADDING);
        show_notes(painter, list, controls);
    }
    let title = Rect::from_min_size(inner.min, vec2(inner.width(), TITLE_HEIGHT - 2.0));
    let text = line(painter, title, Align2::LEFT_CENTER, "Sounding", SMALL, palette.muted);
    let most = controls.value(Param::Voices.info()) as u32;
    let count = Rect::from_min_max(pos2(text.right() + 10.0, title.top()), title.max);
    line(painter, count, Align2::LEFT_CENTER, &format!("{voices} of {most}"), SMALL, palette.text);
    // A dot for each voice. Voices that still fade out beyond the limit are added.
    let dots = Rect::from_min_size(pos2(inner.left(), rect.top() + TITLE_HEIGHT + 2.0), vec2(inner.width(), 12.0));
    let all = most.max(voices).max(1);
    let step = (dots.width() / all as f32).min(13.0);
    for number in 0..all {
        let centre = pos2(dots.left() + (number as f32 + 0.5) * step, dots.center().y);
        let colour = if number < voices { palette.accent } else { palette.line };
        painter.circle_filled(centre, (step * 0.36).min(4.5), colour);
    }
    let telemetry = &controls.params.link().telemetry;
    let area = Rect::from_min_max(pos2(inner.left(), dots.bottom() + 6.0), inner.max);
    let rows = if area.height() >= 60.0 { 2 } else { 1 };
    let columns = 16 / rows;
    let height = (area.height() / rows as f32).min(38.0);
    for channel in 0..16_u8 {
        let (column, row) = (usize::from(channel) % columns, usize::from(channel) / columns);
        let size = vec2(area.width() / columns as f32, height);
        let corner = area.min + vec2(column as f32 * size.x, row as f32 * size.y);
        let cell = Rect::from_min_size(corner, size).shrink(1.5);
        let keys = telemetry.keys(channel);
        let is_down = keys != 0;
        let fill = if is_down { palette.accent } else { palette.raised };
        painter.rect(cell, 3.0, fill, Stroke::new(1.0, palette.outline), StrokeKind::Inside);
        let text = match keys.count_ones() {
            0 => format!("{}", channel + 1),
            1 => note_name(keys.trailing_zeros() as u8),
            many => format!("{many} keys"),
        };
        let colour = if is_down { palette.on_accent } else { palette.muted };
        line(painter, cell, Align2::CENTER_CENTER, &text, SMALL, colour);
    }
    let below = area.with_min_y(area.top() + rows as f32 * height + 6.0);
    if below.height() > 30.0 {
        let text = "The channels, and what each holds. With MPE, every note has a channel of its own: its bend, pressure and timbre are \
                    that note’s alone. A controller’s configuration message makes the zones; members bend by 48 semitones.";
        paragraph(painter, below, text, SMALL, palette.muted);
    }
}

/// Lists the newest notes: channel, key, pitch with bend, velocity, and time since the strike.
fn show_notes(painter: &Painter, rect: Rect, controls: &Controls) {
    let palette = controls.palette;
    let row = |top: f32, texts: [&str; 5], colour: Color32| {
        let width = rect.width() / texts.len() as f32;
        for (column, text) in texts.into_iter().enumerate() {
            let place = Rect::from_min_size(pos2(rect.left() + column as f32 * width, top), vec2(width - 4.0, ROW));
            line(painter, place, Align2::LEFT_CENTER, text, SMALL, colour);
        }
    };
    row(rect.top() - 4.0, ["CHANNEL", "KEY", "PITCH", "VELOCITY", "AGE"], palette.muted);
    if controls.notes.is_empty() {
        let first = rect.with_min_y(rect.top() + ROW - 4.0).with_max_y(rect.top() + 2.0 * ROW - 4.0);
        line(painter, first, Align2::LEFT_CENTER, "Play a note: it gets a row here.", SMALL, palette.muted);
    }
    let rows = ((rect.height() - ROW) / ROW).max(0.0) as usize;
    for (place, note) in controls.notes.iter().take(rows).enumerate() {
        let texts = [
            format!("{}", note.channel + 1),
            note_name(note.key),
            format!("{:.2}", note.pitch),
            format!("{:.0} %", note.velocity * 100.0),
            format!("{:.1} s", note.age),
        ];
        let top = rect.top() + ROW * (place as f32 + 1.0) - 4.0;
        row(top, texts.each_ref().map(String::as_str), palette.text);
    }
}
