//! Effects behind the voices in the engine: blocks, idling, tails, clicks, kits, and that an effect that is off changes no bit.

use crate::events::{event, off, on};
use crate::in_blocks::in_blocks;
use crate::workers::Backwards;
use sprung::engine::{Ensemble, Event, EventKind, Synth};
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::{Routes, Source};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::sound::{Kit, Pad, Sound};
use std::sync::Arc;

const RATE: f64 = 48_000.0;

const PLATE: f32 = 1.0;
const SPRING: f32 = 2.0;
const ROOM: f32 = 3.0;

const GUITAR: f32 = 2.0;
const VOICE: f32 = 4.0;

/// The parameter sections of the effects behind the voices.
const SECTIONS: [&str; 6] = ["Soundbox", "Strings", "Tremolo", "Drive", "Tone", "Space"];

/// Three short modes, panned to both sides.
fn dry() -> Patch {
    let modes = [(1.0, 0.6, 0.7), (2.7, 0.25, -0.9), (5.1, 0.1, 0.4)];
    let modes = modes.map(|(ratio, level, pan)| Mode { ratio, level, pan, ..Mode::UNIT });
    let patch = Patch::default().with(Param::Decay, 0.2).with(Param::Gain, -12.0).with(Param::Limiter, 0.0);
    Patch { modes: ModeTable::new(&modes), ..patch }
}

/// All sections on, with a body.
fn wet(space: f32) -> Patch {
    dry()
        .with(Param::Soundbox, GUITAR)
        .with(Param::SoundboxMix, 60.0)
        .with(Param::StringsLevel, 40.0)
        .with(Param::StringsLowDecay, 0.3)
        .with(Param::StringsHighDecay, 0.1)
        .with(Param::TremoloDepth, 50.0)
        .with(Param::TremoloStereo, 50.0)
        .with(Param::Drive, 6.0)
        .with(Param::ToneLow, 3.0)
        .with(Param::ToneHigh, -4.0)
        .with(Param::Space, space)
        .with(Param::SpaceLowDecay, 0.2)
        .with(Param::SpaceHighDecay, 0.1)
        .with(Param::SpacePreDelay, 0.01)
        .with(Param::StereoWidth, 150.0)
}

/// A kit of two sounds on alternate keys.
fn kit_of(patches: [Patch; 2]) -> Arc<Kit> {
    let sounds = patches.map(|patch| Arc::new(Sound::new(patch))).into();
    let pads = (0..128).map(|key| Some(Pad::of(key % 2))).collect();
    Arc::new(Kit::new(String::new(), sounds, pads))
}

fn set(frame: u32, param: Param, value: f32) -> Event {
    event(frame, EventKind::Param { param, value })
}

/// The bits of both channels, rendered in blocks of one size, and the synth's `is_silent` and `tail_frames` at the end.
fn synth_bits(patch: &Patch, events: &[Event], frames: usize, block: usize) -> (Vec<u32>, bool, u64) {
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(patch);
    synth.reserve_space();
    let process = |events: &[Event], left: &mut [f32], right: &mut [f32]| synth.process(events, left, right);
    let bits = in_blocks(events, frames, block, process);
    (bits, synth.is_silent(), synth.tail_frames())
}

/// Notes separated by silence, and two changes of every parameter of every section: while notes sound, during tails and in
/// silence.
fn busy() -> Vec<Event> {
    let rows = PARAMS.iter().filter(|info| SECTIONS.contains(&info.section));
    let mut events: Vec<Event> = rows
        .enumerate()
        .flat_map(|(n, info)| {
            let travel = 0.13 + 0.04 * n as f64;
            let there = set(1003 + 211 * n as u32, info.param, info.denormalise(travel));
            let back = set(30_011 + 977 * n as u32, info.param, info.denormalise(1.0 - travel));
            [there, back]
        })
        .chain([(100, 48), (5007, 60), (9001, 67), (30_000, 55), (52_019, 72)].map(|(frame, key)| on(frame, key)))
        .chain([off(3000, 48), off(9002, 60)])
        .collect();
    events.sort_by_key(|event| event.frame);
    events
}

#[test]
fn blocks_make_no_difference() {
    let events = busy();
    for (name, patch) in [("spring", wet(SPRING)), ("plate", wet(PLATE)), ("nothing at first", dry())] {
        let frames = 60_000;
        let whole = synth_bits(&patch, &events, frames, frames);
        assert!(whole.0.iter().any(|bits| f32::from_bits(*bits).abs() > 0.01));
        for block in [37, 480, 1024] {
            let parts = synth_bits(&patch, &events, frames, block);
            let differs = whole.0.iter().zip(&parts.0).position(|(a, b)| a != b);
            assert_eq!(differs, None, "{name}, blocks of {block}");
            assert_eq!((whole.1, whole.2), (parts.1, parts.2), "{name}, blocks of {block}");
        }
    }
}

