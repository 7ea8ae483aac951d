//! The tuning that a command uses: Scala's files, given with `--scale` and `--keymap`.

use super::terminal::{complain, counted};
use sprung::engine::EventKind;
use sprung::io::{Inputs, Song};
use sprung::sound::Tuning;
use sprung::sound::tuning::{Keymap, Scale};
use sprung::units::key_from_note_name;
use sprung::{Error, Result};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// How the keys are tuned.
#[derive(Clone, clap::Args)]
pub(super) struct TuningArgs {
    /// Scala scale (.scl) to tune the keys to. Without --keymap, degree 0 is on C4 (key 60), every key is the next
    /// degree, and A4 (key 69) keeps the frequency that the parameter `tuning` gives it
    #[arg(long, value_name = "FILE.scl")]
    scale: Option<PathBuf>,
    /// Scala keyboard mapping (.kbm): which key plays which degree of the scale, which are silent, and the frequency of
    /// one of them, in place of the parameter `tuning`
    #[arg(long, value_name = "FILE.kbm", requires = "scale")]
    keymap: Option<PathBuf>,
}

impl TuningArgs {
    /// Reads the files. Without a scale, the tuning is twelve equal steps.
    pub(super) fn read(&self, inputs: &mut Inputs) -> Result<Tuning> {
        let Some(path) = &self.scale else { return Ok(Tuning::EQUAL) };
        let scale = Scale::read(inputs.open(path)?, &path.display().to_string())?;
        let keymap = match &self.keymap {
            Some(path) => Keymap::read(inputs.open(path)?, &path.display().to_string())?,
            None => Keymap::LINEAR,
        };
        Ok(Tuning::new(&scale, &keymap))
    }

    /// Returns an error for notes that a scale cannot tune: those between two keys. A key that is given twice is an
    /// error too, since the second note would sound on the key beside it.
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

    /// Warns of notes whose keys the tuning leaves silent.
    pub(super) fn warn_of_unmapped(&self, song: &Song, tuning: &Tuning) {
        let keys = || {
            song.events.iter().filter_map(|event| match event.kind {
                EventKind::NoteOn { key, .. } => Some(key),
                _ => None,
            })
        };
        let (all, silent) = (keys().count(), keys().filter(|key| tuning.pitch(*key).is_none()).count());
        if silent > 0 {
            let (all, are) = (counted(all, "note"), if all == 1 { "is" } else { "are" });
            complain("warning", format_args!("{silent} of {all} {are} silent: the keymap leaves their keys out"));
        }
    }
}
