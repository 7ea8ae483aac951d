//! What moves the body, where it acts: a mallet, a plectrum, a bow, a mouthpiece.

use crate::editor::controls::Controls;
use crate::editor::theme::Palette;
use egui::epaint::Mesh;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use sprung::params::Param;
use sprung::sound::bodies::Point;
use sprung_picture::{Form, tint};
use std::f32::consts::TAU;

/// The exciters that are drawn; noise and incoming sound have no place.
const DRAWN: [Param; 4] = [Param::MalletLevel, Param::PluckLevel, Param::BowLevel, Param::BreathLevel];
/// Seconds after which what has struck is back where it rests.
const BACK: f32 = 0.35;
/// Strokes of a bow in a second, and how far it goes, as a share of its length.
const STROKES: f32 = 0.4;
const STROKE: f32 = 0.14;
/// The smallest and the largest head of a mallet, as a multiple of that of a usual mass.
const LIGHTEST: f32 = 0.7;
const HEAVIEST: f32 = 1.5;
/// Corners of a mallet's head.
const CORNERS: u32 = 24;
/// Space between a place and what touches it: the ring around the place is in between.
const RING: f32 = 7.0;

/// Paints the exciter that acts most, if it is drawn, at the place `strike` of a body at rest, or at a usual one. It moves only while a
/// note sounds.
pub(super) fn paint(painter: &Painter, rect: Rect, form: Form, strike: Option<Point>, controls: &Controls) {
    let Some(most) = acting(controls) else { return };
    let at = form.on(rect, strike.unwrap_or(usual(form)), 0.0);
    let age = controls.notes.first().map(|note| note.age).filter(|_| !controls.params.view().less_motion);
    let away = age.map_or(1.0, away);
    let size = (0.045 * rect.height()).clamp(5.0, 14.0);
    // From the left below, where bells and bowls are seen from the side, and otherwise from above.
    let is_upright = matches!(form, Form::Bell | Form::HandBell | Form::Bowl | Form::Glass);
    let from = if is_upright { vec2(-0.85, 0.53) } else { vec2(-0.42, -0.91) };
    let palette = controls.palette;
    match most {
        Param::MalletLevel => {
            let [hardness, mass] = [Param::MalletHardness, Param::MalletMass].map(|param| controls.heard(param.info()));
            let size = size * mass.sqrt().clamp(LIGHTEST, HEAVIEST);
            let head = at + (size + RING + 1.6 * size * away) * from;
            mallet(painter, head, from, (size, (hardness / 100.0).clamp(0.0, 1.0)), palette);
        }
        Param::PluckLevel => plectrum(painter, at + (RING + 1.2 * size * away) * from, from, 2.4 * size, palette),
        Param::BowLevel => {
            let (along, length) = match form {
                Form::Line | Form::Rod => (Vec2::angled(-0.18 * TAU), 0.4 * rect.height()),
                _ => (Vec2::angled(-0.06 * TAU), (0.36 * rect.width()).min(0.7 * rect.height())),
            };
            let moved = age.map_or(0.0, |age| STROKE * length * Vec2::angled(TAU * STROKES * age).y);
            bow(painter, at + moved * along, along * length, size, palette);
        }
        _ if form.is_line() => {
            let end = form.on(rect, Point { x: 0.0, y: 0.0 }, 0.0);
            let length = (end.x - rect.left()).min(3.5 * size);
            mouthpiece(painter, end, vec2(length, size), palette);
        }
        _ => {}
    }
}

