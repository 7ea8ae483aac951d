//! Drafts of noise that lasts as long as the sound, as of breath, a shaker or a scratched record.

use super::bed::{self, Lines};
use super::draft::{Draft, Noise};
use super::movement::Sweep;
use super::refine::{Listener, NEAR_DB};
use super::sweep;
use super::take::Prepared;
use crate::analysis::log_mel::{BANDS, MelBands, RATE, time};
use crate::error::Result;

/// Powers relative to the greatest at which a noise has come to its level, and at which it is over: −3 and −30 dB.
const HALF: f64 = 0.5;
const OVER: f64 = 1e-3;
/// Shortest and longest noise in seconds that goes on for as long as the sound.
const LASTING: (f64, f64) = (0.02, 1.0);
/// Sweeps of noise that are tried, in semitones and seconds, and the steps from the best of these; seconds of the longest sound for
/// which they are, and the reduction of the distance in dB for which one is kept.
const SEMITONES: [f64; 6] = [-22.0, -13.0, -6.0, 6.0, 13.0, 22.0];
const SECONDS: [f64; 5] = [0.05, 0.1, 0.2, 0.4, 0.8];
const STEPS: [f64; 3] = [0.4, 0.25, 0.15];
const LONGEST_SWEPT: f64 = 1.5;
const WORTH_A_SWEEP_DB: f64 = 0.2;
/// Bursts of a noise that stays at its level, the longest distance in seconds between them, and their length relative to it.
const HITS: u8 = 16;
const FARTHEST: f64 = 0.5;
const OVERLAP: f64 = 3.0;
/// Seed of the pans of the modes.
const SEED: u64 = 10;

/// Whether the noise of a draft lasts.
pub(super) fn lasts(draft: &Draft) -> bool {
    draft.noise.seconds > LASTING.0
}

/// Seconds from the onset until a sound has come to its level, and until it is over.
fn extent(take: &Prepared) -> (f64, f64) {
    let target = MelBands::new().measure(&take.mean);
    let power = |column: &[f64; BANDS]| column.iter().map(|level| libm::pow(10.0, 0.1 * level)).sum::<f64>();
    let powers: Vec<f64> = target.columns.iter().map(power).collect();
    let loudest = powers.iter().copied().fold(0.0, f64::max);
    let seconds = |at: Option<usize>| time(at.unwrap_or(0));
    let attack = seconds(powers.iter().position(|power| *power > HALF * loudest));
    (attack, seconds(powers.iter().rposition(|power| *power > OVER * loudest)))
}

/// A draft of noise that goes on for as long as the sound, up to a second, as of breath or a shaker, through short modes.
pub(super) fn lasting(take: &Prepared, most: usize, draft: Draft) -> Draft {
    let (attack, end) = extent(take);
    // The engine's noise falls after its attack.
    let seconds = (end - attack).clamp(LASTING.0, LASTING.1);
    let noise = Noise { seconds, attack: attack.min(LASTING.1), ..Noise::SHORT };
    through_short_modes(&take.mean, most, Draft { noise, ..draft })
}

/// A row of bursts without gaps, whose level stays about the same until the sound is over.
fn level_noise(take: &Prepared) -> Noise {
    let spacing = (extent(take).1 / f64::from(HITS)).clamp(LASTING.0 / OVERLAP, FARTHEST);
    Noise { hits: HITS, spacing, seconds: (OVERLAP * spacing).min(LASTING.1), ..Noise::SHORT }
}

/// The draft with short modes at the levels of samples whose pitch is constant.
fn through_short_modes(samples: &[f32], most: usize, draft: Draft) -> Draft {
    let mut partials = bed::short(&MelBands::new().measure(samples), &Lines::new(samples), most, SEED);
    bed::alternate(&mut partials);
    Draft { partials, ..draft }
}

/// The draft with its noise shaped, or with a noise that stays at its level, and with the sweep of its modes if it has one.
pub(super) fn shaped(draft: Draft, take: &Prepared, most: usize, listener: &mut Listener) -> Result<Draft> {
    let mut level = Draft { noise: level_noise(take), ..draft.clone() };
    let mut best = draft;
    for shaped in [&mut best, &mut level] {
        listener.settle_noise(shaped)?;
    }
    let [mut still, of_level] = [listener.distance(&best, usize::MAX)?, listener.distance(&level, usize::MAX)?];
    if of_level < still {
        (best, still) = (level, of_level);
    }
    let is_short = take.mean.len() <= (LONGEST_SWEPT * f64::from(RATE)) as usize;
    let moving = if is_short && still > NEAR_DB { swept(&best, still, take, most, listener)? } else { None };
    Ok(moving.unwrap_or(best))
}

