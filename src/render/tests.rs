//! Tests of lengths, tails and threads of renderings.

use super::wav::to_wav;
use super::{Delivery, Job, Options, Progress, Rendered, Tail, on_threads};
use crate::engine::EventKind;
use crate::error::Error;
use crate::io::{Inputs, Output, Song, SongEvent, Target};
use crate::params::Param;
use crate::patch::{Mode, ModeTable, Patch};
use crate::sound::Kit;

fn options(sample_rate: u32, block: usize, tail: Tail) -> Options {
    Options { sample_rate, seed: 0, block, tail }
}

fn render(song: &Song, options: Options) -> (Rendered, Vec<f32>) {
    let patch = Patch::default().with(Param::Decay, 0.2).with(Param::Release, 0.05);
    let mut samples = Vec::new();
    let rendered = Job::new(song, &Kit::of_patch(&patch), options)
        .render(|left, right| {
            assert!(left.len() <= options.block && left.len() == right.len());
            samples.extend(left);
            Ok(())
        })
        .unwrap();
    assert_eq!(rendered.frames, samples.len() as u64);
    (rendered, samples)
}

#[test]
fn lengths_are_exact() {
    let song = Song::chord(&[60.0], 1.0, 0.125);
    for (rate, tail, frames, tail_frames) in [
        (44_100, Tail::None, 5513, 0),
        (48_000, Tail::None, 6000, 0),
        (8_000, Tail::Seconds(0.25), 3000, 2000),
        (768_000, Tail::Seconds(0.0), 96_000, 0),
    ] {
        for block in [1000, 65_536] {
            let (rendered, _) = render(&song, options(rate, block, tail));
            assert_eq!((rendered.frames, rendered.tail_frames), (frames, tail_frames), "{rate} {tail:?}");
        }
    }
    assert_eq!(render(&Song::default(), options(48_000, 1, Tail::Auto)).0.frames, 0);
}

#[test]
fn keys_and_pedals_that_are_down_when_a_song_ends_do_not_sound_on() {
    let patch = Patch::default().with(Param::Decay, 60.0).with(Param::Release, 0.05);
    let on = EventKind::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: None };
    let off = EventKind::NoteOff { key: 60, velocity: 0.5, id: None };
    let control = |controller| EventKind::Control { controller, value: 1.0 };
    let release = |kinds: &[EventKind], tail| {
        let event = |kind: &EventKind| SongEvent { seconds: 0.0, channel: 3, kind: *kind };
        let song = Song { events: kinds.iter().map(event).collect(), seconds: 0.1 };
        let [left, _] = Job::new(&song, &Kit::of_patch(&patch), options(48_000, 512, tail)).samples().unwrap();
        left
    };
    for kinds in [&[on][..], &[control(64), on, off], &[on, control(66), off], &[control(67), control(64), on]] {
        let auto = release(kinds, Tail::Auto);
        // The release takes 0.05 s for 60 dB.
        assert!((4800 + 2400..4800 + 9600).contains(&auto.len()), "{kinds:?}: {}", auto.len());
        assert!(auto[..4800].iter().any(|sample| sample.abs() > 0.1), "{kinds:?}");
        // The song is the same whatever follows.
        let timed = release(kinds, Tail::Seconds(0.2));
        assert!(timed.iter().zip(&auto).all(|(a, b)| a.to_bits() == b.to_bits()), "{kinds:?}");
        assert!(timed[auto.len()..].iter().all(|sample| *sample == 0.0), "{kinds:?}");
        assert!(release(kinds, Tail::None) == auto[..4800], "{kinds:?}");
    }
}

#[test]
fn an_auto_tail_ends_in_silence_at_a_frame_that_does_not_depend_on_the_block() {
    let song = Song::chord(&[60.0, 67.5], 1.0, 0.1);
    let (whole, samples) = render(&song, options(48_000, 65_536, Tail::Auto));
    for block in [1, 7, 64, 480] {
        let (rendered, other) = render(&song, options(48_000, block, Tail::Auto));
        assert_eq!(rendered, whole, "{block}");
        assert!(samples.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()), "{block}");
    }
    assert_eq!(whole.voices_used, 2);
    assert!(samples.iter().any(|sample| sample.abs() > 0.01), "it sounds");
    assert!(samples[samples.len() - 10..].iter().all(|sample| sample.abs() < 1e-5), "to its end");
    assert!((1000..48_000).contains(&whole.tail_frames), "{whole:?}");
}

