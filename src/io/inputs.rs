//! Records the files that a command reads, so that none of them can become its output.

use crate::error::{Error, Result};
use same_file::Handle;
use std::fs::File;
use std::io::{self, Stdin};
use std::path::{Path, PathBuf};

/// The open input files, identified by device and inode, so that links and other paths to them are recognised too.
#[derive(Debug, Default)]
pub struct Inputs(Vec<(PathBuf, Handle)>);

impl Inputs {
    /// Opens a file to read.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read.
    pub fn open(&mut self, path: &Path) -> Result<File> {
        let name = path.display().to_string();
        let file = File::open(path).map_err(|source| Error::io(&name, source))?;
        let handle = file.try_clone().and_then(Handle::from_file).map_err(|source| Error::io(&name, source))?;
        self.add(path.to_owned(), handle);
        Ok(file)
    }

    /// Standard input.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read.
    pub(crate) fn stdin(&mut self) -> Result<Stdin> {
        let handle = Handle::stdin().map_err(|source| Error::io("stdin", source))?;
        self.add("stdin".into(), handle);
        Ok(io::stdin())
    }

    /// The paths of the files that were opened.
    #[cfg(feature = "batch")]
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(|(path, _)| path.as_path())
    }

    /// Adds an input if it is a file. Terminals and sockets can safely be input and output at once.
    fn add(&mut self, name: PathBuf, handle: Handle) {
        if handle.as_file().metadata().is_ok_and(|metadata| metadata.is_file()) {
            self.0.push((name, handle));
        }
    }

    /// Returns an error if the output is one of the inputs.
    pub(super) fn check(&self, name: &str, output: &Handle) -> Result<()> {
        match self.0.iter().find(|(_, input)| input == output) {
            Some((input, _)) => {
                let input = input.display();
                Err(Error::value(name, format!("this is the input ‘{input}’: expected another file to write to")))
            }
            None => Ok(()),
        }
    }

    /// Returns an error if standard output goes to one of the inputs, as in `sprung presets show mine.toml >>
    /// mine.toml`.
    ///
    /// # Errors
    /// [`Error::Value`] that names the input.
    pub fn check_stdout(&self) -> Result<()> {
        // If standard output cannot be examined, it is not one of the inputs.
        Handle::stdout().map_or(Ok(()), |stdout| self.check("stdout", &stdout))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{Output, Target};
    use std::fs;

    #[cfg(unix)]
    #[test]
    fn no_way_leads_from_an_output_to_an_input() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::create_dir(path("folder")).unwrap();
        fs::write(path("a"), "input").unwrap();
        fs::write(path("b"), "other").unwrap();
        fs::hard_link(path("a"), path("hard")).unwrap();
        std::os::unix::fs::symlink(path("a"), path("soft")).unwrap();
        std::os::unix::fs::symlink("soft", path("softer")).unwrap();
        let mut inputs = Inputs::default();
        let open = inputs.open(&path("a")).unwrap();
        let descriptor = format!("/proc/self/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&open));
        let mut ways = vec![path("a"), path("hard"), path("soft"), path("softer"), path("folder/../a")];
        ways.extend(fs::exists(&descriptor).unwrap().then(|| descriptor.into()));
        for way in ways {
            for force in [false, true] {
                let error = Output::create(&Target::new(&way), force, &inputs).err().unwrap().to_string();
                let expected = format!(
                    "{}: this is the input ‘{}’: expected another file to write to",
                    way.display(),
                    path("a").display()
                );
                assert_eq!(error, expected);
            }
        }
        Output::create(&Target::new(path("b")), true, &inputs).unwrap().commit().unwrap();
        assert_eq!((fs::read(path("a")).unwrap(), fs::read(path("b")).unwrap()), (b"input".to_vec(), vec![]));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_read_and_written() {
        let mut inputs = Inputs::default();
        inputs.open(Path::new("/dev/null")).unwrap();
        assert!(Output::create(&Target::new("/dev/null"), false, &inputs).is_ok());
    }
}
