//! Kits as they are saved: the preset that each key plays.

use super::Preset;
use crate::params::{PARAMS, Param, ParamInfo, Values};
use crate::sound::kit::KEYS;
use crate::sound::{Kit, Pad};
use std::sync::Arc;

/// The kit format version that is read and written.
pub(crate) const KIT_VERSION: i64 = 1;

/// Presets on keys, with name, author, tags, comment and details.
#[derive(Clone, Debug, PartialEq)]
pub struct KitPreset {
    /// Name; never empty.
    pub name: String,
    /// Author.
    pub author: String,
    /// Words to search for.
    pub tags: Vec<String>,
    /// Description for musicians, and how to play it.
    pub comment: String,
    /// How it is made, and where its figures come from.
    pub details: String,
    /// Maximum number of notes that sound at once.
    pub voices: u8,
    /// Values of effects behind the voices. They replace the values that the sounds have in common.
    pub params: Vec<(Param, f32)>,
    /// The presets of the pads, each with the name by which the file refers to it.
    pub sounds: Vec<(String, Preset)>,
    /// Keys from 0 to 127 with their pads, in the order of the file. Each key occurs once.
    pub pads: Vec<(u8, Pad)>,
}

/// The content of a file: a preset or a kit.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one for each file that is read")]
pub enum Playable {
    /// One sound, which all keys play.
    Preset(Preset),
    /// Sounds that are assigned to keys.
    Kit(KitPreset),
}

impl KitPreset {
    /// The kit as it sounds while its parameters have these values. One sound takes them as they are; of several, see
    /// [`KitPreset::with_moves`].
    #[must_use]
    pub fn with_values(mut self, values: &Values) -> Self {
        let [(_, preset)] = &mut self.sounds[..] else { return self.with_moves(values) };
        preset.patch.values = *values;
        self.with_effects(values)
    }

    /// The kit with the values of knobs of several sounds: each sound is as far from its own value, in knob travel, as the knob is
    /// from its default. Parameters behind the voices, the number of voices and the limiter become the kit's.
    #[must_use]
    pub fn with_moves(mut self, values: &Values) -> Self {
        self.voices = values.get(Param::Voices) as u8;
        for patch in self.sounds.iter_mut().map(|(_, preset)| &mut preset.patch) {
            patch.set(Param::Limiter, values.get(Param::Limiter));
            let infos = PARAMS.iter().filter(|info| !info.param.is_behind_voices() && !info.param.is_of_kit());
            infos.for_each(|info| {
                patch.set(info.param, info.moved(patch.get(info.param), info.travel(values.get(info.param))))
            });
        }
        self.with_effects(values)
    }

    /// The kit with these values behind the voices, whatever sounds it has.
    #[must_use]
    pub fn with_effects(mut self, values: &Values) -> Self {
        let behind = PARAMS.iter().filter(|info| info.param.is_behind_voices());
        let is_own = |info: &&ParamInfo| {
            let value = values.get(info.param);
            value != info.default || self.sounds.iter().any(|(_, preset)| preset.patch.get(info.param) != value)
        };
        self.params = behind.filter(is_own).map(|info| (info.param, values.get(info.param))).collect();
        self
    }

    /// The kit to play. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        let sounds = self.sounds.iter().map(|(_, preset)| preset.sound()).collect();
        let mut pads = vec![None; KEYS];
        for (key, pad) in &self.pads {
            if let Some(place) = pads.get_mut(usize::from(*key)) {
                *place = Some(pad.clone());
            }
        }
        let kit = Kit::new(self.name.clone(), sounds, pads).with_voices(self.voices);
        Arc::new(self.params.iter().fold(kit, |kit, (param, value)| kit.with_effect(*param, *value)))
    }
}

impl Playable {
    /// Gives the preset or kit another name.
    pub fn rename(&mut self, name: impl Into<String>) {
        match self {
            Self::Preset(preset) => preset.name = name.into(),
            Self::Kit(kit) => kit.name = name.into(),
        }
    }

