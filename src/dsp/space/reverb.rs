//! A reverb whose space is a resonant body: a plate, springs, a room, or sympathetic strings.

use super::decay::Decay;
use super::kernel::FRAMES;
use super::pre_delay::PreDelay;
use super::resonator::Resonator;
use super::smoothed::{Smoothed, held};
use super::ticks::Ticks;
use crate::dsp::ramp::Ramp;
use libm::{cos, sin};
use std::f64::consts::FRAC_PI_2;

/// Longest pre-delay in seconds.
pub const LONGEST_PRE_DELAY: f64 = 0.25;

/// Below this a tail is over: −120 dBFS.
const SILENCE: f64 = 1e-6;

/// Ticks between two measurements of the energy.
const MEASURE_TICKS: u64 = 32;

/// Seconds in which a body that is replaced fades out.
const LEAVE_SECONDS: f64 = 0.1;

/// Fainter input is silence to the body: masses that it moves would be slow to compute.
const FAINTEST_INPUT: f32 = 1e-15;

/// A stereo processor: the sum of both sides drives a [`Resonator`], whose pick-ups are added to what came in.
///
/// Real-time safe but for making it: [`ModalReverb::process`] and all setters neither allocate nor wait. Bits do not depend
/// on how frames are divided into blocks. Output is finite for finite input.
///
/// Once the input is silent and the tail is below −120 dBFS for certain, it sleeps: a silent block then costs one look at
/// its samples, and is left as it is. At a wet level of 0 it is off, and does not touch what passes where the dry level is 1.
#[derive(Clone, Debug)]
pub struct ModalReverb {
    sample_rate: f64,
    body: Resonator,
    /// The body before, which fades out by a factor, and whether that is over.
    leaving: Option<(Resonator, Ramp)>,
    left: Option<Resonator>,
    line: PreDelay,
    ticks: Ticks<{ FRAMES as u64 }>,
    dry: Smoothed,
    wet: Smoothed,
    /// What the levels are set to.
    levels: [f32; 2],
    state: State,
    /// Frames of silence at the input; very many if none came before.
    silent_frames: usize,
    /// Sum of the magnitudes of the input since the last control tick.
    input: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Awake,
    /// Everything is at rest, and input wakes it.
    Asleep,
    /// Everything is at rest, and a wet level wakes it.
    Off,
}

impl ModalReverb {
    /// A reverb with this body, off, without pre-delay. Allocates.
    pub fn new(body: Resonator) -> Self {
        let sample_rate = body.sample_rate();
        let line = PreDelay::new((LONGEST_PRE_DELAY * sample_rate) as usize, sample_rate);
        Self {
            sample_rate,
            body,
            leaving: None,
            left: None,
            silent_frames: usize::MAX,
            line,
            ticks: Ticks::default(),
            dry: Smoothed::new(1.0, sample_rate),
            wet: Smoothed::new(0.0, sample_rate),
            levels: [1.0, 0.0],
            state: State::Off,
            input: 0.0,
        }
    }

    /// The body that plays.
    pub fn body(&self) -> &Resonator {
        &self.body
    }

    /// From dry (0) to wet (1) at equal power: white noise stays as loud as it is.
    pub fn set_mix(&mut self, mix: f32) {
        let angle = FRAC_PI_2 * f64::from(mix.clamp(0.0, 1.0));
        let dry = if mix >= 1.0 { 0.0 } else { cos(angle) as f32 };
        self.set_levels(dry, sin(angle) as f32);
    }

    /// Gains of what comes in and of what the pick-ups hear, 1 being as loud as white noise that comes in. They move there
    /// in 20 ms; at once while nothing sounds.
    pub fn set_levels(&mut self, dry: f32, wet: f32) {
        let levels = [dry, wet].map(|level| if level.is_finite() { level.clamp(0.0, 10.0) } else { 0.0 });
        if levels == self.levels {
            return;
        }
        self.levels = levels;
        if self.state == State::Off && levels[1] > 0.0 {
            // What is dry may sound.
            self.wake();
        } else if self.state == State::Asleep {
            return self.jump_to_levels();
        }
        self.move_levels();
    }

