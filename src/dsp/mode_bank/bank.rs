//! The public interface of the bank: load modes, excite them, change their pitch and decay, render.

use super::played::{Part, play};
use super::ring::Ring;
use super::rows::{Form, Modes, Moving, Output, Row, State, Wide};
use super::step::Step;
use super::table::{Build, Table};
use super::tuning::{Aim, ChordLoss, Displace, Settle, TOP_ANGLE, Tune, Tuning, UNIT};
use super::{ExcitationRows, LEAST_LN_RADIUS, MAX_MODES, MOST_LN_RADIUS, ModeRows};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::coefficients::{LN_MINUS_60_DB, angle_from_frequency};
use crate::dsp::exciter::{Drive, Player};
use crate::dsp::simd::Instructions;
use crate::dsp::simd::vector::LANES;
use libm::{exp, expm1, sin};

/// The bank makes tables after free ringing at one pitch for one control tick per this many modes. With few modes, the
/// tables save the time that they cost within one tick, with 64 modes within about eight.
const MODES_PER_TICK: usize = 8;

/// What touches leaves a mode alone that a push would make less loud than this: its displacement is not known well enough.
const LEAST_PUSH: f64 = 1e-9;

/// A bank of modes, as a structure of arrays. Real-time safe, except for the first [`ModeBank::new`], which detects the
/// CPU.
///
/// Without a player, for any sequence of calls, the amplitude of a mode never exceeds the sum of `force · gain` over all strikes, plus
/// the amplitudes of all nudges. Pitch, damping and their changes can only reduce it. What a player brings is bounded in other norms.
///
/// Modes that have rung freely at one pitch for a few control ticks are rendered one whole tick at a time, with tables.
/// Otherwise they are stepped. The choice depends on the modes and on the calls, never on the CPU or on block sizes.
#[derive(Clone, Debug)]
pub struct ModeBank {
    pub(super) instructions: Instructions,
    sample_rate: f64,
    pub(super) len: usize,
    /// Modes from this index on are at rest. A multiple of [`LANES`] or all modes, so that every CPU computes the same
    /// modes.
    pub(super) live: usize,
    /// Output gains without the fade at the top of the spectrum, left and right, and whether any of them is not 1.
    gains: [Row; 2],
    stereo: bool,
    /// Factors of these gains, 0–1, whether there are any, and whether they are new since the last ramp.
    colour: Row,
    is_coloured: bool,
    recoloured: bool,
    /// Whether noise acts on `x` of any mode.
    turned_noise: bool,
    /// Whether some modes are so high that their gains are reduced.
    faded: bool,
    /// Pitch ratio of the coefficients, or their target while they move.
    ratio: f64,
    /// Whether frequencies or T60s have changed since the coefficients were computed.
    retuned: bool,
    /// Whether frequencies are among these.
    transposed: bool,
    /// Whether `tuning` has new T60s that the coefficients do not use yet.
    damped: bool,
    /// Whether the displaced states in `tuning` are those of the present frequencies and T60s.
    displaced: bool,
    /// Whether the coefficients have been computed since the modes were loaded.
    aimed: bool,
    /// Frames until the next control tick.
    until_tick: usize,
    motion: Motion,
    /// The state, and the state at the end of a tick that is rendered by tables. The two swap roles after every such
    /// tick; `current` is the index of the state.
    pub(super) states: [State; 2],
    pub(super) current: usize,
    modes: Modes,
    tuning: Tuning,
    table: Table,
    output: Output,
    pub(super) ln_radius: Wide,
    half_angle: Wide,
}

