//! A stereo true-peak limiter without latency: it lowers peaks above −0.92 dBFS and changes nothing else.
//!
//! The gain falls at once, is held until the next peak of tones down to 17 Hz, and then rises slowly. A
//! peak between two samples is only known after half of `TAPS` further samples have been output. Until the gain
//! follows, single samples are lowered so that no partial sum of an interpolated point exceeds `GUARD`; the partial
//! sum is the value of the point if only silence follows. This is always possible, because a sample of 0 adds nothing
//! to any point.
//!
//! What it cannot do: lower samples that are all below −0.9 dBFS and then stop or change direction. Two samples of 0.89
//! alone have a true peak of +0.9 dBFS. By `ebur128`, which interpolates with the same kernel: white noise at full
//! scale up to +0.6 dBFS; a tone at full scale and a quarter of the sample rate −0.21 dBFS; chords and 64 voices of the
//! presets below −0.3 dBFS. Latency would solve this, but every player would wait 0.2 to 1.5 ms longer. Test:
//! `tests/engine/limiter.rs`.

use super::simd::vector::Vector;
use super::simd::{Instructions, Kernel};
use super::true_peak::{ByAge, Interpolator, TAPS, Weights};
use libm::exp;

/// The gain is 1 while no peak, on a sample or between two, exceeds this level, −0.92 dBFS. The difference from −1 dBFS
/// allows for meters that interpolate differently.
pub(crate) const THRESHOLD: f32 = 0.9;

/// Level to which higher peaks are lowered, −1.9 dBFS. An incomplete point of a sine can exceed the sine's peak by a
/// factor of 1.17, which gives [`GUARD`] at this level. So for a steady tone, only the gain acts.
pub(crate) const CEILING: f32 = 0.805;

/// Upper bound of the waveform between samples, −0.45 dBFS; −0.3 dBFS on meters that interpolate differently.
pub(crate) const GUARD: f32 = 0.95;

/// Samples below this level cannot have a peak above [`THRESHOLD`] between them, since the weights of a point add up to
/// 1.865.
const QUIET: f32 = 0.48;

/// Hold time of the gain: half a period of a 17 Hz tone. With lower tones the gain rises between two peaks, which
/// distorts them.
const HOLD_SECONDS: f64 = 0.03;

/// Time constant of the gain's rise.
const RELEASE_SECONDS: f64 = 0.1;

/// A rising gain above this value is set to 1.
const SETTLED: f64 = 0.999_99;

/// A gain below this value (−0.1 dB) is counted in [`Work::frames`].
const WORK: f64 = 0.988_6;

/// Number of frames that are tested for quietness together.
const SCAN: usize = 64;

/// Holds a stereo signal's true peak to about −0.3 dBFS, with the same gain on both sides and no latency.
///
/// A signal whose true peak stays below −1 dBFS passes bit for bit. From the first peak above `THRESHOLD` on, the
/// points between samples stay below `GUARD`, as this module interpolates them. Samples that were output before that
/// peak cannot be changed any more. Where samples below the threshold stop or change sign within `TAPS` samples, as
/// in white noise, the point between them may exceed the guard before the gain has fallen. Measured: +0.6 dBFS in noise,
/// and +0.9 dBFS for two single samples of 0.89. Only a limiter with latency could avoid this.
///
/// The output is the same for all block sizes, bit for bit. Real-time safe.
#[derive(Clone, Debug)]
pub struct Limiter {
    instructions: Instructions,
    weights: Weights,
    input: [Interpolator; 2],
    output: [Interpolator; 2],
    /// Limits of the incomplete points of the output, for the present `ceiling`.
    limits: ByAge,
    ceiling: f32,
    gain: f64,
    /// A rising gain moves by this fraction of its distance from the target in each frame.
    release: f64,
    recent_peaks: RecentPeaks,
    /// The last samples that were output, oldest first.
    last: [[f32; TAPS]; 2],
    /// Whether the input's interpolators have not received the last samples yet.
    is_stale: bool,
    /// Frames since the last frame that was lowered, at most [`TAPS`]. At [`TAPS`], the points of input and output are
    /// the same, and only those of the input are computed.
    unchanged_frames: usize,
    /// Whether silence would pass unchanged, so that it need not be processed.
    is_idle: bool,
    work: Work,
}

