//! Makes a sound from recordings on a thread of its own: reads them and fits a preset as `sprung fit` does.

use crate::editor::background::{Background, Progress};
use crate::files;
use sprung::analysis::fit::{Settings, Take, VELOCITY, fit, take_velocities_from_names};
use sprung::internals::text::printable;
use sprung::io::sound_file;
use sprung::preset::Preset;
use sprung::{Error, Result};
use std::path::{Path, PathBuf};

/// Largest file that is read, in bytes: the fit would use little of a longer one, and reading cannot be cancelled.
const LARGEST: u64 = 32 << 20;

/// The result of a fit.
pub(super) struct Done {
    pub(super) preset: Preset,
    /// Warnings, and a summary of the sound.
    pub(super) message: String,
}

/// Begins to fit a sound to recordings of one instrument.
///
/// # Errors
/// A message, if the system has no thread for it.
pub(super) fn start(paths: Vec<PathBuf>) -> std::result::Result<Background<Done>, String> {
    let name = match &paths[..] {
        [] => return Err("no recording".to_owned()),
        [path] => file_name(path),
        [first, more @ ..] => format!("{} and {} more", file_name(first), more.len()),
    };
    Background::start(name, move |progress| fitted(&paths, progress))
}

fn fitted(paths: &[PathBuf], progress: &Progress) -> Result<Done> {
    let mut remarks = Vec::new();
    let mut takes = Vec::new();
    for path in paths {
        if progress.is_cancelled() {
            return Err(Error::Interrupted);
        }
        let take = read(path)?;
        remarks.extend(take.recording.warnings.iter().map(|warning| format!("{}: {warning}", take.name)));
        takes.push(take);
    }
    if let Some(velocities) = take_velocities_from_names(&mut takes) {
        remarks.push(format!("velocities {velocities} by the names"));
    }
    let fitted = fit(&takes, &Settings::default(), &mut |share| progress.report(share))?;
    remarks.extend(fitted.warnings.iter().cloned());
    remarks.push(fitted.summary());
    let stem = paths.first().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
    Ok(Done { preset: fitted.named(&stem, &takes), message: remarks.join("; ") })
}

fn read(path: &Path) -> Result<Take> {
    let name = file_name(path);
    let failed = |source| Error::io(name.as_str(), source);
    let file = files::open(path, &name, "a recording")?;
    let size = file.metadata().map_err(failed)?.len();
    if size > LARGEST {
        let [size, largest] = [size, LARGEST].map(|bytes| bytes as f64 / f64::from(1 << 20));
        let message = format!("it has {size:.0} MB: expected at most {largest:.0}; cut out a single stroke");
        return Err(Error::format(&name, message));
    }
    let recording = sound_file::read(file, &name)?;
    Ok(Take { name, recording, key: None, velocity: VELOCITY })
}

/// The last part of a path, safe to show.
fn file_name(path: &Path) -> String {
    printable(&path.file_name().unwrap_or_default().to_string_lossy()).into_owned()
}
