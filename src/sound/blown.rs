//! Tubes that are blown: what of a patch makes the mouthpiece and the tube, and the pitch at which the two sound together.
//!
//! A valve has a mass, so its flow comes late, and the note sounds below the tube with a reed and above it with lips: by 5 to
//! 60 cents, more at high keys; a jet is within some cents. A player's ear puts that right; here, each blown sound is played
//! off the audio thread at every third key, by the bank and the mouthpiece that the voices use, and the tube is tuned against
//! what was heard.

use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Breath, JetLaw, Mouthpiece, MouthpieceLaw, Player, ValveLaw};
use crate::dsp::mode_bank::{MAX_MODES, ModeBank, ModeRows, ModeSetup};
use crate::params::{Choice, Param, Valve as Kind};
use crate::patch::routes::{Route, Source, amount_param};
use crate::patch::{Mode, Patch};
use crate::units::{frequency_from_key, ratio_from_semitones};
use libm::{atan2, cos, fabs, pow, sin};
use std::f64::consts::TAU;

/// Flow through a valve that is wide open at rest, at a pressure difference of 1 and per share of a mode. A clarinet’s reed of
/// 12 mm that stands 0.4 mm off has half of that; lips that stand 0.15 mm off have a tenth.
const WIDEST_FLOW: f64 = 3.0;

/// A reed’s own frequency in Hz, but at least so many times the note’s; and its quality.
const REED_FREQUENCY: f64 = 3200.0;
const REED_RATIO: f64 = 3.0;
const REED_QUALITY: f64 = 1.2;

/// Lips vibrate above their own frequency: this is it, as a multiple of the note’s, with their quality, and how far the pressure
/// that would close a reed opens them, as a multiple of their opening at rest.
const LIPS_RATIO: f64 = 0.8;
const LIPS_QUALITY: f64 = 8.0;
const LIPS_REACH: f64 = 3.0;

/// Modes above this frequency in Hz, or above this share of the sample rate, take no part in the tube.
const HIGHEST: f64 = 19_800.0;
const HIGHEST_SHARE: f64 = 0.45;

/// What is heard of the pressure in a tube rises with frequency, by its power of 5/3 or 10 dB an octave, since that is about how
/// pressures fall in a blown tube: so levels are near the amplitudes that are heard, as they are under any other exciter.
const HEARD: f64 = 5.0 / 3.0;

/// How much more is heard of a speed at the edge of a jet than of a pressure behind a valve: a jet's air reaches a quarter of
/// what a reed's pressure does, and a knob's dB should mean about the same for both.
const SPEED: f64 = 4.0;

/// Modes softer than this, against the loudest, count as this loud: what gives a pressure cannot be infinitely soft.
const SOFTEST: f64 = 1e-3;

/// A jet is in step with its note at this pressure. Harder breath makes it faster, by the square root; the player takes back most of
/// that by the distance of the lips; what is left is this power of the pressure.
const IN_STEP: f64 = 0.6;
const SPEED_POWER: f64 = 0.15;

/// The mouthpiece of a kind under a pressure, whose tension is moved by `lip` semitones, for a note of this frequency in Hz.
pub(crate) fn law(kind: Kind, lip: f64, pressure: f64, frequency: f64) -> MouthpieceLaw {
    let tension = ratio_from_semitones(lip);
    match kind {
        Kind::Reed => {
            let own = REED_FREQUENCY.max(REED_RATIO * frequency);
            MouthpieceLaw::Valve(ValveLaw { frequency: tension * own, quality: REED_QUALITY, reach: -1.0 })
        }
        Kind::Lips => {
            let own = LIPS_RATIO * frequency;
            MouthpieceLaw::Valve(ValveLaw { frequency: tension * own, quality: LIPS_QUALITY, reach: LIPS_REACH })
        }
        Kind::Jet => {
            MouthpieceLaw::Jet(JetLaw { frequency: tension * frequency * pow(pressure / IN_STEP, SPEED_POWER) })
        }
    }
}

/// The flow at a pressure difference of 1 through a valve, or the thickness of a jet, from the opening, 0–1.
pub(crate) fn flow(opening: f64) -> f64 {
    WIDEST_FLOW * opening
}

/// The amplitude of a mode whose level is 1, per unit of what the mouthpiece of a kind feels, at a breath of this gain.
pub(crate) fn amplitude(kind: Kind, gain: f64) -> f64 {
    gain * if kind == Kind::Jet { SPEED } else { 1.0 }
}