/// Statistics of a limiter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Lowest gain, an amplitude ratio; 1 if it never fell, as by a peak that nothing followed. Before a first peak is known, single
    /// samples can be lowered by more, down to 0.
    pub least_gain: f64,
    /// Frames that were lowered by more than 0.1 dB.
    pub frames: u64,
    /// Samples that were infinite or not a number, and became 0.
    pub non_finite: u64,
}

impl Work {
    /// No work yet.
    pub(crate) const NONE: Self = Self { least_gain: 1.0, frames: 0, non_finite: 0 };
}

impl Limiter {
    /// A limiter in its initial state, for a sample rate in Hz.
    pub fn new(sample_rate: f64) -> Self {
        let weights = Weights::new();
        Self {
            limits: limits(&weights, THRESHOLD),
            instructions: Instructions::current(),
            weights,
            input: [Interpolator::SILENT; 2],
            output: [Interpolator::SILENT; 2],
            ceiling: THRESHOLD,
            gain: 1.0,
            release: 1.0 - exp(-1.0 / (RELEASE_SECONDS * sample_rate)),
            recent_peaks: RecentPeaks::new((HOLD_SECONDS * sample_rate) as u32),
            last: [[0.0; TAPS]; 2],
            is_stale: false,
            unchanged_frames: TAPS,
            is_idle: true,
            work: Work::NONE,
        }
    }

    /// Returns to the initial state, as after silence.
    pub(crate) fn reset(&mut self) {
        self.recent_peaks.clear();
        self.set_ceiling(THRESHOLD);
        (self.gain, self.work) = (1.0, Work::NONE);
        self.forget_samples();
    }

    /// The present gain, an amplitude ratio.
    pub(crate) fn gain(&self) -> f64 {
        self.gain
    }

    /// Whether silence would pass unchanged, so that it need not be processed.
    pub fn is_idle(&self) -> bool {
        self.is_idle
    }

    /// The statistics since the limiter was created or reset.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Limits the next frames in place. Both slices have the same length. If `is_on` is false, all frames pass, but a gain below
    /// 1 first rises to 1, as it does after the last peak. If `is_on` is true, samples that are not finite become 0.
    pub fn process(&mut self, is_on: bool, left: &mut [f32], right: &mut [f32]) {
        for (left, right) in left.chunks_mut(SCAN).zip(right.chunks_mut(SCAN)) {
            let [last_left, last_right] = &self.last;
            if self.unchanged_frames == TAPS && [&*left, right, last_left, last_right].into_iter().all(is_quiet) {
                self.is_stale = true;
            } else if is_on || self.gain < 1.0 {
                self.catch_up();
                self.instructions.run(Steps { limiter: self, is_on, left, right });
            }
            self.last.iter_mut().zip([left, right]).for_each(|(last, out)| keep_last(last, out));
            if !is_on && self.gain == 1.0 {
                self.forget_samples();
            }
        }
        self.is_idle = self.unchanged_frames == TAPS && self.last == [[0.0; TAPS]; 2];
    }

