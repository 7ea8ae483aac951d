//! Converts stereo floats to the sample format and the number of channels of a device.

use crate::io::quantise;
use crate::units::mono_from_stereo;

/// A sample in a format that devices use.
pub trait DeviceSample: Copy {
    /// Silence.
    const SILENCE: Self;

    /// Converts a sample; 1.0 is full scale. Integer formats round to the nearest step and clip beyond full scale;
    /// floats stay unchanged. NaN becomes silence.
    fn from_float(sample: f32) -> Self;
}

impl DeviceSample for f32 {
    const SILENCE: Self = 0.0;

    fn from_float(sample: f32) -> Self {
        sample
    }
}

impl DeviceSample for i16 {
    const SILENCE: Self = 0;

    fn from_float(sample: f32) -> Self {
        quantise(sample, 16, 0.0) as i16
    }
}

impl DeviceSample for i32 {
    const SILENCE: Self = 0;

    fn from_float(sample: f32) -> Self {
        quantise(sample, 32, 0.0)
    }
}

impl DeviceSample for u8 {
    const SILENCE: Self = 128;

    fn from_float(sample: f32) -> Self {
        (quantise(sample, 8, 0.0) + 128) as u8
    }
}

/// Writes stereo into the interleaved frames of a device. A single channel gets (L + R) / 2. Of several channels, the
/// first two get left and right, and the others get silence. Real-time safe.
pub fn interleave<T: DeviceSample>(left: &[f32], right: &[f32], channels: usize, out: &mut [T]) {
    let frames = out.chunks_exact_mut(channels.max(1));
    for ((&left, &right), frame) in left.iter().zip(right).zip(frames) {
        match frame {
            [mono] => *mono = T::from_float(mono_from_stereo(left, right)),
            [first, second, others @ ..] => {
                *first = T::from_float(left);
                *second = T::from_float(right);
                others.fill(T::SILENCE);
            }
            [] => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_take_the_nearest_step_and_stop_at_full_scale() {
        let half_step = 1.0 / 65_536.0;
        for (sample, short, long, byte) in [
            (0.0, 0, 0, 128),
            (1.0, 32_767, i32::MAX, 255),
            (-1.0, -32_768, i32::MIN, 0),
            (7.5, 32_767, i32::MAX, 255),
            (-7.5, -32_768, i32::MIN, 0),
            (0.5, 16_384, 1 << 30, 192),
            (half_step, 0, 1 << 15, 128),
            (3.0 * half_step, 2, 3 << 15, 128),
            (f32::NAN, 0, 0, 128),
            (f32::INFINITY, 32_767, i32::MAX, 255),
        ] {
            let steps = (i16::from_float(sample), i32::from_float(sample), u8::from_float(sample));
            assert_eq!(steps, (short, long, byte), "{sample}");
            assert_eq!(f32::from_float(sample).to_bits(), sample.to_bits());
        }
    }

    #[test]
    fn frames_have_one_to_eight_channels() {
        let (left, right) = ([0.5, -0.5], [0.25, 0.25]);
        for channels in 1..=8 {
            let mut out = vec![7.0_f32; 2 * channels];
            interleave(&left, &right, channels, &mut out);
            for (frame, samples) in out.chunks(channels).enumerate() {
                let expected = match channels {
                    1 => vec![[0.375, -0.125][frame]],
                    _ => [vec![left[frame], right[frame]], vec![0.0; channels - 2]].concat(),
                };
                assert_eq!(samples, expected, "{channels} channels, frame {frame}");
            }
        }
        let mut bytes = [0_u8; 3];
        interleave(&[0.0], &[0.0], 3, &mut bytes);
        assert_eq!(bytes, [128; 3], "silence of an unsigned format is its middle");
    }
}
