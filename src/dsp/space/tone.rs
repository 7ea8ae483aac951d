//! Tone control: a low and a high shelving filter.

use super::ticks::Ticks;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::smoothed::{Smoothed, held};
use libm::{exp, log, tan};
use std::f64::consts::{LN_10, PI};

/// Two shelves of first order, `H(s) = (s + ω√g)/(s + ω/√g)` for lows with gain `g`, and its mirror image for highs: a cut
/// is the inverse of a boost by as many dB. The output of each is its input plus `g − 1` times a one-pole filter of the input,
/// in a form whose coefficients may change (V. Zavalishin, *The Art of VA Filter Design*, §3.10).
///
/// With constant gains of 0 dB it does not change the signal. Real-time safe.
///
/// ```
/// let mut tone = sprung::internals::space::Tone::new(48_000.0);
/// tone.set(6.0, -3.0);
/// let (mut left, mut right) = (vec![1.0; 48_000], vec![1.0; 48_000]);
/// tone.process(&mut left, &mut right);
/// assert!((left[47_999] - 1.995).abs() < 1e-3, "6 dB more of 0 Hz");
/// ```
#[derive(Clone, Debug)]
pub struct Tone {
    sample_rate: f64,
    ticks: Ticks<{ CONTROL_FRAMES as u64 }>,
    shelves: [Shelf; 2],
    /// Frames since the last control tick.
    passed: usize,
    /// Frames of silence at the input.
    silent_frames: u64,
}

#[derive(Clone, Debug)]
struct Shelf {
    decibels: Smoothed,
    /// `g − 1`, and the filter's coefficient, each at the last control tick and at the next.
    amount: [f32; 2],
    coefficient: [f32; 2],
    /// The low-pass filter of each side.
    state: [f32; 2],
}

impl Tone {
    /// Corner of the low shelf in Hz.
    pub(crate) const LOW_CORNER: f64 = 250.0;
    /// Corner of the high shelf in Hz.
    pub(crate) const HIGH_CORNER: f64 = 3500.0;
    /// Greatest boost and cut in dB.
    pub(crate) const MOST: f32 = 18.0;

    /// The gain in dB at a frequency in Hz, for gains of lows and highs in dB: of the filters that are approximated.
    pub(crate) fn gain_at(low: f32, high: f32, hertz: f64) -> f64 {
        let shelf = |decibels: f32, way: f64| {
            let gain = exp(f64::from(decibels) * LN_10 / 20.0);
            10.0 * log((way + gain) / (way + 1.0 / gain)) / LN_10
        };
        let square = |ratio: f64| ratio * ratio;
        shelf(low, square(hertz / Self::LOW_CORNER)) + shelf(high, square(Self::HIGH_CORNER / hertz))
    }

    /// A tone control that is off.
    pub fn new(sample_rate: f64) -> Self {
        let shelf = Shelf {
            decibels: Smoothed::new(0.0, sample_rate),
            amount: [0.0; 2],
            coefficient: [0.0; 2],
            state: [0.0; 2],
        };
        let mut tone =
            Self { sample_rate, ticks: Ticks::default(), shelves: [shelf.clone(), shelf], passed: 0, silent_frames: 0 };
        tone.aim(0);
        tone.aim(0);
        tone
    }

    /// Moves to these gains of lows and highs in dB, from −18 to 18, in 20 ms.
    pub fn set(&mut self, low: f32, high: f32) {
        for (shelf, decibels) in self.shelves.iter_mut().zip([low, high]) {
            shelf.decibels.set(decibels.clamp(-Self::MOST, Self::MOST));
        }
    }

    /// Silences the filters and ends all ramps.
    pub fn reset(&mut self) {
        for shelf in &mut self.shelves {
            shelf.decibels.jump(shelf.decibels.target());
            shelf.state = [0.0; 2];
        }
        (self.ticks, self.passed, self.silent_frames) = (Ticks::default(), 0, 0);
        self.aim(0);
        self.aim(0);
    }

    /// Whether silent input gives silent output.
    pub fn is_silent(&self) -> bool {
        self.shelves.iter().all(|shelf| shelf.state == [0.0; 2])
    }

    /// Upper bound of the frames of silence until that is so and no ramp is running.
    pub fn tail_frames(&self) -> u64 {
        if self.is_idle() {
            return 0;
        }
        let moving = self.shelves.iter().map(|shelf| shelf.decibels.frames_left()).max().unwrap_or(0).into();
        self.forget_frames().saturating_sub(self.silent_frames).max(moving) + 3 * CONTROL_FRAMES as u64
    }

    /// The same bound, after input that is still to come.
    pub(crate) fn tail_frames_after(&self) -> u64 {
        if self.is_off() { 0 } else { self.forget_frames() + 3 * CONTROL_FRAMES as u64 }
    }

