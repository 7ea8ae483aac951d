//! Every level of vector instructions that the CPU has gives the bits of scalar code.

mod space;

use rayon::iter::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use sprung::engine::{Ensemble, Event, EventKind};
use sprung::internals::Level;
use sprung::internals::measures::{diff, level};
use sprung::internals::random::{key, uniform};
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::{Response, Route, Source, amount_param};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;
use sprung::sound::bodies::{Body, Model};
use sprung::sound::pairs::{Link, Pair};
use sprung::sound::{KEYS, Kit, Pad, Sound};
use std::sync::{Arc, Mutex};

/// Every preset must exceed this peak, because the bits of silence prove nothing.
const AUDIBLE: f64 = 0.01;

/// Left and right.
type Stereo = [Vec<f32>; 2];

/// The level applies to the whole process, so only one test runs at a time.
static LEVEL: Mutex<()> = Mutex::new(());

/// How many cases are compared: one of so many factory presets, random patches, random kits; and their frames. Emulated levels are slow.
struct Extent {
    step: usize,
    patches: u64,
    kits: u64,
    frames: usize,
}

const FEW: Extent = Extent { step: 64, patches: 9, kits: 1, frames: 4_000 };
const MANY: Extent = Extent { step: 6, patches: 40, kits: 8, frames: 24_000 };

/// A kit and the events that it plays, with a name for failure messages.
struct Case {
    name: String,
    seed: u64,
    kit: Arc<Kit>,
    events: Vec<Event>,
    frames: usize,
}

impl Case {
    /// Factory presets, random patches and random kits, each with random events.
    fn all(extent: &Extent) -> Vec<Case> {
        let frames = extent.frames;
        let preset = |(seed, preset): (u64, &Preset)| Case {
            name: format!("preset ‘{}’", preset.name),
            seed,
            kit: Kit::of_patch(&preset.patch),
            events: events(&mut Stream::new(seed), frames),
            frames,
        };
        let factory: Vec<&Preset> = Preset::factory().iter().step_by(extent.step).collect();
        let first_random = factory.len() as u64;
        let random = |seed| {
            let mut stream = Stream::new(seed);
            let kit = Kit::of_patch(&patch(&mut stream, seed));
            Case { name: format!("random seed {seed}"), seed, kit, events: events(&mut stream, frames), frames }
        };
        let first_kit = first_random + extent.patches;
        let kit = |seed| {
            let mut stream = Stream::new(seed);
            let kit = kit(&mut stream, seed);
            Case { name: format!("kit seed {seed}"), seed, kit, events: events(&mut stream, frames), frames }
        };
        (0..)
            .zip(factory)
            .map(preset)
            .chain((first_random..first_kit).map(random))
            .chain((first_kit..first_kit + extent.kits).map(kit))
            .collect()
    }

    fn render(&self) -> Stereo {
        let mut ensemble = Ensemble::of_kits(48_000.0, self.seed, &self.kit, vec![]);
        let (mut left, mut right) = (vec![0.0; self.frames], vec![0.0; self.frames]);
        ensemble.process(&self.events, &mut left, &mut right);
        [left, right]
    }
}

/// A sequence of random numbers from 0 to 1.
struct Stream {
    key: u64,
    n: u64,
}

impl Stream {
    fn new(seed: u64) -> Self {
        Self { key: key(3, seed), n: 0 }
    }

    fn next(&mut self) -> f64 {
        self.n += 1;
        f64::from(uniform(self.key, self.n)) * 0.5 + 0.5
    }
}

