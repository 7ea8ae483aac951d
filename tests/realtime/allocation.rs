//! The audio callback never allocates, with song, live events, patches and recording: checked by an allocator that forbids it.

use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::engine::EventKind;
use sprung::internals::files::{Inputs, Output, Target};
use sprung::internals::learned::Controllers;
use sprung::internals::realtime::{DeviceSample, Moment, Recording};
use sprung::io::Song;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::realtime::{LiveInputs, Player, Setup, Source, Status};
use sprung::sound::{Kit, Tuning};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Plays half a second in blocks of `frames`, with everything happening at the same time.
fn play<T: DeviceSample>(frames: usize, channels: usize) {
    let directory = tempfile::tempdir().unwrap();
    let output = Output::create(&Target::new(directory.path().join("take.wav")), false, &Inputs::default()).unwrap();
    let (tap, recording) = Recording::start(output, 48_000).unwrap();
    let ([mut keys], inputs) = LiveInputs::new();
    let status = Arc::new(Status::default());
    let song = Song::chord(&[40.0, 50.5, 60.0, 70.0], 1.0, 0.2);
    let kit = Kit::of_patch(&Patch::default());
    let setup = Setup {
        sample_rate: 48_000,
        seed: 0,
        kit: &kit,
        channels: &[],
        programs: &[kit.clone(), kit.clone(), kit.clone()],
        mix: None,
        tuning: &Tuning::EQUAL,
        song: Some(song),
    };
    let (player, mut kits) = Player::new(setup, inputs, Some(tap), status.clone());
    let mut player = player.with_controllers(&Controllers::from([(21, Param::Tilt)]));
    let start = Instant::now();
    let mut out = vec![T::SILENCE; frames * channels];
    let mut blocks_with_sound = 0;
    for block in 0..24_000 / frames as u32 {
        for n in 0..12_u8 {
            let key = (30 + 7 * u32::from(n) + block % 20) as u8;
            keys.send_now(n, EventKind::NoteOn { key, detune: 0.0, velocity: 0.7, id: None });
            keys.send_now(n, EventKind::Program(n % 4));
            keys.send_now(n, EventKind::PitchBend(0.1));
            keys.send_now(n, EventKind::Control { controller: 21, value: f32::from(n) / 11.0 });
        }
        kits.send((block % 16) as u8, &Kit::of_patch(&Patch::default()));
        let _ = (status.telemetry().snapshot(), status.telemetry().load());
        let since = Duration::from_secs_f64(f64::from(block) * frames as f64 / 48_000.0);
        let moment = Moment { now: start + since, called: since, heard: since };
        assert_no_alloc(|| player.fill(&mut out, channels, moment));
        blocks_with_sound += usize::from(status.telemetry().take_peaks()[0] > 0.01);
    }
    assert!(blocks_with_sound > 2, "something sounded");
    drop(player);
    assert!(recording.finish().unwrap().frames > 0);
    assert_eq!(violation_count(), 0, "allocations in the audio callback");
}

#[test]
fn filling_a_block_allocates_nothing() {
    play::<f32>(64, 2);
    play::<i16>(480, 1);
    play::<i32>(6000, 8);
    play::<u8>(1, 3);
}
