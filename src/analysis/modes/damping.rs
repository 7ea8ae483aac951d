//! Finds where a strike is damped while it rings, as by a key that is released, a hand or a gate.
//!
//! The energy of freely ringing modes, apart from beats, falls along a curve that is convex in decibels, since fast
//! decays end first. Where the curve turns down and stays down, something else takes energy. Beats turn down as well.
//! So a place is confirmed by modes that were fitted to the sound before it: after a beat they still explain the sound,
//! but not after damping.

use super::fit::Fit;
use super::pole::add;
use crate::analysis::level::energy;
use crate::analysis::line::Line;
use libm::log10;
use std::ops::Range;

/// Seconds from one level to the next, and number of steps over which a level is measured.
const STEP: f64 = 0.005;
const SMOOTH: usize = 4;
/// Steps before and after a place over which slopes are measured.
const REACHES: [usize; 4] = [16, 32, 64, 128];
/// Least drop in dB of the level at the end of a reach below the line through the levels before.
const LEAST_DROP_DB: f64 = 4.0;
/// The same in mean deviations of the levels from their lines.
const LEAST_DEVIATIONS: f64 = 4.0;
/// Least distance in dB of all later levels from that line.
const NO_RETURN_DB: f64 = 2.0;
/// Slope in dB per step above which a sound is driven and does not ring freely.
const RISING: f64 = 0.02;
/// Range of levels in dB below the loudest. Lower levels are raised to its end, so that a sound that ends in digital
/// silence does not count as damped there.
const RANGE_DB: f64 = 90.0;
/// Levels less than this many dB above the quietest give no information.
const FLOOR_DB: f64 = 6.0;
/// Seconds before the place that are left out, since the place is only roughly known, and their largest share of the
/// time before it. A damper that acts slowly is noticed late: leave out at least the time in which it takes this many dB.
const GUARD: f64 = 0.05;
const GUARD_SHARE: f64 = 0.2;
const GUARD_DB: f64 = 5.0;
/// Levels in dB that the damper takes until modes are compared with the sound. With less, the modes could still explain it.
const COMPARED_DB: f64 = 8.0;
/// Longest time for both of these together, as a share of the time before the place. If they took longer, [`GUARD`] and half of it count:
/// modes that were measured over a short time tell little about what comes long after it.
const AHEAD: f64 = 0.4;
/// Seconds after the place in which modes are compared with the sound.
const COMPARED: f64 = 0.15;
/// Most times that they are compared, one after the other, since the place may be too early.
const COMPARISONS: usize = 3;
/// Latest begin of a comparison but the first, after the last fitted sample, as a share of the time before that.
const FARTHEST: f64 = 0.8;
/// Largest share of the energy that modes leave unexplained if they explain the sound.
const UNEXPLAINED: f64 = 0.2;
/// Largest share of the modes' energy that a damper leaves. If more is left, the modes were wrong.
const DAMPED: f64 = 0.5;
/// Share of the last samples before the place that modes leave unexplained. Above it they do not tell what follows: recordings of a
/// cowbell (0.039) and a steel drum (0.080) that nobody damps seemed to be damped.
const UNKNOWN: f64 = 0.035;
/// Such a share above which a damper must take most of the sound: a beat in noise can look like a damper, and what is none in a recorded
/// tubular bell (0.024) left 0.38 of the energy. The key of a recorded guitar (0.030) left 0.05.
const DOUBTFUL: f64 = 0.01;
/// Largest share of the modes' energy that a damper leaves then.
const DAMPED_IF_DOUBTFUL: f64 = 0.1;
/// Such a share up to which modes tell what comes later, too. The second comparison of Gong C4 (0.0042), whose modes build up, seemed to
/// show a damper; the keys of Tubular Bells (below 0.0001) need the third.
const CLEAR: f64 = 0.001;
/// Most dampers that are tried: each costs a search.
const MOST_DAMPERS: usize = 2;

/// The line through levels, and their mean deviation from it.
fn line(levels: &[f64]) -> Option<(Line, f64)> {
    let line = Line::through_values(levels)?;
    let error = |(step, level): (usize, &f64)| (level - line.at(step as f64)).abs();
    Some((line, levels.iter().enumerate().map(error).sum::<f64>() / line.weight))
}

/// Where a damper seems to act.
#[derive(Clone, Copy, Debug)]
pub(super) struct Damper {
    /// The frame before which the samples ring freely.
    pub(super) from: usize,
    /// Number of frames from there until the damper has clearly lowered the level.
    lag: usize,
}

