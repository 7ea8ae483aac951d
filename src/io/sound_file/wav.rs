//! Reads WAV files: RIFF, RF64 and BW64, integers of 8 to 32 bits and floats, complete or cut off; compressed ones are decoded.

use super::codecs;
use super::recording::{Recording, check_layout};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

/// Smallest length in bytes that programs write into a `data` chunk of unknown length, when they write to a pipe.
const UNKNOWN_LEN: u64 = 0x7fff_0000;
/// Value of the 32-bit sizes in an RF64 file, whose real sizes are in the `ds64` chunk (EBU Tech 3306).
const IN_DS64: u64 = 0xffff_ffff;

/// Codes of the `fmt ` chunk (Multimedia Programming Interface and Data Specifications 1.0, 1991, and mmreg.h).
const PCM: u16 = 1;
const FLOAT: u16 = 3;
const EXTENSIBLE: u16 = 0xfffe;
/// Those that Symphonia decodes, where they are not in an extensible chunk, and their names.
const DECODED: [(u16, &str); 4] = [(2, "MS ADPCM"), (6, "A-law"), (7, "µ-law"), (0x11, "IMA ADPCM")];

/// How the samples are stored.
#[derive(Clone, Copy, Debug)]
struct Layout {
    float: bool,
    channels: usize,
    sample_rate: u32,
    /// Bytes of a sample.
    width: usize,
    /// Bytes by which integers are longer than their bits.
    padding: usize,
}

/// Reads a file whose first bytes are those of a WAV file.
pub(super) fn read(file: File, name: &str) -> Result<Recording> {
    let mut input = BufReader::with_capacity(1 << 16, file);
    let wrong = |message: String| Error::format(name, message);
    let failed = |source| Error::io(name, source);
    input.seek(SeekFrom::Start(12)).map_err(failed)?;
    let (mut layout, mut long_data) = (None, None);
    loop {
        let mut head = [0; 8];
        if !fill(&mut input, &mut head).map_err(failed)? {
            let missing = if layout.is_none() { "‘fmt ’" } else { "‘data’" };
            return Err(wrong(format!("the WAV ends before its {missing} chunk: expected a whole file")));
        }
        let len = u64::from(u32::from_le_bytes([head[4], head[5], head[6], head[7]]));
        match &head[..4] {
            b"fmt " => {
                let body = beginning(&mut input, len).map_err(failed)?;
                if let Some((_, encoding)) = DECODED.iter().find(|(code, _)| Some(*code) == word(&body, 0)) {
                    input.rewind().map_err(failed)?;
                    return codecs::read(input.into_inner(), name, encoding);
                }
                layout = Some(Layout::parse(&body).map_err(wrong)?);
            }
            b"ds64" => {
                let body = beginning(&mut input, len).map_err(failed)?;
                long_data = body.get(8..16).and_then(|bytes| Some(u64::from_le_bytes(bytes.try_into().ok()?)));
            }
            b"data" => {
                let layout = layout.ok_or_else(|| wrong("the ‘fmt ’ chunk is missing before ‘data’".to_owned()))?;
                let len = if len == IN_DS64 { long_data.unwrap_or(len) } else { len };
                return layout.samples(&mut input, len).map_err(failed);
            }
            _ => skip(&mut input, len + len % 2).map_err(failed)?,
        }
    }
}

