//! A reverb whose space is a resonant body: a plate, springs, a room, or sympathetic strings.

mod process;
mod tail;

use super::decay::Decay;
use super::modes::ModeSet;
use super::pre_delay::PreDelay;
use super::resonator::Resonator;
use super::ticks::{BODY_TICK, Ticks};
use crate::dsp::smoothed::Smoothed;
use libm::{cos, sin};
use std::f64::consts::FRAC_PI_2;

/// Longest pre-delay in seconds.
pub const LONGEST_PRE_DELAY: f64 = 0.25;

/// Level at which a tail is over: −120 dBFS.
const SILENCE: f64 = 1e-6;

/// Fewest ticks between two measurements of the energy.
const MEASURE_TICKS: u64 = 32;

/// A stereo processor: the sum of both sides drives a [`Resonator`], whose outputs are added to the input.
///
/// Real-time safe once created: [`ModalReverb::process`] and all setters neither allocate nor wait. The output does not depend,
/// bit for bit, on the block size, and it is finite for finite input.
///
/// Once the input is silent and the tail is certainly below −120 dBFS, it sleeps: a silent block then costs one look at its
/// samples, and is not changed. At a wet level of 0 it is off, and does not change the signal if the dry level is 1.
///
/// A clone has no room to spare: it may allocate when it first wakes, and needs another for a larger body.
#[derive(Clone, Debug)]
pub struct ModalReverb {
    sample_rate: f64,
    body: Resonator,
    /// The modes of the next body, which starts after the present one has faded out.
    next_body: Option<&'static ModeSet>,
    pitch: Smoothed,
    line: PreDelay,
    ticks: Ticks<{ BODY_TICK as u64 }>,
    /// Gain of the body's input. It is faded in when the body starts during a sound.
    drive: Smoothed,
    dry: Smoothed,
    wet: Smoothed,
    /// Targets of the levels, dry and wet.
    levels: [f32; 2],
    state: State,
    /// Frames of silence at the input; a very large number if it was always silent.
    silent_frames: usize,
    /// Sum of the magnitudes of the input since the last control tick.
    input: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Awake,
    /// Everything is at rest. Input wakes it.
    Asleep,
    /// Everything is at rest. A wet level above 0 wakes it.
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
            next_body: None,
            pitch: Smoothed::new(1.0, sample_rate),
            silent_frames: usize::MAX,
            line,
            ticks: Ticks::default(),
            drive: Smoothed::new(1.0, sample_rate),
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

    /// Sets the mix from dry (0) to wet (1) at equal power: the level of white noise does not change.
    pub fn set_mix(&mut self, mix: f32) {
        let angle = FRAC_PI_2 * f64::from(mix.clamp(0.0, 1.0));
        let dry = if mix >= 1.0 { 0.0 } else { cos(angle) as f32 };
        self.set_levels(dry, sin(angle) as f32);
    }

    /// Sets the gains of the input and of the body, where 1 means as loud as the input for white noise. They change in 20 ms, and
    /// a body that was off is faded in; while it sleeps, and with [`ModalReverb::reset`], they change at once.
    pub fn set_levels(&mut self, dry: f32, wet: f32) {
        let levels = [dry, wet].map(|level| if level.is_finite() { level.clamp(0.0, 10.0) } else { 0.0 });
        if levels == self.levels {
            return;
        }
        self.levels = levels;
        if self.state == State::Off && levels[1] > 0.0 {
            // The dry signal may sound now.
            self.begin();
        } else if self.state == State::Asleep {
            return self.jump_to_levels();
        }
        self.move_levels();
    }

    /// Sets another decay of the body: see [`Decay`].
    pub fn set_decay(&mut self, decay: Decay) {
        if decay != self.body.decay() {
            self.body.set_decay(decay);
            if self.state == State::Asleep {
                self.jump_to_levels();
            }
        }
    }

    /// Wakes the reverb, and starts its clock. The body first applies what was set while it was at rest.
    fn wake(&mut self) {
        (self.state, self.ticks) = (State::Awake, Ticks::default());
        self.body.prepare();
    }

