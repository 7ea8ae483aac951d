//! Where output goes: a file that appears whole or not at all, a device, a named pipe, or standard output.

use super::riff;
use super::wav::WavFormat;
use crate::error::{Error, Result};
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Seek, SeekFrom, Stdout, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// What the user named as output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output, written `-`.
    Stdout,
    /// A file, device or named pipe.
    Path(PathBuf),
}

impl Target {
    /// `-` is standard output; all else is a path.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        if path == Path::new("-") { Self::Stdout } else { Self::Path(path) }
    }

    /// The target as errors call it.
    pub fn name(&self) -> String {
        match self {
            Self::Stdout => "stdout".to_owned(),
            Self::Path(path) => path.display().to_string(),
        }
    }
}

/// An output under way. Dropping it before [`Output::commit`] leaves no trace of it on disk.
pub struct Output {
    name: String,
    stream: OutputStream,
    pending: Option<Pending>,
}

/// A temporary file and the name that it gets once it is whole.
struct Pending {
    temporary: TempPath,
    target: PathBuf,
    replace: bool,
}

/// The bytes of an output. Seeks only if [`Output::is_seekable`].
pub enum OutputStream {
    /// A temporary file beside its target.
    File(File),
    /// A device or named pipe.
    Device(File),
    /// Standard output.
    Stdout(Stdout),
}

impl Output {
    /// Opens `target`. A file is written under a temporary name beside it, and an existing one stays untouched
    /// until [`Output::commit`]; devices and pipes are written straight. `force` allows to replace a file.
    ///
    /// # Errors
    /// [`Error::Exists`] for an existing file without `force`; [`Error::Io`] if nothing can be written there.
    pub fn create(target: &Target, force: bool) -> Result<Self> {
        let name = target.name();
        let Target::Path(path) = target else {
            return Ok(Self { name, stream: OutputStream::Stdout(io::stdout()), pending: None });
        };
        let failed = |source| Error::io(&name, source);
        let existing = match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => return Err(failed(ErrorKind::IsADirectory.into())),
            Ok(metadata) if !metadata.is_file() => {
                let device = OpenOptions::new().write(true).open(path).map_err(failed)?;
                return Ok(Self { name, stream: OutputStream::Device(device), pending: None });
            }
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error)),
        };
        // A symbolic link that leads nowhere is not to be lost either.
        if !force && (existing.is_some() || fs::symlink_metadata(path).is_ok()) {
            return Err(Error::Exists { path: name });
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.exists()) {
            let message = format!("there is no folder {}", folder.display());
            return Err(failed(io::Error::new(ErrorKind::NotFound, message)));
        }
        // What a link points to is replaced, not the link.
        let target = if existing.is_some() { fs::canonicalize(path).map_err(failed)? } else { path.clone() };
        let (file, temporary) = temporary_beside(&target).map_err(failed)?;
        if let Some(metadata) = existing {
            file.set_permissions(metadata.permissions()).map_err(failed)?;
        }
        let pending = Some(Pending { temporary, target, replace: force });
        Ok(Self { name, stream: OutputStream::File(file), pending })
    }

    /// What errors call the output.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether what was written can be gone back to.
    pub fn is_seekable(&self) -> bool {
        self.pending.is_some()
    }

    /// The file that the output is in until [`Output::commit`]; none where it is written straight.
    pub fn temporary(&self) -> Option<&Path> {
        self.pending.as_ref().map(|pending| &*pending.temporary)
    }

    /// The stream to write to.
    pub fn stream(&mut self) -> &mut OutputStream {
        &mut self.stream
    }

    /// Completes a WAV whose writing failed, so that what got as far as the disk can be played: cuts it after its last
    /// whole frame and tells the header its length, which takes no further room. Gives the number of frames.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be changed, has no whole header, or is not a file.
    pub fn salvage_wav(&mut self, format: WavFormat) -> Result<u64> {
        let OutputStream::File(file) = &mut self.stream else {
            return Err(Error::io(&self.name, ErrorKind::NotSeekable.into()));
        };
        riff::salvage(file, format.frame_len()).map_err(|source| Error::io(&self.name, source))
    }

    /// Gives the file its name. All must have been written and flushed.
    ///
    /// # Errors
    /// [`Error::Exists`] if a file of that name has appeared and may not be replaced; [`Error::Io`].
    pub fn commit(self) -> Result<()> {
        let Some(Pending { temporary, target, replace }) = self.pending else {
            return Ok(());
        };
        drop(self.stream);
        let renamed = if replace { temporary.persist(&target) } else { temporary.persist_noclobber(&target) };
        renamed.map_err(|failure| match failure.error.kind() {
            ErrorKind::AlreadyExists => Error::Exists { path: self.name },
            _ => Error::io(self.name, failure.error),
        })
    }
}