/// The 16-bit number at this position of a chunk.
fn word(body: &[u8], at: usize) -> Option<u16> {
    body.get(at..at + 2).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// The code of a `fmt ` chunk. In an extensible one, the first two bytes of the sub-format's GUID are it.
fn format_code(body: &[u8]) -> Option<u16> {
    let code = word(body, 0)?;
    if code == EXTENSIBLE { word(body, 24).or(Some(code)) } else { Some(code) }
}

/// The beginning of a chunk, as much as is ever read of one. The whole chunk is passed over.
fn beginning(input: &mut (impl Read + Seek), len: u64) -> std::io::Result<Vec<u8>> {
    let (mut body, kept) = (Vec::new(), len.min(64));
    input.take(kept).read_to_end(&mut body)?;
    skip(input, len - kept + len % 2)?;
    Ok(body)
}

fn skip(input: &mut impl Seek, len: u64) -> std::io::Result<()> {
    input.seek_relative(i64::try_from(len).unwrap_or(i64::MAX))
}

/// Fills the buffer. Returns false if the file ends before that.
fn fill(input: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<bool> {
    match input.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

impl Layout {
    /// Reads a `fmt ` chunk. The error says what would be right.
    fn parse(body: &[u8]) -> std::result::Result<Self, String> {
        let word = |at| word(body, at);
        let (Some(code), Some(channels), Some(align), Some(bits)) = (format_code(body), word(2), word(12), word(14))
        else {
            return Err("the ‘fmt ’ chunk is shorter than 16 bytes".to_owned());
        };
        let sample_rate = u32::from_le_bytes([body[4], body[5], body[6], body[7]]);
        check_layout(sample_rate, channels.into())?;
        let (least, width) = (usize::from(bits.div_ceil(8)), usize::from(align / channels));
        let known = match code {
            PCM => least > 0 && (least..=4).contains(&width),
            FLOAT => least == width && (width == 4 || width == 8),
            _ => return Err(format!("samples are coded as {}: expected PCM or floats", coding(code))),
        };
        if !known || align % channels != 0 {
            let stored = if code == FLOAT { "floats" } else { "integers" };
            return Err(format!(
                "samples are {stored} of {bits} bits, {align} bytes a frame of {channels} channels: expected integers of \
                 8, 16, 24 or 32 bits, or floats of 32 or 64"
            ));
        }
        Ok(Self { float: code == FLOAT, channels: channels.into(), sample_rate, width, padding: width - least })
    }

    /// Reads a `data` chunk of `len` bytes, or as much of it as the file has.
    fn samples(self, input: &mut BufReader<impl Read + Seek>, len: u64) -> std::io::Result<Recording> {
        let mut warnings = Vec::new();
        let frame_len = self.width * self.channels;
        // A program that was interrupted leaves a length of 0, and samples follow. After a really empty chunk, the name
        // of the next chunk or the end of the file follows.
        let left_open = len == 0 && {
            let mut next = [0; 4];
            let here = input.stream_position()?;
            let more = fill(input, &mut next)?;
            input.seek(SeekFrom::Start(here))?;
            more && !next.iter().all(u8::is_ascii_graphic)
        };
        let unknown = left_open || (UNKNOWN_LEN..=IN_DS64).contains(&len);
        let mut data = input.take(if left_open { u64::MAX } else { len });
        let mut channels = vec![Vec::new(); self.channels];
        let mut frame = vec![0; frame_len];
        while fill(&mut data, &mut frame)? {
            for (channel, bytes) in channels.iter_mut().zip(frame.chunks(self.width)) {
                channel.push(self.decode(bytes));
            }
        }
        if self.padding > 0 {
            raise(&mut channels, self.width, self.padding);
        }
        let (found, told) = (channels[0].len() as u64, len / frame_len as u64);
        if left_open {
            warnings.push(format!("the length was never written: read {found} frames, to the end of the file"));
        } else if found < told && !unknown {
            warnings.push(format!("the file breaks off: {found} of {told} frames are there"));
        }
        let kind = if self.float { "float" } else { "PCM" };
        let encoding = format!("{}-bit {kind}", 8 * self.width);
        Ok(Recording { sample_rate: self.sample_rate, channels, encoding, warnings })
    }

    fn decode(self, bytes: &[u8]) -> f32 {
        match (self.float, bytes) {
            (true, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (true, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32,
            // 8 bits are unsigned, and wider samples are signed.
            (false, &[a]) => (f32::from(a) - 128.0) / 128.0,
            (false, bytes) => {
                let mut word = [0; 4];
                word[4 - bytes.len()..].copy_from_slice(bytes);
                i32::from_le_bytes(word) as f32 / 2_147_483_648.0
            }
            (true, _) => unreachable!("floats have 4 or 8 bytes"),
        }
    }
}

/// Raises padded integers to full scale if their padding is above them, as some programs write it, and not below. They are padded
/// below if the lowest bytes are always 0, and also if a number needs the highest ones.
fn raise(channels: &mut [Vec<f32>], width: usize, padding: usize) {
    let gain = (1_u32 << (8 * padding)) as f32;
    let (lowest, full) = (gain / (1_u64 << (8 * width - 1)) as f32, 1.0 / gain);
    let is_below = channels.iter().flatten().all(|sample| sample % lowest == 0.0);
    if !is_below && channels.iter().flatten().all(|sample| (-full..full).contains(sample)) {
        channels.iter_mut().flatten().for_each(|sample| *sample *= gain);
    }
}

/// The name of an encoding that cannot be read.
fn coding(code: u16) -> String {
    let known = DECODED.into_iter().chain([(0x55, "MP3")]).find(|(known, _)| *known == code);
    known.map_or_else(|| format!("format {code}"), |(_, name)| name.to_owned())
}
