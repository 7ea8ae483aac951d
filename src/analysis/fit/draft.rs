//! The fit's description of a sound, in Hz and amplitudes, and the patch that plays it.

use super::movement::{Oscillator, Sweep, Swell, speed};
use crate::analysis::log_mel::RATE;
use crate::params::{Choice, MalletPulse, NoiseDecay, NoteOff, Param};
use crate::patch::routes::Source;
use crate::patch::{Mode, ModeTable, Patch};
use crate::sound::contact_time;
use crate::units::key_from_frequency;
use libm::{cos, fabs, log10, pow};
use std::f64::consts::PI;

/// Frequency in Hz of A4 in a new patch.
pub(super) const A4: f64 = 440.0;
/// Maximum number of modes of a fit.
pub(super) const MOST_MODES: usize = 256;
/// Shortest T60 in seconds of a mode that is struck, and the longest ones of a sound that decays and of one that is held.
pub(super) const SHORTEST_T60: f64 = 0.004;
const LONGEST_T60: [f64; 2] = [60.0, 600.0];

/// The longest T60 in seconds of a mode that is struck. Longer ones would be guesses: in a sound that decays, they are heard.
pub(super) fn longest_t60(is_held: bool) -> f64 {
    LONGEST_T60[usize::from(is_held)]
}

/// Lower bound of the spectrum of a contact, so that modes near its zeros are not struck ever harder: −40 dB.
const LEAST_OF_CONTACT: f64 = 0.01;
/// Places of the route of a swell and of the first one of an oscillator. The routes made from several takes are before them, those
/// of a new patch after them.
const SWELL_ROUTE: usize = 3;
const OSCILLATOR_ROUTES: usize = 4;
/// Most oscillators of a draft: as many as the engine has.
pub(super) const MOST_OSCILLATORS: usize = 3;
/// Low-frequency oscillators, each with its rate, shape and phase.
const LFOS: [(Source, [Param; 3]); MOST_OSCILLATORS] = [
    (Source::Lfo1, [Param::Lfo1Rate, Param::Lfo1Shape, Param::Lfo1Phase]),
    (Source::Lfo2, [Param::Lfo2Rate, Param::Lfo2Shape, Param::Lfo2Phase]),
    (Source::Lfo3, [Param::Lfo3Rate, Param::Lfo3Shape, Param::Lfo3Phase]),
];

/// A mode of the sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Partial {
    /// Hz, after the sweep.
    pub(super) frequency: f64,
    /// Seconds.
    pub(super) t60: f64,
    /// Amplitude in the mean of the channels, at the onset; negative for an inverted phase.
    pub(super) amplitude: f64,
    /// Start phase in radians of a struck mode, −π/2 to π/2; 0 for a sine.
    pub(super) phase: f64,
    /// −1 to 1.
    pub(super) pan: f64,
    /// Whether the strike excites it, and not the noise.
    pub(super) struck: bool,
}

/// The burst of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Noise {
    pub(super) seconds: f64,
    pub(super) decay: NoiseDecay,
    pub(super) attack: f64,
}

impl Noise {
    /// A click.
    pub(super) const SHORT: Self = Self { seconds: 0.004, decay: NoiseDecay::Quadratic, attack: 0.0 };

    /// The engine's longest burst in seconds.
    pub(super) const LONGEST: f64 = 1.0;
    /// Seconds from which a burst is heard as noise, and affects the decays.
    pub(super) const AUDIBLE: f64 = 0.02;

    /// Whether it is heard as noise, and not as a click.
    pub(super) fn is_audible(&self) -> bool {
        self.seconds >= Self::AUDIBLE
    }
}

/// The description of a sound.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draft {
    /// Frequency in Hz of the note that it was recorded on.
    pub(super) note: f64,
    /// 0–1.
    pub(super) velocity: f64,
    /// How much velocity sets the force, 0–1.
    pub(super) follow: f64,
    pub(super) partials: Vec<Partial>,
    /// Hardness of the mallet, 0–1; none for a strike in a single sample.
    pub(super) hardness: Option<f64>,
    pub(super) sweep: Sweep,
    pub(super) noise: Noise,
    pub(super) swell: Option<Swell>,
    /// Up to [`MOST_OSCILLATORS`].
    pub(super) oscillators: Vec<Oscillator>,
    /// Whether it ends when its key is released, and not by itself.
    pub(super) is_held: bool,
}