/// How the levels turn down for good at a place.
struct Bend {
    /// In mean deviations from the lines before and after.
    significance: f64,
    /// Change of the slope in dB per step, downwards.
    steeper: f64,
}

/// Where the samples seem to be damped, earliest first: a sound that falls for long after its key is let go may turn down most clearly
/// in that fall.
pub(super) fn dampers(samples: &[f64], sample_rate: f64) -> Vec<Damper> {
    let (mut dampers, mut end) = (Vec::new(), samples.len());
    while dampers.len() < MOST_DAMPERS
        && let Some(damper) = damped_from(&samples[..end], sample_rate)
    {
        end = damper.from;
        dampers.push(damper);
    }
    dampers.reverse();
    dampers
}

/// Where the samples seem to be damped most clearly, if they do.
fn damped_from(samples: &[f64], sample_rate: f64) -> Option<Damper> {
    let step = ((STEP * sample_rate) as usize).max(1);
    let energies: Vec<f64> = samples.chunks_exact(step).map(|block| energy(block, 0.0) / step as f64).collect();
    let level = |blocks: &[f64]| 10.0 * log10((blocks.iter().sum::<f64>() / SMOOTH as f64).max(1e-30));
    let mut levels: Vec<f64> = energies.windows(SMOOTH).map(level).collect();
    let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    levels.iter_mut().for_each(|level| *level = level.max(loudest - RANGE_DB));
    let quietest = levels.iter().copied().fold(f64::INFINITY, f64::min);
    let (bend, place) = REACHES
        .iter()
        .flat_map(|reach| (*reach..levels.len().saturating_sub(*reach / 2)).map(move |place| (*reach, place)))
        .filter_map(|(reach, place)| Some((bend(&levels, place, reach, quietest)?, place)))
        .max_by(|a, b| a.0.significance.total_cmp(&b.0.significance))?;
    // Frames in which the damper takes so many dB.
    let takes = |db: f64| (db / bend.steeper * step as f64) as usize;
    let (place, shortest) = (place * step, (GUARD * sample_rate) as usize);
    let slow = [shortest.max(takes(GUARD_DB)), (shortest / 2).max(takes(COMPARED_DB))];
    let is_known = (slow[0] + slow[1]) as f64 <= AHEAD * place as f64;
    let [guard, later] = if is_known { slow } else { [shortest, shortest / 2] };
    let from = place - guard.min((GUARD_SHARE * place as f64) as usize);
    Some(Damper { from, lag: guard + later })
}

/// How the levels turn down for good at a place. `None` if they do not.
fn bend(levels: &[f64], place: usize, reach: usize, quietest: f64) -> Option<Bend> {
    // A level covers several steps, so the levels right before the place include later sound.
    let (before, off_before) = line(&levels[place - reach..place + 1 - SMOOTH])?;
    let until = (place + reach).min(levels.len());
    let (after, off_after) = line(&levels[place..until])?;
    let last = (until - 1 - place) as f64;
    let expected = |later: f64| before.at(reach as f64 + later);
    let drop = expected(last) - after.at(last);
    let significance = drop / (off_before + off_after + 0.25);
    if before.slope > RISING || drop < LEAST_DROP_DB || significance < LEAST_DEVIATIONS {
        return None;
    }
    // Once the line through the levels before comes near the floor, it gives no information.
    let back = |(later, level): (usize, &f64)| {
        let expected = expected(later as f64);
        expected > quietest + FLOOR_DB && *level > expected - NO_RETURN_DB
    };
    let comes_back = levels[place..].iter().enumerate().skip(reach / 2).any(back);
    let steeper = before.slope - after.slope;
    (!comes_back && steeper > 0.0).then_some(Bend { significance, steeper })
}

/// Whether the sound differs from the continuation of the modes that were fitted to its samples before a damper, and is weaker
/// than it.
pub(super) fn confirmed(fit: &Fit, damper: Damper, samples: &[f64], sample_rate: f64) -> bool {
    let compared = ((COMPARED * sample_rate) as usize).max(1);
    let last = damper.from.saturating_sub(compared);
    let before = fit.residual(&samples[..damper.from]);
    let unexplained = energy(&before[last..], 0.0) / energy(&samples[last..damper.from], fit.constant).max(1e-300);
    if unexplained > UNKNOWN {
        return false;
    }
    let comparisons = if unexplained > CLEAR { 1 } else { COMPARISONS };
    let most_left = if unexplained > DOUBTFUL { DAMPED_IF_DOUBTFUL } else { DAMPED };
    let first = damper.from + damper.lag;
    let farthest = ((1.0 + FARTHEST) * damper.from as f64) as usize;
    let begins = (first..first + comparisons * compared).step_by(compared);
    // At its end, a sound may be too short for more than the first comparison.
    let later = |begin: usize| begin < farthest && begin + compared <= samples.len();
    begins
        .filter(|begin| *begin == first || later(*begin))
        .any(|begin| differs(fit, samples, begin..begin + compared, most_left))
}

