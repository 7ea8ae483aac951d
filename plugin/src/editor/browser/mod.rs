//! The browser: finds sounds, plays them, keeps favourites, and saves sounds under a name.

mod details;
mod fields;
mod finding;
mod keys;
mod likeness;
mod list;
mod portrait;
pub(super) mod sounds;
mod tags;
mod trying;

use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint, Pick, Said};
use crate::editor::keyboard::audition::Audition;
use crate::editor::theme::{GAP, PADDING, paint_panel};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::progress::{Face, PAUSE, paint};
use crate::files::read;
use crate::link::Link;
use details::{Details, Outcome};
use egui::{Rect, Stroke, Ui, pos2};
use fields::search_field;
use finding::{Finding, Found};
use keys::Command;
use list::{List, row, seen, shelves};
use portrait::Portrait;
use sounds::{Category, Sounds};
use sprung::internals::library::Library;
use sprung::preset::Playable;
use std::collections::BTreeSet;

/// Width of the list of categories, and of the details of a sound.
const SIDE: [f32; 2] = [112.0, 250.0];

/// What the keys do here.
pub(super) const KEYS: &str =
    "Arrow keys: next sound, and hear it     Space: again     Enter keeps it     Esc brings back what you had";

/// Height below which the list has one row of tags.
const LOW: f32 = 340.0;

/// Width of the button that imports files.
const IMPORT: f32 = 54.0;

/// What the browser is opened for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Aim {
    Find,
    Save,
}

/// The browser's state.
pub(super) struct Browser {
    /// Read when the browser is first opened.
    sounds: Option<Sounds>,
    /// What was said last of files that cannot be read.
    told: Option<String>,
    library: Option<Library>,
    /// The favourites, as they were read last.
    starred: Option<BTreeSet<String>>,
    finding: Finding,
    portrait: Portrait,
    details: Details,
    /// The key that plays the sound being tried.
    audition: Audition,
    /// What it was opened for.
    aim: Aim,
    /// The words for which a sound has been tried, or with which it was opened: Enter keeps what is loaded.
    tried: Option<String>,
}

impl Browser {
    /// A browser of a library; `None` if the system names no folder for user data.
    pub(super) fn new(library: Option<Library>) -> Self {
        Self {
            sounds: None,
            told: None,
            library,
            starred: None,
            finding: Finding::default(),
            portrait: Portrait::default(),
            details: Details::default(),
            audition: Audition::default(),
            aim: Aim::Find,
            tried: None,
        }
    }

    /// The user's sounds.
    pub(super) fn library(&self) -> Option<&Library> {
        self.library.as_ref()
    }

    /// Reads the sounds again when they are shown next.
    pub(super) fn forget(&mut self) {
        (self.starred, self.sounds) = (None, None);
    }

    /// Whether the sounds have changed since they were read.
    pub(super) fn is_stale(&self) -> bool {
        self.sounds.is_none()
    }

    /// Prepares for being shown, with the name of the loaded sound: for finding another one, or for saving this one.
    pub(super) fn open(&mut self, name: &str, aim: Aim) {
        self.details.open(name);
        // Words from the last time ask for nothing.
        (self.aim, self.tried) = (aim, Some(self.finding.words.clone()));
        match aim {
            Aim::Find => self.finding.searches = true,
            Aim::Save => self.details.take_name(),
        }
        self.forget();
    }

    /// All sounds, read if they may have changed.
    pub(super) fn sounds(&mut self) -> &Sounds {
        self.sounds.get_or_insert_with(|| Sounds::read(self.library.clone()))
    }

