//! Renders the sound of one job, and makes its line of the manifest.

use super::jobs::Task;
use super::manifest::VERSION;
use super::template::key_of;
use super::{Batch, FileFormat};
use crate::analysis::digest::hexadecimal;
use crate::error::{Error, Result};
use crate::io::{Inputs, Output, Target, flac};
use crate::render::{Job, ModeLabel, NoteLabel, Progress, Report, to_labelled_wav};
use crate::request::quantity::decimal;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Number of files in a folder: few enough for every system and tool.
const FILES_OF_A_FOLDER: u64 = 1000;

/// Frames per block: too few to be shared between cores, since every core has jobs of its own.
const BLOCK: usize = 256;

/// The file of a job, relative to the batch's folder.
pub(super) fn file_of(number: u64, format: FileFormat) -> String {
    format!("{:04}/{number:07}.{}", number / FILES_OF_A_FOLDER, format.ending())
}

/// Renders a job into its file, and returns its line of the manifest. `check` is called often, and can end the work by
/// returning an error.
pub(super) fn make(task: &Task, batch: &Batch, check: &(dyn Fn() -> Result<()> + Sync)) -> Result<String> {
    let located = |error: Error| match error {
        Error::Value { name, message } => Error::format(&task.origin, format!("{}: {message}", key_of(&name))),
        Error::Interrupted => Error::Interrupted,
        error => Error::format(&task.origin, error.to_string()),
    };
    let mut request = task.drawn.request.clone();
    request.block = BLOCK;
    let (mut inputs, mut warnings) = (Inputs::default(), Vec::new());
    let prepared = request.prepare(&mut inputs, &mut |warning| warnings.push(warning.to_owned())).map_err(located)?;
    let job = prepared.job();
    let file = file_of(task.number, batch.format);
    let path = batch.folder.join(&file);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|source| Error::io(folder.display().to_string(), source))?;
    }
    // A resumed batch replaces files that an interrupted run left. A new batch replaces nothing.
    let mut output = Output::create(&Target::Path(path), batch.resume, &inputs).map_err(is_there)?;
    let render = |output: &mut Output| to_labelled_wav(&job, &prepared.delivery, output, |_: Progress| check());
    let (report, labels) = flac::write_as(batch.format, &mut output, render).map_err(located)?;
    let sha256 = sha256_of(output.stream()).map_err(|source| Error::io(output.name(), source))?;
    output.commit().map_err(is_there)?;
    Ok(line(task, &job, &file, &sha256, &report, &labels, &warnings))
}

/// Replaces the error for an existing file, since this command has no --force.
fn is_there(error: Error) -> Error {
    match error {
        Error::Exists { path } => {
            Error::value(path, "the file exists: add --resume if it is of this batch, or choose another folder")
        }
        error => error,
    }
}

/// The SHA-256 of a file, in hexadecimal.
fn sha256_of(file: &mut File) -> std::io::Result<String> {
    file.seek(SeekFrom::Start(0))?;
    let (mut hash, mut block) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hexadecimal(&hash.finalize())),
            read => hash.update(&block[..read]),
        }
    }
}

/// Whether a file exists and has this SHA-256.
pub(super) fn has_sha256(path: &Path, sha256: &str) -> bool {
    File::open(path).and_then(|mut file| sha256_of(&mut file)).is_ok_and(|found| found == sha256)
}

/// A line of the manifest. The order of the keys is fixed here, whatever features the JSON library is built with.
fn line(
    task: &Task,
    job: &Job,
    file: &str,
    sha256: &str,
    report: &Report,
    labels: &[NoteLabel],
    warnings: &[String],
) -> String {
    let mut fields = vec![
        ("number", json!(task.number)),
        ("version", json!(VERSION)),
        ("file", json!(file)),
        ("sha256", json!(sha256)),
        ("job", Value::Object(task.drawn.line.clone())),
        ("seed", json!(job.options.seed)),
        ("rate", json!(report.format.sample_rate)),
        ("channels", json!(report.format.channels)),
        ("frames", json!(report.frames)),
        ("peak_dbfs", decibels(report.peak_dbfs)),
        ("lufs", decibels(report.lufs)),
    ];
    if report.clipped > 0 {
        fields.push(("clipped", json!(report.clipped)));
    }
    if !warnings.is_empty() {
        fields.push(("warnings", json!(warnings)));
    }
    let fields: Vec<String> = fields.iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
    let notes: Vec<String> = labels.iter().map(|label| note(label, job)).collect();
    format!("{{{},\"notes\":[{}]}}", fields.join(","), notes.join(","))
}

/// A note with the labels of its modes.
fn note(label: &NoteLabel, job: &Job) -> String {
    let seconds = |frame: u64| json!(frame as f64 / f64::from(job.options.sample_rate));
    let fields = [
        ("channel", json!(label.channel + 1)),
        ("key", json!(f64::from(label.key) + f64::from(label.detune))),
        ("velocity", json!(decimal(label.velocity))),
        ("voice", json!(label.unison)),
        ("onset", seconds(label.onset)),
        ("free", seconds(label.free)),
    ];
    let fields: Vec<String> = fields.iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
    let mode = |mode: &ModeLabel| {
        let level = decibels(Some(mode.level_db).filter(|level| level.is_finite()));
        format!("{{\"frequency\":{},\"t60\":{},\"level_db\":{level}}}", json!(mode.frequency), json!(mode.t60))
    };
    let modes: Vec<String> = label.modes.iter().map(mode).collect();
    format!("{{{},\"modes\":[{}]}}", fields.join(","), modes.join(","))
}

/// A level rounded to thousandths of a decibel: meters use the system's mathematics functions, whose last digit can
/// differ.
fn decibels(level: Option<f64>) -> Value {
    level.map_or(Value::Null, |level| json!((level * 1000.0).round() / 1000.0))
}
