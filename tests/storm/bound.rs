//! How loud a case can be at most, from its patch and its events alone: the sum over strikes of what each brings.
//!
//! A strike brings a mode the amplitude that its force has through the mode's gain, wherever the pitch is and wherever
//! it goes; damping and movement only take away. What is heard of it is at most the largest output gain of the case.
//!
//! How sharp that is: a single struck note reaches its bound. Looser, by what is said: strikes are counted as if none
//! had decayed and all their modes met in phase; gains that move count at their highest, each by itself; every note-on
//! counts as a strike, also where a legato voice is only retuned; a noise burst counts nine times its expected
//! amplitude, or what it would be if all its frames pushed the same way if that is less.

use crate::case::Case;
use libm::{fabs, hypot, pow, sin, sqrt};
use sprung::engine::{Event, EventKind, Expression};
use sprung::params::{PARAM_COUNT, PARAMS, Param};
use sprung::patch::{Mode, Patch};
use sprung::units::gain_from_db;
use std::f64::consts::{LOG2_10, PI, SQRT_2};

/// How much louder than asked for the classic law may be. Its bank holds a mode to 8 times at every control tick; before
/// the next one a sweep that rises to the end of its range can bring out 7.1 times that, as it does with a strike.
const CLASSIC: f64 = 8.0 * 7.1;
/// A burst of noise adds up at random. By Hoeffding's inequality it is above so many of its standard deviations in one
/// of 10¹⁷ cases, whatever the pitch does (which cannot follow the noise).
const NOISE_DEVIATIONS: f64 = 9.0;
/// What the soft pedal leaves of the force.
const SOFT: f64 = 0.6;

/// Amplitudes to the left and to the right.
type Sides = [f64; 2];

/// The bound from a frame on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) frame: u32,
    /// Of the samples.
    pub(crate) output: Sides,
    /// Of the displacements of all masses together, before any output gain.
    pub(crate) displacement: f64,
}

/// The bound of a case: a staircase that rises with each strike.
pub(crate) fn bound(case: &Case) -> Vec<Step> {
    let parts = if case.ensemble { 16 } else { 1 };
    let mut all: Vec<Step> = (0..parts).flat_map(|index| Part::new(case, index).bound(case)).collect();
    // Each part's steps are rises, so that those of all parts add up.
    all.sort_by_key(|step| step.frame);
    let mut sum = Step { frame: 0, output: [0.0; 2], displacement: 0.0 };
    for step in &mut all {
        sum.output = [0, 1].map(|side| sum.output[side] + step.output[side]);
        sum.displacement += step.displacement;
        *step = Step { frame: step.frame, ..sum };
    }
    all
}

/// Which events the synth of a channel hears: those of its channel, or of a zone's members if it is the master; and all
/// if it is the only one.
fn hears(case: &Case, index: u8) -> Vec<bool> {
    let (mut lower, mut upper, mut chosen) = (0_u8, 0_u8, [[127_u8; 2]; 16]);
    let mut is_heard = |event: &Event| {
        let channel = event.channel & 15;
        let master = |channel: u8| match channel {
            1..=15 if channel <= lower => Some(0),
            0..=14 if channel >= 15 - upper => Some(15),
            _ => None,
        };
        let owner = master(channel).unwrap_or(channel);
        if let EventKind::Control { controller, value } = event.kind {
            let data = (unit(value) * 127.0 + 0.5) as u8;
            match controller {
                101 => chosen[usize::from(channel)][0] = data,
                100 => chosen[usize::from(channel)][1] = data,
                98 | 99 => chosen[usize::from(channel)] = [127; 2],
                121 => {
                    let reset = (0..16_u8).filter(|other| *other == channel || master(*other) == Some(channel));
                    reset.for_each(|other| chosen[usize::from(other)] = [127; 2]);
                }
                6 if channel == 0 && chosen[0] == [0, 6] => {
                    lower = data.min(15);
                    upper = upper.min(14_u8.saturating_sub(lower));
                }
                6 if channel == 15 && chosen[15] == [0, 6] => {
                    upper = data.min(15);
                    lower = lower.min(14_u8.saturating_sub(upper));
                }
                _ => {}
            }
        }
        // What a member's program change says is not for the master.
        owner == index && (owner == channel || !matches!(event.kind, EventKind::Program(_)))
    };
    case.events.iter().map(|event| !case.ensemble || is_heard(event)).collect()
}

