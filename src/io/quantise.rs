//! Converts samples to integers, for files and devices.

/// Converts a sample to an integer of `bits` bits (1–32); 1.0 is full scale. `noise`, in steps, is added before
/// rounding to the nearest step. Clips beyond full scale; NaN becomes 0. Real-time safe.
pub(crate) fn quantise(sample: f32, bits: u16, noise: f64) -> i32 {
    // Adding and subtracting this number rounds to the nearest whole number, without a call.
    const WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;
    let full_scale = f64::from(1u32 << (bits - 1));
    let steps = (f64::from(sample) * full_scale + noise).clamp(-full_scale, full_scale - 1.0);
    // The conversion `as` turns NaN into 0.
    ((steps + WHOLE) - WHOLE) as i32
}
