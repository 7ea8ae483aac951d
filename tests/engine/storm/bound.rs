//! Upper bound of a case's loudness, from its patch and events alone: the sum over all strikes.
//!
//! A strike adds to a mode the amplitude of its force times the mode's gain, whatever the pitch is and however it
//! moves; damping and movement can only reduce it. It is multiplied by at most the largest output gain of the case.
//!
//! How sharp the bound is: a single struck note reaches it. The bound is looser in these ways: strikes are counted as
//! if none had decayed and all their modes were in phase; each moving gain counts at its highest value, independently
//! of the others; every note-on counts as a strike, even if a legato voice is only retuned; a noise burst counts with
//! nine times its expected amplitude, or with the sum of all its frames if that is smaller; energy that blooms counts as if
//! all modes shared it, in phase and all on the louder side.

use super::case::Case;
use super::gains::{Sides, finite, modulated, most_gain, pan_gains, unit};
use super::heard_by::heard_by;
use super::noise::Noise;
use super::reach::{Reach, add};
use libm::{fabs, hypot, pow, sin, sqrt};
use sprung::engine::{Event, EventKind, Expression};
use sprung::params::{PARAM_COUNT, Param};
use sprung::patch::routes::amount_param;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::units::gain_from_db;
use std::f64::consts::{LOG2_10, PI, SQRT_2};

/// Factor by which the classic law may be louder than requested. Its bank limits a mode to 8 times at every control
/// tick. Until the next tick, a sweep that rises to the end of its range can increase this 7.1 times, as it can for a
/// strike.
const CLASSIC: f64 = 8.0 * 7.1;
/// Bound of what breath gives, and of what a rattle moves from mode to mode. The true ones are in other norms, those of pressures
/// and of energies at the point of touch (`dsp/mode_bank/played_tests`, `hammer_tests`), and depend on the smallest level of a mode;
/// here, they must only stay finite.
pub(crate) const UNKNOWN: f64 = 1e12;
/// Factor by which the soft pedal multiplies the force.
const SOFT: f64 = 0.6;

/// The bound from a certain frame on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) frame: u32,
    /// Bound of the samples.
    pub(crate) output: Sides,
    /// Bound of the sum of all displacements, before any output gain.
    pub(crate) displacement: f64,
}

/// The bound of a case over time: a staircase that rises with each strike.
pub(crate) fn bound(case: &Case) -> Vec<Step> {
    let parts = if case.ensemble { 16 } else { 1 };
    let mut all: Vec<Step> = (0..parts).flat_map(|index| Part::new(case, index).bound(case)).collect();
    // Each part's steps are increments, so that those of all parts can be added up.
    all.sort_by_key(|step| step.frame);
    let mut sum = Step { frame: 0, output: [0.0; 2], displacement: 0.0 };
    for step in &mut all {
        sum.output = [0, 1].map(|side| sum.output[side] + step.output[side]);
        sum.displacement += step.displacement;
        *step = Step { frame: step.frame, ..sum };
    }
    all
}

/// One synth, with its patch as changed by events.
struct Part {
    ensemble: bool,
    /// For each event of the case, whether the synth receives it.
    hears: Vec<bool>,
    patch: Patch,
    offsets: [f32; PARAM_COUNT],
    soft: [bool; 16],
    /// The largest number of unison voices of a note.
    unison: f64,
    /// Whether brightness changes or a route moves the tilt; if so, the strike's tilt is unknown.
    moves_tilt: bool,
    /// Bound of the sum of all modes' amplitudes that a bow of speed 1 gives until the end of the case, times the highest level
    /// of the bow.
    bow: f64,
    /// Bound of the sum of all frames of noise that is held.
    held: f64,
    /// Whether breath may blow, or something rattle.
    blows: bool,
    /// The highest gain of mallet, pluck and noise, or 1 if they may all be off: the greatest force of a nudge.
    nudge: f64,
    /// Factor by which bloom may raise the sum of the amplitudes that strikes give; `None` if nothing blooms.
    bloom: Option<f64>,
    /// The reach of a strike; `None` after the patch has changed.
    reach: Option<Reach>,
    /// How far routes raise parameters at most, in travel of their knobs.
    raises: Vec<(Param, f64)>,
}

/// A strike, and the end of its force.
#[derive(Clone, Copy)]
struct Strike {
    end: u64,
    /// Forces of mallet, pluck and noise; that of noise is its upper bound.
    forces: [f64; 3],
    /// Bound of the sum of all modes' amplitudes that a bow or a breath gives.
    played: f64,
    /// Bound of the sum of the frames of held noise.
    held: f64,
    /// Force of a nudge.
    nudge: f64,
    law: f64,
    reach: Reach,
}

