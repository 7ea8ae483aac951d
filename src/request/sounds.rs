//! The sounds of a request: presets and kits, parameter settings, and the tuning.

use super::playable::playable;
use super::programs::{self, used};
use super::tuning::{self, TuningRequest};
use crate::engine::EventKind;
use crate::engine::banks::{DRUM_CHANNEL, MELODIC};
use crate::error::{Error, Result};
use crate::io::{Inputs, Song};
use crate::params::Param;
use crate::preset::{Playable, Programs};
use crate::sound::{Kit, Mix, Tuning};
use crate::text::counted;
use crate::units::note_name;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::sync::Arc;

/// The names of the sounds that play a song.
#[derive(Clone, Debug)]
pub struct SoundRequest {
    /// Factory preset or kit, or preset or kit file, for channels without another choice. Without it, songs use the
    /// first of the programs, and notes use `init`.
    pub preset: Option<OsString>,
    /// Presets, kits or files that single channels, from 0, start with.
    pub channels: Vec<(u8, String)>,
    /// The sounds that program changes select: `gm`, `none` or a file.
    pub programs: OsString,
    /// Parameters to set in every preset used.
    pub set: Vec<(Param, f32)>,
    /// Gain in dB of the sum of all sounds, before the limiter.
    pub mix_gain_db: f64,
    /// The tuning of the keys.
    pub tuning: TuningRequest,
}

impl Default for SoundRequest {
    fn default() -> Self {
        let (channels, set, tuning) = (Vec::new(), Vec::new(), TuningRequest::default());
        Self { preset: None, channels, programs: "gm".into(), set, mix_gain_db: 0.0, tuning }
    }
}

/// The sounds of a request, with the parameters that it sets.
#[derive(Clone, Debug)]
pub struct Sounds {
    /// The initial kit of the channels that are not in `channels`.
    pub kit: Arc<Kit>,
    /// Initial kits of single channels, from 0.
    pub channels: Vec<(u8, Arc<Kit>)>,
    /// The kits that program changes select: melodic sounds, then drum kits. Empty if they select nothing.
    pub programs: Vec<Arc<Kit>>,
    /// The list that the programs come from.
    list: Option<Programs>,
    /// The mix of the channels; with none, they are only added.
    pub mix: Option<Mix>,
    /// The tuning of the keys.
    pub tuning: Tuning,
}

impl Sounds {
    /// Whether an input can drive any of the sounds.
    pub(super) fn take_input(&self) -> bool {
        let kits = [&self.kit].into_iter().chain(self.channels.iter().map(|(_, kit)| kit)).chain(&self.programs);
        let level = Param::InputLevel.info();
        kits.flat_map(|kit| kit.sounds()).map(|sound| sound.patch()).any(|patch| {
            let is_moved = patch.routes.iter().any(|(_, route)| route.destination == level.param);
            is_moved || patch.get(level.param) > level.min
        })
    }
}

impl SoundRequest {
    /// Loads the presets and kits, sets the parameters of all sounds, and reads the tuning. Program changes of the
    /// `song` are changed to the numbers of their kits. Without a song, all programs are loaded if it `is_live`.
    /// Allocates, and reads files.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Format`] for files that cannot be read, [`Error::Value`] for unknown names.
    pub fn load(&self, song: Option<&mut Song>, is_live: bool, inputs: &mut Inputs) -> Result<Sounds> {
        // What is named comes first, so that a wrong name is told before a bank is loaded.
        let own = self.preset.as_deref().map(|name| playable(name, inputs)).transpose()?.map(|own| self.kit(own));
        let mut channels = Vec::with_capacity(self.channels.len() + 1);
        for (channel, name) in &self.channels {
            if channels.iter().any(|(taken, _)| taken == channel) {
                let message = format!("channel {} is there twice: expected each channel once", channel + 1);
                return Err(Error::value("--channel", message));
            }
            channels.push((*channel, self.kit(playable(OsStr::new(name), inputs)?)));
        }
        let list = if song.is_some() || is_live { programs::list(&self.programs, inputs)? } else { None };
        let has_drums = song.as_ref().is_none_or(|song| song.events.iter().any(|event| event.channel == DRUM_CHANNEL));
        let (is_free, has_song) = (self.preset.is_none(), song.is_some());
        let mut used = song.map(|song| {
            match list {
                Some(_) => song.select_by_bank(),
                None => song.events.retain(|event| !matches!(event.kind, EventKind::Program(_))),
            }
            used(song)
        });
        // The initial kits are loaded only once, even if program changes select them too.
        let starts_with_first = is_free && has_song;
        let starts_with_drums = is_free && has_drums && self.channels.iter().all(|(taken, _)| *taken != DRUM_CHANNEL);
        if let Some(used) = &mut used {
            used.extend(starts_with_first.then_some(0));
            used.extend(starts_with_drums.then_some(MELODIC));
        }
        let wanted = |number| used.as_ref().is_none_or(|used: &BTreeSet<u8>| used.contains(&number));
        let made = match &list {
            None => Vec::new(),
            Some(list) => programs::kits(list, wanted, |playable| self.kit(playable), inputs)?,
        };
        let program = |number: u8| made.get(usize::from(number)).cloned().flatten();
        let kit = match own.or_else(|| program(0).filter(|_| starts_with_first)) {
            Some(kit) => kit,
            None => self.kit(playable(OsStr::new("init"), inputs)?),
        };
        channels.extend(program(MELODIC).filter(|_| starts_with_drums).map(|drums| (DRUM_CHANNEL, drums)));
        let programs = made.into_iter().map(|made| made.unwrap_or_else(|| kit.clone())).collect();
        // If the user sets the space, every channel has its own, and the shared one is not used.
        let sets_space = self.set.iter().any(|(param, _)| *param == Param::Space);
        let mut mix = list.as_ref().filter(|_| has_song).map(|list| list.mix.clone());
        if let Some(mix) = mix.as_mut().filter(|_| sets_space) {
            mix.space.clear();
        }
        if self.mix_gain_db != 0.0 {
            mix.get_or_insert_default().gain += self.mix_gain_db as f32;
        }
        Ok(Sounds { kit, channels, programs, mix, list, tuning: self.tuning.read(inputs)? })
    }

