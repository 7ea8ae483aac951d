//! Opens outputs: a file that appears only when it is complete, a device, a named pipe, or standard output.

use super::inputs::Inputs;
use super::target::{Target, resolve};
use super::temporary;
use crate::error::{Error, Result};
use same_file::Handle;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// An output that is being written. If it is dropped before [`Output::commit`], nothing remains on disk.
pub struct Output {
    name: String,
    stream: File,
    pending: Option<Pending>,
}

/// A temporary file, and the name that it gets when it is complete.
struct Pending {
    temporary: TempPath,
    target: PathBuf,
    replace: bool,
}

impl Output {
    /// Opens `target`, which must not be one of the `inputs`. A file is written to a temporary file in the same folder,
    /// and an existing file stays unchanged until [`Output::commit`]. Devices and pipes are written directly. `force`
    /// allows replacing a file. If `target` is a symbolic link, the file that it points to is written, and the link
    /// stays.
    ///
    /// # Errors
    /// [`Error::Value`] if it is one of the inputs; [`Error::Exists`] for an existing file without `force`;
    /// [`Error::Io`] if it cannot be written.
    pub fn create(target: &Target, force: bool, inputs: &Inputs) -> Result<Self> {
        let name = target.name();
        let failed = |source| Error::io(&name, source);
        let Target::Path(path) = target else {
            inputs.check_stdout()?;
            let stream = stdout().map_err(failed)?;
            return Ok(Self { name, stream, pending: None });
        };
        let existing = match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => return Err(failed(ErrorKind::IsADirectory.into())),
            Ok(metadata) if !metadata.is_file() => {
                let stream = OpenOptions::new().write(true).open(path).map_err(failed)?;
                return Ok(Self { name, stream, pending: None });
            }
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error)),
        };
        let target = match &existing {
            Some(metadata) => {
                check_replaceable(path, metadata, &name, force, inputs)?;
                fs::canonicalize(path).map_err(failed)?
            }
            None => resolve(path),
        };
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.exists() {
            let message = format!("there is no folder {}", folder.display());
            return Err(failed(io::Error::new(ErrorKind::NotFound, message)));
        }
        let (stream, temporary) = temporary::create_in(folder).map_err(|error| failed(in_folder(folder, &error)))?;
        if let Some(metadata) = existing {
            stream.set_permissions(metadata.permissions()).map_err(failed)?;
        }
        let pending = Some(Pending { temporary, target, replace: force });
        Ok(Self { name, stream, pending })
    }

    /// The name of the output in error messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether the writer can seek in the output.
    pub fn is_seekable(&self) -> bool {
        self.pending.is_some()
    }

    /// The temporary file before [`Output::commit`]; none if the output is written directly.
    pub fn temporary(&self) -> Option<&Path> {
        self.pending.as_ref().map(|pending| &*pending.temporary)
    }

    /// Another file to write first, in the same folder, or in the system's for temporary files if the output is written directly. It
    /// never gets a name, and vanishes when it is dropped.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be created.
    pub fn scratch(&self) -> Result<Self> {
        let folder = self.temporary().and_then(Path::parent).map_or_else(std::env::temp_dir, Path::to_owned);
        let made = temporary::create_in(&folder).map_err(|error| in_folder(&folder, &error));
        let (stream, temporary) = made.map_err(|source| Error::io(&self.name, source))?;
        let pending = Some(Pending { temporary, target: PathBuf::new(), replace: false });
        Ok(Self { name: self.name.clone(), stream, pending })
    }

    /// The stream to write to.
    pub fn stream(&mut self) -> &mut File {
        &mut self.stream
    }

    /// Renames the file to its final name. Everything must have been written and flushed.
    ///
    /// # Errors
    /// [`Error::Exists`] if a file with that name has appeared and must not be replaced; [`Error::Io`].
    pub fn commit(self) -> Result<()> {
        let Some(Pending { temporary, target, replace }) = self.pending else {
            return Ok(());
        };
        // The file stays open, and thus locked, until it is renamed.
        let renamed = if replace { temporary.persist(&target) } else { temporary.persist_noclobber(&target) };
        renamed.map_err(|failure| match failure.error.kind() {
            ErrorKind::AlreadyExists => Error::Exists { path: self.name },
            _ => Error::io(self.name, failure.error),
        })
    }
}