/// Whether a range of the samples differs from the continuation of modes, and has less than a share `most_left` of its energy.
fn differs(fit: &Fit, samples: &[f64], range: Range<usize>, most_left: f64) -> bool {
    let Some(after) = samples.get(range.start..range.end.min(samples.len())) else { return false };
    let mut expected = vec![fit.constant; after.len()];
    for (pole, amplitude) in fit.poles.iter().zip(&fit.amplitudes) {
        add(&mut expected, *pole, *amplitude * pole.power(range.start), 1.0);
    }
    let left: Vec<f64> = after.iter().zip(&expected).map(|(sample, expected)| sample - expected).collect();
    let of_expected = energy(&expected, fit.constant);
    energy(&left, 0.0) > UNEXPLAINED * of_expected && energy(after, fit.constant) < most_left * of_expected
}

#[cfg(test)]
mod tests {
    use super::super::tests::driven;
    use super::super::{Settings, modes};
    use crate::dsp::random::{key, unit};
    use crate::sound::bodies::LN_1000;
    use crate::units::gain_from_db;
    use libm::{exp, sin};
    use std::f64::consts::TAU;

    const RATE: f64 = 48_000.0;
    /// Seconds until the damper falls.
    const LET_GO: f64 = 1.5;

    /// Three seconds of beating pairs with T60s from 4 to 8 s, damped by a T60 of `damper` seconds.
    fn damped(damper: f64) -> Vec<f32> {
        let sample = |n: usize| {
            let t = n as f64 / RATE;
            let mode = |k: usize| {
                let frequency = 300.0 * (1.0 + (k / 2) as f64 * 0.83) + 0.9 * (k % 2) as f64;
                let t60 = 8.0 - 0.5 * k as f64;
                let fall = t.min(LET_GO) / t60 + (t - LET_GO).max(0.0) / damper.min(t60);
                0.1 * exp(-LN_1000 * fall) * sin(TAU * frequency * t + k as f64)
            };
            (0..8).map(mode).sum::<f64>() as f32
        };
        (0..3 * RATE as usize).map(sample).collect()
    }

    #[test]
    fn dampers_are_found() {
        for damper in [0.05, 0.4] {
            let found = modes(&[damped(damper)], RATE, &Settings::default(), &mut |_| true).unwrap();
            let strike = &found.strikes[0];
            // Under slow beats a damper is noticed up to a tenth of a second late.
            let near = strike.damped.is_some_and(|seconds| (LET_GO - 0.3..LET_GO + 0.1).contains(&seconds));
            let explains = strike.modes.len() == 8 && strike.residual_db < -35.0;
            assert!(near && explains, "{damper} s: {:?}, {:?}", strike.damped, strike.residual_db);
        }
        let found = modes(&[damped(100.0)], RATE, &Settings::default(), &mut |_| true).unwrap();
        assert_eq!(found.strikes[0].damped, None);
    }

    /// Samples with noise of this level in dBFS.
    fn in_noise(mut samples: Vec<f32>, db: f64) -> Vec<f32> {
        let (key, level) = (key(7, 0), gain_from_db(db) * 12.0_f64.sqrt());
        samples.iter_mut().zip(0..).for_each(|(sample, n)| *sample += (level * (unit(key, n) - 0.5)) as f32);
        samples
    }

    fn found(samples: Vec<f32>) -> Option<f64> {
        modes(&[samples], RATE, &Settings::default(), &mut |_| true).unwrap().strikes[0].damped
    }

    #[test]
    fn in_noise_a_damper_must_take_more() {
        let found = [-42.0, -30.0].map(|db| found(in_noise(damped(0.05), db)).is_some());
        assert_eq!(found, [true, false]);
    }

    #[test]
    #[ignore = "takes half a minute"]
    fn the_end_of_what_modes_do_not_explain_is_no_damper() {
        let mode = (TAU * 300.0 / RATE, exp(-LN_1000 / (0.3 * RATE)));
        let sound = driven(&[mode], (0.15 * RATE) as usize, RATE as usize);
        assert_eq!(found(sound.into_iter().map(|sample| 0.01 * sample as f32).collect()), None);
    }
}
