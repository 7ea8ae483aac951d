//! Reads AIFF, FLAC, Ogg Vorbis, MP3 and compressed WAV, which Symphonia decodes.

use super::recording::{Recording, check_layout};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Cursor, ErrorKind, Read, Seek, SeekFrom};
use std::thread;
use symphonia::core::codecs::audio::AudioDecoderOptions;
use symphonia::core::errors::Error as Fault;
use symphonia::core::formats::probe::Hint;
use symphonia::core::formats::{FormatOptions, TrackType};
use symphonia::core::io::{MediaSource, MediaSourceStream, ReadOnlySource};
use symphonia::core::meta::MetadataOptions;

/// Length in bytes of the longest frame of MPEG audio, 320 kbit/s at 8 kHz.
const MOST_FRAME: usize = 2881;

/// Name of the thread that decodes. Symphonia panics at some damaged files; `read` makes an error of it, and whoever shows panics
/// can leave it out.
pub const DECODER: &str = "sound decoder";

/// Reads a file whose next bytes are those of `format`.
pub(super) fn read(file: File, name: &str, format: &str) -> Result<Recording> {
    thread::scope(|scope| {
        let decoder =
            thread::Builder::new().name(DECODER.to_owned()).spawn_scoped(scope, || decode(file, name, format));
        let damaged = || Error::format(name, format!("no decoder can read this, so it is damaged: expected {format}"));
        decoder.map_err(|source| Error::io(name, source))?.join().unwrap_or_else(|_| Err(damaged()))
    })
}

fn decode(file: File, name: &str, format: &str) -> Result<Recording> {
    let wrong = |fault: Fault| match fault {
        Fault::IoError(source) if source.kind() != ErrorKind::UnexpectedEof => Error::io(name, source),
        Fault::IoError(_) => Error::format(name, format!("the file ends within its header: expected a whole {format}")),
        fault => Error::format(name, format!("{fault}: expected {format}")),
    };
    let mut warnings = Vec::new();
    let again = file.try_clone().map_err(|source| Error::io(name, source))?;
    let source: Box<dyn MediaSource> = match format {
        "AIFF" => match mended_aiff(&file).map_err(|source| Error::io(name, source))? {
            Some((mended, warning)) => {
                warnings.push(warning.to_owned());
                Box::new(Cursor::new(mended))
            }
            None => Box::new(file),
        },
        "FLAC" => bare_flac(file).map_err(|source| Error::io(name, source))?,
        _ => Box::new(file),
    };
    let source = MediaSourceStream::new(source, Default::default());
    let (format_options, tag_options) = (FormatOptions::default(), MetadataOptions::default());
    let mut container =
        symphonia::default::get_probe().probe(&Hint::new(), source, format_options, tag_options).map_err(wrong)?;
    let track = container.default_track(TrackType::Audio);
    let parameters = track.and_then(|track| Some((track.id, track.codec_params.as_ref()?.audio()?.clone())));
    let Some((track, parameters)) = parameters else {
        return Err(Error::format(name, format!("there is no sound in this {format}: expected a track of it")));
    };
    let channels = parameters.channels.as_ref().map_or(1, |channels| channels.count());
    // Some containers leave the rate to the sound itself; `super::read` checks it again.
    if let Some(rate) = parameters.sample_rate {
        check_layout(rate, channels).map_err(|message| Error::format(name, message))?;
    }
    let mut decoder = symphonia::default::get_codecs()
        .make_audio_decoder(&parameters, &AudioDecoderOptions::default())
        .map_err(wrong)?;
    let mut found = Recording {
        sample_rate: parameters.sample_rate.unwrap_or(0),
        channels: Vec::new(),
        encoding: format.to_owned(),
        warnings,
    };
    let (mut planes, mut faults, mut last) = (Vec::<Vec<f32>>::new(), 0, None);
    loop {
        let packet = match container.next_packet() {
            Ok(Some(packet)) => packet,
            Ok(None) => break,
            Err(fault) => {
                found.warnings.push(format!("the file breaks off after {} frames: {fault}", found.frames()));
                break;
            }
        };
        if packet.track_id != track {
            continue;
        }
        match decoder.decode(&packet) {
            Ok(buffer) => {
                let (rate, frames) = (buffer.spec().rate(), found.frames());
                buffer.copy_to_vecs_planar(&mut planes);
                if frames > 0 && (rate, planes.len()) != (found.sample_rate, found.channels.len()) {
                    found.warnings.push(format!(
                        "from {rate} Hz and {} channels on, frame {frames}, the rest was left out: one sound has one rate and \
                         number of channels",
                        planes.len()
                    ));
                    break;
                }
                found.sample_rate = rate;
                found.channels.resize_with(planes.len(), Vec::new);
                found.channels.iter_mut().zip(&planes).for_each(|(channel, plane)| channel.extend(plane));
            }
            Err(Fault::DecodeError(_)) => faults += 1,
            Err(fault) => {
                found.warnings.push(format!("the file breaks off after {} frames: {fault}", found.frames()));
                break;
            }
        }
        last = Some(packet.data);
    }
    if faults > 0 {
        found.warnings.push(format!("{faults} packets cannot be decoded and were left out"));
    }
    let frames = found.channels.iter().map(Vec::len).min().unwrap_or(0);
    found.channels.iter_mut().for_each(|channel| channel.truncate(frames));
    if let Some(told) = track_frames(&*container, track).filter(|told| *told > frames as u64)
        && found.warnings.is_empty()
    {
        found.warnings.push(format!("the file breaks off: {frames} of {told} frames are there"));
    }
    if let Some(last) = last.filter(|_| format == "MP3" && found.warnings.is_empty())
        && goes_on(&again, &last).map_err(|source| Error::io(name, source))?
    {
        found.warnings.push(format!("the file breaks off after {frames} frames, within a block"));
    }
    Ok(found)
}

