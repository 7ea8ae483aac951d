//! Pictures of the combined effect of a section's parameters.

use super::outlines;
use crate::editor::controls::Controls;
use crate::editor::lamps;
use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::line;
use egui::{Align2, Painter, Pos2, Rect, Stroke, StrokeKind, pos2, vec2};
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::units::ratio_from_semitones;

/// Share of an envelope's picture for the sustain, which has no duration.
pub(in crate::editor) const SUSTAIN: f64 = 0.2;
/// Half the height of a curve around the middle of its picture, as a share of that.
pub(in crate::editor) const AROUND: f32 = 0.46;
/// Number of points of each curved stage.
const POINTS: usize = 16;

/// Height of the line below a large picture.
const CAPTION: f32 = 15.0;

/// Draws the picture of a section, if it has one. Returns what it shows.
pub(in crate::editor) fn paint(
    painter: &Painter,
    rect: Rect,
    section: &[ParamInfo],
    controls: &Controls,
) -> Option<String> {
    let palette = controls.palette;
    let first = section[0].param;
    if matches!(first, Param::Envelope1Delay | Param::Envelope2Delay) {
        let value = |place: usize| f64::from(controls.heard(&PARAMS[first as usize + place]));
        paint_envelope(painter, rect, &value, whole(lengths(&value)), palette);
        return Some("envelope".to_owned());
    }
    let outline = outlines::of(section, &|info| controls.heard(info))?;
    let [floor, middle] = [rect.bottom(), rect.center().y].map(|y| painter.round_to_pixel_center(y));
    let (ground, height) = if outline.is_around { (middle, AROUND * rect.height()) } else { (floor, rect.height()) };
    let place = |point: egui::Vec2| pos2(rect.left() + rect.width() * point.x, ground - height * point.y);
    painter.hline(rect.x_range(), ground, Stroke::new(1.0, palette.line));
    // A section that is off is drawn in grey.
    let is_quiet = lamps::of(section[0].section).is_some_and(|lamp| !lamp.is_on(controls));
    let colour = match first {
        Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate => palette.modulation,
        _ if is_quiet => palette.muted.gamma_multiply(0.6),
        _ => palette.accent,
    };
    // The second line is what the first is compared with.
    for (points, stroke) in outline.lines.into_iter().zip([Stroke::new(1.5, colour), Stroke::new(1.0, palette.muted)]) {
        let mut points: Vec<Pos2> = points.into_iter().map(place).collect();
        // A line segment between two equal points has no direction.
        points.dedup_by(|next, point| (*next - *point).length() < 0.05);
        painter.add(match outline.is_filled {
            true => egui::Shape::convex_polygon(points, colour, Stroke::NONE),
            false => egui::Shape::line(points, stroke),
        });
    }
    for mark in outline.marks {
        painter.circle(place(mark), 3.0, palette.panel, Stroke::new(1.5, colour));
    }
    Some(outline.caption)
}

/// Draws a picture in a frame with a line below it that says what it shows; `draw` returns that, if there is anything.
pub(super) fn frame(painter: &Painter, rect: Rect, palette: &Palette, draw: impl FnOnce(Rect) -> Option<String>) {
    let (frame, below) = rect.split_top_bottom_at_y(rect.bottom() - CAPTION);
    painter.rect(frame, 4.0, palette.ground, Stroke::new(1.0, palette.outline), StrokeKind::Inside);
    if let Some(caption) = draw(frame.shrink2(vec2(8.0, 10.0))) {
        line(painter, below, Align2::CENTER_CENTER, &caption, SMALL, palette.muted);
    }
}

/// Draws an envelope from the values of its rows: delay, attack, hold, decay, sustain, release, curve. The width of a stage is
/// proportional to the square root of its time, as a share of `whole`, so that short stages stay visible beside long ones.
pub(in crate::editor) fn paint_envelope(
    painter: &Painter,
    rect: Rect,
    value: &dyn Fn(usize) -> f64,
    whole: f64,
    palette: &Palette,
) {
    painter.hline(rect.x_range(), painter.round_to_pixel_center(rect.bottom()), Stroke::new(1.0, palette.line));
    let line = egui::Shape::line(envelope(rect, value, whole), Stroke::new(1.5, palette.modulation));
    painter.with_clip_rect(rect.expand(2.0).intersect(painter.clip_rect())).add(line);
}

/// The lengths of an envelope's delay, attack, hold, decay and release in its picture, from the values of its rows.
pub(in crate::editor) fn lengths(value: &dyn Fn(usize) -> f64) -> [f64; 5] {
    [0, 1, 2, 3, 5].map(|row| value(row).max(0.0).sqrt())
}

/// What the whole width of an envelope's picture is worth in the unit of these lengths.
pub(in crate::editor) fn whole(lengths: [f64; 5]) -> f64 {
    lengths.iter().sum::<f64>() / (1.0 - SUSTAIN)
}

fn envelope(rect: Rect, value: &dyn Fn(usize) -> f64, total: f64) -> Vec<Pos2> {
    let [delay, attack, hold, decay, release] = lengths(value);
    let (sustain, bend) = (value(4) / 100.0, ratio_from_semitones(12.0 * -0.04 * value(6)));
    let stages = [
        (delay, 0.0, 0.0),
        (attack, 0.0, 1.0),
        (hold, 1.0, 1.0),
        (decay, 1.0, sustain),
        (SUSTAIN * total, sustain, sustain),
        (release, sustain, 0.0),
    ];
    let place = |time: f64, level: f64| {
        pos2(rect.left() + rect.width() * (time / total) as f32, rect.bottom() - rect.height() * level as f32)
    };
    let (mut points, mut start) = (vec![place(0.0, 0.0)], 0.0);
    for (length, from, to) in stages {
        for point in 1..=POINTS {
            let share = point as f64 / POINTS as f64;
            // The engine's curve.
            let bent = share / (share + bend * (1.0 - share));
            points.push(place(start + length * share, from + (to - from) * bent));
        }
        start += length;
    }
    // A line segment between two equal points has no direction.
    points.dedup_by(|next, point| (*next - *point).length() < 0.05);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    #[test]
    fn an_envelope_rises_falls_and_ends_at_the_right() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 50.0));
        let rows = [0.1, 0.2, 0.0, 0.5, 40.0, 1.0, 30.0];
        let value = |row: usize| rows[row];
        let points = envelope(rect, &value, whole(lengths(&value)));
        assert!(
            points.windows(2).all(|pair| pair[0].x <= pair[1].x)
                && points.iter().all(|point| rect.expand(0.01).contains(*point))
        );
        assert!(points.iter().any(|point| point.y < 0.01), "it reaches its top");
        assert!(points.windows(2).all(|pair| pair[0] != pair[1]), "no point twice");
        let last = points[points.len() - 1];
        assert!((last - rect.right_bottom()).length() < 0.1, "{last:?}");
        assert!(points.iter().any(|point| (point.y - 30.0).abs() < 0.01), "the sustain");
    }
}
