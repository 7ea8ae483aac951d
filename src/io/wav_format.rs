//! What a WAV file holds: rate, channels, and how samples are stored.

/// How a sample is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFormat {
    /// 16-bit integers.
    Int16,
    /// 24-bit integers.
    Int24,
    /// 32-bit IEEE floats: the engine's own samples, unrounded and never clipped.
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

/// What a WAV file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WavFormat {
    /// Frames per second.
    pub sample_rate: u32,
    /// Samples per frame: 1 or 2.
    pub channels: u16,
    /// How samples are stored.
    pub samples: SampleFormat,
}

impl WavFormat {
    /// Bytes of one frame.
    pub fn frame_len(&self) -> u64 {
        u64::from(self.channels) * u64::from(self.samples.bits() / 8)
    }

    /// The same in hound's words.
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