/// The share of the flow that a mode takes, if it sounds at this frequency in Hz.
pub(crate) fn share(mode: &Mode, frequency: f64, sample_rate: f64) -> f64 {
    if frequency < HIGHEST.min(HIGHEST_SHARE * sample_rate) { mode.strike.into() } else { 0.0 }
}

/// What a mode takes and gives, as [`ModeBank::set_contact`] wants it: with its share of the flow, its level and the level of the
/// loudest mode, the frequency of its ratio, and the amplitude that a pressure of 1 has in a mode of level and ratio 1.
pub(crate) fn contact(share: f64, [level, loudest]: [f64; 2], ratio: f64, amplitude: f64) -> [f32; 2] {
    if share == 0.0 || loudest == 0.0 || amplitude == 0.0 {
        return [0.0; 2];
    }
    let heard = amplitude * pow(ratio, HEARD) * fabs(level).max(SOFTEST * loudest).copysign(level);
    [(share * heard) as f32, (1.0 / heard) as f32]
}

/// The keys at which a blown sound is tuned; between them, the correction is interpolated.
const FIRST_KEY: usize = 24;
const KEYS_APART: usize = 3;
const TUNED: usize = 29;

/// How the sound is played to be tuned: at this rate in Hz, at this velocity. (The pitch is the same within two cents at all rates
/// from 44.1 kHz on.)
const RATE: f64 = 48_000.0;
const VELOCITY: f32 = 0.75;

/// Time until a note is steady, in seconds and in periods; and the length of what is listened to then. Twice as long for each
/// changes no correction of a factory sound by more than a quarter of a cent.
const SETTLED: [f64; 2] = [0.1, 15.0];
const WINDOW: [f64; 2] = [0.03, 6.0];

/// A correction of more cents is none: the note has not spoken, or on another mode.
const MOST_CENTS: f64 = 150.0;

/// After a correction of fewer cents, what is left of the error is some hundredths of a cent.
const NEAR: f64 = 5.0;

/// The transposition of a blown sound’s tube, by key.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Correction([f64; TUNED]);

impl Correction {
    /// That of a patch; none if its breath is off. Takes up to a tenth of a second.
    pub(crate) fn of(patch: &Patch) -> Option<Self> {
        if patch.get(Param::BreathLevel) <= Param::BreathLevel.info().min {
            return None;
        }
        let mut known = 0.0;
        Some(Self(std::array::from_fn(|place| {
            let key = (FIRST_KEY + KEYS_APART * place) as f64;
            for _ in 0..2 {
                let error = cents_off(patch, key, known).filter(|cents| fabs(*cents) < MOST_CENTS);
                known -= error.unwrap_or(0.0);
                if error.is_none_or(|cents| fabs(cents) < NEAR) {
                    break;
                }
            }
            0.01 * known
        })))
    }

    /// The correction in semitones for a pitch on the MIDI scale. Real-time safe.
    pub(crate) fn at(&self, pitch: f64) -> f64 {
        let place = ((pitch - FIRST_KEY as f64) / KEYS_APART as f64).clamp(0.0, (TUNED - 1) as f64);
        let before = (place as usize).min(TUNED - 2);
        let share = place - before as f64;
        self.0[before] * (1.0 - share) + self.0[before + 1] * share
    }
}

/// The value of a parameter for a note of this key at the velocity of the tuning, with the routes of both.
fn value(patch: &Patch, param: Param, key: f64) -> f64 {
    let info = param.info();
    let sources = |source| match source {
        Source::Key => Some(Source::key_at(key)),
        Source::Velocity => Some(VELOCITY),
        _ => None,
    };
    let travel = |(place, route): (usize, Route)| {
        let amount = patch.get(amount_param(place)) * 0.01;
        let is_own = route.destination == param && route.scale.is_none();
        sources(route.source).filter(|_| is_own).map_or(0.0, |source| amount * route.response.apply(source))
    };
    let travel: f32 = patch.routes.iter().map(travel).sum();
    let position = info.normalise(patch.get(param)) + f64::from(travel);
    info.denormalise(position.clamp(0.0, 1.0)).into()
}

