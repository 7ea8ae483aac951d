//! Reads AIFF, FLAC, Ogg Vorbis and MP3, which Symphonia decodes.

use super::recording::{Recording, check_layout};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{Cursor, ErrorKind, Read, Seek, SeekFrom};
use symphonia::core::codecs::audio::AudioDecoderOptions;
use symphonia::core::errors::Error as Fault;
use symphonia::core::formats::probe::Hint;
use symphonia::core::formats::{FormatOptions, TrackType};
use symphonia::core::io::{MediaSource, MediaSourceStream};
use symphonia::core::meta::MetadataOptions;

/// Length in bytes of the longest frame of MPEG audio, 320 kbit/s at 8 kHz.
const MOST_FRAME: usize = 2881;

/// Reads a file whose first bytes are those of `format`.
pub(super) fn read(file: File, name: &str, format: &str) -> Result<Recording> {
    let wrong = |fault: Fault| match fault {
        Fault::IoError(source) if source.kind() != ErrorKind::UnexpectedEof => Error::io(name, source),
        Fault::IoError(_) => Error::format(name, format!("the file ends within its header: expected a whole {format}")),
        fault => Error::format(name, format!("{fault}: expected {format}")),
    };
    let mut warnings = Vec::new();
    let again = file.try_clone().map_err(|source| Error::io(name, source))?;
    let source: Box<dyn MediaSource> = match format {
        "AIFF" => match mended_aiff(&file).map_err(|source| Error::io(name, source))? {
            Some(mended) => {
                warnings.push("the file breaks off: what is there was read".to_owned());
                Box::new(Cursor::new(mended))
            }
            None => Box::new(file),
        },
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
                found.sample_rate = buffer.spec().rate();
                buffer.copy_to_vecs_planar(&mut planes);
                found.channels.resize_with(planes.len().max(found.channels.len()), Vec::new);
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

/// The contents of an AIFF file that is cut off within its samples, with its sizes corrected, since the decoder would
/// refuse it otherwise. `None` for a complete file, and for one that is cut off before its samples.
fn mended_aiff(mut file: &File) -> std::io::Result<Option<Vec<u8>>> {
    let len = file.metadata()?.len();
    let (mut at, mut common) = (12, None);
    let mut found = None;
    while at + 8 <= len {
        let mut head = [0; 8];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut head)?;
        let size = u64::from(u32::from_be_bytes([head[4], head[5], head[6], head[7]]));
        match &head[..4] {
            b"COMM" => common = Some(at as usize + 8),
            // Eight bytes of offset and block size come before the samples.
            b"SSND" if at + 8 + size > len => found = common.filter(|_| at + 16 <= len).map(|common| (common, at)),
            _ => (),
        }
        at += 8 + size + size % 2;
    }
    file.seek(SeekFrom::Start(0))?;
    let Some((common, samples)) = found else { return Ok(None) };
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
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
    Ok(Some(bytes))
}