    /// Limits one frame.
    #[inline(always)]
    fn step(&mut self, is_on: bool, frame: [f32; 2]) -> [f32; 2] {
        if self.unchanged_frames == TAPS {
            if is_on && self.passes(frame) {
                return frame;
            }
            self.output = self.input;
        }
        let frame = frame.map(|sample| {
            let is_wrong = is_on && !sample.is_finite();
            self.work.non_finite += u64::from(is_wrong);
            if is_wrong { 0.0 } else { sample }
        });
        let mut peak = frame[0].abs().max(frame[1].abs());
        for (points, sample) in self.input.iter_mut().zip(frame) {
            peak = peak.max(points.peak_with(&self.weights, sample));
            points.push(&self.weights, sample);
        }
        let peak = if is_on { peak } else { 0.0 };
        if peak > THRESHOLD || self.gain < 1.0 {
            self.follow(peak);
        }
        let mut out = frame.map(|sample| sample * self.gain as f32);
        let mut share = 1.0;
        if is_on {
            let points = self.output.iter().zip(out);
            let shares = points.map(|(points, sample)| points.share_within(&self.weights, &self.limits, sample));
            share = shares.fold(1.0, f32::min);
            out = out.map(|sample| sample * share);
        }
        for (points, sample) in self.output.iter_mut().zip(out) {
            points.push(&self.weights, sample);
        }
        let is_unchanged = self.gain == 1.0 && share == 1.0;
        self.unchanged_frames = if is_unchanged { TAPS.min(self.unchanged_frames + 1) } else { 0 };
        let applied = self.gain * f64::from(share);
        self.work.least_gain = self.work.least_gain.min(self.gain);
        self.work.frames += u64::from(applied < WORK);
        out
    }

    /// If a frame needs no limiting, accepts it and returns true; otherwise does nothing. Called while the output's points are
    /// the same as the input's. For loud frames, this test is most of the work.
    #[inline(always)]
    fn passes(&mut self, frame: [f32; 2]) -> bool {
        let passes = self.input.iter().zip(frame).all(|(points, sample)| {
            sample.abs() <= THRESHOLD
                && points.peak_with(&self.weights, sample) <= THRESHOLD
                && points.is_within(&self.weights, &self.limits, sample)
        });
        if passes {
            self.input.iter_mut().zip(frame).for_each(|(points, sample)| points.push(&self.weights, sample));
        }
        passes
    }

    /// Updates the gain for one frame whose input peak is `peak`.
    fn follow(&mut self, peak: f32) {
        let highest = self.recent_peaks.add(peak);
        // The ceiling falls from the threshold to its lowest value as peaks rise, so that the gain has no step where
        // limiting begins.
        self.set_ceiling((2.0 * THRESHOLD - highest).clamp(CEILING, THRESHOLD));
        let target = if highest > THRESHOLD { f64::from(self.ceiling) / f64::from(highest) } else { 1.0 };
        if target <= self.gain {
            self.gain = target;
        } else {
            self.gain += (target - self.gain) * self.release;
            if target == 1.0 && self.gain > SETTLED {
                self.gain = 1.0;
                self.recent_peaks.clear();
            }
        }
    }

    fn set_ceiling(&mut self, ceiling: f32) {
        if ceiling != self.ceiling {
            self.ceiling = ceiling;
            self.limits = limits(&self.weights, ceiling);
        }
    }

    /// Passes the samples that were skipped to the input's interpolators.
    fn catch_up(&mut self) {
        if self.is_stale {
            for (channel, last) in self.last.iter().enumerate() {
                last.iter().for_each(|sample| self.input[channel].push(&self.weights, *sample));
            }
            self.is_stale = false;
        }
    }

    fn forget_samples(&mut self) {
        self.input = [Interpolator::SILENT; 2];
        self.output = [Interpolator::SILENT; 2];
        self.last = [[0.0; TAPS]; 2];
        (self.is_stale, self.unchanged_frames, self.is_idle) = (false, TAPS, true);
    }
}

/// Limits frames one after the other. A kernel, so that the compiler can vectorise the points of a frame.
struct Steps<'a> {
    limiter: &'a mut Limiter,
    is_on: bool,
    left: &'a mut [f32],
    right: &'a mut [f32],
}

impl Kernel for Steps<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        for (left, right) in self.left.iter_mut().zip(self.right) {
            [*left, *right] = self.limiter.step(self.is_on, [*left, *right]);
        }
    }
}

