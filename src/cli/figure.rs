//! Figures of rendered jobs.

use sprung::analysis::figure::{DrawnMode, Ranges, Render, SoundFigure};
use sprung::render::Job;
use sprung::{Error, Result};

/// Longest sound that is drawn, in seconds.
const LONGEST: f64 = 600.0;
/// Pixels per cell of the spectrogram in a vector image.
const VECTOR_CELL: usize = 5;

/// Renders a job and draws the sound in `format`.
pub(super) fn drawn(job: &Job, title: &str, modes: &[DrawnMode], format: &str) -> Result<Vec<u8>> {
    let sample_rate = f64::from(job.options.sample_rate);
    let [mut left, mut right] = [Vec::new(), Vec::new()];
    job.render(|block_left, block_right| {
        left.extend_from_slice(block_left);
        right.extend_from_slice(block_right);
        if left.len() as f64 > LONGEST * sample_rate {
            return Err(Error::value(
                "--figure",
                format!("the sound is longer than {LONGEST} s: expected a shorter one"),
            ));
        }
        Ok(())
    })?;
    let render = Render { left: &left, right: &right, sample_rate };
    SoundFigure {
        title,
        render,
        modes,
        ranges: Ranges::of(&[render]),
        cell: if format == "svg" { VECTOR_CELL } else { 1 },
    }
    .bytes(format)
}
