//! The bank as its users see it: load modes, strike them, move their pitch, hear them.

use super::ring::Ring;
use super::rows::{Form, Modes, Moving, Output, Row, State, Wide};
use super::step::Step;
use super::table::{Build, Table};
use super::tuning::{Aim, ChordLoss, Settle, Tune, Tuning, UNIT};
use super::{ExcitationGains, LEAST_LN_RADIUS, MAX_MODES, MOST_LN_RADIUS, ModeSetup};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::coefficients::{LN_MINUS_60_DB, angle_from_frequency};
use crate::dsp::exciter::Drive;
use crate::dsp::simd::vector::LANES;
use crate::dsp::simd::{Instructions, Level};
use libm::{cosf, sinf};

/// A bank is worth making tables for once it has rung freely at one pitch for a control tick per so many modes: with
/// few modes they are paid for in a tick, with 64 in about eight.
const MODES_PER_TICK: usize = 8;

/// A bank of modes, structure of arrays. Real-time safe throughout, but for [`ModeBank::new`] when it is the first.
///
/// Whatever is asked of it, and however often, the amplitude of a mode never exceeds the sum of what strikes have
/// brought: `force · gain` each. Pitch, damping and their changes can only take from it.
///
/// Modes that have rung freely at one pitch for a few control ticks are rendered a whole tick at a time, by tables; all
/// others are stepped. Which of the two depends on the modes and on what happens to them, never on the CPU or on how
/// frames are asked for.
#[derive(Clone, Debug)]
pub struct ModeBank {
    instructions: Instructions,
    sample_rate: f64,
    pub(super) len: usize,
    /// Modes from here on are at rest: a multiple of [`LANES`] or all, so that every CPU moves the same modes.
    pub(super) live: usize,
    /// Gains at full level, and whether any of them is not 1.
    gains: [Row; 2],
    stereo: bool,
    /// Some modes are so high that they are not heard at full level.
    faded: bool,
    /// Pitch ratio at which the coefficients are, or at which they are to arrive.
    ratio: f64,
    /// Frequencies or T60s have changed since the coefficients were made.
    retuned: bool,
    /// T60s have been taken over that the coefficients do not have yet.
    damped: bool,
    /// Frames until the next control tick.
    until_tick: usize,
    motion: Motion,
    /// The state, and that at the end of a tick that is rendered by tables; which is which changes with every such
    /// tick.
    states: [State; 2],
    current: usize,
    modes: Modes,
    tuning: Tuning,
    table: Table,
    output: Output,
    pub(super) ln_radius: Wide,
    half_angle: Wide,
}

/// How the pitch of a bank moves, and so how it is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    /// On a straight line of `frames` frames that ends at the next control tick.
    Line {
        frames: usize,
        /// Whether gains move as well.
        gains: bool,
        /// Whether a force has acted on the way.
        driven: bool,
    },
    /// The pitch stands still, and nothing has driven the bank since so many calls of [`ModeBank::sweep_to`].
    Still { ticks: usize },
    /// As before, and rendered by tables: so many frames of the present tick have been handed out.
    Tabled { handed_out: usize },
}

impl ModeBank {
    /// An empty bank.
    pub fn new(sample_rate: f64) -> Self {
        Self {
            instructions: Instructions::current(),
            sample_rate,
            len: 0,
            live: 0,
            gains: [Row::ONE; 2],
            stereo: false,
            faded: false,
            ratio: 1.0,
            retuned: false,
            damped: false,
            until_tick: 0,
            motion: Motion::Still { ticks: 0 },
            states: [State::REST; 2],
            current: 0,
            modes: Modes::UNSET,
            tuning: Tuning::UNSET,
            table: Table::EMPTY,
            output: [[0.0; CONTROL_FRAMES]; 2],
            ln_radius: [0.0; MAX_MODES],
            half_angle: [0.0; MAX_MODES],
        }
    }

    /// The level of instructions that the bank uses.
    pub fn instructions(&self) -> Level {
        self.instructions.level()
    }

