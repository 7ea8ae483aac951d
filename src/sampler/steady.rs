//! Finds the loop of a sustained sound, and fades its end over into what precedes its beginning.

use super::release::level;
use crate::io::Loop;

/// Shares of a sound that pass before its loop may begin: the attack is over by then in most.
const STARTS: [f64; 3] = [0.3, 0.4, 0.5];
/// Most dB by which the halves of what follows the attack may differ: a loop would hold what falls.
const STEADY_DB: f64 = 1.0;
/// Shortest loop in seconds. Shorter ones sound like a flutter.
const SHORTEST: f64 = 0.5;
/// Seconds in which the end fades over.
const FADE: f64 = 0.05;
/// Lowest correlation at which the end is faded over: below it, partials would be heard to cancel.
const LEAST_LIKENESS: f64 = 0.7;
/// Frames per second that are compared in the search. What ensembles differ by lies far below the 3 kHz that these carry.
const COMPARED: usize = 6000;

/// The loop of a sound at a rate in Hz; none if it is not steady or never comes back to what it was. With a loop, the sound ends where
/// the loop does, and its last frames lead to the loop’s first.
pub(super) fn find(sound: &mut [Vec<f32>; 2], rate: u32) -> Option<Loop> {
    let frames = sound[0].len();
    let count = |seconds: f64| (seconds * f64::from(rate)) as usize;
    let (fade, shortest) = (count(FADE), count(SHORTEST));
    let starts = STARTS.map(|share| (share * frames as f64) as usize);
    if fade == 0 || starts[0] < fade || !is_steady(sound, starts[0]) {
        return None;
    }
    let stride = (rate as usize / COMPARED).max(1);
    let candidates = starts.iter().flat_map(|start| (start + shortest..=frames).map(|end| [*start, end]));
    let best = candidates.map(|ends| (likeness(sound, ends, fade, stride), ends)).max_by(|a, b| a.0.total_cmp(&b.0));
    let [start, end] = best?.1;
    let likeness = likeness(sound, [start, end], fade, 1);
    if likeness < LEAST_LIKENESS {
        return None;
    }
    for side in sound {
        for n in 0..fade {
            let [into, from] = gains((n + 1) as f64 / fade as f64, likeness);
            let [a, b] = [start, end].map(|at| f64::from(side[at - fade + n]));
            side[end - fade + n] = (into * a + from * b) as f32;
        }
        side.truncate(end);
    }
    Some(Loop { start: start as u64, end: end as u64 })
}

/// The correlation of the frames before both ends of a loop, less if one is louder: 1 if they are the same.
fn likeness(sound: &[Vec<f32>; 2], [start, end]: [usize; 2], fade: usize, stride: usize) -> f64 {
    let (mut product, mut energy) = (0.0, 0.0);
    for side in sound {
        let [a, b] = [start, end].map(|at| side[at - fade..at].iter().step_by(stride).map(|x| f64::from(*x)));
        for (a, b) in a.zip(b) {
            product += a * b;
            energy += a * a + b * b;
        }
    }
    if energy > 0.0 { 2.0 * product / energy } else { 0.0 }
}

/// The gains at a place from 0 to 1 in a fade between sounds of this correlation, which together are always as loud.
fn gains(place: f64, likeness: f64) -> [f64; 2] {
    let rest = 1.0 - place;
    let loudness = libm::sqrt(place * place + rest * rest + 2.0 * likeness * place * rest);
    [place / loudness, rest / loudness]
}

/// Whether both halves from a frame on are as loud.
fn is_steady(sound: &[Vec<f32>; 2], start: usize) -> bool {
    let half = (sound[0].len() - start) / 2;
    (level(sound, start, half) - level(sound, start + half, half)).abs() < STEADY_DB
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
    fn a_steady_sound_goes_on_after_its_loop_as_before_it() {
        for noise in [0.0, 0.05] {
            let before = tone(0.0, noise);
            let mut sound = before.clone();
            let Loop { start, end } = find(&mut sound, 48_000).unwrap();
            let (start, end) = (start as usize, end as usize);
            assert!(end - start >= 24_000 && sound[0].len() == end);
            assert_eq!(sound[0][end - 1], before[0][start - 1], "the last frame leads to the loop’s first");
            let power = |side: &[f32]| side.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>();
            let ratio = power(&sound[0][end - 2400..]) / power(&before[0][end - 2400..end]);
            assert!((ratio - 1.0).abs() < 0.03, "the fade has a level of its own: {ratio}");
        }
    }

    #[test]
    fn what_decays_hisses_or_is_silent_has_none() {
        assert_eq!(find(&mut tone(1.0, 0.0), 48_000), None);
        assert_eq!(find(&mut tone(1e9, 0.3), 48_000), None);
        assert_eq!(find(&mut tone(1e9, 0.0), 48_000), None);
        assert_eq!(find(&mut [vec![], vec![]], 48_000), None);
    }
}