/// Whether another frame of MPEG audio begins after the last complete one. An MP3 file does not declare its length, so
/// this shows whether it is cut off.
fn goes_on(mut file: &File, last: &[u8]) -> std::io::Result<bool> {
    let len = file.metadata()?.len();
    file.seek(SeekFrom::Start(len.saturating_sub((last.len() + MOST_FRAME) as u64)))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let end = (last.len()..=tail.len()).rev().find(|end| tail[end - last.len()..*end] == *last);
    Ok(end.is_some_and(|end| matches!(tail[end..], [0xff]) || matches!(tail[end..], [0xff, sync, ..] if sync >= 0xe0)))
}

/// Number of frames that the container declares for the track.
fn track_frames(container: &dyn symphonia::core::formats::FormatReader, track: u32) -> Option<u64> {
    container.tracks().iter().find(|other| other.id == track)?.num_frames
}

/// A FLAC with only the description of the stream of its metadata: the decoder would refuse the whole file for a fault in what the
/// sound does not need.
fn bare_flac(file: File) -> std::io::Result<Box<dyn MediaSource>> {
    /// Length in bytes of the description of the stream, and the shortest block that it may have (RFC 9639, §8.2).
    const DESCRIPTION: usize = 34;
    const LEAST_BLOCK: [u8; 2] = [0, 16];
    let mut file = BufReader::new(file);
    let start = file.stream_position()?;
    file.seek_relative(4)?;
    let mut description = None;
    loop {
        let mut head = [0; 4];
        if file.read_exact(&mut head).is_err() {
            break;
        }
        let size = u32::from_be_bytes([0, head[1], head[2], head[3]]) as usize;
        if head[0] & 0x7f == 0 && size == DESCRIPTION {
            let mut block = [0; DESCRIPTION];
            if file.read_exact(&mut block).is_err() {
                break;
            }
            description = Some(block);
        } else {
            file.seek_relative(size as i64)?;
        }
        if head[0] & 0x80 != 0 {
            break;
        }
    }
    let mut frame = [0; 2];
    let (Some(mut description), Ok(())) = (description, file.read_exact(&mut frame)) else {
        file.seek(SeekFrom::Start(start))?;
        return Ok(Box::new(ReadOnlySource::new(file)));
    };
    // The shortest block is as long as the longest if all are alike, as bit 0 of a frame’s second byte says (§9.1).
    let least = if frame[1] & 1 == 0 { [description[2], description[3]] } else { LEAST_BLOCK };
    description[..2].copy_from_slice(&least);
    let beginning = [b"fLaC\x80\0\0\x22", &description[..], &frame].concat();
    Ok(Box::new(ReadOnlySource::new(Cursor::new(beginning).chain(file))))
}

/// The contents of an AIFF file whose sizes the decoder would refuse, with its sizes corrected, and what was wrong: it is cut off
/// within its samples, or says that it is longer than it is. `None` for other files, and for one that is cut off before its samples.
fn mended_aiff(mut file: &File) -> std::io::Result<Option<(Vec<u8>, &'static str)>> {
    let len = file.metadata()?.len();
    let (mut at, mut common) = (12, None);
    let mut found = None;
    let mut head = [0; 8];
    file.seek(SeekFrom::Start(0))?;
    let is_too_long = file.read_exact(&mut head).is_ok() && form_size(&head) + 8 > len;
    while at + 8 <= len {
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut head)?;
        let size = form_size(&head);
        match &head[..4] {
            b"COMM" => common = Some(at as usize + 8),
            // Eight bytes of offset and block size come before the samples.
            b"SSND" if at + 8 + size > len => found = common.filter(|_| at + 16 <= len).map(|common| (common, at)),
            _ => (),
        }
        at += 8 + size + size % 2;
    }
    file.seek(SeekFrom::Start(0))?;
    if !is_too_long && found.is_none() {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let Some((common, samples)) = found else {
        // A file that is longer than its size can say is left as it is.
        let Ok(whole) = u32::try_from(bytes.len() - 8) else { return Ok(None) };
        bytes[4..8].copy_from_slice(&whole.to_be_bytes());
        return Ok(Some((bytes, "the file says that it is longer than it is")));
    };
    let word = |at: usize| u64::from(u16::from_be_bytes([bytes[at], bytes[at + 1]]));
    let frame_len = word(common) * word(common + 6).div_ceil(8);
    let data_len = bytes.len() as u64 - samples - 16;
    let frames = data_len.checked_div(frame_len).unwrap_or(0);
    let samples = samples as usize;
    bytes.truncate(samples + 16 + (frames * frame_len) as usize);
    let (whole, chunk) = (bytes.len() as u32 - 8, (bytes.len() - samples - 8) as u32);
    bytes[4..8].copy_from_slice(&whole.to_be_bytes());
    bytes[samples + 4..samples + 8].copy_from_slice(&chunk.to_be_bytes());
    bytes[common + 2..common + 6].copy_from_slice(&(frames as u32).to_be_bytes());
    Ok(Some((bytes, "the file breaks off: what is there was read")))
}

/// The size in a chunk’s first eight bytes.
fn form_size(head: &[u8; 8]) -> u64 {
    u64::from(u32::from_be_bytes([head[4], head[5], head[6], head[7]]))
}