    /// Shows the browser. Returns a message, and whether the user is done here.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        loaded: &Shown,
        controls: &mut Controls,
    ) -> Option<(Said, bool)> {
        let palette = controls.palette;
        let mut sounds = self.sounds.take().unwrap_or_else(|| Sounds::read(self.library.clone()));
        paint_panel(ui.painter(), rect, palette);
        let inner = rect.shrink(PADDING);
        let details_width = if rect.width() < 900.0 { 190.0 } else { SIDE[1] };
        let categories = Rect::from_min_max(inner.min, pos2(inner.left() + SIDE[0], inner.bottom()));
        let details = Rect::from_min_max(pos2(inner.right() - details_width, inner.top()), inner.max);
        let list = Rect::from_min_max(
            pos2(categories.right() + 2.0 * GAP, inner.top()),
            pos2(details.left() - 2.0 * GAP, inner.bottom()),
        );
        for x in [categories.right() + GAP, details.left() - GAP] {
            ui.painter().vline(ui.painter().round_to_pixel_center(x), inner.y_range(), Stroke::new(1.0, palette.line));
        }
        let before = self.finding.category;
        self.finding.show_categories(ui, categories, palette);
        if self.finding.category != before {
            // Not while they are shown: their order would change under the arrow keys.
            sounds.read_recent();
        }
        let mut message = None;
        let present = controls.params.name();
        let (search, rest) = list.split_top_bottom_at_y(list.top() + 28.0);
        let (tags, rows) = rest.split_top_bottom_at_y(rest.top() + tags::height(list.height() < LOW));
        let import = search.with_max_y(search.top() + 22.0).with_min_x(search.right() - IMPORT);
        let Found { sounds: found, headings, own } = self.finding.find(&sounds);
        // Once a sound has been tried for its words, the search has no use for keys that move in them.
        let words = if self.tried.as_ref() == Some(&self.finding.words) { "" } else { &self.finding.words };
        let command = keys::asked(ui, search_field(), words, found.len());
        // Where there are none, a heading says so.
        let count = if own > 0 || headings.is_empty() { self.finding.category.counted(own) } else { String::new() };
        let clicks_elsewhere = self.finding.show_search(ui, search.with_max_x(import.left() - 4.0), &count, palette);
        let is_filter = |at| categories.contains(at) || tags.contains(at);
        if clicks_elsewhere && ui.input(|input| input.pointer.interact_pos()).is_some_and(is_filter) {
            // Otherwise letters typed next would play notes.
            ui.memory_mut(|memory| memory.request_focus(search_field()));
        }
        let response = button(ui, import, "Import", "Import files", Look::Plain, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Import", "Open sounds, kits, scales, or recordings to make a sound of.");
        }
        if response.clicked() {
            controls.interaction.pick = Some(Pick::Any);
        }
        self.finding.tags.show(ui, tags, &found, palette);
        let place = found.iter().position(|sound| sound.name() == present);
        let focused = ui.memory(|memory| (0..found.len()).find(|place| memory.has_focus(row(*place))));
        let (mut chosen, mut is_kept) = (None, false);
        match command {
            Some(Command::Go(way)) => {
                chosen = way.from(place, &shelves(rows, found.len(), &headings), seen(rows));
                chosen = chosen.filter(|next| Some(*next) != place);
                if let Some(next) = chosen.filter(|_| focused.is_some()) {
                    ui.memory_mut(|memory| memory.request_focus(row(next)));
                }
            }
            Some(Command::Again) => self.play(ui, &controls.params.state().playable, controls.params),
            Some(Command::Keep) if self.finding.words.ends_with(".toml") => message = Some(self.load_file(controls)),
            // The first of what was looked for, if that has not been tried: Enter again keeps it.
            Some(Command::Keep)
                if focused.is_none()
                    && !self.finding.words.is_empty()
                    && (place.is_none() || self.tried.as_ref() != Some(&self.finding.words)) =>
            {
                chosen = (!found.is_empty()).then_some(0);
                ui.memory_mut(|memory| memory.request_focus(search_field()));
            }
            Some(Command::Keep) => is_kept = focused.is_none_or(|focused| Some(focused) == place),
            None => {}
        }
        let list = List { found: &found, present: &present, chosen, headings: &headings };
        let clicked = list.show(ui, rows, &sounds, palette);
        let mut starred = clicked.star.and_then(|place| found.get(place).cloned());
        // By a key, a sound that is loaded is only played again: a click brings it back as it was.
        let is_again =
            clicked.sound.is_some() && clicked.sound == place && !ui.input(|input| input.pointer.any_click());
        if is_again && !is_kept {
            self.play(ui, &controls.params.state().playable, controls.params);
        } else if let Some(sound) = chosen.or(clicked.sound).filter(|_| !is_kept).and_then(|place| found.get(place)) {
            self.tried = Some(self.finding.words.clone());
            controls.release();
            self.details.open(sound.name());
            controls.history.try_out(sound.playable.clone(), controls.params, controls.host);
            self.play(ui, &sound.playable, controls.params);
            if clicks_elsewhere {
                // So that the keys go on being the list's in a host, too.
                ui.memory_mut(|memory| memory.request_focus(search_field()));
            }
        }
        let name = controls.params.name();
        let shown = found.iter().chain(sounds.all()).find(|sound| sound.name() == name).cloned();
        let compared = self.follow_comparison(ui, rows, controls);
        let about = details.with_max_y(self.details.top(details) - 6.0);
        if self.portrait.show(ui, about, shown.as_deref(), &sounds, loaded, controls) {
            starred = shown.clone();
        }
        if let Some(sound) = starred {
            message = sounds.set_favourite(sound.name(), !sounds.is_favourite(&sound)).map(Err).or(message);
            self.starred = None;
        }
        let may_compare = self.finding.likeness.search.is_none();
        let outcome = self.details.show(ui, details, shown.as_deref(), may_compare, &sounds, controls);
        if outcome.as_ref().is_some_and(|outcome| outcome.compares)
            && let Playable::Preset(preset) = controls.params.state().playable
        {
            self.finding.likeness.asked = Some(self.finding.question());
            message = self.finding.likeness.start(preset, &sounds).err().map(Err).or(message);
        }
        let message = compared.map(Err).or(message);
        let is_stale = outcome.as_ref().is_some_and(|outcome| outcome.is_stale);
        let broken =
            sounds.broken.first().map(|first| format!("{} of your files cannot be read: {first}", sounds.broken.len()));
        let is_told = std::mem::replace(&mut self.told, broken.clone()) == broken;
        let broken = broken.filter(|_| !is_told);
        self.sounds = Some(sounds);
        if is_stale {
            self.forget();
        }
        if is_kept {
            return Some((message.unwrap_or(Ok(String::new())), true));
        }
        match outcome {
            Some(Outcome { message, is_done, compares: false, .. }) => Some((message, is_done)),
            _ => message.or(broken.map(Err)).map(|message| (message, false)),
        }
    }

    /// Releases the key of the tried sound when its time is over.
    pub(super) fn follow_time(&mut self, now: f64, controls: &Controls) {
        self.audition.follow_time(now, controls.params.link());
    }

    /// Releases the key of the tried sound at once.
    pub(super) fn release(&mut self, link: &Link) {
        self.audition.release(link);
    }

    /// Shows how far the search for sounds like one is, and its result when it ends, unless one looks for others meanwhile. Returns a
    /// message if there is none.
    fn follow_comparison(&mut self, ui: &Ui, within: Rect, controls: &Controls) -> Option<String> {
        let likeness = &mut self.finding.likeness;
        let search = likeness.search.as_mut()?;
        let Some(ended) = search.take() else {
            ui.ctx().request_repaint_after(PAUSE);
            let (name, share, is_ending) = (&search.name, search.share(), search.is_cancelled());
            let face = Face { verb: "Comparing with", name, share, is_ending, cancel: "Cancel the comparison" };
            if paint(ui, within, &face, controls.palette).clicked() {
                search.cancel();
            }
            return None;
        };
        ui.ctx().request_repaint();
        let name = std::mem::take(&mut search.name);
        likeness.search = None;
        match ended {
            Ok(places) => {
                likeness.found = Some((name, places));
                if self.finding.likeness.asked == Some(self.finding.question()) {
                    self.finding.choose(Category::Like);
                }
                None
            }
            Err(message) => Some(message),
        }
    }

    /// Whether Escape only leaves a field that one was typing into.
    pub(super) fn takes_escape(&self) -> bool {
        self.aim == Aim::Find && self.details.is_left
    }

    fn load_file(&mut self, controls: &mut Controls) -> Said {
        let playable = read(self.finding.words.trim()).map_err(|error| error.to_string())?;
        self.details.open(playable.name());
        controls.history.try_out(playable, controls.params, controls.host);
        // So that Enter again keeps it.
        Ok(format!("loaded {}", std::mem::take(&mut self.finding.words).trim()))
    }
}
