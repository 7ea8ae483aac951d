//! A place that keeps shared data alive while the audio thread may use it, so that nothing is freed there.

use super::Kit;
use std::sync::{Arc, Mutex, PoisonError};

/// Keeps everything that the audio thread may still use: kits, unless `T` is another type.
///
/// An engine drops its reference to a kit on the audio thread, where nothing may be freed. So before a kit is sent to a
/// running engine, it is handed to a collector, which holds a reference of its own. [`Collector::collect`], called from time to
/// time on another thread, frees the kits to which only the collector still refers. Sounds need no collector, because an engine
/// holds them only as long as it holds their kit.
///
/// Clones share one collector. The owner of the engine holds a clone too and drops it after the engine, so that the collector
/// outlives the engine. No method is real-time safe, but holding a clone is.
#[derive(Debug)]
pub struct Collector<T = Kit>(Arc<Mutex<Vec<Arc<T>>>>);

impl<T> Default for Collector<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Clone for Collector<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> Collector<T> {
    /// Keeps a value while others refer to it, and frees the values to which only the collector refers. Allocates, frees
    /// and locks.
    pub fn keep(&self, handle: &Arc<T>) {
        self.collect();
        let mut handles = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !handles.iter().any(|kept| Arc::ptr_eq(kept, handle)) {
            handles.push(handle.clone());
        }
    }

    /// Frees the values to which only the collector refers. Returns the number of those that remain. Frees and locks.
    pub fn collect(&self) -> usize {
        let mut handles = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // If only the collector refers to a value, no one can make another reference, so a count of 1 cannot grow
        // meanwhile.
        handles.retain(|handle| Arc::strong_count(handle) > 1);
        handles.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    #[test]
    fn kits_stay_until_nobody_else_has_them() {
        let collector = Collector::default();
        let kits = [0, 1].map(|_| Kit::of_patch(&Patch::default()));
        kits.iter().chain(&kits).for_each(|kit| collector.keep(kit));
        assert_eq!(collector.clone().collect(), 2);
        let [first, second] = kits;
        let sound = second.sounds()[0].clone();
        drop((first, second));
        assert_eq!(Arc::strong_count(&sound), 2);
        assert_eq!(collector.collect(), 0);
        assert_eq!(Arc::strong_count(&sound), 1);
    }
}
