//! The strikes of a voice: their forces, and the excitation gains of each mode.

use super::blowing::Blowing;
use super::bowing::Bowing;
use super::hammering::{self, Hammering};
use super::held_noise::HeldNoise;
use super::input::Input;
use super::rattling::Rattling;
use super::values::{StruckValues, ratios};
use super::variation::Variation;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::{BurstSetup, Decay, Drive, Exciter, Player, Stroke};
use crate::dsp::mode_bank::{ExcitationRows, MAX_MODES};
use crate::dsp::random;
use crate::dsp::series::sines;
use crate::engine::curves;
use crate::engine::gain::exciter_gain;
use crate::engine::note::Note;
use crate::engine::voice_manager::Unison;
use crate::params::{Choice, Coefficients, MalletPulse, NoiseDecay, Param, Rattle};
use crate::patch::ModeTable;
use crate::sound::contact::{contact_time, hertz};
use libm::{fabs, pow, sqrt};
use std::f64::consts::{FRAC_1_PI, PI};

/// Share of the force that remains with the soft pedal.
const SOFT_FORCE: f64 = 0.6;
/// Share of the hardness that the soft pedal removes.
const SOFT_HARDNESS: f64 = 0.3;

/// Number of the random phase's stream. It differs from the stream of the voice's noise.
const PHASE_STREAM: u64 = 0x55_4e49_534f_4e00;

/// The excitation of a voice. Real-time safe.
pub(super) struct Strike {
    exciter: Exciter,
    drive: Drive,
    /// Forces of the last strike: those of mallet, pluck and noise.
    forces: [f64; 3],
    /// Energy that these forces add, and that of the noise alone.
    energy: f64,
    noise_energy: f64,
    /// The forces of the same strike at full velocity and without routes, and the energy that they would add.
    full_forces: [f64; 3],
    full_energy: f64,
    /// Whether noise excites any mode.
    is_noisy: bool,
    /// Phase offset in radians of the strike of a unison voice.
    phase: f32,
    variation: Variation,
    /// Stream of random numbers of the last strike.
    key: u64,
    pub(super) hammering: Hammering,
    pub(super) rattling: Rattling,
    pub(super) bowing: Bowing,
    pub(super) blowing: Blowing,
    pub(super) input: Input,
    pub(super) held_noise: HeldNoise,
}

impl Strike {
    /// No strike yet.
    pub(super) fn new() -> Self {
        Self {
            exciter: Exciter::REST,
            drive: Drive::NONE,
            forces: [0.0; 3],
            energy: 0.0,
            noise_energy: 0.0,
            full_forces: [0.0; 3],
            full_energy: 0.0,
            is_noisy: false,
            phase: 0.0,
            variation: Variation::NONE,
            key: 0,
            hammering: Hammering::OFF,
            rattling: Rattling::OFF,
            bowing: Bowing::OFF,
            blowing: Blowing::OFF,
            input: Input::OFF,
            held_noise: HeldNoise::OFF,
        }
    }

    /// Forgets the strikes of the note before.
    pub(super) fn start(&mut self) {
        self.exciter = Exciter::REST;
        (self.forces, self.energy, self.phase) = ([0.0; 3], 0.0, 0.0);
        (self.hammering, self.bowing, self.blowing) = (Hammering::OFF, Bowing::OFF, Blowing::OFF);
        self.rattling = Rattling::OFF;
        (self.input, self.held_noise) = (Input::OFF, HeldNoise::OFF);
    }

    /// The strikes in progress.
    pub(super) fn exciter(&self) -> &Exciter {
        &self.exciter
    }

    /// Whether any force is still to come.
    pub(super) fn is_active(&self) -> bool {
        self.exciter.is_active() || self.hammering.is_on()
    }

    /// Whether any force of the strike with this number in the exciter is still to come.
    pub(super) fn is_acting(&self, blow: usize) -> bool {
        let is_newest = blow == self.exciter.newest();
        self.exciter.is_acting(blow) || (is_newest && self.hammering.is_on())
    }

    /// The energy of a full strike: like the last one, but at full velocity and without routes. 1 if mallet, pluck and noise
    /// are all off.
    pub(super) fn full_energy(&self) -> f64 {
        if self.full_energy > 0.0 { self.full_energy } else { 1.0 }
    }

    /// The forces of a full strike together.
    pub(super) fn full_force(&self) -> f64 {
        self.full_forces.iter().sum()
    }