/// One synth: its patch as events move it.
struct Part {
    ensemble: bool,
    /// Whether it hears each event of the case.
    hears: Vec<bool>,
    patch: Patch,
    offsets: [f32; PARAM_COUNT],
    soft: [bool; 16],
    /// The most unison voices that a note has.
    unison: f64,
    /// Brightness moves: the strike's tilt is not known.
    bright: bool,
    /// What a strike reaches, until the patch changes.
    reach: Option<Reach>,
}

/// What a strike of force 1 gives all modes together, by pulse and by noise, as heard and as displacement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Reach {
    struck: [f64; 3],
    noise: [f64; 3],
}

/// A strike, and how long its force lasts.
#[derive(Clone, Copy)]
struct Strike {
    end: u64,
    force: f64,
    noise_factor: f64,
    law: f64,
    reach: Reach,
}

impl Strike {
    fn amplitudes(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.force * self.law * (self.reach.struck[i] + self.noise_factor * self.reach.noise[i]))
    }
}

impl Part {
    fn new(case: &Case, index: u8) -> Self {
        let (ensemble, patch) = (case.ensemble, case.patch.clone());
        let (offsets, soft) = ([0.0; PARAM_COUNT], [false; 16]);
        let mut part =
            Self { ensemble, hears: hears(case, index), patch, offsets, soft, unison: 1.0, bright: false, reach: None };
        part.unison = part.most_unison(case);
        part.bright = part.events(case).any(|event| match event.kind {
            EventKind::Express { expression, .. } => expression == Expression::Brightness,
            EventKind::Control { controller, .. } => controller == 74,
            _ => false,
        });
        part
    }

    /// As a voice struck again keeps the number that its note began with, the most that there ever is.
    fn most_unison(&self, case: &Case) -> f64 {
        let programs = case.programs.iter().filter(|_| self.ensemble);
        let set = programs.chain([&self.patch]).map(|patch| patch.get(Param::Unison));
        let moved = self.events(case).filter_map(|event| match event.kind {
            EventKind::Param { param: Param::Unison, value } => Some(Param::Unison.info().clamp(value)),
            EventKind::Modulate { param: Param::Unison, .. } => Some(Param::Unison.info().max),
            _ => None,
        });
        set.chain(moved).fold(1.0, f32::max).into()
    }

