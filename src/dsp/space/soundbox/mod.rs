//! A body behind the voices: fixed resonances, each of them a mass, through which all that sounds passes.

mod bodies;
#[cfg(test)]
mod tests;

pub use bodies::{BoxBody, Resonance};

use super::ticks::Ticks;
use crate::dsp::coefficients::LN_MINUS_60_DB;
use crate::dsp::exciter::Drive;
use crate::dsp::mode_bank::{ExcitationGains, ExcitationRows, ModeBank, ModeRows, ModeSetup};
use crate::dsp::smoothed::{Smoothed, held};
use crate::dsp::{CONTROL_FRAMES, power_of_two};
use libm::{cos, exp2, expm1, log, log2, sin, sqrt};
use std::f64::consts::{FRAC_PI_2, PI};

/// Level at which a tail is over: −120 dBFS.
const SILENCE: f64 = 1e-6;
/// Smaller input counts as silence, since masses that it moves would be slow to compute.
const FAINTEST_INPUT: f32 = 1e-15;

/// A stereo processor: the mean of both sides drives up to 64 masses, whose sum takes the place of the input by a mix.
///
/// The masses have the frequencies of a body and not those of notes. So partials that move with a vibrato swell as they pass
/// its resonances, a strike needs some milliseconds to reach its peak, and a vocal tract has vowels. A [`ModeBank`] steps the
/// masses. While nothing comes in, they rest once they are certainly below −120 dBFS.
///
/// A frame leaves a mass of radius `r` and gain `g` at `r |z| + 2 g (1 − r) |input|` at most. So while the input is at most `p`,
/// no mass that starts at rest exceeds `2 g p` with the largest `g` on the way, however size and vowel move. Real-time safe once made. The output does not depend,
/// bit for bit, on the block size, and it is finite for finite input.
///
/// ```
/// use sprung::internals::space::{BoxBody, Soundbox};
///
/// let mut guitar = Soundbox::new(48_000.0);
/// guitar.set_body(BoxBody::guitar());
/// guitar.set_mix(1.0);
/// guitar.reset();
/// let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
/// (left[0], right[0]) = (1.0, 1.0);
/// guitar.process(&mut left, &mut right);
/// assert!(left[0].abs() < 0.5 && left[100] != 0.0);
/// ```
#[derive(Clone, Debug)]
pub struct Soundbox {
    sample_rate: f64,
    bank: ModeBank,
    body: &'static BoxBody,
    /// Another body that starts when the present one has faded out.
    next: Option<&'static BoxBody>,
    /// Size as a power of two.
    size: Smoothed,
    vowel: Smoothed,
    dry: Smoothed,
    wet: Smoothed,
    /// Targets of the levels, dry and wet.
    levels: [f32; 2],
    ticks: Ticks<{ CONTROL_FRAMES as u64 }>,
    /// Whether anything sounds or moves; otherwise all masses are at rest.
    is_awake: bool,
    /// The largest magnitude of the input since the last control tick.
    input: f32,
    /// Root of the energy of the masses at the last control tick.
    amplitude: f64,
}

impl Soundbox {
    /// A violin's body, off. Allocates.
    pub fn new(sample_rate: f64) -> Self {
        let smoothed = |value| Smoothed::new(value, sample_rate);
        let mut soundbox = Self {
            sample_rate,
            bank: ModeBank::new(sample_rate),
            body: BoxBody::violin(),
            next: None,
            size: smoothed(0.0),
            vowel: smoothed(0.0),
            dry: smoothed(1.0),
            wet: smoothed(0.0),
            levels: [1.0, 0.0],
            ticks: Ticks::default(),
            is_awake: false,
            input: 0.0,
            amplitude: 0.0,
        };
        soundbox.load();
        soundbox
    }

    /// Changes to another body. If the present one sounds, it fades out in 20 ms before.
    pub fn set_body(&mut self, body: &'static BoxBody) {
        if !std::ptr::eq(body, self.next.unwrap_or(self.body)) {
            self.next = Some(body);
            self.move_levels();
        }
    }

    /// Sets the size, a ratio from 1/16 to 16: all frequencies and bandwidths are divided by it. Moves in 20 ms.
    pub fn set_size(&mut self, size: f64) {
        self.move_to(|this| &mut this.size, log2(size.clamp(1.0 / 16.0, 16.0)) as f32);
    }

    /// Sets where among the vowels of a vocal tract the tongue stands, from 0 to 1. Moves in 20 ms.
    pub fn set_vowel(&mut self, vowel: f32) {
        self.move_to(|this| &mut this.vowel, vowel.clamp(0.0, 1.0));
    }