#[test]
fn options_out_of_range_and_errors_of_the_sink_end_it() {
    let song = Song::chord(&[60.0], 1.0, 0.125);
    let kit = Kit::of_patch(&Patch::default());
    for options in [options(0, 64, Tail::None), options(48_000, 0, Tail::None), options(48_000, 65_537, Tail::None)] {
        assert!(matches!(Job::new(&song, &kit, options).render(|_, _| Ok(())), Err(Error::Value { .. })));
    }
    let mut blocks = 0;
    let result = Job::new(&song, &kit, options(48_000, 64, Tail::None)).render(|_, _| {
        blocks += 1;
        if blocks == 3 { Err(Error::Interrupted) } else { Ok(()) }
    });
    assert!(matches!(result, Err(Error::Interrupted)));
    assert_eq!(blocks, 3);
}

#[test]
fn what_is_passed_over_can_be_ended_and_is_part_of_the_progress() {
    let (song, kit) = (Song::chord(&[60.0], 1.0, 2.0), Kit::of_patch(&Patch::default()));
    let job = Job { from: 1.5, ..Job::new(&song, &kit, options(48_000, 1000, Tail::None)) };
    let mut lengths = Vec::new();
    job.render(|left, _| {
        lengths.push(left.len());
        Ok(())
    })
    .unwrap();
    assert_eq!(lengths, [vec![0; 72], vec![1000; 24]].concat());
    let mut blocks = 0;
    let result = job.render(|_, _| {
        blocks += 1;
        if blocks == 3 { Err(Error::Interrupted) } else { Ok(()) }
    });
    assert!(matches!(result, Err(Error::Interrupted)) && blocks == 3);
    let folder = tempfile::tempdir().unwrap();
    let target = Target::Path(folder.path().join("out.wav"));
    let mut output = Output::create(&target, false, &Inputs::default()).unwrap();
    let mut shown = Vec::new();
    to_wav(&job, &Delivery::default(), &mut output, |Progress { frames, expected }| {
        shown.push((frames, expected));
        Ok(())
    })
    .unwrap();
    assert_eq!((shown.len(), shown[0], shown[95]), (96, (1000, 96_000), (96_000, 96_000)));
}

/// Notes on all channels, which sometimes change their sounds and choke each other.
fn dense_song() -> Song {
    let event = |n: u32| {
        let kind = match n % 8 {
            0 => EventKind::Program((n / 8 % 3) as u8),
            3 => EventKind::PitchBend((n % 5) as f32 / 5.0),
            5 => EventKind::NoteOff { key: (40 + n * 5 % 50) as u8, velocity: 0.5, id: None },
            _ => EventKind::NoteOn { key: (40 + n * 7 % 50) as u8, detune: 0.0, velocity: 0.8, id: None },
        };
        SongEvent { seconds: 0.003 * f64::from(n), channel: (n * 11 % 16) as u8, kind }
    };
    Song { events: (0..240).map(event).collect(), seconds: 0.75 }
}

fn render_on(threads: u16, block: usize, tail: Tail) -> (Rendered, Vec<u32>) {
    let short = Patch::default().with(Param::Decay, 0.3).with(Param::Release, 0.1);
    let mut rich = short.clone().with(Param::Choke, 1.0);
    rich.modes = ModeTable::new(&[Mode { strike: 0.5, ..Mode::UNIT }; 5]);
    let programs = [short.clone().with(Param::Choke, 2.0), rich, short.clone().with(Param::Vibrato, 1.0)];
    let programs = programs.each_ref().map(Kit::of_patch);
    let (song, mut bits) = (dense_song(), Vec::new());
    let options = Options { sample_rate: 48_000, seed: 3, block, tail };
    let kit = Kit::of_patch(&short);
    let job = Job { programs: &programs, ..Job::new(&song, &kit, options) };
    let sink = |left: &[f32], right: &[f32]| {
        bits.extend(left.iter().zip(right).flat_map(|(left, right)| [left.to_bits(), right.to_bits()]));
        Ok(())
    };
    let rendered = on_threads(Some(threads), || job.render(sink)).unwrap().unwrap();
    (rendered, bits)
}

#[test]
fn the_samples_do_not_depend_on_the_threads() {
    for tail in [Tail::Auto, Tail::None, Tail::Seconds(0.3)] {
        let alone = render_on(1, 64, tail);
        assert!(alone.1.iter().any(|bits| f32::from_bits(*bits).abs() > 0.1), "it sounds");
        for (threads, block) in [(1, 4096), (2, 4096), (3, 4096), (2, 600), (3, 65_536)] {
            assert!(render_on(threads, block, tail) == alone, "{threads} threads, blocks of {block}, {tail:?}");
        }
    }
}
