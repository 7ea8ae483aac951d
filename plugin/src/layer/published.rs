//! How the layer gets the parameters of a plugin that the wrapper makes.
//!
//! The wrapper makes the plugin object itself and shows it to nobody. But it makes it within the call that the layer makes,
//! and on that thread. So the layer leaves a place for the parameters there, and plugin objects put theirs into it. Objects
//! that are made for VST3 or for the program find no such place. The place is a plain pointer: a value with a destructor
//! would keep the library from being unloaded while the thread lives.

use crate::params::SprungParams;
use std::cell::Cell;
use std::ptr;
use std::sync::Arc;

thread_local! {
    static PLACE: Cell<*mut Option<Arc<SprungParams>>> = const { Cell::new(ptr::null_mut()) };
}

/// Publishes the parameters of a plugin object that is being made.
pub(crate) fn publish(params: &Arc<SprungParams>) {
    let place = PLACE.get();
    // SAFETY: it is null, or the variable of `published`, which has not returned yet and is on this thread.
    if let Some(place) = unsafe { place.as_mut() } {
        *place = Some(params.clone());
    }
}

/// Runs `make`, and returns what it returns with the parameters that were published meanwhile on this thread.
pub(super) fn published<T>(make: impl FnOnce() -> T) -> (T, Option<Arc<SprungParams>>) {
    /// Takes the place away again, also if `make` panics.
    struct Restore(*mut Option<Arc<SprungParams>>);
    impl Drop for Restore {
        fn drop(&mut self) {
            PLACE.set(self.0);
        }
    }
    let mut params = None;
    let made = {
        let _restore = Restore(PLACE.replace(&raw mut params));
        make()
    };
    (made, params)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_made_meanwhile_on_this_thread_is_found_and_nothing_else() {
        let (first, second) = (Arc::new(SprungParams::default()), Arc::new(SprungParams::default()));
        publish(&first);
        assert!(published(|| ()).1.is_none(), "it was made before");
        let ((), found) = published(|| {
            let other = second.clone();
            std::thread::spawn(move || publish(&other)).join().unwrap();
        });
        assert!(found.is_none(), "it was made on another thread");
        let ((), found) = published(|| {
            publish(&first);
            let ((), inner) = published(|| publish(&second));
            assert!(Arc::ptr_eq(&inner.unwrap(), &second));
        });
        assert!(Arc::ptr_eq(&found.unwrap(), &first));
        publish(&second);
        assert_eq!((Arc::strong_count(&first), Arc::strong_count(&second)), (1, 1), "nothing keeps them");
    }
}
