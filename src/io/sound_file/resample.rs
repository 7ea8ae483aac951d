//! Converts a recording to another sample rate.

use super::recording::Recording;
use crate::error::{Error, Result};
use rubato::audioadapter::Adapter;
use rubato::audioadapter_buffers::direct::SequentialSliceOfVecs;
use rubato::{Fft, FixedSync, Resampler};

/// Frames per conversion step; a power of two above the length of the longest filter.
const CHUNK: usize = 4096;

/// The recording at `sample_rate`, band-limited to the lower of both rates; unchanged if it has this rate already.
///
/// # Errors
/// [`Error::Value`] for a rate of 0 or a ratio that cannot be converted.
pub fn resampled(recording: &Recording, sample_rate: u32) -> Result<Recording> {
    if sample_rate == recording.sample_rate {
        return Ok(recording.clone());
    }
    let failed = |error: &dyn std::fmt::Display| {
        let rates = format!("from {} Hz to {sample_rate} Hz", recording.sample_rate);
        Error::value("sample rate", format!("{rates} cannot be converted: {error}"))
    };
    let (from, to, count) = (recording.sample_rate as usize, sample_rate as usize, recording.channels.len());
    // Double precision as in the analysis, so that the program contains only one kind of Fourier transform.
    let mut resampler = Fft::<f64>::new(from, to, CHUNK, count, FixedSync::Both).map_err(|error| failed(&error))?;
    let frames = recording.frames();
    let precise: Vec<Vec<f64>> =
        recording.channels.iter().map(|channel| channel.iter().map(|sample| f64::from(*sample)).collect()).collect();
    let input = SequentialSliceOfVecs::new(&precise, count, frames).map_err(|error| failed(&error))?;
    let output = resampler.process_all(&input, frames, None).map_err(|error| failed(&error))?;
    let sample = |channel, frame| output.read_sample(channel, frame).unwrap_or(0.0) as f32;
    // The last block may contain a frame beyond the end of the sound.
    let len = (frames as f64 * to as f64 / from as f64).round() as usize;
    let channels = (0..count).map(|channel| (0..len).map(|frame| sample(channel, frame)).collect());
    Ok(Recording { sample_rate, channels: channels.collect(), ..recording.clone() })
}
