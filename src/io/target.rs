//! Interprets the name of an output: standard output, or the file that a path leads to.

#[cfg(feature = "batch")]
use super::FileFormat;
use crate::error::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// The output that the user named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output, written `-`.
    Stdout,
    /// A file, device or named pipe.
    Path(PathBuf),
}

/// File name extensions of sound formats other than WAV.
const OTHER_FORMATS: [&str; 22] = [
    "aac", "aif", "aifc", "aiff", "alac", "ape", "au", "caf", "flac", "m4a", "mid", "midi", "mka", "mp2", "mp3", "mp4",
    "oga", "ogg", "opus", "snd", "w64", "wma",
];

/// Maximum number of symbolic links that are followed in a row, as in Linux.
const MAX_LINKS: usize = 40;

impl Target {
    /// `-` and the paths of standard output (`/dev/stdout`) are standard output. Everything else is a path.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        if path == Path::new("-") || links(&path).any(|path| is_stdout(&path)) {
            Self::Stdout
        } else {
            Self::Path(path)
        }
    }

    /// The name of the target in error messages.
    pub fn name(&self) -> String {
        match self {
            Self::Stdout => "stdout".to_owned(),
            Self::Path(path) => path.display().to_string(),
        }
    }

    /// Returns an error if the name has the extension of another format than WAV.
    ///
    /// # Errors
    /// [`Error::Value`] that says what would be right.
    pub fn check_wav(&self) -> Result<()> {
        let ending = self.ending();
        if OTHER_FORMATS.contains(&ending.as_str()) {
            let message = format!("only WAV can be written, not .{ending}: expected a name that ends in .wav");
            return Err(Error::value(self.name(), message));
        }
        Ok(())
    }

    /// The extension of its name, in lower case; empty if it has none.
    fn ending(&self) -> String {
        match self {
            Self::Stdout => String::new(),
            Self::Path(path) => path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase(),
        }
    }

    /// The format of a sound file with this name: the one that was asked for, or the one that its name says, or WAV.
    ///
    /// # Errors
    /// [`Error::Value`] if the name has the extension of another format; it says what would be right.
    #[cfg(feature = "batch")]
    pub fn file_format(&self, asked: Option<FileFormat>) -> Result<FileFormat> {
        let ending = self.ending();
        let named = match ending.as_str() {
            "flac" => Some(FileFormat::Flac),
            "wav" | "wave" => Some(FileFormat::Wav),
            _ => None,
        };
        match (asked, named) {
            (Some(asked), Some(named)) if asked != named => {
                let ending = asked.ending();
                let message = format!(
                    "--format {ending} does not go with this name: expected a name that ends in .{ending}, or no --format"
                );
                Err(Error::value(self.name(), message))
            }
            (None, None) if OTHER_FORMATS.contains(&ending.as_str()) => {
                let message = format!("only WAV and FLAC can be written, not .{ending}: expected .wav or .flac");
                Err(Error::value(self.name(), message))
            }
            (asked, named) => Ok(asked.or(named).unwrap_or(FileFormat::Wav)),
        }
    }
}

/// The file that gets written for `path`, after following symbolic links. It need not exist yet.
pub(super) fn resolve(path: &Path) -> PathBuf {
    links(path).last().unwrap_or_else(|| path.to_owned())
}

/// The path, and if it is a symbolic link, the path that it points to, and so on.
fn links(path: &Path) -> impl Iterator<Item = PathBuf> {
    let next = |path: &PathBuf| {
        let to = fs::read_link(path).ok()?;
        Some(path.parent().unwrap_or(Path::new("")).join(to))
    };
    std::iter::successors(Some(path.to_owned()), next).take(MAX_LINKS)
}

/// Whether a path is the file descriptor of standard output in a folder of this process's descriptors.
fn is_stdout(path: &Path) -> bool {
    let folder = || path.parent().and_then(|folder| fs::canonicalize(folder).ok());
    path.file_name().is_some_and(|name| name == "1")
        && folder().is_some_and(|folder| {
            ["/proc/self/fd", "/dev/fd"].iter().any(|known| fs::canonicalize(known).is_ok_and(|known| known == folder))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn stdout_has_several_names() {
        let directory = tempfile::tempdir().unwrap();
        let link = directory.path().join("link");
        std::os::unix::fs::symlink("/dev/stdout", &link).unwrap();
        for name in
            [Path::new("-"), Path::new("/dev/stdout"), Path::new("/proc/self/fd/1"), Path::new("/dev/fd/1"), &link]
        {
            assert_eq!(Target::new(name), Target::Stdout, "{}", name.display());
        }
        for name in ["./-", "/dev/stderr", "/dev/fd/2", "1", "/dev/null", "out.wav"] {
            assert_eq!(Target::new(name), Target::Path(name.into()));
        }
    }

    #[cfg(feature = "batch")]
    #[test]
    fn the_format_is_the_one_asked_for_or_named() {
        use FileFormat::{Flac, Wav};
        for (name, asked, format) in [
            ("a.flac", None, Some(Flac)),
            ("a.FLAC", None, Some(Flac)),
            ("a", None, Some(Wav)),
            ("-", None, Some(Wav)),
            ("-", Some(Flac), Some(Flac)),
            ("a.wav", Some(Flac), None),
            ("a.flac", Some(Wav), None),
            ("a.mp3", None, None),
        ] {
            assert_eq!(Target::new(name).file_format(asked).ok(), format, "{name}");
        }
    }

    #[test]
    fn names_that_promise_another_format_are_refused() {
        for name in ["a.mp3", "a.MP3", "a.wav.flac"] {
            let ending = name.rsplit('.').next().unwrap().to_ascii_lowercase();
            let expected = format!("{name}: only WAV can be written, not .{ending}: expected a name that ends in .wav");
            assert_eq!(Target::new(name).check_wav().unwrap_err().to_string(), expected);
        }
        for name in ["a.wav", "a.WAV", "a.wave", "a.rf64", "a", "a.mp3.wav", "a.tmp", "-", "mp3", ".mp3"] {
            assert!(Target::new(name).check_wav().is_ok(), "{name}");
        }
    }
}
