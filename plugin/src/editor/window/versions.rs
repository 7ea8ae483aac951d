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

/// The state without what is only said of the sound, beside its name.
fn undescribed(mut state: State) -> State {
    state.playable.describe(String::new(), Vec::new(), Default::default());
    state
}

impl Versions {
    /// Whether the two differ in what is heard, or in name.
    pub(super) fn differ(&mut self, params: &SprungParams) -> bool {
        let Some((other, _)) = &self.other else { return false };
        let (loaded, name) = (params.loaded(), params.name());
        let positions: Vec<u32> = params.knobs().iter().map(|knob| knob.position().to_bits()).collect();
        let is_known = |(known, of, at): &Shown| Arc::ptr_eq(known, &loaded) && *of == name && *at == positions;
        if let Some((_, differ)) = self.compared.as_ref().filter(|(shown, _)| is_known(shown)) {
            return *differ;
        }
        let differ = !same_sound(&undescribed(other.clone()), &undescribed(params.state()));
        self.compared = Some(((loaded, name, positions), differ));
        differ
    }

    /// Lets go of what was only compared.
    pub(super) fn rest(&mut self) {
        self.compared = None;
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

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::preset::{Playable, Preset};

    #[test]
    fn versions_do_not_differ_in_what_is_said_of_them() {
        let (params, mut versions) = (SprungParams::default(), Versions::default());
        versions.copy((params.state(), false));
        assert!(!versions.differ(&params));
        let described =
            Preset { comment: "Another".to_owned(), author: "Me".to_owned(), ..Preset::find("Init").unwrap().clone() };
        params.describe_as(&Playable::Preset(described));
        let knob = &params.knobs()[Param::Decay as usize];
        let before = knob.position();
        knob.turn(0.9);
        assert!(versions.differ(&params));
        knob.turn(before);
        assert!(!versions.differ(&params));
        params.rename("Other".to_owned());
        assert!(versions.differ(&params));
    }
}
