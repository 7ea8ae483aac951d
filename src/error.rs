//! The error type of the crate: every message says what is wrong, where, and what would be right.

use std::io::ErrorKind;

/// Everything that can fail outside the audio thread. The audio path itself cannot fail.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file or stream could not be read or written.
    #[error("{path}: {}", reason(source))]
    Io {
        /// The file, or `stdout`/`stdin`.
        path: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// The file exists and must not be overwritten.
    #[error("{path}: the file exists; add --force to overwrite it")]
    Exists {
        /// The file.
        path: String,
    },
    /// Another process writes the file.
    #[error("{path}: another process is writing it")]
    Locked {
        /// The file.
        path: String,
    },
    /// The contents of a file are not what they should be.
    #[error("{origin}: {message}")]
    Format {
        /// The file and, where known, the place in it.
        origin: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A value given by the caller is out of range or cannot be read.
    #[error("{name}: {message}")]
    Value {
        /// The parameter, option or field.
        name: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// The work was stopped from outside before its end; nothing incomplete was written.
    #[error("interrupted; nothing incomplete was written")]
    Interrupted,
    /// The work was stopped from outside before its end, and some of it was written.
    #[error("interrupted; {left}")]
    InterruptedAfter {
        /// What was written, and what was not.
        left: String,
    },
}

impl Error {
    /// Whether the work was stopped from outside.
    pub fn is_interrupt(&self) -> bool {
        matches!(self, Self::Interrupted | Self::InterruptedAfter { .. })
    }

    /// An [`Error::Value`] of `name`.
    pub fn value(name: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Value { name: name.into(), message: message.into() }
    }

    /// An [`Error::Format`] in `origin`.
    pub fn format(origin: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Format { origin: origin.into(), message: message.into() }
    }

    /// An [`Error::Io`] on `path`.
    pub fn io(path: impl Into<String>, source: std::io::Error) -> Self {
        Self::Io { path: path.into(), source }
    }
}

/// For frequent errors of the system what would be right; else the error's own words.
fn reason(source: &std::io::Error) -> String {
    if source.get_ref().is_some() {
        // An error of a library or of this crate, with words of its own.
        return source.to_string();
    }
    match source.kind() {
        ErrorKind::NotFound => "No such file or folder: expected one that exists".to_owned(),
        ErrorKind::NotADirectory => "Not a folder: expected one".to_owned(),
        ErrorKind::IsADirectory => "Is a folder: expected a file".to_owned(),
        ErrorKind::PermissionDenied => "Permission denied: expected a file that you may read or write".to_owned(),
        _ => source.to_string(),
    }
}

/// A result with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// The candidates most similar to `word`, in quotes and joined by “or”: those that contain it as a whole word, or else
/// those with the fewest edits. `None` if all are too different.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let word = word.trim().to_lowercase();
    let scored: Vec<_> = candidates.into_iter().map(|candidate| (similarity(&word, candidate), candidate)).collect();
    let best = scored.iter().map(|(score, _)| *score).max_by(f64::total_cmp).filter(|best| *best > LEAST_SIMILARITY)?;
    let found = scored.iter().filter(|(score, _)| *score == best).take(MOST_SUGGESTIONS);
    Some(found.map(|(_, candidate)| format!("‘{candidate}’")).collect::<Vec<_>>().join(" or "))
}

/// Minimum similarity of a suggested candidate.
pub(crate) const LEAST_SIMILARITY: f64 = 0.55;

const MOST_SUGGESTIONS: usize = 3;

/// Similarity from 0 to 1 of a word in lower case, by the edits between the two texts. The edits between `word` and one word of the candidate
/// also count, with slightly less weight.
pub(crate) fn similarity(word: &str, candidate: &str) -> f64 {
    let candidate = candidate.to_lowercase();
    let parts = candidate.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    let of_part = parts.map(|part| 0.9 * strsim::normalized_damerau_levenshtein(word, part)).fold(0.0, f64::max);
    strsim::normalized_damerau_levenshtein(word, &candidate).max(of_part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(word: &str, candidates: &[&str]) -> String {
        nearest(word, candidates.iter().copied()).unwrap_or_default()
    }

    #[test]
    fn the_misspelt_is_found_and_the_unrelated_left() {
        let words = ["decay", "release", "gain"];
        assert_eq!(found("deacy", &words), "‘decay’");
        assert_eq!(found("Gian", &words), "‘gain’");
        assert_eq!(found("decays", &words), "‘decay’");
        assert_eq!(found("xylophone", &words), "");
        assert_eq!(found("", &words), "");
    }

    #[test]
    fn a_word_of_a_longer_name_is_enough() {
        let names = ["Bass", "Church Bell", "Clave", "Closed Hat", "Open Hat", "Sub-Bass"];
        assert_eq!(found("Bell", &names), "‘Church Bell’");
        assert_eq!(found("belll", &names), "‘Church Bell’");
        assert_eq!(found("hat", &names), "‘Closed Hat’ or ‘Open Hat’");
        assert_eq!(found("bass", &names), "‘Bass’", "a whole name goes before a part of one");
        assert_eq!(found("rate", &["vibrato", "vibrato_rate"]), "‘vibrato_rate’");
    }
}
