//! All orders in which hosts create, activate, start, reset, stop and destroy; port layouts, rates and block sizes.

use crate::host::reference::{At, assert_clean, assert_same_bits, assert_sound, render};
use crate::host::{Address, Instance, Player, Sent, Timed, open};
use crate::patches::{load, patches};
use crate::thorough;
use clack_extensions::audio_ports_config::{AudioPortsConfigBuffer, PluginAudioPortsConfig};
use clack_extensions::render::{PluginRender, RenderMode};
use clack_extensions::tail::TailLength;
use clack_host::prelude::*;
use sprung::engine::{EventKind, NoteId};
use sprung::params::Param;
use sprung::patch::Patch;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 9_600;

/// Two notes, as events of the host and of the engine.
fn two_notes() -> (Vec<Timed>, Vec<At>) {
    let note = |frame: u64, key: u8, id: i32| {
        let (address, velocity) = (Address::note(0, key.into(), id), 0.7_f32);
        let kind = EventKind::NoteOn { key, detune: 0.0, velocity, id: NoteId::new(id) };
        (Sent::On(address, velocity.into()).at(frame), At(frame, 0, kind))
    };
    [note(10, 57, 1), note(333, 64, 2)].into_iter().unzip()
}

#[track_caller]
fn plays_from_the_beginning(what: &str, player: &mut Player, patch: &Patch, rate: f64) {
    let (sent, events) = two_notes();
    let found = player.render(&sent, FRAMES, || 480).channels;
    assert_same_bits(what, &found, &render(patch, rate, &events, FRAMES));
}

pub(crate) fn every_rate_and_block_size_plays() {
    let mut blocks = [1, 2, 31, 64, 512, 1_000, 8_192];
    let rates = [1_234.567_8, 8_000.0, 11_025.0, 22_050.0, 44_100.0, 44_100.5, 96_000.0, 192_000.0, 768_000.0];
    for rate in rates {
        blocks.rotate_left(2);
        for &max_block in &blocks[..thorough::of(2, 7)] {
            let mut instance = Instance::new();
            let patch = patches().swap_remove(1).1;
            load(&mut instance, &patch);
            let mut player = instance.play(rate, max_block);
            let (sent, events) = two_notes();
            let found = player.render(&sent, FRAMES, || max_block as usize).channels;
            let what = format!("{rate} Hz, blocks of {max_block}");
            assert_sound(&what, &found);
            // The wrapper passes the sample rate in single precision.
            assert_same_bits(&what, &found, &render(&patch, f64::from(rate as f32), &events, FRAMES));
        }
    }
}

pub(crate) fn reset_and_reactivation_start_anew() {
    let (name, patch) = patches().swap_remove(4);
    let mut instance = Instance::new();
    load(&mut instance, &patch);
    let mut player = instance.play(RATE, 480);
    for round in 0..3 {
        plays_from_the_beginning(&format!("{name}, round {round}"), &mut player, &patch, RATE);
        player.render(&[Sent::Midi([0xE0, 0, 100]).at(0), Sent::Midi([0xB0, 64, 127]).at(9)], 960, || 480);
        player.audio.reset();
        assert!(player.render(&[], 960, || 480).channels.iter().flatten().all(|sample| *sample == 0.0), "silent");
        player.audio.reset();
    }
    for rate in [96_000.0, RATE, 22_050.0] {
        player = player.stop().play(rate, 480);
        plays_from_the_beginning(&format!("{name}, reactivated at {rate} Hz"), &mut player, &patch, rate);
    }
}

