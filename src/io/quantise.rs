//! Converts samples to integers, for files and devices.

/// Converts a sample to an integer of `bits` bits (1–32); 1.0 is full scale. `noise`, in steps, is added before
/// rounding to the nearest step. Clips beyond full scale; NaN becomes 0. Real-time safe.
pub(crate) fn quantise(sample: f32, bits: u16, noise: f64) -> i32 {
    let full_scale = f64::from(1u32 << (bits - 1));
    // The conversion `as` turns NaN into 0.
    (f64::from(sample) * full_scale + noise).round_ties_even().clamp(-full_scale, full_scale - 1.0) as i32
}
