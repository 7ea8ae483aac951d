//! Up to 64 masses side by side, their ringing summed in one fixed order.
//!
//! State, law and tuning are here; `kernel` and `step` have what happens every sample, once for all vector
//! instructions (`vector`, `x86`, `neon`), `levels` compiles it for each and chooses, `control` what happens at control
//! ticks, `table` the tables of freely ringing modes, `classic` the original formulas. The vectors of an instruction
//! set, and calling what is compiled for one, are the only unsafe code of the crate.

mod classic;
mod control;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod kernel;
#[allow(unsafe_code)]
mod levels;
#[cfg(target_arch = "aarch64")]
#[allow(unsafe_code)]
mod neon;
#[allow(clippy::needless_range_loop, reason = "as in `kernel`")]
mod step;
mod table;
mod tail;
#[allow(clippy::needless_range_loop, reason = "as in `kernel`")]
mod vector;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod x86;

use super::coefficients::{LN_MINUS_60_DB, angle_from_frequency};
use super::exciter::Drive;
use super::{CONTROL_FRAMES, Coefficients};
use control::{Pitch, UNIT, Wide};
use kernel::{Form, Modes, Output, Row, State};
use levels::Kernels;
use std::f64::consts::PI;
use table::Table;
use vector::LANES;

pub use levels::Level;

/// Most modes in a bank.
pub const MAX_MODES: usize = 64;

/// Modes up to this angle per sample sound at full level; from here to π they fade out, and beyond they are silent.
const TOP_ANGLE: f64 = 0.98 * PI;

/// A mode that comes down from just below π would need a boost without bound; 2 serves those from 20 kHz at 48 kHz.
const HIGHEST_LEVEL: f32 = 2.0;

/// The logarithm of the smallest radius that the series for it can take: a T60 of 0.5 ms at 8 kHz, the least of a voice;
/// at 1 kHz modes ring for 3.8 ms at least.
const LEAST_LN_RADIUS: f64 = -1.8;

/// Control ticks for which a bank must have rung freely before it is worth making its tables: `WAIT + modes / 8`.
/// With one mode a table is paid for in a tick, with 64 in about eight.
const WAIT: usize = 1;

/// Which formulas turn pitch and decay into coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Tuning and decay are exact ([`super::Coefficients::exact`]), the pitch bends exactly, the level does not depend on it.
    Exact,
    /// The original formulas ([`super::Coefficients::seed`]), the sweep used as the pitch ratio, clamped short of exploding.
    Classic,
}

/// One mode as it is loaded into a bank.
#[derive(Clone, Copy, Debug)]
pub struct ModeSetup {
    /// Frequency in Hz at a pitch ratio of 1.
    pub frequency: f64,
    /// T60 in seconds.
    pub t60: f64,
    /// Output gain to the left.
    pub left: f32,
    /// Output gain to the right.
    pub right: f32,
}

/// How strongly one mode is moved.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    /// Amplitude that a pulse of unit area gives by pushing (a strike).
    pub push: f32,
    /// Amplitude that a pulse of unit area gives by displacing (a pluck).
    pub pull: f32,
    /// Expected amplitude that a noise burst of unit force gives.
    pub noise: f32,
}

/// A bank of modes, structure of arrays. Real-time safe throughout, but for [`ModeBank::new`] when it is the first.
///
/// The output of a mode is its displacement times a level that keeps the amplitude independent of the pitch (exact
/// law): a slow sweep leaves the area of the orbit in `(x, v)` alone, which is `A² ω cos(θ/2)`, so `x` grows as
/// `1/√cos(θ/2)` and the level falls with it.
///
/// Modes of the exact law that have rung freely at a steady pitch for a few control ticks are rendered a whole tick
/// at a time, by tables; all others are stepped. Which of the two depends on the modes and on what happens to them,
/// never on the CPU or on how frames are asked for.
#[derive(Clone, Debug)]
pub struct ModeBank {
    kernels: &'static Kernels,
    sample_rate: f64,
    law: Law,
    len: usize,
    /// Modes from here on are at rest: a multiple of [`LANES`] or all, so that every CPU moves the same modes.
    live: usize,
    /// Gains are not all 1.
    stereo: bool,
    ratio: f64,
    /// Frames until the next control tick.
    until_tick: usize,
    /// Frames until sweeps and levels arrive at those of `ratio`, and how many of the line modes at rest have missed.
    line_frames: usize,
    missed_frames: usize,
    /// Sweeps and levels are those of `ratio` and stay there.
    settled: bool,
    /// And they are all exactly 1, so that the plain step gives the same bits.
    unswept: bool,
    /// Decay has changed since the coefficients were made.
    untuned: bool,
    /// Control ticks since the bank has rung freely at a steady pitch.
    steady_ticks: usize,
    /// The tables are those of the coefficients, sweeps and levels.
    tabled: bool,
    /// The state is that of the tables: the second coordinate is not the velocity.
    ahead: bool,
    /// Within a tick that is rendered by tables: how many of its frames have been handed out.
    handed_out: Option<usize>,
    /// The state, and that at the end of a tick that is rendered by tables; which is which changes with every such
    /// tick.
    states: [State; 2],
    current: usize,
    modes: Modes,
    pitch: Pitch,
    table: Table,
    output: Output,
    ln_radius: Wide,
    half_angle: Wide,
}