    /// The events that this synth hears.
    fn events<'a>(&self, case: &'a Case) -> impl Iterator<Item = &'a Event> + use<'a> {
        let events = case.events.iter().zip(self.hears.clone());
        events.filter(|(_, is_heard)| *is_heard).map(|(event, _)| event)
    }

    /// The rises of the bound.
    fn bound(mut self, case: &Case) -> Vec<Step> {
        let gain = self.output_gain(case);
        let (mut steps, mut strikes) = (vec![], Vec::<Strike>::new());
        for event in self.events(case) {
            self.apply(case, event);
            let strike = self.strike(event, case.sample_rate);
            if strike.is_none() && !self.bright {
                continue;
            }
            let reach = self.reach();
            let mut rise = strike.map_or([0.0; 3], |strike| strike.amplitudes());
            // What is still to come of earlier forces goes through the gains of this strike, or of a brightness that
            // comes before the first frame.
            let running = |earlier: &&mut Strike| earlier.end > u64::from(event.frame) && earlier.reach != reach;
            for earlier in strikes.iter_mut().filter(running) {
                let before = earlier.amplitudes();
                for i in 0..3 {
                    earlier.reach.struck[i] = earlier.reach.struck[i].max(reach.struck[i]);
                    earlier.reach.noise[i] = hypot(earlier.reach.noise[i], reach.noise[i]);
                }
                let after = earlier.amplitudes();
                rise = [0, 1, 2].map(|i| rise[i] + after[i] - before[i]);
            }
            strikes.extend(strike);
            if rise != [0.0; 3] {
                let output = [rise[0] * gain[0], rise[1] * gain[1]];
                steps.push(Step { frame: event.frame, output, displacement: rise[2] });
            }
        }
        steps
    }

    /// Takes in what changes the patch, its modulation and the soft pedal.
    fn apply(&mut self, case: &Case, event: &Event) {
        if matches!(event.kind, EventKind::Param { .. } | EventKind::Modulate { .. } | EventKind::Program(_)) {
            self.reach = None;
        }
        match event.kind {
            EventKind::Param { param, value } => self.patch.set(param, value),
            EventKind::Modulate { id: None, param, offset } => {
                self.offsets[param as usize] = finite(offset).clamp(-1.0, 1.0);
            }
            EventKind::Program(number) if self.ensemble => {
                self.patch = case.programs.get(usize::from(number)).unwrap_or(&self.patch).clone();
            }
            EventKind::Control { controller: 67, value } => {
                self.soft[usize::from(event.channel & 15)] = unit(value) >= 0.5;
            }
            // A reset on a zone's master lifts the pedals of its members too.
            EventKind::Control { controller: 121, .. } => self.soft = [false; 16],
            _ => {}
        }
    }

    fn value(&self, param: Param) -> f64 {
        f64::from(modulated(self.patch.get(param), param, self.offsets[param as usize]))
    }

    fn strike(&mut self, event: &Event, sample_rate: f64) -> Option<Strike> {
        let EventKind::NoteOn { velocity, .. } = event.kind else { return None };
        let soft = if self.soft[usize::from(event.channel & 15)] { SOFT } else { 1.0 };
        // Of n unison voices each has the force divided by √n, and they may meet in phase.
        let force = pow(unit(velocity).into(), 0.02 * self.value(Param::Velocity)) * soft * sqrt(self.unison);
        let noise_frames = libm::floor(self.value(Param::NoiseTime) * sample_rate + 0.5);
        // The longest pulse lasts 10 ms.
        let end = u64::from(event.frame) + noise_frames.max(0.01 * sample_rate) as u64 + 2;
        let law = if self.value(Param::Coefficients) == 0.0 { 1.0 } else { CLASSIC };
        Some(Strike { end, force, noise_factor: noise_factor(noise_frames, law), law, reach: self.reach() })
    }

    /// What a strike of force 1 gives the modes now.
    fn reach(&mut self) -> Reach {
        if let Some(reach) = self.reach {
            return reach;
        }
        let modes = self.patch.modes.as_slice();
        let exciter = self.value(Param::Exciter) as u32;
        let noise_gain = gain_from_db(self.value(Param::NoiseLevel));
        let tilt = self.value(Param::Tilt) / (20.0 / LOG2_10);
        let tilted = |mode: &Mode| fabs(f64::from(mode.level)) * pow(f64::from(mode.ratio), tilt);
        let plain: f64 = modes.iter().map(|mode| fabs(f64::from(mode.level))).sum();
        let total: f64 = modes.iter().map(tilted).sum();
        let balance = if tilt != 0.0 && total > 0.0 { plain / total } else { 1.0 };
        let mut reach = Reach::default();
        let mut widest = [0.0_f64, 0.0, 1.0];
        for mode in modes {
            let gains = if self.unison > 1.0 { [SQRT_2, SQRT_2, 1.0] } else { heard(mode, self.value(Param::Width)) };
            widest = [0, 1, 2].map(|i| widest[i].max(gains[i]));
            let level = tilted(mode) * balance;
            let struck = if exciter == 3 { 0.0 } else { level * f64::from(mode.strike) };
            let noise = if exciter == 3 { level } else { level * (1.0 - f64::from(mode.strike)) } * noise_gain;
            let point = sin(PI * self.value(Param::Position) * 0.01 * f64::from(mode.ratio));
            let struck = if exciter == 2 { struck * fabs(point) } else { struck };
            reach.struck = add(reach.struck, gains.map(|gain| gain * struck));
            reach.noise = add(reach.noise, gains.map(|gain| gain * noise));
        }
        if self.bright {
            // Any tilt distributes the same sum of levels in another way.
            let most = widest.map(|gain| gain * plain);
            reach = Reach { struck: most, noise: most.map(|most| most * noise_gain) };
        }
        self.reach = Some(reach);
        reach
    }

    /// The largest gain that can apply to anything, to each side: each factor at its highest in the case.
    fn output_gain(&self, case: &Case) -> Sides {
        let mut levels = vec![self.patch.get(Param::Gain)];
        let mut pans = vec![self.patch.get(Param::Pan)];
        let (mut level_offsets, mut pan_offsets) = (vec![0.0], vec![0.0]);
        let mut volume = 1.0_f32;
        let mut positions = vec![0.5_f32];
        // Of the channels that can be masters, and of all.
        let (mut masters, mut channels, mut zones) = (vec![0.5_f32], vec![0.5_f32], false);
        for event in self.events(case) {
            match event.kind {
                EventKind::Param { param: Param::Gain, value } => levels.push(Param::Gain.info().clamp(value)),
                EventKind::Param { param: Param::Pan, value } => pans.push(Param::Pan.info().clamp(value)),
                EventKind::Modulate { param: Param::Gain, offset, .. } => level_offsets.push(finite(offset)),
                EventKind::Modulate { param: Param::Pan, offset, .. } => pan_offsets.push(finite(offset)),
                EventKind::Program(number) if self.ensemble => {
                    if let Some(patch) = case.programs.get(usize::from(number)) {
                        levels.push(patch.get(Param::Gain));
                        pans.push(patch.get(Param::Pan));
                    }
                }
                EventKind::Express { expression: Expression::Volume, value, .. } => {
                    volume = volume.max(finite(value).clamp(0.0, 4.0));
                }
                EventKind::Express { expression: Expression::Pan, value, .. } => {
                    positions.push(finite(value).clamp(-1.0, 1.0) * 0.5 + 0.5);
                }
                EventKind::Control { controller: 10, value } => {
                    let position = ((unit(value) * 127.0 - 1.0) / 126.0).clamp(0.0, 1.0);
                    channels.push(position);
                    if matches!(event.channel & 15, 0 | 15) {
                        masters.push(position);
                    }
                }
                EventKind::Control { controller: 6, .. } => zones = true,
                _ => {}
            }
        }
        if !zones {
            masters = vec![0.5];
        }
        let most = |values: &[f32]| values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let least = |values: &[f32]| values.iter().copied().fold(f32::INFINITY, f32::min);
        let level = modulated(most(&levels), Param::Gain, most(&level_offsets));
        let pan_ends = [
            modulated(least(&pans), Param::Pan, least(&pan_offsets)),
            modulated(most(&pans), Param::Pan, most(&pan_offsets)),
        ];
        let pans = pan_ends.map(|pan| pan * 0.005 + 0.5);
        let gain = gain_from_db(level.into()) * f64::from(volume);
        [0, 1].map(|side| {
            let widest = |positions: &[f32]| {
                positions.iter().map(|position| pan_gains(f64::from(*position))[side]).fold(0.0, f64::max)
            };
            gain * widest(&pans) * widest(&positions) * widest(&channels) * widest(&masters)
        })
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + b[i])
}

