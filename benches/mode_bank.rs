//! A bank of 64 masses over one control tick: ringing, swept, and driven.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sprung::dsp::CONTROL_FRAMES;
use sprung::dsp::exciter::{Drive, Exciter};
use sprung::dsp::mode_bank::{Coupling, Law, MAX_MODES, ModeBank, ModeSetup};

/// A full bank that has just been struck, and rings for longer than any measurement.
fn struck_bank() -> ModeBank {
    let mut bank = ModeBank::new(48_000.0);
    let mode = |m: usize| ModeSetup { frequency: 100.0 + 310.0 * m as f64, t60: 10_000.0, left: 0.1, right: 0.1 };
    bank.load(Law::Exact, (0..MAX_MODES).map(mode));
    (0..MAX_MODES).for_each(|m| bank.set_coupling(m, Coupling { push: 1.0, pull: 0.0, noise: 0.0 }));
    let mut drive = Drive::NONE;
    drive.pulse[0] = 1.0;
    let [mut left, mut right] = [[0.0; CONTROL_FRAMES]; 2];
    bank.render(Some(&drive), &mut left, &mut right);
    bank
}

fn mode_bank(criterion: &mut Criterion) {
    let [mut left, mut right] = [[0.0; CONTROL_FRAMES]; 2];
    let mut group = criterion.benchmark_group("bank of 64");
    group.throughput(Throughput::Elements((MAX_MODES * CONTROL_FRAMES) as u64));
    group.bench_function("ringing", |bencher| {
        let mut bank = struck_bank();
        bencher.iter(|| bank.render(None, &mut left, &mut right));
    });
    group.bench_function("swept", |bencher| {
        let mut bank = struck_bank();
        let mut up = false;
        bencher.iter(|| {
            up = !up;
            bank.sweep_to(if up { 1.01 } else { 0.99 }, CONTROL_FRAMES);
            bank.render(None, &mut left, &mut right);
        });
    });
    group.bench_function("driven", |bencher| {
        let mut bank = struck_bank();
        let (mut exciter, mut drive) = (Exciter::REST, Drive::NONE);
        exciter.strike(0.0, 1, 1e-6, u32::MAX, 7);
        bencher.iter(|| {
            exciter.fill(CONTROL_FRAMES, &mut drive);
            bank.render(Some(&drive), &mut left, &mut right);
        });
    });
    group.bench_function("settle", |bencher| {
        let mut bank = struck_bank();
        bencher.iter(|| bank.settle());
    });
    group.finish();
}

criterion_group!(benches, mode_bank);
criterion_main!(benches);
