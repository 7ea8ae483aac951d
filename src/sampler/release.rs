//! Measures how long a note sounds after its key is let go.

use super::settings::Sampling;
use super::strike::strike;
use crate::error::Result;
use crate::sound::Kit;
use std::sync::Arc;

/// Seconds for which the key is held, and seconds that are heard after it.
const HELD: f64 = 0.3;
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
