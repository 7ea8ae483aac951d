//! Recordings: their modes, presets fitted to them, and the difference of two of them.

use crate::failure::{check_signals, raised, told, warn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprung::analysis::Comparison;
use sprung::analysis::fit::{Family, Settings as FitSettings, Take, fit as fitted_to};
use sprung::analysis::modes::{self, Mode, Strike};
use sprung::internals::files::Inputs;
use sprung::internals::request::{quantity, recording};
use sprung::io::sound_file::Recording;
use sprung::units::parse_key;
use std::path::{Path, PathBuf};

/// A sound: a file, or a rate and the samples of each channel.
#[derive(FromPyObject)]
pub(crate) enum Sound {
    File(PathBuf),
    Samples(f64, Vec<Vec<f32>>),
}

impl Sound {
    /// The samples, and the name for error messages.
    fn read(self, warnings: &mut Vec<String>) -> sprung::Result<(Recording, String)> {
        match self {
            Self::File(path) => {
                recording(Path::new(&path), &mut Inputs::default(), &mut |warning| warnings.push(warning.to_owned()))
            }
            Self::Samples(rate, channels) => {
                let (encoding, name) = ("array".to_owned(), "the array");
                let sample_rate = quantity::rate(&rate.to_string());
                let sample_rate = sample_rate.map_err(|message| sprung::Error::value("rate", message))?;
                let sound = Recording { sample_rate, channels, encoding, warnings: Vec::new() };
                sound.check_layout(name)?;
                sound.check_finite(name)?;
                Ok((sound, name.to_owned()))
            }
        }
    }
}

fn mode<'py>(py: Python<'py>, mode: &Mode) -> PyResult<Bound<'py, PyDict>> {
    let (entry, uncertainty) = (PyDict::new(py), PyDict::new(py));
    let rows = [
        ("frequency", mode.frequency, mode.uncertainty.frequency),
        ("t60", mode.t60, mode.uncertainty.t60),
        ("level_db", mode.level_db, mode.uncertainty.level_db),
        ("phase", mode.phase, mode.uncertainty.phase),
    ];
    for (name, value, deviation) in rows {
        entry.set_item(name, value)?;
        uncertainty.set_item(name, deviation)?;
    }
    entry.set_item("snr_db", mode.snr_db)?;
    entry.set_item("uncertainty", uncertainty)?;
    Ok(entry)
}

fn strike<'py>(py: Python<'py>, strike: &Strike) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("onset", strike.onset)?;
    entry.set_item("seconds", strike.seconds)?;
    entry.set_item("damped", strike.damped)?;
    entry.set_item("residual_db", strike.residual_db)?;
    entry.set_item("modes", strike.modes.iter().map(|one| mode(py, one)).collect::<PyResult<Vec<_>>>()?)?;
    Ok(entry)
}

/// Checks a number of modes by the limits of the command line.
fn check_most_modes(most_modes: usize, limit: usize) -> PyResult<()> {
    let is_within = (1..=limit).contains(&most_modes);
    if is_within { Ok(()) } else { Err(told(format!("most_modes: {most_modes}: expected 1 to {limit}"))) }
}

/// Splits a recording into the modes of its strikes.
#[pyfunction]
pub(crate) fn analyze(
    py: Python<'_>,
    sound: Sound,
    most_modes: usize,
    all_strikes: bool,
) -> PyResult<Vec<Bound<'_, PyDict>>> {
    check_most_modes(most_modes, 1000)?;
    let mut warnings = Vec::new();
    let found = py.detach(|| {
        let (sound, name) = sound.read(&mut warnings)?;
        let settings = modes::Settings { most_modes, all_strikes, ..modes::Settings::default() };
        let found =
            modes::modes(&sound.channels, sound.sample_rate.into(), &settings, &mut |_| check_signals().is_ok());
        found.map_err(|error| match error {
            sprung::Error::Value { message, .. } => sprung::Error::format(name, message),
            error => error,
        })
    });
    let found = found.map_err(raised)?;
    warnings.extend(found.warnings);
    warn(py, &warnings)?;
    found.strikes.iter().map(|one| strike(py, one)).collect()
}

/// Fits a preset to recordings. Returns the text of its file, and its distance from each recording in dB.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    sounds: Vec<(Sound, Option<String>, f64)>,
    name: String,
    body: &str,
    most_modes: usize,
) -> PyResult<(String, Vec<f64>)> {
    check_most_modes(most_modes, 256)?;
    if name.trim().is_empty() {
        return Err(told("name: it is blank: expected a name".to_owned()));
    }
    let family = Family::ALL.iter().find(|(name, _)| *name == body).map(|(_, family)| *family);
    let family = family.ok_or_else(|| {
        let expected: Vec<&str> = Family::ALL.iter().map(|(name, _)| *name).collect();
        told(format!("body: ‘{body}’ is none: expected one of {}", expected.join(", ")))
    })?;
    let mut warnings = Vec::new();
    let fitted = py.detach(|| {
        let mut takes = Vec::new();
        for (sound, note, velocity) in sounds {
            // The same range as on the command line.
            if !(1.0..=127.0).contains(&velocity) {
                return Err(sprung::Error::value("velocity", format!("{velocity}: expected from 1 to 127")));
            }
            let (recording, name) = sound.read(&mut warnings)?;
            let key = note.map(|note| parse_key(&note, 440.0)).transpose();
            let key = key.map_err(|message| sprung::Error::value("note", message))?;
            takes.push(Take { name, recording, key, velocity });
        }
        let settings = FitSettings { most_modes, family };
        let fitted = fitted_to(&takes, &settings, &mut |_| check_signals().is_ok())?;
        Ok((fitted.named(&name, &takes).to_toml(), fitted.distances, fitted.warnings))
    });
    let (preset, distances, found) = fitted.map_err(raised)?;
    warnings.extend(found);
    warn(py, &warnings)?;
    Ok((preset, distances))
}

/// The differences of two sounds with the same rate; none if they are equal to the bit.
#[pyfunction]
pub(crate) fn diff(py: Python<'_>, expected: Sound, actual: Sound) -> PyResult<Option<Bound<'_, PyDict>>> {
    let mut warnings = Vec::new();
    let found = py.detach(|| {
        let (expected, _) = expected.read(&mut warnings)?;
        let (actual, name) = actual.read(&mut warnings)?;
        if expected.sample_rate != actual.sample_rate {
            let rates = [actual.sample_rate, expected.sample_rate];
            return Err(sprung::Error::format(name, format!("its rate is {} Hz: expected {} Hz", rates[0], rates[1])));
        }
        Ok(Comparison::of(&expected.channels, &actual.channels, expected.sample_rate.into()))
    });
    let found = found.map_err(raised)?;
    warn(py, &warnings)?;
    let Some(found) = found else { return Ok(None) };
    let entry = PyDict::new(py);
    entry.set_item("first_frame", found.difference.first_frame)?;
    entry.set_item("worst_frame", found.difference.worst_frame)?;
    entry.set_item("worst_dbfs", found.difference.worst_dbfs)?;
    entry.set_item("rms_dbfs", found.difference.rms_dbfs)?;
    entry.set_item("frames", found.difference.frames)?;
    Ok(Some(entry))
}
