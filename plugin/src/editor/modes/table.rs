//! The table of modes, for changes by the user.

use crate::editor::controls::Controls;
use crate::loaded::Loaded;
use sprung::patch::{Mode, ModeTable};
use sprung::preset::Playable;
use std::sync::Arc;

/// The modes within the limits of a preset file. Modes of two joined bodies may decay faster than these limits allow.
pub(super) fn clamped(modes: &[Mode]) -> Vec<Mode> {
    modes.iter().map(Mode::clamped).collect()
}

/// The phase of each mode; empty if the table has none.
pub(super) fn phases(table: &ModeTable) -> Vec<f32> {
    let modes = if table.has_phases() { table.as_slice().len() } else { 0 };
    (0..modes).map(|mode| table.phase(mode)).collect()
}

/// Replaces the sound's table of modes; the knobs stay where they are. Returns the loaded sound; nothing for a kit.
pub(crate) fn replace(table: ModeTable, controls: &Controls) -> Option<Arc<Loaded>> {
    controls.params.change(|mut state| {
        let Playable::Preset(preset) = &mut state.playable else { return None };
        preset.patch.modes = table;
        Some(state)
    })
}
