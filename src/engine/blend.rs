//! The balance between the sound that goes into an effect and the sound that comes out of it.

use crate::dsp::smoothed::Smoothed;

/// A share of the effect's sound in the output, 0–1; the rest is the sound as it came in. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Blend(Smoothed);

impl Blend {
    /// A balance at rest, for a sample rate in Hz.
    pub fn new(sample_rate: f64, wet: f32) -> Self {
        Self(Smoothed::new(within(wet), sample_rate))
    }

    /// Moves to another share within 20 ms. A share beyond 0–1 counts as the nearest, NaN as 0.
    pub fn aim(&mut self, wet: f32) {
        self.0.set(within(wet));
    }

    /// Mixes the next frames, as many as the shortest slice has, and overwrites `wet`, channel by channel. At a share of 0 the output
    /// has the bits of `dry`, at 1 those of `wet`.
    pub fn mix<'a>(&mut self, dry: impl IntoIterator<Item = &'a [f32]>, wet: &mut [&mut [f32]]) {
        let frames = wet.first().map_or(0, |channel| channel.len());
        for (dry, wet) in dry.into_iter().zip(wet) {
            for (frame, (dry, wet)) in dry.iter().zip(wet.iter_mut()).enumerate() {
                let share = self.0.after(frame);
                *wet = match share {
                    0.0 => *dry,
                    1.0 => *wet,
                    share => *dry * (1.0 - share) + *wet * share,
                };
            }
        }
        self.0.advance(frames);
    }
}

fn within(wet: f32) -> f32 {
    if wet.is_nan() { 0.0 } else { wet.clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_exact_and_the_way_is_the_same_in_parts() {
        let dry: Vec<f32> = (0..480).map(|n| if n % 7 == 0 { -0.0 } else { 0.1 * n as f32 }).collect();
        let given: Vec<f32> = (0..480).map(|n| 1.0 - 0.3 * n as f32).collect();
        let bits = |samples: &[f32]| samples.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
        for (share, expected) in [(0.0, &dry), (f32::NAN, &dry), (-3.0, &dry), (1.0, &given), (9.0, &given)] {
            let mut wet = given.clone();
            Blend::new(12_000.0, share).mix([&dry[..]], &mut [&mut wet]);
            assert_eq!(bits(&wet), bits(expected), "{share}");
        }
        let mixed = |part: usize| {
            let (mut blend, mut wet) = (Blend::new(12_000.0, 0.0), given.clone());
            blend.aim(1.0);
            for (dry, wet) in dry.chunks(part).zip(wet.chunks_mut(part)) {
                blend.mix([dry], &mut [wet]);
            }
            wet
        };
        let whole = mixed(480);
        assert_eq!(whole[120], 0.5 * dry[120] + 0.5 * given[120], "half of 20 ms");
        assert_eq!(bits(&whole[240..]), bits(&given[240..]));
        assert_eq!(bits(&whole), bits(&mixed(7)));
    }
}
