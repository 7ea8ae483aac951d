//! Between hound and the output: completes the header of a WAV that cannot be gone back to, and pads odd chunks.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom, Write};

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

/// Makes the file that a broken-off writer left a whole one: ends it after its last whole frame and sets the sizes of
/// the RIFF and data chunks. Gives the number of frames. `frame_len` is even, so that no padding is needed.
pub(super) fn salvage(file: &mut File, frame_len: u64) -> Result<u64> {
    let len = file.metadata()?.len().min(u64::from(u32::MAX));
    let mut header = [0; 256];
    file.seek(SeekFrom::Start(0))?;
    let header_len = file.read(&mut header)?;
    let data = header[..header_len].windows(4).position(|id| id == b"data").map(|id| id as u64 + 8);
    let Some(data) = data.filter(|data| *data <= len) else {
        return Err(Error::new(ErrorKind::UnexpectedEof, "nothing was recorded"));
    };
    let frames = (len - data) / frame_len;
    let data_len = frames * frame_len;
    file.set_len(data + data_len)?;
    for (position, size) in [(4, data + data_len - RIFF_PREAMBLE), (data - 4, data_len)] {
        file.seek(SeekFrom::Start(position))?;
        file.write_all(&(size as u32).to_le_bytes())?;
    }
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{SampleFormat, WavFormat, WavWriter};

    #[test]
    fn a_file_that_broke_off_is_whole_up_to_there() {
        let format = WavFormat { sample_rate: 8000, channels: 2, samples: SampleFormat::Float32 };
        let mut whole = std::io::Cursor::new(Vec::new());
        let mut writer = WavWriter::new(&mut whole, "x", format, None, None).unwrap();
        writer.write(&[1.0, 2.0, 3.0], &[-1.0, -2.0, -3.0]).unwrap();
        writer.finish().unwrap();
        let mut whole = whole.into_inner();
        let data = whole.len() - 24;
        // As it is before the sizes are written.
        whole[4..8].fill(0);
        whole[data - 4..data].fill(0);
        for (len, expected) in
            [(whole.len(), Some(3)), (data + 15, Some(1)), (data, Some(0)), (data - 1, None), (0, None)]
        {
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(&whole[..len]).unwrap();
            let frames = salvage(&mut file, 8).ok();
            assert_eq!(frames, expected, "{len} bytes");
            file.seek(SeekFrom::Start(0)).unwrap();
            if let Some(frames) = frames {
                let samples: Vec<f32> =
                    hound::WavReader::new(file).unwrap().into_samples().map(|sample| sample.unwrap()).collect();
                assert_eq!(samples, [1.0, -1.0, 2.0, -2.0, 3.0, -3.0][..2 * frames as usize]);
            }
        }
    }
}