/// Share of a strike's force that reaches a mode of a frequency in Hz, by a contact of this many seconds: the spectrum
/// of the engine's pulse `u² (1 − u)²`, in whole frames at [`RATE`], relative to its middle. The share is negative
/// where the pulse acts more against the wave than with it.
pub(super) fn contact_share(frequency: f64, seconds: f64) -> f64 {
    let frames = ((seconds * f64::from(RATE) + 0.5) as usize).max(1);
    let turn = 2.0 * PI * frequency * frames as f64 / f64::from(RATE);
    let (mut sum, mut all) = (0.0, 0.0);
    for n in 0..frames {
        let u = (n as f64 + 0.5) / frames as f64;
        let force = u * u * (1.0 - u) * (1.0 - u);
        (sum, all) = (sum + force * cos(turn * (u - 0.5)), all + force);
    }
    sum / all
}

/// Gain of a pan in the mean of both channels: the engine's pan law has constant power.
pub(super) fn share_of_mean(pan: f64) -> f64 {
    0.5 * (libm::sqrt(1.0 - pan) + libm::sqrt(1.0 + pan))
}

impl Partial {
    /// Proportional to the energy of its whole decay.
    pub(super) fn energy(&self) -> f64 {
        self.amplitude * self.amplitude * self.t60
    }

    /// A partial measured so many seconds after the onset, with the level that it had there, but at most `most_db` above. Its phase
    /// stays as it is.
    pub(super) fn earlier(&self, seconds: f64, most_db: f64) -> Self {
        let before = (60.0 * seconds / self.t60).min(most_db);
        Self { amplitude: self.amplitude * pow(10.0, before / 20.0), ..*self }
    }

    /// The frequency in Hz at the mean time of its energy, since a sweep moves it.
    pub(super) fn heard_at(&self, sweep: &Sweep) -> f64 {
        self.frequency * speed(sweep, self.t60)
    }
}

impl Draft {
    /// The partial with the most energy over its whole decay.
    pub(super) fn main(&self) -> Option<&Partial> {
        self.partials.iter().max_by(|a, b| a.energy().total_cmp(&b.energy()))
    }

    /// The key that it was recorded on, as a fractional MIDI key.
    pub(super) fn key(&self) -> f64 {
        key_from_frequency(self.note, A4)
    }

    /// The force of its strike, 0–1.
    pub(super) fn force(&self) -> f64 {
        pow(self.velocity, 2.0 * self.follow)
    }

    /// The level that its mode needs for the partial's amplitude, if the force is 1.
    fn demand(&self, partial: &Partial) -> f64 {
        let share = match self.hardness {
            Some(hardness) if partial.struck => {
                // The contact is over before the pitch has moved far.
                let struck_at = partial.frequency * pow(2.0, self.sweep.semitones / 12.0);
                let share = contact_share(struck_at, contact_time(hardness));
                if share < 0.0 { share.min(-LEAST_OF_CONTACT) } else { share.max(LEAST_OF_CONTACT) }
            }
            _ => 1.0,
        };
        partial.amplitude / (share * share_of_mean(partial.pan))
    }

