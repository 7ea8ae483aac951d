//! Parts of songs: from a bar or a second to another, as loops, and patterns of type 2; FLAC.

use crate::{Sandbox, Wav, end, midi, note_on, song};
use midly::num::u7;
use midly::{MetaMessage, MidiMessage, TrackEvent, TrackEventKind};

fn control(delta: u32, channel: u8, controller: u8, value: u8) -> TrackEvent<'static> {
    let (controller, value) = (u7::new(controller), u7::new(value));
    midi(delta, channel, MidiMessage::Controller { controller, value })
}

fn off(delta: u32, channel: u8, key: u8) -> TrackEvent<'static> {
    midi(delta, channel, MidiMessage::NoteOff { key: key.into(), vel: 64.into() })
}

fn meta(message: MetaMessage<'static>) -> TrackEvent<'static> {
    TrackEvent { delta: 0.into(), kind: TrackEventKind::Meta(message) }
}

/// Frames of stereo at 48 kHz in a second.
const SECOND: usize = 2 * 48_000;

#[test]
fn a_passage_has_the_bits_of_the_whole_when_nothing_rings_on_from_before() {
    let sandbox = Sandbox::new();
    let program = |channel, number: u8| midi(0, channel, MidiMessage::ProgramChange { program: number.into() });
    // In the first second: notes, and everything that a later note follows.
    sandbox.write(
        "song.mid",
        song(&[
            program(0, 12),
            program(1, 73),
            control(0, 0, 7, 80),
            control(0, 0, 10, 20),
            control(0, 0, 101, 0),
            control(0, 0, 100, 2),
            control(0, 0, 6, 66),
            // Portamento, and a key to glide from that the first note uses up.
            control(0, 0, 65, 127),
            control(0, 0, 5, 30),
            control(0, 1, 84, 48),
            note_on(0, 0, 60),
            note_on(0, 1, 72),
            note_on(0, 9, 36),
            control(0, 0, 100, 0),
            control(0, 0, 6, 12),
            midi(0, 0, MidiMessage::PitchBend { bend: midly::PitchBend::from_f64(0.5) }),
            control(100, 1, 1, 90),
            control(0, 0, 91, 0),
            off(100, 0, 60),
            off(0, 1, 72),
            program(0, 11),
            note_on(20 * 960, 0, 64),
            note_on(0, 1, 67),
            note_on(50, 9, 38),
            off(910, 0, 64),
            off(0, 1, 67),
            end(0),
        ]),
    );
    for args in ["", "--set space=none", "--programs none --preset Marimba", "--tempo 2"] {
        let (from, skipped) = if args == "--tempo 2" { (10, 10) } else { (20, 20) };
        let base = format!("render song.mid {args} --bits 32f --tail 1 --force");
        sandbox.succeeds(&format!("{base} -o whole.wav"));
        sandbox.succeeds(&format!("{base} --from {from} -o part.wav"));
        let (whole, part) = (sandbox.wav("whole.wav"), sandbox.wav("part.wav"));
        let rest = &whole.samples[skipped * SECOND..];
        assert_eq!(part.samples.len(), rest.len(), "{args}");
        let first = part.samples.iter().zip(rest).position(|(a, b)| a != b);
        assert_eq!((first, part.peak() > 0.01), (None, true), "{args}");
    }
}

#[test]
fn bars_are_those_of_the_time_signatures() {
    let sandbox = Sandbox::new();
    // Two bars of 3/4, then 4/4; 480 ticks are half a second, and a second from the third bar on.
    sandbox.write(
        "song.mid",
        song(&[
            meta(MetaMessage::TimeSignature(3, 2, 24, 8)),
            note_on(0, 0, 60),
            TrackEvent { delta: (6 * 480).into(), ..meta(MetaMessage::TimeSignature(4, 2, 24, 8)) },
            meta(MetaMessage::Tempo(1_000_000.into())),
            note_on(0, 0, 64),
            note_on(480, 0, 67),
            end(480 * 7),
        ]),
    );
    let frames = |args: &str| {
        sandbox.succeeds(&format!("render song.mid {args} --tail none --rate 8000 --force -o out.wav"));
        sandbox.wav("out.wav").frames
    };
    assert_eq!(frames("--from bar3"), 64_000);
    assert_eq!(frames("--from bar3.2 --to bar4"), 24_000);
    assert_eq!(frames("--from bar2 --tempo 2"), (12_000 + 64_000) / 2);
    assert_eq!(frames("--from 1.25s --to 99"), 78_000);
    sandbox.fails("render song.mid --from bar3.5 -o no.wav", 1, "--from: bar 3 has 4 beats: expected 1 to 4");
    sandbox.fails("render song.mid --from bar9 -o no.wav", 1, "--from: 27.000 s is not before the end, at 11.000 s");
    sandbox.fails("render song.mid --from 2 --to 1 -o no.wav", 1, "--from: 2.000 s is not before the end, at 1.000 s");
    let message = "‘9x’ is not a number: expected 0 to 86400 s, or a bar (bar 9)";
    sandbox.fails("render song.mid --to 9x -o no.wav", 2, message);
}

#[test]
fn a_loop_is_the_song_with_its_tail_folded_into_its_beginning() {
    let sandbox = Sandbox::new();
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), note_on(200, 0, 67), off(0, 0, 60), end(50)]));
    let base = "render song.mid --bits 32f --force";
    for args in ["", "--from 0.1", "--set space=none --tail 5"] {
        sandbox.succeeds(&format!("{base} {args} --set limiter=off -o whole.wav"));
        sandbox.succeeds(&format!("{base} {args} --set limiter=off --loop -o loop.wav"));
        let (whole, looped) = (sandbox.wav("whole.wav"), sandbox.wav("loop.wav"));
        let length = if args == "--from 0.1" { 12_500 - 4800 } else { 12_500 };
        assert_eq!(looped.frames, length, "{args}");
        let mut folded = vec![0.0_f32; 2 * length as usize];
        for (n, sample) in whole.samples.iter().enumerate() {
            folded[n % (2 * length as usize)] += *sample as f32;
        }
        assert!(whole.frames > 2 * length && looped.peak() > 0.02, "{} {}", whole.frames, looped.peak());
        assert!(looped.samples.iter().zip(&folded).all(|(a, b)| *a as f32 == *b), "{args}");
    }
    // The points of the loop: the chunk `smpl` with the first and the last frame.
    let bytes = sandbox.read("loop.wav");
    let chunk = bytes.windows(4).position(|window| window == b"smpl").unwrap();
    let number = |at: usize| u32::from_le_bytes(bytes[chunk + at..chunk + at + 4].try_into().unwrap());
    assert_eq!([number(4), number(36), number(52), number(56)], [60, 1, 0, 12_499]);
    let riff = u32::from_le_bytes(bytes[4..8].try_into().unwrap());
    assert_eq!((riff as usize + 8, chunk + 68), (bytes.len(), bytes.len()));
    sandbox.fails("render song.mid --loop --tail none -o no.wav", 1, "--loop: what sounds on goes into the beginning");
}

