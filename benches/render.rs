//! The demo song, from MIDI file to samples.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sprung::io::Song;
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::render::{Job, Options, Tail};

fn render(criterion: &mut Criterion) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/midi/suite.mid");
    let song = Song::read(std::fs::File::open(file).unwrap(), file).unwrap();
    let programs: Vec<Patch> = Preset::factory().iter().map(|preset| preset.patch).collect();
    let options = Options { sample_rate: 48_000, seed: 0, block: 1024, tail: Tail::None };
    let job = Job { song: &song, patch: &programs[0], programs: &programs, options };
    let mut group = criterion.benchmark_group("render");
    group.sample_size(10).throughput(Throughput::Elements(job.song_frames()));
    group.bench_function("suite.mid", |bencher| bencher.iter(|| job.render(|_, _| Ok(())).unwrap()));
    group.finish();
}

criterion_group!(benches, render);
criterion_main!(benches);
