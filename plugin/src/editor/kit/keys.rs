//! All keys of a sound or kit, with the sound and the choke group of each.

use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::grid::{Cell, KeyGrid};
use egui::{Rect, Ui};
use sprung::params::Param;
use sprung::sound::Pad;
use sprung::units::note_name;

/// Shows the keys of a sound or kit; `down` has one bit for each held key. Returns the key that was clicked.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    grid: &mut KeyGrid,
    shown: &Shown,
    (down, chosen): (u128, Option<u8>),
    controls: &mut Controls,
) -> Option<u8> {
    let kit = &shown.loaded().kit;
    let group = controls.value(Param::Choke.info());
    let choke = |pad: &Pad| kit.choke(pad, group);
    let marked = grid.hovered().and_then(|key| kit.pad(key)).map(choke).filter(|group| *group > 0);
    let guide = shown.guide();
    let cell = |key: u8| {
        let is_chosen = chosen == Some(key);
        let Some(pad) = kit.pad(key) else { return Cell { is_chosen, ..Cell::default() } };
        let is_kit = shown.preset().is_none();
        let group = choke(pad);
        Cell {
            text: if is_kit { shown.pad_name(pad) } else { String::new() },
            is_on: is_kit || (guide.lowest..=guide.highest).contains(&key),
            group,
            is_marked: marked == Some(group),
            is_chosen,
        }
    };
    let clicked = grid.show(ui, rect, "Pad", down, &cell, controls);
    if let Some(key) = grid.hovered() {
        *controls.hint = Hint::new(note_name(key), about(key, shown, group));
    }
    clicked
}

/// A pad in words. `group` is the value of the parameter of choke groups.
pub(super) fn about(key: u8, shown: &Shown, group: f32) -> String {
    let kit = &shown.loaded().kit;
    let Some(pad) = kit.pad(key) else { return "silent".to_owned() };
    let pitch =
        pad.pitch.map_or(String::new(), |pitch| format!("   at {}", note_name(pitch.round().clamp(0.0, 127.0) as u8)));
    let gain = if pad.gain_db == 0.0 { String::new() } else { format!("   {:+.1} dB", pad.gain_db) };
    let group = match kit.choke(pad, group) {
        0 => String::new(),
        group => format!("   choke group {group}: the outlined keys silence each other"),
    };
    format!("{}{pitch}{gain}{group}", shown.pad_name(pad))
}