    /// Fills the bank with modes at rest, at a pitch ratio of 1. Modes beyond [`MAX_MODES`] are left out. What the bank
    /// played before leaves no trace: it then gives the bits of a new one.
    pub fn load(&mut self, modes: impl Iterator<Item = ModeSetup>) {
        self.instructions = Instructions::current();
        (self.len, self.stereo, self.faded) = (0, false, false);
        // Both, since each becomes the other at the end of a tick that is rendered by tables.
        (self.states, self.motion) = ([State::REST; 2], Motion::Still { ticks: 0 });
        for (m, mode) in modes.take(MAX_MODES).enumerate() {
            self.len = m + 1;
            (self.gains[0].0[m], self.gains[1].0[m]) = (mode.left, mode.right);
            self.stereo |= mode.left != 1.0 || mode.right != 1.0;
            self.half_angle[m] = 0.5 * angle_from_frequency(mode.frequency, self.sample_rate);
            self.set_t60(m, mode.t60);
        }
        [self.modes.left, self.modes.right] = self.gains;
        [self.modes.left_step, self.modes.right_step] = [Row::ZERO; 2];
        for m in self.len..MAX_MODES {
            // What was loaded before must not be heard: lanes and tables are filled up with modes at rest.
            for row in [&mut self.modes.pulse_x, &mut self.modes.pulse_y, &mut self.modes.noise] {
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

    /// Sets how strongly mode `m` is moved by what drives the bank.
    pub fn set_excitation_gains(&mut self, m: usize, gains: ExcitationGains) {
        self.tune();
        let (x, y) = (gains.pull * self.tuning.pull_x.0[m], gains.push + gains.pull * self.tuning.pull_y.0[m]);
        (self.modes.pulse_x.0[m], self.modes.pulse_y.0[m]) = if gains.phase == 0.0 {
            (x, y)
        } else {
            let (sin, cos) = (sinf(gains.phase), cosf(gains.phase));
            (x * cos + y * sin, y * cos - x * sin)
        };
        self.modes.noise.0[m] = gains.noise;
    }

    /// Changes the T60 of mode `m` to `t60` seconds, at once. Follow with [`ModeBank::sweep_to`].
    pub fn set_t60(&mut self, m: usize, t60: f64) {
        self.leave_tables();
        self.ln_radius[m] = (LN_MINUS_60_DB / (t60 * self.sample_rate)).clamp(LEAST_LN_RADIUS, MOST_LN_RADIUS);
        self.retuned = true;
    }

    /// Gives the modes, in their order, new frequencies in Hz and T60s in seconds while they ring. The pitch stays where
    /// it is until [`ModeBank::sweep_to`], which must follow, moves it.
    pub fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        for (m, (frequency, t60)) in modes.take(self.len).enumerate() {
            self.half_angle[m] = 0.5 * angle_from_frequency(frequency, self.sample_rate);
            self.set_t60(m, t60);
        }
    }

    /// Takes over frequencies and T60s, if they have changed.
    fn tune(&mut self) {
        if std::mem::take(&mut self.retuned) {
            let Self { tuning, ln_radius, half_angle, len, .. } = self;
            self.instructions.run(Tune { tuning, ln_radius, half_angle, len: *len });
            self.damped = true;
        }
    }

    /// Moves every mode to a pitch ratio, in a straight line of the coefficients over `frames` frames: those until the
    /// next control tick, at which it is to be called again.
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        let frames = frames.max(1);
        let same = ratio == self.ratio && !self.retuned && !self.damped;
        match self.motion {
            Motion::Still { ticks } if same => {
                (self.motion, self.until_tick) = (Motion::Still { ticks: ticks + 1 }, frames);
                return;
            }
            Motion::Tabled { .. } if same => return self.until_tick = frames,
            _ => self.leave_tables(),
        }
        let (passed, left) = (self.passed(), self.until_tick);
        let (mut arrived, mut lost) = (false, None);
        if let Motion::Line { frames, driven, .. } = self.motion {
            arrived = same && passed == frames;
            // What a force has brought on the way has lost less: then nothing is given back.
            lost = (!driven).then(|| ChordLoss::new(passed, frames));
        }
        self.tune();
        (self.ratio, self.until_tick) = (ratio, frames);
        self.aim((!arrived).then_some(frames), [passed, left], lost);
    }

    /// Puts every mode at a pitch ratio at once: for modes at rest.
    pub fn jump_to(&mut self, ratio: f64) {
        self.leave_tables();
        self.tune();
        (self.ratio, self.until_tick) = (ratio, 0);
        self.aim(None, [0, 0], None);
    }

    /// Sends the coefficients to those of `ratio`, over so many frames or at once. Of the line before, so many frames
    /// have passed and so many are left, and what those that passed have lost is given back.
    fn aim(&mut self, frames: Option<usize>, [passed, left]: [usize; 2], lost: Option<ChordLoss>) {
        let fades = self.tuning.fades(self.ratio);
        let faded = std::mem::replace(&mut self.faded, fades);
        let moved = matches!(self.motion, Motion::Line { gains: true, .. });
        let gains = self.instructions.run(Aim {
            tuning: &mut self.tuning,
            modes: &mut self.modes,
            state: &mut self.states[self.current],
            ratio: self.ratio as f32,
            passed,
            left,
            lost,
            damped: std::mem::take(&mut self.damped),
            per_frame: frames.map(|frames| 1.0 / frames as f32),
            fade: (fades || faded || moved).then_some(&self.gains),
            live: self.live,
            len: self.len,
        });
        self.motion = match frames {
            Some(frames) => Motion::Line { frames, gains, driven: false },
            None => Motion::Still { ticks: 0 },
        };
    }

    /// Frames of a line that have passed.
    fn passed(&self) -> usize {
        if let Motion::Line { frames, .. } = self.motion { frames - self.until_tick } else { 0 }
    }

    /// Steps on from the start of a tick that is rendered by tables, to the frame that is next.
    fn leave_tables(&mut self) {
        if let Motion::Tabled { handed_out } = self.motion {
            self.motion = Motion::Still { ticks: 0 };
            if handed_out > 0 {
                self.step(&Drive::NONE, false, handed_out);
            }
        }
    }

    fn form(&self, driven: bool, frames: usize) -> Form {
        let moving = match self.motion {
            Motion::Line { gains: true, .. } => Moving::PitchAndGain,
            Motion::Line { .. } => Moving::Pitch,
            Motion::Still { .. } | Motion::Tabled { .. } => Moving::Nothing,
        };
        let line = if let Motion::Line { frames, .. } = self.motion { frames } else { 0 };
        let stereo = self.stereo || self.faded || moving == Moving::PitchAndGain;
        Form { moving, driven, stereo, live: self.live, frames, line, passed: self.passed() }
    }

    fn step(&mut self, drive: &Drive, driven: bool, frames: usize) {
        let form = self.form(driven, frames);
        let (modes, state, out) = (&self.modes, &mut self.states[self.current], &mut self.output);
        self.instructions.run(Step { form, modes, state, drive, out });
    }

    /// Makes the tables at the start of a tick, once that is worth while.
    fn make_tables(&mut self) {
        if let Motion::Still { ticks } = self.motion
            && ticks > self.len / MODES_PER_TICK
            && self.until_tick == CONTROL_FRAMES
        {
            let Self { table, ln_radius, half_angle, ratio, len, .. } = self;
            self.instructions.run(Build { table, ln_radius, half_angle, ratio: *ratio, len: *len });
            self.motion = Motion::Tabled { handed_out: 0 };
        }
    }

    /// Renders a whole tick by the tables.
    fn ring(&mut self) {
        let form = self.form(false, CONTROL_FRAMES);
        let [first, second] = &mut self.states;
        let (start, end) = if self.current == 0 { (first, second) } else { (second, first) };
        // What modes that have come to rest left here two ticks ago must not be struck to life.
        if self.live < self.len {
            end.x.0[self.live..self.len].fill(0.0);
            end.y.0[self.live..self.len].fill(0.0);
        }
        let (table, modes, out) = (&mut self.table, &self.modes, &mut self.output);
        self.instructions.run(Ring { form, table, modes, start, end, out });
    }

    /// The next frames, left and right: at most those until the next control tick, of which [`ModeBank::sweep_to`]
    /// has told.
    pub fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        debug_assert!(frames <= self.until_tick);
        let frames = frames.min(CONTROL_FRAMES);
        if let Some(drive) = drive {
            self.leave_tables();
            self.live = self.len;
            match &mut self.motion {
                Motion::Line { driven, .. } => *driven = true,
                still => *still = Motion::Still { ticks: 0 },
            }
            self.step(drive, true, frames);
        } else {
            self.make_tables();
            match self.motion {
                Motion::Tabled { handed_out: 0 } => self.ring(),
                Motion::Tabled { .. } => {}
                Motion::Line { .. } | Motion::Still { .. } => self.step(&Drive::NONE, false, frames),
            }
        }
        self.until_tick = self.until_tick.saturating_sub(frames);
        let stereo = self.form(false, frames).stereo;
        let (mut start, mut end) = (0, frames);
        if let Motion::Tabled { handed_out } = &mut self.motion {
            (start, end) = (*handed_out, CONTROL_FRAMES.min(*handed_out + frames));
            *handed_out = end % CONTROL_FRAMES;
            self.current ^= usize::from(end == CONTROL_FRAMES);
        }
        let [left, right] = &self.output;
        [&left[start..end], &(if stereo { right } else { left })[start..end]]
    }

    /// Where mode `m` is and its squared amplitude, at full gain: to look at. Within a tick that is rendered by tables,
    /// as of its start.
    pub fn mass(&self, m: usize) -> (f32, f32) {
        let State { x, y } = &self.states[self.current];
        (x.0[m], x.0[m] * x.0[m] + y.0[m] * y.0[m])
    }

    /// Frames that have been heard since the state was as [`ModeBank::mass`] has it.
    pub(super) fn frames_since(&self) -> usize {
        if let Motion::Tabled { handed_out } = self.motion { handed_out } else { 0 }
    }

    /// The sum of the squared amplitudes of the modes; those that have all but stopped are set to rest. To be called at
    /// control ticks.
    pub fn settle(&mut self) -> f64 {
        debug_assert!(self.frames_since() == 0);
        let state = &mut self.states[self.current];
        let total = self.instructions.run(Settle { state, live: self.live });
        let State { x, y } = state;
        while self.live > 0 && x.0[self.live - 1] == 0.0 && y.0[self.live - 1] == 0.0 {
            self.live -= 1;
        }
        self.live = self.live.next_multiple_of(LANES).min(self.len);
        f64::from(total) * f64::from(UNIT) * f64::from(UNIT)
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