    fn move_to(&mut self, setting: impl Fn(&mut Self) -> &mut Smoothed, value: f32) {
        let is_awake = self.is_awake;
        let setting = setting(self);
        if setting.target() != value && is_awake {
            setting.set(value);
        } else if setting.target() != value && !value.is_nan() {
            setting.jump(value);
            self.load();
        }
    }

    /// Sets the mix from the input (0, off) to what the body makes of it (1) at equal power. Moves in 20 ms.
    pub fn set_mix(&mut self, mix: f32) {
        let mix = if mix.is_finite() { mix.clamp(0.0, 1.0) } else { 0.0 };
        let angle = FRAC_PI_2 * f64::from(mix);
        let dry = if mix >= 1.0 { 0.0 } else { cos(angle) as f32 };
        let levels = [dry, sin(angle) as f32];
        if levels != self.levels {
            // The dry signal may sound now, but a body that was on already hears nothing while it sleeps.
            let was_off = self.levels[1] == 0.0;
            self.levels = levels;
            if !self.is_awake && was_off {
                self.wake();
            }
            self.move_levels();
        }
    }

    fn move_levels(&mut self) {
        let [dry, wet] = self.levels;
        if self.is_awake {
            self.dry.set(dry);
            self.wet.set(if self.next.is_some() { 0.0 } else { wet });
        } else {
            self.dry.jump(dry);
            self.wet.jump(wet);
            if let Some(body) = self.next.take() {
                self.body = body;
                self.load();
            }
        }
    }

    fn wake(&mut self) {
        (self.is_awake, self.ticks, self.input, self.amplitude) = (true, Ticks::default(), 0.0, 0.0);
    }

    /// Loads the masses, at rest.
    fn load(&mut self) {
        let ratio = self.ratio();
        let setup = |mode: Resonance| {
            let ((frequency, t60), [left, right]) = (mode.tuned(ratio), mode.sides);
            ModeSetup { frequency, t60, left, right }
        };
        let rows: ModeRows = self.modes().map(setup).collect();
        self.bank.load(&rows);
        self.bank.jump_to(1.0);
        self.set_pushes();
    }

    /// The resonances of the present vowel.
    fn modes(&self) -> impl Iterator<Item = Resonance> + use<> {
        self.body.at(self.vowel.after(0).into())
    }

    /// The ratio of the frequencies to those of the body, at the present size.
    fn ratio(&self) -> f64 {
        power_of_two(-self.size.after(0)).into()
    }

    /// Sets how strongly the input moves each mass: a lasting sine at its frequency comes out with the gain of the resonance.
    fn set_pushes(&mut self) {
        let mut gains = ExcitationRows::all(ExcitationGains::NONE);
        let ratio = self.ratio();
        for (m, mode) in self.modes().enumerate() {
            let (_, t60) = mode.tuned(ratio);
            gains.push[m] = (-2.0 * expm1(LN_MINUS_60_DB / (t60 * self.sample_rate)) * mode.gain) as f32;
            // A displacement follows the input below its frequency; a velocity falls towards both sides.
            [gains.turn[0][m], gains.turn[1][m]] = if mode.is_velocity { [0.0, 1.0] } else { [1.0, 0.0] };
        }
        self.bank.set_excitation_gains(&gains);
    }

    /// Silences the masses and ends all ramps.
    pub fn reset(&mut self) {
        self.is_awake = false;
        for setting in [&mut self.size, &mut self.vowel] {
            setting.jump(setting.target());
        }
        self.move_levels();
        self.load();
    }

    /// Whether it does not change the signal.
    pub(crate) fn is_off(&self) -> bool {
        !self.is_awake && self.levels[1] == 0.0
    }

    /// Whether silent input changes nothing.
    pub fn is_idle(&self) -> bool {
        !self.is_awake
    }