impl ModeBank {
    /// An empty bank.
    pub fn new(sample_rate: f64) -> Self {
        let zero = || Row::ZERO;
        Self {
            kernels: Kernels::current(),
            sample_rate,
            law: Law::Exact,
            len: 0,
            live: 0,
            stereo: false,
            ratio: 1.0,
            until_tick: 0,
            line_frames: 0,
            missed_frames: 0,
            settled: true,
            unswept: true,
            untuned: false,
            steady_ticks: 0,
            tabled: false,
            ahead: false,
            handed_out: None,
            states: [State::REST; 2],
            current: 0,
            modes: Modes {
                zeta: zero(),
                omega2: zero(),
                sweep: Row::ONE,
                sweep_step: zero(),
                level: Row::ONE,
                level_step: zero(),
                least: zero(),
                left: Row::ONE,
                right: Row::ONE,
                push: zero(),
                pull: zero(),
                noise: zero(),
            },
            pitch: Pitch::UNSET,
            table: Table::EMPTY,
            output: [[0.0; CONTROL_FRAMES]; 2],
            ln_radius: [0.0; MAX_MODES],
            half_angle: [0.0; MAX_MODES],
        }
    }

    /// The level of instructions that the bank uses.
    pub fn instructions(&self) -> Level {
        self.kernels.level()
    }

    /// Fills the bank with modes at rest, at a pitch ratio of 1. Modes beyond [`MAX_MODES`] are left out.
    pub fn load(&mut self, law: Law, modes: impl Iterator<Item = ModeSetup>) {
        (self.law, self.len, self.stereo) = (law, 0, false);
        (self.states[self.current], self.ahead, self.handed_out) = (State::REST, false, None);
        for (m, mode) in modes.take(MAX_MODES).enumerate() {
            self.len = m + 1;
            (self.modes.left.0[m], self.modes.right.0[m]) = (mode.left, mode.right);
            self.stereo |= mode.left != 1.0 || mode.right != 1.0;
            self.half_angle[m] = 0.5 * angle_from_frequency(mode.frequency, self.sample_rate);
            self.set_t60(m, mode.t60);
        }
        for m in self.len..MAX_MODES {
            // What was loaded before must not be heard: lanes and tables are filled up with modes at rest.
            for row in [&mut self.modes.push, &mut self.modes.pull, &mut self.modes.noise] {
                row.0[m] = 0.0;
            }
        }
        self.live = self.len;
        self.jump_to(1.0);
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the bank has no modes.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Changes the T60 of mode `m` to `t60` seconds. The displacement is continuous. Follow with [`ModeBank::sweep_to`].
    pub fn set_t60(&mut self, m: usize, t60: f64) {
        self.leave_tables();
        self.ln_radius[m] = (LN_MINUS_60_DB / (t60 * self.sample_rate)).max(LEAST_LN_RADIUS);
        (self.untuned, self.settled, self.unswept) = (true, false, false);
    }

    /// Makes the coefficients, if decay has changed.
    fn tune(&mut self) {
        if !std::mem::take(&mut self.untuned) {
            return;
        }
        match self.law {
            Law::Exact => {
                self.kernels.tune(&mut self.pitch, &mut self.modes, &self.ln_radius, &self.half_angle, self.len);
            }
            Law::Classic => (0..self.len).for_each(|m| self.tune_classic(m)),
        }
    }

    /// Sets how strongly mode `m` is moved by what drives the bank.
    pub fn set_coupling(&mut self, m: usize, coupling: Coupling) {
        self.tune();
        // A push gives the mass the velocity, a pull the displacement, of a ringing of unit amplitude.
        let (push, pull) = (self.pitch.unit_push.0[m], self.pitch.unit_pull.0[m]);
        self.modes.push.0[m] = coupling.push * push;
        self.modes.pull.0[m] = coupling.pull * pull;
        self.modes.noise.0[m] = coupling.noise * push;
    }

    /// Gives the modes, in their order, new frequencies in Hz and T60s in seconds while they ring. What is heard is
    /// continuous: the pitch stays where it is until [`ModeBank::sweep_to`], which must follow, moves it.
    pub fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        self.leave_tables();
        self.catch_up();
        let (omega2, inverse_bow) = (self.modes.omega2, self.pitch.inverse_bow);
        for (m, (frequency, t60)) in modes.take(self.len).enumerate() {
            self.half_angle[m] = 0.5 * angle_from_frequency(frequency, self.sample_rate);
            self.set_t60(m, t60);
        }
        self.tune();
        let state = &mut self.states[self.current];
        for m in 0..self.len {
            // Sweep times ω, velocity times sweep, and displacement times level are what was before.
            let stretch = libm::sqrtf(self.modes.omega2.0[m] / omega2.0[m]);
            let boost = self.pitch.inverse_bow.0[m] / inverse_bow.0[m];
            self.modes.sweep.0[m] /= stretch;
            self.modes.level.0[m] *= boost;
            state.x.0[m] /= boost;
            state.v.0[m] *= stretch / boost;
        }
        // No ratio that comes next is the one that the sweeps are at.
        (self.ratio, self.line_frames) = (f64::NAN, 0);
        (self.tabled, self.steady_ticks) = (false, 0);
    }

