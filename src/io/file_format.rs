//! The formats of sound files that are written, and what each can hold.

use super::wav_format::{SampleFormat, WavFormat};
use crate::error::{Error, Result};

/// Highest sample rate in Hz that the FLAC encoder accepts.
pub(super) const HIGHEST_RATE: u32 = 96_000;

/// Most bytes of a WAV file that becomes FLAC: longer ones are RF64, which the reader of the samples does not know. The 68 bytes of a
/// loop's chunk may be added.
const LONGEST_WAV: u64 = u32::MAX as u64 - 68;

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
    pub(crate) fn check(
        self,
        samples: SampleFormat,
        sample_rate: u32,
    ) -> std::result::Result<(), (&'static str, String)> {
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

    /// As `FileFormat::check`, with an error that names the command's option.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn check_options(self, samples: SampleFormat, sample_rate: u32) -> Result<()> {
        self.check(samples, sample_rate).map_err(|(option, message)| Error::value(format!("--{option}"), message))
    }

    /// Checks that a file of at least so many frames can have the format.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn check_length(self, format: &WavFormat, frames: u64) -> Result<()> {
        match self {
            Self::Wav => Ok(()),
            Self::Flac => check_wav_length(format.file_len(frames)?),
        }
    }
}

/// Returns an error if a WAV file of so many bytes is too long to become FLAC.
pub(super) fn check_wav_length(bytes: u64) -> Result<()> {
    if bytes <= LONGEST_WAV {
        return Ok(());
    }
    Err(Error::value("--format", "the sound is too long for FLAC, over 4 GiB as WAV: expected wav, or less at a time"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flac_takes_what_fits_into_4_gib_of_wav() {
        let format = WavFormat { sample_rate: 48_000, channels: 2, samples: SampleFormat::Int16 };
        let most = (LONGEST_WAV - format.file_len(0).unwrap()) / 4;
        assert!(FileFormat::Flac.check_length(&format, most).is_ok());
        let error = FileFormat::Flac.check_length(&format, most + 1).unwrap_err().to_string();
        assert!(error.starts_with("--format: the sound is too long for FLAC"), "{error}");
        assert!(FileFormat::Wav.check_length(&format, most + 1).is_ok());
    }
}
