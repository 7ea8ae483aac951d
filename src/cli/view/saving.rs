//! Saves the sound of a channel under a name, among the user's own sounds.

use super::app::{App, Playing};
use sprung::error::Error;
use sprung::preset::catalogue::{Catalogue, Listed};
use sprung::preset::{Playable, Preset};
use sprung::text::printable;
use std::sync::Arc;

impl App {
    /// Saves the channel's sound with its present values under a name. If the name exists, entering it again replaces
    /// the file. Returns the name if it must be typed again.
    pub(super) fn save(&mut self, name: &str) -> Option<String> {
        let name = name.trim();
        let replace = self.replace.take().is_some_and(|replace| replace == name);
        let Some(library) = &self.library else {
            self.tell("the system does not say where your data is kept".to_owned());
            return None;
        };
        let Some(preset) = self.preset(name) else {
            self.tell("a kit is kept in its file: only single sounds are saved".to_owned());
            return None;
        };
        match library.save(&preset, replace) {
            Ok(path) => {
                self.catalogue = Catalogue::read(Some(library));
                self.playing[usize::from(self.channel)].name = printable(name).into_owned();
                self.tell(format!("saved {}", path.display()));
                None
            }
            Err(Error::Exists { .. }) => {
                self.replace = Some(name.to_owned());
                self.replace.clone()
            }
            Err(error) => {
                self.tell(error.to_string());
                Some(name.to_owned())
            }
        }
    }

    /// The channel's sound with its present values, as a preset of this name; none for a kit of several sounds.
    fn preset(&self, name: &str) -> Option<Preset> {
        let Playing { kit, values, listed, .. } = self.playing();
        let [sound] = kit.sounds() else { return None };
        let mut patch = sound.patch().clone();
        patch.values = *values;
        // A sound that was not chosen from the list may be in it too.
        let is_it = |known: &&Arc<Listed>| match &known.playable {
            Playable::Preset(preset) => preset.name == kit.name() && preset.patch.modes == patch.modes,
            Playable::Kit(_) => false,
        };
        let listed = listed.as_ref().or_else(|| self.catalogue.sounds.iter().find(is_it));
        let about = match listed.map(|listed| &listed.playable) {
            Some(Playable::Preset(preset)) => preset.clone(),
            Some(Playable::Kit(_)) => return None,
            None => Preset::new(name, patch.clone()),
        };
        Some(Preset { name: name.to_owned(), patch, ..about })
    }
}
