//! Loads sounds for the window.

use super::gestures;
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::Playable;

/// Loads a preset or kit, and tells the host the new knob positions.
pub(crate) fn load(playable: Playable, params: &SprungParams, host: &GuiContext) {
    let State { seed, view, .. } = params.state();
    gestures::load(State::new(playable, seed, view), params, host);
}

/// Like [`load`], for the present sound with changes: if it is that of a kit's pad, it stays so.
pub(crate) fn load_changed(playable: Playable, params: &SprungParams, host: &GuiContext) {
    let State { seed, view, pad, .. } = params.state();
    gestures::load(State { pad, ..State::new(playable, seed, view) }, params, host);
}