/// The motion of the pitch, which decides how the bank is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    /// A linear ramp of `frames` frames that ends at the next control tick.
    Line {
        frames: usize,
        /// Whether gains change as well.
        gains: bool,
        /// Whether an excitation force has acted during the ramp.
        driven: bool,
    },
    /// The pitch does not move, and no force has acted during the last `ticks` calls of [`ModeBank::sweep_to`].
    Still { ticks: usize },
    /// The pitch does not move, and tables are used: `handed_out` frames of the present tick have been returned.
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
            colour: Row::ONE,
            is_coloured: false,
            recoloured: false,
            turned_noise: false,
            faded: false,
            ratio: 1.0,
            retuned: false,
            transposed: false,
            damped: false,
            displaced: false,
            aimed: true,
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

    /// Fills the bank with modes at rest, at a pitch ratio of 1. Nothing remains of what the bank played before: it gives the
    /// same bits as a new one.
    pub fn load(&mut self, modes: &ModeRows) {
        self.instructions = Instructions::current();
        // Resets both states, since they swap roles after each tick that is rendered by tables.
        (self.states, self.motion) = ([State::REST; 2], Motion::Still { ticks: 0 });
        self.gains = [Row(modes.left), Row(modes.right)];
        self.len = modes.len.min(MAX_MODES);
        self.stereo = modes.left[..self.len].iter().chain(&modes.right[..self.len]).any(|gain| *gain != 1.0);
        (self.turned_noise, self.faded) = (false, false);
        (self.is_coloured, self.recoloured) = (false, false);
        for m in 0..self.len {
            self.half_angle[m] = half_angle(modes.frequency[m], self.sample_rate);
            self.ln_radius[m] = ln_radius(modes.t60[m], self.sample_rate);
        }
        [self.modes.left, self.modes.right] = self.gains;
        [self.modes.left_step, self.modes.right_step] = [Row::ZERO; 2];
        for m in self.len..MAX_MODES {
            // Clears the modes after the last, which fill up lanes and tables and must stay at rest.
            let Modes { push_x, push_y, pull_x, pull_y, noise_x, noise, take, take_y, give, .. } = &mut self.modes;
            [push_x, push_y, pull_x, pull_y, noise_x, noise, take, take_y, give]
                .into_iter()
                .for_each(|row| row.0[m] = 0.0);
            // Otherwise every change of damping would multiply their coefficients by the last factor of an earlier mode, until
            // they are infinite and the product with a state of 0 is NaN.
            self.tuning.shrink.0[m] = 0.0;
        }
        self.live = self.len;
        (self.ratio, self.until_tick) = (1.0, 0);
        // The coefficients are computed when they are needed, since a note jumps to its own pitch first.
        (self.retuned, self.transposed, self.displaced, self.aimed) = (true, false, false, false);
    }

    /// Number of modes.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Sets how strongly the pulse and noise excite the modes.
    pub fn set_excitation_gains(&mut self, gains: &ExcitationRows) {
        let ExcitationRows { push, pull, noise, turn: [cos, sin], turned_noise } = gains;
        let is_plucked = pull[..self.len].iter().any(|pull| *pull != 0.0);
        if is_plucked && !std::mem::replace(&mut self.displaced, true) {
            let Self { tuning, ln_radius, half_angle, len, .. } = self;
            self.instructions.run(Displace { tuning, ln_radius, half_angle, len: *len });
        }
        let (Modes { push_x, push_y, pull_x, pull_y, noise_x, noise: noise_y, .. }, tuning) =
            (&mut self.modes, &self.tuning);
        for m in 0..self.len {
            (push_x.0[m], push_y.0[m]) = (push[m] * sin[m], push[m] * cos[m]);
            (noise_x.0[m], noise_y.0[m]) = (0.0, noise[m]);
        }
        if is_plucked {
            for m in 0..self.len {
                let (x, y) = (pull[m] * tuning.pull_x.0[m], pull[m] * tuning.pull_y.0[m]);
                (pull_x.0[m], pull_y.0[m]) = (x * cos[m] + y * sin[m], y * cos[m] - x * sin[m]);
            }
        } else {
            (*pull_x, *pull_y) = (Row::ZERO, Row::ZERO);
        }
        if *turned_noise {
            for m in 0..self.len {
                (noise_x.0[m], noise_y.0[m]) = (noise[m] * sin[m], noise[m] * cos[m]);
            }
            self.turned_noise = true;
        }
    }

    /// Adds velocity to mode `m` in the direction in which it moves: its amplitude grows by `amplitude` at most, and the output
    /// does not jump. Does nothing if there is no mode `m`.
    pub(crate) fn nudge(&mut self, m: usize, amplitude: f32) {
        if m >= self.len {
            return;
        }
        self.leave_tables();
        match &mut self.motion {
            Motion::Line { driven, .. } => *driven = true,
            still => *still = Motion::Still { ticks: 0 },
        }
        let y = &mut self.states[self.current].y.0[m];
        *y += amplitude.copysign(*y);
        self.live = self.live.max((m + 1).next_multiple_of(LANES).min(self.len));
    }

    /// Sets what mode `m` takes of a player's force, and what it gives of its displacement: see `played` for both.
    pub(crate) fn set_contact(&mut self, m: usize, take: f32, give: f32) {
        (self.modes.take.0[m], self.modes.take_y.0[m], self.modes.give.0[m]) = (take, 0.0, give);
    }

    /// What a push of 1 gives mode `m`.
    pub(crate) fn push(&self, m: usize) -> f64 {
        self.modes.push_y.0[m].into()
    }

    /// Prepares mode `m` for what touches the body: an impulse of 1 gives it the amplitude `push`, and the point of touch, by this
    /// mode, the speed `weight`. Returns how far a force of 1 in a frame moves the point by this mode: until the frame's end, or,
    /// if the mode is too high to be rendered, for as long as the force lasts.
    pub(crate) fn set_touched(&mut self, m: usize, push: f64, weight: f64) -> [f64; 2] {
        let angle = 2.0 * self.half_angle[m] * self.ratio;
        let is_rendered = angle < TOP_ANGLE;
        if push.abs() < LEAST_PUSH || !is_rendered {
            self.set_contact(m, 0.0, 0.0);
            return [0.0, if is_rendered { 0.0 } else { weight / (angle * angle) }];
        }
        // The integral of e^(st) over a frame, (e^s − 1)/s, with s = ln r + iθ and e^s = 1 − α + iβ.
        let growth = self.ln_radius[m];
        let (real, imaginary) = if self.is_level() {
            (-f64::from(self.modes.alpha.0[m]), f64::from(self.modes.beta.0[m]))
        } else {
            let (radius, half) = (exp(growth), sin(0.5 * angle));
            (expm1(growth) - 2.0 * radius * half * half, radius * sin(angle))
        };
        let norm = growth * growth + angle * angle;
        let along = (real * growth + imaginary * angle) / norm;
        let across = (imaginary * growth - real * angle) / norm;
        let Modes { take, take_y, give, .. } = &mut self.modes;
        (take.0[m], take_y.0[m]) = ((push * across) as f32, (push * along) as f32);
        give.0[m] = (weight / (push * angle)) as f32;
        [weight * across / angle, 0.0]
    }

    /// What the modes give a player now.
    #[cfg(test)]
    pub(crate) fn given(&mut self) -> f32 {
        self.leave_tables();
        let x = &self.states[self.current].x;
        (0..self.len).map(|m| x.0[m] * self.modes.give.0[m]).sum()
    }

    /// Changes the T60 of mode `m` to `t60` seconds, at once. Follow with [`ModeBank::sweep_to`].
    pub(crate) fn set_t60(&mut self, m: usize, t60: f64) {
        self.leave_tables();
        self.ln_radius[m] = ln_radius(t60, self.sample_rate);
        (self.retuned, self.displaced) = (true, false);
    }

    /// Gives the modes, in their order, new frequencies in Hz and T60s in seconds while they ring. The pitch does not
    /// change until the next [`ModeBank::sweep_to`], which must follow.
    pub(crate) fn retune(&mut self, modes: impl Iterator<Item = (f64, f64)>) {
        for (m, (frequency, t60)) in modes.take(self.len).enumerate() {
            self.set_t60(m, t60);
            self.half_angle[m] = half_angle(frequency, self.sample_rate);
            self.transposed = true;
        }
    }

    /// As [`ModeBank::retune`], with the T60s that they have.
    pub(crate) fn transpose(&mut self, frequencies: impl Iterator<Item = f64>) {
        self.leave_tables();
        for (angle, frequency) in self.half_angle[..self.len].iter_mut().zip(frequencies) {
            *angle = half_angle(frequency, self.sample_rate);
        }
        (self.retuned, self.transposed, self.displaced) = (true, true, false);
    }

    /// Sets factors of the output gains, 0–1, one for each mode. The gains move with the next ramp or jump, which must follow.
    pub(crate) fn set_colour(&mut self, colour: [f32; MAX_MODES]) {
        let was_coloured = std::mem::replace(&mut self.is_coloured, colour[..self.len] != [1.0; MAX_MODES][..self.len]);
        self.recoloured |= was_coloured || self.is_coloured;
        self.colour = Row(colour);
    }

    /// Whether other frequencies wait for the next ramp.
    pub(crate) fn is_transposed(&self) -> bool {
        self.transposed
    }

    /// The ratio at which the modes turn; none within a ramp, and while other frequencies wait for one.
    pub(crate) fn pitch(&self) -> Option<f64> {
        (self.until_tick == 0 && !self.transposed).then_some(self.ratio)
    }

    /// Updates `tuning` if frequencies or T60s have changed.
    fn tune(&mut self) {
        self.transposed = false;
        if std::mem::take(&mut self.retuned) {
            let Self { tuning, ln_radius, half_angle, len, .. } = self;
            self.instructions.run(Tune { tuning, ln_radius, half_angle, len: *len });
            self.damped = true;
        }
    }

    /// Starts a linear ramp of every mode's coefficients to a pitch ratio, over `frames` frames. These are the frames until
    /// the next control tick, when this must be called again.
    pub fn sweep_to(&mut self, ratio: f64, frames: usize) {
        let frames = frames.max(1);
        if !self.aimed {
            self.jump_to(self.ratio);
        }
        let same = ratio == self.ratio && !self.retuned && !self.damped && !self.recoloured;
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
            // If a force acted late in the ramp, the loss of its part of the amplitude is smaller. So nothing is given back.
            lost = (!driven).then(|| ChordLoss::new(passed, frames));
        }
        self.tune();
        (self.ratio, self.until_tick) = (ratio, frames);
        self.aim((!arrived).then_some(frames), [passed, left], lost);
    }

    /// Sets the pitch ratio of every mode at once, without a ramp: for modes at rest or pushed just now.
    pub(crate) fn jump_to(&mut self, ratio: f64) {
        self.leave_tables();
        self.tune();
        (self.ratio, self.until_tick, self.aimed) = (ratio, 0, true);
        self.aim(None, [0, 0], None);
    }

    /// Sets the target of the coefficients to those of `ratio`, reached after `frames` frames, or at once if `None`. `passed`
    /// frames of the previous ramp have been rendered and `left` frames remain. `lost` is the loss of amplitude during the
    /// rendered frames, which is compensated.
    fn aim(&mut self, frames: Option<usize>, [passed, left]: [usize; 2], lost: Option<ChordLoss>) {
        let fades = self.tuning.fades(self.ratio);
        let faded = std::mem::replace(&mut self.faded, fades);
        let recoloured = std::mem::take(&mut self.recoloured);
        let moved = recoloured || matches!(self.motion, Motion::Line { gains: true, .. });
        let coloured = |side: &Row| Row(std::array::from_fn(|m| side.0[m] * self.colour.0[m]));
        let full = if self.is_coloured { &self.gains.each_ref().map(coloured) } else { &self.gains };
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
            fade: (fades || faded || moved).then_some(full),
            live: self.live,
            len: self.len,
        });
        self.motion = match frames {
            Some(frames) => Motion::Line { frames, gains, driven: false },
            None => Motion::Still { ticks: 0 },
        };
    }

    /// Whether the coefficients are those of the present frequencies, T60s and pitch ratio, and not on a ramp to them.
    fn is_level(&self) -> bool {
        !self.retuned && !self.damped && !matches!(self.motion, Motion::Line { .. })
    }

    /// Number of rendered frames of the present ramp.
    fn passed(&self) -> usize {
        if let Motion::Line { frames, .. } = self.motion { frames - self.until_tick } else { 0 }
    }

    /// Ends the use of tables: steps the state from the start of the present tick to the next frame.
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
        let stereo = self.stereo || self.faded || self.is_coloured || moving == Moving::PitchAndGain;
        let turned_noise = self.turned_noise;
        Form { moving, driven, turned_noise, stereo, live: self.live, frames, line, passed: self.passed() }
    }

    fn step(&mut self, drive: &Drive, driven: bool, frames: usize) {
        let form = self.form(driven, frames);
        let (modes, state, out) = (&self.modes, &mut self.states[self.current], &mut self.output);
        self.instructions.run(Step { form, modes, state, drive, out });
    }

    /// Prepares the modes for forces: all of them are live.
    fn leave_rest(&mut self) {
        self.leave_tables();
        self.live = self.len;
        match &mut self.motion {
            Motion::Line { driven, .. } => *driven = true,
            still => *still = Motion::Still { ticks: 0 },
        }
    }

    /// The bank for the next frames under a player, which count as rendered, and the place for what is heard of it: see [`play`].
    pub(crate) fn part(&mut self, frames: usize) -> (Part<'_>, &mut Output) {
        debug_assert!(frames <= self.until_tick);
        self.leave_rest();
        let form = self.form(true, frames);
        self.until_tick = self.until_tick.saturating_sub(frames);
        let Self { instructions, modes, states, current, output, .. } = self;
        (Part { instructions: *instructions, form, modes, state: &mut states[*current] }, output)
    }

    /// Makes the tables at the start of a tick, if they will save time.
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

    /// Renders a whole tick with the tables.
    fn ring(&mut self) {
        let form = self.form(false, CONTROL_FRAMES);
        let [first, second] = &mut self.states;
        let (start, end) = if self.current == 0 { (first, second) } else { (second, first) };
        // This state was in use two ticks ago. Modes that came to rest since then may have old values in it and must
        // not sound again.
        if self.live < self.len {
            end.x.0[self.live..self.len].fill(0.0);
            end.y.0[self.live..self.len].fill(0.0);
        }
        let (table, modes, out) = (&mut self.table, &self.modes, &mut self.output);
        self.instructions.run(Ring { form, table, modes, start, end, out });
    }

    /// Renders the next frames, left and right. `frames` must not exceed those left until the next control tick, as
    /// given to [`ModeBank::sweep_to`].
    pub fn render(&mut self, drive: Option<&Drive>, frames: usize) -> [&[f32]; 2] {
        self.render_played(drive, None, frames)
    }

    /// As [`ModeBank::render`], under a player. This is slower than with other forces, since each frame depends on the previous
    /// one.
    pub(crate) fn render_played(
        &mut self,
        drive: Option<&Drive>,
        player: Option<Player>,
        frames: usize,
    ) -> [&[f32]; 2] {
        let frames = frames.min(CONTROL_FRAMES);
        if let Some(mut player) = player {
            let (part, out) = self.part(frames);
            play(&mut [Some(part)], frames, drive.unwrap_or(&Drive::NONE), &mut player, out);
            return out.each_ref().map(|side| &side[..frames]);
        }
        debug_assert!(frames <= self.until_tick);
        if let Some(drive) = drive {
            self.leave_rest();
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

    /// Displacement and squared amplitude of mode `m`, at full gain, for display. During a tick that is rendered by
    /// tables, these are the values at the start of the tick.
    pub(crate) fn mass(&self, m: usize) -> (f32, f32) {
        let State { x, y } = &self.states[self.current];
        (x.0[m], x.0[m] * x.0[m] + y.0[m] * y.0[m])
    }

    /// Sets every mode to rest.
    pub(crate) fn rest(&mut self) {
        self.states = [State::REST; 2];
    }

    /// Takes over the state of another bank, which has as many modes and renders nothing from tables.
    pub(crate) fn take_state_of(&mut self, other: &Self) {
        (self.states, self.current) = (other.states, other.current);
        // In a tick that is rendered by tables, this bank's state is that of the tick's start, and the other's that of this frame.
        if matches!(self.motion, Motion::Tabled { .. }) {
            self.motion = Motion::Still { ticks: 0 };
        }
    }

    /// Frames rendered since the state that [`ModeBank::mass`] returns.
    pub(super) fn frames_since(&self) -> usize {
        if let Motion::Tabled { handed_out } = self.motion { handed_out } else { 0 }
    }

    /// Returns the sum of the squared amplitudes of the modes, and sets modes that have nearly stopped to rest. Must be
    /// called at control ticks only.
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

    /// Sets the last modes to rest, [`LANES`] at a time, while the root of the mean square of a group's amplitudes, which is more than
    /// their mean, is below `least`. Must be called at control ticks only.
    pub(crate) fn rest_below(&mut self, least: f32) {
        debug_assert!(self.frames_since() == 0);
        let State { x: Row(x), y: Row(y) } = &mut self.states[self.current];
        while let Some(last) = self.live.checked_sub(1) {
            let group = last / LANES * LANES..self.live;
            let energy: f32 = group.clone().map(|m| x[m] * x[m] + y[m] * y[m]).sum();
            if energy >= least * least * group.len() as f32 {
                break;
            }
            x[group.clone()].fill(0.0);
            y[group.clone()].fill(0.0);
            self.live = group.start;
        }
    }
}

/// Half of the angle by which a mode turns per frame.
fn half_angle(frequency: f64, sample_rate: f64) -> f64 {
    0.5 * angle_from_frequency(frequency, sample_rate)
}

/// The logarithm of the factor by which the amplitude falls per frame.
fn ln_radius(t60: f64, sample_rate: f64) -> f64 {
    (LN_MINUS_60_DB / (t60 * sample_rate)).clamp(LEAST_LN_RADIUS, MOST_LN_RADIUS)
}

#[cfg(test)]
#[path = "tests/mod.rs"]
mod tests;
