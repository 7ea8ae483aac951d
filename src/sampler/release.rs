//! Measures how long a note sounds after its key is let go, and how fast it falls while the key is held.

use super::settings::Sampling;
use super::strike::strike;
use crate::analysis::line::Line;
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
/// The energy of a block of silence, in dB.
const SILENT_DB: f64 = -120.0;

/// The time in seconds in which the sound falls by 60 dB after the key is let go, by the line through the levels of all blocks
/// until it has fallen by 40 dB; none if it is silent by then.
pub(super) fn seconds(sampling: &Sampling, kit: &Arc<Kit>, key: u8, velocity: u8) -> Result<Option<f64>> {
    let sound = strike(sampling, kit, key, velocity, 0, [HELD, HEARD])?;
    Ok(fall_time(&sound, sampling.rate))
}

fn fall_time(sound: &[Vec<f32>; 2], rate: u32) -> Option<f64> {
    let rate = f64::from(rate);
    let (held, block) = ((HELD * rate) as usize, ((BLOCK * rate) as usize).max(1));
    let last = sound[0].len().saturating_sub(block);
    let levels: Vec<f64> = (held..=last).step_by(block).map(|at| level(sound, at, block)).collect();
    let first = *levels.first().filter(|level| **level > SILENT_DB)?;
    let fallen = levels.iter().take_while(|level| **level > first - FALL_DB).count().max(2).min(levels.len());
    let fall = -Line::through_values(&levels[..fallen])?.slope * rate / block as f64;
    Some(if fall > 0.0 { (60.0 / fall).clamp(RANGE.0, RANGE.1) } else { RANGE.1 })
}

/// The most dB a second by which a held sound is said to fall: SFZ has no more.
const MOST_FALL: f64 = 200.0;

/// The dB a second by which a held sound falls, on average, from where the keys of released samples are let go until it is silent or
/// ends; 0 if it does not.
pub(super) fn fall(sound: &[Vec<f32>; 2], rate: u32) -> f64 {
    let count = |seconds: f64| ((seconds * f64::from(rate)) as usize).max(1);
    let (held, block) = (count(HELD), count(10.0 * BLOCK));
    let level = |at: usize| level(sound, at, block);
    let first = level(held.saturating_sub(block));
    let last = sound[0].len().saturating_sub(block);
    let Some(end) = (held..=last).step_by(block).take_while(|at| level(*at) > first - 60.0).last() else { return 0.0 };
    let seconds = (end + block - held) as f64 / f64::from(rate);
    ((first - level(end)) / seconds).clamp(0.0, MOST_FALL)
}

/// The energy in dB of a number of frames from one on, on both sides; −300 dB of silence.
pub(super) fn level(sound: &[Vec<f32>; 2], from: usize, frames: usize) -> f64 {
    let samples = sound.iter().flat_map(|side| side.iter().skip(from).take(frames));
    10.0 * libm::log10(samples.map(|sample| f64::from(*sample) * f64::from(*sample)).sum::<f64>().max(1e-30))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_a_fall_is_that_of_its_line() {
        for time in [0.01, 0.1, 0.5, 3.0] {
            let sample = |n: u32| {
                let t = f64::from(n) / 8000.0;
                let gain = libm::pow(10.0, -3.0 * (t - HELD).max(0.0) / time);
                (gain * libm::sin(std::f64::consts::TAU * 110.0 * t)) as f32
            };
            let side: Vec<f32> = (0..18_400).map(sample).collect();
            let found = fall_time(&[side.clone(), side], 8000).unwrap();
            assert!((found - time).abs() < 0.05 * time.max(0.02), "{time}: {found}");
        }
        assert_eq!(fall_time(&[vec![0.0; 8000], vec![0.0; 8000]], 8000), None);
    }

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
