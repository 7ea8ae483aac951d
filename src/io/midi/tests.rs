//! Tests of the MIDI reader with files from midly's writer and with files written by hand.

use super::limits::MAX_EVENTS;
use super::*;
use midly::{Format, Fps, Header, MetaMessage, MidiMessage, PitchBend, Smf, Timing, TrackEvent, TrackEventKind};
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
        (on(60, 127), E::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: None }),
        (on(60, 0), E::NoteOff { key: 60, velocity: 0.5, id: None }),
        (M::NoteOff { key: u(60), vel: u(127) }, E::NoteOff { key: 60, velocity: 1.0, id: None }),
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
    // The tempo track comes last: only the ticks matter, not the order of tracks.
    let song = song(BEATS, &[notes, tempo]);
    let (tempos, notes): (Vec<SongEvent>, Vec<_>) =
        song.events.iter().partition(|event| matches!(event.kind, EventKind::Tempo(_)));
    assert_eq!(notes.iter().map(|event| event.seconds).collect::<Vec<_>>(), [0.0, 1.0, 1.25]);
    assert_eq!(notes.iter().map(|event| event.frame(44_100.0)).collect::<Vec<_>>(), [0, 44_100, 55_125]);
    // The engine receives each tempo before the notes at the same time.
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
        (vec![], "an empty file: expected a Standard MIDI File"),
        (b"RIFF\x04\0\0\0WAVE".to_vec(), "a WAV sound file: expected a Standard MIDI File (.mid)"),
        (b"RIFF\x04\0\0\0RMID".to_vec(), "an RMID file without a song"),
        (b"RIFF\x0c\0\0\0RMIDdata\x04\0\0\0nope".to_vec(), "an RMID file without a song"),
        (b"fLaC".to_vec(), "a FLAC sound file: expected"),
        ("format = 1\nname = \"Schöne Glocke\"".into(), "a text file: expected"),
        (vec![0x7f; 300], "not a MIDI file: expected"),
        (b"MThd".to_vec(), "not a whole MIDI file: it breaks off in its header"),
        (whole[..12].to_vec(), "not a whole MIDI file: it breaks off in its header"),
        (whole[..14].to_vec(), "declares 2 tracks and has 0"),
        (with(11, 3), "declares 3 tracks and has 2"),
        (with(11, 0), "declares 0 tracks and has 2"),
        (with(9, 2), "a MIDI file of type 2, whose tracks are patterns: expected --pattern 1 to 2"),
        (with(9, 7), "a MIDI file of type 7: expected type 0, 1 or 2"),
        (with(13, 0).iter().enumerate().map(|(i, b)| if i == 12 { 0 } else { *b }).collect(), "the division is 0"),
        (with(12, 0x80), "found 128"),
        (with(12, 0x90), "found 112"),
        (with(23, 0xf5), "track 1, bar 1, beat 1 (tick 0, byte 22): status byte 0xf5 has no place in a file"),
        (with(25, 0x85), "track 1, bar 1, beat 1 (tick 0, byte 22): expected a data byte of at most 0x7f, found 0x85"),
        (
            whole[..whole.len() - 1].to_vec(),
            "track 2, bar 1, beat 1 (tick 0, byte 45): the file is cut off: 7 of the track's 8 bytes are there; \
             add --lenient to read it nevertheless",
        ),
        (
            zero_tempo,
            "track 1, bar 1, beat 1 (tick 7, byte 22): the tempo is 0 µs per quarter note: expected at least 1",
        ),
    ] {
        let error = Song::parse(&bytes, "song.mid").unwrap_err().to_string();
        assert!(error.starts_with("song.mid: ") && error.contains(expected), "{expected}: {error}");
    }
}

