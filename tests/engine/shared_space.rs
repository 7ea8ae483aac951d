//! The space that the channels of an ensemble share: sends, blocks and threads, and its tail.

use crate::events::{off, on};
use crate::in_blocks::in_blocks;
use crate::workers::Backwards;
use sprung::engine::{Ensemble, Event, EventKind};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::sound::Mix;

/// The MIDI controller that sends a channel to the shared space.
const REVERB_SEND: u8 = 91;

const RATE: f64 = 48_000.0;

fn dry() -> Ensemble {
    let patch = Patch::default().with(Param::Decay, 0.1).with(Param::Gain, -12.0).with(Param::Limiter, 0.0);
    Ensemble::new(RATE, 1, &patch, &[])
}

fn room() -> Mix {
    let space = vec![(Param::Space, 3.0), (Param::SpaceLowDecay, 0.3), (Param::SpaceHighDecay, 0.2)];
    Mix { space, ..Mix::default() }
}

fn send(frame: u32, channel: u8, value: u8) -> Event {
    Event { frame, channel, kind: EventKind::Control { controller: REVERB_SEND, value: f32::from(value) / 127.0 } }
}

fn samples(mut ensemble: Ensemble, events: &[Event], frames: usize, block: usize) -> Vec<f32> {
    let process = |events: &[Event], left: &mut [f32], right: &mut [f32]| ensemble.process(events, left, right);
    in_blocks(events, frames, block, process).into_iter().map(f32::from_bits).collect()
}

/// The sound that the space adds to a note at the reverb send `value`.
fn added(value: Option<u8>) -> Vec<f32> {
    let events: Vec<Event> = value.map(|value| send(0, 0, value)).into_iter().chain([on(2000, 60)]).collect();
    let (with, without) = (dry().with_mix(&room()), dry());
    let [with, without] = [with, without].map(|ensemble| samples(ensemble, &events, 12_000, 12_000));
    with.iter().zip(&without).map(|(with, without)| with - without).collect()
}

#[test]
fn a_channel_sends_what_its_controller_says() {
    assert!(added(Some(0)).iter().all(|sample| *sample == 0.0), "without a send the mix keeps its bits");
    assert_eq!(added(None), added(Some(40)), "the send of General MIDI 2");
    let power = |value| added(Some(value)).iter().map(|sample| f64::from(*sample * *sample)).sum::<f64>();
    let ratio = (power(127) / power(40)).sqrt();
    assert!((ratio / (127.0 / 40.0) - 1.0).abs() < 1e-3, "{ratio}");
}

#[test]
fn each_channel_has_a_send_of_its_own() {
    let notes = [Event { channel: 3, ..on(2000, 60) }, Event { channel: 5, ..on(2000, 67) }];
    let heard = |ensemble: Ensemble, sends: &[Event]| samples(ensemble, &[sends, &notes].concat(), 9600, 480);
    let none = [3, 5].map(|channel| send(0, channel, 0));
    assert!(heard(dry().with_mix(&room()), &none) == heard(dry(), &[]));
    let only = |channel: u8| heard(dry().with_mix(&room()), &[send(0, 3, 0), send(1, 5, 0), send(2, channel, 127)]);
    let (third, fifth) = (only(3), only(5));
    assert!(third != fifth && third != heard(dry(), &[]));
}

#[test]
fn values_out_of_range_are_taken_as_the_nearest() {
    let sent = |value: f32| {
        let kind = EventKind::Control { controller: REVERB_SEND, value };
        samples(dry().with_mix(&room()), &[Event { kind, ..on(0, 0) }, on(2000, 60)], 9600, 480)
    };
    for (odd, plain) in [(f32::NAN, 0.0), (-1.0, 0.0), (2.0, 1.0)] {
        assert_eq!(sent(odd), sent(plain), "{odd}");
    }
}

#[test]
fn a_send_that_jumps_under_a_note_does_not_click() {
    let wet = |sends: &[Event]| {
        let mut events = [sends, &[on(2000, 60)]].concat();
        events.sort_by_key(|event| event.frame);
        let [with, without] = [dry().with_mix(&room()), dry()].map(|ensemble| samples(ensemble, &events, 4000, 480));
        with.iter().zip(&without).map(|(with, without)| with - without).collect::<Vec<f32>>()
    };
    let jump = |wet: &[f32]| wet[2000..4000].windows(2).fold(0.0_f32, |most, pair| most.max((pair[1] - pair[0]).abs()));
    let (always, late) = (jump(&wet(&[send(0, 0, 127)])), jump(&wet(&[send(0, 0, 0), send(2500, 0, 127)])));
    assert!(late > 0.0 && late < always, "{late} and {always}");
}