#[test]
fn channels_of_an_ensemble_have_their_own() {
    let (kits, frames) = ([wet(ROOM), wet(SPRING), dry()].map(|patch| Kit::of_patch(&patch)), 12_000);
    let ensemble = |chunk: usize| {
        let [first, second, third] = &kits;
        let programs = vec![second.clone(), third.clone()];
        Ensemble::of_kits(RATE, 1, first, programs).with_kit(1, second).with_kit(2, third).with_chunk(chunk)
    };
    let strikes = (0..3).map(|channel| Event { channel, ..on(10 * u32::from(channel), 60) });
    let changes = [(0, 1), (1, 1), (2, 0)].map(|(channel, program)| Event {
        frame: 4001,
        channel,
        kind: EventKind::Program(program),
    });
    let again = (0..3).map(|channel| Event { channel, ..on(6000, 64) });
    let events: Vec<Event> = strikes.chain(changes).chain(again).collect();
    let bits = |chunk, block| {
        let mut ensemble = ensemble(chunk);
        in_blocks(&events, frames, block, |events, left, right| ensemble.process(events, left, right))
    };
    let whole = bits(1024, frames);
    for (chunk, block) in [(77, frames), (1024, 333)] {
        let differs = whole.iter().zip(&bits(chunk, block)).position(|(a, b)| a != b);
        assert_eq!(differs, None, "chunks of {chunk}, blocks of {block}");
    }
    let mut backwards = ensemble(1024);
    let reversed = in_blocks(&events, frames, 512, |events, left, right| {
        backwards.process_by(&Backwards, events, &[], left, right);
    });
    assert!(whole == reversed, "the order in which parts are played");
    // The effects of a channel do not change the other channels: the mix is the sum of the channels rendered alone.
    let alone = |channel: u8| {
        let mut ensemble = ensemble(1024);
        let own: Vec<Event> = events.iter().filter(|event| event.channel == channel).copied().collect();
        in_blocks(&own, frames, 512, |events, left, right| ensemble.process(events, left, right))
    };
    let each = [0, 1, 2].map(alone);
    for (n, bits) in whole.iter().enumerate() {
        let sum: f32 = each.iter().map(|one| f32::from_bits(one[n])).sum();
        assert!((sum - f32::from_bits(*bits)).abs() < 1e-5, "{n}");
    }
}

#[test]
fn what_is_off_changes_no_bit_and_what_is_on_changes_some() {
    let notes = [on(0, 60), off(4000, 60)];
    let plain = synth_bits(&dry(), &notes, 9000, 512).0;
    let mut settings = dry();
    // Changes every parameter of the sections except those that switch an effect on.
    for info in PARAMS.iter().filter(|info| SECTIONS.contains(&info.section)) {
        use Param::{Drive, Soundbox, Space, StereoWidth, StringsLevel, ToneHigh, ToneLow, TremoloDepth};
        if ![Drive, Soundbox, Space, StereoWidth, StringsLevel, ToneHigh, ToneLow, TremoloDepth].contains(&info.param) {
            settings.set(info.param, info.denormalise(0.8));
        }
    }
    assert!(plain == synth_bits(&settings, &notes, 9000, 512).0);
    for (param, value) in [
        (Param::Soundbox, VOICE),
        (Param::StringsLevel, 50.0),
        (Param::TremoloDepth, 50.0),
        (Param::Drive, 6.0),
        (Param::ToneLow, 6.0),
        (Param::ToneHigh, 6.0),
        (Param::Space, SPRING),
        (Param::StereoWidth, 50.0),
    ] {
        assert!(plain != synth_bits(&dry().with(param, value), &notes, 9000, 512).0, "{param:?}");
        // An effect that was switched on and off again changes no bit of later notes.
        let turned = [set(0, param, value), set(100, param, param.info().default)];
        let later = notes.map(|note| Event { frame: note.frame + 20_000, ..note });
        let events = [&turned[..], &later[..]].concat();
        let back = synth_bits(&dry(), &events, 29_000, 500).0;
        let expected = synth_bits(&dry(), &later, 29_000, 500).0;
        assert!(back == expected, "{param:?}, off again");
    }
}