    /// Begins to play a body at rest during a sound, which fades in. It is prepared in its first block.
    fn begin(&mut self) {
        (self.state, self.ticks) = (State::Awake, Ticks::default());
        self.body.begin();
        self.drive.jump(0.0);
        self.drive.set(1.0);
    }

    /// Control ticks of a block of the body, at whose beginning its pitch moves.
    fn block_ticks(&self) -> u64 {
        self.body.block_frames() as u64 / BODY_TICK as u64
    }

    /// Control ticks between two measurements: whole blocks.
    fn measure_ticks(&self) -> u64 {
        self.block_ticks().max(MEASURE_TICKS)
    }

    /// Sets the pre-delay in seconds, up to [`LONGEST_PRE_DELAY`]. Changes by a crossfade of 20 ms.
    pub fn set_pre_delay(&mut self, seconds: f64) {
        // NaN becomes 0 in the conversion to an integer.
        let frames = (seconds.clamp(0.0, LONGEST_PRE_DELAY) * self.sample_rate) as usize;
        self.line.set(frames, self.state != State::Awake);
    }

    /// Changes to a body with other modes, at rest. If the present one sounds, it is first faded out in 20 ms.
    ///
    /// Real-time safe if the body has room for as many modes ([`Resonator::with_room`]).
    pub fn set_body(&mut self, modes: &'static ModeSet) {
        if self.state == State::Awake {
            self.next_body = Some(modes);
            self.move_levels();
        } else {
            self.body.load(modes);
            self.jump_to_levels();
        }
    }

    /// Sets the ratio of all frequencies to those of the body's modes, from 1/64 to 64: in 20 ms, or at once while nothing
    /// sounds. Modes near half the sample rate or above are silent. Ringing modes continue at the new pitch.
    pub fn set_pitch(&mut self, pitch: f32) {
        let pitch = pitch.clamp(1.0 / 64.0, 64.0);
        if self.state == State::Awake {
            self.pitch.set(pitch);
        } else if !pitch.is_nan() && !self.pitch.rests_at(pitch) {
            self.pitch.jump(pitch);
            self.body.tune(pitch.into());
            self.jump_to_levels();
        }
    }

    /// Whether it sleeps or is off: silent input gives silent output.
    pub fn is_silent(&self) -> bool {
        self.state != State::Awake
    }

    /// Whether it is off and no level is moving: the signal is not changed.
    pub(crate) fn is_off(&self) -> bool {
        self.state == State::Off && self.dry.rests_at(1.0)
    }

    /// Whether silent input changes nothing.
    pub fn is_idle(&self) -> bool {
        self.state != State::Awake && !self.dry.is_moving()
    }

    /// Silences the body and ends all ramps.
    pub fn reset(&mut self) {
        self.body.reset();
        self.finish();
        self.line.clear();
        (self.input, self.silent_frames) = (0.0, usize::MAX);
        self.drive.jump(1.0);
        self.jump_to_levels();
        self.state = if self.levels[1] > 0.0 { State::Asleep } else { State::Off };
    }

    /// Whether no setting is moving.
    fn is_still(&self) -> bool {
        let levels = [&self.drive, &self.dry, &self.wet];
        !levels.iter().any(|level| level.is_moving()) && !self.pitch.is_moving() && self.next_body.is_none()
    }

    /// Starts the next body, if there is one, and sets the target pitch.
    fn finish(&mut self) {
        if let Some(modes) = self.next_body.take() {
            self.body.load(modes);
        }
        if self.pitch.is_moving() {
            self.pitch.jump(self.pitch.target());
            self.body.tune(self.pitch.target().into());
        }
    }

    fn move_levels(&mut self) {
        self.dry.set(self.levels[0]);
        let fades = self.next_body.is_some();
        self.wet.set(if fades { 0.0 } else { self.levels[1] * self.body.heard_noise_gain() });
    }

    fn jump_to_levels(&mut self) {
        self.dry.jump(self.levels[0]);
        self.wet.jump(self.levels[1] * self.body.noise_gain());
    }
}
