//! A phrase with everything musicians use in MIDI: as a MIDI file, as host events, and as events of the engine.

use crate::host::{Address, Sent, Timed};
use midly::num::{u4, u7, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, Smf, Timing, TrackEvent, TrackEventKind};
use sprung::engine::EventKind;
use sprung::io::Song;

/// Sample rate, in frames per second, for all frames below.
pub(crate) const SAMPLE_RATE: u32 = 48_000;

/// Length of the phrase in frames.
pub(crate) const FRAMES: usize = 72_000;

/// How a host sends notes; everything else is sent as MIDI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dialect {
    Clap,
    Midi,
}

/// Messages of one channel, by frame. Those that set the bend range are far apart: VST3 passes controllers as
/// parameters, and in some hosts parameters that change within one block have no order.
pub(crate) fn messages() -> Vec<(u64, [u8; 3])> {
    vec![
        (0, [0xB0, 7, 110]),
        (0, [0x90, 48, 100]),
        (1, [0x90, 55, 1]),
        (4_801, [0x90, 60, 127]),
        (5_000, [0xE0, 0x7F, 0x7F]),
        (5_777, [0xE0, 0x00, 0x00]),
        (6_301, [0xE0, 0x01, 0x40]),
        (7_200, [0xB0, 1, 64]),
        (9_599, [0x80, 48, 64]),
        (9_600, [0xE0, 0x00, 0x40]),
        (12_007, [0xB0, 64, 127]),
        (12_013, [0x90, 64, 80]),
        (13_000, [0x90, 64, 0]),
        (14_000, [0x90, 64, 90]),
        (15_000, [0xA0, 64, 100]),
        (16_000, [0x80, 64, 0]),
        (18_003, [0xB0, 64, 0]),
        (20_000, [0xD0, 90, 0]),
        (21_111, [0xD0, 0, 0]),
        (22_000, [0xB0, 101, 0]),
        (22_600, [0xB0, 100, 0]),
        (23_200, [0xB0, 6, 12]),
        (24_000, [0x90, 72, 99]),
        (24_000, [0x90, 76, 98]),
        (24_000, [0x90, 79, 97]),
        (25_013, [0xE0, 0x55, 0x61]),
        (27_000, [0xB0, 66, 127]),
        (28_000, [0x80, 72, 30]),
        (28_001, [0x80, 76, 127]),
        (30_000, [0xB0, 66, 0]),
        (31_000, [0xB0, 10, 20]),
        (31_500, [0xB0, 11, 70]),
        (32_000, [0xB0, 67, 127]),
        (33_000, [0x90, 50, 101]),
        (40_000, [0xB0, 121, 0]),
        (45_000, [0x90, 62, 60]),
        (52_000, [0xB0, 123, 0]),
        (56_000, [0x90, 43, 120]),
        (60_001, [0xB0, 120, 0]),
    ]
}

/// An MPE performance: a zone of fifteen channels with one note each. Bends over the whole range of ±48 semitones,
/// pressure and brightness move while the notes sound.
pub(crate) fn mpe_messages() -> Vec<(u64, [u8; 3])> {
    let mut messages = vec![(0, [0xB0, 101, 0]), (0, [0xB0, 100, 6]), (0, [0xB0, 6, 15])];
    for channel in 1..16_u8 {
        let start = 600 * u64::from(channel);
        let bend = |n: u64| (n * 1_237 + u64::from(channel) * 2_711) % 16_384;
        let bent = |n: u64| [0xE0 | channel, (bend(n) & 127) as u8, (bend(n) >> 7) as u8];
        messages.push((start, bent(0)));
        messages.push((start, [0xB0 | channel, 74, 8 * channel]));
        messages.push((start, [0x90 | channel, 40 + 2 * channel, 60 + 4 * channel]));
        for n in 1..40 {
            let frame = start + 911 * n;
            messages.push((frame, bent(n)));
            messages.push((frame + 13, [0xD0 | channel, (n * 3 % 128) as u8, 0]));
            messages.push((frame + 29, [0xB0 | channel, 74, (n * 7 % 128) as u8]));
        }
        messages.push((start + 40_000, [0x80 | channel, 40 + 2 * channel, 50]));
    }
    messages.extend([(20_000, [0xE0, 0, 96]), (30_000, [0xB0, 64, 127]), (55_000, [0xB0, 64, 0])]);
    messages.sort_by_key(|(frame, _)| *frame);
    messages
}

/// The phrase on the keys of a drum kit, without pedals and bends.
pub(crate) fn kit_messages() -> Vec<(u64, [u8; 3])> {
    let mut messages = messages();
    messages.retain(|(_, [status, controller, _])| match status & 0xF0 {
        0xB0 => [7, 10, 11].contains(controller),
        0xE0 => false,
        _ => true,
    });
    for (_, [status, key, _]) in &mut messages {
        if matches!(*status & 0xF0, 0x80 | 0x90 | 0xA0) {
            *key = 35 + *key % 24;
        }
    }
    messages
}

