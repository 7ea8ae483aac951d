//! Finds the loop of a steady sound: two places at which it is the same.

use crate::io::Loop;

/// Share of a sound that passes before its loop may begin: the attack.
const ATTACK: f64 = 0.4;
/// Seconds of the blocks whose levels are compared, and most dB by which they may differ.
const BLOCK: f64 = 0.05;
const STEADY_DB: f64 = 1.0;
/// Shortest loop in seconds. Shorter ones sound like a tone of their own.
const SHORTEST: f64 = 0.25;
/// Seconds in which the sound must be the same at both ends of the loop.
const SAME: f64 = 0.02;
/// Largest energy of the difference relative to that of the sound: −45 dB, which is not heard as a step.
const DIFFERENCE: f64 = 3.2e-5;

/// The loop of a sound at a rate in Hz; none if it is not steady or does not come back to itself.
pub(super) fn find(sound: &[Vec<f32>; 2], rate: u32) -> Option<Loop> {
    let frames = sound[0].len();
    let count = |seconds: f64| (seconds * f64::from(rate)) as usize;
    let (start, same) = ((ATTACK * frames as f64) as usize, count(SAME));
    if !is_steady(sound, start, count(BLOCK)) || frames < start + count(SHORTEST) + same {
        return None;
    }
    let energy = |at: usize| -> f64 { sound.iter().flat_map(|side| &side[at..at + same]).map(|x| square(*x)).sum() };
    let wanted = energy(start);
    // Most candidates are given up after a few frames.
    let difference = |end: usize, limit: f64| {
        let mut sum = 0.0;
        for n in 0..same {
            sum += sound.iter().map(|side| square(side[start + n] - side[end + n])).sum::<f64>();
            if sum >= limit {
                return None;
            }
        }
        Some(sum)
    };
    let (mut best, mut end) = (DIFFERENCE * wanted, None);
    for candidate in (start + count(SHORTEST)..frames - same).rev() {
        if let Some(sum) = difference(candidate, best) {
            (best, end) = (sum, Some(candidate));
        }
    }
    end.map(|end| Loop { start: start as u64, end: end as u64 })
}

fn square(sample: f32) -> f64 {
    f64::from(sample) * f64::from(sample)
}

/// Whether the levels of all blocks from a frame on are alike.
fn is_steady(sound: &[Vec<f32>; 2], start: usize, block: usize) -> bool {
    let energies = (start..sound[0].len().saturating_sub(block))
        .step_by(block.max(1))
        .map(|at| sound.iter().flat_map(|side| &side[at..at + block]).map(|sample| square(*sample)).sum::<f64>());
    let (least, most) =
        energies.fold((f64::INFINITY, 0.0_f64), |(least, most), energy| (least.min(energy), most.max(energy)));
    most > 0.0 && 10.0 * libm::log10(most / least) < STEADY_DB
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn tone(decay: f64, noise: f64) -> [Vec<f32>; 2] {
        let random = crate::dsp::random::key(1, 2);
        let sample = |n: u32| {
            let t = f64::from(n) / 48_000.0;
            let tone = 0.3 * libm::sin(TAU * 220.0 * t) + 0.1 * libm::sin(TAU * 663.0 * t);
            (libm::exp(-decay * t) * tone + noise * f64::from(crate::dsp::random::uniform(random, n.into()))) as f32
        };
        let side: Vec<f32> = (0..96_000).map(sample).collect();
        [side.clone(), side]
    }

    #[test]
    fn a_steady_sound_has_a_loop_whose_ends_are_the_same() {
        let sound = tone(0.0, 0.0);
        let Loop { start, end } = find(&sound, 48_000).unwrap();
        for n in 0..480 {
            let [a, b] = [start, end].map(|at| sound[0][at as usize + n]);
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
        assert!(end - start >= 12_000);
    }

    #[test]
    fn what_decays_or_hisses_has_none() {
        assert_eq!(find(&tone(1.0, 0.0), 48_000), None);
        assert_eq!(find(&tone(0.0, 0.05), 48_000), None);
    }
}
