//! Samples, ended notes and tails do not depend on the division into blocks: random sounds, events, rates, divisions.

use proptest::prelude::*;
use proptest::sample::select;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use sprung::engine::midi::parse_message;
use sprung::engine::{Ensemble, Event, EventKind, Expression, NoteId, Notes, Synth};
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::{Response, Route, Source, amount_param};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::sound::bodies::{Body, Model};
use sprung::sound::pairs::{Link, Pair};
use sprung::sound::{KEYS, Kit, Mix, Pad, Sound};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::{Arc, LazyLock};

const FRAMES: usize = 9_600;
/// Random cases at every commit and in the long suite.
const CASES: u32 = 20;
const MANY: u32 = 400;
const RATES: [f64; 8] = [1_000.0, 8_000.0, 22_050.0, 44_100.0, 48_000.0, 96_000.0, 192_000.0, 768_000.0];

/// What is played, and how the ensemble and the blocks divide the frames.
#[derive(Clone, Debug)]
struct Case {
    sample_rate: f64,
    seed: u64,
    kit: Arc<Kit>,
    programs: Vec<Arc<Kit>>,
    /// In order of their frames.
    events: Vec<Event>,
    /// Lengths of blocks, repeated in a cycle.
    blocks: Vec<usize>,
    /// Number of frames that the ensemble mixes at a time.
    chunk: usize,
}

fn any_patch() -> impl Strategy<Value = Patch> {
    let mode = (0.5..20.0f32, -1.0..1.0f32, 0.01..4.0f32, 0.0..1.0f32, -1.0..1.0f32)
        .prop_map(|(ratio, level, decay, strike, pan)| Mode { ratio, level, decay, strike, pan });
    let route = (select(Source::ALL.to_vec()), any_param(), select(Response::ALL.to_vec())).prop_flat_map(
        |(source, destination, response)| {
            prop::option::of(select(Source::ALL.to_vec())).prop_map(move |scale| Route {
                source,
                destination,
                response,
                scale,
            })
        },
    );
    let routes = prop::collection::vec((route, -60.0..60.0f32), 0..6);
    // Half of the parameters keep their defaults, because sounds with only random parameters are rarely loud for long.
    let position = prop::option::of(0.0..1.0f64);
    (
        prop_oneof![9 => prop::collection::vec(mode.clone(), 1..20), 1 => prop::collection::vec(mode, 65..150)],
        prop::collection::vec(position, PARAMS.len()),
        routes,
    )
        .prop_map(|(modes, positions, routes)| {
            // The few cases with exactly 4 modes get a pair instead.
            let modes = if modes.len() == 4 { pair() } else { ModeTable::new(&modes) };
            let mut patch = Patch { modes, ..Patch::default() };
            for (info, position) in PARAMS.iter().zip(positions) {
                if let Some(position) = position {
                    patch.set(info.param, info.denormalise(position));
                }
            }
            for (place, (route, amount)) in routes.into_iter().enumerate() {
                patch.routes.set(place, Some(route));
                patch.set(amount_param(place), amount);
            }
            patch
        })
}

/// A string that follows the keys, joined to a plate that does not: the pair has a mode table for each key, with phases.
fn pair() -> ModeTable {
    static PAIR: LazyLock<ModeTable> = LazyLock::new(|| {
        let body = |model, modes| Body { modes, ..Body::new(Model::find(model).unwrap().clone()) };
        let plate = Body { follows_key: false, ..body("plate", 9) };
        let link = Link::Spring { stiffness: 500.0, damping: 0.1 };
        let pair = Pair { polarisation: 0.3, keys: [40, 70], ..Pair::new(body("string", 9), plate, link) };
        pair.table().unwrap()
    });
    PAIR.clone()
}

/// One sound on all keys, or several sounds on some of the keys.
fn any_kit() -> impl Strategy<Value = Arc<Kit>> {
    let pad = (0..4usize, prop::option::of(30.0..90.0f64), -20.0..6.0f32, -1.0..1.0f32, prop::option::of(0..3u8))
        .prop_map(|(sound, pitch, gain_db, pan, choke)| Pad { pitch, gain_db, pan, choke, ..Pad::of(sound) });
    let pads = prop::collection::vec(prop::option::weighted(0.8, pad), KEYS);
    let several = (prop::collection::vec(any_patch(), 2..4), pads).prop_map(|(patches, pads)| {
        let sounds = patches.into_iter().map(|patch| Arc::new(Sound::new(patch))).collect();
        Arc::new(Kit::new(String::new(), sounds, pads))
    });
    prop_oneof![2 => any_patch().prop_map(|patch| Kit::of_patch(&patch)), 1 => several]
}

