//! Sixteen voices of 64 modes for 64 frames, by fundsp and by Sprung in one run. Elements are modes × frames.
//!
//! fundsp uses the vector instructions that the compiler may use, so build with `RUSTFLAGS="-C target-cpu=x86-64-v3"`.
//! Its filters take an input sample in each frame, as Sprung's do when `driven`. Other peers: `run.sh`, in this folder.

#[path = "../struck/mod.rs"]
mod struck;

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use fundsp::audionode::AudioNode;
use fundsp::biquad::{BiquadCoefs, Resonator};
use fundsp::biquad_bank::BiquadBank;
use fundsp::buffer::BufferArray;
use fundsp::numeric_array::typenum::{U1, U8};
use fundsp::{F32x, Float, Frame};
use sprung::internals::Level;
use sprung::internals::random::uniform;
use std::hint::black_box;
use std::time::Duration;
use struck::{StruckBank, Work};

const MODES: usize = 16 * 64;
const FRAMES: usize = 64;

fn frequency(m: usize) -> f32 {
    100.0 + 20.0 * m as f32
}

/// An input signal for the filters.
fn noise() -> [f32; FRAMES] {
    black_box(std::array::from_fn(|n| 0.5 * uniform(1, n as u64)))
}

/// All filters, as banks of eight biquads in a vector.
fn biquad_banks() -> Vec<BiquadBank<F32x>> {
    let resonator = |m| BiquadCoefs::resonator(48_000.0, frequency(m), 1000.0);
    let bank = |n: usize| {
        let c: [BiquadCoefs<f32>; 8] = std::array::from_fn(|lane| resonator(8 * n + lane));
        let lanes = |part: fn(&BiquadCoefs<f32>) -> f32| F32x::new(std::array::from_fn(|lane| part(&c[lane])));
        let coefs = BiquadCoefs {
            a1: lanes(|c| c.a1),
            a2: lanes(|c| c.a2),
            b0: lanes(|c| c.b0),
            b1: lanes(|c| c.b1),
            b2: lanes(|c| c.b2),
        };
        BiquadBank::<F32x>::with_coefs(coefs)
    };
    (0..MODES / 8).map(bank).collect()
}

/// One bank after the other over the block, in a loop around `tick` that the compiler can optimise: fundsp at its
/// fastest.
fn biquad_ticks(criterion: &mut Criterion) {
    let mut banks = biquad_banks();
    let input = noise();
    bench(criterion, "fundsp BiquadBank tick", || {
        let mut sums = [F32x::ZERO; FRAMES];
        for bank in &mut banks {
            for (sum, input) in sums.iter_mut().zip(input) {
                let frame: Frame<f32, U8> = [input; 8].into();
                *sum += F32x::from_frame(&bank.tick(&frame));
            }
        }
        sums[0].reduce_add() + sums[FRAMES - 1].reduce_add()
    });
}

/// One bank after the other, with `process`, as fundsp's graphs do it.
fn biquad_blocks(criterion: &mut Criterion) {
    let mut banks = biquad_banks();
    let (mut input, mut output) = (BufferArray::<U8>::new(), BufferArray::<U8>::new());
    for channel in 0..8 {
        input.channel_f32_mut(channel).copy_from_slice(&noise());
    }
    bench(criterion, "fundsp BiquadBank process", || {
        let mut sums = [F32x::ZERO; FRAMES / 8];
        for bank in &mut banks {
            bank.process(FRAMES, &input.buffer_ref(), &mut output.buffer_mut());
            for channel in 0..8 {
                sums.iter_mut().zip(output.channel(channel)).for_each(|(sum, eight)| *sum += *eight);
            }
        }
        sums[0].reduce_add() + sums[FRAMES / 8 - 1].reduce_add()
    });
}

/// One resonator after the other over the block.
fn resonators(criterion: &mut Criterion) {
    let mut filters: Vec<_> = (0..MODES).map(|m| Resonator::<f32, U1>::new(frequency(m), 10.0)).collect();
    filters.iter_mut().for_each(|filter| filter.set_sample_rate(48_000.0));
    let input = noise();
    bench(criterion, "fundsp resonator", || {
        let mut sums = [0.0; FRAMES];
        for filter in &mut filters {
            for (sum, input) in sums.iter_mut().zip(input) {
                *sum += filter.tick(&[input].into())[0];
            }
        }
        sums[0] + sums[FRAMES - 1]
    });
}

fn sprung(criterion: &mut Criterion) {
    for work in Work::ALL {
        for level in Level::ALL.into_iter().filter(|level| level.force()) {
            let mut banks = StruckBank::many(MODES, work);
            bench(criterion, &format!("sprung {} {}", work.name(), level.name()), || {
                banks.iter_mut().map(|bank| bank.tick() + bank.tick()).sum()
            });
        }
    }
}

fn bench(criterion: &mut Criterion, name: &str, mut work: impl FnMut() -> f32) {
    let mut group = criterion.benchmark_group("peers");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements((MODES * FRAMES) as u64));
    group.bench_function(name, |bencher| bencher.iter(&mut work));
    group.finish();
}

fn quick() -> Criterion {
    let short = Duration::from_millis(300);
    Criterion::default().warm_up_time(short / 3).measurement_time(short).sample_size(20).nresamples(2000)
}

criterion_group! { name = benches; config = quick(); targets = biquad_ticks, biquad_blocks, resonators, sprung }
criterion_main!(benches);