#[test]
fn it_falls_asleep_and_wakes_at_the_same_frame_in_all_blocks() {
    let space = [(Param::Space, 3.0), (Param::SpaceLowDecay, 0.05), (Param::SpaceHighDecay, 0.05)];
    let mix = Mix { space: space.to_vec(), ..Mix::default() };
    let events = [send(0, 0, 127), on(10, 60), off(20, 60), send(30_000, 0, 60), on(40_001, 72)];
    let mut asleep = dry().with_mix(&mix);
    asleep.process(&events[..3], &mut [0.0; 30_000], &mut [0.0; 30_000]);
    assert!(asleep.is_silent(), "it sleeps between the notes");
    let whole = samples(dry().with_mix(&mix), &events, 48_000, 48_000);
    for block in [1, 37, 480] {
        let parts = samples(dry().with_mix(&mix), &events, 48_000, block);
        assert_eq!(whole.iter().zip(&parts).position(|(a, b)| a != b), None, "blocks of {block}");
    }
}

#[test]
fn blocks_chunks_and_the_order_of_parts_make_no_difference() {
    let channels = (0..16).map(|channel| Event { channel, ..on(100 * u32::from(channel), 40 + 2 * channel) });
    let sends = (0..16).map(|channel| send(1500 + 7 * u32::from(channel), channel, 8 * channel));
    let events: Vec<Event> = channels.chain(sends).chain([off(5000, 40), on(9000, 60), send(9001, 0, 127)]).collect();
    let whole = samples(dry().with_mix(&room()), &events, 24_000, 24_000);
    assert!(whole.iter().any(|sample| sample.abs() > 0.01));
    for (chunk, block) in [(1024, 37), (77, 24_000), (4096, 4096)] {
        let parts = samples(dry().with_mix(&room()).with_chunk(chunk), &events, 24_000, block);
        assert_eq!(whole.iter().zip(&parts).position(|(a, b)| a != b), None, "chunks of {chunk}, blocks of {block}");
    }
    let mut ensemble = dry().with_mix(&room());
    let backwards = in_blocks(&events, 24_000, 512, |events, left, right| {
        ensemble.process_by(&Backwards, events, &[], left, right);
    });
    assert!(backwards.into_iter().map(f32::from_bits).eq(whole));
}

#[test]
fn it_rings_on_after_the_notes_and_then_falls_silent() {
    let mut ensemble = dry().with_mix(&room());
    let (mut left, mut right) = ([0.0; 4800], [0.0; 4800]);
    ensemble.process(&[send(0, 0, 127), on(0, 60)], &mut left, &mut right);
    let mut alone = dry();
    alone.process(&[on(0, 60)], &mut [0.0; 4800], &mut [0.0; 4800]);
    let tenths = (1..100).find(|_| {
        alone.process(&[], &mut [0.0; 4800], &mut [0.0; 4800]);
        ensemble.process(&[], &mut left, &mut right);
        alone.is_silent()
    });
    assert!(tenths.is_some() && !ensemble.is_silent());
    assert!(left.iter().any(|sample| sample.abs() > 1e-6));
    let more = (1..20).find(|_| {
        ensemble.process(&[], &mut left, &mut right);
        ensemble.is_silent()
    });
    assert!(more.is_some(), "0.3 s of T60 take less than 2 s to −120 dBFS");
    ensemble.process(&[], &mut left, &mut right);
    assert!(left.iter().chain(&right).all(|sample| *sample == 0.0));
}

#[test]
fn the_gain_of_a_mix_is_that_of_all_that_sounds() {
    let events = [send(0, 0, 127), on(10, 60)];
    let plain = samples(dry().with_mix(&room()), &events, 9600, 480);
    let softer = samples(dry().with_mix(&Mix { gain: -20.0, ..room() }), &events, 9600, 480);
    assert!(plain.iter().zip(&softer).all(|(plain, softer)| (0.1 * plain - softer).abs() <= 1e-6 * plain.abs()));
    assert!(softer.iter().any(|sample| sample.abs() > 0.001));
}
