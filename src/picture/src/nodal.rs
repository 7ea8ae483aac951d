//! The lines on a body along which a mode does not move.

use crate::form::Form;
use emath::Pos2;
use sprung::sound::bodies::Point;
use std::collections::BTreeMap;

/// Lengths of a dash and of the gap after it, in pixels.
const DASH: [f32; 2] = [4.5, 3.5];
/// What counts as no motion at the edge of a body, as a share of the mode's greatest.
const STILL: f32 = 1e-3;

/// A place between two points of a grid: these, and the share of the way from one to the other.
pub(crate) type Between = ([usize; 2], f32);

/// Whether a mode has such lines.
pub(crate) fn has_any(values: &[f32]) -> bool {
    let most = values.iter().fold(0.0_f32, |most, value| most.max(value.abs()));
    [1.0, -1.0].iter().all(|side| values.iter().any(|value| side * value > 0.02 * most))
}

/// The places along a line where a mode does not move.
pub(crate) fn on_line(values: &[f32]) -> Vec<Between> {
    let values = moving(values, [values.len(), 1], false);
    (1..values.len()).filter_map(|to| crossing(&values, [to - 1, to])).collect()
}

/// The lines on a surface where a mode does not move, as far as they are seen.
pub(crate) fn on_surface(
    form: Form,
    points: &[Point],
    values: &[f32],
    [columns, rows]: [usize; 2],
) -> Vec<Vec<Between>> {
    let is_closed = !matches!(form, Form::Plate { .. });
    let values = moving(values, [columns, rows], is_closed);
    // The lines between the crossings of the edges of each patch.
    let mut next: BTreeMap<[usize; 2], Vec<[usize; 2]>> = BTreeMap::new();
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
        let first = row * columns + column;
        let corners = [first, first + 1, first + columns + 1, first + columns];
        // At the crown of a bell and the bottom of a bowl, they would only meet.
        let is_left_out = (form.is_bell() || form.is_open()) && points[first].x < 0.3;
        if is_left_out || corners.iter().any(|corner| form.is_behind(points[*corner])) {
            continue;
        }
        let edge = |side: usize| {
            let [mut from, mut to] = [corners[side], corners[(side + 1) % 4]];
            // The last row is the first one again.
            if is_closed && from.min(to) >= (rows - 1) * columns {
                [from, to] = [from, to].map(|corner| corner - (rows - 1) * columns);
            }
            [from.min(to), from.max(to)]
        };
        let crossed: Vec<[usize; 2]> = (0..4).map(edge).filter(|edge| crossing(&values, *edge).is_some()).collect();
        for pair in crossed.chunks_exact(2) {
            for (from, to) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                next.entry(from).or_default().push(to);
            }
        }
    }
    let mut lines = Vec::new();
    // Those with an end first; those that remain go round.
    let ends: Vec<[usize; 2]> = next.iter().filter(|(_, to)| to.len() == 1).map(|(from, _)| *from).collect();
    let all: Vec<[usize; 2]> = next.keys().copied().collect();
    for start in ends.into_iter().chain(all) {
        let mut line = vec![start];
        let mut at = start;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            if let Some(back) = next.get_mut(&to) {
                back.retain(|other| *other != at);
            }
            line.push(to);
            at = to;
        }
        if line.len() > 2 {
            lines.push(line.into_iter().filter_map(|edge| crossing(&values, edge)).collect());
        }
    }
    lines
}

/// Cuts a line into dashes.
pub(crate) fn dashed(line: &[Pos2]) -> Vec<Vec<Pos2>> {
    let mut dashes = vec![line.first().copied().into_iter().collect::<Vec<_>>()];
    let (mut is_drawn, mut left) = (true, DASH[0]);
    for ends in line.windows(2) {
        let (mut from, way) = (ends[0], (ends[1] - ends[0]).length());
        let mut rest = way;
        while rest > left {
            from += (ends[1] - ends[0]) * (left / way);
            rest -= left;
            if is_drawn {
                dashes.last_mut().into_iter().for_each(|dash| dash.push(from));
            } else {
                dashes.push(vec![from]);
            }
            is_drawn = !is_drawn;
            left = DASH[usize::from(!is_drawn)];
        }
        left -= rest;
        if is_drawn {
            dashes.last_mut().into_iter().for_each(|dash| dash.push(ends[1]));
        }
    }
    dashes.retain(|dash| dash.len() > 1);
    dashes
}

/// Where a mode changes its side between two points.
fn crossing(values: &[f32], [from, to]: [usize; 2]) -> Option<Between> {
    let [a, b] = [values[from], values[to]];
    ((a < 0.0) != (b < 0.0)).then(|| ([from, to], a / (a - b)))
}

/// The values, with those of an edge that is held replaced by the ones beside them: it is no line of the mode's.
fn moving(values: &[f32], [columns, rows]: [usize; 2], is_closed: bool) -> Vec<f32> {
    let most = values.iter().fold(0.0_f32, |most, value| most.max(value.abs()));
    let inner = |place: usize, count: usize, is_held: bool| match place {
        0 if is_held && count > 1 => 1,
        place if is_held && count > 1 && place + 1 == count => count - 2,
        place => place,
    };
    let value = |number: usize| {
        if values[number].abs() > STILL * most {
            return values[number];
        }
        let (column, row) = (inner(number % columns, columns, true), inner(number / columns, rows, !is_closed));
        values[row * columns + column]
    };
    (0..values.len()).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use emath::pos2;
    use std::f32::consts::TAU;

    #[test]
    fn a_line_has_a_place_between_two_sides_and_none_at_ends_that_are_held() {
        let string: Vec<f32> = (0..=40).map(|point| emath::Vec2::angled(1.5 * TAU * point as f32 / 40.0).y).collect();
        let places: Vec<f32> = on_line(&string).iter().map(|([from, _], share)| *from as f32 + share).collect();
        assert_eq!(places.len(), 2, "{places:?}");
        assert!((places[0] - 40.0 / 3.0).abs() < 0.1 && (places[1] - 80.0 / 3.0).abs() < 0.1, "{places:?}");
        assert!(has_any(&string) && !has_any(&string.iter().map(|value| value.abs()).collect::<Vec<_>>()));
    }

    #[test]
    fn a_disc_has_diameters_and_a_circle() {
        let form = Form::Round;
        let grid = form.grid();
        let points = Form::points(grid);
        let lines = |value: &dyn Fn(&Point) -> f32| {
            on_surface(form, &points, &points.iter().map(value).collect::<Vec<_>>(), grid).len()
        };
        let turned = |point: &Point| emath::Vec2::angled(TAU * 2.0 * point.y as f32 + 0.1);
        assert_eq!(lines(&|point| turned(point).x * point.x as f32), 4, "halves of two diameters");
        assert_eq!(lines(&|point| 0.5 - point.x as f32), 1, "a circle");
        assert_eq!(lines(&|point| 1.0 - point.x as f32), 0, "the held rim");
    }

    #[test]
    fn dashes_cover_more_than_half_of_a_line() {
        let line = [pos2(0.0, 0.0), pos2(30.0, 0.0), pos2(30.0, 50.0)];
        let long: f32 =
            dashed(&line).iter().flat_map(|dash| dash.windows(2).map(|ends| (ends[1] - ends[0]).length())).sum();
        assert!((long / 80.0 - DASH[0] / (DASH[0] + DASH[1])).abs() < 0.06, "{long}");
    }
}