    /// Moves every mode to a pitch ratio, in a straight line of sweep and level over `frames` frames: those until the
    /// next control tick, at which it is to be called again.
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        self.until_tick = frames;
        if ratio == self.ratio && self.settled {
            return self.make_tables();
        }
        self.leave_tables();
        self.catch_up();
        self.tune();
        (self.tabled, self.steady_ticks) = (false, 0);
        let arrived = ratio == self.ratio && self.line_frames == 0;
        self.ratio = ratio;
        self.line_frames = if arrived { 0 } else { frames };
        // Once arrived, what the steps of the line left by rounding is dropped.
        self.aim(1.0 / frames as f32, arrived);
        (self.settled, self.unswept) = (false, false);
        if arrived {
            self.rest_sweep();
        }
    }

    /// Puts every mode at a pitch ratio at once: for modes at rest.
    pub fn jump_to(&mut self, ratio: f64) {
        self.leave_tables();
        self.tune();
        (self.tabled, self.steady_ticks) = (false, 0);
        self.ratio = ratio;
        (self.until_tick, self.line_frames, self.missed_frames) = (0, 0, 0);
        self.aim(0.0, true);
        self.rest_sweep();
    }

    /// Sends sweeps and levels to those of `ratio`, at once if `jump`.
    fn aim(&mut self, per_frame: f32, jump: bool) {
        let (modes, pitch) = (&mut self.modes, &self.pitch);
        if self.law == Law::Exact && self.ratio != 1.0 {
            return self.kernels.aim(pitch, modes, self.ratio as f32, per_frame, jump, self.len);
        }
        for m in 0..self.len {
            let sweep = match self.law {
                Law::Exact => 1.0,
                Law::Classic => {
                    let (zeta, omega2) = (f64::from(modes.zeta.0[m]), f64::from(modes.omega2.0[m]));
                    self.ratio.min(classic::limit(zeta) / libm::sqrt(omega2)) as f32
                }
            };
            let level = pitch.rest_level.0[m];
            if jump {
                (modes.sweep.0[m], modes.level.0[m]) = (sweep, level);
            }
            modes.sweep_step.0[m] = (sweep - modes.sweep.0[m]) * per_frame;
            modes.level_step.0[m] = (level - modes.level.0[m]) * per_frame;
        }
    }

    /// Sweeps and levels are where they belong; notices whether they are all exactly 1.
    fn rest_sweep(&mut self) {
        let all_one = |row: &Row| row.0[..self.len].iter().all(|value| *value == 1.0);
        self.unswept = all_one(&self.modes.sweep) && all_one(&self.modes.level);
        self.settled = true;
    }

    /// Moves the modes at rest, which the kernels leave out, along the line that the others have gone.
    fn catch_up(&mut self) {
        let frames = std::mem::take(&mut self.missed_frames) as f32;
        if frames > 0.0 {
            let modes = &mut self.modes;
            for m in self.live..self.len {
                modes.sweep.0[m] += modes.sweep_step.0[m] * frames;
                modes.level.0[m] += modes.level_step.0[m] * frames;
            }
        }
    }

    /// At a control tick of a settled bank: makes the tables, once that is worth while.
    fn make_tables(&mut self) {
        if self.until_tick != CONTROL_FRAMES || self.law == Law::Classic || self.tabled {
            return;
        }
        self.steady_ticks += 1;
        if self.steady_ticks > WAIT + self.len / 8 {
            self.kernels.build(&mut self.table, &self.modes, self.len);
            self.tabled = true;
        }
    }

    /// Goes back to the state that is stepped, within a tick at the frame that is next.
    fn leave_tables(&mut self) {
        if std::mem::take(&mut self.ahead) {
            self.kernels.convert(&self.table.turn, &mut self.states[self.current], false, self.live);
        }
        if let Some(frames) = self.handed_out.take() {
            self.step(&Drive::NONE, false, frames);
        }
    }

    fn form(&self, driven: bool, frames: usize) -> Form {
        let fused = self.law == Law::Exact;
        Form { swept: !self.unswept, driven, stereo: self.stereo, fused, live: self.live, frames }
    }

    fn step(&mut self, drive: &Drive, driven: bool, frames: usize) {
        let (form, state) = (self.form(driven, frames), &mut self.states[self.current]);
        self.kernels.step(form, &mut self.modes, state, drive, &mut self.output);
    }

    /// The next frames, left and right: at most those until the next control tick, of which [`ModeBank::sweep_to`]
    /// has told.
    pub fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        debug_assert!(frames <= self.until_tick);
        let frames = frames.min(CONTROL_FRAMES);
        if let Some(drive) = drive {
            self.leave_tables();
            self.catch_up();
            (self.live, self.steady_ticks) = (self.len, 0);
            self.step(drive, true, frames);
        } else if self.handed_out.is_none() {
            if self.tabled && self.until_tick == CONTROL_FRAMES {
                self.handed_out = Some(0);
                if !std::mem::replace(&mut self.ahead, true) {
                    self.kernels.convert(&self.table.turn, &mut self.states[self.current], true, self.live);
                }
                let form = self.form(false, CONTROL_FRAMES);
                let [first, second] = &mut self.states;
                let (start, end) = if self.current == 0 { (first, second) } else { (second, first) };
                self.kernels.ring(form, &mut self.table, &self.modes, start, end, &mut self.output);
                // What modes that have come to rest left here two ticks ago must not be struck to life.
                end.x.0[self.live..self.len].fill(0.0);
                end.v.0[self.live..self.len].fill(0.0);
            } else {
                self.leave_tables();
                self.step(&Drive::NONE, false, frames);
            }
        }
        self.until_tick = self.until_tick.saturating_sub(frames);
        let moved = self.line_frames.min(frames);
        self.line_frames -= moved;
        self.missed_frames += moved;
        let start = self.handed_out.unwrap_or(0);
        let end = CONTROL_FRAMES.min(start + frames);
        if self.handed_out.is_some() {
            self.handed_out = (end < CONTROL_FRAMES).then_some(end);
            self.current ^= usize::from(end == CONTROL_FRAMES);
        }
        let [left, right] = &self.output;
        [&left[start..end], &(if self.stereo { right } else { left })[start..end]]
    }

    /// Where mode `m` is, as heard at full gain, and its squared amplitude: to look at. Within a tick that is rendered
    /// by tables, as of its start.
    pub fn motion(&self, m: usize) -> (f32, f32) {
        let level = self.modes.level.0[m];
        (self.states[self.current].x.0[m] * level, self.energy(m) * level * level)
    }

    /// The squared amplitude of mode `m`, but for its level.
    fn energy(&self, m: usize) -> f32 {
        let State { x, v } = &self.states[self.current];
        let (x, v, sweep) = (x.0[m], v.0[m], self.modes.sweep.0[m]);
        if self.ahead {
            x * x + v * v
        } else {
            let c = Coefficients {
                zeta: self.modes.zeta.0[m].into(),
                omega2: f64::from(self.modes.omega2.0[m] * sweep * sweep),
                x0: 0.0,
                v0: 0.0,
            };
            (c.energy(x.into(), f64::from(v * sweep)) as f32).max(0.0)
        }
    }

    /// The sum of the squared amplitudes at which the modes ring, as heard; modes that have all but stopped are set
    /// to rest. To be called at control ticks.
    pub fn settle(&mut self) -> f64 {
        debug_assert!(self.handed_out.is_none());
        let total = match self.law {
            Law::Exact => {
                let state = &mut self.states[self.current];
                let total = self.kernels.take_stock(&self.pitch, &self.modes, state, self.ahead, self.live);
                f64::from(total) * f64::from(UNIT) * f64::from(UNIT)
            }
            Law::Classic => (0..self.live).map(|m| self.settle_classic(m)).sum(),
        };
        self.catch_up();
        let State { x, v } = &self.states[self.current];
        while self.live > 0 && x.0[self.live - 1] == 0.0 && v.0[self.live - 1] == 0.0 {
            self.live -= 1;
        }
        self.live = self.live.next_multiple_of(LANES).min(self.len);
        total
    }
}

#[cfg(test)]
mod tests;