pub(crate) fn instances_do_not_hear_each_other() {
    let entry = open();
    let patches = patches();
    let mut players: Vec<(Player, Patch)> = patches[..4]
        .iter()
        .map(|(_, patch)| {
            let mut instance = Instance::of(&entry, true);
            load(&mut instance, patch);
            (instance.play(RATE, 64), patch.clone())
        })
        .collect();
    let (sent, events) = two_notes();
    let mut found = vec![vec![Vec::new(); 2]; players.len()];
    for block in 0..FRAMES / 64 {
        let inside = |timed: &&Timed| timed.frame / 64 == block as u64;
        let now: Vec<Timed> = sent.iter().filter(inside).map(|timed| timed.sent.at(timed.frame % 64)).collect();
        for ((player, _), found) in players.iter_mut().zip(&mut found) {
            let part = player.render(&now, 64, || 64).channels;
            found.iter_mut().zip(part).for_each(|(whole, part)| whole.extend(part));
        }
    }
    for (((_, patch), found), (name, _)) in players.iter().zip(&found).zip(&patches) {
        assert_same_bits(name, found, &render(patch, RATE, &events, found[0].len()));
    }
    // Some instances end, in any order, while the others continue to play.
    drop(players.remove(2).0.stop());
    drop(players.remove(0).0.stop());
    for (player, patch) in &mut players {
        player.audio.reset();
        plays_from_the_beginning("after others have gone", player, patch, RATE);
    }
}

/// One instance on each of several threads at the same time.
pub(crate) fn instances_on_several_threads_play_at_once() {
    let play = || {
        let patch = patches().swap_remove(2).1;
        for _ in 0..10 {
            let mut instance = Instance::new();
            load(&mut instance, &patch);
            plays_from_the_beginning("on a thread", &mut instance.play(RATE, 480), &patch, RATE);
        }
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(play)).collect();
        threads.into_iter().for_each(|thread| thread.join().unwrap());
    });
}

/// The layouts of ports: number, input buses, and channels of the output.
pub(crate) fn layouts() -> Vec<(ClapId, u32, u32)> {
    let mut instance = Instance::new();
    let handle = instance.clack.plugin_handle();
    let extension: PluginAudioPortsConfig = handle.get_extension().unwrap();
    let mut buffer = AudioPortsConfigBuffer::new();
    (0..extension.count(&handle))
        .map(|index| {
            let layout = extension.get(&handle, index, &mut buffer).unwrap();
            (layout.id, layout.input_port_count, layout.main_output.unwrap().channel_count)
        })
        .collect()
}

/// An instance with one of the layouts.
pub(crate) fn of_layout(id: ClapId) -> Instance {
    let mut instance = Instance::new();
    let handle = instance.clack.plugin_handle();
    let extension: PluginAudioPortsConfig = handle.get_extension().unwrap();
    extension.select(&handle, id).unwrap();
    instance
}

/// Stereo is the engine's output; mono is the mean of both sides; the input is ignored, even in the same memory.
pub(crate) fn every_layout_plays_and_ignores_its_input() {
    let patch = patches().swap_remove(1).1;
    let (sent, events) = two_notes();
    let stereo = render(&patch, RATE, &events, FRAMES);
    let mean: Vec<f32> = stereo[0].iter().zip(&stereo[1]).map(|(left, right)| 0.5 * (left + right)).collect();
    for (id, inputs, channels) in layouts() {
        for in_place in [false, true] {
            let mut instance = of_layout(id);
            load(&mut instance, &patch);
            let mut player = instance.play(RATE, 480);
            player.audio.feed_noise();
            if in_place {
                if inputs == 0 || channels != 2 {
                    continue;
                }
                player.audio.work_in_place();
            }
            let found = player.render(&sent, FRAMES, || 480).channels;
            let expected: &[Vec<f32>] = if channels == 1 { std::slice::from_ref(&mean) } else { &stereo };
            assert_same_bits(&format!("layout {id:?}, in place: {in_place}"), &found, expected);
        }
    }
}

