//! A number of a pad that is being turned: the kit is made again at intervals and at the end; all is one undo step.

use super::edit::{edited, set};
use crate::editor::body::edit::rest;
use crate::editor::controls::Controls;
use crate::editor::controls::gestures::touch;
use crate::loaded::Loaded;
use sprung::sound::Pad;
use std::sync::Arc;
use std::time::Instant;

/// Turns by the wheel that follow each other within this time are one step, in seconds.
const PAUSE: f64 = 0.7;

/// A number that is being turned.
pub(super) struct Turn {
    key: u8,
    /// The pad as it is to be, and the name of the step.
    pad: Option<Pad>,
    what: String,
    /// Whether the kit is yet to be made with it, and when that may be.
    is_new: bool,
    next: f64,
    /// When it ends if it is not held.
    end: f64,
    /// The kit that was made last. If another sound is loaded, the turn is over.
    loaded: Arc<Loaded>,
}

impl Turn {
    /// Begins to turn a number of a key's pad.
    pub(super) fn begin(key: u8, loaded: &Arc<Loaded>, controls: &mut Controls) -> Self {
        controls.release();
        controls.history.begin(controls.params);
        let (pad, what, loaded) = (None, String::new(), loaded.clone());
        Self { key, pad, what, is_new: false, next: 0.0, end: 0.0, loaded }
    }

    /// Goes on to this pad. `nudged` is when that was done, if nothing is held by which the number is turned.
    pub(super) fn to(self, pad: Pad, what: String, nudged: Option<f64>) -> Self {
        let end = nudged.map_or(f64::NEG_INFINITY, |now| now + PAUSE);
        Self { pad: Some(pad), what, is_new: true, end, ..self }
    }

    pub(super) fn key(&self) -> u8 {
        self.key
    }

    /// The pad as it is to be.
    pub(super) fn pad(&self) -> Option<&Pad> {
        self.pad.as_ref()
    }

    /// Whether this belongs to that kit.
    pub(super) fn is_of(&self, loaded: &Arc<Loaded>) -> bool {
        Arc::ptr_eq(&self.loaded, loaded)
    }

    /// Makes the kit again if it is time. The host is told at the end.
    pub(super) fn write(&mut self, now: f64, controls: &Controls) {
        if !self.is_new || now < self.next {
            return;
        }
        self.is_new = false;
        let (start, key, pad) = (Instant::now(), self.key, self.pad.clone());
        if let Some(loaded) = controls.params.change(|state| edited(state, |kit| set(kit, key, pad))) {
            self.loaded = loaded;
        }
        self.next = now + rest(start);
    }

    /// Seconds until there is something to do; none if nothing is left but to end.
    pub(super) fn rest(&self, now: f64, is_held: bool) -> Option<f64> {
        let end = if is_held { f64::INFINITY } else { self.end - now };
        let wait = if self.is_new { end.min(self.next - now) } else { end };
        (wait > 0.0).then_some(wait)
    }

    /// Makes the kit a last time and ends the step.
    pub(super) fn end(mut self, controls: &mut Controls) {
        self.write(f64::INFINITY, controls);
        controls.history.end_of(&[], self.what, controls.params);
        touch(controls.params, controls.host);
    }
}
