//! The figure of a rendering: waveform, spectrogram, and the modes of a single note.

use crate::figure::drawn;
use sprung::Result;
use sprung::analysis::figure::{DrawnMode, modes_of};
use sprung::params::Param;
use sprung::render::Job;
use sprung::units::{frequency_from_key, parse_key};

/// Draws a job's sound in `format`, before the level is changed for the file.
pub(super) fn draw(notes: &[String], title: &str, job: &Job, format: &str) -> Result<Vec<u8>> {
    let modes = match notes {
        [note] => modes(job, note),
        _ => Vec::new(),
    };
    drawn(job, title, &modes, format)
}

/// The modes of the sound that plays a note; none if the key is invalid or has no sound.
fn modes(job: &Job, note: &str) -> Vec<DrawnMode> {
    let a4_hz = f64::from(job.kit.values().get(Param::Tuning));
    let Ok(key) = parse_key(note, a4_hz) else { return Vec::new() };
    let Some(pad) = job.kit.pad(key.round().clamp(0.0, 127.0) as u8) else { return Vec::new() };
    let Some(sound) = job.kit.sounds().get(pad.sound) else { return Vec::new() };
    modes_of(sound.patch(), frequency_from_key(pad.pitch.unwrap_or(key), a4_hz))
}
