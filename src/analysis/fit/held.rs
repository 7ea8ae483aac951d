//! Drafts a held sound: the modes of the sound without its drift.

use super::draft::{Draft, Partial, SHORTEST_T60, longest_t60};
use super::drift::Drift;
use super::movement::Sweep;
use super::pitch_track;
use super::prepared::Prepared;
use super::start::{self, Found, Source};
use super::tones::{HOP, Tone, tones};
use crate::analysis::log_mel::RATE;
use crate::error::Result;
use libm::{exp, log, pow};

/// Seconds in which a tone rises, greatest difference of a level that counts, as a logarithm, and greatest distance in Hz of a
/// mode from its tone.
const ATTACK: f64 = 0.1;
const MOST_OFF: f64 = 3.0;
const REACH: f64 = 22.0;

/// The draft, with at most `most` modes, and the strike in which these were found; none if the sound has no tones. If the movement
/// of the pitch is `known`, the draft has that one, and no tremolo.
pub(super) fn draft(
    take: &Prepared,
    known: Option<Sweep>,
    most: usize,
    tell: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Found>> {
    let Some(drift) = Drift::of(&take.mean, take.rise) else { return Ok(None) };
    let still: Vec<Vec<f32>> = take.channels.iter().map(|channel| drift.removed_from(channel)).collect();
    let Some(strike) = start::strike(&still, most.div_ceil(2), tell)? else { return Ok(None) };
    let (swept, mean) = known.map_or_else(|| pitch_track::of_pitch(&drift.pitches()), |known| (known, 0.0));
    let mut draft = start::from(take, Some(&strike), &Source { swept, late: 0.0, struck: true }, true);
    if known.is_none() {
        draft.oscillators = drift.tremolo(&mut || tell(1.0))?.into_iter().collect();
    }
    let from = (strike.fitted_from * f64::from(RATE)) as usize;
    steady(&mut draft, most, &compared(&strike.samples, &strike.residual), from);
    // The modes have the mean pitch, and those of a draft the pitch without sweep and vibrato.
    draft.partials.iter_mut().for_each(|partial| partial.frequency *= pow(2.0, -mean / 12.0));
    Ok(Some((draft, Some(strike))))
}

/// The tones of a sound, each with that of the modes which leave `rest` of the sound.
fn compared(sound: &[f32], rest: &[f32]) -> Vec<(Tone, Tone)> {
    let modes: Vec<f32> = sound.iter().zip(rest).map(|(sample, rest)| sample - rest).collect();
    let pair = |tone: Tone| {
        let of_modes = Tone::of(&modes, tone.frequency);
        (tone, of_modes)
    };
    tones(sound).into_iter().map(pair).collect()
}

/// Replaces the modes of each tone by a steady mode if that is nearer to the track of its level. `pairs` are those of
/// [`compared`], of the stretch that was analysed, which begins with a sample `from` the onset. The draft gets no more than `most` modes.
fn steady(draft: &mut Draft, most: usize, pairs: &[(Tone, Tone)], from: usize) {
    let moments = |seconds: f64| seconds * f64::from(RATE) / HOP as f64;
    for (tone, modes) in pairs {
        let Some(line) = tone.line(moments(ATTACK) as usize) else { continue };
        let off = |value: f64| value.abs().min(MOST_OFF);
        let levels: Vec<[f64; 2]> = tone.levels();
        let of_steady: f64 =
            levels.iter().enumerate().map(|(n, [level, _])| off(level - line[0] - line[1] * n as f64)).sum();
        let of_modes: f64 =
            levels.iter().zip(modes.levels()).map(|([level, _], [of_modes, _])| off(level - of_modes)).sum();
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

#[cfg(test)]
mod tests {
    use super::*;
    use libm::sin;
    use std::f64::consts::TAU;

    fn sine(frequency: f64, t60: f64, phase: f64) -> impl Fn(usize) -> f64 {
        move |n| {
            let t = n as f64 / f64::from(RATE);
            0.3 * exp(-log(1000.0) * t / t60) * sin(TAU * frequency * t + phase)
        }
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
