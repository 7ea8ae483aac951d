//! Converts a pair into the mode table of a patch: one for all keys, or one for each.
//!
//! Tables for all keys of the range have the same number of modes, and clones of the patch share them. A note-on
//! selects a table without allocating. A voice that is retuned (mono, legato, glide) takes the table of its new key,
//! mode by mode in the order of their frequencies. Not done: tables between keys, which would need a match of modes
//! where they cross. 61 keys of 64 + 64 modes took 90 ms in a release build on a busy machine (143 ms with a second
//! direction of the string) and 187 KB (measured once).

use super::free::Free;
use super::link::Link;
use super::pair::Pair;
use crate::dsp::random::{key, uniform};
use crate::error::Result;
use crate::patch::{Mode, ModeTable};
use crate::sound::bodies::LN_1000;
use crate::sound::coupled::{CoupledMode, Partial};
use crate::units::frequency_from_key;
use libm::{atan2, hypot};
use std::f64::consts::TAU;

/// Number of the random pans' stream. It differs from the streams that a body uses with its seed.
const PAN_STREAM: u64 = 0x5041_4952_5041_4E00;

/// The shortest T60 of a mode, as a multiple of the pair's. A voice limits it further.
const LEAST_DECAY: f32 = 1e-6;

/// Modes with less than this share of the sum of all levels (−120 dB) are left out of a table for all keys.
const INAUDIBLE: f64 = 1e-6;

/// The modes of the pair at one frequency, and the output of each on both bodies.
struct Heard {
    frequency: f64,
    modes: Vec<CoupledMode>,
    /// For each body, the response to the strike and to the noise, which may excite different bodies.
    on: [[Vec<Partial>; 2]; 2],
}

impl Heard {
    /// The sum of all amplitudes on one of the bodies.
    fn sum(&self, body: usize) -> f64 {
        (0..self.modes.len()).map(|m| self.amplitude(m, body)).sum()
    }

    /// The amplitude of mode `m` on one of the bodies.
    fn amplitude(&self, m: usize, body: usize) -> f64 {
        self.on[body].iter().map(|heard| amplitude(&heard[m])).sum()
    }

    /// The output of mode `m` with these gains of the bodies: after the strike, and after the noise.
    fn mixed(&self, m: usize, gains: [f64; 2]) -> [Partial; 2] {
        [0, 1].map(|exciter| {
            let [one, other] = [0, 1].map(|body| self.on[body][exciter][m]);
            let of = |part: fn(&Partial) -> f64| gains[0] * part(&one) + gains[1] * part(&other);
            Partial { cosine: of(|heard| heard.cosine), sine: of(|heard| heard.sine) }
        })
    }
}

impl Pair {
    /// The T60 in seconds of the first body's mode that sets the pitch, before it is joined. Set the patch's `decay` to it: the
    /// decays of the table are multiples of it. Allocates.
    pub fn t60(&self) -> f64 {
        self.first.t60()
    }

    /// The mode table of a patch: ratios to the played note, levels whose absolute values add up to 1 at most, decays as
    /// multiples of [`Pair::t60`], and phases. Not real-time safe.
    ///
    /// If both bodies follow the keys, one table is for all keys. If not, there is one for each of [`Pair::keys`], made
    /// together with a [`Sound`](crate::sound::Sound). A note uses the table of the key that is nearest to its pitch.
    /// The whole table is shifted to the note's exact pitch, so tuning, bends and vibrato move all modes by the same
    /// interval. This includes the body that keeps its frequency: by at most half a semitone unless the pitch is bent.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) for a number that is out of range, and if the poles were not found.
    pub fn table(&self) -> Result<ModeTable> {
        self.check()?;
        let one = self.heard(self.first.frequency())?;
        let is_same = self.is_same_for_all_keys();
        let count = if is_same { None } else { Some(self.count_of(&self.free())) };
        let middle = self.tables_of(&[one], count).swap_remove(0);
        if is_same {
            return Ok(middle);
        }
        let pair = self.clone();
        Ok(middle.with_keys(pair.keys[0], move || pair.key_tables()))
    }

    /// Number of modes of the pair, from the numbers of modes of its bodies.
    fn count_of(&self, free: &Free) -> usize {
        let [first, second] = free.len();
        self.directions() * first + second
    }

    /// A table for each of the keys.
    fn key_tables(&self) -> Vec<ModeTable> {
        let free = self.free();
        let keys = (self.keys[0]..=self.keys[1]).map(|key| {
            let frequency = frequency_from_key(key.into(), 440.0);
            // The search for the poles fails only if two of them nearly coincide. A slightly different joint prevents that.
            let slightly_stiffer = || match self.link {
                Link::Spring { stiffness, damping } => {
                    let link = Link::Spring { stiffness: 1.001 * stiffness, damping };
                    Self { link, ..self.clone() }.coupled(&free, frequency)
                }
                _ => Self { mass: 1.001 * self.mass, ..self.clone() }.heard(frequency).map(|heard| heard.modes),
            };
            let modes = self.coupled(&free, frequency).or_else(|_| slightly_stiffer());
            self.heard_of(frequency, modes.unwrap_or_default())
        });
        self.tables_of(&keys.collect::<Vec<_>>(), Some(self.count_of(&free)))
    }