/// The messages, with each controller, bend and pressure of the channel moved to the start of its block.
pub(crate) fn with_controllers_by_block(messages: &[(u64, [u8; 3])], block: u64) -> Vec<(u64, [u8; 3])> {
    let is_controller = |data: [u8; 3]| matches!(data[0] & 0xF0, 0xB0 | 0xD0 | 0xE0);
    let mut moved = messages.to_vec();
    moved.iter_mut().filter(|(_, data)| is_controller(*data)).for_each(|(frame, _)| *frame -= *frame % block);
    // On the same frame, controllers come first.
    moved.sort_by_key(|&(frame, data)| (frame, !is_controller(data)));
    moved
}

/// The phrase as the bytes of a MIDI file.
pub(crate) fn midi_file() -> Vec<u8> {
    file(&messages())
}

/// Messages as the bytes of a MIDI file with four ticks per frame. Each message is a quarter of a frame late, so that
/// hosts that truncate times to whole frames, hosts that round them and `sprung render` all use the same frame.
pub(crate) fn file(messages: &[(u64, [u8; 3])]) -> Vec<u8> {
    let tempo = TrackEventKind::Meta(MetaMessage::Tempo(u24::new(125_000)));
    let mut track = vec![TrackEvent { delta: u28::new(0), kind: tempo }];
    let mut now = 0;
    let mut add = |tick: u64, kind| {
        track.push(TrackEvent { delta: u28::new((tick - now) as u32), kind });
        now = tick;
    };
    for &(frame, data) in messages {
        add(4 * frame + 1, TrackEventKind::Midi { channel: u4::new(data[0] & 15), message: message(data) });
    }
    add(4 * FRAMES as u64, TrackEventKind::Meta(MetaMessage::EndOfTrack));
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new((SAMPLE_RATE / 2) as u16)));
    let mut bytes = Vec::new();
    Smf { header, tracks: vec![track] }.write(&mut bytes).unwrap();
    bytes
}

fn message([status, first, second]: [u8; 3]) -> MidiMessage {
    let (key, vel, value) = (u7::new(first), u7::new(second), u7::new(second));
    match status & 0xF0 {
        0x80 => MidiMessage::NoteOff { key, vel },
        0x90 => MidiMessage::NoteOn { key, vel },
        0xA0 => MidiMessage::Aftertouch { key, vel },
        0xB0 => MidiMessage::Controller { controller: key, value },
        0xD0 => MidiMessage::ChannelAftertouch { vel: key },
        0xE0 => {
            let bend = i16::from(first) + (i16::from(second) << 7) - 8192;
            MidiMessage::PitchBend { bend: midly::PitchBend::from_int(bend) }
        }
        _ => panic!("no message of the phrase: {status:#x}"),
    }
}

/// Reads a song as `sprung render` does.
pub(crate) fn song(bytes: &[u8]) -> Song {
    Song::parse(bytes, "the phrase").unwrap()
}

/// MIDI messages as events of a host.
pub(crate) fn sent(messages: &[(u64, [u8; 3])], dialect: Dialect) -> Vec<Timed> {
    let translate = |&(frame, data): &(u64, [u8; 3])| {
        let note = Address::key(i16::from(data[0] & 15), data[1].into());
        let velocity = f64::from(data[2]) / 127.0;
        let sent = match (dialect, data[0] & 0xF0) {
            // MIDI does not say how fast these keys were released; hosts use the middle velocity.
            (Dialect::Clap, 0x90) if data[2] == 0 => Sent::Off(note, 0.5),
            (Dialect::Clap, 0x90) => Sent::On(note, velocity),
            (Dialect::Clap, 0x80) => Sent::Off(note, velocity),
            _ => Sent::Midi(data),
        };
        sent.at(frame)
    };
    messages.iter().map(translate).collect()
}

/// The messages of a MIDI file, by frame, without program changes, since a plugin plays one patch.
pub(crate) fn messages_of(bytes: &[u8], sample_rate: f64) -> Vec<(u64, [u8; 3])> {
    // The times come from the library's own reader, the bytes from the file. Both contain the same events in the same
    // order.
    let song = song(bytes);
    let smf = Smf::parse(bytes).unwrap();
    let mut raw = Vec::new();
    for track in &smf.tracks {
        let mut tick = 0_u64;
        for event in track {
            tick += u64::from(event.delta.as_int());
            if let TrackEventKind::Midi { channel, message } = event.kind {
                let mut data = Vec::new();
                midly::live::LiveEvent::Midi { channel, message }.write(&mut data).unwrap();
                data.resize(3, 0);
                raw.push((tick, [data[0], data[1], data[2]]));
            }
        }
    }
    raw.sort_by_key(|(tick, _)| *tick);
    let events: Vec<_> = song.events.iter().filter(|event| !matches!(event.kind, EventKind::Tempo(_))).collect();
    assert_eq!(raw.len(), events.len());
    let timed = events.into_iter().zip(raw).map(|(event, (_, data))| (event.frame(sample_rate), data));
    timed.filter(|(_, data)| data[0] & 0xF0 != 0xC0).collect()
}
