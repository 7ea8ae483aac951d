//! Who does the work of a block: its caller alone, or several threads.

/// Hands out pieces of work that do not depend on each other.
pub trait Workers: Sync {
    /// Calls `work` once with each item, in any order and on any threads, and returns when all is done.
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync);

    /// Whether the notes of a part are handed out too, where there is enough to do. This allocates.
    fn shares_notes(&self) -> bool;
}

/// The caller alone, in order. Real-time safe.
pub(crate) struct Alone;

impl Workers for Alone {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        items.iter_mut().for_each(work);
    }

    fn shares_notes(&self) -> bool {
        false
    }
}