    /// Says who made it, and gives it other tags, another description and other details.
    pub fn describe(&mut self, author: String, tags: Vec<String>, [comment, details]: [String; 2]) {
        match self {
            Self::Preset(preset) => {
                (preset.author, preset.tags) = (author, tags);
                (preset.comment, preset.details) = (comment, details);
            }
            Self::Kit(kit) => {
                (kit.author, kit.tags) = (author, tags);
                (kit.comment, kit.details) = (comment, details);
            }
        }
    }

    /// The name of the preset or kit.
    pub fn name(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => &kit.name,
        }
    }

    /// Who made it.
    pub fn author(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.author,
            Self::Kit(kit) => &kit.author,
        }
    }

    /// Its tags.
    pub fn tags(&self) -> &[String] {
        match self {
            Self::Preset(preset) => &preset.tags,
            Self::Kit(kit) => &kit.tags,
        }
    }

    /// Its description for musicians.
    pub fn comment(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.comment,
            Self::Kit(kit) => &kit.comment,
        }
    }

    /// How it is made, and where its figures come from; often empty.
    pub fn details(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.details,
            Self::Kit(kit) => &kit.details,
        }
    }

    /// The name of a pad: its own, or that of its sound.
    pub fn pad_name<'a>(&'a self, pad: &'a Pad) -> &'a str {
        match self {
            _ if !pad.name.is_empty() => &pad.name,
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => kit.sounds.get(pad.sound).map_or("", |(_, preset)| &preset.name),
        }
    }

    /// The kit to play. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        match self {
            Self::Preset(preset) => preset.kit(),
            Self::Kit(kit) => kit.kit(),
        }
    }

    /// The presets in it.
    pub fn presets_mut(&mut self) -> Vec<&mut Preset> {
        match self {
            Self::Preset(preset) => vec![preset],
            Self::Kit(kit) => kit.sounds.iter_mut().map(|(_, preset)| preset).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kit_takes_the_values_of_its_knobs() {
        let Ok(Playable::Kit(kit)) = Playable::find("Acoustic Kit") else { panic!("it is there") };
        let mut values = *kit.kit().values();
        assert_eq!(kit.kit(), kit.clone().with_values(&values).kit(), "as they are");
        for (param, value) in [(Param::Voices, 9.0), (Param::SpaceMix, 31.0), (Param::Limiter, 0.0)] {
            values.set(param, value);
        }
        let info = Param::Decay.info();
        values.set(Param::Decay, info.denormalise(info.normalise(info.default) + 0.1));
        let taken = kit.clone().with_values(&values);
        values.set(Param::Decay, info.default);
        assert_eq!(taken.kit().values(), &values);
        for ((_, before), (_, after)) in kit.sounds.iter().zip(&taken.sounds) {
            let way = |preset: &Preset| info.normalise(preset.patch.get(Param::Decay));
            assert!((way(after) - (way(before) + 0.1).min(1.0)).abs() < 1e-5, "{}", before.name);
        }
    }

    #[test]
    fn a_kit_of_one_sound_takes_them_as_they_are_and_keeps_its_effects_beside_others() {
        let Ok(Playable::Kit(kit)) = Playable::find("Acoustic Kit") else { panic!("it is there") };
        let sound = ("Kick".to_owned(), Preset::find("Kick").unwrap().clone());
        let single = KitPreset { sounds: vec![sound], pads: vec![(36, Pad::of(0))], params: Vec::new(), ..kit };
        let mut values = *single.kit().values();
        for (param, value) in [(Param::Decay, 0.7), (Param::Choke, 3.0), (Param::SpaceMix, 31.0)] {
            values.set(param, value);
        }
        let mut taken = single.clone().with_values(&values);
        assert_eq!(
            (taken.sounds[0].1.patch.values, taken.kit().values(), taken.voices),
            (values, &values, single.voices)
        );
        taken.sounds.push(("Snare".to_owned(), Preset::find("Snare").unwrap().clone()));
        assert_eq!(taken.kit().values().get(Param::SpaceMix), 31.0);
    }
}
