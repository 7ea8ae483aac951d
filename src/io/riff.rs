//! The header of a WAV file: RIFF up to 4 GiB, RF64 for longer files.
//!
//! hound makes the chunk `fmt ` and stores the samples, both by its public functions; the sizes are ours.

use super::output::Output;
use super::wav_format::WavFormat;
use crate::engine::synth::check_rate;
use crate::error::Error;
use std::fs::File;
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};

/// Length of `RIFF` and its size field in bytes. The size field does not include them.
const RIFF_PREAMBLE: u64 = 8;

/// Length in bytes of the contents of a `ds64` chunk without a table: the sizes of RIFF and data, the number of frames,
/// and the length of the table.
const DS64_LEN: u32 = 3 * 8 + 4;

/// Value of the 32-bit size fields in an RF64 file: the sizes are in the `ds64` chunk.
const IN_DS64: u32 = u32::MAX;

/// Maximum length of a file in bytes, since file systems use signed 64-bit offsets.
const MAX_LEN: u64 = i64::MAX as u64;

impl WavFormat {
    /// Length in bytes of a file with this many frames.
    ///
    /// # Errors
    /// [`Error::Value`] if a file cannot be that long, or if the rate is not one of the engine's.
    pub(crate) fn file_len(&self, frames: u64) -> crate::Result<u64> {
        check_rate(self.sample_rate).map_err(|message| Error::value("rate", message))?;
        let header_len = header(self, 0).len() as u64;
        let data_len = frames.checked_mul(self.frame_len()).filter(|len| *len < MAX_LEN - header_len);
        let data_len =
            data_len.ok_or_else(|| Error::value("length", format!("{frames} frames are more than a file can have")))?;
        Ok(header_len + data_len + padding(data_len))
    }
}

/// The header of a file with this many frames. Its length does not depend on their number, so that it can be written
/// again when the number is known: a RIFF file has a `JUNK` chunk in the place where an RF64 file has its 64-bit sizes
/// (`ds64`), as EBU Tech 3306 recommends.
pub(super) fn header(format: &WavFormat, frames: u64) -> Vec<u8> {
    header_with(format, frames, 0)
}

/// The header of a file that has further chunks after the samples, of so many bytes together.
pub(super) fn header_with(format: &WavFormat, frames: u64, further: u64) -> Vec<u8> {
    // hound writes `RIFF`, its size, `WAVE`, the chunk `fmt `, `data` and its size.
    let plain = format.spec().into_header_for_infinite_file();
    let (riff, chunks) = plain.split_at(12);
    let chunks = &chunks[..chunks.len() - 4];

    let data_len = frames * format.frame_len();
    let header_len = plain.len() as u64 + 8 + u64::from(DS64_LEN);
    let riff_len = header_len - RIFF_PREAMBLE + data_len + padding(data_len) + further;
    let rf64 = riff_len >= u64::from(IN_DS64);
    let size = |len: u64| if rf64 { IN_DS64 } else { len as u32 };

    let mut header = Vec::with_capacity(header_len as usize);
    header.extend(if rf64 { b"RF64" } else { &riff[..4] });
    header.extend(size(riff_len).to_le_bytes());
    header.extend(&riff[8..]);
    header.extend(if rf64 { b"ds64" } else { b"JUNK" });
    header.extend(DS64_LEN.to_le_bytes());
    for value in [riff_len, data_len, frames] {
        header.extend(if rf64 { value } else { 0 }.to_le_bytes());
    }
    header.extend(0u32.to_le_bytes());
    header.extend(chunks);
    header.extend(size(data_len).to_le_bytes());
    header
}

/// Number of bytes after the samples: a chunk of odd length is followed by a zero byte, which only the RIFF size
/// includes (Multimedia Programming Interface and Data Specifications 1.0, 1991).
pub(super) fn padding(data_len: u64) -> u64 {
    data_len % 2
}

impl Output {
    /// Completes a WAV file after writing has failed, so that the part on the disk can be played: cuts it after its
    /// last complete frame and corrects the header, which needs no additional disk space. Returns the number of frames.
    ///
    /// # Errors
    /// [`Error::Io`] if the output is not a file, cannot be changed, or has no complete header.
    pub(crate) fn salvage_wav(&mut self, format: WavFormat) -> crate::Result<u64> {
        let salvaged = match self.is_seekable() {
            true => salvage(self.stream(), &format),
            false => Err(ErrorKind::NotSeekable.into()),
        };
        salvaged.map_err(|source| Error::io(self.name(), source))
    }
}

