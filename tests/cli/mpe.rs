//! An MPE performance from a MIDI file, rendered by the command: every note follows the bends of its own channel.

use crate::damped_sine::fit;
use midly::num::{u4, u7, u14, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, PitchBend, Smf, Timing, TrackEvent, TrackEventKind};
use sprung::internals::CONTROL_FRAMES;
use sprung::units::frequency_from_key;
use std::path::Path;
use std::process::Command;

const SAMPLE_RATE: u32 = 48_000;

/// Frames for which a channel keeps a bend: three cycles of the lowest note.
const HOLD: usize = 4801;

/// Number of bends per channel.
const BENDS: usize = 40;

const KEY: u8 = 72;
const START: usize = 777;

/// The bend range of a member channel.
const SEMITONES: f64 = 48.0;

/// The `n`-th bend of a channel, as 14 bits: over the whole range, including both ends.
fn bend(channel: u8, n: usize) -> u16 {
    match n {
        3 => 0,
        5 => 16_383,
        // The highest resulting frequency is 8.4 kHz.
        _ => ((n * 1_237 + usize::from(channel) * 2_711) % 16_384) as u16,
    }
}

/// A bend in semitones.
fn semitones(bend: u16) -> f64 {
    let from_centre = f64::from(bend) - 8192.0;
    SEMITONES * if from_centre < 0.0 { from_centre / 8192.0 } else { from_centre / 8191.0 }
}

/// The performance, with a note on only one of the fifteen channels; the others send bends, pressure and controllers
/// meanwhile. Four ticks of the file are one frame.
fn performance(heard: u8) -> Vec<u8> {
    let control =
        |controller: u8, value: u8| MidiMessage::Controller { controller: u7::new(controller), value: u7::new(value) };
    let mut messages = vec![(0, 0, control(101, 0)), (0, 0, control(100, 6)), (0, 0, control(6, 15))];
    for channel in 1..16 {
        for n in 0..BENDS {
            let frame = START + HOLD * n;
            let bend = PitchBend(u14::new(bend(channel, n)));
            messages.push((frame, channel, MidiMessage::PitchBend { bend }));
            messages.push((frame + 13, channel, MidiMessage::ChannelAftertouch { vel: u7::new((n * 3 % 128) as u8) }));
            messages.push((frame + 29, channel, control(74, (n * 7 % 128) as u8)));
        }
    }
    messages.push((START, heard, MidiMessage::NoteOn { key: u7::new(KEY), vel: u7::new(127) }));
    messages.sort_by_key(|(frame, ..)| *frame);

    let tempo = TrackEventKind::Meta(MetaMessage::Tempo(u24::new(125_000)));
    let mut track = vec![TrackEvent { delta: u28::new(0), kind: tempo }];
    let mut now = 0;
    let mut add = |frame: usize, kind| {
        track.push(TrackEvent { delta: u28::new((4 * frame - now) as u32), kind });
        now = 4 * frame;
    };
    for (frame, channel, message) in messages {
        add(frame, TrackEventKind::Midi { channel: u4::new(channel), message });
    }
    add(START + HOLD * BENDS, TrackEventKind::Meta(MetaMessage::EndOfTrack));
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new((SAMPLE_RATE / 2) as u16)));
    let mut bytes = Vec::new();
    Smf { header, tracks: vec![track] }.write(&mut bytes).unwrap();
    bytes
}

/// The samples that the command renders from a MIDI file.
fn render(folder: &Path, midi: &[u8]) -> Vec<f32> {
    let (song, sound) = (folder.join("mpe.mid"), folder.join("mpe.wav"));
    std::fs::write(&song, midi).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command
        .arg("render")
        .arg(&song)
        .arg("-o")
        .arg(&sound)
        .args(["--preset", "init", "--force", "--mono", "--bits", "32f", "--tail", "none"]);
    command.args(["--set", "decay=60", "--set", "limiter=off", "--rate", "48000", "--programs", "none"]);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    hound::WavReader::open(sound).unwrap().into_samples().map(|sample| sample.unwrap()).collect()
}

/// From the control tick after a bend until the next bend, the note has exactly the pitch that was sent.
#[test]
fn every_bend_is_where_it_was_sent_from_the_next_tick_on() {
    let folder = tempfile::tempdir().unwrap();
    let (mut worst, mut measured) = (0.0_f64, 0);
    for channel in 1..16 {
        let samples = render(folder.path(), &performance(channel));
        for n in 0..BENDS {
            let frequency = frequency_from_key(f64::from(KEY) + semitones(bend(channel, n)), 440.0);
            let (start, end) = ((START + HOLD * n + 1).next_multiple_of(CONTROL_FRAMES), START + HOLD * (n + 1));
            let found = fit(&samples[start..end], SAMPLE_RATE.into(), frequency, 60.0).expect("a damped sinusoid");
            let cents = 1200.0 * libm::log2(found.frequency / frequency);
            let case = format!("channel {channel}, bend {n}, {frequency:.1} Hz");
            assert!(cents.abs() < 0.05, "{case}: {cents:+.4} cents");
            // If one tick had another pitch, the whole would not be a sinusoid.
            assert!(found.residual_db < -80.0, "{case}: {:.1} dB", found.residual_db);
            (worst, measured) = (worst.max(cents.abs()), measured + 1);
        }
    }
    println!("{measured} bends: at worst {worst:.5} cents from what was sent");
}
