//! The row above the pads: the kit's name, the octaves to go to, and how many pads are seen.

use super::pads::ROWS;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{SMALL, TEXT};
use crate::editor::widgets::buttons::{Look, button, help_tab, tab};
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Rect, Role, Ui, WidgetInfo, pos2, vec2};
use sprung::units::note_name;

/// Keys of an octave, and the first key of the highest one.
const OCTAVE: u8 = 12;
const HIGHEST: u8 = 120;
/// Widths of the tabs that show other pads, of an octave, of an arrow beside these, and of the manual.
const TAB: f32 = 37.0;
const BANK: f32 = 25.0;
const ARROW: f32 = 18.0;
const HELP: f32 = 22.0;
/// Most octaves that have a tab.
const MOST: usize = 6;

/// What is shown below.
pub(super) struct View {
    pub(super) shows_keys: bool,
    /// Pads in a row.
    pub(super) row: u8,
    /// The key of the first pad.
    pub(super) first: u8,
}

/// What is to be shown.
pub(super) enum Deed {
    Manual,
    /// Pads from this key on.
    Go(u8),
    Keys,
    /// So many pads in a row: from this key on, or around the chosen pad.
    Rows(u8, Option<u8>),
}

/// Shows the row.
pub(super) fn show(ui: &Ui, rect: Rect, shown: &Shown, view: View, controls: &mut Controls) -> Option<Deed> {
    let kit = shown.kit()?;
    let palette = controls.palette;
    let help = rect.with_min_x(rect.right() - HELP);
    let tabs = rect.with_min_x(help.left() - 3.0 * (TAB + 1.0)).with_max_x(help.left());
    let mut banks = rect.with_max_x(tabs.left() - 4.0);
    let count = match kit.pads.len() {
        1 => "1 pad".to_owned(),
        count => format!("{count} pads"),
    };
    // Where there is no room for both, the header above has the name.
    let least = 3.0 * BANK + 2.0 * ARROW;
    let named = width(ui.painter(), &kit.name, TEXT + 2.0).ceil();
    let counted = width(ui.painter(), &count, SMALL).ceil();
    if banks.width() >= named + counted + 24.0 + least {
        line(ui.painter(), banks, Align2::LEFT_CENTER, &kit.name, TEXT + 2.0, palette.text);
        banks.min.x += named + 8.0;
    }
    if banks.width() >= counted + 16.0 + least {
        line(ui.painter(), banks, Align2::LEFT_CENTER, &count, SMALL, palette.muted);
        banks.min.x += counted + 16.0;
    }
    let mut deed = None;
    if !view.shows_keys {
        let pads: Vec<u8> = kit.pads.iter().map(|(key, _)| key / OCTAVE).collect();
        deed = octaves(ui, banks, &pads, view.first, controls);
    }
    for (place, (text, row)) in
        [("4 × 4", Some(ROWS[0])), ("8 × 8", Some(ROWS[1])), ("Keys", None)].into_iter().enumerate()
    {
        let at = Rect::from_min_size(tabs.min + vec2(place as f32 * (TAB + 1.0), 0.0), vec2(TAB, tabs.height()));
        let is_shown = if view.shows_keys { row.is_none() } else { row == Some(view.row) };
        if tab(ui, at, text, is_shown, palette).clicked() {
            // The many begin with the kit's first pad, the few with what is chosen.
            let first = kit.pads.first().filter(|_| row == Some(ROWS[1])).map(|(key, _)| *key);
            deed = Some(row.map_or(Deed::Keys, |row| Deed::Rows(row, first)));
        }
    }
    if help_tab(ui, help, "kits", controls) { Some(Deed::Manual) } else { deed }
}

/// Shows as many octaves as there is room for, from the lowest that has a pad on, and arrows to all others. `pads` are the octaves of
/// the kit's pads.
fn octaves(ui: &Ui, rect: Rect, pads: &[u8], first: u8, controls: &mut Controls) -> Option<Deed> {
    let palette = controls.palette;
    let count = (((rect.width() - 2.0 * ARROW) / BANK) as usize).clamp(1, MOST) as u8;
    let (now, last) = (first / OCTAVE, HIGHEST / OCTAVE);
    let lowest = pads.iter().min().copied().unwrap_or(now).min(last + 1 - count);
    // The octave that is shown is among them.
    let lowest = lowest.clamp((now + 1).saturating_sub(count), now.min(last + 1 - count));
    let whole = f32::from(count) * BANK + 2.0 * ARROW;
    let cell =
        |left: f32, width: f32| Rect::from_min_size(pos2(rect.left() + left, rect.top()), vec2(width, rect.height()));
    let mut deed = None;
    let arrows = [
        ("‹", "Pads an octave lower", 0.0, first.checked_sub(OCTAVE)),
        ("›", "Pads an octave higher", whole - ARROW, Some(first + OCTAVE).filter(|key| *key <= HIGHEST)),
    ];
    for (text, name, left, to) in arrows {
        let look = if to.is_some() { Look::Plain } else { Look::Disabled };
        if button(ui, cell(left, ARROW), text, name, look, palette).clicked() {
            deed = to.map(Deed::Go);
        }
    }
    for place in 0..count {
        let octave = lowest + place;
        let name = note_name(octave * OCTAVE);
        let response = tab(ui, cell(ARROW + f32::from(place) * BANK, BANK), &name, octave == now, palette);
        response.widget_info(|| WidgetInfo::selected(Role::Tab, true, octave == now, format!("Pads from {name}")));
        if response.hovered() {
            let filled = pads.iter().filter(|own| **own == octave).count();
            *controls.hint =
                Hint::new(format!("Pads from {name}"), format!("{filled} of the octave’s keys have a pad."));
        }
        if response.clicked() {
            deed = Some(Deed::Go(octave * OCTAVE));
        }
    }
    deed
}