/// A random patch of 1 to 64 modes; every eighth has up to 512. Every third keeps its default parameters except for the
/// modes and the exciter, so that all forms of the kernels are used: mono and stereo, ringing, swept and driven,
/// classic.
fn patch(stream: &mut Stream, seed: u64) -> Patch {
    let mut patch = Patch::default();
    if !seed.is_multiple_of(3) {
        for info in PARAMS {
            patch.set(info.param, info.denormalise(stream.next()));
        }
    }
    // Struck by one exciter, or by several at once.
    let is_on = |exciter: u64| (seed % 4 == exciter || seed % 5 == 4) && seed % 9 != 3 + exciter;
    patch.set(Param::MalletPulse, (seed % 2) as f32);
    for (exciter, level) in [Param::MalletLevel, Param::PluckLevel, Param::NoiseLevel].into_iter().enumerate() {
        patch.set(level, if is_on(exciter as u64) { 0.0 } else { -60.0 });
    }
    patch.set(Param::NoiseReach, if seed % 4 == 2 { 100.0 } else { 0.0 });
    // A touch silences most sounds soon, so only every ninth patch has one, and a light one. Half of the patches bloom.
    patch.set(Param::Touch, if seed % 9 == 4 { 20.0 } else { 0.0 });
    patch.set(Param::Bloom, if seed % 4 >= 2 { 80.0 } else { 0.0 });
    patch.set(Param::BloomTime, 0.1);
    // Without fused instructions, bodies of many masses are slow, so only every eighth patch has a spring space and strings.
    let has_bodies = seed % 8 == 3;
    patch.set(Param::Space, if has_bodies { 2.0 } else { 0.0 });
    patch.set(Param::StringsLevel, if has_bodies { 30.0 } else { 0.0 });
    patch.set(Param::Coefficients, f32::from(u8::from(seed % 7 == 6)));
    let pan = if seed.is_multiple_of(2) { 0.0 } else { 1.0 };
    let most = if seed % 8 == 5 { 512.0 } else { 64.0 };
    let modes: Vec<Mode> = (0..1 + (stream.next() * stream.next() * most) as usize)
        .map(|_| Mode {
            ratio: (0.5 + 20.0 * stream.next() * stream.next()) as f32,
            level: (stream.next() * 0.3) as f32,
            decay: (0.01 + stream.next()) as f32,
            strike: stream.next() as f32,
            pan: ((stream.next() * 2.0 - 1.0) * pan) as f32,
        })
        .collect();
    patch.modes = if seed % 8 == 6 { pair(stream) } else { ModeTable::new(&modes) };
    for place in 0..(stream.next() * stream.next() * 17.0) as usize {
        let mut one_of = |count: usize| (stream.next() * count as f64) as usize % count;
        let source = Source::ALL[one_of(Source::ALL.len())];
        let scale = Source::ALL.get(one_of(2 * Source::ALL.len())).copied();
        let response = Response::ALL[one_of(Response::ALL.len())];
        let destination = PARAMS[one_of(PARAMS.len())].param;
        patch.routes.set(place, Some(Route { source, destination, response, scale }));
        patch.set(amount_param(place), (stream.next() * 60.0 - 30.0) as f32);
    }
    patch
}

/// A random string that follows the keys, joined to a plate that does not: a mode table for each key, with phases.
fn pair(stream: &mut Stream) -> ModeTable {
    let body = |model, modes| Body { modes, ..Body::new(Model::find(model).unwrap().clone()) };
    let plate = Body { follows_key: false, ..body("plate", 2 + (stream.next() * 40.0) as usize) };
    let link = Link::Spring { stiffness: 1000.0 * stream.next().max(0.01), damping: stream.next() };
    let string = body("string", 2 + (stream.next() * 20.0) as usize);
    let pair = Pair { polarisation: stream.next(), keys: [50, 60], ..Pair::new(string, plate, link) };
    pair.table().unwrap()
}

/// A random kit of three sounds. Some keys are silent; some have a pitch, gain or choke group of their own.
fn kit(stream: &mut Stream, seed: u64) -> Arc<Kit> {
    let sounds = (0..3).map(|n| Arc::new(Sound::new(patch(stream, seed + n)))).collect();
    let pads = (0..KEYS).map(|_| {
        let pad = Pad {
            pitch: (stream.next() < 0.3).then(|| 40.0 + 40.0 * stream.next()),
            gain_db: (stream.next() * 20.0 - 14.0) as f32,
            pan: (stream.next() * 2.0 - 1.0) as f32,
            choke: (stream.next() < 0.3).then_some(1),
            ..Pad::of((stream.next() * 2.99) as usize)
        };
        (stream.next() < 0.9).then_some(pad)
    });
    Arc::new(Kit::new(String::new(), sounds, pads.collect()))
}