/// The gains of a mode to the left and right, and 1 for its displacement.
fn heard(mode: &Mode, width: f64) -> [f64; 3] {
    let [left, right] = pan_gains(f64::from(mode.pan) * width * 0.01 * 0.5 + 0.5);
    [left, right, 1.0]
}

/// Gains of a position from 0 (left) to 1 (right), of constant power.
fn pan_gains(position: f64) -> Sides {
    [1.0 - position, position].map(|share| SQRT_2 * sqrt(share.max(0.0)))
}

/// The amplitude that a burst of noise of force 1 and so many frames brings at most: its frames are uniform over ±1
/// under `(1−u)²`, scaled so that the sum of their squares is expected to be 1 if they are many. The classic law is only
/// held to what they are if all of them push the same way.
fn noise_factor(frames: f64, law: f64) -> f64 {
    let n = frames.max(1.0);
    let scale = 1.0 / sqrt(n / 15.0);
    // Σ (j/n)² and Σ (j/n)⁴ for j = 1 … n.
    let sum = (n + 1.0) * (2.0 * n + 1.0) / (6.0 * n);
    let squares = (n + 1.0) * (2.0 * n + 1.0) * (3.0 * n * n + 3.0 * n - 1.0) / (30.0 * n * n * n);
    let likely = NOISE_DEVIATIONS * sqrt(squares / 3.0);
    scale * if law == 1.0 { sum.min(likely) } else { sum }
}

fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}

fn unit(value: f32) -> f32 {
    finite(value).clamp(0.0, 1.0)
}

/// A parameter's value, moved by an offset in knob travel.
fn modulated(value: f32, param: Param, offset: f32) -> f32 {
    let info = &PARAMS[param as usize];
    let offset = offset.clamp(-1.0, 1.0);
    if offset == 0.0 { value } else { info.denormalise(info.normalise(value) + f64::from(offset)) }
}
