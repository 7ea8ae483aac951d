//! Draws the face of a knob: an arc from the default to the position, a pointer, and rings for modulation.

use crate::editor::routes::Ring;
use crate::editor::routes::carry::Halo;
use crate::editor::theme::{KNOB, Palette, RADIUS};
use crate::editor::widgets::disc;
use crate::marks::{Colour, Mark};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, vec2};
use std::f32::consts::PI;

/// Where a position is drawn on a knob that only moves each pad's own value: the neutral position points upwards.
pub(super) fn around(neutral: f32, position: f32) -> f32 {
    let side = if position < neutral { neutral } else { 1.0 - neutral };
    0.5 + 0.5 * (position - neutral) / side.max(1e-6)
}

/// Contents of a face. Positions are 0 to 1.
pub(crate) struct Face<'a> {
    pub(crate) position: f32,
    /// Start of the arc: the position of the default.
    pub(crate) origin: f32,
    /// Offset of the position by the host's modulation.
    pub(crate) offset: f32,
    /// The modulation by the sound's routes, and the modulated values in the sounding notes.
    pub(crate) ring: &'a Ring<'a>,
    pub(crate) is_hovered: bool,
    pub(crate) is_focused: bool,
}

/// The direction of a position: from lower left over the top to lower right.
fn direction(position: f32) -> Vec2 {
    Vec2::angled(PI * (0.75 + 1.5 * position.clamp(0.0, 1.0)))
}

fn arc(painter: &Painter, centre: Pos2, radius: f32, [from, to]: [f32; 2], stroke: Stroke) {
    // As few lines as look round: a knob's arc is never more than a tenth of a pixel off. Each costs six triangles.
    let steps = 2 + ((to - from).abs() * 22.0 * (radius / (0.5 * KNOB + 1.0)).max(1.0).sqrt()) as usize;
    let point = |step: usize| centre + radius * direction(from + (to - from) * step as f32 / steps as f32);
    painter.add(Shape::line((0..=steps).map(point).collect(), stroke));
}

/// The centre of a mark on the ring around the face in `rect`.
pub(crate) fn on_ring(rect: Rect, position: f32) -> Pos2 {
    rect.center() + (rect.width() / 2.0 + 1.0) * direction(position)
}

/// Paints the marks of the sounding notes: that of the newest note is the largest and on top.
fn paint_marks(painter: &Painter, rect: Rect, marks: &[f32], palette: &Palette) {
    for (place, mark) in marks.iter().enumerate().rev() {
        let (radius, edge) = if place == 0 { (3.2, 1.2) } else { (2.0, 0.8) };
        let centre = on_ring(rect, *mark);
        disc(painter, centre, radius, palette.modulation, Stroke::new(edge, palette.panel));
    }
}

/// Paints how a knob answers a source that is being dragged, around its face in `rect`.
pub(super) fn paint_halo(painter: &Painter, rect: Rect, halo: Halo, palette: &Palette) {
    let radius = rect.width() / 2.0 + 3.0;
    if let Some(edge) = halo_edge(halo, palette) {
        painter.circle(rect.center(), radius, palette.modulation.gamma_multiply(0.18), edge);
    }
}

/// The same for one that is a bar.
pub(super) fn paint_bar_halo(painter: &Painter, rect: Rect, halo: Halo, palette: &Palette) {
    if let Some(edge) = halo_edge(halo, palette) {
        painter.rect_stroke(rect.expand2(vec2(3.0, 0.0)), RADIUS, edge, StrokeKind::Inside);
    }
}

fn halo_edge(halo: Halo, palette: &Palette) -> Option<Stroke> {
    match halo {
        Halo::None | Halo::Closed => None,
        Halo::Open => Some(Stroke::new(1.0, palette.modulation.gamma_multiply(0.6))),
        Halo::Aimed => Some(Stroke::new(2.5, palette.modulation)),
    }
}

/// Paints a knob so small that it only shows where it stands.
pub(crate) fn paint_small(
    painter: &Painter,
    centre: Pos2,
    radius: f32,
    [origin, position]: [f32; 2],
    palette: &Palette,
) {
    arc(painter, centre, radius - 1.0, [0.0, 1.0], Stroke::new(2.0, palette.line));
    if (position - origin).abs() > 1e-4 {
        arc(painter, centre, radius - 1.0, [origin, position], Stroke::new(2.0, palette.accent));
    }
    let along = direction(position);
    painter.line_segment([centre, centre + (radius - 3.0) * along], Stroke::new(1.5, palette.text));
}

/// Paints what the host says of a parameter: a disc for the controller that it is mapped to, and beside it a ring for
/// automation, which is filled while that plays or is recorded; both in the host's colours.
pub(crate) fn paint_mark(painter: &Painter, centre: Pos2, mark: Option<&Mark>, palette: &Palette) {
    let Some(Mark { mapping, automation }) = mark else { return };
    let colour = |colour: Option<Colour>| colour.map_or(palette.text, |[r, g, b]| Color32::from_rgb(r, g, b));
    if let Some(mapping) = mapping {
        painter.circle_filled(centre - vec2(4.0, 0.0), 3.0, colour(mapping.colour));
    }
    if let Some((automation, of)) = automation {
        let place = centre + vec2(4.0, 0.0);
        painter.circle_stroke(place, 2.4, Stroke::new(1.2, colour(*of)));
        if automation.is_running() {
            painter.circle_filled(place, 3.0, colour(*of));
        }
    }
}

pub(crate) fn paint(painter: &Painter, rect: Rect, palette: &Palette, face: &Face) {
    let (centre, radius) = (rect.center(), rect.width() / 2.0);
    let track = if face.is_hovered { palette.muted.gamma_multiply(0.55) } else { palette.line };
    arc(painter, centre, radius - 2.0, [0.0, 1.0], Stroke::new(3.0, track));
    if (face.position - face.origin).abs() > 1e-4 {
        arc(painter, centre, radius - 2.0, [face.origin, face.position], Stroke::new(3.0, palette.accent));
    }
    for range in &face.ring.ranges {
        arc(painter, centre, radius + 1.0, *range, Stroke::new(1.5, palette.modulation));
    }
    painter.circle_filled(centre, radius - 6.5, palette.raised);
    if face.is_focused {
        painter.circle_stroke(centre, radius - 5.5, Stroke::new(1.5, palette.accent));
    }
    let hand = |position: f32, from: f32, stroke: Stroke| {
        let along = direction(position);
        painter.line_segment([centre + from * along, centre + (radius - 7.5) * along], stroke);
    };
    if face.offset.abs() > 1e-4 {
        let modulated = (face.position + face.offset).clamp(0.0, 1.0);
        arc(painter, centre, radius + 1.0, [face.position, modulated], Stroke::new(1.5, palette.modulation));
        painter.circle_filled(on_ring(rect, modulated), 2.2, palette.modulation);
    }
    let colour: Color32 = palette.text;
    hand(face.position, radius * 0.22, Stroke::new(2.0, colour));
    paint_marks(painter, rect, &face.ring.marks, palette);
}

#[cfg(test)]
mod tests {
    use super::around;

    #[test]
    fn the_neutral_position_is_in_the_middle_and_the_ends_stay_within() {
        for (neutral, ends) in [(0.0, [0.5, 1.0]), (1.0, [0.0, 0.5]), (0.25, [0.0, 1.0])] {
            assert_eq!([0.0, 1.0].map(|end| around(neutral, end)), ends, "{neutral}");
            assert_eq!(around(neutral, neutral), 0.5);
        }
    }
}
