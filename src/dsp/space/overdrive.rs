//! Overdrive: soft clipping, without the aliasing of its overtones.

use super::half_band::{Both, HalfBand};
use crate::dsp::smoothed::{Smoothed, held};
use libm::{exp, sqrt};
use std::f64::consts::LN_10;

/// Amplifies soft samples and limits loud ones: `f(x) = x √(1+k²) / √(1+k²x²)`. Full scale stays full scale, and very soft
/// samples are amplified by the drive, `√(1+k²)`.
///
/// Computed at four times the sample rate, as the mean of `f` over the line between two samples (J. Parker, V. Zavalishin
/// and E. Le Bivic, "Reducing the aliasing of nonlinear waveshaping using continuous-time convolution", DAFx 2016). For this
/// `f` the mean is `√(1+k²) (x₀ + x₁) / (√(1+k²x₀²) + √(1+k²x₁²))`, without a difference that could cancel. The filters
/// delay low frequencies by some four samples.
///
/// With a constant drive of 0 dB it does not change the signal. It is faded in and out within 20 ms. Real-time safe.
///
/// ```
/// let mut drive = sprung::internals::space::Overdrive::new(48_000.0);
/// drive.set(12.0);
/// let (mut left, mut right) = (vec![0.01; 4800], vec![1.0; 4800]);
/// drive.process(&mut left, &mut right);
/// assert!((left[4799] - 0.0398).abs() < 1e-3 && (right[4799] - 1.0).abs() < 1e-3);
/// ```
#[derive(Clone, Debug)]
pub struct Overdrive {
    /// Target of the drive in dB.
    decibels: f32,
    /// `k`.
    hardness: Smoothed,
    /// Share of the driven signal in the output, 0–1.
    blend: Smoothed,
    clipper: Clipper,
    /// Frames of silence at the input.
    silent_frames: u64,
    forget_frames: u64,
}

/// The filter next to the sample rate, which has to separate 23 from 25 kHz at 48 kHz, and the one at the higher rate.
type Near = HalfBand<5>;
type Far = HalfBand<2>;

/// What clips both sides at four times the sample rate.
#[derive(Clone, Debug)]
struct Clipper {
    up: (Near, Far),
    down: (Near, Far),
    /// The last samples at the highest rate and their `√(1+k²x²)`.
    last: [Both; 2],
}

impl Clipper {
    fn new() -> Self {
        let filters = (Near::new(0.02), Far::new(0.25));
        Self { up: filters, down: filters, last: [[0.0; 2], [1.0; 2]] }
    }

    fn clear(&mut self) {
        for (near, far) in [&mut self.up, &mut self.down] {
            near.clear();
            far.clear();
        }
        self.last = [[0.0; 2], [1.0; 2]];
    }

    #[inline(always)]
    fn next(&mut self, samples: Both, hardness: f32) -> Both {
        let square = hardness * hardness;
        let lift = (1.0 + square).sqrt();
        // Not by `map`, whose closure would not be inlined.
        let [earlier, later] = self.up.0.up(samples);
        let doubled = [self.clip(earlier, square, lift), self.clip(later, square, lift)];
        self.down.0.down(doubled)
    }

    /// One sample at twice the sample rate.
    #[inline(always)]
    fn clip(&mut self, samples: Both, square: f32, lift: f32) -> Both {
        let Self { up, down, last } = self;
        // Two samples of both sides, as four lanes.
        let [[a, b], [c, d]] = up.1.up(samples);
        let (now, mut root, mut mean) = ([a, b, c, d], [0.0; 4], [0.0; 4]);
        for lane in 0..4 {
            root[lane] = (1.0 + square * now[lane] * now[lane]).sqrt();
        }
        let (before, before_root) = ([last[0][0], last[0][1], a, b], [last[1][0], last[1][1], root[0], root[1]]);
        for lane in 0..4 {
            mean[lane] = lift * (before[lane] + now[lane]) / (before_root[lane] + root[lane]);
        }
        *last = [[c, d], [root[2], root[3]]];
        down.1.down([[mean[0], mean[1]], [mean[2], mean[3]]])
    }
}

