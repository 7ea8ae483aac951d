//! Banks of masses on every level of vector instructions, compared with a plain loop over an array of oscillators.
//!
//! Elements are modes × frames. The ratios in `benches/README.md` are relative to `plain loop`. Ringing banks are
//! rendered by tables, modulated and driven banks step by step. A call renders a block of frames. Banks have at most 64
//! modes; larger numbers are several banks, rendered one after the other.

mod struck;

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sprung::dsp::{Coefficients, HarmonicOscillator, MAX_MODES, ModeBank, ModeSetup};
use sprung::internals::{CONTROL_FRAMES, Level};
use std::time::Duration;
use struck::{StruckBank, Work};

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.force())
}

/// An array of structs, stepped sample by sample: the simplest implementation.
fn plain_loop(criterion: &mut Criterion) {
    const MODES: usize = 1024;
    const FRAMES: usize = 64;
    let mode = |m: usize| HarmonicOscillator::<f32>::new(&Coefficients::exact(m as f64 + 1.0, 1e4, 1.0, 48_000.0));
    let mut masses: Vec<_> = (0..MODES).map(mode).collect();
    let mut group = criterion.benchmark_group("plain loop");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements((MODES * FRAMES) as u64));
    group.bench_function("1024 modes", |bencher| {
        let mut out = [0.0; FRAMES];
        bencher.iter(|| {
            out.fill_with(|| masses.iter_mut().map(HarmonicOscillator::step).sum());
            out[0]
        });
    });
    group.finish();
}

fn banks(criterion: &mut Criterion) {
    for work in Work::ALL {
        let mut group = criterion.benchmark_group(work.name());
        group.sampling_mode(SamplingMode::Flat);
        for level in levels() {
            for modes in [1, 8, 64, 1024, 4096] {
                let mut banks = StruckBank::many(modes, work);
                for frames in [32, 64, 512] {
                    group.throughput(Throughput::Elements((modes * frames) as u64));
                    let id = BenchmarkId::new(level.name(), format!("{modes} modes x {frames} frames"));
                    group.bench_function(id, |bencher| {
                        bencher.iter(|| {
                            for bank in &mut banks {
                                (0..frames / CONTROL_FRAMES).for_each(|_| _ = bank.tick());
                            }
                        });
                    });
                }
            }
        }
        group.finish();
    }
}

/// Operations at control ticks, per mode.
fn control(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("control");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(MAX_MODES as u64));
    for level in levels() {
        let mut bank = ModeBank::new(48_000.0);
        let mode = ModeSetup { frequency: 1000.0, t60: 1.0, left: 1.0, right: 1.0 };
        group.bench_function(BenchmarkId::new(level.name(), "load"), |bencher| {
            bencher.iter(|| bank.load(&[mode; MAX_MODES].into_iter().collect()));
        });
        let StruckBank { mut bank, .. } = StruckBank::new(MAX_MODES, Work::Ringing);
        group.bench_function(BenchmarkId::new(level.name(), "settle"), |bencher| bencher.iter(|| bank.settle()));
    }
    group.finish();
}

/// Many short samples, so that the fastest is not disturbed by other work on the machine.
fn quick() -> Criterion {
    let short = Duration::from_millis(150);
    Criterion::default().warm_up_time(short / 3).measurement_time(short).sample_size(20).nresamples(2000)
}

criterion_group! { name = benches; config = quick(); targets = plain_loop, banks, control }
criterion_main!(benches);