    /// Changes `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let mut start = 0;
        while start < frames && !self.is_off() {
            if !self.is_awake {
                let is_sound = |frame: &usize| left[*frame].abs().max(right[*frame].abs()) >= FAINTEST_INPUT;
                let Some(first) = (start..frames).find(is_sound) else { return };
                start = first;
                self.wake();
            }
            if self.ticks.is_due() {
                self.control();
                if !self.is_awake {
                    continue;
                }
            }
            let end = start + self.ticks.frames_before(frames - start);
            self.render(&mut left[start..end], &mut right[start..end]);
            self.ticks.advance(end - start);
            start = end;
        }
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let (frames, mut drive, mut loudest) = (left.len(), Drive::NONE, self.input.to_bits());
        for ((left, right), force) in left.iter().zip(&*right).zip(&mut drive.push) {
            let input = held(0.5 * (left + right));
            *force = if input.abs() >= FAINTEST_INPUT { input } else { 0.0 };
            // Magnitudes have the order of their bits, whose maximum is found in vectors.
            loudest = loudest.max(force.abs().to_bits());
        }
        self.input = f32::from_bits(loudest);
        let sum = self.bank.render(Some(&drive), frames);
        let [dry, wet] = [self.dry.after(0), self.wet.after(0)];
        let is_moving = self.dry.is_moving() || self.wet.is_moving();
        for (side, wet_side) in [left, right].into_iter().zip(sum) {
            let samples = side.iter_mut().zip(wet_side);
            if is_moving {
                for (n, (sample, wet)) in samples.enumerate() {
                    *sample = *sample * self.dry.after(n) + wet * self.wet.after(n);
                }
            } else {
                samples.for_each(|(sample, wet_sample)| *sample = *sample * dry + wet_sample * wet);
            }
        }
        self.dry.advance(frames);
        self.wet.advance(frames);
    }

    /// Does the work of a control tick.
    fn control(&mut self) {
        self.amplitude = sqrt(self.bank.settle());
        let was_silent = std::mem::take(&mut self.input) == 0.0 && !self.ticks.is_start();
        if self.wet.rests_at(0.0)
            && let Some(body) = self.next.take()
        {
            (self.body, self.amplitude) = (body, 0.0);
            self.load();
            self.move_levels();
        }
        let is_over = self.levels[1] == 0.0 || was_silent && self.loudest(self.amplitude) <= SILENCE;
        if is_over && self.frames_moving() == 0 {
            self.is_awake = false;
            self.bank.rest();
            return;
        }
        if self.size.is_moving() || self.vowel.is_moving() {
            self.size.advance(CONTROL_FRAMES);
            self.vowel.advance(CONTROL_FRAMES);
            let (modes, ratio) = (self.modes(), self.ratio());
            self.bank.retune(modes.map(|mode| mode.tuned(ratio)));
            self.set_pushes();
        }
        self.bank.sweep_to(1.0, CONTROL_FRAMES);
    }

    /// Upper bound of the output of the masses while the root of their energy is `amplitude`.
    fn loudest(&self, amplitude: f64) -> f64 {
        // Each side's gain of a mass is at most √2 (Cauchy and Schwarz).
        let gains = sqrt(2.0 * self.bank.len() as f64);
        // Another body that waits will be heard at the full level.
        let waiting = self.next.map_or(0.0, |_| self.levels[1]);
        f64::from(self.wet.after(0).max(self.wet.target()).max(waiting)) * gains * amplitude
    }

    /// Upper bound of the root of the energy from now on, while the magnitude of the input is at most `peak`.
    fn most(&self, peak: f64) -> f64 {
        let gain = self.bodies().map(|body| body.most_gain()).fold(0.0, f64::max);
        self.amplitude + 2.0 * gain * peak.max(self.input.into())
    }

    /// The present body and the next.
    fn bodies(&self) -> impl Iterator<Item = &'static BoxBody> + use<> {
        [Some(self.body), self.next].into_iter().flatten()
    }

    fn frames_moving(&self) -> u64 {
        let settings = [&self.size, &self.vowel, &self.dry, &self.wet];
        let moving = settings.map(Smoothed::frames_left).into_iter().max().map_or(0, u64::from);
        // Another body starts at the tick after the present one has faded out, and fades in.
        moving + self.next.map_or(0, |_| CONTROL_FRAMES as u64 + u64::from(self.wet.frames()))
    }

    /// Upper bound of the frames until it rests, if `frames` frames of at most the magnitude `peak` come before the silence.
    /// Real-time safe.
    pub(crate) fn tail_frames_after(&self, frames: u64, peak: f64) -> u64 {
        if self.is_off() || !self.is_awake && frames == 0 {
            return frames;
        }
        let bandwidth = self.bodies().map(|body| body.least_bandwidth()).fold(f64::INFINITY, f64::min);
        let size = exp2(self.size.after(0).max(self.size.target()).into());
        let rate = PI * bandwidth / (size * self.sample_rate);
        let rings = (log(self.loudest(self.most(peak)) / SILENCE) / rate).max(0.0) as u64;
        // It rests from the first tick on before which the input was silent.
        let ticks = 2 * CONTROL_FRAMES as u64 + 1;
        frames.saturating_add(self.frames_moving()).saturating_add(rings).saturating_add(ticks)
    }

    /// Upper bound of the output from now on, if the magnitude of the input is at most `peak` on either side. Real-time safe.
    pub(crate) fn peak_after(&self, peak: f64) -> f64 {
        peak * f64::from(self.dry.after(0).max(self.dry.target())) + self.loudest(self.most(peak))
    }
}