    /// Upper bound of the output from now on, if the magnitude of the input is at most `peak`. A shelf adds `g − 1` times the
    /// output of its one-pole filter. That output is no larger than the
    /// input; the bound takes twice the input, as a margin, and at least 1 for `|g − 1|`.
    pub(crate) fn peak_after(&self, peak: f64) -> f64 {
        self.shelves.iter().fold(peak, |peak, shelf| {
            let decibels = f64::from(shelf.decibels.after(0).max(shelf.decibels.target()));
            peak * (1.0 + 2.0 * (exp(decibels * LN_10 / 20.0) - 1.0).abs().max(1.0))
        })
    }

    /// Whether the signal is not changed.
    pub fn is_off(&self) -> bool {
        self.is_flat() && self.ticks.is_due()
    }

    /// Whether silent input changes nothing but the clock: [`Tone::skip`] does the same.
    pub fn is_idle(&self) -> bool {
        let moves = self.shelves.iter().any(|shelf| shelf.decibels.is_moving() || shelf.amount[0] != shelf.amount[1]);
        self.is_off() || !moves && self.is_silent()
    }

    /// Advances by frames of silence while it is idle.
    pub fn skip(&mut self, frames: usize) {
        if !self.is_off() {
            self.ticks.advance(frames);
            self.passed = (self.passed + frames) % CONTROL_FRAMES;
            self.silent_frames += frames as u64;
        }
    }

    /// Frames in which the filters' states fall by 160 dB: the lowest pole is at the low shelf's corner divided by the square
    /// root of its largest gain.
    fn forget_frames(&self) -> u64 {
        (8.0 * LN_10 / (2.0 * PI * 80.0) * self.sample_rate) as u64
    }

    /// Starts ramps of both shelves to the gains that they will have `frames` frames from now.
    fn aim(&mut self, frames: usize) {
        let sample_rate = self.sample_rate;
        for (index, shelf) in self.shelves.iter_mut().enumerate() {
            let at_rest = !shelf.decibels.is_moving();
            let (amount, coefficient) = if at_rest && frames > 0 && shelf.amount[1] == shelf.amount[0] {
                (shelf.amount[1], shelf.coefficient[1])
            } else {
                let decibels = f64::from(shelf.decibels.after(frames));
                let gain = exp(decibels * LN_10 / 20.0);
                let root = exp(0.5 * log(gain));
                let corner = [Self::LOW_CORNER / sample_rate, Self::HIGH_CORNER / sample_rate][index];
                let warped = tan(PI * corner.min(0.45)) * if index == 0 { 1.0 / root } else { root };
                ((gain - 1.0) as f32, (warped / (1.0 + warped)) as f32)
            };
            shelf.amount = [shelf.amount[1], amount];
            shelf.coefficient = [shelf.coefficient[1], coefficient];
            shelf.decibels.advance(frames);
        }
    }

    fn is_flat(&self) -> bool {
        self.shelves.iter().all(|shelf| shelf.decibels.rests_at(0.0) && shelf.amount[1] == 0.0)
    }

    /// Changes `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let mut start = 0;
        while start < frames {
            if self.ticks.is_due() {
                if self.is_flat() {
                    return;
                }
                self.aim(CONTROL_FRAMES);
                self.passed = 0;
            }
            let end = start + self.ticks.frames_before(frames - start);
            for frame in start..end {
                let share = self.passed as f32 * (1.0 / CONTROL_FRAMES as f32);
                let sides = [&mut left[frame], &mut right[frame]];
                let silent = sides.iter().all(|sample| **sample == 0.0);
                self.silent_frames = if silent { self.silent_frames + 1 } else { 0 };
                let [low, high] = &mut self.shelves;
                for (side, sample) in sides.into_iter().enumerate() {
                    let heard = held(*sample);
                    let below = low.low_pass(side, heard, share);
                    let middle = heard + low.amount_at(share) * below;
                    let above = middle - high.low_pass(side, middle, share);
                    *sample = middle + high.amount_at(share) * above;
                }
                self.passed += 1;
            }
            self.ticks.advance(end - start);
            start = end;
            // The filters' states are inaudible once both shelves are flat. They must not become subnormal. At the end of a tick, since
            // a tone control that is off is not asked to process.
            if self.ticks.is_due() && (self.is_flat() || self.silent_frames > self.forget_frames()) {
                self.shelves.iter_mut().for_each(|shelf| shelf.state = [0.0; 2]);
            }
        }
    }
}

impl Shelf {
    fn amount_at(&self, share: f32) -> f32 {
        self.amount[0] + (self.amount[1] - self.amount[0]) * share
    }

    /// Filters a sample of one side with the one-pole filter.
    fn low_pass(&mut self, side: usize, sample: f32, share: f32) -> f32 {
        let coefficient = self.coefficient[0] + (self.coefficient[1] - self.coefficient[0]) * share;
        let step = (sample - self.state[side]) * coefficient;
        let low = self.state[side] + step;
        self.state[side] = low + step;
        low
    }
}