    /// The stream of random numbers of the last strike.
    pub(super) fn key(&self) -> u64 {
        self.key
    }

    /// The energy that the pulses of the last strike will have brought, until they are over. That of noise counts as it comes.
    pub(super) fn coming(&self) -> f64 {
        let is_pushed = self.exciter.is_pushed() || self.hammering.is_on();
        if is_pushed { self.energy - self.noise_energy } else { 0.0 }
    }

    /// Whether a hammer, a bow or breath acts on the modes by how they move.
    pub(super) fn is_touched(&self) -> bool {
        self.hammering.is_on() || self.is_played_on()
    }

    /// Whether a bow or breath acts, which need the contacts of the modes for themselves.
    fn is_played_on(&self) -> bool {
        self.bowing.is_on() || self.blowing.is_on()
    }

    /// Whether a player, held noise or incoming sound acts.
    pub(super) fn is_played(&self) -> bool {
        self.is_played_on() || self.input.is_on() || self.held_noise.is_on()
    }

    /// Frames until no force is left.
    pub(super) fn frames_left(&self) -> u32 {
        self.exciter.frames_left().max(self.hammering.frames_left())
    }

    /// The forces of the next frames, if there are any: those of strikes and of the incoming sound, and the player's. `input` is
    /// the incoming sound: empty, or one sample for each frame. Breath takes the place of a bow, and both end the touch of a hammer, under which
    /// nothing rattles.
    pub(super) fn forces(&mut self, frames: usize, input: &[f32]) -> (Option<&Drive>, Option<Player<'_>>) {
        let is_noisy = self.held_noise.is_on();
        let is_driven = self.exciter.is_active() || (self.input.is_on() && !input.is_empty()) || is_noisy;
        if is_driven || self.input.is_on() {
            self.exciter.fill(frames, &mut self.drive);
            self.input.add_to(&mut self.drive.push, input, frames);
            if is_noisy {
                self.held_noise.add_to(&mut self.drive.noise, frames);
            }
        }
        let bow = self.bowing.stroke(frames);
        let breath = self.blowing.blow(frames);
        if breath.is_some() || bow.is_some() {
            self.hammering = Hammering::OFF;
            self.rattling.interrupt();
        }
        let hammer = Some(&mut self.hammering.hammer).filter(|hammer| hammer.is_there());
        let rattle = self.rattling.rattle().map(Player::Rattle);
        let player = breath.map(Player::Breath).or(bow.map(Player::Bow)).or(hammer.map(Player::Hammer)).or(rattle);
        (is_driven.then_some(&self.drive), player)
    }

    /// Computes each mode's excitation gains. Returns the change of the energy that the last strike adds.
    pub(super) fn set_gains(&mut self, values: &StruckValues, bank: &mut Cells) -> f64 {
        let table = values.modes();
        let [mallet, pluck, burst] = self.forces;
        let mallet = if self.hammering.is_on() { hammering::MOST * mallet } else { mallet };
        let [full_mallet, full_pluck, full_burst] = self.full_forces;
        let reach = values.share(Param::NoiseReach);
        let turned_noise = table.has_phases();
        let (mut noisy, mut energy, mut burst_energy, mut full) = (false, 0.0, 0.0, 0.0);
        let cells = table.as_slice().chunks(MAX_MODES).zip(values.tilted_levels());
        for (cell, (modes, mut levels)) in cells.enumerate() {
            let (first, ratios) = (cell * MAX_MODES, ratios(modes));
            self.variation.vary(first, &mut levels);
            let at_mallet = self.variation.at_mallet(&ratios);
            let at_finger = if pluck > 0.0 { self.at_finger(values, &ratios) } else { [0.0; MAX_MODES] };
            let mut gains = ExcitationRows { turned_noise, ..ExcitationRows::NONE };
            if self.phase != 0.0 || turned_noise {
                gains.turn = self.turns(table, first);
            }
            // The sums follow in a loop of their own, so that the compiler can use vector instructions in this one.
            let mut energies = [[0.0; MAX_MODES]; 3];
            for (m, mode) in modes.iter().enumerate() {
                let (level, strike) = (levels[m], f64::from(mode.strike));
                let (push, pull) = (level * strike * at_mallet[m], level * strike * at_finger[m]);
                let noise = level * (1.0 - strike * (1.0 - reach));
                (gains.push[m], gains.pull[m], gains.noise[m]) = (push as f32, pull as f32, noise as f32);
                let (pulses, burst) = (fabs(push * mallet) + fabs(pull * pluck), noise * burst);
                (energies[0][m], energies[2][m]) = (pulses * pulses + burst * burst, burst * burst);
                let (pulses, burst) = (fabs(push * full_mallet) + fabs(pull * full_pluck), noise * full_burst);
                energies[1][m] = pulses * pulses + burst * burst;
            }
            noisy |= gains.noise.iter().any(|noise| *noise != 0.0);
            let [own, whole, noise] = energies.each_ref().map(|row| &row[..modes.len()]);
            energy = own.iter().fold(energy, |sum, mode| sum + mode);
            full = whole.iter().fold(full, |sum, mode| sum + mode);
            burst_energy += noise.iter().sum::<f64>();
            bank.set_excitation_gains(cell, &gains);
        }
        let more = energy - self.energy;
        (self.energy, self.full_energy, self.is_noisy) = (energy, full, noisy);
        self.noise_energy = burst_energy;
        more
    }