/// Number of frames until silence, in steps of one control tick, and the peak of the last step.
fn frames_to_silence(synth: &mut Synth) -> (u64, f32) {
    let (mut frames, mut last) = (0, 0.0);
    while !synth.is_silent() {
        let (mut left, mut right) = ([0.0; 32], [0.0; 32]);
        synth.process(&[], &mut left, &mut right);
        last = left.iter().chain(&right).fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        frames += 32;
        assert!(frames < 100 * RATE as u64, "it never ends");
    }
    (frames, last)
}

#[test]
fn tails_are_never_longer_than_told() {
    let strings = dry().with(Param::StringsLevel, 40.0).with(Param::StringsLowDecay, 0.4);
    let effects = dry().with(Param::TremoloDepth, 40.0).with(Param::Drive, 20.0).with(Param::ToneLow, 6.0);
    let patches = [
        ("all", wet(SPRING)),
        ("plate", dry().with(Param::Space, PLATE).with(Param::SpaceLowDecay, 0.3).with(Param::SpaceHighDecay, 0.2)),
        ("soundbox", dry().with(Param::Soundbox, GUITAR).with(Param::SoundboxSize, 400.0)),
        ("strings", strings),
        ("effects", effects),
        ("width", dry().with(Param::StereoWidth, 0.0)),
    ];
    for (name, patch) in patches {
        let turned = [on(0, 60), set(2990, Param::SpaceSize, 60.0), set(2995, Param::SpaceMix, 90.0)];
        // Just after the onset, while the note rings, when only the tail is left; and while parameters change.
        for (events, frames) in [(&turned[..1], 10), (&turned[..1], 3000), (&turned[..1], 20_000), (&turned, 3000)] {
            let mut synth = Synth::new(RATE, 1);
            synth.set_patch(&patch);
            assert!(synth.is_silent() && synth.tail_frames() == 0);
            let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
            synth.process(events, &mut left, &mut right);
            let told = synth.tail_frames();
            let (found, last) = frames_to_silence(&mut synth);
            println!("{name}: {told} frames told, {found} were, {last:.1e} at the end");
            assert!(found <= told + 32, "{name}: {told} frames told, {found} were");
            assert!(last < 2e-6, "{name}: {last} at the end");
            assert_eq!(synth.tail_frames(), 0);
        }
    }
}

#[test]
fn nothing_clicks() {
    let patch = |space: f32| wet(space).with(Param::Decay, 4.0).with(Param::Drive, 0.0).with(Param::Gain, -20.0);
    let render = |patch: &Patch, events: &[Event]| {
        let mut synth = Synth::new(RATE, 1);
        synth.set_patch(patch);
        synth.reserve_space();
        let (mut left, mut right) = (vec![0.0; 14_000], vec![0.0; 14_000]);
        synth.process(events, &mut left, &mut right);
        [left, right]
    };
    let jump = |sound: &[Vec<f32>; 2]| {
        let pairs = sound.iter().flat_map(|side| side[6000..].windows(2));
        pairs.map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max)
    };
    let note = on(0, 45);
    for (param, from, to) in [
        (Param::Soundbox, 0.0, VOICE),
        (Param::Soundbox, GUITAR, 0.0),
        (Param::Soundbox, GUITAR, VOICE),
        (Param::SoundboxMix, 60.0, 10.0),
        (Param::StringsLevel, 40.0, 0.0),
        (Param::StringsTuning, 0.0, 1.0),
        (Param::StringsTune, 0.0, 7.0),
        (Param::TremoloDepth, 0.0, 80.0),
        (Param::TremoloRate, 5.0, 1.0),
        (Param::Drive, 0.0, 3.0),
        (Param::ToneLow, 0.0, 3.0),
        (Param::ToneHigh, 0.0, 3.0),
        (Param::Space, SPRING, ROOM),
        (Param::Space, SPRING, 0.0),
        (Param::Space, 0.0, SPRING),
        // To a larger size and so a lower pitch: sound that is moved to a higher pitch has larger steps without any click.
        (Param::SpaceSize, 100.0, 140.0),
        (Param::SpaceMaterial, 0.0, 2.0),
        (Param::SpaceLowDecay, 0.2, 2.0),
        (Param::SpacePreDelay, 0.0, 0.1),
        (Param::SpaceMix, 25.0, 80.0),
        (Param::StereoWidth, 100.0, 0.0),
    ] {
        let (before, after) = (patch(SPRING).with(param, from), patch(SPRING).with(param, to));
        let own = jump(&render(&before, &[note])).max(jump(&render(&after, &[note])));
        let turned = jump(&render(&before, &[note, set(7001, param, to)]));
        println!("{param:?}: {turned:.5}, its own {own:.5}");
        assert!(turned <= 1.2 * own + 0.001, "{param:?}: a jump of {turned} where {own} is the sound’s own");
    }
}