    /// Gives the body another decay, in place: see [`Decay`].
    pub fn set_decay(&mut self, decay: Decay) {
        if decay != self.body.decay() {
            self.body.set_decay(decay);
            match self.state {
                State::Awake => self.move_levels(),
                State::Asleep => self.jump_to_levels(),
                State::Off => {}
            }
        }
    }

    /// The body takes over a decay that it was given while it was at rest, all at once.
    fn wake(&mut self) {
        self.state = State::Awake;
        self.body.finish_damping();
    }

    /// Time in seconds before the body hears what comes in, up to [`LONGEST_PRE_DELAY`]. Changes by a crossfade of 20 ms.
    pub fn set_pre_delay(&mut self, seconds: f64) {
        // What is no number is 0 as a whole one.
        let frames = (seconds.clamp(0.0, LONGEST_PRE_DELAY) * self.sample_rate) as usize;
        self.line.set(frames, self.state != State::Awake);
    }

    /// Goes on with another body, made elsewhere, from rest; the one that plays fades out in 100 ms, and is then handed out
    /// by [`ModalReverb::take_replaced`].
    ///
    /// # Errors
    ///
    /// `body` itself, if its sample rate is another, or if the one before has not been taken yet: try again later.
    #[allow(clippy::result_large_err, reason = "moved, so that nothing is allocated or freed")]
    pub fn replace_body(&mut self, mut body: Resonator) -> Result<(), Resonator> {
        if self.leaving.is_some() || self.left.is_some() || body.sample_rate() != self.sample_rate {
            return Err(body);
        }
        body.reset();
        body.finish_damping();
        let before = std::mem::replace(&mut self.body, body);
        if self.state == State::Awake {
            let mut fade = Ramp::at_rest(self.wet.after(0));
            fade.set(0.0, (LEAVE_SECONDS * self.sample_rate) as u32);
            self.leaving = Some((before, fade));
            // The new body is at rest: it may start at its own level.
            self.wet.jump(self.levels[1] * self.body.noise_gain());
        } else {
            self.left = Some(before);
            self.jump_to_levels();
        }
        Ok(())
    }

    /// A body that has been replaced and is silent: to be freed elsewhere than on the audio thread.
    pub fn take_replaced(&mut self) -> Option<Resonator> {
        self.left.take()
    }

    /// Whether it sleeps or is off: silence in gives silence out.
    pub fn is_silent(&self) -> bool {
        self.state != State::Awake
    }

    /// At most how many frames after the last that was processed it falls asleep, if only silence comes from there on.
    ///
    /// Energy is known in closed form, and nothing but decay takes it: no sample after the tail exceeds −120 dBFS. Real-time
    /// safe; takes a few microseconds.
    pub fn tail_frames(&self) -> u64 {
        if self.state != State::Awake {
            return 0;
        }
        let held = self.line.reach().saturating_sub(self.silent_frames) as u64;
        let moving = u64::from(self.wet.frames_left().max(self.dry.frames_left()));
        let leaving = if self.leaving.is_some() { (LEAVE_SECONDS * self.sample_rate) as u64 } else { 0 };
        let wet = self.loudest_wet();
        let rings = if wet > 0.0 { self.body.frames_until(SILENCE / wet, self.input) } else { 0 };
        let end = held.saturating_add(rings).max(moving).max(leaving).saturating_add(1);
        let mut ticks = self.ticks;
        ticks.advance(end as usize);
        // It falls asleep before the frame after.
        end.saturating_add(ticks.frames_until_every(MEASURE_TICKS)).saturating_add(1)
    }

    /// Silence, and all that moves where it is to be.
    pub fn reset(&mut self) {
        self.body.reset();
        if let Some((body, _)) = self.leaving.take() {
            self.left = Some(body);
        }
        self.line.clear();
        (self.ticks, self.input, self.silent_frames) = (Ticks::default(), 0.0, usize::MAX);
        self.jump_to_levels();
        self.state = if self.levels[1] > 0.0 { State::Asleep } else { State::Off };
    }

