//! A key that the window plays by itself, so that the user hears a change or a chosen sound.

use crate::link::{Link, Touch};
use egui::Ui;
use std::time::Duration;

/// How long a key is held when a sound is tried, in seconds.
const HELD: f64 = 0.7;
/// Time between two strikes while a sound is being changed, in seconds.
const STRIKES: f64 = 0.25;
/// The velocity of these strikes.
pub(crate) const VELOCITY: f32 = 0.7;

/// The key that is held, if there is one.
#[derive(Default)]
pub(crate) struct Audition {
    key: Option<u8>,
    /// When the key is released, and when it was last struck.
    end: f64,
    struck: f64,
}

impl Audition {
    /// Strikes a key, and holds it for a while.
    pub(crate) fn strike(&mut self, key: u8, velocity: f32, now: f64, link: &Link) {
        self.hold(key, Touch::Down { key, velocity }, now, link);
    }

    /// Holds a key for a while whose note is not struck: only one mode is pushed, with an amplitude from 0 to 1.
    pub(crate) fn wake(&mut self, key: u8, (mode, amplitude): (u16, f32), now: f64, link: &Link) {
        self.hold(key, Touch::Wake { key, mode, amplitude }, now, link);
    }

    /// Holds a key for a while that `touch` presses.
    fn hold(&mut self, key: u8, touch: Touch, now: f64, link: &Link) {
        self.release(link);
        link.play(touch);
        (self.key, self.end, self.struck) = (Some(key), now + HELD, now);
    }

    /// Strikes a key at regular intervals as long as the user drags something. To be called in each pass.
    pub(crate) fn repeat(&mut self, key: u8, now: f64, link: &Link) {
        if self.key != Some(key) || !(self.struck..self.struck + STRIKES).contains(&now) {
            self.strike(key, VELOCITY, now, link);
        }
    }

    /// Releases the key when its time is over.
    pub(crate) fn follow_time(&mut self, now: f64, link: &Link) {
        if now >= self.end {
            self.release(link);
        }
    }

    /// Releases the key at once.
    pub(crate) fn release(&mut self, link: &Link) {
        if let Some(key) = self.key.take() {
            link.play(Touch::Up { key });
        }
    }

    /// Asks for a pass at the time at which the key is to be released.
    pub(crate) fn request_end(&self, ui: &Ui) {
        if let Some(rest) = self.rest(ui.input(|input| input.time)) {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(rest));
        }
    }

    /// Seconds until the key is released; none if no key is held.
    fn rest(&self, now: f64) -> Option<f64> {
        self.key.map(|_| (self.end - now).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_held_for_a_while_and_struck_again_while_something_is_dragged() {
        let link = Link::default();
        let mut touches = link.connect(48_000.0);
        let mut heard = || std::iter::from_fn(|| touches.pop().ok()).collect::<Vec<_>>();
        let mut audition = Audition::default();
        audition.strike(60, 0.5, 1.0, &link);
        audition.follow_time(1.6, &link);
        assert_eq!(heard(), [Touch::Down { key: 60, velocity: 0.5 }]);
        assert!(audition.rest(1.6).is_some_and(|rest| (rest - 0.1).abs() < 1e-9));
        audition.follow_time(1.8, &link);
        assert_eq!((heard(), audition.rest(1.8)), (vec![Touch::Up { key: 60 }], None));
        (0..=60).for_each(|pass| audition.repeat(62, 2.0 + f64::from(pass) / 60.0, &link));
        let strikes = heard();
        let downs = strikes.iter().filter(|touch| matches!(touch, Touch::Down { .. })).count();
        assert!((4..=5).contains(&downs), "{strikes:?}");
        audition.release(&link);
        assert_eq!(heard(), [Touch::Up { key: 62 }]);
    }
}
