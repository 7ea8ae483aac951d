//! The audio thread never allocates, and neither does the loudness meter: tested with an allocator that forbids it.

use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::engine::{Ensemble, Event, EventKind, Expression, NoteId, Notes, Synth};
use sprung::internals::threads::Meter;
use sprung::params::{PARAMS, Param};
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};
use sprung::sound::bodies::{Body, Model};
use sprung::sound::pairs::{Link, Pair};
use sprung::sound::{Collector, Kit, Mix, Pad, Sound, Tuning};
use std::sync::Arc;

/// Every kind of event, on every channel, with constant stealing and choking.
fn storm(block: u32) -> Vec<Event> {
    let mut events = vec![];
    for n in 0..96_u32 {
        let (frame, channel) = (n * 5, (n % 16) as u8);
        let key = (30 + (n * 7 + block * 11) % 60) as u8;
        let value = (n % 11) as f32 / 10.0;
        let param = &PARAMS[((n + block * 13) as usize) % PARAMS.len()];
        for kind in [
            EventKind::NoteOn { key, detune: 0.1, velocity: value, id: NoteId::new(n as i32) },
            EventKind::NoteOff { key: key - 5, velocity: value, id: None },
            EventKind::Strike { key: key + 3, contact: Sound::new(Patch::default()).strike(value, value, value) },
            EventKind::Nudge { key, mode: n as u16 % 3, amplitude: value },
            EventKind::PitchBend(value),
            EventKind::ChannelPressure(value),
            EventKind::PolyPressure { key, pressure: value },
            EventKind::Control {
                controller: [1, 5, 6, 7, 10, 11, 64, 65, 66, 67, 68, 74, 84, 91, 100, 101, 120, 121, 123, 126, 127]
                    [n as usize % 21],
                value,
            },
            EventKind::Param { param: param.param, value: param.denormalise(value.into()) },
            EventKind::Choke { group: (n % 3) as u8 },
            EventKind::Express { notes: Notes::on(channel, key), expression: Expression::ALL[n as usize % 7], value },
            EventKind::Silence { notes: Notes { id: NoteId::new(n as i32 - 9), ..Notes::default() } },
            EventKind::Modulate {
                id: NoteId::new(n as i32).filter(|_| n % 2 == 0),
                param: param.param,
                offset: value - 0.5,
            },
            EventKind::ModulateNotes { notes: Notes::on(channel, key), param: param.param, offset: value - 0.5 },
            EventKind::Tempo(60.0 + value),
            EventKind::Tune { key, pitch: 60.0 + value, sounding: n % 2 == 0 },
            EventKind::Release { notes: Notes { id: NoteId::new(n as i32 - 5), ..Notes::default() }, velocity: value },
            EventKind::Program((n % 4) as u8),
        ] {
            events.push(Event { frame, channel, kind });
        }
    }
    events
}

#[test]
fn processing_does_not_allocate() {
    let patch = Patch { modes: ModeTable::new(&[Mode { strike: 0.5, ..Mode::UNIT }; 64]), ..Patch::default() };
    let programs = [patch.clone(), Patch::default(), patch, pair()];
    let mut ensemble = Ensemble::new(48_000.0, 1, &Patch::default(), &programs)
        .with_mix(&Mix { gain: -6.0, space: vec![(Param::Space, 1.0)] });
    let (mut left, mut right) = (vec![0.0; 480], vec![0.0; 480]);
    let blocks: Vec<_> = (0..20).map(storm).collect();
    let mut loudest = 0.0_f32;
    let gaps = Tuning::from_scala("\n1\n3/2", Some("3\n0\n127\n60\n60\n256.0\n2\n0\nx\n1")).unwrap();
    for (events, tuning) in blocks.iter().zip([gaps, Tuning::EQUAL].iter().cycle()) {
        assert_no_alloc(|| ensemble.set_tuning(tuning));
        assert_no_alloc(|| ensemble.process(events, &mut left, &mut right));
        loudest = left.iter().fold(loudest, |peak, sample| peak.max(sample.abs()));
    }
    assert!(loudest > 0.1, "something sounded");
    assert_no_alloc(|| std::hint::black_box((ensemble.is_silent(), ensemble.voices_used())));
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(&programs[3]);
    for events in &blocks {
        assert_no_alloc(|| {
            synth.process_with_input(events, &[0.1; 480], &mut left, &mut right);
            std::hint::black_box((synth.tail_frames(), synth.ended()));
        });
    }
    // More voices than the pool has, so that notes on all channels are stolen.
    let mut large = Patch::default().with(Param::Decay, 10.0);
    large.modes = ModeTable::new(&[Mode::UNIT; MAX_MODES]);
    let mut ensemble = Ensemble::new(48_000.0, 1, &large, &[]);
    let note = |n: u32| Event { channel: (n % 16) as u8, ..Event::note_on(n * 2, (n % 90) as u8, 0.5) };
    let notes: Vec<_> = (0..200).map(note).collect();
    assert_no_alloc(|| (0..4).for_each(|_| ensemble.process(&notes, &mut left, &mut right)));
    assert_eq!(violation_count(), 0, "allocations on the audio thread");
}

