//! The tuning that a command plays in: Scala's files, named by `--scale` and `--keymap`.

use sprung::io::Inputs;
use sprung::sound::Tuning;
use sprung::sound::tuning::{Keymap, Scale};
use sprung::units::key_from_note_name;
use sprung::{Error, Result};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// How the keys are tuned.
#[derive(clap::Args)]
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
    /// Reads the files; twelve equal steps where none is named.
    pub(super) fn read(&self, inputs: &mut Inputs) -> Result<Tuning> {
        let Some(path) = &self.scale else { return Ok(Tuning::EQUAL) };
        let scale = Scale::read(inputs.open(path)?, &path.display().to_string())?;
        let keymap = match &self.keymap {
            Some(path) => Keymap::read(inputs.open(path)?, &path.display().to_string())?,
            None => Keymap::LINEAR,
        };
        Ok(Tuning::new(&scale, &keymap))
    }

    /// Refuses notes that a scale says nothing of: those between keys. A key given twice would sound by its neighbour.
    pub(super) fn check_notes(&self, notes: &[String]) -> Result<()> {
        let mut keys = BTreeSet::new();
        for note in notes.iter().filter(|_| self.scale.is_some()) {
            let key = key_from_note_name(note).or(note.trim().parse().ok());
            let wrong = match key {
                None => "lies between the keys that --scale tunes",
                Some(key) if !keys.insert(key) => "is there twice",
                Some(_) => continue,
            };
            let expected = "expected keys (C#4, 60), each once";
            return Err(Error::value("--note", format!("‘{note}’ {wrong}: {expected}")));
        }
        Ok(())
    }
}