    /// Opens every file that loading these sounds would read, including the files that kits and lists of programs name.
    /// Files that cannot be read are left out; they give an error when they are loaded.
    #[cfg(feature = "batch")]
    pub(crate) fn files(&self) -> Inputs {
        let mut inputs = Inputs::default();
        let given = self.preset.iter().cloned().chain(self.channels.iter().map(|(_, name)| name.into()));
        let mut names: BTreeSet<OsString> = given.collect();
        // The factory's list names no files.
        if self.programs != "gm"
            && let Ok(Some(list)) = programs::list(&self.programs, &mut inputs)
        {
            names.extend((0..=u8::MAX).filter_map(|number| list.name_of(number)).map(OsString::from));
        }
        for name in names {
            drop(playable(&name, &mut inputs));
        }
        inputs
    }

    /// Warns of a song without notes, of program changes without a sound or away from the requested sound, of keys that the tuning does not map,
    /// and of channels and notes that stay silent.
    pub fn warn(&self, song: &Song, sounds: &Sounds, warn: &mut dyn FnMut(&str)) {
        if !song.events.iter().any(|event| matches!(event.kind, EventKind::NoteOn { .. })) {
            warn("there are no notes to play");
        }
        if let Some(list) = &sounds.list {
            programs::warn_of_missing(song, list, "what channels start with", warn);
        }
        programs::warn_of_changes(song, self.asked_for(sounds), &sounds.programs, warn);
        tuning::warn_of_unmapped(song, &sounds.tuning, self.tuning.keymap.is_some(), warn);
        self.warn_of_silence(song, sounds, warn);
    }

    /// The kit that the user asked for on each channel; none if neither a preset for all channels nor one for this
    /// channel was given.
    fn asked_for<'a>(&self, sounds: &'a Sounds) -> [Option<&'a Arc<Kit>>; 16] {
        let mut asked = [self.preset.is_some().then_some(&sounds.kit); 16];
        sounds.channels[..self.channels.len()]
            .iter()
            .for_each(|(channel, kit)| asked[usize::from(*channel)] = Some(kit));
        asked
    }

    /// Warns of channels that were given a sound but have no events, and of notes on keys without a pad in their kit. A
    /// channel without notes may still be used: the notes of an MPE zone are on other channels than its master channel.
    fn warn_of_silence(&self, song: &Song, sounds: &Sounds, warn: &mut dyn FnMut(&str)) {
        let programs = &sounds.programs;
        let mut playing = [&sounds.kit; 16];
        sounds.channels.iter().for_each(|(channel, kit)| playing[usize::from(*channel)] = kit);
        let (mut is_used, mut all) = ([false; 16], 0);
        let (mut silent, mut keys) = (0, BTreeMap::<u8, BTreeSet<u8>>::new());
        for event in &song.events {
            let channel = usize::from(event.channel);
            let Some(playing) = playing.get_mut(channel) else { continue };
            is_used[channel] = true;
            match event.kind {
                EventKind::Program(number) => *playing = programs.get(usize::from(number)).unwrap_or(playing),
                EventKind::NoteOn { key, .. } => {
                    all += 1;
                    if playing.pad(key).is_none() {
                        silent += 1;
                        keys.entry(event.channel).or_default().insert(key);
                    }
                }
                _ => {}
            }
        }
        for (channel, _) in self.channels.iter().filter(|(channel, _)| !is_used[usize::from(*channel)]) {
            warn(&format!("--channel {0}: the song has nothing on channel {0}", channel + 1));
        }
        if silent > 0 {
            let list = |(channel, keys): (&u8, &BTreeSet<u8>)| {
                let names: Vec<_> = keys.iter().map(|key| note_name(*key)).collect();
                format!("channel {}: {}", channel + 1, names.join(" "))
            };
            let where_to = keys.iter().map(list).collect::<Vec<_>>().join("; ");
            let (all, are) = (counted(all, "note"), if all == 1 { "is" } else { "are" });
            warn(&format!("{silent} of {all} {are} silent: their kits have no pad on their keys ({where_to})"));
        }
    }

    /// The kit of a preset or kit, with the request's parameters set.
    pub fn kit(&self, mut playable: Playable) -> Arc<Kit> {
        for preset in playable.presets_mut() {
            self.set.iter().for_each(|(param, value)| preset.patch.set(*param, *value));
        }
        playable.kit()
    }
}
