//! The format of a WAV file: sample rate, channels, and sample format.

/// The format of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFormat {
    /// 16-bit integers.
    Int16,
    /// 24-bit integers.
    Int24,
    /// 32-bit IEEE floats: the engine's samples without rounding or clipping.
    Float32,
}

impl SampleFormat {
    /// Bits of one sample.
    pub fn bits(self) -> u16 {
        match self {
            Self::Int16 => 16,
            Self::Int24 => 24,
            Self::Float32 => 32,
        }
    }
}

/// The format of a WAV file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WavFormat {
    /// Frames per second.
    pub sample_rate: u32,
    /// Samples per frame: 1 or 2.
    pub channels: u16,
    /// The format of a sample.
    pub samples: SampleFormat,
}

impl WavFormat {
    /// Bytes of one frame.
    pub(crate) fn frame_len(&self) -> u64 {
        u64::from(self.channels) * u64::from(self.samples.bits() / 8)
    }

    /// The format as hound describes it.
    pub(super) fn spec(&self) -> hound::WavSpec {
        hound::WavSpec {
            channels: self.channels,
            sample_rate: self.sample_rate,
            bits_per_sample: self.samples.bits(),
            sample_format: match self.samples {
                SampleFormat::Float32 => hound::SampleFormat::Float,
                _ => hound::SampleFormat::Int,
            },
        }
    }
}
