//! Where kits are kept while an engine may have them, so that none is freed on the audio thread.

use super::Kit;
use std::sync::{Arc, Mutex, PoisonError};

/// Kits that somebody may still play.
///
/// An engine lets go of a kit on the audio thread, where nothing may be freed. So whoever hands kits to a running engine
/// puts them on a shelf first, which keeps a handle of each, and now and then calls [`Shelf::collect`] away from the
/// audio thread: it frees those that nobody else has. The sounds of a kit need no shelf of their own, because an engine
/// holds them only while it holds the kit.
///
/// Clones are the same shelf. The owner of the engine keeps one too, to be dropped after the engine: so the shelf outlives
/// it. No call is real-time safe; to hold a clone is.
#[derive(Clone, Debug, Default)]
pub struct Shelf(Arc<Mutex<Vec<Arc<Kit>>>>);

impl Shelf {
    /// Keeps a kit for as long as anybody else has it, and frees others that nobody has. Allocates, frees and locks.
    pub fn keep(&self, kit: &Arc<Kit>) {
        self.collect();
        let mut kits = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !kits.iter().any(|kept| Arc::ptr_eq(kept, kit)) {
            kits.push(kit.clone());
        }
    }

    /// Frees the kits that nobody else has; gives how many are left. Frees and locks.
    pub fn collect(&self) -> usize {
        let mut kits = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // Nobody can take a handle from the last one but this shelf, so a count of one stays one.
        kits.retain(|kit| Arc::strong_count(kit) > 1);
        kits.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    #[test]
    fn kits_stay_until_nobody_else_has_them() {
        let shelf = Shelf::default();
        let kits = [0, 1].map(|_| Kit::of_patch(&Patch::default()));
        kits.iter().chain(&kits).for_each(|kit| shelf.keep(kit));
        assert_eq!(shelf.clone().collect(), 2);
        let [first, second] = kits;
        let sound = second.sounds()[0].clone();
        drop((first, second));
        assert_eq!(Arc::strong_count(&sound), 2);
        assert_eq!(shelf.collect(), 0);
        assert_eq!(Arc::strong_count(&sound), 1);
    }
}