    /// The patch that plays it. Allocates.
    pub(super) fn patch(&self) -> Patch {
        let main = self.main().map_or(1.0, |partial| partial.t60);
        let [decay_info, gain_info] = [Param::Decay, Param::Gain].map(Param::info);
        let longest = self.partials.iter().map(|partial| partial.t60).fold(0.0, f64::max);
        // A mode rings at most this many times as long as the patch's decay.
        let reach = f64::from(Mode::FIELDS[2].2);
        let decay = main.max(longest / reach).clamp(decay_info.min.into(), decay_info.max.into());
        let force = self.force();
        let demands: Vec<f64> = self.partials.iter().map(|partial| self.demand(partial) / force).collect();
        let total: f64 = demands.iter().map(|demand| fabs(*demand)).sum::<f64>().max(1e-9);
        let gain_db = (20.0 * log10(total)).clamp(gain_info.min.into(), gain_info.max.into());
        let gain = pow(10.0, gain_db / 20.0);
        let mode = |(partial, demand): (&Partial, &f64)| {
            let mode = Mode {
                ratio: digits(partial.frequency / self.note, 7) as f32,
                level: digits(demand / gain, 4) as f32,
                decay: digits(partial.t60 / decay, 4) as f32,
                strike: if partial.struck { 1.0 } else { 0.0 },
                pan: digits(partial.pan, 2) as f32,
            };
            mode.clamped()
        };
        let modes: Vec<Mode> = self.partials.iter().zip(&demands).map(mode).collect();
        let phases: Vec<f32> = self.partials.iter().map(|partial| digits(partial.phase, 3) as f32).collect();
        let table = ModeTable::new(&modes);
        let table = if phases.iter().any(|phase| *phase != 0.0) { table.with_phases(&phases) } else { table };
        let mut patch = Patch { modes: table, ..Patch::default() };
        let mut set = |param: Param, value: f64| {
            let info = param.info();
            patch.set(param, info.clamp(digits(value, 5) as f32));
        };
        set(Param::Decay, decay);
        set(Param::Gain, (gain_db * 100.0).round() / 100.0);
        set(Param::Velocity, (100.0 * self.follow).round());
        let note_off = if self.is_held { NoteOff::Damp } else { NoteOff::Ring };
        set(Param::NoteOff, f64::from(note_off.value()));
        set(Param::NoiseTime, self.noise.seconds);
        set(Param::NoiseAttack, self.noise.attack);
        set(Param::NoiseDecay, f64::from(self.noise.decay.value()));
        if let Some(hardness) = self.hardness {
            set(Param::MalletPulse, f64::from(MalletPulse::Contact.value()));
            set(Param::MalletHardness, 100.0 * hardness);
        }
        if self.sweep.semitones != 0.0 {
            set(Param::Sweep, self.sweep.semitones);
            set(Param::SweepTime, self.sweep.seconds);
            set(Param::SweepCurve, 100.0 * self.sweep.curve);
        }
        if self.sweep.vibrato.semitones != 0.0 {
            set(Param::Vibrato, 100.0 * self.sweep.vibrato.semitones);
            set(Param::VibratoRate, self.sweep.vibrato.rate);
            set(Param::VibratoDelay, self.sweep.vibrato.delay);
        }
        for (oscillator, (_, [rate, shape, phase])) in self.oscillators.iter().zip(&LFOS) {
            set(*rate, oscillator.rate);
            set(*shape, oscillator.shape.value().into());
            set(*phase, 100.0 * oscillator.phase);
        }
        if let Some(swell) = self.swell {
            let depth = swell.depth.min(gain_db - f64::from(gain_info.min));
            set(Param::Gain, ((gain_db - depth) * 100.0).round() / 100.0);
            set(Param::Envelope1Attack, swell.seconds);
            set(Param::Envelope1Curve, 100.0 * swell.curve);
            match swell.fall {
                None => {
                    set(Param::Envelope1Sustain, 100.0);
                    // The damper ends the note, and not the envelope.
                    set(Param::Envelope1Release, Param::Envelope1Release.info().max.into());
                }
                Some(seconds) => {
                    set(Param::Envelope1Sustain, 0.0);
                    // A key that comes up before the end lets the sound fall, too.
                    set(Param::Envelope1Decay, seconds);
                    set(Param::Envelope1Release, seconds);
                }
            }
            patch = patch.with_route(SWELL_ROUTE, Source::Envelope1, Param::Gain, amount(Param::Gain, depth));
        }
        let moved = self.oscillators.iter().zip(&LFOS).flat_map(|(oscillator, (source, _))| {
            [(Param::Gain, oscillator.db), (Param::Tune, oscillator.semitones)]
                .map(|(param, depth)| (*source, param, depth))
        });
        for (n, (source, param, depth)) in moved.filter(|(.., depth)| *depth != 0.0).enumerate() {
            patch = patch.with_route(OSCILLATOR_ROUTES + n, source, param, amount(param, depth));
        }
        patch
    }
}

/// The amount in percent of a route that moves a parameter by `depth` in its unit.
fn amount(param: Param, depth: f64) -> f32 {
    digits(100.0 * depth / f64::from(param.info().max - param.info().min), 5) as f32
}

/// A number rounded to `digits` significant digits.
pub(super) fn digits(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = pow(10.0, f64::from(digits - 1) - libm::floor(log10(fabs(value))));
    (value * scale).round() / scale
}
