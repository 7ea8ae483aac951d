//! Controllers that the user has bound turn their knobs at their frames, with the engine's bits and without jumps, and are told.

use crate::automation::on;
use crate::host::reference::{At, assert_same_bits, render};
use crate::host::{Address, Instance, Sent};
use crate::patches::load;
use crate::process::{command, succeeds};
use sprung::engine::EventKind;
use sprung::params::Param;
use sprung::patch::Patch;
use std::path::Path;
use std::process::{Command, ExitCode};

const RATE: f64 = 48_000.0;
const FRAMES: usize = 9_600;

/// Gives a process a user who has bound these controllers.
pub(crate) fn bind(command: &mut Command, home: &Path, controllers: &str) {
    std::fs::create_dir_all(home.join("sprung")).unwrap();
    std::fs::write(home.join("sprung/controllers.toml"), controllers).unwrap();
    command.env("XDG_DATA_HOME", home);
}

pub(crate) fn a_bound_controller_has_the_bits_of_the_engine() {
    let home = tempfile::tempdir().unwrap();
    let mut command = command("controllers");
    bind(&mut command, home.path(), "tilt = 7\n");
    succeeds(command);
}

/// Runs in the process that the test starts.
pub(crate) fn work() -> ExitCode {
    let tilt = Param::Tilt.info();
    let patch = Patch::default().with(Param::Decay, 2.0).with(Param::Tilt, tilt.denormalise(0.5));
    let control = |frame, position| Sent::Midi([0xB4, 7, position]).at(frame);
    let at = |position: u8| f32::from(position) / 127.0;
    let moved = |frame, position| {
        At(frame, 0, EventKind::Param { param: Param::Tilt, value: tilt.denormalise(at(position).into()) })
    };
    let notes = [on(0, 0, 60, 1, 0.9), on(3_000, 0, 67, 2, 0.5)];
    // The first two do not reach it. The note of frame 0 ends before the last one, and is told before.
    let ends = Sent::Choke(Address::id(1)).at(5_000);
    let positions = [(1_000, 10), (1_001, 30), (2_777, 90), (2_778, 100), (3_000, 20), (8_000, 21)];
    let mut sent: Vec<_> = notes.iter().map(|(sent, _)| *sent).chain([ends]).collect();
    sent.extend(positions.map(|(frame, position)| control(frame, position)));
    sent.sort_by_key(|sent| sent.frame);
    let choked = sprung::engine::Notes { id: sprung::engine::NoteId::new(1), ..Default::default() };
    let mut expected: Vec<At> = notes.iter().map(|(_, at)| *at).collect();
    expected.push(At(5_000, 0, EventKind::Silence { notes: choked }));
    expected.extend(positions[2..].iter().map(|(frame, position)| moved(*frame, *position)));
    // Parameters come first at their frame.
    expected.sort_by_key(|At(frame, _, kind)| (*frame, !matches!(kind, EventKind::Param { .. })));
    let expected = render(&patch, RATE, &expected, FRAMES);
    for block in [1, 64, 480, 4_801] {
        let mut instance = Instance::new();
        let id = instance.id(Param::Tilt);
        load(&mut instance, &patch);
        let mut player = instance.play(RATE, 8_192);
        let rendered = player.render(&sent, FRAMES, || block);
        assert_same_bits(&format!("blocks of {block}"), &rendered.channels, &expected);
        let told: Vec<_> = rendered.values.iter().map(|(frame, of, value)| (*frame, *of, *value as f32)).collect();
        assert_eq!(
            told,
            positions[2..].iter().map(|(frame, position)| (*frame, id, at(*position))).collect::<Vec<_>>()
        );
        assert!(rendered.is_in_order, "hosts are told in the order of the frames");
        assert_eq!(player.stop().value(id).map(|value| value as f32), Some(at(21)));
    }
    ExitCode::SUCCESS
}
