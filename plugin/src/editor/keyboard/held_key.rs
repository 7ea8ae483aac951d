//! The key that the mouse holds, on the keyboard or on a page's grid.

use crate::link::{Link, Touch};

/// The key that the mouse holds.
#[derive(Default)]
pub(crate) struct HeldKey(Option<u8>);

impl HeldKey {
    pub(crate) fn key(&self) -> Option<u8> {
        self.0
    }

    /// Plays the touched key with this velocity, and releases the previous one.
    pub(crate) fn follow(&mut self, touched: Option<(u8, f32)>, link: &Link) {
        if touched.map(|(key, _)| key) == self.0 {
            return;
        }
        self.release(link);
        if let Some((key, velocity)) = touched {
            self.0 = Some(key);
            link.play(Touch::Down { key, velocity });
        }
    }

    /// Releases the key.
    pub(crate) fn release(&mut self, link: &Link) {
        if let Some(key) = self.0.take() {
            link.play(Touch::Up { key });
        }
    }
}
