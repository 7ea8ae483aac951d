//! Tests of the MIDI reader, on files that midly's writer and a few bytes by hand make.

use super::*;
use midly::{Fps, Smf, Timing, TrackEvent};
use proptest::prelude::*;

const BEATS: Timing = Timing::Metrical(midly::num::u15::new(480));

fn midi(delta: u32, channel: u8, message: MidiMessage) -> TrackEvent<'static> {
    TrackEvent { delta: delta.into(), kind: TrackEventKind::Midi { channel: channel.into(), message } }
}

fn meta(delta: u32, message: MetaMessage<'static>) -> TrackEvent<'static> {
    TrackEvent { delta: delta.into(), kind: TrackEventKind::Meta(message) }
}

fn on(key: u8, velocity: u8) -> MidiMessage {
    MidiMessage::NoteOn { key: key.into(), vel: velocity.into() }
}

fn file(format: Format, timing: Timing, tracks: &[Vec<TrackEvent<'static>>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    Smf { header: Header::new(format, timing), tracks: tracks.to_vec() }.write(&mut bytes).unwrap();
    bytes
}

fn song(timing: Timing, tracks: &[Vec<TrackEvent<'static>>]) -> Song {
    let format = if tracks.len() == 1 { Format::SingleTrack } else { Format::Parallel };
    Song::parse(&file(format, timing, tracks), "test").unwrap()
}

#[test]
fn every_message_becomes_an_event() {
    use EventKind as E;
    use MidiMessage as M;
    let u = |value: u8| midly::num::u7::new(value);
    let bend = |value: u16| M::PitchBend { bend: PitchBend(value.into()) };
    for (message, expected) in [
        (on(60, 127), E::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: -1 }),
        (on(60, 0), E::NoteOff { key: 60, velocity: 0.5, id: -1 }),
        (M::NoteOff { key: u(60), vel: u(127) }, E::NoteOff { key: 60, velocity: 1.0, id: -1 }),
        (M::Aftertouch { key: u(1), vel: u(127) }, E::PolyPressure { key: 1, pressure: 1.0 }),
        (M::ChannelAftertouch { vel: u(0) }, E::ChannelPressure(0.0)),
        (M::Controller { controller: u(64), value: u(127) }, E::Control { controller: 64, value: 1.0 }),
        (M::ProgramChange { program: u(5) }, E::Program(5)),
        (bend(0), E::PitchBend(-1.0)),
        (bend(8192), E::PitchBend(0.0)),
        (bend(16383), E::PitchBend(1.0)),
    ] {
        let song = song(BEATS, &[vec![midi(480, 9, message)]]);
        assert_eq!(song.events, [SongEvent { seconds: 0.5, channel: 9, kind: expected }]);
    }
}

#[test]
fn tempo_changes_hold_across_tracks() {
    let tempo = vec![meta(0, MetaMessage::Tempo(1_000_000.into())), meta(480, MetaMessage::Tempo(250_000.into()))];
    let notes = vec![midi(0, 0, on(60, 1)), midi(480, 0, on(61, 1)), midi(480, 0, on(62, 1))];
    // The tempo track comes last: what counts is when, not where.
    let song = song(BEATS, &[notes, tempo]);
    let (tempos, notes): (Vec<SongEvent>, Vec<_>) =
        song.events.iter().partition(|event| matches!(event.kind, EventKind::Tempo(_)));
    assert_eq!(notes.iter().map(|event| event.seconds).collect::<Vec<_>>(), [0.0, 1.0, 1.25]);
    assert_eq!(notes.iter().map(|event| event.frame(44_100.0)).collect::<Vec<_>>(), [0, 44_100, 55_125]);
    // The engine hears of each tempo, before the notes of its time.
    assert_eq!(
        tempos.iter().map(|event| (event.seconds, event.kind)).collect::<Vec<_>>(),
        [(0.0, EventKind::Tempo(60.0)), (1.0, EventKind::Tempo(240.0))]
    );
    assert_eq!([song.events[0], song.events[2]], tempos[..]);
}

#[test]
fn events_of_one_time_keep_the_order_of_tracks_and_events() {
    let track = |keys: [u8; 2]| keys.map(|key| midi(0, 0, on(key, 1))).to_vec();
    let mut late = track([1, 2]);
    late[0].delta = 5.into();
    let song = song(BEATS, &[late, track([4, 3]), track([6, 5])]);
    let keys: Vec<u8> = song
        .events
        .iter()
        .map(|event| match event.kind {
            EventKind::NoteOn { key, .. } => key,
            _ => unreachable!(),
        })
        .collect();
    assert_eq!(keys, [4, 3, 6, 5, 1, 2]);
}

#[test]
fn the_end_of_the_longest_track_is_the_length() {
    let short = vec![midi(0, 0, on(60, 1)), meta(480, MetaMessage::EndOfTrack), midi(9, 0, on(61, 1))];
    let long = vec![meta(960, MetaMessage::EndOfTrack)];
    let song = song(BEATS, &[short, long]);
    assert_eq!((song.seconds, song.events.len()), (1.0, 1));
    assert_eq!(song.frames(22_050.0), 22_050);
}

#[test]
fn smpte_time_and_running_status_are_read() {
    let song = song(Timing::Timecode(Fps::Fps25, 40), &[vec![midi(1000, 0, on(60, 1))]]);
    assert_eq!(song.seconds, 1.0);
    let mut bytes = b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk\0\0\0\x0b".to_vec();
    bytes.extend([0, 0x91, 60, 1, 96, 61, 1, 0, 0xff, 0x2f, 0]);
    let song = Song::parse(&bytes, "x").unwrap();
    assert_eq!(
        song.events.iter().map(|event| (event.seconds, event.channel)).collect::<Vec<_>>(),
        [(0.0, 1), (0.5, 1)]
    );
}

#[test]
fn what_follows_the_declared_tracks_is_not_looked_at() {
    let mut bytes = file(Format::SingleTrack, BEATS, &[vec![midi(0, 0, on(60, 1))]]);
    bytes.extend(b"\0\0\0 rubbish");
    assert_eq!(Song::parse(&bytes, "x").unwrap().events.len(), 1);
}

#[test]
fn unfit_files_are_refused_with_a_reason() {
    let note = vec![midi(0, 0, on(60, 1)), meta(9, MetaMessage::EndOfTrack)];
    let whole = file(Format::Parallel, BEATS, &[note.clone(), note.clone()]);
    let with = |at: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        bytes
    };
    let zero_tempo = file(Format::SingleTrack, BEATS, &[vec![meta(7, MetaMessage::Tempo(0.into()))]]);
    for (bytes, expected) in [
        (vec![], "not a midi file"),
        (b"RIFF\x04\0\0\0WAVE".to_vec(), "not an rmid riff file"),
        (b"MThd".to_vec(), "invalid midi header"),
        (whole[..12].to_vec(), "invalid midi header"),
        (whole[..14].to_vec(), "declares 2 tracks and has 0"),
        (with(11, 3), "declares 3 tracks and has 2"),
        (with(11, 0), "declares 0 tracks and has 0"),
        (with(9, 2), "a MIDI file of type 2 (independent patterns): expected type 0 or 1"),
        (with(9, 7), "invalid midi header"),
        (with(13, 0).iter().enumerate().map(|(i, b)| if i == 12 { 0 } else { *b }).collect(), "the division is 0"),
        (with(12, 0x80), "found 128"),
        (with(12, 0x90), "invalid midi header"),
        (with(23, 0xf5), "track 1: event 1 (after tick 0) is malformed"),
        (whole[..whole.len() - 1].to_vec(), "is cut off or damaged"),
        (zero_tempo, "the tempo at tick 7 is 0"),
    ] {
        let error = Song::parse(&bytes, "song.mid").unwrap_err().to_string();
        assert!(error.starts_with("song.mid: ") && error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn every_truncation_is_an_error() {
    let track = vec![midi(0, 0, on(60, 1)), midi(300, 0, on(60, 0)), meta(9, MetaMessage::EndOfTrack)];
    let whole = file(Format::Parallel, BEATS, &[track.clone(), track]);
    for length in 0..whole.len() {
        assert!(Song::parse(&whole[..length], "x").is_err(), "{length} of {}", whole.len());
    }
    assert!(Song::parse(&whole, "x").is_ok());
}

#[test]
fn an_endless_file_is_refused_without_reading_on() {
    let error = Song::read(std::io::repeat(b'M'), "x").unwrap_err().to_string();
    assert_eq!(error, "x: too large for a MIDI file: expected at most 64 MiB");
}

#[test]
fn a_song_longer_than_time_has_a_length() {
    let far: Vec<_> = (0..1000).map(|_| midi(0x0fff_ffff, 0, on(60, 1))).collect();
    let song = song(Timing::Metrical(1.into()), &[far]);
    assert_eq!(song.frames(48_000.0), (f64::from(0x0fff_ffff) * 1000.0 * 24_000.0) as u64);
}

proptest! {
    #[test]
    fn random_bytes_never_panic(
        bytes in proptest::collection::vec(any::<u8>(), 0..200),
        header in proptest::array::uniform6(any::<u8>()),
        at in any::<proptest::sample::Index>(),
        byte in any::<u8>(),
    ) {
        let _ = Song::parse(&bytes, "x");
        let mut framed = b"MThd\0\0\0\x06".to_vec();
        framed.extend(header);
        let _ = Song::parse(&framed, "x");
        framed[8..14].copy_from_slice(&[0, 1, 0, 1, 0, 96]);
        framed.extend(b"MTrk");
        framed.extend((bytes.len() as u32).to_be_bytes());
        framed.extend(&bytes);
        let _ = Song::parse(&framed, "x");
        // One wrong byte in a good file.
        let mut good = file(Format::Parallel, BEATS, &[vec![midi(3, 0, on(60, 1)), meta(1, MetaMessage::Tempo(7.into()))]]);
        let at = at.index(good.len());
        good[at] = byte;
        let _ = Song::parse(&good, "x");
    }
}

#[test]
fn messages_from_a_port_are_read_one_by_one() {
    for (bytes, expected) in [
        (&[0x91, 60, 127][..], Some((1, EventKind::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: -1 }))),
        (&[0x9f, 60, 0], Some((15, EventKind::NoteOff { key: 60, velocity: 0.5, id: -1 }))),
        (&[0xe0, 0, 64], Some((0, EventKind::PitchBend(0.0)))),
        (&[0xc2, 7], Some((2, EventKind::Program(7)))),
        (&[0xf8], None),
        (&[0xf0, 1, 2, 0xf7], None),
        (&[0x90, 60], None),
        (&[60, 60], None),
        (&[], None),
    ] {
        assert_eq!(parse_message(bytes), expected, "{bytes:?}");
    }
}