/// A new file in the directory of `target`, so that renaming stays within one file system, with the permissions that
/// any new file would get.
fn temporary_beside(target: &Path) -> io::Result<(File, TempPath)> {
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sprung-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    // Errors are to speak of the target, not of a name that nobody gave.
    builder.tempfile_in(directory).map(tempfile::NamedTempFile::into_parts).map_err(|error| {
        match error.raw_os_error() {
            Some(code) => io::Error::from_raw_os_error(code),
            None => error.kind().into(),
        }
    })
}

impl Write for OutputStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) | Self::Device(file) => file.write(bytes),
            Self::Stdout(stdout) => stdout.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) | Self::Device(file) => file.flush(),
            Self::Stdout(stdout) => stdout.flush(),
        }
    }
}

impl Seek for OutputStream {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::File(file) => file.seek(to),
            Self::Device(_) | Self::Stdout(_) => Err(ErrorKind::NotSeekable.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_only_when_it_is_whole() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.wav");
        let mut output = Output::create(&Target::new(&path), false).unwrap();
        output.stream().write_all(b"half").unwrap();
        assert!(!path.exists());
        assert_eq!(fs::read(output.temporary().unwrap()).unwrap(), b"half");
        drop(output);
        assert!(names(directory.path()).is_empty(), "an abandoned output leaves nothing");

        let mut output = Output::create(&Target::new(&path), false).unwrap();
        output.stream().write_all(b"whole").unwrap();
        output.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(directory.path()), ["a.wav"]);
    }

    #[test]
    fn an_existing_file_is_replaced_only_by_force() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.wav");
        // One that appears while the other is being written is not lost either.
        let racing = Output::create(&Target::new(&path), false).unwrap();
        fs::write(&path, b"old").unwrap();
        assert!(matches!(racing.commit(), Err(Error::Exists { .. })));
        assert!(matches!(Output::create(&Target::new(&path), false), Err(Error::Exists { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        let mut output = Output::create(&Target::new(&path), true).unwrap();
        output.stream().write_all(b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        output.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(directory.path()), ["a.wav"]);
    }

    #[test]
    fn unwritable_places_are_named() {
        let directory = tempfile::tempdir().unwrap();
        for path in [directory.path().join("none/a.wav"), directory.path().to_owned()] {
            let error = Output::create(&Target::new(&path), true).err().unwrap().to_string();
            assert!(error.starts_with(&format!("{}: ", path.display())) && !error.contains(".part"), "{error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn permissions_links_and_devices_are_respected() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let (plain, path, link) = (directory.path().join("p"), directory.path().join("a"), directory.path().join("l"));
        File::create(&plain).unwrap();
        Output::create(&Target::new(&path), false).unwrap().commit().unwrap();
        assert_eq!(mode(&path), mode(&plain), "a new file's permissions");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        let mut output = Output::create(&Target::new(&link), true).unwrap();
        output.stream().write_all(b"through").unwrap();
        output.commit().unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!((fs::read(&path).unwrap().as_slice(), mode(&path)), (&b"through"[..], 0o640));

        let output = Output::create(&Target::new("/dev/null"), false).unwrap();
        assert!(!output.is_seekable());
        output.commit().unwrap();
    }
}
