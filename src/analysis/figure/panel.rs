//! The parts that figures are made of: a waveform over time, a spectrogram over time, a scale of colours.

use crate::analysis::spectrum::spectrogram;
use crate::figure::colour::{BLUE, GRID, INK, VERMILLION, viridis};
use crate::figure::{Area, Drawn, envelope::envelope, text};
use crate::text::number::short;
use libm::pow;
use plotters::prelude::*;

/// Range in dB that the colours of a spectrogram span, down from [`top_level`].
const SPAN_DB: f64 = 100.0;
/// Lowest level at which the colours end, as of silence.
pub(super) const QUIETEST_DB: f64 = -160.0;
/// Width in pixels to the left of every panel's axis, so that time axes line up.
const LABEL_WIDTH: u32 = 84;
/// Space in pixels around the labels at the left edge, whose letters reach a little beyond their area.
const LEFT_MARGIN: u32 = 14;
/// Width in pixels to the right of every panel, which a spectrogram uses for its scale of colours.
pub(super) const RIGHT_MARGIN: u32 = 110;

/// A signal in a waveform panel.
pub(super) struct Trace<'a> {
    /// Its name in the right margin; may be empty.
    pub(super) name: &'a str,
    pub(super) samples: &'a [f32],
    pub(super) colour: RGBColor,
}

/// What the waveforms of a stereo sound show: each channel, or one if both are the same.
pub(super) fn channels<'a>([left, right]: [&'a [f32]; 2]) -> Vec<Trace<'a>> {
    let trace = |name, samples, colour| Trace { name, samples, colour };
    if left == right {
        vec![trace("both", left, BLUE)]
    } else {
        vec![trace("left", left, BLUE), trace("right", right, VERMILLION)]
    }
}

/// Half the range of a waveform's axis that shows some signals.
pub(super) fn waveform_range<'a>(signals: impl IntoIterator<Item = &'a [f32]>) -> f64 {
    let finite = |sample: &f32| if sample.is_finite() { f64::from(sample.abs()) } else { 0.0 };
    let peak = signals.into_iter().flatten().map(finite).fold(0.0, f64::max);
    if peak > 0.0 { 1.08 * peak } else { 1.0 }
}

/// Draws a signal over the time of so many frames, with `label` at the vertical axis, which reaches from `-range` to `range`.
/// Wherever several samples share a pixel, the trace spans all of them.
pub(super) fn waveform<B: DrawingBackend>(
    area: &Area<B>,
    Trace { name, samples, colour }: &Trace,
    frames: usize,
    sample_rate: f64,
    label: &str,
    range: f64,
) -> Drawn<B> {
    let seconds = frames.max(2) as f64 / sample_rate;
    let (width, height) = area.dim_in_pixel();
    let mut chart = ChartBuilder::on(area)
        .margin_right(RIGHT_MARGIN)
        .margin_top(10)
        .margin_left(LEFT_MARGIN)
        .y_label_area_size(LABEL_WIDTH)
        .x_label_area_size(12)
        .build_cartesian_2d(0.0..seconds, -range..range)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(text(16))
        .axis_desc_style(text(18))
        .x_labels(0)
        .y_labels((height as usize / 20).clamp(3, 11))
        .y_label_formatter(&|y| {
            if y.abs() < 1e-9 * range || range > 0.01 { trimmed((y * 1e6).round() / 1e6) } else { format!("{y:.1e}") }
        })
        .y_desc(label)
        .draw()?;
    let (columns, _) = chart.plotting_area().dim_in_pixel();
    let share = samples.len() as f64 / (seconds * sample_rate);
    let points = envelope(samples, sample_rate, (f64::from(columns) * share) as usize);
    chart.draw_series(LineSeries::new(points, colour.stroke_width(1)))?;
    area.draw_text(name, &text(16).color(colour), ((width - RIGHT_MARGIN + 18) as i32, 12))?;
    Ok(())
}

/// Samples of a transform for a spectrogram: about 80 ms resolve the partials of a bass note and still show a strike as a vertical edge.
fn length(sample_rate: f64) -> usize {
    ((0.08 * sample_rate) as usize).next_power_of_two()
}

/// The level in dB at which the colours of a signal's spectrogram end: that of its loudest bin, rounded up to ten.
pub(super) fn top_level(samples: &[f32], sample_rate: f64) -> f64 {
    let grams = spectrogram(samples, sample_rate, length(sample_rate), length(sample_rate) / 8);
    10.0 * (grams.columns.iter().flatten().copied().fold(QUIETEST_DB, f64::max) / 10.0).ceil()
}

