//! What can be wrong in a track, and where it continues, for error messages and for the repairs of lenient reading.

/// Maximum number of repairs, counted by kind and track. A file with more is probably no MIDI file.
pub(super) const MOST_REPAIRS: usize = 1000;

/// Why an event or a track cannot be read as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// The time before the event has more than four bytes.
    LongTime,
    /// The track ends inside the event.
    CutOff,
    /// The event has no status byte, and there is no running status.
    NoStatus,
    /// The status byte is not allowed in a file.
    Status(u8),
    /// A channel message has this data byte above 127. The message follows, with its status byte.
    Data(u8, [u8; 3]),
    /// A meta event is complete, but its contents are invalid.
    Meta(u8),
    /// The tempo is 0.
    Tempo,
    /// The file ends after so many bytes of the track’s.
    FileCutOff([usize; 2]),
}

/// A fault, and where the track continues.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Found<'a> {
    pub(super) fault: Fault,
    /// Ticks before the event, if they can be read.
    pub(super) delta: u32,
    /// Where the next event begins, if that is known. After [`Fault::LongTime`] it is the same event, whose time now has four bytes.
    pub(super) after: Option<&'a [u8]>,
}

impl Fault {
    /// Finds the fault of the event at the start of `bytes`. `running` is the running status.
    pub(super) fn find(bytes: &[u8], running: Option<u8>) -> Found<'_> {
        let Some((delta, event)) = variable_length(bytes) else {
            let fault = if bytes.len() < 4 { Self::CutOff } else { Self::LongTime };
            // Leading bytes of 0x80 are zeros.
            let zeros = bytes.iter().take_while(|byte| **byte == 0x80).count();
            let short = (1..=zeros).map(|start| &bytes[start..]).find(|rest| variable_length(rest).is_some());
            return Found { fault, delta: 0, after: short };
        };
        let found = |fault| Found { fault, delta, after: None };
        let Some((&status, rest)) = event.split_first() else { return found(Self::CutOff) };
        match status {
            0..0x80 => match running {
                None => found(Self::NoStatus),
                Some(running) => Self::of_data(running, event, delta),
            },
            0x80..0xf0 => Self::of_data(status, rest, delta),
            0xff => match rest.split_first().and_then(|(kind, rest)| Some((*kind, variable_length(rest)?))) {
                Some((kind, (length, data))) if data.len() >= length as usize => {
                    Found { fault: Self::Meta(kind), delta, after: Some(&data[length as usize..]) }
                }
                _ => found(Self::CutOff),
            },
            // The data of SysEx events are not checked, so only their length can be wrong.
            0xf0 | 0xf7 => found(Self::CutOff),
            // A message of a MIDI cable. Quarter frames and song selects have one data byte, song positions two (MIDI 1.0).
            _ => {
                let most = [0, 1, 2, 1].get(usize::from(status & 15)).copied().unwrap_or(0);
                let length = rest.iter().take(most).take_while(|byte| **byte < 0x80).count();
                Found { fault: Self::Status(status), delta, after: Some(&rest[length..]) }
            }
        }
    }

    fn of_data(status: u8, data: &[u8], delta: u32) -> Found<'_> {
        // Program changes and channel pressure have one data byte, the other channel messages two (MIDI 1.0).
        let length = if (0xc0..0xe0).contains(&status) { 1 } else { 2 };
        let above = data.iter().take(length).find(|byte| **byte > 127);
        match (above, data.split_at_checked(length)) {
            (Some(byte), Some((message, after))) => {
                let mut bytes = [status, 0, 0];
                bytes[1..=length].copy_from_slice(message);
                Found { fault: Self::Data(*byte, bytes), delta, after: Some(after) }
            }
            _ => Found { fault: Self::CutOff, delta, after: None },
        }
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::LongTime => write!(f, "the time before the event takes more than 4 bytes"),
            Self::CutOff => write!(f, "the track ends within an event"),
            Self::NoStatus => write!(f, "an event has no status byte, and a meta or SysEx event ends running status"),
            Self::Status(byte) => write!(f, "status byte {byte:#04x} has no place in a file"),
            Self::Data(byte, _) => write!(f, "expected a data byte of at most 0x7f, found {byte:#04x}"),
            Self::Meta(0x54) => write!(f, "the SMPTE offset is no time of day"),
            Self::Meta(kind) => write!(f, "meta event {kind:#04x} has contents that it cannot have"),
            Self::Tempo => write!(f, "the tempo is 0 µs per quarter note: expected at least 1"),
            Self::FileCutOff([there, promised]) => {
                write!(f, "the file is cut off: {there} of the track's {promised} bytes are there")
            }
        }
    }
}