/// How far what has struck so many seconds ago is on its way to where it rests.
fn away(age: f32) -> f32 {
    let share = (age / BACK).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// The loudest exciter of those that are drawn and on.
fn acting(controls: &Controls) -> Option<Param> {
    let level = |param: &Param| controls.heard(param.info());
    let is_on = |param: &Param| level(param) > param.info().min;
    // Of equals the first.
    DRAWN.into_iter().rev().filter(is_on).max_by(|one, other| level(one).total_cmp(&level(other)))
}

/// Where a body is struck whose sound knows no place.
fn usual(form: Form) -> Point {
    match form {
        Form::Line | Form::Rod | Form::Plate { .. } => Point { x: 0.5, y: 0.5 },
        Form::Round | Form::Cymbal | Form::Gong => Point { x: 0.35, y: 0.0 },
        Form::Bell | Form::HandBell | Form::Bowl | Form::Glass => Point { x: 0.85, y: 0.0 },
    }
}

/// A colour of a material as it is seen in a light from 0 to 2, where 1 shows it as it is.
fn shade(material: &str, light: f32) -> Color32 {
    let towards = if light < 1.0 { Color32::BLACK } else { Color32::WHITE };
    tint(material).lerp_to_gamma(towards, (light - 1.0).abs())
}

/// A head at the end of a stick of wood: of felt if its hardness is 0, of steel if that is 1.
fn mallet(painter: &Painter, head: Pos2, from: Vec2, (size, hardness): (f32, f32), palette: &Palette) {
    let colour = |light: f32| shade("skin", light).lerp_to_gamma(shade("steel", light), hardness);
    let stick = [head, head + 9.0 * size * from];
    painter.line_segment(stick, Stroke::new(0.34 * size + 1.5, shade("maple", 0.45)));
    painter.line_segment(stick, Stroke::new(0.34 * size, shade("maple", 1.0)));
    let mut ball = Mesh::default();
    ball.colored_vertex(head - vec2(0.3, 0.35) * size, colour(1.15 + 0.4 * hardness));
    for corner in 0..CORNERS {
        let out = Vec2::angled(TAU * corner as f32 / CORNERS as f32);
        // Lit from the left above.
        let light = 0.62 - 0.2 * (out.x + out.y);
        ball.colored_vertex(head + size * out, colour(light));
        ball.add_triangle(0, 1 + corner, 1 + (corner + 1) % CORNERS);
    }
    painter.add(ball);
    painter.circle_stroke(head, size, Stroke::new(1.0, palette.line));
}

fn plectrum(painter: &Painter, tip: Pos2, from: Vec2, size: f32, palette: &Palette) {
    let across = from.rot90();
    let corner = |[up, aside]: [f32; 2]| tip + size * (up * from + aside * across);
    let outline =
        [[0.0, 0.0], [0.6, 0.38], [0.85, 0.42], [1.0, 0.26], [1.05, 0.0], [1.0, -0.26], [0.85, -0.42], [0.6, -0.38]];
    let edge = Stroke::new(1.0, palette.line);
    painter.add(Shape::convex_polygon(outline.map(corner).to_vec(), shade("rosewood", 1.15), edge));
}

/// A bow whose hair lies on the middle, half of it to each side.
fn bow(painter: &Painter, middle: Pos2, half: Vec2, size: f32, palette: &Palette) {
    let up = half.rot90().normalized() * if half.x * half.y > 0.0 { 1.0 } else { -1.0 };
    let place = |along: f32, above: f32| middle + along * half - above * size * up;
    let hair = Stroke::new(2.0, shade("nylon", 1.0));
    painter.line_segment([place(-1.0, 0.0), place(1.0, 0.0)], hair);
    // The stick bends towards the hair, which a frog holds off it at one end.
    let stick = (0..=16).map(|step| {
        let along = -1.08 + 2.08 * step as f32 / 16.0;
        place(along, 0.55 + 0.45 * along * along)
    });
    let stick: Vec<Pos2> = stick.collect();
    painter.add(Shape::line(stick.clone(), Stroke::new(0.3 * size + 1.5, palette.line)));
    painter.add(Shape::line(stick, Stroke::new(0.3 * size, shade("rosewood", 1.1))));
    let frog = [[-1.0, 0.0], [-0.86, 0.0], [-0.86, 0.9], [-1.0, 0.95]].map(|[along, above]| place(along, above));
    painter.add(Shape::convex_polygon(frog.to_vec(), shade("rubber", 0.7), Stroke::new(1.0, palette.line)));
}

/// A mouthpiece at the left end of a tube, with the lip of its reed below.
fn mouthpiece(painter: &Painter, end: Pos2, size: Vec2, palette: &Palette) {
    let place = |[x, y]: [f32; 2]| end + vec2(-x * size.x, y * size.y);
    let beak = [[0.0, -0.75], [0.0, 0.75], [1.0, 0.62], [1.0, 0.38]].map(place);
    painter.add(Shape::convex_polygon(beak.to_vec(), shade("rubber", 1.15), Stroke::new(1.0, palette.muted)));
    painter.line_segment([[0.1, 0.82], [1.0, 0.68]].map(place), Stroke::new(2.0, shade("maple", 1.0)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_strikes_touches_and_goes_back() {
        assert_eq!([0.0, BACK, 9.0].map(away), [0.0, 1.0, 1.0]);
        let ways: Vec<f32> = (0..20).map(|step| away(0.02 * step as f32)).collect();
        assert!(ways.is_sorted() && ways[3] < 0.2);
    }
}
