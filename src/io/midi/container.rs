//! The chunks of a MIDI file: its header and its tracks' bytes, in a plain file or inside a RIFF file (RMID).

use super::fault::MOST_REPAIRS;
use midly::Header;

/// The chunks of a MIDI file. The contents of the tracks have not been examined.
pub(super) struct Container<'a> {
    pub(super) header: Header,
    /// The tracks, at most as many as the header declares.
    pub(super) tracks: Vec<Track<'a>>,
    /// Descriptions of the repairs.
    pub(super) repairs: Vec<String>,
}

/// The bytes of a track.
pub(super) struct Track<'a> {
    pub(super) bytes: &'a [u8],
    /// Position of the first byte in the file.
    pub(super) start: usize,
    /// Number of bytes according to the header. If the file is cut off, `bytes` has fewer.
    pub(super) promised: usize,
}

/// Other kinds of files that users may confuse with MIDI files, by their first bytes.
const OTHERS: [(&[u8], &str); 9] = [
    (b"RF64", "a WAV sound file"),
    (b"RIFF", "a RIFF file without a song"),
    (b"FORM", "an AIFF sound file"),
    (b"fLaC", "a FLAC sound file"),
    (b"OggS", "an Ogg sound file"),
    (b"ID3", "an MP3 sound file"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"<", "an XML file"),
];

impl<'a> Container<'a> {
    /// Splits a file into its chunks. If `lenient` is true, wrong sizes and track counts are repaired.
    pub(super) fn open(file: &'a [u8], lenient: bool) -> Result<Self, String> {
        let mut repairs = Vec::new();
        let mut repair = |fault: String, remedy: &str| {
            if !lenient || repairs.len() >= MOST_REPAIRS {
                return Err(fault);
            }
            repairs.push(format!("{fault}: {remedy}"));
            Ok(())
        };
        let song = song_in(file, &mut repair)?;
        let mut at = file.len() - song.len();
        let header_chunk = next_chunk(file, &mut at, u32::from_be_bytes).filter(|chunk| chunk.promised >= 6);
        let (header, declared) = match header_chunk {
            Some(chunk) if chunk.bytes.len() == chunk.promised => read_header(song, chunk.bytes, &mut repair)?,
            _ => return Err("not a whole MIDI file: it breaks off in its header".to_owned()),
        };
        // If a file declares no tracks, its writer was interrupted before it could fill in the number.
        let wanted = if declared == 0 { usize::MAX } else { declared };
        let mut tracks = Vec::new();
        while tracks.len() < wanted {
            let rest = &file[at.min(file.len())..];
            if lenient && !starts_chunk(rest) {
                let Some(junk) = find(rest, b"MTrk") else { break };
                repair(
                    format!("after track {}, byte {at}: {junk} bytes belong to no track", tracks.len()),
                    "left out",
                )?;
                at += junk;
            }
            let Some(chunk) = next_chunk(file, &mut at, u32::from_be_bytes) else { break };
            match &chunk.id {
                b"MTrk" => {
                    let mut track = chunk.into_track();
                    if lenient && let Some(length) = real_length(&file[track.start..], track.promised) {
                        let (number, said) = (tracks.len() + 1, track.promised);
                        let fault = format!("track {number} says that it has {said} bytes");
                        repair(fault, &format!("it has {length} up to its end mark"))?;
                        (track.promised, at) = (length, track.start + length);
                        track.bytes = &file[track.start..at];
                    }
                    tracks.push(track);
                }
                b"MThd" => return Err(format!("a second header after track {}: expected one song", tracks.len())),
                _ => {}
            }
        }
        if tracks.len() != declared || declared == 0 {
            let fault = format!("not a whole MIDI file: it declares {declared} tracks and has {}", tracks.len());
            if tracks.is_empty() {
                return Err(fault);
            }
            repair(fault, "these are read")?;
        }
        Ok(Self { header, tracks, repairs })
    }
}

/// The bytes of the song in the file, from its header on.
fn song_in<'a>(
    file: &'a [u8],
    repair: &mut impl FnMut(String, &str) -> Result<(), String>,
) -> Result<&'a [u8], String> {
    if file.starts_with(b"MThd") {
        return Ok(file);
    }
    if !(file.starts_with(b"RIFF") && file.get(8..12) == Some(b"RMID")) {
        return Err(format!("{}: expected a Standard MIDI File (.mid)", describe(file)));
    }
    if file[4..8] == [0; 4] {
        repair("an RMID file of size 0".to_owned(), "read to its end")?;
    }
    let mut at = 12;
    while let Some(chunk) = next_chunk(file, &mut at, u32::from_le_bytes) {
        if &chunk.id == b"data" {
            let start = chunk.start;
            if chunk.promised == 0 {
                repair("an RMID file whose song has the size 0".to_owned(), "read to its end")?;
            }
            // The end of the song follows from its own chunks.
            let song = &file[start..];
            return if song.starts_with(b"MThd") { Ok(song) } else { Err("an RMID file without a song".to_owned()) };
        }
        // Chunks of RIFF files start at even positions.
        at += chunk.promised % 2;
    }
    Err("an RMID file without a song".to_owned())
}

