//! A chart with axes in units, and lines that are clipped at its edges.

use super::colour::{GRID, INK};
use super::{Area, Drawn, text};
use crate::text::number::short;
use libm::{ceil, floor, log10, pow};
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::prelude::*;
use std::ops::Range;

/// An axis: its range, quantity and scale.
#[derive(Clone, Debug)]
pub(crate) struct Axis<'a> {
    /// Smallest and largest value; for a logarithmic axis, their decimal logarithms.
    pub range: Range<f64>,
    /// Its quantity, with the unit. If empty, the axis has no labels.
    pub label: &'a str,
    /// Whether the coordinates of lines are decimal logarithms of the values.
    pub logarithmic: bool,
}

impl<'a> Axis<'a> {
    /// An axis with even steps.
    pub(crate) fn linear(range: Range<f64>, label: &'a str) -> Self {
        Self { range, label, logarithmic: false }
    }

    /// A logarithmic axis; `range` contains decimal logarithms.
    pub(crate) fn logarithmic(range: Range<f64>, label: &'a str) -> Self {
        Self { range, label, logarithmic: true }
    }

    /// About `count` round values, as positions along the axis.
    fn ticks(&self, count: usize) -> Vec<f64> {
        let Range { start, end } = self.range;
        let decades = end - start;
        if self.logarithmic && decades <= 0.6 * count as f64 {
            let digits: &[f64] = if decades <= 0.25 * count as f64 { &[1.0, 2.0, 5.0] } else { &[1.0] };
            let all =
                (floor(start) as i32..=end as i32).flat_map(|n| digits.iter().map(move |d| f64::from(n) + log10(*d)));
            return all.filter(|tick| (start..=end).contains(tick)).collect();
        }
        let least = decades / count.max(1) as f64;
        let unit = pow(10.0, floor(log10(least)));
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|d| d * unit).find(|step| *step >= least).unwrap_or(unit);
        let step = if self.logarithmic { step.max(1.0).round() } else { step };
        (ceil(start / step - 1e-9) as i64..=floor(end / step + 1e-9) as i64).map(|n| n as f64 * step).collect()
    }

    /// The label of a tick. A tick that differs from 0 only by rounding is labelled 0.
    fn name(&self, tick: f64) -> String {
        if self.logarithmic {
            return short(pow(10.0, tick));
        }
        short(if tick.abs() < 1e-9 * (self.range.end - self.range.start) { 0.0 } else { tick })
    }
}

/// A chart to be drawn.
pub(crate) struct Panel<'a> {
    /// Horizontal axis.
    pub x: Axis<'a>,
    /// Vertical axis.
    pub y: Axis<'a>,
    /// Title above the chart.
    pub title: &'a str,
}

/// A coordinate with the ticks chosen here.
pub(crate) struct Ticked {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        from + (share * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// A drawn panel, to which lines can be added.
pub(crate) type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<Ticked, Ticked>>;

impl Panel<'_> {
    /// Draws axes, grid and labels.
    pub(crate) fn draw<'a, B: DrawingBackend>(
        &self,
        area: &'a Area<B>,
    ) -> Result<Chart<'a, B>, DrawingAreaErrorKind<B::ErrorType>> {
        let mut builder = ChartBuilder::on(area);
        builder.margin(6).margin_right(16).y_label_area_size(68);
        builder.x_label_area_size(if self.x.label.is_empty() { 8 } else { 38 });
        if !self.title.is_empty() {
            builder.caption(self.title, text(15));
        }
        let (width, height) = area.dim_in_pixel();
        let ticked = |axis: &Axis, count: u32| Ticked {
            range: axis.range.clone(),
            ticks: axis.ticks(count.clamp(3, 12) as usize),
        };
        let (x, y) = (ticked(&self.x, width.saturating_sub(90) / 60), ticked(&self.y, height.saturating_sub(60) / 28));
        let mut chart = builder.build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(INK)
            .label_style(text(12))
            .axis_desc_style(text(13))
            .x_labels(if self.x.label.is_empty() { 0 } else { 50 })
            .y_labels(50)
            .x_label_formatter(&|tick| self.x.name(*tick))
            .y_label_formatter(&|tick| self.y.name(*tick))
            .x_desc(self.x.label)
            .y_desc(self.y.label)
            .draw()?;
        Ok(chart)
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    /// Its colour.
    pub colour: RGBColor,
    /// Width in pixels.
    pub width: u32,
    /// Whether it is dashed.
    pub dashed: bool,
}