    /// The factors of the levels of modes of these ratios at the point of the pluck, under the width of the finger: the mean of
    /// each mode's shape over it.
    fn at_finger(&self, values: &StruckValues, ratios: &[f64; MAX_MODES]) -> [f64; MAX_MODES] {
        let mut shapes = [1.0; MAX_MODES];
        // Levels with phases already include the mode shapes at the point of the strike.
        if !values.modes().has_phases() {
            let place = values.get(Param::PluckPosition) + self.variation.pluck_place;
            sines(ratios, place * 0.01, 0.0, &mut shapes);
        }
        let half_width = 0.5 * values.share(Param::PluckWidth);
        if half_width > 0.0 {
            let mut edges = [0.0; MAX_MODES];
            sines(ratios, half_width, 0.0, &mut edges);
            let means = edges.iter().zip(ratios).map(|(edge, ratio)| edge / (PI * half_width * ratio));
            shapes.iter_mut().zip(means).for_each(|(shape, mean)| *shape *= mean);
        }
        shapes
    }

    /// Cosines and sines of the phases of the modes from mode `first` on.
    fn turns(&self, table: &ModeTable, first: usize) -> [[f32; MAX_MODES]; 2] {
        let phases: [f64; MAX_MODES] = std::array::from_fn(|m| f64::from(self.phase + table.phase(first + m)));
        [0.5, 0.0].map(|offset| {
            let mut row = [0.0; MAX_MODES];
            sines(&phases, FRAC_1_PI, offset, &mut row);
            row.map(|value| value as f32)
        })
    }

    /// Whether a hammer strikes, which the body pushes back. Bow and breath need the contacts of the modes for themselves, the
    /// formulas of the seed have none, and modes with phases do not say where they are displaced.
    fn is_felt(&self, values: &StruckValues, note: &Note) -> bool {
        let knobs = &values.instrument.knobs;
        knobs.choice::<MalletPulse>(Param::MalletPulse) == MalletPulse::Felt
            && note.contact.is_none()
            && self.phase == 0.0
            && self.forces[0] > 0.0
            && !values.modes().has_phases()
            && knobs.choice::<Coefficients>(Param::Coefficients) == Coefficients::Exact
            && exciter_gain(values.get(Param::BowLevel)) == 0.0
            && !self.blowing.may_blow()
            && !self.is_played_on()
    }

