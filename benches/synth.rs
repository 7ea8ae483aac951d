//! Whole instruments at 48 kHz, in blocks of 64 frames, on every level of vector instructions. Elements are frames.

mod chord;

use chord::{Chord, FRAMES, moving, patch, routed};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sprung::engine::{Ensemble, Synth};
use sprung::internals::Level;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::preset::Preset;
use std::time::{Duration, Instant};

const VOICES: usize = 16;

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.force())
}

/// Sixteen notes of 64 modes, and of factory sounds: struck in one block; ringing; with bend, vibrato and sweep; and with sixteen routes as
/// well.
fn chords(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("synth");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    for level in levels() {
        // The last have the most modes of the factory's sounds, and much that differs from strike to strike.
        let sounds = ["Grand Piano", "Crash", "Clash Cymbals"].map(|name| {
            let patch = Preset::find(name).expect("the factory has it").patch.clone();
            (name, patch.with(Param::Voices, VOICES as f32))
        });
        for (name, patch) in sounds.into_iter().chain([("note-on", patch(VOICES))]) {
            group.bench_function(BenchmarkId::new(level.name(), name), |bencher| {
                let mut chord = Chord::new(&patch, VOICES);
                bencher.iter_custom(|iterations| {
                    let struck = |_| {
                        chord.reset();
                        let start = Instant::now();
                        chord.strike();
                        start.elapsed()
                    };
                    (0..iterations).map(struck).sum()
                });
            });
        }
        let works = [
            ("ringing", patch(VOICES), false),
            ("moving", moving(patch(VOICES)), true),
            ("routed", routed(patch(VOICES)), true),
        ];
        for (name, patch, bent) in works {
            let mut chord = Chord::new(&patch, VOICES);
            group.bench_function(BenchmarkId::new(level.name(), name), |bencher| {
                bencher.iter(|| chord.process(bent));
            });
        }
    }
    group.finish();
}

/// From one note to the maximum number.
fn voices(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("voices");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    Level::ALL.into_iter().rev().any(Level::force);
    for voices in [1, 2, 4, 8, 16, 32, 64] {
        let mut chord = Chord::new(&patch(voices), voices);
        group.bench_function(voices.to_string(), |bencher| bencher.iter(|| chord.process(false)));
    }
    group.finish();
}

/// Sixteen held notes of factory sounds that something goes on touching: a bow, a reed, lips, an edge, a loose mass.
fn touching(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("touching");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    Level::ALL.into_iter().rev().any(Level::force);
    for name in ["Violin", "Clarinet", "Trumpet", "Sitar", "Prepared Piano"] {
        let patch = Preset::find(name).expect("the factory has it").patch.clone().with(Param::Voices, VOICES as f32);
        let mut chord = Chord::new(&patch, VOICES);
        group.bench_function(name, |bencher| bencher.iter(|| chord.process(false)));
    }
    group.finish();
}

/// Silence.
fn idle(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("idle");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(FRAMES as u64));
    let [mut left, mut right] = [[0.0; FRAMES]; 2];
    let mut synth = Synth::new(48_000.0, 1);
    group.bench_function("synth", |bencher| bencher.iter(|| synth.process(&[], &mut left, &mut right)));
    let mut ensemble = Ensemble::new(48_000.0, 1, &Patch::default(), &[]);
    group.bench_function("ensemble", |bencher| bencher.iter(|| ensemble.process(&[], &mut left, &mut right)));
    group.finish();
}

fn quick() -> Criterion {
    let short = Duration::from_millis(300);
    Criterion::default().warm_up_time(short / 3).measurement_time(short).sample_size(20).nresamples(2000)
}

criterion_group! { name = benches; config = quick(); targets = chords, voices, touching, idle }
criterion_main!(benches);
