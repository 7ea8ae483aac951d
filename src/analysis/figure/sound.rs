//! Draws a sound: its waveform, its spectrogram, and its modes, if they are known.

use super::Render;
use super::panel::{QUIETEST_DB, channels, spectrogram_panel, top_level, waveform, waveform_range};
use crate::analysis::level::mono;
use crate::figure::colour::{BLUE, INK, VERMILLION};
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, png, svg, text};
use crate::patch::Patch;
use libm::{ceil, floor, log10, pow};
use plotters::prelude::*;

/// Lowest frequency in Hz of the modes' axis.
const LOWEST: f64 = 20.0;
/// Range of levels in dB.
const SPAN_DB: f64 = 80.0;
/// Height in pixels of the panels of a waveform, the spectrogram and the modes.
const WAVEFORM: u32 = 180;
const SPECTROGRAM: u32 = 520;
const MODES: u32 = 320;
/// Width in pixels of the remarks beside the modes.
const REMARKS: u32 = 230;

/// A mode as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnMode {
    /// Hz.
    pub frequency: f64,
    /// dB, relative to any level that is the same for all modes.
    pub level_db: f64,
    /// Seconds.
    pub t60: f64,
    /// Whether noise excites it, and not the strike.
    pub is_noisy: bool,
}

/// The modes of a patch for a note of a frequency in Hz, with the patch's own tilts. Allocates.
pub fn modes_of(patch: &Patch, frequency: f64) -> Vec<DrawnMode> {
    use crate::params::Param::{Decay, DecayTilt, Fine, KeyTrack, Stretch, Tilt, Tune};
    let value = |param| f64::from(patch.get(param));
    let moved = pow(2.0, (value(Tune) + 0.01 * value(Fine)) / 12.0);
    let middle = crate::sound::bodies::DEFAULT_FREQUENCY;
    let note = moved * middle * pow(frequency / middle, 0.01 * value(KeyTrack));
    let mode = |mode: &crate::patch::Mode| {
        let ratio = f64::from(mode.ratio);
        DrawnMode {
            frequency: note * pow(ratio, value(Stretch)),
            level_db: 20.0 * log10(f64::from(mode.level.abs()).max(1e-9)) + value(Tilt) * libm::log2(ratio),
            t60: value(Decay) * f64::from(mode.decay) * pow(ratio, -value(DecayTilt)),
            is_noisy: mode.strike < 0.5,
        }
    };
    patch.modes.as_slice().iter().map(mode).collect()
}

/// Ranges of a figure's axes, so that several figures can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Half the range of a waveform.
    waveform: f64,
    /// The level in dB at which the colours of the spectrogram end.
    top_level: f64,
}

impl Ranges {
    /// The ranges that show all of some sounds, of which there is at least one.
    pub fn of(renders: &[Render]) -> Self {
        let level = |render: &Render| top_level(&mono(&[render.left, render.right]), render.sample_rate);
        Self {
            waveform: waveform_range(renders.iter().flat_map(|render| [render.left, render.right])),
            top_level: renders.iter().map(level).fold(QUIETEST_DB, f64::max),
        }
    }
}

/// The figure of a sound.
pub struct SoundFigure<'a> {
    /// Its title.
    pub title: &'a str,
    /// The sound.
    pub render: Render<'a>,
    /// Its modes; without any there is no panel for them.
    pub modes: &'a [DrawnMode],
    /// Ranges of its axes.
    pub ranges: Ranges,
    /// Pixels per cell of the spectrogram: 1 for an image of pixels, more for a vector image.
    pub cell: usize,
}

impl SoundFigure<'_> {
    /// The figure as a file in `format`, `png` or `svg`.
    ///
    /// # Errors
    /// [`Error::Format`](crate::Error::Format) if it cannot be drawn.
    pub fn bytes(&self, format: &str) -> crate::Result<Vec<u8>> {
        if format == "svg" { svg(self).map(String::into_bytes) } else { png(self) }
    }
}

impl Picture for SoundFigure<'_> {
    fn size(&self) -> (u32, u32) {
        let waveforms = WAVEFORM * channels([self.render.left, self.render.right]).len() as u32;
        (1600, 46 + waveforms + SPECTROGRAM + if self.modes.is_empty() { 0 } else { MODES })
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text(self.title, &text(24), (20, 14))?;
        let (_, body) = area.split_vertically(46);
        let Render { left, right, sample_rate } = self.render;
        let traces = channels([left, right]);
        let (upper, rest) = body.split_vertically(WAVEFORM * traces.len() as u32);
        let (middle, lower) = rest.split_vertically(SPECTROGRAM);
        for (trace, strip) in traces.iter().zip(upper.split_evenly((traces.len(), 1))) {
            waveform(&strip, trace, left.len(), sample_rate, "sound", self.ranges.waveform)?;
        }
        spectrogram_panel(&middle, &mono(&[left, right]), sample_rate, self.cell, self.ranges.top_level)?;
        if self.modes.is_empty() { Ok(()) } else { self.draw_modes(&lower) }
    }
}

