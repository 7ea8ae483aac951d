//! Draws a strike: its spectrum with the modes, the spectrum of the residual, and the decay of the modes over frequency.

use crate::analysis::modes::{Mode, Strike};
use crate::analysis::spectrum::{Spectrum, spectrum};
use crate::figure::colour::{BLUE, INK, VERMILLION};
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, text};
use libm::{ceil, floor, log10, pow};
use plotters::prelude::*;

/// Number of columns into which the bins of a spectrum are gathered.
const COLUMNS: usize = 900;
/// Lowest frequency in Hz.
const LOWEST: f64 = 20.0;
/// Range of levels in dB.
const SPAN_DB: f64 = 120.0;

/// The figure of a strike.
pub struct ModesFigure<'a> {
    /// Its title.
    pub title: &'a str,
    /// The strike.
    pub strike: &'a Strike,
    /// Hz.
    pub sample_rate: f64,
}

impl Picture for ModesFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1280, 860)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text(self.title, &text(20), (20, 12))?;
        let (_, body) = area.split_vertically(46);
        let (plots, key) = body.split_horizontally(1060);
        let (upper, lower) = plots.split_vertically(480);
        let high = log10(0.5 * self.sample_rate);
        let x = log10(LOWEST).min(high - 1.0)..high;
        let sound = spectrum(&self.strike.samples, self.sample_rate);
        let residual = spectrum(&self.strike.residual, self.sample_rate);
        let loudest = sound.levels.iter().copied().fold(-300.0, f64::max);
        // A decaying mode has a higher level at the onset than in the spectrum, which shows its mean over time.
        let strongest = self.strike.modes.iter().map(|mode| mode.level_db).fold(-300.0, f64::max);
        let top = 10.0 * ceil(loudest.max(strongest) / 10.0);
        let levels = Panel {
            x: Axis::logarithmic(x.clone(), ""),
            y: Axis::linear(top - SPAN_DB..top, "level / dBFS"),
            title: "",
        };
        let mut chart = levels.draw(&upper)?;
        for (spectrum, colour) in [(&sound, BLUE), (&residual, VERMILLION)] {
            line(&mut chart, &outline(spectrum, &x), Stroke { colour, width: 1, dashed: false })?;
        }
        let modes = &self.strike.modes;
        let place = |mode: &Mode| (log10(mode.frequency), mode.level_db.max(top - SPAN_DB));
        chart.draw_series(modes.iter().map(|mode| Circle::new(place(mode), 4, INK.stroke_width(1))))?;

        let decays = || modes.iter().map(|mode| log10(mode.t60)).filter(|decay| decay.is_finite());
        let (least, most) = decays().fold((0.0_f64, 0.0_f64), |(least, most), t60| (least.min(t60), most.max(t60)));
        let decay = Panel {
            x: Axis::logarithmic(x, "frequency / Hz"),
            y: Axis::logarithmic(floor(least * 2.0) / 2.0 - 0.1..ceil(most * 2.0) / 2.0 + 0.1, "T60 / s"),
            title: "",
        };
        let mut chart = decay.draw(&lower)?;
        for mode in modes.iter().filter(|mode| mode.t60.is_finite()) {
            let at = |deviations: f64| {
                (log10(mode.frequency), log10((mode.t60 + deviations * mode.uncertainty.t60).max(1e-3 * mode.t60)))
            };
            let stroke = Stroke { colour: BLUE, width: 1, dashed: false };
            line(&mut chart, &[at(-1.0), at(1.0)], stroke)?;
            let size = (7.0 + (mode.level_db - strongest) / 10.0).clamp(2.0, 7.0) as i32;
            chart.draw_series([Circle::new(at(0.0), size, BLUE.filled())])?;
        }
        let remarks = [
            (BLUE, "spectrum of the whole:"),
            (BLUE, "brief modes vanish in it"),
            (VERMILLION, "what is left of it"),
            (INK, ""),
            (INK, "circles: levels of"),
            (INK, "modes at the onset"),
            (INK, ""),
            (INK, "below, the larger"),
            (INK, "the louder; lines:"),
            (INK, "standard deviation"),
        ];
        for (n, (colour, remark)) in remarks.into_iter().enumerate() {
            key.draw_text(remark, &text(14).color(&colour), (12, 40 + 22 * n as i32))?;
        }
        Ok(())
    }
}

/// The loudest bin of each column of a logarithmic axis.
fn outline(spectrum: &Spectrum, x: &std::ops::Range<f64>) -> Vec<(f64, f64)> {
    let edge = |column: usize| x.start + (x.end - x.start) * column as f64 / COLUMNS as f64;
    let last = spectrum.levels.len() - 1;
    let bin = |position: f64| ((pow(10.0, position) / spectrum.bin_width) as usize).min(last);
    let loudest = |column: usize| {
        let (from, to) = (bin(edge(column)), bin(edge(column + 1)));
        let level = spectrum.levels[from..=to].iter().copied().fold(-300.0, f64::max);
        (edge(column), level)
    };
    (0..COLUMNS).map(loudest).collect()
}
