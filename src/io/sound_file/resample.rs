//! Converts a recording to another sample rate.

use super::recording::{Recording, check_layout};
use crate::error::{Error, Result};

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
    let channels = sprung_fourier::resampled(&recording.channels, recording.sample_rate, sample_rate)
        .map_err(|error| failed(&error))?;
    let (encoding, warnings) = (recording.encoding.clone(), recording.warnings.clone());
    Ok(Recording { sample_rate, channels, encoding, warnings })
}
