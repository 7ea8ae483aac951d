//! The table of modes as the user changes it.

use super::controls::Controls;
use crate::loaded::Loaded;
use sprung::patch::{Mode, ModeTable};
use sprung::preset::Playable;
use std::sync::Arc;

/// The modes as a preset file can say them: those of two joined bodies may decay faster.
pub(super) fn clamped(modes: &[Mode]) -> Vec<Mode> {
    modes.iter().map(Mode::clamped).collect()
}

/// The phase of each mode; empty if the table has none.
pub(super) fn phases(table: &ModeTable) -> Vec<f32> {
    let modes = if table.has_phases() { table.as_slice().len() } else { 0 };
    (0..modes).map(|mode| table.phase(mode)).collect()
}

/// Gives the sound another table of modes, with a phase for each or none. Returns what was loaded; nothing if it is a
/// kit.
pub(super) fn replace(modes: &[Mode], phases: &[f32], controls: &Controls) -> Option<Arc<Loaded>> {
    let mut state = controls.params.state();
    let Playable::Preset(preset) = &mut state.playable else { return None };
    preset.patch.modes = ModeTable::new(modes).with_phases(phases);
    // The knobs stay where they are.
    Some(controls.params.load(state.into()))
}