/// The tail has the length of the remaining sound, exact to a control tick; then hosts may stop processing. In real
/// time the plugin computes the tail only from time to time, and reports an infinite tail until then.
pub(crate) fn the_tail_is_exact_and_then_the_plugin_may_sleep() {
    for mode in [RenderMode::Realtime, RenderMode::Offline] {
        let mut instance = Instance::new();
        {
            let handle = instance.clack.plugin_handle();
            let render: PluginRender = handle.get_extension().unwrap();
            render.set(&handle, mode).unwrap();
        }
        load(&mut instance, &Patch::default().with(Param::Decay, 1.0).with(Param::Release, 0.4));
        let mut player = instance.play(RATE, 64);
        assert_eq!(player.audio.tail(), TailLength::Finite(0), "nothing has sounded");
        let note = Address::note(0, 60, 1);
        let wait = if mode == RenderMode::Offline { 0 } else { 4_096 };
        player.render(&[Sent::On(note, 0.9).at(5), Sent::Off(note, 0.5).at(2_000)], 2_048 + wait, || 64);
        let TailLength::Finite(tail) = player.audio.tail() else { panic!("{mode:?}: the tail is finite") };
        let rest = player.render(&[], 96_000, || 64);
        let last = rest.channels.iter().filter_map(|channel| channel.iter().rposition(|sample| *sample != 0.0)).max();
        let sounding = last.unwrap() + 1;
        assert!((sounding..=sounding + 64).contains(&(tail as usize)), "{mode:?}: {tail} instead of {sounding}");
        assert_eq!(player.audio.tail(), TailLength::Finite(0), "all has died away");
        let status = player.audio.process(&EventBuffer::new(), 64);
        assert!(matches!(status, ProcessStatus::ContinueIfNotQuiet | ProcessStatus::Sleep), "{status:?} in silence");
        player.render(&[Sent::On(note, 0.9).at(0)], 64, || 64);
        let status = player.audio.process(&EventBuffer::new(), 64);
        assert!(matches!(status, ProcessStatus::Continue | ProcessStatus::Tail), "{status:?} while a note sounds");
    }
}

pub(crate) fn blocks_without_frames_and_short_blocks_do_no_harm() {
    let (mut instance, patch) = (Instance::new(), Patch::default());
    load(&mut instance, &patch);
    let mut player = instance.play(RATE, 512);
    assert_clean("empty blocks", &player.render(&[], 512, || 512).channels);
    for frames in [0, 1, 0, 3, 512, 0] {
        player.audio.process(&EventBuffer::new(), frames);
    }
    player.audio.reset();
    plays_from_the_beginning("after empty blocks", &mut player, &patch, RATE);
}

/// Repeated activation and starting without a block in between; switching to offline and back.
pub(crate) fn starts_and_stops_need_no_block_in_between() {
    let (mut instance, patch) = (Instance::new(), Patch::default());
    load(&mut instance, &patch);
    for round in 0..20 {
        instance = instance.play(44_100.0 + f64::from(round), 32 << (round % 5)).stop();
        let handle = instance.clack.plugin_handle();
        let mode = if round % 2 == 0 { RenderMode::Offline } else { RenderMode::Realtime };
        let render: PluginRender = handle.get_extension().unwrap();
        render.set(&handle, mode).unwrap();
    }
    plays_from_the_beginning("after all that", &mut instance.play(RATE, 480), &patch, RATE);
}

/// A host without the thread-check extension.
pub(crate) fn a_host_without_thread_checks_gets_the_same() {
    let mut instance = Instance::of(&open(), false);
    let patch = patches().swap_remove(1).1;
    load(&mut instance, &patch);
    plays_from_the_beginning("without thread checks", &mut instance.play(RATE, 480), &patch, RATE);
}

/// An audio thread plays the same samples as the main thread.
pub(crate) fn audio_may_run_on_any_thread() {
    let mut instance = Instance::new();
    let patch = patches().swap_remove(1).1;
    load(&mut instance, &patch);
    let Player { instance, mut audio } = instance.play(RATE, 480);
    let (sent, events) = two_notes();
    let (audio, found) = std::thread::spawn(move || {
        let mut found = vec![Vec::new(); 2];
        let mut buffer = EventBuffer::new();
        for start in (0..FRAMES as u64).step_by(480) {
            buffer.clear();
            let inside = sent.iter().filter(|timed| (start..start + 480).contains(&timed.frame));
            inside.for_each(|timed| timed.sent.push((timed.frame - start) as u32, &mut buffer));
            audio.process(&buffer, 480);
            found.iter_mut().zip(audio.outputs()).for_each(|(whole, part)| whole.extend(part));
        }
        (audio, found)
    })
    .join()
    .unwrap();
    assert_same_bits("on another thread", &found, &render(&patch, RATE, &events, FRAMES));
    Player { instance, audio }.stop();
}
