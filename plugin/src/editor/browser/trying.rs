//! What can be done without opening the browser: stepping through its list, and the star of the loaded sound.

use super::Browser;
use super::sounds::Sounds;
use crate::editor::controls::history::History;
use crate::params::SprungParams;
use egui::Ui;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::{Guide, Playable};

impl Browser {
    /// Whether the sound of this name is a favourite.
    pub(in crate::editor) fn is_favourite(&mut self, name: &str) -> bool {
        let read = || self.library.as_ref().and_then(|library| library.favourites().ok()).unwrap_or_default();
        self.starred.get_or_insert_with(read).contains(name)
    }

    /// Makes the sound of this name a favourite, or no favourite any more. Returns a message if this cannot be stored.
    pub(in crate::editor) fn turn_favourite(&mut self, name: &str) -> Option<String> {
        let is_favourite = self.is_favourite(name);
        (self.starred, self.sounds) = (None, None);
        self.library.as_ref()?.set_favourite(name, !is_favourite).err().map(|error| error.to_string())
    }

    /// Plays a sound on the key that suits it best.
    pub(super) fn play(&mut self, ui: &Ui, playable: &Playable, params: &SprungParams) {
        let key = match playable {
            Playable::Preset(preset) => preset.guide.home,
            Playable::Kit(kit) => kit.pads.first().map_or(Guide::default().home, |(key, _)| *key),
        };
        self.audition.strike(key, 0.75, ui.input(|input| input.time), params.link());
    }

    /// Loads and plays the sound at this distance in the list, beginning again beyond its ends.
    pub(in crate::editor) fn step(
        &mut self,
        ui: &Ui,
        places: isize,
        (history, params, host): (&mut History, &SprungParams, &GuiContext),
        is_open: bool,
    ) {
        let sounds = self.sounds.take().unwrap_or_else(|| Sounds::read(self.library.clone()));
        let mut found = self.finding.find(&sounds).sounds;
        if found.is_empty() {
            found = sounds.all().cloned().collect();
        }
        self.sounds = Some(sounds);
        let (name, count) = (params.name(), found.len() as isize);
        // From a sound that is not in the list, the next is its first and the one before its last.
        let place = found.iter().position(|sound| sound.name() == name).map(|place| place as isize);
        let place = place.unwrap_or(if places > 0 { -1 } else { 0 }) + places;
        let Some(sound) = place.checked_rem_euclid(count).and_then(|place| found.get(place as usize)) else { return };
        if is_open {
            history.try_out(sound.playable.clone(), params, host);
        } else {
            history.load(sound.playable.clone(), params, host);
        }
        self.play(ui, &sound.playable, params);
    }
}