/// Parameters that change during silence are not smoothed: the next note starts with their new values.
#[test]
fn in_silence_settings_hold_at_once() {
    let mut turned = Synth::new(RATE, 1);
    turned.set_patch(&dry());
    turned.reserve_space();
    for info in PARAMS.iter().filter(|info| SECTIONS.contains(&info.section)) {
        turned.handle(&set(0, info.param, wet(SPRING).get(info.param)));
    }
    assert!(turned.is_silent());
    let mut made = Synth::new(RATE, 1);
    made.set_patch(&wet(SPRING));
    let bits = |synth: &mut Synth| in_blocks(&[on(0, 60)], 9000, 512, |events, l, r| synth.process(events, l, r));
    let expected = bits(&mut made);
    assert!(bits(&mut turned) == expected);
    for synth in [&mut turned, &mut made] {
        synth.reset();
        assert!(synth.is_silent());
        assert!(bits(synth) == expected, "after a reset");
        synth.prepare(RATE);
        assert!(bits(synth) == expected, "prepared anew");
    }
}

#[test]
fn a_kit_of_several_has_the_space_that_all_of_its_sounds_have() {
    let agreed = kit_of([wet(SPRING), wet(SPRING).with(Param::Drive, 9.0)]);
    let value = |param| agreed.values().get(param);
    assert_eq!([Param::Space, Param::ToneLow, Param::Drive].map(value), [SPRING, 3.0, 0.0]);
    let mut synth = Synth::new(RATE, 1);
    synth.set_kit(&agreed);
    let (mut left, mut right) = (vec![0.0; 24_000], vec![0.0; 24_000]);
    synth.process(&[on(0, 60)], &mut left, &mut right);
    assert!(left[15_000..].iter().any(|sample| *sample != 0.0), "it rings on");
}

/// In an ensemble, bodies take memory only on channels whose kits have them, unless `reserve_space` was called.
#[test]
fn without_room_bodies_stay_off() {
    let mut ensemble = Ensemble::new(RATE, 1, &dry(), &[]);
    let mut other = Ensemble::new(RATE, 1, &dry(), &[]);
    let turned = [set(0, Param::Space, PLATE), set(0, Param::StringsLevel, 50.0)];
    let bits = |ensemble: &mut Ensemble, events: &[Event]| {
        in_blocks(events, 9000, 512, |events, left, right| ensemble.process(events, left, right))
    };
    let note = on(0, 60);
    let plain = bits(&mut other, &[note]);
    assert!(bits(&mut ensemble, &[turned[0], turned[1], note]) == plain);
    let mut roomy = Ensemble::new(RATE, 1, &dry(), &[]);
    roomy.reserve_space();
    assert!(bits(&mut roomy, &[turned[0], turned[1], note]) != plain);
}

/// Routes move effects for all notes: by macros, controllers, and the strike of the newest note.
#[test]
fn routes_move_effects() {
    let routed = |source| {
        let patch = Patch { routes: Routes::NONE, ..dry() }.with(Param::ToneHigh, -18.0);
        patch.with_route(0, source, Param::ToneHigh, 100.0)
    };
    let notes = [on(0, 60), on(4000, 64)];
    let plain = |high: f32| {
        synth_bits(&Patch { routes: Routes::NONE, ..dry() }.with(Param::ToneHigh, high), &notes, 9000, 512).0
    };
    let macro_up = [set(0, Param::Macro1, 50.0), notes[0], notes[1]];
    assert!(synth_bits(&routed(Source::Macro1), &macro_up, 9000, 512).0 == plain(0.0));
    let wheel_up = [event(0, EventKind::Control { controller: 1, value: 1.0 }), notes[0], notes[1]];
    assert!(synth_bits(&routed(Source::Wheel), &wheel_up, 9000, 512).0 == plain(18.0));
    assert!(synth_bits(&routed(Source::Wheel), &notes, 9000, 512).0 == plain(-18.0));
    // Moved while they sound, with the strikes of new notes, in blocks of any size.
    let moved = [
        notes[0],
        set(1000, Param::Macro1, 70.0),
        event(1777, EventKind::Control { controller: 1, value: 0.7 }),
        notes[1],
        set(5003, Param::ToneHigh, 3.0),
    ];
    for source in [Source::Macro1, Source::Wheel, Source::Velocity, Source::Key, Source::Random] {
        let patch = routed(source).with(Param::Soundbox, VOICE).with_route(1, source, Param::SoundboxVowel, 60.0);
        let whole = synth_bits(&patch, &moved, 9000, 9000);
        for block in [37, 512] {
            assert!(synth_bits(&patch, &moved, 9000, block) == whole, "{source:?}, blocks of {block}");
        }
    }
    // What is of one note's time cannot move what all notes share.
    for source in [Source::Lfo1, Source::Envelope2, Source::ReleaseVelocity] {
        assert!(routed(source).routes.get(0).is_none(), "{source:?}");
    }
    // A kit without such routes has its own values again.
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(&routed(Source::Macro1));
    let bits = |synth: &mut Synth, events: &[Event]| {
        in_blocks(events, 30_000, 512, |events, l, r| synth.process(events, l, r))
    };
    bits(&mut synth, &[set(0, Param::Macro1, 50.0), on(0, 60), off(100, 60)]);
    assert!(synth.is_silent());
    synth.set_patch(&dry());
    let mut other = Synth::new(RATE, 1);
    other.set_patch(&dry());
    bits(&mut other, &[on(0, 60), off(100, 60)]);
    assert!(bits(&mut synth, &[on(0, 60)]) == bits(&mut other, &[on(0, 60)]));
}

