//! Samples as whole steps, for files and for devices alike.

/// The step nearest to `sample`, 1.0 being full scale, of integers with so many bits (1–32); what lies beyond full scale
/// becomes the last step, and NaN becomes 0. `noise`, in steps, is added before rounding. Real-time safe.
pub fn quantise(sample: f32, bits: u16, noise: f64) -> i32 {
    let full_scale = f64::from(1u32 << (bits - 1));
    // The conversion makes 0 of NaN.
    (f64::from(sample) * full_scale + noise).round_ties_even().clamp(-full_scale, full_scale - 1.0) as i32
}