/// Limits of incomplete points: [`GUARD`] at the lowest ceiling. At the threshold they are higher, so that a signal that
/// must pass unchanged cannot reach them.
fn limits(weights: &Weights, ceiling: f32) -> ByAge {
    let share = (ceiling - CEILING) / (THRESHOLD - CEILING);
    weights.partial_bounds(THRESHOLD).map(|bound| GUARD + share * (bound - GUARD).max(0.0))
}

/// Whether no sample exceeds [`QUIET`]; false if one is NaN. Has no branch, so that the compiler can use vectors.
fn is_quiet(samples: &[f32]) -> bool {
    samples.iter().fold(true, |quiet, sample| quiet & (sample.abs() <= QUIET))
}

/// Appends samples to the kept ones and drops the oldest.
fn keep_last(last: &mut [f32; TAPS], samples: &[f32]) {
    let kept = TAPS.saturating_sub(samples.len());
    last.copy_within(TAPS - kept.., 0);
    last[kept..].copy_from_slice(&samples[samples.len() - (TAPS - kept)..]);
}

/// The highest peak of the last frames. The window is divided into eight parts, so its length is exact to an eighth.
#[derive(Clone, Debug)]
struct RecentPeaks {
    /// The highest peak of each part, newest first.
    parts: [f32; 8],
    /// The highest of all parts except the newest.
    highest_before: f32,
    part_frames: u32,
    elapsed: u32,
}

impl RecentPeaks {
    fn new(frames: u32) -> Self {
        Self { parts: [0.0; 8], highest_before: 0.0, part_frames: (frames / 8).max(1), elapsed: 0 }
    }

    fn clear(&mut self) {
        (self.parts, self.highest_before, self.elapsed) = ([0.0; 8], 0.0, 0);
    }

    /// Adds the peak of the next frame and returns the highest peak in the window.
    fn add(&mut self, peak: f32) -> f32 {
        if self.elapsed == self.part_frames {
            self.parts.rotate_right(1);
            (self.parts[0], self.elapsed) = (0.0, 0);
            self.highest_before = self.parts.iter().fold(0.0, |highest, part| highest.max(*part));
        }
        self.elapsed += 1;
        self.parts[0] = self.parts[0].max(peak);
        self.parts[0].max(self.highest_before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_samples_are_kept_however_they_come() {
        let samples: Vec<f32> = (0..40).map(|n| n as f32).collect();
        for lengths in [&[40][..], &[13, 0, 27], &[30, 1, 1, 3, 5], &[12, 12, 12, 4]] {
            let (mut last, mut rest) = ([0.0; TAPS], &samples[..]);
            for length in lengths {
                keep_last(&mut last, &rest[..*length]);
                rest = &rest[*length..];
            }
            assert_eq!(last[..], samples[40 - TAPS..], "{lengths:?}");
        }
    }

    #[test]
    fn recent_peaks_are_those_of_the_time_they_are_held() {
        let mut peaks = RecentPeaks::new(80);
        assert_eq!(peaks.add(0.5), 0.5);
        assert_eq!(peaks.add(2.0), 2.0);
        assert!((0..78).all(|_| peaks.add(1.0) == 2.0));
        assert_eq!(peaks.add(1.0), 1.0);
    }

    #[test]
    fn quiet_samples_have_no_peak_beyond_the_threshold_between_them() {
        let (weights, mut worst) = (Weights::new(), 0.0f32);
        for first in 0..4096 {
            let mut points = Interpolator::SILENT;
            // Every combination of signs of the twelve samples of a point.
            for n in 0..TAPS {
                let sample = if first >> n & 1 == 1 { QUIET } else { -QUIET };
                worst = worst.max(points.peak_with(&weights, sample));
                points.push(&weights, sample);
            }
        }
        assert!((0.99 * THRESHOLD..THRESHOLD).contains(&worst), "{worst}");
    }
}
