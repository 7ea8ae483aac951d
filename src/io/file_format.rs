//! The formats of sound files that are written, and what each can hold.

use super::wav_format::SampleFormat;

/// Highest sample rate in Hz that the FLAC encoder accepts.
pub(super) const HIGHEST_RATE: u32 = 96_000;

/// The format of a sound file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// WAV.
    Wav,
    /// FLAC, which stores the samples of the WAV in less space. It has no floats, and sample rates up to 96 kHz.
    Flac,
}

impl FileFormat {
    /// The extension of file names.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Wav => "wav",
            Self::Flac => "flac",
        }
    }

    /// Checks that the format can hold samples of a kind at a rate in Hz.
    ///
    /// # Errors
    /// The option that is wrong, and a message that says what would be right.
    pub fn check(self, samples: SampleFormat, sample_rate: u32) -> Result<(), (&'static str, String)> {
        match self {
            Self::Flac if samples == SampleFormat::Float32 => {
                Err(("bits", "FLAC has no floats: expected 16 or 24, or --format wav".to_owned()))
            }
            Self::Flac if sample_rate > HIGHEST_RATE => Err((
                "rate",
                format!("{sample_rate} Hz is too high for FLAC: expected at most {HIGHEST_RATE} Hz, or --format wav"),
            )),
            _ => Ok(()),
        }
    }
}
