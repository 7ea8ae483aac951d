//! A float that threads share.

use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// A float that threads share, stored as its bits.
#[derive(Default)]
pub(super) struct AtomicF32(AtomicU32);

impl AtomicF32 {
    pub(super) fn load(&self) -> f32 {
        f32::from_bits(self.0.load(Relaxed))
    }

    pub(super) fn store(&self, value: f32) {
        self.0.store(value.to_bits(), Relaxed);
    }

    /// Stores the greater of the two values. Both must be at least 0: then their bits have the same order as the
    /// values.
    pub(super) fn raise_to(&self, value: f32) {
        self.0.fetch_max(value.to_bits(), Relaxed);
    }

    /// Returns the value and resets it to 0.
    pub(super) fn take(&self) -> f32 {
        f32::from_bits(self.0.swap(0, Relaxed))
    }
}
