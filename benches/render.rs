//! The demo song, from MIDI file to samples, on one thread and on two.

mod song;

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use song::Sounds;
use sprung::internals::threads::on_threads;
use std::time::Duration;

fn render(criterion: &mut Criterion) {
    let (song, sounds) = (song::song("suite"), Sounds::new());
    let job = sounds.job(&song, 4096);
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
