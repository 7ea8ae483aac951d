//! The tuning of a request, from Scala files.

use crate::engine::EventKind;
use crate::error::{Error, Result};
use crate::io::{Inputs, Song};
use crate::sound::Tuning;
use crate::sound::tuning::{Keymap, Scale};
use crate::text::counted;
use crate::units::key_from_note_name;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// The tuning of the keys: Scala files, or twelve equal steps without a scale.
#[derive(Clone, Debug, Default)]
pub struct TuningRequest {
    /// Scale (.scl).
    pub scale: Option<PathBuf>,
    /// Keyboard mapping (.kbm), which needs a scale.
    pub keymap: Option<PathBuf>,
}

impl TuningRequest {
    /// Reads the files.
    pub(super) fn read(&self, inputs: &mut Inputs) -> Result<Tuning> {
        self.check()?;
        let Some(path) = &self.scale else { return Ok(Tuning::EQUAL) };
        let scale = Scale::read(inputs.open(path)?, &path.display().to_string())?;
        let keymap = match &self.keymap {
            Some(path) => Keymap::read(inputs.open(path)?, &path.display().to_string())?,
            None => Keymap::LINEAR,
        };
        Ok(Tuning::new(&scale, &keymap))
    }

    /// Returns an error for a keymap without a scale.
    pub(super) fn check(&self) -> Result<()> {
        if self.keymap.is_some() && self.scale.is_none() {
            return Err(Error::value("--keymap", "expected --scale beside it"));
        }
        Ok(())
    }

    /// Leaves the song's own tunings out if there is a scale: changes of single keys would mix two tunings. `warn` is told so.
    pub fn overrule(&self, song: &mut Song, warn: &mut dyn FnMut(&str)) {
        if self.scale.is_none() {
            return;
        }
        let before = song.events.len();
        song.events.retain(|event| !matches!(event.kind, EventKind::Tune { .. }));
        if song.events.len() < before {
            warn("--scale goes before the tunings by MIDI Tuning Standard in the song: they were left out");
        }
    }

    /// Returns an error for notes that a scale cannot tune: those between two keys. A key that is given twice is an
    /// error too, since the second note would sound on the neighbouring key.
    pub(super) fn check_notes(&self, notes: &[String]) -> Result<()> {
        let mut keys = BTreeSet::new();
        for note in notes.iter().filter(|_| self.scale.is_some()) {
            let key = key_from_note_name(note).or(note.trim().parse().ok());
            let wrong = match key {
                None => "is no key, and --scale tunes keys",
                Some(key) if !keys.insert(key) => "is there twice",
                Some(_) => continue,
            };
            let expected = "expected keys (C#4, 60), each once";
            return Err(Error::value("--note", format!("‘{note}’ {wrong}: {expected}")));
        }
        Ok(())
    }
}

/// Warns of notes whose keys the tuning leaves silent.
pub(super) fn warn_of_unmapped(song: &Song, tuning: &Tuning, has_keymap: bool, warn: &mut dyn FnMut(&str)) {
    let keys = || {
        song.events.iter().filter_map(|event| match event.kind {
            EventKind::NoteOn { key, .. } => Some(key),
            _ => None,
        })
    };
    let (all, silent) = (keys().count(), keys().filter(|key| tuning.pitch(*key).is_none()).count());
    if silent > 0 {
        let (all, are) = (counted(all, "note"), if all == 1 { "is" } else { "are" });
        let why =
            if has_keymap { "the keymap leaves their keys out" } else { "the scale takes their keys out of range" };
        warn(&format!("{silent} of {all} {are} silent: {why}"));
    }
}