/// How many cents a key sounds above its pitch if its tube is transposed by `cents`; none if it does not speak.
fn cents_off(patch: &Patch, key: f64, cents: f64) -> Option<f64> {
    let wanted = frequency_from_key(key, 440.0);
    let frequency = wanted * ratio_from_semitones(0.01 * cents);
    let value = |param| value(patch, param, key);
    let [decay, tilt, stretch] = [Param::Decay, Param::DecayTilt, Param::Stretch].map(value);
    let modes = patch.modes.at(patch.modes.place(wanted)).as_slice();
    let modes = &modes[..modes.len().min(MAX_MODES)];
    let sounding = |mode: &Mode| frequency * pow(mode.ratio.into(), stretch);
    let shares = || modes.iter().map(|mode| share(mode, sounding(mode), RATE));
    let setup = |(mode, share): (&Mode, f64)| {
        let t60 = decay * f64::from(mode.decay) * pow(mode.ratio.into(), -tilt);
        let heard = if share > 0.0 { 1.0 } else { 0.0 };
        ModeSetup { frequency: sounding(mode), t60, left: heard, right: heard }
    };
    let mut bank = ModeBank::new(RATE);
    let rows: ModeRows = modes.iter().zip(shares()).map(setup).collect();
    bank.load(&rows);
    // Heard is what the mouthpiece feels: all modes alike.
    shares().enumerate().for_each(|(m, share)| bank.set_contact(m, share as f32, rows.left[m]));
    let kind = Kind::from_value(patch.get(Param::BreathValve));
    let pressure = 0.01 * value(Param::BreathPressure);
    let steady = [pressure as f32, 0.0];
    let mut mouthpiece = Mouthpiece::REST;
    mouthpiece.breath = Breath {
        // What starts a jet is that its pressure rises.
        pressure: if kind == Kind::Jet { [0.0, steady[0] / CONTROL_FRAMES as f32] } else { steady },
        opening: flow(0.01 * value(Param::BreathOpening)) as f32,
        per_frame: (frequency / RATE) as f32,
        shares: shares().sum::<f64>() as f32,
        ..Breath::NONE
    };
    mouthpiece.set(law(kind, value(Param::BreathLip), pressure, frequency), RATE);

    let frames = |[seconds, periods]: [f64; 2]| (RATE * f64::max(seconds, periods / wanted)) as usize;
    let (settled, window) = (frames(SETTLED), frames(WINDOW));
    let mut heard = vec![];
    while heard.len() < settled + 2 * window {
        bank.sweep_to(1.0, CONTROL_FRAMES);
        let [left, _] = bank.render_played(None, Some(Player::Breath(&mut mouthpiece)), CONTROL_FRAMES);
        heard.extend_from_slice(left);
        mouthpiece.breath.pressure = steady;
    }
    let loudest = heard[settled..].iter().fold(0.0, |most: f32, sample| most.max(sample.abs()));
    let (frequency, fundamental) = frequency_of(&heard[settled..], window, wanted);
    let speaks = amplitude(kind, loudest.into()) > SPEAKS && fundamental > FUNDAMENTAL * f64::from(loudest);
    speaks.then(|| 1200.0 * libm::log2(frequency / wanted))
}

/// A note speaks if the pressure in its tube reaches this, or its speed a quarter of it; and on its own mode if its fundamental
/// has this share of the peak: of an overblown note some −80 dB are left.
const SPEAKS: f64 = 0.05;
const FUNDAMENTAL: f64 = 0.03;

/// The frequency in Hz of a steady tone near `guess`, and its amplitude: from how far the phase of its fundamental advances
/// between two windows, farther and farther apart, so that each distance tells the next one’s whole periods.
fn frequency_of(heard: &[f32], window: usize, guess: f64) -> (f64, f64) {
    let (mut frequency, mut amplitude) = (guess, 0.0);
    // The window, and the tone that phases are measured against, turn by rotation.
    let turn = |angle| (cos(angle), sin(angle));
    let turned = |(re, im): (f64, f64), (c, s): (f64, f64)| (re * c - im * s, re * s + im * c);
    let of_hann = turn(TAU / window as f64);
    for apart in [window / 64, window / 16, window / 4, window] {
        let of_tone = turn(TAU * frequency / RATE);
        let mut phase = |start: usize| {
            let (mut re, mut im) = (0.0, 0.0);
            let (mut hann, mut tone) = ((1.0, 0.0), turn(TAU * frequency * start as f64 / RATE));
            for sample in &heard[start..start + window] {
                let weighted = f64::from(*sample) * (1.0 - hann.0);
                (re, im) = (re + weighted * tone.0, im - weighted * tone.1);
                (hann, tone) = (turned(hann, of_hann), turned(tone, of_tone));
            }
            amplitude = 2.0 * libm::hypot(re, im) / window as f64;
            atan2(im, re)
        };
        let advance = phase(apart) - phase(0);
        let advance = advance - TAU * libm::round(advance / TAU);
        frequency += advance / TAU * RATE / apart as f64;
    }
    (frequency, amplitude)
}
