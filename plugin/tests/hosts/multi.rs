//! Sprung Multi: its ports, what goes to them, and its state, which is that of Sprung.

use crate::host::reference::assert_same_bits;
use crate::host::{Address, Instance, Rendered, Sent, Timed};
use crate::patches::{drums, load, state_of_kit};
use crate::state::values;
use clack_extensions::audio_ports::{AudioPortFlags, AudioPortInfoBuffer, PluginAudioPorts};
use sprung::params::Param;
use sprung::preset::{Playable, Preset};

const FRAMES: usize = 24_000;

/// The drums without what is behind the voices. The pads are on outputs 1 to 16 in turn if `spread` says so, or on the main one.
fn kit(spread: bool) -> Vec<u8> {
    let Playable::Kit(mut kit) = drums() else { panic!("a kit") };
    kit.params = vec![(Param::Limiter, 0.0)];
    for ((_, pad), output) in kit.pads.iter_mut().zip((1..=16).cycle()) {
        pad.output = if spread { output } else { 0 };
    }
    state_of_kit(&Playable::Kit(kit))
}

/// Every pad of the drums once.
fn strikes() -> Vec<Timed> {
    let Playable::Kit(kit) = drums() else { panic!("a kit") };
    let strikes = kit.pads.iter().zip(0_u16..).map(|((key, _), n)| {
        let note = Address::note(0, i16::from(*key), i32::from(n));
        Sent::On(note, 0.4).at(u64::from(n) * 700)
    });
    strikes.collect()
}

fn play(mut instance: Instance, state: &[u8], song: &[Timed]) -> Rendered {
    assert!(instance.load(state));
    let mut lens = [64, 480, 1, 333].into_iter().cycle();
    instance.play(48_000.0, 480).render(song, FRAMES, || lens.next().unwrap())
}

fn is_silent(channels: &[Vec<f32>]) -> bool {
    channels.iter().flatten().all(|sample| sample.to_bits() == 0)
}

pub(crate) fn sixteen_stereo_outputs_follow_the_main_one() {
    let mut instance = Instance::multi();
    let handle = instance.clack.plugin_handle();
    let ports: PluginAudioPorts = handle.get_extension().unwrap();
    assert_eq!((ports.count(&handle, true), ports.count(&handle, false)), (0, 17));
    let mut buffer = AudioPortInfoBuffer::new();
    for index in 0..17 {
        let port = ports.get(&handle, index, false, &mut buffer).unwrap();
        assert_eq!((port.channel_count, port.flags.contains(AudioPortFlags::IS_MAIN)), (2, index == 0));
        if index > 0 {
            assert_eq!(String::from_utf8_lossy(port.name), format!("Output {index}"));
        }
    }
}

pub(crate) fn pads_go_to_their_outputs_which_add_up_to_the_plain_plugin() {
    let song = strikes();
    let expected = play(Instance::new(), &kit(true), &song);
    assert_eq!(expected.channels.len(), 2);
    let all = play(Instance::multi(), &kit(true), &song);
    assert_eq!(all.channels.len(), 34);
    assert!(is_silent(&all.channels[..2]), "every pad is elsewhere");
    let outputs = all.channels.chunks(2).skip(1);
    assert_eq!(outputs.clone().filter(|output| !is_silent(output)).count(), song.len().min(16));
    assert_eq!(all.ended, expected.ended);
    for (side, expected) in expected.channels.iter().enumerate() {
        for (frame, expected) in expected.iter().enumerate() {
            let sum: f64 = all.channels.iter().skip(side).step_by(2).map(|channel| f64::from(channel[frame])).sum();
            assert!((sum - f64::from(*expected)).abs() < 4e-6, "frame {frame}: {sum} instead of {expected}");
        }
    }
    let unspread = play(Instance::multi(), &kit(false), &song);
    assert_same_bits("all on the main output", &unspread.channels[..2], &expected.channels);
    assert!(is_silent(&unspread.channels[2..]));
}

pub(crate) fn channels_go_to_the_outputs_of_their_numbers() {
    let mut instance = Instance::multi();
    load(&mut instance, &Preset::find("Marimba").unwrap().patch.clone().with(Param::Space, 0.0));
    let mut player = instance.play(48_000.0, 480);
    let on = |channel, frame| Sent::On(Address::key(channel, 60), 0.8).at(frame);
    let rendered = player.render(&[on(0, 0), on(1, 10), on(9, 20), on(15, 30)], 4_800, || 480);
    let ports = rendered.channels.chunks(2).enumerate().filter(|(_, port)| !is_silent(port));
    assert_eq!(ports.map(|(index, _)| index).collect::<Vec<_>>(), [0, 2, 10, 16]);
}

pub(crate) fn states_move_between_both() {
    let state = kit(true);
    let mut multi = Instance::multi();
    assert!(multi.load(&state));
    let saved = multi.save();
    let mut plain = Instance::new();
    assert!(plain.load(&saved));
    assert_eq!(plain.save(), saved, "from Sprung Multi to Sprung");
    let (mut back, song) = (Instance::multi(), strikes());
    assert!(back.load(&plain.save()));
    assert_eq!((back.save(), values(&mut back)), (saved.clone(), values(&mut plain)));
    let (before, after) = (play(multi, &state, &song), play(back, &saved, &song));
    assert_same_bits("there and back", &after.channels, &before.channels);
}