    fn heard(&self, frequency: f64) -> Result<Heard> {
        Ok(self.heard_of(frequency, self.modes(frequency)?))
    }

    fn heard_of(&self, frequency: f64, modes: Vec<CoupledMode>) -> Heard {
        let struck = [1.0 - self.struck, self.struck];
        let strike = [self.first.strike_share, self.second.strike_share];
        let on = [[1.0, 0.0], [0.0, 1.0]].map(|body| {
            [strike, strike.map(|share| 1.0 - share)].map(|exciter| {
                let force = [struck[0] * exciter[0], struck[1] * exciter[1]];
                let heard = |mode: &CoupledMode| {
                    let Partial { cosine, sine } = mode.displacement(force, body);
                    let scale = if is_playable(mode, frequency) { mode.angular_frequency } else { 0.0 };
                    Partial { cosine: scale * cosine, sine: scale * sine }
                };
                modes.iter().map(heard).collect()
            })
        });
        Heard { frequency, modes, on }
    }

    /// The tables of some frequencies, with the same gains for all. Each has `count` modes, or without a count, all audible
    /// modes.
    fn tables_of(&self, all: &[Heard], count: Option<usize>) -> Vec<ModeTable> {
        let share = [1.0 - self.heard, self.heard];
        let gains = [0, 1].map(|body| {
            let mean = all.iter().map(|heard| heard.sum(body)).sum::<f64>() / all.len() as f64;
            if mean > 0.0 { share[body] / mean } else { 0.0 }
        });
        let level = |heard: &Heard, m| heard.mixed(m, gains).iter().map(amplitude).sum::<f64>();
        let total = |heard: &Heard| (0..heard.modes.len()).map(|m| level(heard, m)).sum::<f64>();
        let most = all.iter().map(total).fold(0.0, f64::max);
        let t60 = self.t60();
        let table = |heard: &Heard| {
            let least = if count.is_none() { INAUDIBLE * total(heard) } else { -1.0 };
            let audible = (0..heard.modes.len()).filter(|m| level(heard, *m) > least);
            let (mut modes, mut phases): (Vec<Mode>, Vec<f32>) =
                audible.map(|m| self.mode(heard, m, gains, most, t60)).unzip();
            modes.resize(count.unwrap_or(modes.len()).max(1), Mode { level: 0.0, strike: 0.0, ..Mode::UNIT });
            phases.resize(modes.len(), 0.0);
            ModeTable::new(&modes).with_phases(&phases)
        };
        all.iter().map(table).collect()
    }

    /// Mode `m` and its phase.
    fn mode(&self, heard: &Heard, m: usize, gains: [f64; 2], most: f64, t60: f64) -> (Mode, f32) {
        let mode = &heard.modes[m];
        let after = heard.mixed(m, gains);
        let [strike, noise] = [0, 1].map(|exciter| amplitude(&after[exciter]));
        let amounts = [0, 1].map(|body| gains[body] * heard.amplitude(m, body));
        let sum = amounts[0] + amounts[1];
        let random = if m == 0 { 0.0 } else { f64::from(uniform(key(self.first.seed, PAN_STREAM), m as u64)) };
        let pan = amounts[0] * self.first.pan + amounts[1] * self.second.pan;
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let fields = [
            mode.angular_frequency / (TAU * heard.frequency),
            share(strike + noise, most),
            LN_1000 / (mode.decay_rate * t60),
            share(strike, strike + noise),
            share(random * pan, sum),
        ];
        let mut ranges = Mode::FIELDS;
        // A joint can have modes that decay within milliseconds, with a smaller decay than files may contain.
        ranges[2].1 = LEAST_DECAY;
        let within = |field: usize| (fields[field] as f32).clamp(ranges[field].1, ranges[field].2);
        // Noise has no phase of its own.
        (Mode::from_fields([0, 1, 2, 3, 4].map(within)), atan2(after[0].cosine, after[0].sine) as f32)
    }
}

fn amplitude(partial: &Partial) -> f64 {
    hypot(partial.cosine, partial.sine)
}

/// Whether a bank can play the mode: it oscillates, and its ratio to the note is in range.
fn is_playable(mode: &CoupledMode, frequency: f64) -> bool {
    let (_, min, max) = Mode::FIELDS[0];
    (f64::from(min)..=f64::from(max)).contains(&(mode.angular_frequency / (TAU * frequency)))
}