impl SoundFigure<'_> {
    fn draw_modes<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        let (width, _) = area.dim_in_pixel();
        let (plots, key) = area.split_horizontally(width - REMARKS);
        let [levels, decays] = [0, 1].map(|n| plots.split_evenly((1, 2)).swap_remove(n));
        let x = || Axis::logarithmic(log10(LOWEST)..log10(0.5 * self.render.sample_rate).max(3.0), "frequency / Hz");
        let loudest = self.modes.iter().map(|mode| mode.level_db).fold(-300.0, f64::max);
        let top = 10.0 * ceil((loudest + 1.0) / 10.0);
        let y = Axis::linear(top - SPAN_DB..top, "level / dB");
        let mut chart = Panel { x: x(), y, title: "" }.draw(&levels)?;
        for mode in self.modes {
            let at = log10(mode.frequency.max(1e-3));
            let stroke = Stroke { colour: colour(mode), width: 2, dashed: false };
            line(&mut chart, &[(at, top - SPAN_DB), (at, mode.level_db)], stroke)?;
        }
        let times = || self.modes.iter().map(|mode| log10(mode.t60.max(1e-3)));
        let (least, most) = times().fold((0.0_f64, 0.0_f64), |(least, most), t60| (least.min(t60), most.max(t60)));
        let y = Axis::logarithmic(floor(least * 2.0) / 2.0 - 0.1..ceil(most * 2.0) / 2.0 + 0.1, "T60 / s");
        let mut chart = Panel { x: x(), y, title: "" }.draw(&decays)?;
        let (x_range, y_range) = (chart.x_range(), chart.y_range());
        for mode in self.modes {
            let at = (log10(mode.frequency.max(1e-3)), log10(mode.t60.max(1e-3)));
            if x_range.contains(&at.0) && y_range.contains(&at.1) {
                let size = (7.0 + (mode.level_db - loudest) / 10.0).clamp(2.0, 7.0) as i32;
                chart.draw_series([Circle::new(at, size, colour(mode).filled())])?;
            }
        }
        let remarks =
            [(BLUE, "modes that are struck"), (VERMILLION, "modes that noise moves"), (INK, "larger: louder")];
        for (n, (colour, remark)) in remarks.into_iter().enumerate() {
            key.draw_text(remark, &text(14).color(&colour), (12, 40 + 22 * n as i32))?;
        }
        Ok(())
    }
}

fn colour(mode: &DrawnMode) -> RGBColor {
    if mode.is_noisy { VERMILLION } else { BLUE }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;

    #[test]
    fn modes_are_where_the_patch_has_them() {
        let patch = Patch::default().with(Param::Tune, -12.0).with(Param::Decay, 0.5);
        let modes = modes_of(&patch, 440.0);
        let expected = DrawnMode { frequency: 220.0, level_db: 0.0, t60: 0.5, is_noisy: false };
        assert!((modes[0].frequency - expected.frequency).abs() < 1e-9, "{modes:?}");
        assert_eq!(DrawnMode { frequency: 220.0, ..modes[0] }, expected);
    }

    #[test]
    fn sounds_are_drawn_with_and_without_modes() {
        let samples = [0.0, 0.5, -0.5, 0.25];
        let render = Render { left: &samples, right: &samples, sample_rate: 48_000.0 };
        let modes = modes_of(&Patch::default(), 440.0);
        let with = SoundFigure { title: "a", render, modes: &modes, ranges: Ranges::of(&[render]), cell: 5 };
        let without = SoundFigure { modes: &[], ..with };
        assert!(with.size().1 > without.size().1);
        assert!(String::from_utf8(with.bytes("svg").unwrap()).unwrap().contains("T60 / s"));
        assert!(without.bytes("png").unwrap().starts_with(b"\x89PNG"));
    }

    #[test]
    fn figures_with_the_same_ranges_show_all_of_both_sounds() {
        let tone = |amplitude: f32| (0..9600).map(|n| amplitude * libm::cosf(0.1 * n as f32)).collect::<Vec<_>>();
        let (soft, loud) = (tone(0.05), tone(0.5));
        let [one, two, stereo] = [(&soft, &soft), (&loud, &loud), (&soft, &loud)].map(|(left, right)| Render {
            left,
            right,
            sample_rate: 48_000.0,
        });
        assert_eq!(Ranges::of(&[one, two]), Ranges::of(&[two]));
        assert!(Ranges::of(&[one]).top_level <= Ranges::of(&[two]).top_level - 20.0);
        let height =
            |render| SoundFigure { title: "", render, modes: &[], ranges: Ranges::of(&[render]), cell: 1 }.size().1;
        assert_eq!(height(stereo), height(one) + WAVEFORM);
        assert_eq!(Ranges::of(&[stereo]).waveform, Ranges::of(&[two]).waveform);
    }
}
