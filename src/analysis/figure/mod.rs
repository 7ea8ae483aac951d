//! Figures of renders as PNG or SVG, with axes in units.

mod modes;
mod panel;
pub(crate) mod sound;

pub use modes::ModesFigure;
pub use sound::{DrawnMode, Ranges, SoundFigure, modes_of};

use super::level::mono;
use crate::error::{Error, Result};
use crate::figure::colour::BLUE;
use crate::figure::{Area, Drawn, Picture, png, svg, text};
use panel::{Trace, channels, spectrogram_panel, top_level, waveform, waveform_range};
use plotters::prelude::*;
use std::path::Path;

/// A stereo render to draw.
#[derive(Clone, Copy, Debug)]
pub struct Render<'a> {
    /// Left channel.
    pub left: &'a [f32],
    /// Right channel, of the same length.
    pub right: &'a [f32],
    /// Hz.
    pub sample_rate: f64,
}

/// Draws the waveform of each channel (or one waveform if both are the same) above the spectrogram of their mean, to a
/// `.png` of 1600 × 900 pixels or an `.svg`.
pub fn waveform_and_spectrogram(render: Render, title: &str, path: &Path) -> Result<()> {
    let Render { left, right, sample_rate } = render;
    save(path, Sheet { title, cell: 1, sample_rate, render, against: None, middle: mono(&[left, right]) })
}

/// Draws the expected and the actual render, their difference (at its own scale), and the spectrogram of the difference.
pub fn comparison(expected: Render, actual: Render, title: &str, path: &Path) -> Result<()> {
    save(path, Sheet::comparison(expected, actual, title))
}

/// [`comparison`] as the bytes of a file in `format`, `png` or `svg`.
pub fn comparison_bytes(expected: Render, actual: Render, title: &str, format: &str) -> Result<Vec<u8>> {
    bytes(Sheet::comparison(expected, actual, title), format)
}

/// The contents of a figure.
struct Sheet<'a> {
    title: &'a str,
    /// Pixels per cell of the spectrogram.
    cell: usize,
    sample_rate: f64,
    render: Render<'a>,
    /// The expected render, if `render` is compared with one.
    against: Option<Render<'a>>,
    /// The signal of the spectrogram: mean of the channels, or of their differences.
    middle: Vec<f32>,
}

impl<'a> Sheet<'a> {
    fn comparison(expected: Render<'a>, actual: Render<'a>, title: &'a str) -> Self {
        let len = expected.left.len().max(actual.left.len());
        let middle = |render: Render| {
            let mut samples = mono(&[render.left, render.right]);
            samples.resize(len, 0.0);
            samples
        };
        let difference: Vec<f32> = middle(actual).iter().zip(middle(expected)).map(|(a, e)| a - e).collect();
        let sample_rate = actual.sample_rate;
        Self { title, cell: 1, sample_rate, render: actual, against: Some(expected), middle: difference }
    }
}

impl Picture for Sheet<'_> {
    fn size(&self) -> (u32, u32) {
        (1600, 900)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        let (_, height) = area.dim_in_pixel();
        area.draw_text(self.title, &text(24), (20, 14))?;
        let (_, body) = area.split_vertically(46);
        let (upper, lower) =
            body.split_vertically(if self.against.is_some() { height * 11 / 20 } else { height * 2 / 5 });
        let sounds = match self.against {
            Some(expected) => vec![("expected", expected), ("actual", self.render)],
            None => vec![("sound", self.render)],
        };
        let compared = waveform_range(sounds.iter().flat_map(|(_, render)| [render.left, render.right]));
        let mut strips = Vec::new();
        for (label, Render { left, right, .. }) in sounds {
            strips.extend(channels([left, right]).into_iter().map(|trace| (label, trace, compared)));
        }
        if self.against.is_some() {
            let difference = Trace { name: "mean", samples: &self.middle, colour: BLUE };
            strips.push(("difference", difference, waveform_range([&self.middle[..]])));
        }
        for ((label, trace, range), area) in strips.iter().zip(upper.split_evenly((strips.len(), 1))) {
            waveform(&area, trace, self.middle.len(), self.sample_rate, label, *range)?;
        }
        let top_level = top_level(&self.middle, self.sample_rate);
        spectrogram_panel(&lower, &self.middle, self.sample_rate, self.cell, top_level)
    }
}

/// Draws to a file in the format that its extension names.
fn save(path: &Path, sheet: Sheet) -> Result<()> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    if !["png", "svg"].contains(&extension.as_str()) {
        return Err(Error::value("figure", format!("{} must end in .png or .svg", path.display())));
    }
    std::fs::write(path, bytes(sheet, &extension)?).map_err(|error| Error::io(path.display().to_string(), error))
}

/// The sheet as a file in that format.
fn bytes(sheet: Sheet, format: &str) -> Result<Vec<u8>> {
    // A vector image has no pixels: larger cells keep the file small.
    if format == "svg" { svg(&Sheet { cell: 5, ..sheet }).map(String::into_bytes) } else { png(&sheet) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decay(frequency: f64, len: usize) -> Vec<f32> {
        (0..len)
            .map(|n| {
                let t = n as f64 / 48_000.0;
                (0.8 * libm::exp(-6.0 * t) * libm::sin(std::f64::consts::TAU * frequency * t)) as f32
            })
            .collect()
    }

    /// Checks that the file exists in its format, and returns its length.
    fn check(path: &Path, starts: &[u8]) -> usize {
        let bytes = std::fs::read(path).unwrap();
        assert!(bytes.starts_with(starts), "{}", path.display());
        bytes.len()
    }

    #[test]
    fn figures_are_drawn_in_both_formats() {
        let folder = tempfile::tempdir().unwrap();
        let (left, right) = (decay(440.0, 24_000), decay(1320.0, 24_000));
        let render = Render { left: &left, right: &right, sample_rate: 48_000.0 };
        let same = Render { right: &left, ..render };
        let png = folder.path().join("a.png");
        waveform_and_spectrogram(render, "A strike", &png).unwrap();
        let two_strips = check(&png, b"\x89PNG");
        waveform_and_spectrogram(same, "A strike", &png).unwrap();
        assert_ne!(check(&png, b"\x89PNG"), two_strips);
        comparison(same, render, "A change", &png).unwrap();
        check(&png, b"\x89PNG");
        let svg = folder.path().join("a.svg");
        waveform_and_spectrogram(render, "A strike", &svg).unwrap();
        check(&svg, b"<svg");
        assert!(std::fs::read_to_string(&svg).unwrap().contains("frequency / Hz"));
    }

    #[test]
    fn empty_short_and_broken_renders_still_draw() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for (samples, rate) in
            [(&[][..], 8e3), (&[0.5], 8e3), (&[0.5], 768e3), (&[f32::NAN, f32::INFINITY, 0.5], 768e3)]
        {
            let render = Render { left: samples, right: samples, sample_rate: rate };
            waveform_and_spectrogram(render, "", &path).unwrap();
            comparison(render, render, "", &path).unwrap();
        }
    }

    #[test]
    fn a_figure_that_cannot_be_written_is_an_error() {
        let render = Render { left: &[0.0], right: &[0.0], sample_rate: 48_000.0 };
        for path in ["/nonexistent/folder/a.png", "/nonexistent/folder/a.svg", "figure.gif"] {
            let error = waveform_and_spectrogram(render, "", Path::new(path)).unwrap_err();
            assert!(error.to_string().contains(path), "{error}");
        }
    }
}