impl Strike {
    fn amplitudes(&self) -> [f64; 3] {
        let [mallet, pluck, noise] = self.forces;
        let Reach { struck, plucked, noise: burst, nudged } = self.reach;
        let sum = |i: usize| {
            mallet * struck[i] + pluck * plucked[i] + (noise + self.held) * burst[i] + self.nudge * nudged[i]
        };
        [0, 1, 2].map(|i| self.law * sum(i))
    }
}

impl Part {
    fn new(case: &Case, index: u8) -> Self {
        let (ensemble, patch) = (case.ensemble, case.patch.clone());
        let (offsets, soft) = ([0.0; PARAM_COUNT], [false; 16]);
        let mut part = Self {
            ensemble,
            hears: heard_by(case, index),
            patch,
            offsets,
            soft,
            unison: 1.0,
            moves_tilt: false,
            bow: 0.0,
            held: 0.0,
            blows: false,
            nudge: 1.0,
            bloom: None,
            reach: None,
            raises: vec![],
        };
        part.raises = part.most_raised(case);
        // A voice that is struck again keeps the number of unison voices of its note’s start, so the highest number counts.
        part.unison = part.most(case, Param::Unison).max(1.0);
        part.bow = part.most_bow(case);
        part.held = part.most_held(case);
        part.blows = part.most(case, Param::BreathLevel) > -60.0 || part.most(case, Param::Rattle) > 0.0;
        let levels = [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel].map(|level| part.most(case, level));
        part.nudge = levels.into_iter().map(gain_from_db).fold(1.0, f64::max);
        part.bloom = part.most_bloom(case);
        let has_route = |patch: &Patch| patch.routes.iter().any(|(_, route)| route.destination == Param::Tilt);
        let is_routed = has_route(&case.patch) || case.programs.iter().any(has_route);
        let is_bright = |event: &Event| match event.kind {
            EventKind::Express { expression, .. } => expression == Expression::Brightness,
            EventKind::Control { controller, .. } => controller == 74,
            _ => false,
        };
        part.moves_tilt = is_routed || part.events(case).any(is_bright);
        part
    }

    /// The highest value of a parameter in the case: set by a patch or an event, or modulated to its maximum, and raised by routes.
    fn most(&self, case: &Case, asked: Param) -> f64 {
        let set = self.patches(case).map(|patch| patch.get(asked));
        let moved = self.events(case).filter_map(|event| match event.kind {
            EventKind::Param { param, value } if param == asked => Some(asked.info().clamp(value)),
            EventKind::Modulate { param, .. } if param == asked => Some(asked.info().max),
            _ => None,
        });
        self.raised(asked, set.chain(moved).fold(f32::NEG_INFINITY, f32::max)).into()
    }

    /// How far routes raise parameters at most, in travel of their knobs.
    fn most_raised(&self, case: &Case) -> Vec<(Param, f64)> {
        let routes = self.patches(case).flat_map(|patch| patch.routes.iter().map(move |route| (patch, route)));
        let raised = routes.map(|(patch, (place, route))| {
            let amount = amount_param(place);
            let leads_there = |patch: &Patch| patch.routes.iter().any(|(_, route)| route.destination == amount);
            let moves = self.patches(case).any(leads_there) || self.is_moved(case, amount);
            (route.destination, if moves { 1.0 } else { 0.01 * fabs(patch.get(amount).into()) })
        });
        raised.collect()
    }

    /// A value of a parameter after routes have raised it as far as they may.
    fn raised(&self, param: Param, value: f32) -> f32 {
        let by = |(to, by): &(Param, f64)| if *to == param { *by } else { 0.0 };
        match self.raises.iter().map(by).sum::<f64>() {
            0.0 => value,
            by => param.info().denormalise((param.info().normalise(value) + by).min(1.0)),
        }
    }

    /// A frame of a bow adds at most twice friction times speed to the squared amplitudes, and friction is at most the speed;
    /// so `n` frames give the amplitude `√(2 n) · speed`, which up to 64 modes may share.
    fn most_bow(&self, case: &Case) -> f64 {
        let level = self.most(case, Param::BowLevel);
        if level > -60.0 { gain_from_db(level) * sqrt(2.0 * case.frames as f64 * 64.0) } else { 0.0 }
    }

    /// Held noise is at most its force in each frame; a filter may double that.
    fn most_held(&self, case: &Case) -> f64 {
        let level = self.most(case, Param::NoiseHeld);
        let force = 2.0 * sqrt(6.0 * 6.908 / case.sample_rate);
        if level > -60.0 { gain_from_db(level) * force * case.frames as f64 } else { 0.0 }
    }

