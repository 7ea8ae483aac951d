//! The speed of the machine: its clock, and fused multiply-adds per second, on one core.
//!
//! Elements of `clock` are cycles, those of the others are scalar `a·b + c`. Read these next to every other figure.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

const STEPS: u64 = 4096;

/// An exclusive or and a multiplication, each waiting for the other: four cycles on Intel and AMD cores since 2013.
fn clock(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("probe");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(4 * STEPS));
    let odd = black_box(0x9e37_79b9_7f4a_7c15_u64);
    group.bench_function("clock", |bencher| {
        bencher.iter(|| (0..STEPS).fold(odd, |x, n| (x ^ n).wrapping_mul(odd)));
    });
    group.finish();
}

/// Twelve independent sums: more than two units with a latency of four cycles can process at once.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{_mm256_fmadd_ps, _mm256_set1_ps, _mm512_fmadd_ps, _mm512_set1_ps};

    pub(super) const SUMS: u64 = 12;

    macro_rules! sums {
        ($name:ident, $features:literal, $set1:ident, $fmadd:ident) => {
            #[target_feature(enable = $features)]
            pub(super) fn $name(steps: u64, value: f32) {
                let factor = $set1(value);
                let mut sums = [factor; SUMS as usize];
                for _ in 0..steps {
                    sums.iter_mut().for_each(|sum| *sum = $fmadd(*sum, factor, factor));
                }
                std::hint::black_box(&sums);
            }
        };
    }
    sums!(avx2, "avx2,fma", _mm256_set1_ps, _mm256_fmadd_ps);
    sums!(avx512, "avx512f", _mm512_set1_ps, _mm512_fmadd_ps);
}

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "calls what is compiled for instructions that the CPU was found to have")]
fn fused(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("probe");
    group.sampling_mode(SamplingMode::Flat);
    let value = black_box(0.5);
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        group.throughput(Throughput::Elements(8 * x86::SUMS * STEPS));
        // SAFETY: the CPU has AVX2 and FMA.
        group.bench_function("avx2", |bencher| bencher.iter(|| unsafe { x86::avx2(STEPS, value) }));
    }
    if is_x86_feature_detected!("avx512f") {
        group.throughput(Throughput::Elements(16 * x86::SUMS * STEPS));
        // SAFETY: the CPU has AVX-512F.
        group.bench_function("avx512", |bencher| bencher.iter(|| unsafe { x86::avx512(STEPS, value) }));
    }
    group.finish();
}

/// The levels above are those of x86; on other CPUs only the clock is measured.
#[cfg(not(target_arch = "x86_64"))]
fn fused(_: &mut Criterion) {}

fn quick() -> Criterion {
    let short = Duration::from_millis(150);
    Criterion::default().warm_up_time(short / 3).measurement_time(short).sample_size(20).nresamples(2000)
}

criterion_group! { name = benches; config = quick(); targets = clock, fused }
criterion_main!(benches);
