//! Checks the free disk space before an output is written.

use super::output::Output;
use crate::error::{Error, Result};
use std::io::{self, ErrorKind};

impl Output {
    /// Returns an error if there is not enough free space for this many bytes. Does nothing if that is unknown.
    ///
    /// # Errors
    /// [`Error::Io`] with both sizes.
    pub(crate) fn check_room(&self, bytes: u64) -> Result<()> {
        let Some(room) = self.temporary().and_then(|path| fs4::available_space(path).ok()) else { return Ok(()) };
        if bytes <= room {
            return Ok(());
        }
        let message = format!("{bytes} bytes do not fit: {room} are free there");
        Err(Error::io(self.name(), io::Error::new(ErrorKind::StorageFull, message)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{Inputs, Target};

    #[test]
    fn what_does_not_fit_is_refused_with_the_numbers() {
        let directory = tempfile::tempdir().unwrap();
        let output = Output::create(&Target::Path(directory.path().join("a.wav")), false, &Inputs::default()).unwrap();
        output.check_room(1).unwrap();
        let error = output.check_room(u64::MAX).unwrap_err().to_string();
        assert!(error.contains("a.wav: 18446744073709551615 bytes do not fit: "), "{error}");
    }
}