    /// The amplitudes of `n` modes add up to at most `√n` times the root of their energy. After several strikes, that root is at
    /// most the sum of the amplitudes of all strikes. Bloom does not change the energy.
    fn most_bloom(&self, case: &Case) -> Option<f64> {
        let blooms = self.patches(case).any(|patch| self.raised(Param::Bloom, patch.get(Param::Bloom)) > 0.0)
            || self.is_moved(case, Param::Bloom);
        let modes = self.patches(case).map(|patch| patch.modes.as_slice().len()).max()?;
        blooms.then_some(sqrt(modes as f64))
    }

    /// The patches that it may play.
    fn patches<'a>(&'a self, case: &'a Case) -> impl Iterator<Item = &'a Patch> {
        case.programs.iter().filter(|_| self.ensemble).chain([&self.patch])
    }

    /// Whether an event sets or modulates a parameter.
    fn is_moved(&self, case: &Case, asked: Param) -> bool {
        self.events(case).any(|event| match event.kind {
            EventKind::Param { param, .. } | EventKind::Modulate { param, .. } => param == asked,
            _ => false,
        })
    }

    /// The events that this synth receives.
    fn events<'a>(&self, case: &'a Case) -> impl Iterator<Item = &'a Event> + use<'a> {
        let events = case.events.iter().zip(self.hears.clone());
        events.filter(|(_, is_heard)| *is_heard).map(|(event, _)| event)
    }

    /// The increments of the bound.
    fn bound(mut self, case: &Case) -> Vec<Step> {
        let events = self.events(case);
        let gain = most_gain(case, &self.patch, self.ensemble, events);
        let (mut steps, mut strikes) = (vec![], Vec::<Strike>::new());
        for event in self.events(case) {
            self.apply(case, event);
            let strike = self.strike(event, case.sample_rate);
            if strike.is_none() && !self.moves_tilt {
                continue;
            }
            let reach = self.reach();
            let mut rise = strike.map_or([0.0; 3], |strike| strike.amplitudes());
            let played = strike.map_or(0.0, |strike| strike.played);
            rise = add(rise, [SQRT_2, SQRT_2, 1.0].map(|gain| gain * played));
            // The rest of earlier forces passes through the gains of this strike, or of a brightness that comes before the first
            // frame.
            let running = |earlier: &&mut Strike| earlier.end > u64::from(event.frame) && earlier.reach != reach;
            for earlier in strikes.iter_mut().filter(running) {
                let before = earlier.amplitudes();
                for i in 0..3 {
                    earlier.reach.struck[i] = earlier.reach.struck[i].max(reach.struck[i]);
                    earlier.reach.plucked[i] = earlier.reach.plucked[i].max(reach.plucked[i]);
                    earlier.reach.noise[i] = hypot(earlier.reach.noise[i], reach.noise[i]);
                }
                let after = earlier.amplitudes();
                rise = [0, 1, 2].map(|i| rise[i] + after[i] - before[i]);
            }
            strikes.extend(strike);
            if let Some(louder) = self.bloom {
                rise = [SQRT_2, SQRT_2, 1.0].map(|gain| gain * louder * rise[2]);
            }
            if rise != [0.0; 3] {
                let output = [rise[0] * gain[0], rise[1] * gain[1]];
                steps.push(Step { frame: event.frame, output, displacement: rise[2] });
            }
        }
        steps
    }

    /// Applies an event's changes of the patch, its modulation and the soft pedal.
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
            // A reset on a zone's master also lifts the pedals of its members.
            EventKind::Control { controller: 121, .. } => self.soft = [false; 16],
            _ => {}
        }
    }

    fn value(&self, param: Param) -> f64 {
        f64::from(modulated(self.patch.get(param), param, self.offsets[param as usize]))
    }

    /// The present value of a parameter, raised by routes.
    fn highest(&self, param: Param) -> f64 {
        self.raised(param, self.value(param) as f32).into()
    }

    /// The gain of an exciter's level: the lowest is off.
    fn level(&self, param: Param) -> f64 {
        let db = self.highest(param);
        if db > -60.0 { gain_from_db(db) } else { 0.0 }
    }

    fn strike(&mut self, event: &Event, sample_rate: f64) -> Option<Strike> {
        let is_exact = self.value(Param::Coefficients) == 0.0;
        let law = if is_exact { 1.0 } else { CLASSIC };
        if let EventKind::Nudge { amplitude, .. } = event.kind {
            let nudge = f64::from(unit(amplitude)) * self.nudge * sqrt(self.unison);
            return Some(Strike { end: 0, forces: [0.0; 3], played: 0.0, held: 0.0, nudge, law, reach: self.reach() });
        }
        let EventKind::NoteOn { velocity, .. } = event.kind else { return None };
        let soft = if self.soft[usize::from(event.channel & 15)] { SOFT } else { 1.0 };
        // Each of n unison voices has the force divided by √n, and all of them may be in phase.
        let force = |own| {
            let power = (self.value(Param::Velocity) + self.value(own)).max(0.0);
            pow(unit(velocity).into(), 0.02 * power) * soft * sqrt(self.unison)
        };
        let noise = Noise::new(|param| self.value(param), sample_rate);
        // The longest pulse lasts 10 ms; ten times as long where mass and speed make it longer.
        let is_plain = self.value(Param::MalletMass) <= 1.0 && self.value(Param::MalletSpeed) == 0.0;
        let pulse = if is_plain { 0.01 } else { 0.101 } * sample_rate;
        // A hammer is caught after 50 ms, and gives at most twice the area of its strike.
        let is_felt = self.value(Param::MalletPulse) == 2.0;
        let (pulse, hammered) = if is_felt { (0.05 * sample_rate, 2.0) } else { (pulse, 1.0) };
        let end = u64::from(event.frame) + noise.frames().max(pulse) as u64 + 2;
        let forces = [
            hammered * force(Param::MalletVelocity) * self.level(Param::MalletLevel),
            force(Param::PluckVelocity) * self.level(Param::PluckLevel),
            force(Param::NoiseVelocity) * self.level(Param::NoiseLevel) * noise.most(is_exact),
        ];
        let played = force(Param::BowVelocity) * self.bow + if self.blows { UNKNOWN } else { 0.0 };
        let held = force(Param::NoiseVelocity) * self.held;
        Some(Strike { end, forces, played, held, nudge: 0.0, law, reach: self.reach() })
    }

    /// The reach of a strike of force 1 with the present patch.
    fn reach(&mut self) -> Reach {
        if let Some(reach) = self.reach {
            return reach;
        }
        // A note may use the mode table of any key.
        self.patch.modes.make_tables();
        let tables: Vec<Reach> = self.patch.modes.tables().iter().map(|table| self.reach_of(table)).collect();
        let reach = tables.into_iter().fold(Reach::default(), Reach::max);
        self.reach = Some(reach);
        reach
    }

    /// The reach with one table of modes.
    fn reach_of(&self, table: &ModeTable) -> Reach {
        let modes = table.as_slice();
        let varied = gain_from_db(self.highest(Param::VaryModes));
        let tilt = self.value(Param::Tilt) / (20.0 / LOG2_10);
        let tilted = |mode: &Mode| fabs(f64::from(mode.level)) * pow(f64::from(mode.ratio), tilt);
        let plain: f64 = modes.iter().map(|mode| fabs(f64::from(mode.level))).sum();
        let total: f64 = modes.iter().map(tilted).sum();
        let balance = if tilt != 0.0 && total > 0.0 { plain / total } else { 1.0 };
        let (mut reach, mut furthest) = (Reach::default(), Reach::default());
        for mode in modes {
            let gains = if self.unison > 1.0 { [SQRT_2, SQRT_2, 1.0] } else { heard(mode, self.value(Param::Width)) };
            let level = tilted(mode) * balance * varied;
            let struck = f64::from(mode.strike);
            let reached = 1.0 - struck * (1.0 - 0.01 * self.value(Param::NoiseReach));
            let point = sin(PI * self.value(Param::PluckPosition) * 0.01 * f64::from(mode.ratio));
            let plucked =
                struck * if self.value(Param::VaryPosition) > 0.0 || table.has_phases() { 1.0 } else { fabs(point) };
            let heard = |share: f64| gains.map(|gain| gain * share);
            let noise = heard(reached);
            let own = Reach { struck: heard(struck), plucked: heard(plucked), noise, nudged: heard(1.0) };
            reach = reach.plus(own, level);
            furthest = furthest.max(own);
        }
        if self.moves_tilt {
            // Any tilt distributes the same sum of levels in another way.
            return Reach::default().plus(furthest, plain * varied);
        }
        reach
    }
}

/// The gains of a mode, left and right, and 1 for its displacement.
fn heard(mode: &Mode, width: f64) -> [f64; 3] {
    let [left, right] = pan_gains(f64::from(mode.pan) * width * 0.01 * 0.5 + 0.5);
    [left, right, 1.0]
}
