//! Tests with modes denser than their bandwidths, as in a drum head.

use super::*;

/// Modes of a drum head, 2 to 30 Hz apart, with bandwidths of a thirtieth of their frequencies: 4 to 38 Hz from 130 Hz on.
fn head(lowest: f64, count: usize, random: &mut Sequence) -> Vec<Known> {
    let mode = |place: usize| {
        let frequency = lowest + 16.0 * (place as f64 + 0.9 * random.unit());
        Known(frequency, 66.0 / frequency, 0.2 + 0.8 * random.unit(), 0.0)
    };
    (0..count).map(mode).collect()
}

#[test]
fn modes_denser_than_their_bandwidths_are_told_apart() {
    dense_modes(700.0, 24, 1..=1);
}

#[test]
#[ignore = "takes minutes"]
fn modes_denser_than_their_bandwidths_are_told_apart_in_larger_heads() {
    dense_modes(130.0, 64, 1..=3);
}

fn dense_modes(lowest: f64, count: usize, seeds: std::ops::RangeInclusive<u64>) {
    for seed in seeds {
        let mut random = Sequence::new(key(seed, 0));
        let known = head(lowest, count, &mut random);
        let (samples, ..) = sound(&known, 0.6, -300.0, &mut random);
        let strike = &taken_apart(samples).strikes[0];
        let is_found = |known: &&Known| {
            let near = |mode: &Mode| (mode.frequency - known.0).abs() < 0.5 && (mode.t60 / known.1 - 1.0).abs() < 0.05;
            strike.modes.iter().any(near)
        };
        let (found, modes) = (known.iter().filter(is_found).count(), strike.modes.len());
        let case = format!("seed {seed}: {found} of {count}, {modes} modes, {:.1} dB are left", strike.residual_db);
        println!("{case}");
        assert!(strike.residual_db < -90.0 && 4 * found >= 3 * count && modes <= count + 4, "{case}");
    }
}

#[test]
fn what_nobody_could_hear_beside_its_neighbour_is_no_mode() {
    let mut random = Sequence::new(1);
    for (level_db, heard) in [(-90.0, true), (-115.0, false)] {
        let faint = Known(442.7, 0.95, pow(10.0, level_db / 20.0), 0.3);
        let (samples, ..) = sound(&[Known(440.0, 1.0, 1.0, 0.0), faint], 1.5, -300.0, &mut random);
        let found = &taken_apart(samples).strikes[0];
        assert_eq!(found.modes.len(), if heard { 2 } else { 1 }, "{level_db} dB: {:?}", found.modes);
    }
}