/// A file with one track of these bytes and 96 ticks per beat.
fn raw(track: &[u8]) -> Vec<u8> {
    let length = (track.len() as u32).to_be_bytes();
    [b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk", &length[..], track].concat()
}

fn keys(song: &Song) -> Vec<u8> {
    let key = |event: &SongEvent| match event.kind {
        EventKind::NoteOn { key, .. } => Some(key),
        _ => None,
    };
    song.events.iter().filter_map(key).collect()
}

#[test]
fn lenient_reading_repairs_what_it_knows_and_says_so() {
    // A title, and a note without its status byte; one bar of 3/4 later two more such notes, after SysEx.
    let running: &[u8] = &[
        0, 0xff, 0x58, 4, 3, 2, 24, 8, 0, 0x90, 60, 100, 0, 0xff, 3, 1, b'x', 0x60, 61, 100, 0, 0xf0, 1, 0xf7, 0x60,
        62, 100, 0, 0xff, 0x2f, 0,
    ];
    let offset: &[u8] = &[0x60, 0xff, 0x54, 5, 0, 0, 0, 30, 0, 0, 0x90, 60, 100, 0, 0xff, 0x2f, 0];
    let cut: &[u8] = &[0, 0x90, 60, 100, 0x60, 61, 100, 0, 0xff, 0x2f];
    let tempo: &[u8] = &[0, 0xff, 0x51, 3, 0, 0, 0, 0x60, 0x90, 60, 100];
    let mut broken_off = raw(&[0, 0x90, 60, 100, 0x60, 61, 100, 0, 62, 100, 0, 0xff, 0x2f, 0]);
    broken_off.truncate(broken_off.len() - 6);
    let mut miscounted = raw(&[0, 0x90, 60, 100]);
    miscounted[11] = 3;
    let mut uncounted = raw(&[0, 0x90, 60, 100]);
    uncounted[11] = 0;
    let rmid = |size: u32, data: u32| {
        let song = raw(&[0, 0x90, 60, 100]);
        let (size, data) = (size.to_le_bytes(), data.to_le_bytes());
        [b"RIFF", &size[..], b"RMIDDISP\x03\0\0\0abc\0data", &data[..], &song[..]].concat()
    };
    for (bytes, expected, repairs) in [
        (
            raw(running),
            &[60, 61, 62][..],
            &[
                "track 1, bar 1, beat 2 (tick 96, byte 39): an event has no status byte, and a meta or SysEx event ends \
               running status: running status continues (2 times in this track)",
            ][..],
        ),
        (
            raw(offset),
            &[60],
            &["track 1, bar 1, beat 2 (tick 96, byte 22): the SMPTE offset is no time of day: left out"],
        ),
        (raw(cut), &[60, 61], &["track 1, bar 1, beat 2 (tick 96, byte 29): the track ends within an event: left out"]),
        (
            broken_off,
            &[60, 61],
            &[
                "track 1, bar 1, beat 2 (tick 96, byte 30): the file is cut off: 8 of the track's 14 bytes are there: played \
               as far as it goes",
            ],
        ),
        (
            raw(tempo),
            &[60],
            &[
                "track 1, bar 1, beat 1 (tick 0, byte 22): the tempo is 0 µs per quarter note: expected at least 1: left out",
            ],
        ),
        (miscounted, &[60], &["not a whole MIDI file: it declares 3 tracks and has 1: these are read"]),
        (uncounted, &[60], &["not a whole MIDI file: it declares 0 tracks and has 1: these are read"]),
        (rmid(0, 26), &[60], &["an RMID file of size 0: read to its end"]),
        (
            rmid(0, 0),
            &[60],
            &["an RMID file of size 0: read to its end", "an RMID file whose song has the size 0: read to its end"],
        ),
    ] {
        let refused = Song::parse(&bytes, "x").unwrap_err().to_string();
        assert!(refused.ends_with("; add --lenient to read it nevertheless"), "{refused}");
        let (song, told) = Song::parse_leniently(&bytes, "x").unwrap();
        assert_eq!(
            (keys(&song).as_slice(), told.iter().map(String::as_str).collect::<Vec<_>>().as_slice()),
            (expected, repairs)
        );
    }
    assert_eq!(keys(&Song::parse(&rmid(50, 26), "x").unwrap()), [60]);
}

#[test]
fn lenient_reading_changes_nothing_of_a_sound_file() {
    let tempo = vec![meta(0, MetaMessage::Tempo(1_000_000.into())), meta(480, MetaMessage::Tempo(250_000.into()))];
    let bytes = file(Format::Parallel, BEATS, &[tempo, vec![midi(7, 3, on(60, 1)), midi(480, 3, on(60, 0))]]);
    assert_eq!(Song::parse_leniently(&bytes, "x").unwrap(), (Song::parse(&bytes, "x").unwrap(), vec![]));
}

#[test]
fn lenient_reading_plays_what_other_players_play() {
    const FIRST: &str = "track 1, bar 1, beat 1 (tick 0, byte 22)";
    const SECOND: &str = "track 1, bar 1, beat 2 (tick 96, byte 26)";
    for (track, expected, place, repair) in [
        (
            &[0, 0xb0, 7, 0xff, 0, 0x90, 60, 0xc8, 0, 61, 0x99][..],
            &[60, 61][..],
            FIRST,
            "expected a data byte of at most 0x7f, found 0xff: 127 is taken for it (3 times in this track)",
        ),
        (&[0, 0x90, 200, 100, 0, 61, 100], &[61], FIRST, "expected a data byte of at most 0x7f, found 0xc8: left out"),
        (
            &[0, 0x90, 60, 100, 0x60, 0xf8, 0, 61, 100],
            &[60, 61],
            SECOND,
            "status byte 0xf8 has no place in a file: left out",
        ),
        (
            &[0, 0x90, 60, 100, 0x60, 0xf2, 1, 2, 0, 61, 100],
            &[60, 61],
            SECOND,
            "status byte 0xf2 has no place in a file: left out",
        ),
        (
            &[0, 60, 100],
            &[],
            FIRST,
            "an event has no status byte, and a meta or SysEx event ends running status: the rest of the track is left out",
        ),
        (
            &[0x80, 0x80, 0x80, 0x80, 0x60, 0x90, 60, 100],
            &[60],
            FIRST,
            "the time before the event takes more than 4 bytes: read nevertheless",
        ),
        (
            &[0, 0x90, 60, 100, 0x81, 0x82, 0x83, 0x84, 0, 61, 100],
            &[60],
            "track 1, bar 1, beat 1 (tick 0, byte 26)",
            "the time before the event takes more than 4 bytes: the rest of the track is left out",
        ),
    ] {
        let refused = Song::parse(&raw(track), "x").unwrap_err().to_string();
        assert!(refused.ends_with("; add --lenient to read it nevertheless"), "{refused}");
        let (song, repairs) = Song::parse_leniently(&raw(track), "x").unwrap();
        assert_eq!((keys(&song).as_slice(), repairs), (expected, vec![format!("{place}: {repair}")]));
    }
    let (clipped, _) = Song::parse_leniently(&raw(&[0, 0xb0, 7, 0xff]), "x").unwrap();
    assert_eq!(clipped.events[0].kind, EventKind::Control { controller: 7, value: 1.0 });
}

#[test]
fn lenient_reading_finds_all_tracks() {
    let track = |key: u8, length: u32| {
        let bytes = [0, 0x90, key, 100, 0x60, key, 0, 0, 0xff, 0x2f, 0];
        [b"MTrk", &length.to_be_bytes()[..], &bytes].concat()
    };
    let file = |kind: u8, tracks: &[&[u8]]| [b"MThd\0\0\0\x06\0", &[kind, 0, 2, 0, 96][..], &tracks.concat()].concat();
    for (bytes, repair) in [
        (file(1, &[&track(60, 5), &track(61, 11)]), "track 1 says that it has 5 bytes: it has 11 up to its end mark"),
        (file(1, &[&track(60, 9), &track(61, 11)]), "track 1 says that it has 9 bytes: it has 11 up to its end mark"),
        (file(1, &[&track(60, 0), &track(61, 11)]), "track 1 says that it has 0 bytes: it has 11 up to its end mark"),
        (file(1, &[&track(60, 30), &track(61, 11)]), "track 1 says that it has 30 bytes: it has 11 up to its end mark"),
        (file(1, &[&track(60, 11), &track(61, 0)]), "track 2 says that it has 0 bytes: it has 11 up to its end mark"),
        (
            file(1, &[&track(60, 11), &[1, 2, 3], &track(61, 11)]),
            "after track 1, byte 33: 3 bytes belong to no track: left out",
        ),
        (file(9, &[&track(60, 11), &track(61, 11)]), "a MIDI file of type 9: expected type 0, 1 or 2: read as type 1"),
    ] {
        let (song, repairs) = Song::parse_leniently(&bytes, "x").unwrap();
        assert_eq!((keys(&song), repairs), (vec![60, 61], vec![repair.to_owned()]));
    }
    let whole = file(1, &[&track(60, 11), b"XFIH\0\0\0\x02ab", &track(61, 11), b"\0rubbish"]);
    assert_eq!(Song::parse_leniently(&whole, "x").unwrap(), (Song::parse(&whole, "x").unwrap(), vec![]));
}

#[test]
fn hostile_files_take_no_time() {
    let header = b"MThd\0\0\0\x06\0\x01\0\0\0\x60";
    // No chunk and no further track in a megabyte, and a million empty tracks, each behind junk.
    let none = [&header[..], &b"\xff\xff\xff\xff\0\0\0\0".repeat(1 << 17)].concat();
    assert!(Song::parse_leniently(&none, "x").is_err());
    let junk = [&header[..], &b"\xff\xff\xff\xffMTrk\0\0\0\0".repeat(1 << 17)].concat();
    let refused = Song::parse_leniently(&junk, "x").unwrap_err().to_string();
    assert!(refused.contains("4 bytes belong to no track"), "{refused}");
    // Velocities above 127 under running status: more than a song may have.
    let many = [&[0, 0x90, 60, 200][..], &[0, 60, 200].repeat(MAX_EVENTS)].concat();
    let refused = Song::parse_leniently(&raw(&many), "x").unwrap_err().to_string();
    assert!(refused.contains("too many events: expected at most 8000000"), "{refused}");
}

#[test]
fn a_lenient_reader_plays_every_truncation_as_far_as_it_goes() {
    let track =
        vec![midi(0, 0, on(60, 1)), midi(300, 1, on(61, 1)), midi(300, 0, on(62, 1)), meta(9, MetaMessage::EndOfTrack)];
    let whole = file(Format::SingleTrack, BEATS, &[track]);
    let all = Song::parse(&whole, "x").unwrap();
    for length in 22..whole.len() {
        let (song, repairs) = Song::parse_leniently(&whole[..length], "x").unwrap();
        assert_eq!(song.events, all.events[..song.events.len()], "{length}");
        assert!(!repairs.is_empty(), "{length}");
    }
    assert_eq!(Song::parse_leniently(&whole[..whole.len() - 1], "x").unwrap().0.events, all.events);
}

#[test]
fn a_title_that_looks_like_a_header_is_a_title() {
    let title = b"MThd\0\0\0\x06\0\x01\0\x01\x80\x60";
    let track = [&[0, 0xff, 3, title.len() as u8][..], title, &[0, 0x90, 60, 100]].concat();
    assert_eq!(keys(&Song::parse(&raw(&track), "x").unwrap()), [60]);
    // Between tracks it is an error.
    let mut bytes = raw(&[0, 0x90, 60, 100]);
    bytes[11] = 2;
    bytes.extend(title);
    let error = Song::parse(&bytes, "x").unwrap_err().to_string();
    assert_eq!(error, "x: a second header after track 1: expected one song");
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
        let _ = Song::parse_leniently(&bytes, "x");
        let _ = Song::parse(&bytes, "x");
        let mut framed = b"MThd\0\0\0\x06".to_vec();
        framed.extend(header);
        let _ = Song::parse(&framed, "x");
        framed[8..14].copy_from_slice(&[0, 1, 0, 1, 0, 96]);
        framed.extend(b"MTrk");
        framed.extend((bytes.len() as u32).to_be_bytes());
        framed.extend(&bytes);
        let _ = Song::parse(&framed, "x");
        // A valid file with one wrong byte.
        let mut good = file(Format::Parallel, BEATS, &[vec![midi(3, 0, on(60, 1)), meta(1, MetaMessage::Tempo(7.into()))]]);
        let at = at.index(good.len());
        good[at] = byte;
        let _ = Song::parse(&good, "x");
    }
}