/// Returns an error if an existing file is one of the inputs, must not be replaced, or cannot be written.
fn check_replaceable(path: &Path, metadata: &Metadata, name: &str, force: bool, inputs: &Inputs) -> Result<()> {
    let failed = |source| Error::io(name, source);
    let open = || OpenOptions::new().write(true).open(path);
    // This also identifies a file that can be written but not read.
    let handle = Handle::from_path(path).or_else(|_| Handle::from_file(open()?)).map_err(failed)?;
    inputs.check(name, &handle)?;
    if !force {
        return Err(Error::Exists { path: name.to_owned() });
    }
    // Refuse explicitly: renaming would replace a read-only file, and the superuser could open it for writing.
    if metadata.permissions().readonly() {
        let message = "the file is read-only: make it writable, or choose another name";
        return Err(failed(io::Error::new(ErrorKind::PermissionDenied, message)));
    }
    open().map(drop).map_err(failed)
}

/// An error that names the folder instead of the temporary file, whose name the user does not know.
fn in_folder(folder: &Path, error: &io::Error) -> io::Error {
    let reason = error.raw_os_error().map_or_else(|| error.kind().into(), io::Error::from_raw_os_error);
    io::Error::new(error.kind(), format!("no file can be made in the folder {}: {reason}", folder.display()))
}

/// Standard output, unbuffered.
fn stdout() -> io::Result<File> {
    #[cfg(unix)]
    let stdout = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned();
    #[cfg(windows)]
    let stdout = std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned();
    // WebAssembly has no files.
    #[cfg(not(any(unix, windows)))]
    let stdout: io::Result<File> = Err(ErrorKind::Unsupported.into());
    stdout.map(File::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn create(path: impl Into<PathBuf>, force: bool) -> Result<Output> {
        Output::create(&Target::new(path), force, &Inputs::default())
    }

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
        let mut output = create(&path, false).unwrap();
        output.stream().write_all(b"half").unwrap();
        assert!(!path.exists());
        assert_eq!(fs::read(output.temporary().unwrap()).unwrap(), b"half");
        drop(output);
        assert!(names(directory.path()).is_empty(), "an abandoned output leaves nothing");

        let mut output = create(&path, false).unwrap();
        output.stream().write_all(b"whole").unwrap();
        output.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(directory.path()), ["a.wav"]);
    }

    #[test]
    fn an_existing_file_is_replaced_only_by_force() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.wav");
        // A file that appears while the output is being written is not lost either.
        let racing = create(&path, false).unwrap();
        fs::write(&path, b"old").unwrap();
        assert!(matches!(racing.commit(), Err(Error::Exists { .. })));
        assert!(matches!(create(&path, false), Err(Error::Exists { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        let mut output = create(&path, true).unwrap();
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
            let error = create(&path, true).err().unwrap().to_string();
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
        create(&path, false).unwrap().commit().unwrap();
        assert_eq!(mode(&path), mode(&plain), "a new file's permissions");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        let mut output = create(&link, true).unwrap();
        output.stream().write_all(b"through").unwrap();
        output.commit().unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!((fs::read(&path).unwrap().as_slice(), mode(&path)), (&b"through"[..], 0o640));

        let output = create("/dev/null", false).unwrap();
        assert!(!output.is_seekable());
        output.commit().unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_no_file_yet_is_written_through() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::create_dir(path("folder")).unwrap();
        std::os::unix::fs::symlink("folder/new", path("link")).unwrap();
        std::os::unix::fs::symlink("link", path("far")).unwrap();
        let mut output = create(path("far"), false).unwrap();
        output.stream().write_all(b"through").unwrap();
        output.commit().unwrap();
        assert!(["link", "far"].iter().all(|link| fs::symlink_metadata(path(link)).unwrap().is_symlink()));
        assert_eq!(fs::read(path("folder/new")).unwrap(), b"through");
        assert!(matches!(create(path("far"), false), Err(Error::Exists { .. })));

        std::os::unix::fs::symlink("none/new", path("lost")).unwrap();
        let error = create(path("lost"), true).err().unwrap().to_string();
        assert!(error.ends_with(&format!("there is no folder {}", path("none").display())), "{error}");
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.wav");
        fs::write(&path, "old").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = create(&path, true).err().unwrap().to_string();
        assert!(error.ends_with("a.wav: the file is read-only: make it writable, or choose another name"), "{error}");
        assert_eq!((names(directory.path()), fs::read(&path).unwrap()), (vec!["a.wav".to_owned()], b"old".to_vec()));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_takes_no_files_is_named() {
        // Not even the superuser can create a file here.
        let error = create("/sys/a.wav", false).err().unwrap().to_string();
        assert!(error.starts_with("/sys/a.wav: no file can be made in the folder /sys: "), "{error}");
        assert!(!error.contains(".part"), "{error}");
    }
}
