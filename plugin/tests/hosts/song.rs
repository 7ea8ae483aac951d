//! With the same song, patch, seed and rate, the command's renderer and the plugin in a host give the same bits.

use crate::host::reference::{assert_same_bits, assert_sound};
use crate::host::{Instance, Player, Timed};
use crate::lifecycle::{layouts, of_layout};
use crate::patches::{drums, load, patches, state_of_kit};
use crate::phrase::{self, Dialect, FRAMES, SAMPLE_RATE};
use crate::thorough;
use sprung::engine::{Event, EventKind, Synth};
use sprung::internals::random::{key, uniform};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::patch::routes::Source;
use sprung::render::{Job, Options, Tail};
use sprung::sound::Kit;
use std::path::Path;
use std::sync::Arc;

/// A name, and a function that returns the length of each next block.
pub(crate) type Division = (&'static str, Box<dyn FnMut() -> usize>);

/// Ways to divide a song into blocks.
pub(crate) fn divisions() -> Vec<Division> {
    let mut n = 0;
    let random = move || {
        n += 1;
        1 + ((uniform(key(7, 0), n) + 1.0) * 450.0) as usize
    };
    vec![
        ("blocks of 1", Box::new(|| 1)),
        ("blocks of 64", Box::new(|| 64)),
        ("blocks of 480", Box::new(|| 480)),
        ("blocks of 8192", Box::new(|| 8192)),
        ("random blocks", Box::new(random)),
    ]
}

/// One of the divisions, for each case another: neither songs nor the ways to send them depend on them. All in the long suite.
pub(crate) fn some_divisions(case: usize) -> impl Iterator<Item = Division> {
    let mut all = divisions();
    let (count, first) = (thorough::of(1, all.len()), case % all.len());
    all.rotate_left(first);
    all.into_iter().take(count)
}

/// The samples that `sprung render` makes from a MIDI file.
pub(crate) fn rendered_by_the_command(midi: &[u8], kit: &Arc<Kit>) -> Vec<Vec<f32>> {
    let song = phrase::song(midi);
    let options = Options { sample_rate: SAMPLE_RATE, tail: Tail::None, ..Options::default() };
    rendered(&Job::new(&song, kit, options))
}

pub(crate) fn rendered(job: &Job) -> Vec<Vec<f32>> {
    job.samples().unwrap().into()
}

fn player(patch: &Patch) -> Player {
    let mut instance = Instance::new();
    load(&mut instance, patch);
    instance.play(f64::from(SAMPLE_RATE), 8192)
}

pub(crate) fn one_channel_has_the_bits_of_the_command() {
    let midi = phrase::midi_file();
    for ((name, patch), case) in patches().into_iter().zip((0..).step_by(2)) {
        let expected = rendered_by_the_command(&midi, &Kit::of_patch(&patch));
        assert_sound(name, &expected);
        for dialect in [Dialect::Clap, Dialect::Midi] {
            let sent = phrase::sent(&phrase::messages(), dialect);
            for (division, block) in some_divisions(case + dialect as usize) {
                let found = player(&patch).render(&sent, FRAMES, block).channels;
                assert_same_bits(&format!("{name}, {dialect:?}, {division}"), &found, &expected);
            }
        }
    }
}

/// A file that configures an MPE zone is played on one instrument, as in the plugin.
pub(crate) fn an_mpe_performance_has_the_bits_of_the_command() {
    let messages = phrase::mpe_messages();
    let midi = phrase::file(&messages);
    for ((name, patch), case) in patches().into_iter().zip(1..) {
        let patch = patch.with_route(1, Source::Pressure, Param::Vibrato, 5.0).with(Param::Voices, 16.0);
        let expected = rendered_by_the_command(&midi, &Kit::of_patch(&patch));
        assert_sound(name, &expected);
        let mut dialects = [Dialect::Clap, Dialect::Midi];
        dialects.rotate_left(case % 2);
        for dialect in dialects.into_iter().take(thorough::of(1, 2)) {
            for (division, block) in some_divisions(case) {
                let found = player(&patch).render(&phrase::sent(&messages, dialect), FRAMES, block).channels;
                assert_same_bits(&format!("MPE, {name}, {dialect:?}, {division}"), &found, &expected);
            }
        }
    }
}

/// A kit in a project, with notes on its keys.
pub(crate) fn a_kit_has_the_bits_of_the_command() {
    let messages = phrase::kit_messages();
    let drums = drums();
    let expected = rendered_by_the_command(&phrase::file(&messages), &drums.kit());
    assert_sound("drums", &expected);
    for dialect in [Dialect::Clap, Dialect::Midi] {
        let sent = phrase::sent(&messages, dialect);
        for (division, block) in some_divisions(1 + dialect as usize) {
            let mut instance = Instance::new();
            assert!(instance.load(&state_of_kit(&drums)), "the plugin takes a state with a kit");
            let mut player = instance.play(f64::from(SAMPLE_RATE), 8192);
            let found = player.render(&sent, FRAMES, block).channels;
            assert_same_bits(&format!("drums, {dialect:?}, {division}"), &found, &expected);
        }
    }
}

/// Audio input of the plugin, and the same input as a file in the command.
pub(crate) fn sound_that_comes_in_has_the_bits_of_the_command() {
    let midi = phrase::midi_file();
    let song = phrase::song(&midi);
    let input: Vec<f32> = (0..FRAMES as u64 / 2).map(|n| 0.2 * uniform(key(9, 0), n)).collect();
    let (id, ..) =
        layouts().into_iter().find(|(_, inputs, channels)| (*inputs, *channels) == (1, 2)).expect("a layout");
    for ((name, patch), case) in patches().into_iter().zip(2..) {
        let silent = rendered_by_the_command(&midi, &Kit::of_patch(&patch));
        let patch = patch.with(Param::InputLevel, -6.0);
        let options = Options { sample_rate: SAMPLE_RATE, tail: Tail::None, ..Options::default() };
        let kit = Kit::of_patch(&patch);
        let expected = rendered(&Job { input: &input, ..Job::new(&song, &kit, options) });
        assert!(expected != silent, "{name}: what comes in is heard");
        for (division, block) in some_divisions(case) {
            let mut instance = of_layout(id);
            load(&mut instance, &patch);
            let mut player = instance.play(f64::from(SAMPLE_RATE), 8192);
            player.audio.feed(input.clone());
            let found = player.render(&phrase::sent(&phrase::messages(), Dialect::Midi), FRAMES, block).channels;
            assert_same_bits(&format!("{name} with input, {division}"), &found, &expected);
        }
    }
}

/// The sixteen channels of the demo songs on one instance: the bits of one synth of the engine.
pub(crate) fn sixteen_channels_have_the_bits_of_one_synth() {
    for (song, case) in [("groove", 1), ("suite", 4)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../assets/midi/{song}.mid"));
        let midi = std::fs::read(path).unwrap();
        let frames = 20 * SAMPLE_RATE as usize;
        let mut messages = phrase::messages_of(&midi, SAMPLE_RATE.into());
        messages.retain(|(frame, _)| *frame < frames as u64);
        let (name, patch) = patches().swap_remove(1);
        let expected = played_by_one_synth(&messages, &patch, frames);
        for (division, block) in some_divisions(case) {
            let sent: Vec<Timed> = phrase::sent(&messages, Dialect::Midi);
            let found = player(&patch).render(&sent, frames, block).channels;
            assert_same_bits(&format!("{song}, {name}, {division}"), &found, &expected);
        }
    }
}

/// Plays messages on the engine's synth, in one block.
fn played_by_one_synth(messages: &[(u64, [u8; 3])], patch: &Patch, frames: usize) -> Vec<Vec<f32>> {
    let mut synth = Synth::new(SAMPLE_RATE.into(), 0);
    synth.reserve_space();
    synth.set_patch(patch);
    synth.reset();
    let mut channels = vec![vec![0.0; frames]; 2];
    let [left, right] = channels.as_mut_slice() else { unreachable!("there are two") };
    let events: Vec<Event> = messages
        .iter()
        .map(|(frame, data)| {
            let (channel, kind): (u8, EventKind) =
                sprung::engine::midi::parse_message(data).expect("a channel message");
            Event { frame: *frame as u32, channel, kind }
        })
        .collect();
    synth.process(&events, left, right);
    channels
}
