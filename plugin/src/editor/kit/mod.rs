//! The face of a kit: its pads, the sounds that can be put on them, and the chosen pad; of a preset, its keys.

mod chips;
mod detail;
pub(super) mod edit;
mod head;
mod keys;
mod live;
mod mates;
mod pads;
mod sounds;
mod turn;

use crate::editor::browser::Browser;
use crate::editor::controls::files::remake;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::keyboard::grid::KeyGrid;
use crate::editor::theme::{GAP, PADDING, TEXT, paint_panel};
use crate::editor::widgets::buttons::{Look, button, help_tab};
use crate::editor::widgets::text::line;
use crate::link::Link;
use detail::Detail;
use edit::{SECOND, change, copy, name_of, put, set, swap, take};
use egui::{Align2, Rect, Ui, pos2, vec2};
use live::{About, Bodies, Live};
use pads::{Carried, Deed, Pads};
use sounds::SoundList;
use sprung::preset::Playable;
use sprung::units::note_name;
use std::sync::Arc;

/// What the user asks for.
pub(super) enum Request {
    Manual,
    /// To change the sound of the chosen pad.
    Edit,
    /// To see the effects behind all pads.
    Effects,
}

/// Shares of the width that sounds and the chosen pad have, and their least and greatest widths.
const SIDES: [(f32, [f32; 2]); 2] = [(0.17, [130.0, 190.0]), (0.28, [180.0, 300.0])];
/// Height of the row above the pads.
const HEAD: f32 = 24.0;

/// The state of the face.
#[derive(Default)]
pub(super) struct KitPage {
    pads: Pads,
    sounds: SoundList,
    detail: Detail,
    keys: KeyGrid,
    shows_keys: bool,
    audition: Audition,
    /// The name of the kit; empty for a preset.
    name: String,
    /// Whether a kit of the present sound was made, which is shown with the next pass.
    is_made: bool,
    bodies: Bodies,
    live: Live,
}