#[test]
fn a_loud_loop_is_limited_and_goes_round_without_a_step() {
    let sandbox = Sandbox::new();
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), note_on(0, 0, 64), note_on(0, 0, 67), end(150)]));
    sandbox.succeeds("render song.mid --bits 32f --mix-gain-db 20 --loop -o loop.wav");
    let looped = sandbox.wav("loop.wav");
    assert!(looped.peak() < 0.97 && looped.peak() > 0.5);
    let side: Vec<f64> = looped.samples.iter().step_by(2).copied().collect();
    let steps: Vec<f64> = side.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let largest = steps.iter().copied().fold(0.0, f64::max);
    let seam = (side[0] - side[side.len() - 1]).abs();
    assert!(seam <= largest, "{seam} at the seam, {largest} elsewhere");
}

#[test]
fn a_pattern_of_a_file_of_type_2_is_a_song() {
    let sandbox = Sandbox::new();
    let track = |key: u8, ticks: u8| {
        let events = [0, 0x90, key, 100, ticks, 0x80, key, 64, 0, 0xff, 0x2f, 0];
        [&b"MTrk"[..], &(events.len() as u32).to_be_bytes(), &events].concat()
    };
    let file = |kind: u8, tracks: &[Vec<u8>]| {
        let header = [0, 0, 0, 6, 0, kind, 0, tracks.len() as u8, 0, 0x60];
        [&b"MThd"[..], &header, &tracks.concat()].concat()
    };
    sandbox.write("patterns.mid", file(2, &[track(60, 0x60), track(67, 0x30)]));
    sandbox.write("second.mid", file(0, &[track(67, 0x30)]));
    sandbox.succeeds("render patterns.mid --pattern 2 -o pattern.wav");
    sandbox.succeeds("render second.mid -o second.wav");
    assert!(sandbox.read("pattern.wav") == sandbox.read("second.wav"));
    let message = "a MIDI file of type 2, whose tracks are patterns: expected --pattern 1 to 2";
    sandbox.fails("render patterns.mid -o no.wav", 1, message);
    sandbox.fails("render patterns.mid --pattern 3 -o no.wav", 1, message);
    sandbox.fails("render second.mid --pattern 1 -o no.wav", 1, "only files of type 2 have patterns");
}

#[test]
fn a_flac_by_its_name_has_the_samples_of_the_wav() {
    let sandbox = Sandbox::new();
    let base = "render --note C4,E4 --length 0.2 --tail 0.1 --force";
    for bits in ["16 --dither", "24", "24 --mono", "24 --normalize peak=-1"] {
        sandbox.succeeds(&format!("{base} --bits {bits} -o out.wav"));
        sandbox.succeeds(&format!("{base} --bits {bits} -o out.flac"));
        let piped = sandbox.succeeds(&format!("{base} --bits {bits} --format flac -o -"));
        assert!(piped == sandbox.read("out.flac"), "{bits}");
        let flac =
            sprung::io::sound_file::read(std::fs::File::open(sandbox.path("out.flac")).unwrap(), "out.flac").unwrap();
        let wav = Wav::read(&sandbox.read("out.wav"));
        assert_eq!(flac.channels.len(), usize::from(wav.spec.channels));
        for (channel, samples) in flac.channels.iter().enumerate() {
            let own = wav.samples.iter().skip(channel).step_by(flac.channels.len());
            assert!(samples.len() == wav.frames as usize && samples.iter().zip(own).all(|(a, b)| f64::from(*a) == *b));
        }
    }
    assert_eq!(sandbox.files(), ["out.flac", "out.wav"]);
    for (args, message) in [
        ("--bits 32f -o no.flac", "--bits: FLAC has no floats"),
        ("--rate 192k -o no.flac", "--rate: 192000 Hz is too high for FLAC"),
        (
            "--format flac -o no.wav",
            "no.wav: --format flac does not go with this name: expected a name that ends in .flac, or no --format",
        ),
        ("-o no.mp3", "no.mp3: only WAV and FLAC can be written, not .mp3: expected .wav or .flac"),
    ] {
        sandbox.fails(&format!("render --note C4 {args}"), 1, message);
    }
}
