//! Converts a recording to another sample rate.

use super::recording::{Recording, check_layout};
use crate::error::{Error, Result};
use rubato::audioadapter::Adapter;
use rubato::audioadapter_buffers::direct::SequentialSliceOfVecs;
use rubato::{Fft, FixedSync, Resampler};

/// Frames per conversion step; a power of two above the length of the longest filter.
const CHUNK: usize = 4096;

/// The recording at `sample_rate`, band-limited to the lower of both rates; unchanged if it has this rate already.
///
/// # Errors
/// [`Error::Value`] for rates and numbers of channels that [`Recording::check_layout`] refuses.
pub fn resampled(recording: &Recording, sample_rate: u32) -> Result<Recording> {
    if sample_rate == recording.sample_rate {
        return Ok(recording.clone());
    }
    let failed = |error: &dyn std::fmt::Display| {
        let rates = format!("from {} Hz to {sample_rate} Hz", recording.sample_rate);
        Error::value("sample rate", format!("{rates} cannot be converted: {error}"))
    };
    for rate in [recording.sample_rate, sample_rate] {
        check_layout(rate, recording.channels.len()).map_err(|error| failed(&error))?;
    }
    let (from, to, frames) = (recording.sample_rate as usize, sample_rate as usize, recording.frames());
    // Double precision as in the analysis, so that the program contains only one kind of Fourier transform. One channel after
    // the other: if the rates have no common divisor, the filter has as many taps as the rate has Hz, for each channel.
    let mut resampler = Fft::<f64>::new(from, to, CHUNK, 1, FixedSync::Both).map_err(|error| failed(&error))?;
    // The last block may contain a frame beyond the end of the sound.
    let len = (frames as f64 * to as f64 / from as f64).round() as usize;
    let mut convert = |channel: &Vec<f32>| {
        let precise = [channel.iter().map(|sample| f64::from(*sample)).collect::<Vec<f64>>()];
        let input = SequentialSliceOfVecs::new(&precise, 1, frames).map_err(|error| failed(&error))?;
        let output = resampler.process_all(&input, frames, None).map_err(|error| failed(&error))?;
        Ok((0..len).map(|frame| output.read_sample(0, frame).unwrap_or(0.0) as f32).collect())
    };
    let channels = recording.channels.iter().map(&mut convert).collect::<Result<_>>()?;
    let (encoding, warnings) = (recording.encoding.clone(), recording.warnings.clone());
    Ok(Recording { sample_rate, channels, encoding, warnings })
}
