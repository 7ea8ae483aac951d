//! A change of a body in progress: the sound is made again at intervals while a number is dragged; all is one undo step.

use crate::editor::controls::Controls;
use crate::editor::controls::gestures::{Gestures, touch};
use crate::loaded::Loaded;
use sprung::params::Param;
use sprung::preset::Playable;
use sprung_picture::Origin;
use std::sync::Arc;
use std::time::Instant;

/// The shortest time between two changes of the sound, in seconds: some sounds take long to compute.
const CHANGES: f64 = 0.06;

/// A change of a body in progress.
pub(crate) struct BodyEdit {
    origin: Origin,
    /// The last body whose sound could be made, and the description of the change up to then.
    good: (Origin, String),
    is_new: bool,
    /// The description of the change, for the name of the undo step.
    what: String,
    /// The parameter *Decay* as a multiple of the body's T60, and its position before the change.
    decay: f64,
    position: f32,
    /// When the sound may be changed again.
    next: f64,
    /// The sound that was made last. If another sound is loaded, the change is over.
    loaded: Arc<Loaded>,
}

impl BodyEdit {
    /// Makes the sound from another body, as one step that can be undone. The error says why it cannot be made.
    pub(crate) fn make(
        before: &Origin,
        after: Origin,
        what: String,
        loaded: &Arc<Loaded>,
        controls: &mut Controls,
    ) -> Result<(), String> {
        let mut edit = Self::begin(before, loaded, controls);
        edit.change(after, what);
        edit.end(controls)
    }

    /// Begins to change the body from which the modes of `loaded` are made.
    pub(super) fn begin(origin: &Origin, loaded: &Arc<Loaded>, controls: &mut Controls) -> Self {
        controls.release();
        controls.history.begin(controls.params);
        let decay = f64::from(controls.value(Param::Decay.info()));
        Self {
            origin: origin.clone(),
            good: (origin.clone(), String::new()),
            is_new: false,
            what: String::new(),
            decay: origin.t60().map_or(1.0, |t60| decay / t60),
            position: controls.position(Param::Decay.info()),
            next: 0.0,
            loaded: loaded.clone(),
        }
    }

    /// Whether this change belongs to this sound.
    pub(super) fn is_of(&self, loaded: &Arc<Loaded>) -> bool {
        Arc::ptr_eq(&self.loaded, loaded)
    }

    pub(super) fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Sets the body from which the sound is made next.
    pub(super) fn change(&mut self, origin: Origin, what: String) {
        (self.origin, self.what, self.is_new) = (origin, what, true);
    }

    /// Makes the sound again if it is time. The error says why it cannot be made; the last body that worked is kept.
    pub(super) fn write(&mut self, now: f64, controls: &mut Controls) -> Result<(), String> {
        if !self.is_new || now < self.next {
            return Ok(());
        }
        self.is_new = false;
        let start = Instant::now();
        let modes = match self.origin.modes() {
            Ok(Some(modes)) => modes,
            Ok(None) => return Ok(()),
            Err(message) => {
                (self.origin, self.what) = self.good.clone();
                self.next = now + rest(start);
                return Err(message);
            }
        };
        self.good = (self.origin.clone(), self.what.clone());
        // The modes' decays are relative to the parameter *Decay*.
        let decay = Param::Decay.info();
        let value = decay.clamp((self.decay * self.origin.t60().unwrap_or(1.0)) as f32);
        let loaded = controls.params.change(|mut state| {
            let Playable::Preset(preset) = &mut state.playable else { return None };
            preset.patch.modes = modes;
            if value != state.values.get(Param::Decay) {
                preset.patch.set(Param::Decay, value);
                state.values.set(Param::Decay, value);
                state.positions[Param::Decay as usize] = decay.normalise(value) as f32;
            }
            Some(state)
        });
        let Some(loaded) = loaded else { return Ok(()) };
        (self.loaded, self.next) = (loaded, now + rest(start));
        Ok(())
    }

    /// Whether the sound is yet to be made from the body that was set last.
    pub(super) fn is_due(&self) -> bool {
        self.is_new
    }

    /// Makes the sound a last time and ends the undo step. The error is that of [`BodyEdit::write`].
    pub(super) fn end(mut self, controls: &mut Controls) -> Result<(), String> {
        let result = self.write(f64::INFINITY, controls);
        controls.history.end_of(&[Param::Decay as usize], self.what, controls.params);
        let position = controls.position(Param::Decay.info());
        if position.to_bits() == self.position.to_bits() {
            touch(controls.params, controls.host);
        } else {
            Gestures::default().set(controls.params, controls.host, Param::Decay as usize, position);
        }
        result
    }
}

/// How long to wait after work that began at `start`, in seconds: most of the time is left for the window.
pub(in crate::editor) fn rest(start: Instant) -> f64 {
    CHANGES.max(4.0 * start.elapsed().as_secs_f64())
}
