//! Loads sounds for the window.

use super::gestures;
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::Playable;

/// Loads a preset or kit, and tells the host the new knob positions. While the sound of a kit's pad is edited, a preset takes its place,
/// and can be put back on the pad.
pub(crate) fn load(playable: Playable, params: &SprungParams, host: &GuiContext) {
    gestures::load(params.suited(in_place(playable, params)), params, host);
}

/// As [`load`], for a sound that is made from the present one.
pub(crate) fn remake(playable: Playable, params: &SprungParams, host: &GuiContext) {
    gestures::load(in_place(playable, params), params, host);
}

/// The state with a preset or kit in place of the present one.
fn in_place(playable: Playable, params: &SprungParams) -> State {
    let State { seed, view, pad, .. } = params.state();
    let pad = pad.filter(|_| matches!(playable, Playable::Preset(_)));
    State { pad, ..State::new(playable, seed, view) }
}
