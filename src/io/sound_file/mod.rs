//! Reads sound files: WAV of every kind, AIFF, FLAC, Ogg Vorbis and MP3.

pub(crate) mod codecs;
mod recording;
mod resample;
mod wav;

pub use recording::Recording;
pub use resample::resampled;

use crate::error::{Error, Result};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

/// Number of bytes at the start of a file that identify its format.
const MAGIC_LEN: usize = 36;
/// Length in bytes of the header of an ID3v2 tag.
const TAG_LEN: u64 = 10;

/// Reads a sound file to its end; `name` is its name in errors. A file that is cut off is read up to its end, with a
/// line in [`Recording::warnings`].
///
/// # Errors
/// [`Error::Io`] if it cannot be read; [`Error::Format`], with what would be right, if it is no sound file, of a format
/// that is not read, without a single frame, or as [`Recording::check_layout`].
pub fn read(mut file: File, name: &str) -> Result<Recording> {
    let failed = |source| Error::io(name, source);
    let mut magic = start(&mut file).map_err(failed)?;
    if magic.is_empty() {
        return Err(Error::format(name, "the file is empty: expected a sound file"));
    }
    let mut place = 0;
    // Some programs tag a FLAC as if it were an MP3.
    if let Some(len) = tag_len(&magic) {
        file.seek(SeekFrom::Start(len)).map_err(failed)?;
        let below = start(&mut file).map_err(failed)?;
        if below.starts_with(b"fLaC") {
            (place, magic) = (len, below);
        }
    }
    file.seek(SeekFrom::Start(place)).map_err(failed)?;
    let recording = match Format::of(&magic) {
        Some(Format::Wav) => wav::read(file, name),
        Some(Format::Coded(format)) => codecs::read(file, name, format),
        Some(Format::Opus) => Err(Error::format(name, format!("this is Opus: expected {FORMATS}"))),
        None => Err(Error::format(name, format!("this is not a sound file: expected {FORMATS}"))),
    }?;
    if recording.frames() == 0 {
        return Err(Error::format(name, "there is no sound in the file: expected at least one frame"));
    }
    recording.check_layout(name)?;
    Ok(recording)
}

const FORMATS: &str = "WAV, AIFF, FLAC, Ogg Vorbis or MP3";

/// The next bytes of a file, at most [`MAGIC_LEN`].
fn start(file: &mut File) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(MAGIC_LEN);
    file.take(MAGIC_LEN as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The length in bytes of the ID3v2 tag that a file starts with. Its size has 7 bits a byte, and leaves out header and footer
/// (ID3v2.4, §3.1).
fn tag_len(magic: &[u8]) -> Option<u64> {
    let tag = magic.strip_prefix(b"ID3")?;
    let (flags, size) = (tag.get(2)?, tag.get(3..7)?);
    let size = size.iter().fold(0, |size, byte| size << 7 | u64::from(byte & 0x7f));
    Some(size + TAG_LEN * if flags & 0x10 != 0 { 2 } else { 1 })
}

/// The format that the first bytes of a file indicate.
#[derive(Debug, PartialEq)]
enum Format {
    Wav,
    /// A format that needs a decoder, by its name.
    Coded(&'static str),
    /// Ogg with Opus, which nothing here decodes.
    Opus,
}

impl Format {
    fn of(magic: &[u8]) -> Option<Self> {
        let at = |start: usize, bytes: &[u8]| magic.get(start..start + bytes.len()) == Some(bytes);
        let form = |container: &[u8], kind: &[u8]| at(0, container) && at(8, kind);
        // An MPEG audio frame begins with eleven one bits, and its layer is not 0.
        let mpeg = || magic.len() > 1 && magic[0] == 0xff && magic[1] & 0xe0 == 0xe0 && magic[1] & 0x06 != 0;
        if [&b"RIFF"[..], b"RF64", b"BW64"].iter().any(|container| form(container, b"WAVE")) {
            Some(Self::Wav)
        } else if form(b"FORM", b"AIFF") || form(b"FORM", b"AIFC") {
            Some(Self::Coded("AIFF"))
        } else if at(0, b"fLaC") {
            Some(Self::Coded("FLAC"))
        } else if at(0, b"OggS") && at(28, b"OpusHead") {
            Some(Self::Opus)
        } else if at(0, b"OggS") {
            Some(Self::Coded("Ogg"))
        } else if at(0, b"ID3") || mpeg() {
            Some(Self::Coded("MP3"))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
