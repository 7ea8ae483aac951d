//! Describes the result of a fit in words, for the preset's comment and for users.

use super::draft::A4;
use super::pitch::key_name;
use super::{Fitted, Take};
use crate::preset::Preset;
use crate::text::counted;
use crate::text::number::measured;
use crate::units::frequency_from_key;
use std::path::Path;

/// Maximum number of characters of a preset's name.
const LONGEST_NAME: usize = 60;

impl Fitted {
    /// The preset that was fitted to these takes. Its name has no space around it, is cut off if it is too long, and `Fitted`
    /// if it is blank. Its comment names the takes by their file names, without folders. Allocates.
    pub fn named(&self, name: &str, takes: &[Take]) -> Preset {
        let name = name.replace(char::is_control, " ");
        let name: String = name.trim().chars().take(LONGEST_NAME).collect();
        let name = if name.is_empty() { "Fitted" } else { name.trim_end() };
        let files: Vec<String> = takes.iter().map(|take| file_name(&take.name)).collect();
        self.preset(name, &format!("Fitted to {}.\n{}", files.join(", "), self.summary()))
    }

    /// The result of the fit, in a few sentences.
    pub fn summary(&self) -> String {
        let noisy = self.patch.modes.as_slice().iter().filter(|mode| mode.strike < 0.5).count();
        let struck = self.patch.modes.as_slice().len() - noisy;
        let key = if self.is_estimated { "estimated as " } else { "" };
        // A key that was estimated is played as it was recorded with this frequency.
        let frequency = frequency_from_key(self.key, A4);
        let mut text = format!(
            "Key {key}{} ({} Hz), {} struck and {noisy} moved by noise, {:.2} dB from the recording.",
            self.key_name(),
            if self.is_estimated { format!("{frequency:.2}") } else { measured(frequency) },
            counted(struck, "mode"),
            self.distances[self.base],
        );
        if let Some(release) = self.release {
            text += &format!(
                " The key is let go after {:.2} s, and the damper's T60 is {} s.",
                release.seconds,
                measured(release.t60)
            );
        }
        if let Some(explained) = &self.explained {
            text += &format!(
                " As a {}: {} of {} modes are its own, {:.1} cents off on average; {:.1} dB of their energy remain unexplained.",
                explained.model.replace('_', " "),
                explained.modes.0,
                explained.modes.1,
                explained.cents,
                explained.unexplained_db
            );
        }
        text
    }

    /// The key as musicians write it: `C4`, or `C4 +13 ct` between two keys.
    pub(crate) fn key_name(&self) -> String {
        key_name(self.key)
    }
}

/// The last part of a path.
fn file_name(path: &str) -> String {
    Path::new(path).file_name().map_or(path.to_owned(), |name| name.to_string_lossy().into_owned())
}
