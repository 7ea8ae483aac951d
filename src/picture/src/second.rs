//! The body that is joined to another: where the two of them stand, and the spring between them.

use crate::figure::Figure;
use emath::{Pos2, Rect, Vec2, pos2, vec2};
use std::f32::consts::TAU;

/// Pixels from turn to turn of the spring, and points of a turn.
const TURN: f32 = 5.0;
const STEPS: usize = 10;
/// Share of the spring that is straight at each end.
const STRAIGHT: f32 = 0.1;

/// Width of the second body's picture.
fn side(rect: Rect) -> f32 {
    (0.19 * rect.width()).min(0.5 * rect.height())
}

/// Where the first body is: as near to the middle as the second one lets it.
pub(crate) fn first_place(rect: Rect, figure: &Figure) -> Rect {
    if figure.second.is_none() {
        return rect;
    }
    let taken = 1.45 * side(rect);
    let room = rect.with_max_x(rect.right() - taken);
    let half = figure.form.half_width() * figure.form.view(room).unit;
    let middle = rect.center().x.min(rect.right() - taken - half);
    Rect::from_center_size(pos2(middle, rect.center().y), room.size())
}

/// Where the second body is.
pub(crate) fn second_place(rect: Rect) -> Rect {
    let size = vec2(side(rect), 0.72 * side(rect));
    Rect::from_min_size(rect.right_bottom() - size, size)
}

/// What joins them, from end to end.
pub(crate) fn joint(from: Pos2, to: Pos2, thickness: f32, is_rigid: bool) -> Vec<Pos2> {
    let way = to - from;
    let turns = ((1.0 - 2.0 * STRAIGHT) * way.length() / TURN).round() as usize;
    if is_rigid || turns == 0 {
        return vec![from, to];
    }
    let (along, across) = (way.normalized(), way.normalized().rot90());
    let coil = |step: usize| {
        let share = STRAIGHT + (1.0 - 2.0 * STRAIGHT) * step as f32 / (turns * STEPS) as f32;
        let turn = thickness * (Vec2::angled(TAU * step as f32 / STEPS as f32) - Vec2::X);
        from + share * way + 0.45 * turn.x * along + turn.y * across
    };
    std::iter::once(from).chain((0..=turns * STEPS).map(coil)).chain([to]).collect()
}
