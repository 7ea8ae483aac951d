//! Recordings that tests make.

use sprung::internals::random::uniform;

/// A WAV of interleaved floats.
pub(crate) fn wav(samples: &[f32], sample_rate: u32, channels: u16) -> Vec<u8> {
    let spec = hound::WavSpec { channels, sample_rate, bits_per_sample: 32, sample_format: hound::SampleFormat::Float };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = hound::WavWriter::new(&mut bytes, spec).unwrap();
    samples.iter().for_each(|sample| writer.write_sample(*sample).unwrap());
    writer.finalize().unwrap();
    bytes.into_inner()
}

/// Noise from −0.5 to 0.5.
pub(crate) fn noise(len: usize) -> Vec<f32> {
    (0..len as u64).map(|n| 0.5 * uniform(1, n)).collect()
}