/// The draft with the sweep that brings it nearer than `still` dB, if there is one: found by ear, since noise has no pitch to follow.
fn swept(draft: &Draft, still: f64, take: &Prepared, most: usize, listener: &mut Listener) -> Result<Option<Draft>> {
    let decay = sweep::decay(&take.mean);
    let (mut least, mut found) = (still - WORTH_A_SWEEP_DB, None);
    let coarse = SEMITONES.iter().flat_map(|semitones| SECONDS.map(|seconds| (*semitones, seconds)));
    let mut tried: Vec<Sweep> =
        coarse.map(|(semitones, seconds)| Sweep { semitones, seconds, curve: 0.0, ..Sweep::NONE }).collect();
    for step in STEPS {
        for sweep in tried {
            let samples = sweep::stilled(&take.mean, &sweep, decay);
            let mut other = through_short_modes(&samples, most, Draft { sweep, ..draft.clone() });
            let distance = listener.settle(&mut other)?;
            if distance < least {
                (found, least) = (Some(other), distance);
            }
        }
        let Some(found) = &found else { return Ok(None) };
        let near = [[step, 0.0, 0.0], [0.0, step, 0.0], [0.0, 0.0, step]];
        tried = near.iter().flat_map(|by| [*by, by.map(|by| -by)]).map(|by| found.sweep.moved(by)).collect();
    }
    if let Some(swept) = &mut found {
        listener.settle_noise(swept)?;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::super::audition::{Audition, Played};
    use super::super::correct;
    use super::super::draft::Partial;
    use super::super::take::{Take, VELOCITY};
    use super::*;
    use crate::io::sound_file::Recording;

    /// A draft of noise through forty modes, and what it sounds like.
    fn sound(noise: Noise, sweep: Sweep) -> (Draft, Prepared) {
        let partial = |n: usize| Partial {
            frequency: 300.0 * libm::pow(1.08, n as f64),
            t60: 0.04,
            amplitude: if n.is_multiple_of(2) { 0.02 } else { -0.02 },
            phase: 0.0,
            pan: 0.0,
            struck: false,
        };
        let partials = (0..40).map(partial).collect();
        let draft = Draft { noise, sweep, partials, ..correct::tests::draft([0.0; 2]) };
        let note = Played { key: 69.0, velocity: draft.velocity, frames: RATE as usize, let_go: None };
        let samples = Audition::new().mean(&draft.patch(), note);
        let recording =
            Recording { sample_rate: RATE, channels: vec![samples], encoding: String::new(), warnings: Vec::new() };
        let take = Take { name: "a.wav".to_owned(), recording, key: Some(69.0), velocity: VELOCITY };
        (draft, Prepared::new(&take).unwrap())
    }

    /// The shaped draft of a sound, and its distance in dB.
    fn found((draft, take): &(Draft, Prepared)) -> (Draft, f64) {
        let mut go_on = |_: f64| true;
        let mut listener = Listener::new(take, &mut go_on);
        let first = lasting(take, 96, Draft { partials: Vec::new(), sweep: Sweep::NONE, ..draft.clone() });
        assert!(lasts(&first));
        let shaped = shaped(first, take, 96, &mut listener).unwrap();
        let distance = listener.distance(&shaped, usize::MAX).unwrap();
        (shaped, distance)
    }

    #[test]
    fn a_breath_is_found_with_its_rise_and_its_length() {
        let breath = Noise { attack: 0.1, seconds: 0.4, ..Noise::SHORT };
        let (draft, distance) = found(&sound(breath, Sweep::NONE));
        assert!(distance < 2.5 && draft.noise.hits == 1, "{distance:.2} dB, {:?}", draft.noise);
        assert!(libm::fabs(libm::log2(draft.noise.attack / breath.attack)) < 0.7, "{:?}", draft.noise);
        assert!(libm::fabs(libm::log2(draft.noise.seconds / breath.seconds)) < 0.6, "{:?}", draft.noise);
    }

    #[test]
    fn noise_that_stays_at_its_level_becomes_a_row_of_bursts() {
        let level = Noise { hits: 16, spacing: 0.02, seconds: 0.06, ..Noise::SHORT };
        let (draft, distance) = found(&sound(level, Sweep::NONE));
        assert!(distance < 2.5 && draft.noise.hits == 16, "{distance:.2} dB, {:?}", draft.noise);
        assert!((draft.noise.last() / level.last() - 1.0).abs() < 0.2, "{:?}", draft.noise);
    }

    #[test]
    fn the_sweep_of_noise_is_heard() {
        let sweep = Sweep { semitones: -14.0, seconds: 0.2, curve: 0.0, ..Sweep::NONE };
        let (draft, distance) = found(&sound(Noise { attack: 0.02, seconds: 0.3, ..Noise::SHORT }, sweep));
        assert!(distance < 3.5 && draft.sweep.semitones < -5.0, "{distance:.2} dB, {:?}", draft.sweep);
    }
}