/// Notes, releases, bends, pressure and parameters: many at first, then few, so that notes also ring undisturbed.
fn events(stream: &mut Stream, frames: usize) -> Vec<Event> {
    let mut events: Vec<Event> = (0..60)
        .map(|_| {
            let frame = (stream.next() * stream.next() * frames as f64) as u32;
            let (key, value) = (36 + (stream.next() * 48.0) as u8, stream.next() as f32);
            let kind = match (stream.next() * 10.0) as u8 {
                0..=4 => EventKind::NoteOn { key, detune: value, velocity: value, id: None },
                5 => EventKind::NoteOff { key, velocity: value, id: None },
                6 => EventKind::PitchBend(value * 2.0 - 1.0),
                7 => EventKind::ChannelPressure(value),
                8 => EventKind::Control { controller: [1, 2, 7, 10, 11, 64][(value * 5.9) as usize], value },
                _ => {
                    let info = &PARAMS[(stream.next() * PARAMS.len() as f64) as usize % PARAMS.len()];
                    EventKind::Param { param: info.param, value: info.denormalise(value.into()) }
                }
            };
            Event { frame, channel: (frame % 2) as u8, kind }
        })
        .collect();
    events.sort_by_key(|event| event.frame);
    events
}

/// Each case, rendered by scalar code.
fn reference(extent: &Extent) -> Vec<(Case, Stereo)> {
    assert!(Level::Scalar.force(), "every CPU has scalar code");
    let rendered = |case: Case| {
        let audio = case.render();
        (case, audio)
    };
    Case::all(extent).into_par_iter().map(rendered).collect()
}

/// A line for each case that differs from scalar code.
fn differences(reference: &[(Case, Stereo)], level: Level, found: impl Fn(&Case) -> Stereo + Sync) -> Vec<String> {
    let line = |(case, expected): &(Case, Stereo)| {
        let found = found(case);
        let difference = diff::compare(expected, &found)?;
        Some(format!("{}: scalar and {} differ: {difference}", case.name, level.name()))
    };
    reference.par_iter().filter_map(line).collect()
}

/// Renders the cases on every level that the CPU has, and plants a difference of one bit, which must be reported.
fn levels_agree(extent: &Extent) {
    let _alone = LEVEL.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let reference = reference(extent);
    for (case, [left, right]) in reference.iter().filter(|(case, _)| case.name.starts_with("preset")) {
        let loudest = level::peak(left).max(level::peak(right));
        assert!(loudest >= AUDIBLE, "{}: its loudest sample is {loudest}, expected {AUDIBLE} or more", case.name);
    }
    for level in Level::ALL.into_iter().filter(|level| *level != Level::Scalar) {
        if level.force() {
            let differences = differences(&reference, level, Case::render);
            assert!(differences.is_empty(), "{}", differences.join("\n"));
        } else {
            println!("{} is left out: this CPU does not have it", level.name());
        }
    }
    let planted = |case: &Case| {
        let (_, audio) = reference.iter().find(|(other, _)| other.name == case.name).expect("it is a case");
        let mut audio = audio.clone();
        if case.name == reference[0].0.name {
            audio[1][1234] = f32::from_bits(audio[1][1234].to_bits() ^ 1);
        }
        audio
    };
    let found = differences(&reference, Level::Avx2, planted);
    let expected = format!("{}: scalar and avx2 differ: first differing frame 1234, ", reference[0].0.name);
    assert!(found.len() == 1 && found[0].starts_with(&expected), "{found:?} instead of {expected}…");
}

#[test]
fn levels_agree_on_few_cases() {
    levels_agree(&FEW);
}

#[test]
#[ignore = "takes minutes"]
fn levels_agree_on_many_cases() {
    levels_agree(&MANY);
}
