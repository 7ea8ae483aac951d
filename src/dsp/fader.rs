//! The gain of a voice: linear ramps between control ticks, and the fade-out that ends a voice early.

use super::simd::vector::Vector;
use super::simd::{Instructions, Kernel};

/// Left and right gain. It depends only on the number of elapsed frames, not on the block size. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fader {
    instructions: Instructions,
    from: [f32; 2],
    step: [f32; 2],
    /// Frames since the start of the ramp.
    elapsed: u32,
    /// Length of the fade-out in frames, 0 if there is none, and, in the next field, its frames so far.
    fade_frames: u32,
    faded: u32,
}

impl Fader {
    /// A silent fader. [`Fader::jump`] sets its first gain.
    pub(crate) fn closed() -> Self {
        let instructions = Instructions::current();
        Self { instructions, from: [0.0; 2], step: [0.0; 2], elapsed: 0, fade_frames: 0, faded: 0 }
    }

    /// The gain of the last frame.
    pub(crate) fn now(&self) -> [f32; 2] {
        [0, 1].map(|side| self.from[side] + self.step[side] * self.elapsed as f32)
    }

    /// Sets the gain to `target` at once.
    pub(crate) fn jump(&mut self, target: [f32; 2]) {
        (self.from, self.step, self.elapsed) = (target, [0.0; 2], 0);
    }

    /// Starts a ramp to `target` that takes `frames` frames. Returns whether the gain changes.
    pub(crate) fn aim(&mut self, target: [f32; 2], frames: usize) -> bool {
        let from = self.now();
        let step = [0, 1].map(|side| (target[side] - from[side]) / frames as f32);
        (self.from, self.step, self.elapsed) = (from, step, 0);
        from != target
    }

    /// Frames until a fade-out ends, if there is one.
    pub(crate) fn frames_left(&self) -> Option<u64> {
        (self.fade_frames > 0).then(|| u64::from(self.fade_frames - self.faded))
    }

    /// Whether the gain is constant, apart from a fade-out.
    pub(crate) fn is_level(&self) -> bool {
        self.step == [0.0; 2]
    }

    /// Starts to fade out.
    pub(crate) fn fade(&mut self, frames: u32) {
        self.fade_frames = frames;
    }

    /// Whether the fade-out has ended.
    pub(crate) fn is_closed(&self) -> bool {
        self.fade_frames > 0 && self.faded >= self.fade_frames
    }

    /// The fraction of the energy that remains after the fade-out so far.
    pub(crate) fn remaining(&self) -> f64 {
        if self.fade_frames == 0 {
            return 1.0;
        }
        let gain = f64::from(fade_after(self.faded, self.fade_frames));
        gain * gain
    }

    /// The greater of the two gains.
    pub(crate) fn loudest(&self) -> f32 {
        let [left, right] = self.now();
        left.max(right)
    }

    /// Adds the next frames of a voice to a mix. All slices have the same length.
    pub(crate) fn mix(&mut self, voice: [&[f32]; 2], into: [&mut [f32]; 2]) {
        let frames = into[0].len() as u32;
        self.instructions.run(Mix { fader: *self, voice, into });
        self.elapsed += frames;
        if self.fade_frames > 0 {
            self.faded = self.fade_frames.min(self.faded + frames);
        }
    }
}

/// The work of [`Fader::mix`]: plain loops, which the compiler vectorises for each instruction level.
struct Mix<'a> {
    fader: Fader,
    voice: [&'a [f32]; 2],
    into: [&'a mut [f32]; 2],
}

impl Kernel for Mix<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Fader { elapsed, fade_frames, faded, .. } = self.fader;
        for (side, (voice, into)) in self.voice.into_iter().zip(self.into).enumerate() {
            let (from, step) = (self.fader.from[side], self.fader.step[side]);
            let pairs = into.iter_mut().zip(voice);
            if fade_frames > 0 {
                for (i, (into, voice)) in (1..).zip(pairs) {
                    let gain = from + step * (elapsed + i) as f32;
                    *into += voice * (gain * fade_after(faded + i, fade_frames));
                }
            } else if step == 0.0 {
                for (into, voice) in pairs {
                    *into += voice * from;
                }
            } else {
                // A signed counter, since every CPU has a vector instruction that converts it to float.
                for (i, (into, voice)) in (elapsed as i32 + 1..).zip(pairs) {
                    *into += voice * (from + step * i as f32);
                }
            }
        }
    }
}

/// An S-curve from 1 to 0. Its slope is zero at both ends, so a fade makes no click.
#[inline(always)]
fn fade_after(frames: u32, length: u32) -> f32 {
    let u = frames.min(length) as f32 / length as f32;
    1.0 - u * u * (3.0 - 2.0 * u)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn render(fader: &mut Fader, frames: usize) -> Vec<f32> {
        let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
        let voice = vec![1.0; frames];
        fader.mix([&voice, &voice], [&mut left, &mut right]);
        left
    }

    #[test]
    fn a_line_arrives_on_time_however_it_is_divided() {
        let mut whole = Fader::closed();
        whole.jump([0.25, 1.0]);
        assert_eq!(render(&mut whole, 3), [0.25; 3]);
        whole.aim([1.0, 0.0], 30);
        whole.fade(40);
        let mut parts = whole;
        let expected = render(&mut whole, 30);
        assert_eq!([1, 13, 0, 16].map(|frames| render(&mut parts, frames)).concat(), expected);
        assert_eq!(whole.now(), [1.0, 0.0]);
        assert!(!whole.is_closed());
        let end = render(&mut whole, 10);
        assert!(whole.is_closed() && end[9] == 0.0 && end[8] > 0.0);
    }
}
