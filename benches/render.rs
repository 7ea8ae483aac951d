//! The demo song, from MIDI file to samples, on one thread and on two.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sprung::io::Song;
use sprung::preset::{Preset, Programs};
use sprung::render::{Job, Options, Tail, on_threads};
use std::time::Duration;

fn render(criterion: &mut Criterion) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/midi/suite.mid");
    let mut song = Song::read(std::fs::File::open(file).unwrap(), file).unwrap();
    song.select_by_bank();
    let kit = Preset::find("init").unwrap().kit();
    let programs = Programs::factory_kits();
    let options = Options { sample_rate: 48_000, seed: 0, block: 4096, tail: Tail::None };
    let job = Job { programs: &programs, mix: Some(&Programs::general_midi().mix), ..Job::new(&song, &kit, options) };
    let mut group = criterion.benchmark_group("suite.mid");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(job.song_frames()));
    for threads in [1, 2] {
        let render = || on_threads(Some(threads), || job.render(|_, _| Ok(())));
        group.bench_function(format!("{threads} threads"), |bencher| bencher.iter(render));
    }
    group.finish();
}

fn quick() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_secs(5))
        .sample_size(10)
}

criterion_group! { name = benches; config = quick(); targets = render }
criterion_main!(benches);