/// A strike brings the routes of its own sound: what those of the sound before have moved returns.
#[test]
fn each_strike_of_a_kit_brings_the_routes_of_its_sound() {
    let routed = |param| Patch { routes: Routes::NONE, ..dry() }.with_route(0, Source::Macro1, param, 100.0);
    let bits = |patches, events: &[Event]| {
        let mut synth = Synth::new(RATE, 1);
        synth.set_kit(&kit_of(patches));
        in_blocks(events, 60_000, 512, |events, left, right| synth.process(events, left, right))
    };
    let both = [routed(Param::ToneHigh), routed(Param::Drive)];
    let (up, low, high) = (set(0, Param::Macro1, 90.0), on(0, 60), on(40_000, 61));
    let after = bits(both.clone(), &[up, low, high]);
    assert!(after[80_000..] == bits(both, &[up, high])[80_000..], "after silence");
    // A macro that moves in silence counts from the next strike on, and an event that moves nothing changes no bit.
    let wavering = dry().with(Param::TremoloDepth, 80.0).with(Param::TremoloRate, 3.0);
    let wavering = wavering.with_route(0, Source::Macro1, Param::ToneHigh, 100.0);
    let idle = event(39_000, EventKind::Control { controller: 20, value: 0.3 });
    let played = |events: &[Event]| synth_bits(&wavering, events, 60_000, 512).0;
    assert!(played(&[up, low, high]) == played(&[up, low, idle, high]), "the motor of the tremolo continues");
}

#[test]
fn a_soundbox_alone_outlives_another_sample_rate() {
    let mut synth = Synth::new(44_100.0, 1);
    synth.set_patch(&dry().with(Param::Soundbox, GUITAR));
    synth.prepare(RATE);
    let bits = in_blocks(&[on(0, 60)], 9000, 512, |events, left, right| synth.process(events, left, right));
    assert!(bits == synth_bits(&dry().with(Param::Soundbox, GUITAR), &[on(0, 60)], 9000, 512).0);
}

/// Offsets of the host and values that are set together reach routes to effects at once.
#[test]
fn routes_hold_after_all_values_are_set() {
    let patch = Patch { routes: Routes::NONE, ..dry() }.with(Param::ToneHigh, -18.0);
    let patch = patch.with_route(0, Source::Macro1, Param::ToneHigh, 100.0);
    let mut values = patch.values;
    values.set(Param::Macro1, 80.0);
    let bits = |set: &dyn Fn(&mut Synth)| {
        let mut synth = Synth::new(RATE, 1);
        synth.set_patch(&patch);
        let (mut left, mut right) = (vec![0.0; 512], vec![0.0; 512]);
        synth.process(&[on(0, 60)], &mut left, &mut right);
        set(&mut synth);
        in_blocks(&[], 6000, 512, |events, left, right| synth.process(events, left, right))
    };
    let together = bits(&|synth| synth.set_values(&values));
    assert!(
        together
            == bits(&|synth| {
                synth.set_values(&values);
                synth.handle(&set(0, Param::Macro1, 80.0));
            })
    );
    assert!(together != bits(&|synth| synth.set_values(&patch.values)));
}
