//! Measures how long a note sounds after its key is let go, and how fast it falls while the key is held.

use super::settings::Sampling;
use super::strike::strike;
use crate::error::Result;
use crate::sound::Kit;
use std::sync::Arc;

/// Seconds for which the key is held, and seconds that are heard after it.
pub(super) const HELD: f64 = 0.3;
const HEARD: f64 = 2.0;
/// Seconds of the blocks whose levels are compared.
const BLOCK: f64 = 0.005;
/// The fall in dB that is measured. A longer one would end in what rings by itself.
const FALL_DB: f64 = 40.0;
/// Shortest release in seconds, so that it does not click, and the longest.
const RANGE: (f64, f64) = (0.005, 30.0);

/// The time in seconds in which the sound falls by 60 dB after the key is let go; none if it is silent by then.
pub(super) fn seconds(sampling: &Sampling, kit: &Arc<Kit>, key: u8, velocity: u8) -> Result<Option<f64>> {
    let sound = strike(sampling, kit, key, velocity, 0, [HELD, HEARD])?;
    let rate = f64::from(sampling.rate);
    let (held, block) = ((HELD * rate) as usize, ((BLOCK * rate) as usize).max(1));
    let power = |at: usize| -> f64 {
        let samples = sound.iter().flat_map(|side| side.iter().skip(at).take(block));
        samples.map(|sample| f64::from(*sample) * f64::from(*sample)).sum()
    };
    let level = power(held.saturating_sub(block));
    if level <= 0.0 {
        return Ok(None);
    }
    let fallen = |at: usize| 10.0 * libm::log10(level / power(at).max(f64::MIN_POSITIVE));
    let blocks = held..sound[0].len().saturating_sub(block);
    let end = blocks.clone().step_by(block).find(|at| fallen(*at) >= FALL_DB);
    let at = end.unwrap_or(blocks.end);
    let (time, fall) = ((at - held) as f64 / rate + BLOCK, fallen(at).max(0.1));
    Ok(Some((60.0 * time / fall).clamp(RANGE.0, RANGE.1)))
}

/// The most dB a second by which a held sound is said to fall: SFZ has no more.
const MOST_FALL: f64 = 200.0;

/// The dB a second by which a held sound falls, on average, from where the keys of released samples are let go until it is silent or
/// ends; 0 if it does not.
pub(super) fn fall(sound: &[Vec<f32>; 2], rate: u32) -> f64 {
    let count = |seconds: f64| ((seconds * f64::from(rate)) as usize).max(1);
    let (held, block) = (count(HELD), count(10.0 * BLOCK));
    let level = |at: usize| -> f64 {
        let samples = sound.iter().flat_map(|side| side.iter().skip(at).take(block));
        10.0 * libm::log10(samples.map(|sample| f64::from(*sample) * f64::from(*sample)).sum::<f64>().max(1e-30))
    };
    let first = level(held.saturating_sub(block));
    let last = sound[0].len().saturating_sub(block);
    let Some(end) = (held..=last).step_by(block).take_while(|at| level(*at) > first - 60.0).last() else { return 0.0 };
    let seconds = (end + block - held) as f64 / f64::from(rate);
    ((first - level(end)) / seconds).clamp(0.0, MOST_FALL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fall_of_a_held_sound_is_measured() {
        for (fall_db, seconds, measured) in [(0.0, 2.0, 0.0), (30.0, 3.0, 30.0), (120.0, 3.0, 120.0), (30.0, 0.1, 0.0)]
        {
            let sample = |n: u32| libm::pow(10.0, -fall_db * f64::from(n) / (20.0 * 8000.0)) as f32;
            let side: Vec<f32> = (0..(seconds * 8000.0) as u32).map(sample).collect();
            let found = fall(&[side.clone(), side], 8000);
            assert!((found - measured).abs() < 0.05 * measured + 1e-6, "{fall_db}: {found}");
        }
    }
}