fn any_channel() -> impl Strategy<Value = u8> + Clone {
    select(vec![0, 0, 0, 0, 1, 1, 2, 9, 15])
}

/// Only few keys, so that events often match sounding notes.
fn any_key() -> impl Strategy<Value = u8> + Clone {
    36..60u8
}

fn any_id() -> impl Strategy<Value = Option<NoteId>> + Clone {
    (-1..6i32).prop_map(NoteId::new)
}

fn any_notes() -> impl Strategy<Value = Notes> {
    let id = any_id();
    (id, prop::option::of(any_channel()), prop::option::of(any_key())).prop_map(|(id, channel, key)| Notes {
        id,
        channel,
        key,
    })
}

fn any_param() -> impl Strategy<Value = Param> {
    (0..PARAMS.len()).prop_map(|index| PARAMS[index].param)
}

fn any_kind() -> impl Strategy<Value = EventKind> {
    let unit = 0.0..1.0f32;
    prop_oneof![
        10 => (any_key(), -0.5..0.5f32, 0.2..1.0f32, any_id())
            .prop_map(|(key, detune, velocity, id)| EventKind::NoteOn { key, detune, velocity, id }),
        2 => (any_key(), unit.clone(), unit.clone(), unit.clone()).prop_map(|(key, material, position, impulse)| {
            let contact = Sound::new(Patch::default()).strike(material, position, impulse);
            EventKind::Strike { key, contact }
        }),
        2 => (any_key(), 0..8u16, unit.clone())
            .prop_map(|(key, mode, amplitude)| EventKind::Nudge { key, mode, amplitude }),
        4 => (any_key(), unit.clone(), any_id())
            .prop_map(|(key, velocity, id)| EventKind::NoteOff { key, velocity, id }),
        1 => (any_key(), unit.clone()).prop_map(|(key, pressure)| EventKind::PolyPressure { key, pressure }),
        1 => (any_notes(), unit.clone()).prop_map(|(notes, velocity)| EventKind::Release { notes, velocity }),
        1 => any_notes().prop_map(|notes| EventKind::Silence { notes }),
        3 => (any_notes(), select(Expression::ALL.to_vec()), -1.0..4.0f32)
            .prop_map(|(notes, expression, value)| EventKind::Express { notes, expression, value }),
        1 => unit.clone().prop_map(EventKind::ChannelPressure),
        2 => (-1.0..1.0f32).prop_map(EventKind::PitchBend),
        3 => (select(vec![1, 2, 5, 7, 10, 11, 64, 65, 66, 67, 68, 74, 84, 120, 121, 123, 126, 127]), unit)
            .prop_map(|(controller, value)| EventKind::Control { controller, value }),
        3 => (any_param(), 0.0..1.0f64)
            .prop_map(|(param, position)| EventKind::Param { param, value: param.info().denormalise(position) }),
        3 => (any_id(), any_param(), -1.0..1.0f32)
            .prop_map(|(id, param, offset)| EventKind::Modulate { id, param, offset }),
        1 => (any_notes(), any_param(), -1.0..1.0f32)
            .prop_map(|(notes, param, offset)| EventKind::ModulateNotes { notes, param, offset }),
        1 => (20.0..300.0f32).prop_map(EventKind::Tempo),
        1 => (any_key(), 0.0..128.0f32, any::<bool>())
            .prop_map(|(key, pitch, sounding)| EventKind::Tune { key, pitch, sounding }),
        1 => (0..3u8).prop_map(|group| EventKind::Choke { group }),
        2 => (0..4u8).prop_map(EventKind::Program),
    ]
}

/// A controller with a MIDI value.
fn control(channel: u8, controller: u8, value: u8) -> (u8, EventKind) {
    (channel, EventKind::Control { controller, value: f32::from(value) / 127.0 })
}