/// Draws a signal's spectrogram, 30 Hz (or less, at low rates) to Nyquist on a logarithmic axis, in cells of `cell`
/// pixels, with its scale of colours to the right, down from `top_level` in dB.
pub(super) fn spectrogram_panel<B: DrawingBackend>(
    area: &Area<B>,
    samples: &[f32],
    sample_rate: f64,
    cell: usize,
    top_level: f64,
) -> Drawn<B> {
    let seconds = samples.len().max(2) as f64 / sample_rate;
    let (low, high) = (30.0_f64.min(0.01 * sample_rate), sample_rate / 2.0);
    let ticks: Vec<f64> = [1.0, 2.0, 5.0]
        .iter()
        .flat_map(|first| (1..6).map(move |power| first * pow(10.0, f64::from(power))))
        .filter(|frequency| (low..=high).contains(frequency))
        .collect();
    let mut chart = ChartBuilder::on(area)
        .margin_right(RIGHT_MARGIN)
        .margin_top(10)
        .margin_left(LEFT_MARGIN)
        .y_label_area_size(LABEL_WIDTH)
        .x_label_area_size(52)
        .build_cartesian_2d(0.0..seconds, (low..high).log_scale().with_key_points(ticks))?;
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(INK)
        .label_style(text(16))
        .axis_desc_style(text(18))
        .x_labels(11)
        .x_label_formatter(&|t| trimmed(*t))
        .y_label_formatter(&|f| if *f < 1000.0 { trimmed(*f) } else { format!("{} k", trimmed(f / 1000.0)) })
        .x_desc("time / s")
        .y_desc("frequency / Hz")
        .draw()?;
    let cells = chart.plotting_area().strip_coord_spec();
    let (width, height) = cells.dim_in_pixel();
    let (width, height) = (width as usize, height as usize);
    let hop = (samples.len() * cell / width.max(1)).max(1);
    let grams = spectrogram(samples, sample_rate, length(sample_rate), hop);
    for y in (0..height).step_by(cell) {
        let frequency = |edge: usize| high * pow(low / high, edge as f64 / height as f64);
        let (top, bottom) = (frequency(y), frequency(y + cell));
        for x in (0..width).step_by(cell) {
            let column = (x as f64 / width as f64 * seconds / grams.hop_seconds) as usize;
            let Some(levels) = grams.columns.get(column) else { continue };
            let level = level_between(levels, bottom / grams.bin_width, top / grams.bin_width);
            let colour = viridis(1.0 + (level - top_level) / SPAN_DB);
            let corner = (x as i32, y as i32);
            let opposite = ((x + cell).min(width) as i32, (y + cell).min(height) as i32);
            if cell == 1 {
                cells.draw_pixel(corner, &colour)?;
            } else {
                cells.draw(&Rectangle::new([corner, opposite], colour.filled()))?;
            }
        }
    }
    scale_of_colours(area, height, top_level)
}

/// The loudest bin between two fractional bins, or the level interpolated where they are closer than a bin.
fn level_between(levels: &[f64], low: f64, high: f64) -> f64 {
    let last = levels.len() - 1;
    let interpolated = |bin: f64| {
        let index = (bin as usize).min(last.saturating_sub(1));
        levels[index] + (bin - index as f64).clamp(0.0, 1.0) * (levels[(index + 1).min(last)] - levels[index])
    };
    let first = (low.ceil() as usize).min(last);
    let end = (high.ceil() as usize).clamp(first, last + 1);
    levels[first..end].iter().fold(interpolated((low + high) / 2.0), |most, level| most.max(*level))
}

/// A bar of all colours with their levels, in the right margin of `area`.
fn scale_of_colours<B: DrawingBackend>(area: &Area<B>, height: usize, top_level: f64) -> Drawn<B> {
    let (width, _) = area.dim_in_pixel();
    let (left, top, height) = ((width - RIGHT_MARGIN + 18) as i32, 10, height as i32);
    for y in 0..height {
        let colour = viridis(1.0 - f64::from(y) / f64::from(height));
        area.draw(&Rectangle::new([(left, top + y), (left + 16, top + y + 1)], colour.filled()))?;
    }
    for position in (0..=5).map(|step| f64::from(step) / 5.0) {
        let level = top_level - position * SPAN_DB;
        let y = top + (position * f64::from(height - 16)) as i32;
        area.draw_text(&format!("{level:.0} dB"), &text(15), (left + 22, y))?;
    }
    Ok(())
}

/// The text of a tick. Ticks are sums of steps, so that the tick at zero may be a small rounding error.
fn trimmed(tick: f64) -> String {
    short(if tick.abs() < 1e-12 { 0.0 } else { tick })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_peak_is_not_lost_between_pixels() {
        let levels = [-100.0, -100.0, -3.0, -100.0, -100.0];
        assert_eq!(level_between(&levels, 0.5, 3.9), -3.0);
        assert!((level_between(&levels, 1.4, 1.6) + 51.5).abs() < 1e-9);
        assert_eq!(level_between(&levels, 9.0, 12.0), -100.0);
    }
}