impl KitPage {
    /// Ends the user's action, and releases the held keys.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.detail.leave(controls);
        self.sounds.leave();
        self.pads.swap_next(false);
        self.release(controls.params.link());
    }

    /// Chooses the pad of a key.
    pub(super) fn choose(&mut self, key: u8) {
        self.pads.choose(key);
    }

    /// Releases the held keys.
    pub(super) fn release(&mut self, link: &Link) {
        self.pads.release(link);
        self.keys.release(link);
        self.audition.release(link);
    }

    /// Shows the face; `down` has one bit for each held key, and the energies are those of the newest note's modes.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &mut Shown,
        (down, energies, browser): (u128, &[f32], &mut Browser),
        controls: &mut Controls,
    ) -> Option<Request> {
        let palette = controls.palette;
        self.audition.follow_time(ui.input(|input| input.time), controls.params.link());
        let name = shown.kit().map_or(String::new(), |kit| kit.name.clone());
        if self.name != name {
            self.leave(controls);
            self.name = name;
            let keys = || shown.kit().into_iter().flat_map(|kit| kit.pads.iter().map(|(key, _)| *key));
            if std::mem::take(&mut self.is_made) {
                // A click on another sound puts that beside the first, and not in its place.
                self.pads.choose(SECOND);
            } else if let Some(first) = keys().next().filter(|_| keys().all(|key| key != self.pads.chosen())) {
                self.pads.choose(first);
            }
        }
        if shown.kit().is_none() {
            return self.show_preset(ui, rect, shown, down, controls);
        }
        let [left, right] = SIDES.map(|(share, [least, most])| (share * rect.width()).clamp(least, most));
        let list = rect.with_max_x(rect.left() + left);
        let detail = rect.with_min_x(rect.right() - right);
        let middle = Rect::from_min_max(pos2(list.right() + GAP, rect.top()), pos2(detail.left() - GAP, rect.bottom()));
        for panel in [list, detail, middle] {
            paint_panel(ui.painter(), panel, palette);
        }
        let inner = middle.shrink(PADDING);
        let (head, below) = inner.split_top_bottom_at_y(inner.top() + HEAD);
        let request = self.head(ui, head, shown, controls);
        self.bodies.follow(shown);
        self.live.follow(&self.bodies, shown, energies, controls);
        let clicked = self.sounds.show(ui, list.shrink(PADDING), browser.sounds(), controls);
        let key = self.pads.chosen();
        let is_swapping = self.pads.is_swapping();
        let about = About { shown, bodies: &self.bodies, live: &self.live, key, is_swapping };
        // Before the pads, which choose another: what is typed for this one is taken first.
        let mut deed = self.detail.show(ui, detail.shrink(PADDING), &about, controls);
        if self.shows_keys {
            if let Some(key) = keys::show(ui, below, &mut self.keys, shown, (down, Some(key)), controls) {
                self.pads.choose(key);
            }
        } else {
            deed = self.pads.show(ui, below.expand(2.0), (&about, down), controls).or(deed);
        }
        shown.follow(self.pads.chosen());
        let put_here = clicked.map(|sound| Deed::Drop(Arc::new(Carried::Sound(sound)), key));
        let deed = put_here.or(deed);
        let asked = match deed {
            Some(Deed::Edit(_)) => Some(Request::Edit),
            Some(Deed::Effects) => Some(Request::Effects),
            _ => request,
        };
        if let Some(deed) = deed {
            self.detail.leave(controls);
            self.carry_out(ui, deed, shown, controls);
        }
        self.audition.request_end(ui);
        asked
    }

    /// Shows the row above the pads.
    fn head(&mut self, ui: &Ui, rect: Rect, shown: &Shown, controls: &mut Controls) -> Option<Request> {
        let rect = rect.with_max_y(rect.bottom() - 4.0);
        let view = head::View { shows_keys: self.shows_keys, row: self.pads.row(), first: self.pads.keys()[0] };
        match head::show(ui, rect, shown, view, controls)? {
            head::Deed::Manual => return Some(Request::Manual),
            head::Deed::Go(first) => self.pads.show_from(first),
            head::Deed::Keys => {
                self.release(controls.params.link());
                self.pads.swap_next(false);
                self.shows_keys = true;
            }
            head::Deed::Rows(row, first) => {
                self.release(controls.params.link());
                self.shows_keys = false;
                self.pads.show_rows(row, first.unwrap_or(self.pads.chosen()));
            }
        }
        None
    }

    fn carry_out(&mut self, ui: &Ui, deed: Deed, shown: &Shown, controls: &mut Controls) {
        match deed {
            Deed::Drop(carried, key) => match &*carried {
                Carried::Sound(sound) => {
                    let Playable::Preset(preset) = &sound.playable else { return };
                    change(format!("{} on {}", preset.name, name_of(key)), controls, |kit| put(kit, key, preset));
                    self.pads.choose(key);
                    self.audition.strike(key, VELOCITY, ui.input(|input| input.time), controls.params.link());
                }
                Carried::Pad(from, loaded) if *from != key && Arc::ptr_eq(loaded, shown.loaded()) => {
                    let (way, what) = ([*from, key], format!("{} to {}", name_of(*from), note_name(key)));
                    match ui.input(|input| input.modifiers.command) {
                        true => change(format!("copy {what}"), controls, |kit| copy(kit, way)),
                        false => change(what, controls, |kit| swap(kit, way)),
                    }
                    self.pads.choose(key);
                }
                Carried::Pad(..) => {}
            },
            // A kit without pads would be none.
            Deed::Empty(key) if shown.kit().is_some_and(|kit| kit.pads.len() > 1) => {
                change(format!("{} emptied", name_of(key)), controls, |kit| set(kit, key, None));
            }
            Deed::Empty(_) => {}
            Deed::Edit(key) => take(key, controls),
            Deed::Choose(key) => self.pads.choose(key),
            Deed::Strike(key) => {
                self.audition.strike(key, VELOCITY, ui.input(|input| input.time), controls.params.link());
            }
            Deed::Swapping => {
                // In the list of all keys, none can be clicked to be swapped.
                self.shows_keys = false;
                self.pads.swap_next(!self.pads.is_swapping());
            }
            Deed::Swap(ways) => {
                let pad = |key: u8| shown.loaded().kit.pad(key);
                let [from, to] = ways.map(|key| pad(key).map_or_else(|| name_of(key), |pad| shown.pad_name(pad)));
                change(format!("swapped {from} and {to}"), controls, |kit| swap(kit, ways));
                self.pads.choose(ways[1]);
            }
            Deed::Effects => {}
        }
    }

    /// Shows all keys of a preset, and a button that makes a kit of it.
    fn show_preset(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &Shown,
        down: u128,
        controls: &mut Controls,
    ) -> Option<Request> {
        let palette = controls.palette;
        paint_panel(ui.painter(), rect, palette);
        let (head, below) = rect.shrink(PADDING).split_top_bottom_at_y(rect.top() + PADDING + HEAD);
        let make = Rect::from_min_size(head.min, vec2(96.0, HEAD - 4.0));
        let response = button(ui, make, "Make a kit", "Make a kit of this sound", Look::Main, palette);
        if response.hovered() {
            *controls.hint =
                Hint::new("Make a kit", "Puts this sound on a pad, and other sounds can be put beside it.");
        }
        if response.clicked()
            && let Playable::Preset(preset) = controls.params.state().playable
        {
            self.release(controls.params.link());
            controls.history.begin(controls.params);
            remake(Playable::Kit(edit::kit_of(preset)), controls.params, controls.host);
            controls.history.end("a kit of this sound", controls.params);
            self.is_made = true;
            return None;
        }
        let help = Rect::from_min_size(pos2(head.right() - 22.0, head.top()), vec2(22.0, HEAD - 4.0));
        let says = Rect::from_min_max(make.right_top() + vec2(10.0, 0.0), pos2(help.left(), make.bottom()));
        let text = match controls.params.pad() {
            Some(pad) => format!("You edit {}. Put back, above, ends that and shows the kit.", pad.name()),
            None => format!("All keys play {}: those that suit it are bright.", controls.params.name()),
        };
        line(ui.painter(), says, Align2::LEFT_CENTER, &text, TEXT, palette.muted);
        keys::show(ui, below, &mut self.keys, shown, (down, None), controls);
        help_tab(ui, help, "kits", controls).then_some(Request::Manual)
    }
}