/// Events at one frame: a single event, a MIDI message, or a registered parameter, which takes several messages.
fn any_group() -> impl Strategy<Value = Vec<(u8, EventKind)>> {
    prop_oneof![
        12 => (any_channel(), any_kind()).prop_map(|one| vec![one]),
        4 => (0x80..0xF0u8, 0..128u8, 0..128u8)
            .prop_map(|(status, first, second)| parse_message(&[status, first, second]).into_iter().collect()),
        // 0 is the bend range, 6 is the number of members of an MPE zone.
        1 => (select(vec![0, 1, 15]), select(vec![0, 6]), 0..16u8).prop_map(|(channel, number, value)| {
            vec![control(channel, 101, 0), control(channel, 100, number), control(channel, 6, value)]
        }),
    ]
}

fn any_events() -> impl Strategy<Value = Vec<Event>> {
    prop::collection::vec((0..FRAMES as u32, any_group()), 1..60).prop_map(|mut groups| {
        groups.sort_by_key(|(frame, _)| *frame);
        let at = |frame, (channel, kind)| Event { frame, channel, kind };
        groups.into_iter().flat_map(|(frame, group)| group.into_iter().map(move |one| at(frame, one))).collect()
    })
}

fn any_case() -> impl Strategy<Value = Case> {
    let block = prop_oneof![Just(0_usize), Just(1), 2..32_usize, Just(32), 33..700_usize];
    let blocks =
        (prop::collection::vec(block, 0..20), 1..1_000_usize).prop_map(|(blocks, last)| [blocks, vec![last]].concat());
    let programs = prop::collection::vec(any_kit(), 0..4);
    let chunk = select(vec![1, 31, 64, 1_000, 20_000]);
    (select(RATES.to_vec()), any::<u64>(), any_kit(), programs, any_events(), blocks, chunk).prop_map(
        |(sample_rate, seed, kit, programs, events, blocks, chunk)| Case {
            sample_rate,
            seed,
            kit,
            programs,
            events,
            blocks,
            chunk,
        },
    )
}

/// A synth or an ensemble.
trait Plays {
    fn play(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]);
    /// Records the reports after a block, such as ended notes and voices.
    fn note(&mut self, is_last: bool, about: &mut About);
}

/// The reports of a render: ended notes, by their serial numbers, the tail after the last block, silence and voices.
#[derive(Clone, Debug, Default, PartialEq)]
struct About {
    ended: BTreeSet<(u64, Option<NoteId>, u8, u8)>,
    times_ended: usize,
    tail: u64,
    is_silent: bool,
    voices: usize,
}

impl Plays for Synth {
    fn play(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process(events, left, right);
    }

    fn note(&mut self, is_last: bool, about: &mut About) {
        about.times_ended += self.ended().len();
        about.ended.extend(self.ended().iter().map(|note| (note.serial, note.id, note.channel, note.key)));
        if is_last {
            about.tail = self.tail_frames();
        }
        (about.is_silent, about.voices) = (self.is_silent(), self.voices_used());
    }
}

impl Plays for Ensemble {
    fn play(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process(events, left, right);
    }

    fn note(&mut self, _: bool, about: &mut About) {
        (about.is_silent, about.voices) = (self.is_silent(), self.voices_used());
    }
}

/// Renders in blocks of these lengths, repeated in a cycle. Returns the bits of the samples and the reports.
fn render(player: &mut impl Plays, events: &[Event], blocks: &[usize]) -> ([Vec<u32>; 2], About) {
    // Not zero, so that samples which a block does not write are noticed.
    let [mut left, mut right] = [(); 2].map(|()| vec![f32::NAN; FRAMES]);
    let (mut start, mut rest, mut about) = (0, events, About::default());
    for length in blocks.iter().cycle() {
        let end = FRAMES.min(start + length);
        // A block without frames receives the events at its position.
        let now = rest.partition_point(|event| (event.frame as usize) < end.max(start + 1));
        let inside: Vec<Event> =
            rest[..now].iter().map(|event| Event { frame: event.frame - start as u32, ..*event }).collect();
        rest = &rest[now..];
        player.play(&inside, &mut left[start..end], &mut right[start..end]);
        start = end;
        player.note(start == FRAMES, &mut about);
        if start == FRAMES {
            break;
        }
    }
    ([left, right].map(|channel| channel.into_iter().map(f32::to_bits).collect()), about)
}

