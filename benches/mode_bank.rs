//! Banks of masses on every level of vector instructions, beside a plain loop over an array of oscillators.
//!
//! Elements are modes × frames. `a plain loop` is what the ratios in ARCHITECTURE.md refer to. Ringing banks are
//! rendered by tables, modulated and driven ones step by step.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sprung::dsp::exciter::{Drive, Exciter};
use sprung::dsp::mode_bank::{Coupling, Law, Level, MAX_MODES, ModeBank, ModeSetup};
use sprung::dsp::{CONTROL_FRAMES, Coefficients, HarmonicOscillator};
use std::time::Duration;

/// A bank that has been struck, rings for longer than any measurement, and has its tables.
fn ringing_bank(modes: usize) -> ModeBank {
    let mut bank = ModeBank::new(48_000.0);
    let mode = |m: usize| ModeSetup { frequency: 100.0 + 310.0 * m as f64, t60: 10_000.0, left: 1.0, right: 1.0 };
    bank.load(Law::Exact, (0..modes).map(mode));
    (0..modes).for_each(|m| bank.set_coupling(m, Coupling { push: 1.0, pull: 0.0, noise: 1.0 }));
    let mut drive = Drive::NONE;
    drive.pulse[0] = 1.0;
    bank.sweep_to(1.0, CONTROL_FRAMES);
    bank.render(Some(&drive), CONTROL_FRAMES);
    for _ in 0..20 {
        bank.sweep_to(1.0, CONTROL_FRAMES);
        bank.render(None, CONTROL_FRAMES);
    }
    bank
}

/// As many modes as that, in banks of at most [`MAX_MODES`].
fn ringing_banks(modes: usize) -> Vec<ModeBank> {
    let whole = (0..modes / MAX_MODES).map(|_| ringing_bank(MAX_MODES));
    whole.chain((!modes.is_multiple_of(MAX_MODES)).then(|| ringing_bank(modes % MAX_MODES))).collect()
}

/// A control tick of one bank at a pitch ratio.
fn tick(bank: &mut ModeBank, ratio: f64, drive: Option<&Drive>) -> f32 {
    bank.sweep_to(ratio, CONTROL_FRAMES);
    bank.render(drive, CONTROL_FRAMES)[0][0]
}

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.force())
}

fn plain_loop(criterion: &mut Criterion) {
    const MODES: usize = 1024;
    const FRAMES: usize = 64;
    let mode = |m: usize| HarmonicOscillator::<f32>::new(&Coefficients::exact(m as f64 + 1.0, 1e4, 1.0, 48_000.0));
    let mut masses: Vec<_> = (0..MODES).map(mode).collect();
    let mut group = criterion.benchmark_group("a plain loop");
    group.throughput(Throughput::Elements((MODES * FRAMES) as u64));
    group.bench_function("1024 modes", |bencher| {
        let mut out = [0.0; FRAMES];
        bencher.iter(|| {
            out.fill_with(|| masses.iter_mut().map(HarmonicOscillator::step).sum());
            out[0]
        });
    });
    group.finish();
}

fn ringing(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("ringing");
    for level in levels() {
        for modes in [1, 8, 64, 1024, 4096] {
            let mut banks = ringing_banks(modes);
            for frames in [32, 64, 512] {
                group.throughput(Throughput::Elements((modes * frames) as u64));
                let id = BenchmarkId::new(level.name(), format!("{modes} modes × {frames} frames"));
                group.bench_function(id, |bencher| {
                    bencher.iter(|| {
                        for bank in &mut banks {
                            for _ in 0..frames / CONTROL_FRAMES {
                                tick(bank, 1.0, None);
                            }
                        }
                    });
                });
            }
        }
    }
    group.finish();
}

/// Sixteen banks of 64 modes, for 64 frames: swept anew at every tick, and under a burst of noise.
fn moving(criterion: &mut Criterion) {
    const MODES: usize = 16 * MAX_MODES;
    let mut group = criterion.benchmark_group("moving");
    group.throughput(Throughput::Elements((MODES * 2 * CONTROL_FRAMES) as u64));
    for level in levels() {
        let mut banks = ringing_banks(MODES);
        let mut turn = 0_u32;
        group.bench_function(BenchmarkId::new(level.name(), "modulated"), |bencher| {
            bencher.iter(|| {
                for _ in 0..2 {
                    turn = (turn + 1) % 7;
                    banks.iter_mut().for_each(|bank| _ = tick(bank, 1.0 + 0.001 * f64::from(turn), None));
                }
            });
        });
        let (mut exciter, mut drive) = (Exciter::REST, Drive::NONE);
        exciter.strike(0.0, 1, 1e-6, u32::MAX, 7);
        exciter.fill(CONTROL_FRAMES, &mut drive);
        let mut banks = ringing_banks(MODES);
        group.bench_function(BenchmarkId::new(level.name(), "driven"), |bencher| {
            bencher.iter(|| {
                (0..2).for_each(|_| banks.iter_mut().for_each(|bank| _ = tick(bank, 1.0, Some(&drive))));
            });
        });
    }
    group.finish();
}

/// What happens now and then, per mode.
fn control(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("control");
    group.throughput(Throughput::Elements(MAX_MODES as u64));
    for level in levels() {
        let mut bank = ringing_bank(MAX_MODES);
        group.bench_function(BenchmarkId::new(level.name(), "load"), |bencher| {
            let mode = ModeSetup { frequency: 1000.0, t60: 1.0, left: 1.0, right: 1.0 };
            bencher.iter(|| bank.load(Law::Exact, [mode; MAX_MODES].into_iter()));
        });
        let mut bank = ringing_bank(MAX_MODES);
        group.bench_function(BenchmarkId::new(level.name(), "settle"), |bencher| bencher.iter(|| bank.settle()));
    }
    group.finish();
}

fn quick() -> Criterion {
    let short = Duration::from_millis(400);
    Criterion::default().warm_up_time(short / 4).measurement_time(short).sample_size(20)
}

criterion_group! { name = benches; config = quick(); targets = plain_loop, ringing, moving, control }
criterion_main!(benches);