/// Completes a file after writing has failed: cuts it after its last complete frame and writes the header for that
/// length. Returns the number of frames.
fn salvage(file: &mut File, format: &WavFormat) -> io::Result<u64> {
    let header_len = header(format, 0).len() as u64;
    let Some(data_len) = file.metadata()?.len().checked_sub(header_len) else {
        return Err(io::Error::new(ErrorKind::UnexpectedEof, "nothing was recorded"));
    };
    let frames = data_len / format.frame_len();
    let end = header_len + frames * format.frame_len();
    file.set_len(end)?;
    file.set_len(end + padding(end - header_len))?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(&header(format, frames))?;
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{SampleFormat, WavWriter};
    use std::io::Cursor;

    const FORMAT: WavFormat = WavFormat { sample_rate: 48_000, channels: 2, samples: SampleFormat::Float32 };

    fn number(bytes: &[u8], at: usize, len: usize) -> u64 {
        bytes[at..at + len].iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte))
    }

    #[test]
    fn sizes_beyond_32_bits_are_in_the_ds64_chunk() {
        let header_len = header(&FORMAT, 0).len() as u64;
        // The longest file with a RIFF header: the largest value of the size field is reserved for RF64.
        let longest = (u64::from(u32::MAX) - 1 - (header_len - 8)) / 8;
        let riff = header(&FORMAT, longest);
        assert_eq!((&riff[..4], &riff[12..16]), (&b"RIFF"[..], &b"JUNK"[..]));
        assert_eq!(number(&riff, 4, 4), header_len - 8 + longest * 8);
        assert_eq!(number(&riff, riff.len() - 4, 4), longest * 8);
        assert!(riff[20..48].iter().all(|byte| *byte == 0));

        for frames in [longest + 1, 10_000_000_000] {
            let rf64 = header(&FORMAT, frames);
            assert_eq!((&rf64[..4], &rf64[8..16]), (&b"RF64"[..], &b"WAVEds64"[..]));
            assert_eq!((number(&rf64, 4, 4), number(&rf64, rf64.len() - 4, 4)), (0xffff_ffff, 0xffff_ffff));
            assert_eq!(number(&rf64, 16, 4), 28);
            let sizes = [20, 28, 36].map(|at| number(&rf64, at, 8));
            assert_eq!(sizes, [header_len - 8 + frames * 8, frames * 8, frames]);
            assert_eq!(number(&rf64, 44, 4), 0, "there is no table");
            assert_eq!((rf64.len(), &rf64[48..rf64.len() - 4]), (riff.len(), &riff[48..riff.len() - 4]));
        }
    }

    #[test]
    fn a_file_that_broke_off_is_whole_up_to_there() {
        let mono = WavFormat { sample_rate: 8000, channels: 1, samples: SampleFormat::Int24 };
        for format in [FORMAT, mono] {
            let write = |frames: usize| {
                let mut whole = Cursor::new(Vec::new());
                let mut writer = WavWriter::new(&mut whole, "x", format, None, None).unwrap();
                let signal = &[0.25, 0.5, 0.75][..frames];
                writer.write(signal, signal).unwrap();
                writer.finish().unwrap();
                whole.into_inner()
            };
            let (mut broken, data) = (write(3), header(&format, 0).len());
            // The header before the sizes are known.
            broken[..data].copy_from_slice(&header(&format, 0));
            let frame_len = format.frame_len() as usize;
            for (len, expected) in [
                (data + 3 * frame_len, Some(3)),
                (data + 2 * frame_len - 1, Some(1)),
                (data, Some(0)),
                (data - 1, None),
                (0, None),
            ] {
                let mut file = tempfile::tempfile().unwrap();
                file.write_all(&broken[..len]).unwrap();
                assert_eq!(salvage(&mut file, &format).ok(), expected, "{len} bytes");
                let Some(frames) = expected else { continue };
                let mut salvaged = Vec::new();
                file.seek(SeekFrom::Start(0)).unwrap();
                std::io::Read::read_to_end(&mut file, &mut salvaged).unwrap();
                assert!(salvaged == write(frames as usize), "{len} bytes");
            }
        }
    }
}
