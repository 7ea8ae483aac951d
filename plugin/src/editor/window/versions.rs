//! The two versions of the sound: the one that is not shown, and whether it differs from the one that is.

use crate::editor::controls::history::{History, restore, same_sound};
use crate::loaded::Loaded;
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use std::sync::Arc;

/// The two versions.
#[derive(Default)]
pub(super) struct Versions {
    /// The other one, and whether it is changed ([`History::is_changed`]). Until there is one, it is like the one that is shown.
    other: Option<(State, bool)>,
    pub(super) is_b: bool,
    /// Whether they differ, for what was shown when they were compared.
    compared: Option<(Shown, bool)>,
}

/// What tells whether another sound is shown, without a copy of it: what was loaded, its name, and the positions of the knobs.
type Shown = (Arc<Loaded>, String, Vec<u32>);

impl Versions {
    /// Whether the two differ.
    pub(super) fn differ(&mut self, params: &SprungParams) -> bool {
        let Some((other, _)) = &self.other else { return false };
        let (loaded, name) = (params.loaded(), params.name());
        let positions: Vec<u32> = params.knobs().iter().map(|knob| knob.position().to_bits()).collect();
        let is_known = |(known, of, at): &Shown| Arc::ptr_eq(known, &loaded) && *of == name && *at == positions;
        if let Some((_, differ)) = self.compared.as_ref().filter(|(shown, _)| is_known(shown)) {
            return *differ;
        }
        let differ = !same_sound(other, &params.state());
        self.compared = Some(((loaded, name, positions), differ));
        differ
    }

    /// Makes the other one a copy of a version.
    pub(super) fn copy(&mut self, version: (State, bool)) {
        (self.other, self.compared) = (Some(version), None);
    }

    /// Notes that the other one is shown now, after this one was.
    pub(super) fn have_swapped(&mut self, before: (State, bool)) {
        self.copy(before);
        self.is_b = !self.is_b;
    }

    /// Shows the other one, as a step that can be undone.
    pub(super) fn swap(&mut self, history: &mut History, params: &SprungParams, host: &GuiContext) {
        history.begin(params);
        let now = (params.state(), history.is_changed());
        let mut is_changed = now.1;
        if let Some((other, other_is_changed)) = self.other.take() {
            restore(other, params, host);
            is_changed = other_is_changed;
        }
        self.have_swapped(now);
        history.end_swap(if self.is_b { "version B" } else { "version A" }, is_changed, params);
    }
}