/// Seconds after which the filters are silent.
const FORGET: f64 = 0.05;

impl Overdrive {
    /// Greatest drive in dB.
    pub(crate) const MOST: f32 = 36.0;

    /// `k` for a drive in dB.
    fn hardness(decibels: f32) -> f32 {
        let lift = exp(f64::from(decibels) * LN_10 / 20.0);
        sqrt((lift * lift - 1.0).max(0.0)) as f32
    }

    /// What becomes of a steady sample: `f`.
    pub(crate) fn steady(decibels: f32, sample: f32) -> f32 {
        let hardness = Self::hardness(decibels);
        let square = hardness * hardness;
        sample * (1.0 + square).sqrt() / (1.0 + square * sample * sample).sqrt()
    }

    /// An overdrive that is off.
    pub fn new(sample_rate: f64) -> Self {
        Self {
            decibels: 0.0,
            hardness: Smoothed::new(0.0, sample_rate),
            blend: Smoothed::new(0.0, sample_rate),
            clipper: Clipper::new(),
            silent_frames: 0,
            forget_frames: (FORGET * sample_rate) as u64,
        }
    }

    /// Moves to a drive in dB, from 0 (off) to 36, in 20 ms.
    pub fn set(&mut self, decibels: f32) {
        let decibels = decibels.clamp(0.0, Self::MOST);
        if decibels.is_nan() || decibels == self.decibels {
            return;
        }
        self.decibels = decibels;
        self.hardness.set(Self::hardness(decibels));
        self.blend.set(if decibels > 0.0 { 1.0 } else { 0.0 });
    }

    /// Silences the filters and ends all ramps.
    pub fn reset(&mut self) {
        self.hardness.jump(self.hardness.target());
        self.blend.jump(self.blend.target());
        self.forget();
    }

    fn forget(&mut self) {
        self.clipper.clear();
        self.silent_frames = self.forget_frames;
    }

    /// Whether silent input gives silent output.
    pub fn is_silent(&self) -> bool {
        self.blend.rests_at(0.0) || self.silent_frames >= self.forget_frames
    }

    /// Upper bound of the frames of silence until that is so and no ramp is running.
    pub fn tail_frames(&self) -> u64 {
        let filters = if self.is_silent() { 0 } else { self.forget_frames - self.silent_frames };
        filters.max(self.hardness.frames_left().max(self.blend.frames_left()).into())
    }

    /// The same bound, after input that is still to come.
    pub(crate) fn tail_frames_after(&self) -> u64 {
        if self.is_off() { 0 } else { self.forget_frames.max(self.tail_frames()) }
    }

    /// Upper bound of the output from now on, without the overshoot of the filters, if the magnitude of the input is at most
    /// `peak`.
    pub(crate) fn peak_after(&self, peak: f64) -> f64 {
        let hardness = f64::from(self.hardness.after(0).max(self.hardness.target()));
        peak * sqrt(1.0 + hardness * hardness)
    }

    /// Whether the signal is not changed.
    pub fn is_off(&self) -> bool {
        self.blend.rests_at(0.0) && !self.hardness.is_moving()
    }

    /// Whether silent input changes nothing.
    pub fn is_idle(&self) -> bool {
        self.is_silent() && !self.blend.is_moving() && !self.hardness.is_moving()
    }

    /// Changes `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        for (left, right) in left.iter_mut().zip(right) {
            if self.is_off() {
                return;
            }
            let (hardness, blend) = (self.hardness.after(0), self.blend.after(0));
            self.hardness.advance(1);
            self.blend.advance(1);
            if *left == 0.0 && *right == 0.0 {
                if self.silent_frames >= self.forget_frames {
                    continue;
                }
                self.silent_frames += 1;
            } else {
                self.silent_frames = 0;
            }
            let heard = [held(*left), held(*right)];
            let driven = self.clipper.next(heard, hardness);
            for ((sample, heard), driven) in [left, right].into_iter().zip(heard).zip(driven) {
                *sample = if blend == 1.0 { driven } else { heard + (driven - heard) * blend };
            }
            if self.silent_frames == self.forget_frames || self.blend.rests_at(0.0) {
                self.forget();
            }
        }
    }
}
