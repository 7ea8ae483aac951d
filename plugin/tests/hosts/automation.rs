//! Parameter changes take effect at their frames, with the same bits as in the engine.

use crate::host::reference::{At, assert_same_bits, render};
use crate::host::{Address, Instance, Player, Sent, Timed};
use crate::parameters::host_value;
use crate::patches::load;
use sprung::engine::{EventKind, NoteId};
use sprung::params::{PARAMS, Param};
use sprung::patch::Patch;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 6_400;

/// Block sizes that put events at the start, at the end and in the middle of blocks.
const BLOCKS: [usize; 4] = [1, 64, 480, 4_801];

/// A sound in which most parameters are audible.
pub(crate) fn patch() -> Patch {
    Patch::default().with(Param::MalletPulse, 1.0).with(Param::Vibrato, 20.0).with(Param::Decay, 0.8)
}

/// A note, as the host's event and as the engine's.
pub(crate) fn on(frame: u64, channel: u8, key: u8, id: i32, velocity: f32) -> (Timed, At) {
    let note = Address::note(channel.into(), key.into(), id);
    let sent = Sent::On(note, velocity.into()).at(frame);
    (sent, At(frame, channel, EventKind::NoteOn { key, detune: 0.0, velocity, id: NoteId::new(id) }))
}

/// Plays a song in a host and on the engine, compares the bits, and returns the sound.
#[track_caller]
pub(crate) fn compare(what: &str, patch: &Patch, song: &[(Timed, At)]) -> [Vec<f32>; 2] {
    compare_in(&mut player(), &BLOCKS, what, patch, song)
}

/// The same for one of many parameters, of which each has its block size: how blocks are divided does not depend on them.
#[track_caller]
pub(crate) fn compare_one(player: &mut Player, param: Param, what: &str, patch: &Patch, song: &[(Timed, At)]) {
    compare_in(player, &[BLOCKS[param as usize % BLOCKS.len()]], what, patch, song);
}

#[track_caller]
fn compare_in(player: &mut Player, blocks: &[usize], what: &str, patch: &Patch, song: &[(Timed, At)]) -> [Vec<f32>; 2] {
    let (sent, events): (Vec<Timed>, Vec<At>) = song.iter().copied().unzip();
    let expected = render(patch, RATE, &events, FRAMES);
    for &block in blocks {
        load(&mut player.instance, patch);
        player.render(&[], 1, || 1);
        player.audio.reset();
        let found = player.render(&sent, FRAMES, || block);
        assert_same_bits(&format!("{what}, blocks of {block}"), &found.channels, &expected);
    }
    expected
}

/// An instance for one song after the other, since it takes longer to make one than to play a song.
pub(crate) fn player() -> Player {
    Instance::new().play(RATE, 8_192)
}

/// Each parameter changes three times while notes sound, and once before a note, for changes that only new notes use.
pub(crate) fn a_parameter_changes_at_its_frame() {
    let mut player = player();
    for info in PARAMS {
        let id = player.instance.id(info.param);
        let mut song = vec![on(0, 0, 60, 1, 0.9), on(7, 0, 67, 2, 0.5)];
        let mut now = patch().get(info.param);
        for (frame, position) in [(1_001, 0.3), (2_777, 0.8), (2_778, 0.55)] {
            let value = info.denormalise(f64::from(position as f32));
            // Between two values of the table, the host's position decides which of them is meant.
            let host = host_value(info, value);
            let value = if host.fract() == 0.0 { value } else { info.denormalise(f64::from(host as f32)) };
            // The plugin drops changes to the same value, since the engine would start a new ramp at their frame.
            if std::mem::replace(&mut now, value) != value {
                let event = EventKind::Param { param: info.param, value };
                song.push((Sent::Value(id, host).at(frame), At(frame, 0, event)));
            }
            song.push(on(frame + 300, 0, 55 + frame as u8 % 7, frame as i32, 0.7));
        }
        song.sort_by_key(|(sent, _)| sent.frame);
        compare_one(&mut player, info.param, info.id, &patch(), &song);
    }
}

/// Many changes at one frame, and one change at each of many neighbouring frames.
pub(crate) fn changes_may_be_as_dense_as_frames() {
    let mut instance = Instance::new();
    let [gain, tune] = [Param::Gain, Param::Tune].map(|param| (param, instance.id(param)));
    let mut song = vec![on(0, 0, 60, 1, 0.9)];
    for frame in 100..400 {
        for (param, id) in [gain, tune] {
            let position = (frame % 97) as f32 / 97.0;
            let value = param.info().denormalise(position.into());
            song.push((Sent::Value(id, position.into()).at(frame), At(frame, 0, EventKind::Param { param, value })));
        }
    }
    compare("dense", &patch(), &song);
}
