//! The spectrum of the last frames of the sound: a fast Fourier transform of a windowed piece.

use egui::Vec2;
use sprung::internals::display::SCOPE_FRAMES;
use sprung::units::db_from_gain;
use std::f32::consts::TAU;

/// The lowest level, in decibels; lower levels are raised to it.
pub(super) const FLOOR: f32 = -90.0;

/// Levels in decibels of the bands from 0 Hz to half the sample rate. A sine at full scale has 0 dB in its band. The
/// window is von Hann's, so that a sine fills three bands.
pub(super) fn levels(frames: &[f32; SCOPE_FRAMES]) -> Vec<f32> {
    let turns = |number: usize| Vec2::angled(TAU * number as f32 / SCOPE_FRAMES as f32);
    let windowed = |(number, frame): (usize, &f32)| Vec2::new(frame * 0.5 * (1.0 - turns(number).x), 0.0);
    let mut values: Vec<Vec2> = frames.iter().enumerate().map(windowed).collect();
    let roots: Vec<Vec2> = (0..SCOPE_FRAMES / 2).map(turns).collect();
    transform(&mut values, &roots);
    // The negative frequency has half of the amplitude, and the window's mean is one half.
    let scale = 4.0 / SCOPE_FRAMES as f32;
    let level = |value: &Vec2| (db_from_gain(f64::from(value.length() * scale)) as f32).max(FLOOR);
    values[..SCOPE_FRAMES / 2].iter().map(level).collect()
}

/// Transforms complex numbers in place (Cooley and Tukey 1965). Their count is a power of two; `roots` has the first
/// half of that many roots of unity.
fn transform(values: &mut [Vec2], roots: &[Vec2]) {
    let count = values.len();
    for place in 0..count {
        let other = place.reverse_bits() >> (usize::BITS - count.trailing_zeros());
        if place < other {
            values.swap(place, other);
        }
    }
    let mut half = 1;
    while half < count {
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (number, (low, high)) in low.iter_mut().zip(high).enumerate() {
                let root = roots[number * (count / (2 * half))];
                // Multiplied by the conjugate root.
                let turned = Vec2::new(high.x * root.x + high.y * root.y, high.y * root.x - high.x * root.y);
                (*low, *high) = (*low + turned, *low - turned);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_have_their_levels_in_their_bands() {
        for (band, gain) in [(100_usize, 1.0_f32), (7, 0.1), (1000, 0.001)] {
            let turns = |frame: usize| TAU * (band * frame % SCOPE_FRAMES) as f32 / SCOPE_FRAMES as f32;
            let levels = levels(&std::array::from_fn(|frame| gain * Vec2::angled(turns(frame)).y));
            let db = db_from_gain(f64::from(gain)) as f32;
            assert!((levels[band] - db).abs() < 0.01, "{}", levels[band]);
            assert!((levels[band + 1] - db + 6.02).abs() < 0.05, "a neighbour: {}", levels[band + 1]);
            let others = levels.iter().enumerate().filter(|(place, _)| place.abs_diff(band) > 1);
            assert!(others.clone().all(|(_, level)| *level < db - 60.0 || *level == FLOOR), "{band}");
        }
        assert!(levels(&[0.0; SCOPE_FRAMES]).iter().all(|level| *level == FLOOR));
    }
}