/// Ten minutes: a growing list of gating blocks would exceed its initial capacity.
#[test]
fn measuring_keeps_nothing_that_grows() {
    let mut meter = Meter::new(8000, 1).unwrap();
    let second: Vec<f32> = (0..8000).map(|n| if n % 8 < 4 { 0.5 } else { -0.5 }).collect();
    for _ in 0..600 {
        assert_no_alloc(|| meter.add(&second, &[]).unwrap());
    }
    assert!(meter.levels().lufs.is_some());
    assert_eq!(violation_count(), 0, "allocations while measuring");
}

#[test]
fn the_ban_bites() {
    assert_no_alloc(|| drop(std::hint::black_box(vec![0_u8; 10])));
    assert_ne!(violation_count(), 0);
}

/// A thousand kits per second of audio, each created during playing and dropped when the next one replaces it.
#[test]
fn kits_come_and_go_without_allocating_or_freeing() {
    let collector = Collector::default();
    let sounds: Vec<Arc<Sound>> = (1..=128).map(|n| Arc::new(Sound::new(modes(n % 64)))).collect();
    let pads = |sounds: usize| (0..128).map(|key| Some(Pad::of(key % sounds))).collect();
    let kit = |n: usize| {
        let sounds = match n % 4 {
            0 => vec![Arc::new(Sound::new(modes(n % 64)))],
            1 => sounds.clone(),
            _ => sounds[..n % 7 + 1].to_vec(),
        };
        Arc::new(Kit::new(String::new(), sounds.clone(), pads(sounds.len())))
    };
    let mut ensemble = Ensemble::of_kits(48_000.0, 1, &kit(0), (0..4).map(kit).collect());
    ensemble.reserve(128);
    let (mut left, mut right) = ([0.0; 48], [0.0; 48]);
    let (mut most, mut loudest) = (0, 0.0_f32);
    for n in 0..1000_u32 {
        let kit = kit(n as usize);
        collector.keep(&kit);
        most = collector.collect().max(most);
        let sent = [kit];
        let channel = (n % 16) as u8;
        let events = [
            Event { channel, ..Event::note_on(3, (20 + n * 7 % 90) as u8, 0.8) },
            Event { frame: 20, channel: (n / 3 % 16) as u8, kind: EventKind::Program((n % 4) as u8) },
        ];
        let [kit] = &sent;
        assert_no_alloc(|| {
            ensemble.set_kit(channel, kit);
            ensemble.process(&events, &mut left, &mut right);
        });
        loudest = left.iter().fold(loudest, |peak, sample| peak.max(sample.abs()));
    }
    assert!(loudest > 0.1, "something sounded");
    assert!(most <= 18, "{most} kits are kept for 16 channels");
    drop(ensemble);
    assert_eq!(collector.collect(), 0);
    assert_eq!(violation_count(), 0, "allocations on the audio thread");
}

/// Replaces the bodies of the space and changes the parameters of all effects behind the voices while they sound.
#[test]
fn spaces_come_and_go_without_allocating() {
    let collector = Collector::default();
    let rows: Vec<_> = PARAMS.iter().filter(|info| info.param.is_behind_voices()).collect();
    let kits: Vec<Arc<Kit>> = (0..8)
        .map(|n| {
            let mut patch = modes(n).with(Param::Gain, 0.0);
            for info in &rows {
                patch.set(info.param, info.denormalise((n as f64 * 0.37 + 0.3).fract()));
            }
            Kit::of_patch(&patch.with(Param::Space, (n % 4) as f32))
        })
        .collect();
    kits.iter().for_each(|kit| collector.keep(kit));
    let mut synth = Synth::new(48_000.0, 1);
    synth.reserve_space();
    // The synth's first kit is in no collector, so it is replaced here, where freeing is allowed. The collector keeps all other kits.
    synth.set_kit(&kits[7]);
    let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
    let mut loudest = 0.0_f32;
    for n in 0..240_usize {
        let strike = EventKind::NoteOn { key: (30 + n * 7 % 60) as u8, detune: 0.0, velocity: 0.8, id: None };
        let info = rows[n * 5 % rows.len()];
        let value = info.denormalise((n as f64 * 0.23).fract());
        let events = [strike, EventKind::Param { param: info.param, value }].map(|kind| Event {
            frame: (n % 50) as u32,
            channel: 0,
            kind,
        });
        assert_no_alloc(|| {
            if n % 30 == 7 {
                synth.set_kit(&kits[n / 30]);
            }
            synth.process(&events, &mut left, &mut right);
            std::hint::black_box((synth.tail_frames(), synth.is_silent()));
        });
        loudest = left.iter().fold(loudest, |peak, sample| peak.max(sample.abs()));
    }
    assert_no_alloc(|| synth.reset());
    assert!(loudest > 0.1, "something sounded");
    assert_eq!(violation_count(), 0, "allocations on the audio thread");
}

/// A string that follows the keys, joined to a plate that does not: the pair has a mode table for each key.
fn pair() -> Patch {
    let body = |model, modes| Body { modes, ..Body::new(Model::find(model).unwrap().clone()) };
    let plate = Body { follows_key: false, ..body("plate", 9) };
    let link = Link::Spring { stiffness: 500.0, damping: 0.1 };
    let pair = Pair { keys: [40, 70], ..Pair::new(body("string", 9), plate, link) };
    Patch { modes: pair.table().unwrap(), ..Patch::default() }
}

fn modes(count: usize) -> Patch {
    let modes = vec![Mode { level: 0.1, ..Mode::UNIT }; count + 1];
    Patch { modes: ModeTable::new(&modes), ..Patch::default() }
}
