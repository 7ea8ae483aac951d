//! Between hound and the output: completes the header of a WAV that cannot be gone back to, and pads odd chunks.

use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};

/// Bytes of `RIFF` and its size, which the size itself does not count.
const RIFF_PREAMBLE: u64 = 8;

/// Takes what hound writes (a header with empty sizes, samples, then a seek back and the sizes) and sees to it that
///
/// - with a known length, the header goes out with its sizes filled in and nothing is written after the samples,
///   so that the output need not seek;
/// - a data chunk of odd length is followed by a zero byte that only the RIFF size counts, which the format asks for
///   (Multimedia Programming Interface and Data Specifications 1.0, 1991) and hound leaves out.
pub(super) struct RiffSink<W> {
    inner: W,
    /// Length of the data chunk in bytes, where it is known beforehand.
    data_len: Option<u32>,
    header_len: u64,
    position: u64,
    /// Where hound's next correction goes, once it has sought back.
    patching: Option<u64>,
    padding: u32,
}

impl<W: Write + Seek> RiffSink<W> {
    pub(super) fn new(inner: W, data_len: Option<u32>) -> Self {
        Self { inner, data_len, header_len: 0, position: 0, patching: None, padding: 0 }
    }

    fn write_header(&mut self, header: &[u8]) -> Result<()> {
        self.header_len = header.len() as u64;
        let Some(data_len) = self.data_len else {
            return self.inner.write_all(header);
        };
        let mut header = header.to_vec();
        let riff_len = header.len() as u32 - RIFF_PREAMBLE as u32 + data_len + data_len % 2;
        let data_field = header.len() - 4;
        header[4..8].copy_from_slice(&riff_len.to_le_bytes());
        header[data_field..].copy_from_slice(&data_len.to_le_bytes());
        self.inner.write_all(&header)
    }

    /// hound's size fields: at 4 that of the RIFF chunk, else that of the data.
    fn write_patch(&mut self, offset: u64, bytes: &[u8]) -> Result<()> {
        if self.data_len.is_some() {
            return Ok(());
        }
        let mut field: [u8; 4] = bytes.try_into().map_err(|_| Error::from(ErrorKind::InvalidInput))?;
        if offset == 4 {
            field = (u32::from_le_bytes(field) + self.padding).to_le_bytes();
        }
        self.inner.seek(SeekFrom::Start(offset))?;
        self.inner.write_all(&field)
    }
}

impl<W: Write + Seek> Write for RiffSink<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        if let Some(offset) = self.patching {
            self.write_patch(offset, bytes)?;
            self.patching = Some(offset + bytes.len() as u64);
            return Ok(bytes.len());
        }
        let written = if self.position == 0 {
            // hound writes its header at once.
            self.write_header(bytes)?;
            bytes.len()
        } else {
            self.inner.write(bytes)?
        };
        self.position += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> Result<()> {
        self.inner.flush()
    }
}

impl<W: Write + Seek> Seek for RiffSink<W> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let SeekFrom::Start(offset) = to else {
            return Err(ErrorKind::Unsupported.into());
        };
        if self.patching.is_none() && (self.position - self.header_len) % 2 == 1 {
            self.inner.write_all(&[0])?;
            self.padding = 1;
        }
        self.patching = Some(offset);
        Ok(offset)
    }
}
