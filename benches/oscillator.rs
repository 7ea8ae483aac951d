//! One mass: the step and the step with sweep.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sprung::dsp::{Coefficients, HarmonicOscillator};
use std::hint::black_box;

/// Steps per measurement.
const FRAMES: usize = 1024;

fn oscillator(criterion: &mut Criterion) {
    let coefficients = Coefficients::exact(440.0, 1000.0, 1.0, 48_000.0);
    let mut group = criterion.benchmark_group("oscillator");
    group.throughput(Throughput::Elements(FRAMES as u64));
    group.bench_function("step", |bencher| {
        let mut oscillator = HarmonicOscillator::<f32>::new(&coefficients);
        bencher.iter(|| (0..FRAMES).map(|_| oscillator.step()).sum::<f32>());
    });
    group.bench_function("step with sweep", |bencher| {
        let mut oscillator = HarmonicOscillator::<f32>::new(&coefficients);
        bencher.iter(|| (0..FRAMES).map(|_| oscillator.step_with_sweep(black_box(1.25))).sum::<f32>());
    });
    group.finish();
}

criterion_group!(benches, oscillator);
criterion_main!(benches);
