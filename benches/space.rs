//! A plate reverb with all of its modes, compared with the driven mode bank and with smaller bodies in the same run.
//!
//! On every level of vector instructions. Elements are modes × frames, for plate and bank alike, and frames for the bodies;
//! `silence` is a whole block of a reverb that is idle.

#[allow(dead_code, reason = "shared with other benches")]
mod struck;

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sprung::internals::random::{key, uniform};
use sprung::internals::space::{
    BoxBody, Decay, ModalReverb, Overdrive, Plate, Resonator, Room, Soundbox, Spring, Strings, Tone, Tremolo, Width,
};
use sprung::internals::{CONTROL_FRAMES, Level};
use std::time::Duration;
use struck::{StruckBank, Work};

const RATE: f64 = 48_000.0;
const FRAMES: usize = 512;
const DECAY: Decay = Decay { low: 4.0, high: 1.5 };

fn noise() -> Vec<f32> {
    (0..FRAMES as u64).map(|n| 0.1 * uniform(key(1, 1), n)).collect()
}

fn plate_beside_bank(criterion: &mut Criterion) {
    let sheet = Plate::default().modes().leak();
    let input = noise();
    let mut group = criterion.benchmark_group("space");
    group.sampling_mode(SamplingMode::Flat);
    for level in Level::ALL.into_iter().filter(|level| level.force()) {
        let mut banks = StruckBank::many(4096, Work::Driven);
        group.throughput(Throughput::Elements((4096 * FRAMES) as u64));
        group.bench_function(BenchmarkId::new(level.name(), "bank, driven"), |bencher| {
            bencher.iter(|| {
                for bank in &mut banks {
                    (0..FRAMES / CONTROL_FRAMES).for_each(|_| _ = bank.tick());
                }
            });
        });
        let body = Resonator::new(sheet, DECAY, RATE);
        group.throughput(Throughput::Elements((body.len() * FRAMES) as u64));
        let mut reverb = ModalReverb::new(body);
        reverb.set_mix(0.5);
        for block in [32, 64, FRAMES] {
            let id = BenchmarkId::new(level.name(), format!("plate, blocks of {block}"));
            group.bench_function(id, |bencher| {
                let (mut left, mut right) = (input.clone(), input.clone());
                bencher.iter(|| {
                    left.copy_from_slice(&input);
                    right.copy_from_slice(&input);
                    let blocks = left.chunks_mut(block).zip(right.chunks_mut(block));
                    blocks.for_each(|(left, right)| reverb.process(left, right));
                    left[0]
                });
            });
        }
    }
    group.finish();
}

/// The cost of bodies per frame, at rest and while their pitch moves.
fn bodies(criterion: &mut Criterion) {
    let input = noise();
    let mut group = criterion.benchmark_group("bodies");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    for (name, modes) in [
        ("plate", Plate::default().modes()),
        ("room", Room::default().modes()),
        ("springs", Spring::default().modes()),
        ("strings", Strings::new([110.0, 165.0, 220.0, 277.18]).modes()),
    ] {
        for moves in [false, true] {
            let mut reverb = ModalReverb::new(Resonator::new(modes.clone().leak(), DECAY, RATE));
            reverb.set_mix(0.5);
            let mut pitch = 1.0;
            let id = BenchmarkId::new(name, if moves { "moving" } else { "at rest" });
            group.bench_function(id, |bencher| {
                let (mut left, mut right) = (input.clone(), input.clone());
                bencher.iter(|| {
                    left.copy_from_slice(&input);
                    right.copy_from_slice(&input);
                    pitch = if moves { 2.1 - pitch } else { pitch };
                    reverb.set_pitch(pitch);
                    reverb.process(&mut left, &mut right);
                    left[0]
                });
            });
        }
    }
    group.finish();
}

/// The cost of the effects per frame, in stereo.
fn effects(criterion: &mut Criterion) {
    let input = noise();
    let mut group = criterion.benchmark_group("effects");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    let mut sleeping = ModalReverb::new(Resonator::new(Plate::default().modes().leak(), DECAY, RATE));
    sleeping.set_mix(0.5);
    sleeping.reset();
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    group.bench_function("silence", |bencher| bencher.iter(|| sleeping.process(&mut left, &mut right)));
    macro_rules! effect {
        ($name:literal, $effect:expr) => {
            let mut effect = $effect;
            effect.reset();
            group.bench_function($name, |bencher| {
                bencher.iter(|| {
                    left.copy_from_slice(&input);
                    right.copy_from_slice(&input);
                    effect.process(&mut left, &mut right);
                    left[0]
                });
            });
        };
    }
    let (mut soundbox, mut voice) = (Soundbox::new(RATE), Soundbox::new(RATE));
    soundbox.set_mix(0.5);
    voice.set_mix(0.5);
    voice.set_body(BoxBody::voice());
    effect!("soundbox", soundbox);
    effect!("soundbox, voice", voice);
    let (mut tremolo, mut overdrive, mut tone, mut width) =
        (Tremolo::new(RATE), Overdrive::new(RATE), Tone::new(RATE), Width::new(RATE));
    tremolo.set_depth(0.5);
    overdrive.set(12.0);
    tone.set(3.0, -3.0);
    width.set(1.5);
    effect!("tremolo", tremolo);
    effect!("overdrive", overdrive);
    effect!("tone", tone);
    effect!("width", width);
    group.finish();
}

/// Many short samples, so that the fastest is not disturbed by other work on the machine.
fn quick() -> Criterion {
    let short = Duration::from_millis(150);
    Criterion::default().warm_up_time(short / 3).measurement_time(short).sample_size(20).nresamples(2000)
}

criterion_group! { name = benches; config = quick(); targets = plate_beside_bank, bodies, effects }
criterion_main!(benches);
