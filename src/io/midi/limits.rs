//! How large a song can be.

/// Maximum number of events in a song. Each takes 32 bytes of memory.
pub(super) const MAX_EVENTS: usize = 8_000_000;
