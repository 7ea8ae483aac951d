//! Saves the sound of a channel under a name, among the user's own sounds.

use super::app::{App, Playing};
use sprung::Error;
use sprung::internals::library::{Catalogue, Listed};
use sprung::internals::text::printable;
use sprung::preset::{Playable, Preset};
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
        let Some(sound) = self.sound(name) else {
            self.tell("only presets, and kits of the list, are saved".to_owned());
            return None;
        };
        match library.save(&sound, replace) {
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

    /// The channel's sound with its present values, under this name; none for a kit that was not chosen from the list.
    fn sound(&self, name: &str) -> Option<Playable> {
        let Playing { kit, values, listed, .. } = self.playing();
        let mut sound = match listed.as_ref().map(|listed| &listed.playable) {
            Some(Playable::Kit(kit)) => Playable::Kit(kit.clone().with_values(values)),
            Some(Playable::Preset(preset)) => Playable::Preset(preset.clone()),
            None => {
                let [sound] = kit.sounds() else { return None };
                // A sound that was not chosen from the list may be in it too.
                let is_it = |known: &&Arc<Listed>| match &known.playable {
                    Playable::Preset(preset) => preset.name == kit.name() && preset.patch.modes == sound.patch().modes,
                    Playable::Kit(_) => false,
                };
                let known = self.catalogue.sounds.iter().find(is_it).map(|listed| listed.playable.clone());
                known.unwrap_or_else(|| Playable::Preset(Preset::new(name, sound.patch().clone())))
            }
        };
        if let (Playable::Preset(preset), [sound]) = (&mut sound, kit.sounds()) {
            preset.patch = sound.patch().clone();
            preset.patch.values = *values;
        }
        sound.rename(name);
        Some(sound)
    }
}
