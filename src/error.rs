//! The one error type: every message says what is wrong, where, and what would be right.

/// Everything that can go wrong outside the audio thread. The audio path itself has no errors: it cannot fail.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file or stream could not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file, or `stdout`/`stdin`.
        path: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file exists and was not to be overwritten.
    #[error("{path}: the file exists; add --force to overwrite it")]
    Exists {
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
    /// The work was stopped from outside before its end; nothing was written.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

impl Error {
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

/// A result with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// The closest of `candidates` to `word`, when it is close enough to be what was meant.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&word.to_lowercase(), &candidate.to_lowercase()), candidate))
        .filter(|(similarity, _)| *similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_finds_the_misspelt_and_leaves_the_unrelated() {
        let words = ["decay", "release", "gain"];
        assert_eq!(nearest("deacy", words), Some("decay"));
        assert_eq!(nearest("Gian", words), Some("gain"));
        assert_eq!(nearest("xylophone", words), None);
    }
}