    /// Adds the space to what is in `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let (mut left, mut right) = (&mut left[..frames], &mut right[..frames]);
        while !left.is_empty() {
            if self.state != State::Awake && self.rest(left, right) {
                return self.ticks.advance(left.len());
            }
            if self.ticks.is_due() {
                self.control();
            }
            let frames = self.ticks.frames_before(left.len());
            let (now_left, now_right);
            (now_left, left) = left.split_at_mut(frames);
            (now_right, right) = right.split_at_mut(frames);
            if self.state == State::Asleep && !is_silent(now_left, now_right) {
                self.wake();
            }
            if self.state == State::Awake {
                self.render(now_left, now_right);
            } else {
                _ = self.rest(now_left, now_right);
            }
            self.ticks.advance(frames);
        }
    }

    /// What to do with a block at rest, if that is all of it: off, only the dry level counts; asleep, silence is left as it
    /// is.
    fn rest(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        if self.state == State::Asleep {
            return is_silent(left, right);
        }
        if !self.dry.rests_at(1.0) {
            for (left, right) in left.iter_mut().zip(right) {
                let dry = self.dry.after(0);
                (*left, *right) = (*left * dry, *right * dry);
                self.dry.advance(1);
            }
        }
        true
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let mut input = [0.0; FRAMES];
        for ((left, right), input) in left.iter().zip(&*right).zip(&mut input) {
            let sum = held(0.5 * (left + right));
            let heard = if sum.abs() >= FAINTEST_INPUT { sum } else { 0.0 };
            self.silent_frames = if heard == 0.0 { self.silent_frames.saturating_add(1) } else { 0 };
            self.input += f64::from(heard.abs());
            *input = self.line.next(heard);
        }
        let frames = left.len().min(FRAMES);
        let [wet_left, wet_right] = self.body.render(&input[..frames]);
        let moving = self.dry.is_moving() || self.wet.is_moving();
        let (mut dry, mut wet) = (self.dry.after(0), self.wet.after(0));
        for i in 0..frames {
            if moving {
                (dry, wet) = (self.dry.after(i), self.wet.after(i));
            }
            left[i] = left[i] * dry + wet_left[i] * wet;
            right[i] = right[i] * dry + wet_right[i] * wet;
        }
        self.dry.advance(frames);
        self.wet.advance(frames);
        if let Some((body, fade)) = &mut self.leaving {
            let [out_left, out_right] = body.render(&[0.0; FRAMES][..frames]);
            for i in 0..frames {
                let level = fade.after(i as u32);
                left[i] += out_left[i] * level;
                right[i] += out_right[i] * level;
            }
            fade.advance(frames as u32);
        }
    }

    /// What is done at a control tick.
    fn control(&mut self) {
        if self.state != State::Awake {
            return;
        }
        self.body.tick(std::mem::take(&mut self.input));
        if let Some((body, fade)) = self.leaving.take() {
            if fade.after(0) == 0.0 { self.left = Some(body) } else { self.leaving = Some((body, fade)) }
        }
        if !self.ticks.is_due_every(MEASURE_TICKS) {
            return;
        }
        let is_empty = self.silent_frames >= self.line.reach();
        self.body.measure(is_empty);
        if let Some((body, _)) = &mut self.leaving {
            body.measure(false);
        }
        let still = !self.dry.is_moving() && !self.wet.is_moving() && self.leaving.is_none();
        let off = self.levels[1] == 0.0;
        if still && (off || is_empty && self.body.peak(0.0) * self.loudest_wet() <= SILENCE) {
            self.body.reset();
            self.line.clear();
            self.silent_frames = usize::MAX;
            self.jump_to_levels();
            self.state = if off { State::Off } else { State::Asleep };
        }
    }

    /// The greatest wet gain from now on.
    fn loudest_wet(&self) -> f64 {
        f64::from(self.wet.after(0).max(self.wet.target()))
    }

    fn move_levels(&mut self) {
        self.dry.set(self.levels[0]);
        self.wet.set(self.levels[1] * self.body.noise_gain());
    }

    fn jump_to_levels(&mut self) {
        self.dry.jump(self.levels[0]);
        self.wet.jump(self.levels[1] * self.body.noise_gain());
    }
}

fn is_silent(left: &[f32], right: &[f32]) -> bool {
    left.iter().chain(right).all(|sample| *sample == 0.0)
}
