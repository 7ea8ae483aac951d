//! Drafts a held sound: the modes of the sound without its drift.

use super::draft::{Draft, Partial, SHORTEST_T60, longest_t60};
use super::drift::Drift;
use super::movement::Sweep;
use super::pitch_track;
use super::prepared::Prepared;
use super::start::{self, Found, Source};
use super::tones::{HOP, Tone, tones};
use crate::analysis::log_mel::RATE;
use crate::analysis::modes::{Mode, Strike};
use crate::error::Result;
use libm::{cos, exp, log, pow, sin};
use std::f64::consts::TAU;

/// Times that the drift is measured by the modes, and the residual in dB below which once is enough.
const MEASURED: usize = 2;
const STILL_DB: f64 = -35.0;
/// Seconds in which a tone rises, greatest difference of a level that counts, as a logarithm, and greatest distance in Hz of a
/// mode from its tone.
const ATTACK: f64 = 0.1;
const MOST_OFF: f64 = 3.0;
const REACH: f64 = 22.0;

/// The draft, with at most `most` modes, and the strike in which these were found; none if the sound has no tones. If the movement
/// of the pitch is `known`, the draft has that one, and no tremolo.
///
/// First the drift is measured by itself, and then by how the sound differs from the modes that were found without it, since
/// these explain the beats. More modes are found in what the first ones leave, among them high and faint ones.
pub(super) fn draft(
    take: &Prepared,
    known: Option<Sweep>,
    most: usize,
    tell: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Found>> {
    let Some(first) = Drift::of(&take.mean, take.rise) else { return Ok(None) };
    let without = |drift: &Drift| take.channels.iter().map(|channel| drift.removed_from(channel)).collect::<Vec<_>>();
    let mut part = |n: usize, share: f64| tell((n as f64 + share) / 4.0);
    let found = |drift: &Drift, tell: &mut dyn FnMut(f64) -> bool| start::strike(&without(drift), most / 3, tell);
    let (mut drift, Some(mut strike)) = (first.clone(), found(&first, &mut |share| part(0, share))?) else {
        return Ok(None);
    };
    for n in 1..=MEASURED {
        let refined = drift.refined(&strike);
        let again = found(&refined, &mut |share| part(n, share))?;
        match again.filter(|again| again.residual_db < strike.residual_db) {
            Some(again) => (drift, strike) = (refined, again),
            None => break,
        }
        if strike.residual_db < STILL_DB {
            break;
        }
    }
    let still = without(&drift);
    let from = (strike.fitted_from * f64::from(RATE)) as usize;
    let rest: Vec<Vec<f32>> =
        (0..still.len()).map(|channel| unexplained(&still[channel], channel, &strike, from)).collect();
    if let Some(more) = start::strike(&rest, most / 4, &mut |share| part(MEASURED + 1, share))? {
        let late = from as f64 / f64::from(RATE) + more.onset - strike.onset;
        strike.modes.extend(more.modes.into_iter().map(|mode| earlier(mode, late)));
        strike.steady.extend(more.steady.into_iter().map(|mode| earlier(mode, late)));
        strike.residual_db += more.residual_db;
        strike.residual = more.residual;
    }
    let (swept, mean) = known.map_or_else(|| pitch_track::of_pitch(&drift.pitches()), |known| (known, 0.0));
    let mut draft = start::from(take, Some(&strike), &Source { swept, late: 0.0, struck: true }, true);
    let still = drift.removed_from(&take.mean);
    if known.is_none() {
        draft.oscillators = drift.tremolo(&mut || tell(1.0))?.into_iter().collect();
    }
    let pairs = compared(&still[from.min(still.len())..], &unexplained(&still, usize::MAX, &strike, from));
    steady(&mut draft, most, &pairs, from);
    // The modes have the mean pitch, and those of a draft the pitch without sweep and vibrato.
    draft.partials.iter_mut().for_each(|partial| partial.frequency *= pow(2.0, -mean / 12.0));
    Ok(Some((draft, Some(strike))))
}

/// The tones of a sound, each with its track relative to the modes that leave `rest` of the sound.
fn compared(sound: &[f32], rest: &[f32]) -> Vec<(Tone, Tone)> {
    let modes: Vec<f32> = sound.iter().zip(rest).map(|(sample, rest)| sample - rest).collect();
    tones(sound, None).into_iter().zip(tones(sound, Some(&modes))).collect()
}

/// Replaces the modes of each tone by a steady mode if that is nearer to the track of its level. `pairs` are those of
/// [`compared`], of a sound that begins with a sample `from` the onset. The draft gets no more than `most` modes.
fn steady(draft: &mut Draft, most: usize, pairs: &[(Tone, Tone)], from: usize) {
    let moments = |seconds: f64| seconds * f64::from(RATE) / HOP as f64;
    for (tone, against) in pairs {
        let Some(line) = tone.line(moments(ATTACK) as usize) else { continue };
        let off = |value: f64| value.abs().min(MOST_OFF);
        let levels: Vec<[f64; 2]> = tone.levels();
        let of_steady: f64 =
            levels.iter().enumerate().map(|(n, [level, _])| off(level - line[0] - line[1] * n as f64)).sum();
        let of_modes: f64 = against.levels().iter().map(|[level, _]| off(*level)).sum();
        if of_steady >= of_modes {
            continue;
        }
        let others = pairs.iter().map(|(other, _)| other).filter(|other| other.frequency != tone.frequency);
        let near = others.map(|other| 0.5 * (other.frequency - tone.frequency).abs()).fold(REACH, f64::min);
        let is_of = |partial: &Partial| (partial.frequency - tone.frequency).abs() < near;
        let members = draft.partials.iter().filter(|partial| is_of(partial));
        let pan =
            members.max_by(|a, b| a.amplitude.abs().total_cmp(&b.amplitude.abs())).map_or(0.0, |partial| partial.pan);
        draft.partials.retain(|partial| !is_of(partial));
        if draft.partials.len() >= most {
            continue;
        }
        let t60 = (log(1000.0) / (-line[1] * moments(1.0)).max(1e-9)).clamp(SHORTEST_T60, longest_t60(draft.is_held));
        let amplitude = exp(line[0] - line[1] * from as f64 / HOP as f64);
        draft.partials.push(Partial {
            frequency: tone.mean_frequency(),
            t60,
            amplitude,
            phase: 0.0,
            pan,
            struck: true,
        });
    }
}

/// A channel without the modes of a strike, from a sample on.
fn unexplained(samples: &[f32], channel: usize, strike: &Strike, from: usize) -> Vec<f32> {
    let mut rest: Vec<f64> = samples[from.min(samples.len())..].iter().map(|sample| f64::from(*sample)).collect();
    for mode in strike.modes.iter().chain(&strike.steady) {
        let (level, phase) = mode.channels.get(channel).copied().unwrap_or((mode.level_db, mode.phase));
        let late = from as f64 / f64::from(RATE) - strike.onset;
        let fall = log(1000.0) / mode.t60;
        let (turn, start) = (TAU * mode.frequency / f64::from(RATE), TAU * mode.frequency * late + phase);
        let radius = exp(-fall / f64::from(RATE));
        let step = [radius * cos(turn), radius * sin(turn)];
        let amplitude = pow(10.0, level / 20.0) * exp(-fall * late);
        let mut state = [amplitude * cos(start), amplitude * sin(start)];
        for sample in &mut rest {
            *sample -= state[1];
            state = [state[0] * step[0] - state[1] * step[1], state[0] * step[1] + state[1] * step[0]];
        }
    }
    rest.into_iter().map(|sample| sample as f32).collect()
}

/// A mode with level and phase of `seconds` earlier.
fn earlier(mut mode: Mode, seconds: f64) -> Mode {
    let (rise, turn) = (60.0 * seconds / mode.t60, TAU * mode.frequency * seconds);
    (mode.level_db, mode.phase) = (mode.level_db + rise, libm::remainder(mode.phase - turn, TAU));
    for (level, phase) in &mut mode.channels {
        (*level, *phase) = (*level + rise, libm::remainder(*phase - turn, TAU));
    }
    mode
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::modes::{Settings, modes};

    fn sine(frequency: f64, t60: f64, phase: f64) -> impl Fn(usize) -> f64 {
        move |n| {
            let t = n as f64 / f64::from(RATE);
            0.3 * exp(-log(1000.0) * t / t60) * sin(TAU * frequency * t + phase)
        }
    }

    #[test]
    fn nothing_is_left_of_a_sound_without_its_modes() {
        let tones = [sine(440.0, 3.0, 0.3), sine(1234.5, 1.0, 2.0)];
        let sound: Vec<f32> =
            (0..RATE as usize).map(|n| tones.iter().map(|tone| tone(n)).sum::<f64>() as f32).collect();
        let found = modes(std::slice::from_ref(&sound), RATE.into(), &Settings::default(), &mut |_| true).unwrap();
        let strike = &found.strikes[0];
        let left = unexplained(&sound, 0, strike, 2000);
        assert!(left.len() == sound.len() - 2000 && left.iter().all(|sample| sample.abs() < 1e-4));
        let mode = strike.modes[0].clone();
        let before = earlier(mode.clone(), 0.25);
        let turned = libm::remainder(mode.phase - before.phase - TAU * mode.frequency * 0.25, TAU);
        assert!(turned.abs() < 1e-9 && (before.level_db - mode.level_db - 15.0 / mode.t60).abs() < 1e-9);
    }

    #[test]
    fn modes_that_end_too_early_give_way_to_a_steady_one() {
        let sound: Vec<f32> = (0..2 * RATE as usize).map(|n| sine(700.0, 100.0, 0.0)(n) as f32).collect();
        let (early, late) = (sine(700.0, 0.4, 0.0), sine(1500.0, 100.0, 0.0));
        let sound: Vec<f32> = sound.iter().enumerate().map(|(n, sample)| sample + late(n) as f32).collect();
        let rest: Vec<f32> = sound.iter().enumerate().map(|(n, sample)| sample - (early(n) + late(n)) as f32).collect();
        let partial = |frequency, t60| Partial { frequency, t60, amplitude: 0.3, phase: 0.0, pan: 0.2, struck: true };
        let mut draft = super::super::correct::tests::draft([0.0; 2]);
        draft.partials = vec![partial(700.0, 0.4), partial(1500.0, 100.0)];
        let mut few = draft.clone();
        let pairs = compared(&sound, &rest);
        steady(&mut few, 1, &pairs, 0);
        assert_eq!(few.partials, [partial(1500.0, 100.0)]);
        steady(&mut draft, 8, &pairs, 0);
        assert_eq!(draft.partials.len(), 2, "{:?}", draft.partials);
        assert_eq!(draft.partials[0], partial(1500.0, 100.0));
        let Partial { frequency, t60, amplitude, pan, .. } = draft.partials[1];
        let is_steady = (frequency - 700.0).abs() < 0.5 && t60 > 50.0 && (amplitude - 0.3).abs() < 0.02 && pan == 0.2;
        assert!(is_steady, "{:?}", draft.partials);
    }
}