    /// Reads the strike's parameters and starts the exciters. `frequency` is the note's, in Hz. Returns the energy that the
    /// strike adds.
    pub(super) fn strike(
        &mut self,
        values: &StruckValues,
        note: &Note,
        frequency: f64,
        unison: Unison,
        bank: &mut Cells,
    ) -> f64 {
        // Each unison voice has its own phase and noise; together they have the energy of one voice.
        let (Unison { index, count }, key) = (unison, random::key(values.instrument.seed, note.serial));
        let key = if index == 0 { key } else { random::key(key, index as u64) };
        self.key = key;
        if count > 1 {
            let phase = random::uniform(random::key(key, PHASE_STREAM), 0);
            self.phase = (PI * values.share(Param::UnisonPhase)) as f32 * phase;
        }
        self.variation = Variation::new(values, key);
        self.variation.move_mallet(note.contact.map_or(0.0, |contact| contact.place.into()));

        let soft = if note.soft { SOFT_FORCE } else { 1.0 };
        let follow = values.share(Param::Velocity);
        let force = |own| {
            let power = 2.0 * (follow + values.share(own)).max(0.0);
            curves::force(note.velocity, power) * soft / sqrt(count as f64)
        };
        let [mallet, pluck, burst] = [Param::MalletVelocity, Param::PluckVelocity, Param::NoiseVelocity].map(force);
        let levels = [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel];
        let [mallet_gain, pluck_gain, noise_gain] = levels.map(|param| exciter_gain(values.get(param)));
        self.forces = [mallet * mallet_gain, pluck * pluck_gain, burst * noise_gain];
        let level = |param| exciter_gain(values.instrument.knobs.modulated(param).into()) / sqrt(count as f64);
        self.full_forces = levels.map(level);
        self.bowing.strike(values, force(Param::BowVelocity));
        self.blowing.strike(values, key, count);
        self.held_noise.strike(values, key, burst);
        let kind = values.instrument.knobs.choice(Param::Rattle);
        self.rattling.strike(if values.modes().has_phases() { Rattle::Off } else { kind });
        // The energy of earlier strikes has been counted already.
        self.energy = 0.0;
        let varied = self.variation.hardness;
        let hardness = |param| {
            let hardness = (values.share(param) + varied).clamp(0.0, 1.0);
            if note.soft { hardness * (1.0 - SOFT_HARDNESS) } else { hardness }
        };
        let sample_rate = values.instrument.sample_rate;
        let frames = |seconds: f64| frames(seconds, sample_rate);
        let is_felt = self.is_felt(values, note);
        let speed = if is_felt { 1.0 } else { mallet * sqrt(count as f64) };
        let contact = mallet_seconds(values, note, hardness(Param::MalletHardness), speed, frequency);
        self.hammering = Hammering::OFF;
        let mut push = (self.forces[0] as f32, frames(contact));
        if is_felt {
            push = (0.0, 1);
            self.hammering.strike(values, [self.forces[0], self.full_forces[0]], contact * sample_rate);
        }
        let more = self.set_gains(values, bank);
        let stroke = Stroke {
            push,
            pull: (self.forces[1] as f32, frames(contact_time(hardness(Param::PluckHardness)))),
            noise: BurstSetup {
                force: if self.is_noisy { self.forces[2] as f32 } else { 0.0 },
                frames: frames(values.get(Param::NoiseTime)),
                attack: frames(values.get(Param::NoiseAttack)),
                decay: match NoiseDecay::from_value(values.get(Param::NoiseDecay) as f32) {
                    NoiseDecay::Quadratic => Decay::Quadratic,
                    NoiseDecay::Exponential => Decay::Exponential,
                },
                hits: values.get(Param::NoiseHits) as u32,
                spacing: frames(values.get(Param::NoiseSpacing)),
                colour: values.share(Param::NoiseColour),
                key,
            },
        };
        self.exciter.strike(&stroke, sample_rate);
        more
    }
}

/// The greatest amplitude of a nudge of mode `m`, for one of `count` unison voices; 0 if there is no such mode.
pub(super) fn most_nudged(values: &StruckValues, m: usize, count: usize) -> f64 {
    let level = |param| exciter_gain(values.instrument.knobs.modulated(param).into());
    let levels = [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel].map(level);
    let loudest = levels.into_iter().fold(0.0, f64::max);
    let force = if loudest > 0.0 { loudest } else { 1.0 } / sqrt(count as f64);
    values.tilted_levels().as_flattened().get(m).map_or(0.0, |level| force * fabs(*level))
}

/// Contact time of the mallet in seconds, for a speed from 0 to 1 and a note's frequency in Hz.
fn mallet_seconds(values: &StruckValues, note: &Note, hardness: f64, speed: f64, frequency: f64) -> f64 {
    if let Some(contact) = note.contact {
        return contact.seconds.into();
    }
    if values.instrument.knobs.choice::<MalletPulse>(Param::MalletPulse) == MalletPulse::Impulse {
        return 0.0;
    }
    let stretch = hertz(values.get(Param::MalletMass), speed, values.share(Param::MalletSpeed));
    let contact = contact_time(hardness) * stretch;
    let by_key = values.share(Param::MalletKey);
    let shortened = if by_key > 0.0 { pow((1.0 / (frequency.max(1.0) * contact)).min(1.0), by_key) } else { 1.0 };
    contact * shortened
}

fn frames(seconds: f64, sample_rate: f64) -> u32 {
    (seconds * sample_rate + 0.5) as u32
}