/// Reads a number of variable length (at most four bytes). Returns it and the bytes after it; none if it is longer or
/// cut off.
fn variable_length(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let length = 1 + bytes.iter().take(4).position(|byte| *byte < 0x80)?;
    let (number, rest) = bytes.split_at(length);
    Some((number.iter().fold(0, |sum, byte| sum << 7 | u32::from(byte & 0x7f)), rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use midly::EventIter;

    #[test]
    fn each_fault_is_told_from_the_others() {
        for (bytes, running, fault, delta) in [
            (&[0x81][..], None, Fault::CutOff, 0),
            (&[0x81, 0x82, 0x83, 0x84, 0], None, Fault::LongTime, 0),
            (&[0x81, 0x02], None, Fault::CutOff, 130),
            (&[5, 60, 100], None, Fault::NoStatus, 5),
            (&[5, 60, 0x90], Some(0x91), Fault::Data(0x90, [0x91, 60, 0x90]), 5),
            (&[5, 60], Some(0x91), Fault::CutOff, 5),
            (&[0, 0xc3, 0x80], None, Fault::Data(0x80, [0xc3, 0x80, 0]), 0),
            (&[0, 0xc3], None, Fault::CutOff, 0),
            (&[0, 0xe3, 1], None, Fault::CutOff, 0),
            (&[7, 0xf5, 1], None, Fault::Status(0xf5), 7),
            (&[7, 0xf8], None, Fault::Status(0xf8), 7),
            (&[7, 0xf0, 3, 1, 2], None, Fault::CutOff, 7),
            (&[7, 0xff], None, Fault::CutOff, 7),
            (&[7, 0xff, 0x2f], None, Fault::CutOff, 7),
            (&[7, 0xff, 0x51, 3, 1, 2], None, Fault::CutOff, 7),
        ] {
            let mut events = EventIter::new(bytes);
            *events.running_status_mut() = running;
            assert!(events.next().is_some_and(|event| event.is_err()), "{bytes:?}: midly reads it");
            let found = Fault::find(bytes, running);
            assert_eq!((found.fault, found.delta), (fault, delta), "{bytes:?}");
        }
        for (bytes, after) in [
            (&[7, 0xf8, 1, 2][..], Some(&[1, 2][..])),
            (&[7, 0xf2, 1, 2, 3], Some(&[3])),
            (&[7, 0xf3, 0x90, 2], Some(&[0x90, 2])),
            (&[7, 0x93, 60, 200, 9], Some(&[9])),
            (&[7, 0x93, 200], None),
            (&[0x80, 0x80, 0x81, 0x80, 0x80, 0x05, 0x93], Some(&[0x81, 0x80, 0x80, 0x05, 0x93])),
            (&[0x81, 0x80, 0x80, 0x80, 0x05, 0x93], None),
        ] {
            assert_eq!(Fault::find(bytes, None).after, after, "{bytes:?}");
        }
        // A frame number of 30 at 24 frames per second, and a key signature without its mode.
        for meta in [&[7, 0xff, 0x54, 5, 0, 0, 0, 30, 0, 9, 9][..], &[7, 0xff, 0x59, 1, 3, 9, 9]] {
            assert!(EventIter::new(meta).next().is_some_and(|event| event.is_err()), "{meta:?}: midly reads it");
            let expected = Found { fault: Fault::Meta(meta[2]), delta: 7, after: Some(&[9, 9][..]) };
            assert_eq!(Fault::find(meta, None), expected);
        }
    }
}