/// Describes a file that contains no song.
fn describe(file: &[u8]) -> String {
    if file.is_empty() {
        return "an empty file".to_owned();
    }
    if file.starts_with(b"RIFF") && file.get(8..12) == Some(b"WAVE") {
        return "a WAV sound file".to_owned();
    }
    if let Some((_, name)) = OTHERS.iter().find(|(start, _)| file.starts_with(start)) {
        return (*name).to_owned();
    }
    let start = &file[..file.len().min(512)];
    let text = start.utf8_chunks().next().is_some_and(|chunk| {
        let valid = chunk.valid();
        // The last character may be incomplete.
        valid.len() + 4 > start.len() && !valid.chars().any(|c| c.is_control() && !c.is_whitespace())
    });
    if text { "a text file".to_owned() } else { "not a MIDI file".to_owned() }
}

/// Bytes of meta event 2F, which ends a track.
const END_MARK: &[u8] = &[0xff, 0x2f, 0];

/// Whether a chunk starts here: a track, or another one that is all there.
fn starts_chunk(file: &[u8]) -> bool {
    next_chunk(file, &mut 0, u32::from_be_bytes)
        .is_some_and(|chunk| &chunk.id == b"MTrk" || chunk.id.is_ascii() && chunk.promised == chunk.bytes.len())
}

/// The length of the track at the start of `file`, if it is not the promised one.
fn real_length(file: &[u8], promised: usize) -> Option<usize> {
    let (inside, after) = file.split_at(promised.min(file.len()));
    let swallowed = find(inside, &[END_MARK, b"MTrk"].concat());
    let goes_on = !after.is_empty() && !starts_chunk(after) && !inside.ends_with(END_MARK);
    let end = swallowed.or_else(|| {
        if !goes_on {
            return None;
        }
        let own = inside.len() + find(after, b"MTrk").unwrap_or(after.len());
        // The end mark may begin inside.
        let from = inside.len().saturating_sub(END_MARK.len() - 1);
        find(&file[from..own], END_MARK).map(|end| from + end)
    });
    end.map(|end| end + END_MARK.len())
}

fn find(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes.windows(pattern.len()).position(|window| window == pattern)
}

fn read_header(
    song: &[u8],
    data: &[u8],
    repair: &mut impl FnMut(String, &str) -> Result<(), String>,
) -> Result<(Header, usize), String> {
    let mut chunk = song[..8 + data.len()].to_vec();
    match u16::from_be_bytes([data[0], data[1]]) {
        0..=2 => {}
        kind => {
            repair(format!("a MIDI file of type {kind}: expected type 0, 1 or 2"), "read as type 1")?;
            chunk[8..10].copy_from_slice(&[0, 1]);
        }
    }
    // midly negates this byte as an `i8`, which overflows for 0x80.
    let frames_per_second = data[4].wrapping_neg();
    if data[4] >= 0x80 && !matches!(frames_per_second, 24 | 25 | 29 | 30) {
        let expected = "expected 24, 25, 29 or 30 SMPTE frames per second";
        return Err(format!("not a valid MIDI file: {expected}, found {frames_per_second}"));
    }
    let (header, tracks) = midly::parse(&chunk).map_err(|error| error.kind().message().to_owned())?;
    Ok((header, tracks.size_hint().0))
}

struct Chunk<'a> {
    id: [u8; 4],
    bytes: &'a [u8],
    start: usize,
    promised: usize,
}

impl<'a> Chunk<'a> {
    fn into_track(self) -> Track<'a> {
        Track { bytes: self.bytes, start: self.start, promised: self.promised }
    }
}

/// The chunk at position `at`, which then moves to the next chunk. None if the file ends before the chunk's contents.
fn next_chunk<'a>(file: &'a [u8], at: &mut usize, length: fn([u8; 4]) -> u32) -> Option<Chunk<'a>> {
    let (id, rest) = file.get(*at..)?.split_first_chunk::<4>()?;
    let (size, rest) = rest.split_first_chunk::<4>()?;
    let (start, promised) = (*at + 8, length(*size) as usize);
    let bytes = &rest[..promised.min(rest.len())];
    *at = start.saturating_add(promised);
    Some(Chunk { id: *id, bytes, start, promised })
}