/// The first frame that differs in one of the channels.
fn first_difference(whole: &[Vec<u32>; 2], parts: &[Vec<u32>; 2]) -> Option<usize> {
    (0..FRAMES).find(|frame| (0..2).any(|side| whole[side][*frame] != parts[side][*frame]))
}

/// Returns whether the case sounds, or an error if the blocks make a difference.
fn check(case: &Case) -> Result<bool, TestCaseError> {
    let synth = || {
        let mut synth = Synth::new(case.sample_rate, case.seed);
        synth.set_kit(&case.kit);
        synth
    };
    let ensemble = || {
        let ensemble = Ensemble::of_kits(case.sample_rate, case.seed, &case.kit, case.programs.clone());
        if case.seed.is_multiple_of(2) {
            ensemble
        } else {
            ensemble.with_mix(&Mix { gain: -3.0, space: vec![(Param::Space, 3.0)] })
        }
    };
    let mut sounds = false;
    for (what, whole, parts) in [
        ("synth", render(&mut synth(), &case.events, &[FRAMES]), render(&mut synth(), &case.events, &case.blocks)),
        (
            "ensemble",
            render(&mut ensemble(), &case.events, &[FRAMES]),
            render(&mut ensemble().with_chunk(case.chunk), &case.events, &case.blocks),
        ),
    ] {
        prop_assert_eq!(first_difference(&whole.0, &parts.0), None, "{}: the first frame that differs", what);
        prop_assert_eq!(&whole.1, &parts.1, "{}: one block's, and that of several", what);
        prop_assert_eq!(whole.1.ended.len(), whole.1.times_ended, "{}: a note ends once", what);
        let samples = || whole.0.iter().flatten().map(|bits| f32::from_bits(*bits));
        prop_assert!(samples().all(f32::is_finite), "{} is not finite", what);
        sounds |= samples().any(|sample| sample.abs() > 0.01);
    }
    Ok(sounds)
}

#[test]
fn blocks_make_no_difference() {
    blocks_make_none(CASES);
}

#[test]
#[ignore = "takes minutes"]
fn blocks_make_no_difference_to_many() {
    blocks_make_none(MANY);
}

fn blocks_make_none(cases: u32) {
    let sounding = Cell::new(0);
    // Shrinking a case for minutes does not make it clearer.
    let config = ProptestConfig { cases, max_shrink_iters: 256, ..ProptestConfig::default() };
    let result = TestRunner::new(config).run(&any_case(), |case| {
        let sounds = check(&case)?;
        sounding.set(sounding.get() + u32::from(sounds));
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    // The cases are random, and about two thirds sound (of 32, 19 to 25 in eight runs): a quarter or fewer is no accident.
    assert!(sounding.get() > cases / 4, "only {} of {cases} cases sounded", sounding.get());
}

/// A number for each kind of event. A new kind does not compile until it has a number here.
fn number(kind: EventKind) -> usize {
    match kind {
        EventKind::NoteOn { .. } => 0,
        EventKind::NoteOff { .. } => 1,
        EventKind::PolyPressure { .. } => 2,
        EventKind::Release { .. } => 3,
        EventKind::Silence { .. } => 4,
        EventKind::Express { .. } => 5,
        EventKind::ChannelPressure(_) => 6,
        EventKind::PitchBend(_) => 7,
        EventKind::Control { .. } => 8,
        EventKind::Param { .. } => 9,
        EventKind::Modulate { .. } => 10,
        EventKind::Tempo(_) => 11,
        EventKind::Choke { .. } => 12,
        EventKind::Program(_) => 13,
        EventKind::Strike { .. } => 14,
        EventKind::Nudge { .. } => 15,
        EventKind::Tune { .. } => 16,
        EventKind::ModulateNotes { .. } => 17,
    }
}

const KINDS: usize = 18;

#[test]
fn every_kind_of_event_comes_up() {
    let mut runner = TestRunner::deterministic();
    let mut seen = BTreeSet::new();
    for _ in 0..CASES {
        let events = any_events().new_tree(&mut runner).unwrap().current();
        seen.extend(events.into_iter().map(|event| number(event.kind)));
    }
    assert_eq!(seen, (0..KINDS).collect());
}
