//! The face of a kit: its pads, the sounds that can be put on them, and the chosen pad; of a preset, its keys.

mod detail;
pub(super) mod edit;
mod keys;
mod pads;
mod sounds;

use crate::editor::browser::Browser;
use crate::editor::controls::files::remake;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::keyboard::grid::KeyGrid;
use crate::editor::theme::{GAP, PADDING, TEXT};
use crate::editor::widgets::buttons::{Look, button, help_tab, tab};
use crate::editor::widgets::text::line;
use crate::link::Link;
use crate::loaded::Loaded;
use detail::Detail;
use edit::{SECOND, change, copy, name_of, put, set, swap, take};
use egui::{Align2, Rect, Ui, pos2, vec2};
use pads::{Carried, Deed, Pads, ROWS};
use sounds::SoundList;
use sprung::preset::{Playable, Preset};
use sprung::units::note_name;
use sprung_picture::{Figure, small_figure};
use std::sync::Arc;

/// What the user asks for.
pub(super) enum Request {
    Manual,
    /// To change the sound of the chosen pad.
    Edit,
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
    figures: Figures,
}

/// The figures of the kit's sounds, made anew only when these change.
#[derive(Default)]
struct Figures {
    loaded: Option<Arc<Loaded>>,
    sounds: Vec<(String, Preset)>,
    figures: Vec<Figure>,
}

impl Figures {
    fn of(&mut self, shown: &Shown) -> &[Figure] {
        let sounds = shown.kit().map_or(&[][..], |kit| &kit.sounds);
        let is_known = self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, shown.loaded()));
        if !is_known && self.sounds != sounds {
            let of =
                |(_, preset): &(String, Preset)| small_figure(&preset.patch.modes, preset.guide.family, &preset.tags);
            (self.sounds, self.figures) = (sounds.to_vec(), sounds.iter().map(of).collect());
        }
        self.loaded = Some(shown.loaded().clone());
        &self.figures
    }
}

impl KitPage {
    /// Ends the user's action, and releases the held keys.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.detail.leave(controls);
        self.sounds.leave();
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

    /// Shows the face; `down` has one bit for each held key.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &mut Shown,
        (down, browser): (u128, &mut Browser),
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
            palette.paint_panel(ui.painter(), panel);
        }
        let inner = middle.shrink(PADDING);
        let (head, below) = inner.split_top_bottom_at_y(inner.top() + HEAD);
        let request = self.head(ui, head, shown, controls);
        let clicked = self.sounds.show(ui, list.shrink(PADDING), browser.sounds(), controls);
        let key = self.pads.chosen();
        let figures = self.figures.of(shown);
        // Before the pads, which choose another: what is typed for this one is taken first.
        let mut deed = self.detail.show(ui, detail.shrink(PADDING), key, (shown, figures), controls);
        if self.shows_keys {
            if let Some(key) = keys::show(ui, below, &mut self.keys, shown, (down, Some(key)), controls) {
                self.pads.choose(key);
            }
        } else {
            deed = self.pads.show(ui, below.expand(2.0), (shown, figures, down), controls).or(deed);
        }
        shown.follow(self.pads.chosen());
        let put_here = clicked.map(|sound| Deed::Drop(Arc::new(Carried::Sound(sound)), key));
        let deed = put_here.or(deed);
        let edits = matches!(deed, Some(Deed::Edit(_)));
        if let Some(deed) = deed {
            self.detail.leave(controls);
            self.carry_out(ui, deed, shown, controls);
        }
        self.audition.request_end(ui);
        if edits { Some(Request::Edit) } else { request }
    }

    /// Shows which pads are seen, and buttons to see others.
    fn head(&mut self, ui: &Ui, rect: Rect, shown: &Shown, controls: &mut Controls) -> Option<Request> {
        let palette = controls.palette;
        let rect = rect.with_max_y(rect.bottom() - 4.0);
        let cell = |left: f32, width: f32| Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()));
        // The keys are all of them.
        let [lowest, highest] = if self.shows_keys { [0, 127] } else { self.pads.keys() };
        let look = if self.shows_keys { Look::Disabled } else { Look::Plain };
        for (place, (text, name, octaves)) in
            [("‹", "Pads an octave lower", -1), ("›", "Pads an octave higher", 1)].into_iter().enumerate()
        {
            let at = cell(rect.left() + 112.0 * place as f32, 24.0);
            if button(ui, at, text, name, look, palette).clicked() {
                self.pads.go(octaves);
            }
        }
        let range = format!("{} to {}", note_name(lowest), note_name(highest));
        line(ui.painter(), cell(rect.left() + 26.0, 84.0), Align2::CENTER_CENTER, &range, TEXT, palette.muted);
        let help = cell(rect.right() - 22.0, 22.0);
        let [few, many] = ROWS;
        for (place, (text, row)) in
            [("Keys", None), ("8 × 8", Some(many)), ("4 × 4", Some(few))].into_iter().enumerate()
        {
            let at = cell(help.left() - 38.0 * (place + 1) as f32, 37.0);
            let is_shown = if self.shows_keys { row.is_none() } else { row == Some(self.pads.row()) };
            if tab(ui, at, text, is_shown, palette).clicked() {
                self.release(controls.params.link());
                self.shows_keys = row.is_none();
                if let Some(row) = row {
                    // The many begin with the kit's first pad, the few with what is chosen.
                    let chosen = self.pads.chosen();
                    let first = shown.kit().and_then(|kit| kit.pads.first()).map_or(chosen, |(key, _)| *key);
                    self.pads.show_rows(row, if row == many { first } else { chosen });
                }
            }
        }
        help_tab(ui, help, "kits", controls).then_some(Request::Manual)
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
        palette.paint_panel(ui.painter(), rect);
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