/// Draws a line through `points`, as far as it lies within the axes.
pub(crate) fn line<B: DrawingBackend>(chart: &mut Chart<B>, points: &[(f64, f64)], stroke: Stroke) -> Drawn<B> {
    let (x, y) = (chart.x_range(), chart.y_range());
    let style = stroke.colour.stroke_width(stroke.width);
    for piece in clipped(points, &x, &y) {
        if stroke.dashed {
            chart.draw_series(DashedLineSeries::new(piece, 6, 4, style))?;
        } else {
            chart.draw_series(LineSeries::new(piece, style))?;
        }
    }
    Ok(())
}

/// The pieces of a polyline within a rectangle. A point that is not a number ends a piece.
pub(crate) fn clipped(points: &[(f64, f64)], x: &Range<f64>, y: &Range<f64>) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut joined = false;
    for pair in points.windows(2) {
        let Some((from, to)) = clip(pair[0], pair[1], x, y) else {
            joined = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if joined => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        joined = to == pair[1];
    }
    pieces
}

/// The part of a segment within a rectangle (Liang & Barsky 1984).
fn clip(from: (f64, f64), to: (f64, f64), x: &Range<f64>, y: &Range<f64>) -> Option<((f64, f64), (f64, f64))> {
    if ![from.0, from.1, to.0, to.1].iter().all(|value| value.is_finite()) {
        return None;
    }
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, distance) in
        [(-dx, from.0 - x.start), (dx, x.end - from.0), (-dy, from.1 - y.start), (dy, y.end - from.1)]
    {
        if step == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if step < 0.0 {
            enter = enter.max(distance / step);
        } else {
            leave = leave.min(distance / step);
        }
    }
    let at = |share: f64| (from.0 + share * dx, from.1 + share * dy);
    let end = |share: f64| if share == 1.0 { to } else { at(share) };
    (enter <= leave).then(|| (if enter == 0.0 { from } else { at(enter) }, end(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_frame_and_come_back_in() {
        let (x, y) = (0.0..10.0, -1.0..1.0);
        let pieces = clipped(&[(0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (5.0, 0.5), (6.0, f64::NAN), (7.0, 0.0)], &x, &y);
        assert_eq!(pieces, [vec![(0.0, 0.0), (1.0, 1.0)], vec![(3.0, 1.0), (4.0, 0.0), (5.0, 0.5)]]);
        assert!(clipped(&[(0.0, 3.0), (9.0, 2.0)], &x, &y).is_empty());
        assert_eq!(clipped(&[(5.0, -9.0), (5.0, 9.0)], &x, &y), [vec![(5.0, -1.0), (5.0, 1.0)]]);
    }

    #[test]
    fn ticks_are_round_and_few() {
        let linear = |range| Axis::linear(range, "");
        assert_eq!(linear(0.0..5.0).ticks(5), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(linear(-0.11..0.11).ticks(4), [-0.1, 0.0, 0.1]);
        assert_eq!(linear(-3e-16..3e-16).ticks(4), [-2e-16, 0.0, 2e-16]);
        let named = |range, count| {
            let axis = Axis::logarithmic(range, "");
            axis.ticks(count).into_iter().map(|tick| axis.name(tick)).collect::<Vec<_>>()
        };
        assert_eq!(named(1.3..4.3, 12), ["20", "50", "100", "200", "500", "1000", "2000", "5000", "10000"]);
        assert_eq!(named(-4.0..-1.9, 4), ["0.0001", "0.001", "0.01"]);
        assert_eq!(named(-16.0..0.0, 8), ["1e−16", "1e−14", "1e−12", "1e−10", "1e−8", "1e−6", "0.0001", "0.01", "1"]);
        assert_eq!(linear(-1.0..1.0).name(-5.6e-17), "0");
    }
}
