//! How whole songs scale with the cores that render them.
//!
//! One and two threads are measured. For more cores, one thread does the work and times each piece of it, channels and
//! notes; then the pieces are scheduled as the pool of threads would: the piece that is ready first on the core that is free
//! first. Waking and waiting are not in that, so it is what a machine could do at best. Prints a table: × real time.

mod song;

use song::{RATE, Sounds, song};
use sprung::engine::{Ensemble, Event, Workers};
use sprung::internals::threads::on_threads;
use sprung::io::{Song, SongEvent};
use sprung::preset::{Preset, Programs};
use std::sync::Mutex;
use std::time::Instant;

/// Frames that are rendered at a time: the renderer's default.
const FRAMES: usize = 4096;
const RUNS: usize = 3;
const CORES: [usize; 5] = [1, 2, 4, 8, 16];

/// Times in seconds of pieces of work that can be done at once. A channel's work is a sequence of such stages.
type Stage = Vec<f64>;

/// One thread that times what it does.
#[derive(Default)]
struct Timed(Mutex<Times>);

#[derive(Default)]
struct Times {
    /// The stages of each channel, chunk by chunk.
    chunks: Vec<Vec<Vec<Stage>>>,
    /// When the work of a channel went on, if one is played.
    since: Option<Instant>,
}

impl Times {
    /// The channels of the chunk at hand.
    fn channels(&mut self) -> &mut Vec<Vec<Stage>> {
        self.chunks.last_mut().expect("a chunk has begun")
    }

    /// Ends the stage at hand, which one thread did alone.
    fn end_stage(&mut self) {
        if let Some(since) = self.since.take() {
            let seconds = since.elapsed().as_secs_f64();
            self.channels().last_mut().expect("a channel has begun").push(vec![seconds]);
        }
    }
}

impl Workers for Timed {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        let are_notes = self.0.lock().unwrap().since.is_some();
        if are_notes {
            self.0.lock().unwrap().end_stage();
            let time = |item| {
                let start = Instant::now();
                work(item);
                start.elapsed().as_secs_f64()
            };
            let notes = items.iter_mut().map(time).collect();
            let mut times = self.0.lock().unwrap();
            times.channels().last_mut().unwrap().push(notes);
            times.since = Some(Instant::now());
        } else {
            self.0.lock().unwrap().chunks.push(Vec::new());
            for item in items {
                let mut times = self.0.lock().unwrap();
                times.channels().push(Vec::new());
                times.since = Some(Instant::now());
                drop(times);
                work(item);
                self.0.lock().unwrap().end_stage();
            }
        }
    }

    fn shares_notes(&self) -> bool {
        true
    }
}

/// The seconds that so many cores take for the stages of all channels.
fn scheduled(channels: &[Vec<Stage>], cores: usize) -> f64 {
    let mut free = vec![0.0_f64; cores];
    // When the next stage of each channel can begin.
    let mut ready: Vec<(f64, &[Stage])> = channels.iter().map(|stages| (0.0, &stages[..])).collect();
    let waits = |(_, stages): &&mut (f64, &[Stage])| !stages.is_empty();
    while let Some((at, stages)) = ready.iter_mut().filter(waits).min_by(|a, b| a.0.total_cmp(&b.0)) {
        let start = *at;
        for seconds in &stages[0] {
            let first = free.iter_mut().min_by(|a, b| a.total_cmp(b)).unwrap();
            *first = first.max(start) + seconds;
            *at = at.max(*first);
        }
        *stages = &stages[1..];
    }
    free.into_iter().fold(0.0, f64::max)
}

/// The seconds that each of [`CORES`] takes for a song: the least of some runs.
fn simulated(song: &Song) -> [f64; CORES.len()] {
    let (kit, programs) = (Preset::find("init").unwrap().kit(), Programs::factory_kits());
    let mut least = [f64::INFINITY; CORES.len()];
    for _ in 0..RUNS {
        let mix = &Programs::general_midi().mix;
        let mut ensemble = Ensemble::of_kits(RATE.into(), 0, &kit, programs.clone()).with_mix(mix).with_chunk(FRAMES);
        let (mut left, mut right, mut seconds) = ([0.0; FRAMES], [0.0; FRAMES], [0.0; CORES.len()]);
        let frame = |event: &SongEvent| event.frame(RATE.into()) as usize;
        let frames = Sounds::new().job(song, FRAMES).song_frames() as usize;
        let mut rest = &song.events[..];
        for start in (0..frames).step_by(FRAMES) {
            let (now, later) = rest.split_at(rest.partition_point(|event| frame(event) < start + FRAMES));
            let events = now.iter().map(|event| {
                let SongEvent { channel, kind, .. } = *event;
                Event { frame: (frame(event) - start) as u32, channel, kind }
            });
            let (events, timed) = (events.collect::<Vec<_>>(), Timed::default());
            let begin = Instant::now();
            ensemble.process_by(&timed, &events, &[], &mut left, &mut right);
            let whole = begin.elapsed().as_secs_f64();
            let chunks = timed.0.into_inner().unwrap().chunks;
            let alone = whole - chunks.iter().flatten().flatten().flatten().sum::<f64>();
            for (sum, cores) in seconds.iter_mut().zip(CORES) {
                *sum += alone + chunks.iter().map(|channels| scheduled(channels, cores)).sum::<f64>();
            }
            rest = later;
        }
        least = std::array::from_fn(|index| least[index].min(seconds[index]));
    }
    least
}

/// The seconds that so many threads take for a song: the least of some runs.
fn measured(song: &Song, threads: u16) -> f64 {
    let sounds = Sounds::new();
    let job = sounds.job(song, FRAMES);
    let run = |_| {
        let start = Instant::now();
        on_threads(Some(threads), || job.render(|_, _| Ok(()))).unwrap().unwrap();
        start.elapsed().as_secs_f64()
    };
    (0..RUNS).map(run).fold(f64::INFINITY, f64::min)
}

/// The song with the notes of its busiest channel alone, drums aside.
fn busiest_channel(mut song: Song) -> Song {
    let events = |channel: u8| song.events.iter().filter(|event| event.channel == channel).count();
    let busiest = (0..16).filter(|channel| *channel != 9).max_by_key(|channel| events(*channel));
    song.events.retain(|event| Some(event.channel) == busiest);
    song
}

fn print_row(name: &str, song: &Song) {
    let speed = |seconds: f64| format!("{:.1}", song.seconds / seconds);
    let columns = [1, 2].map(|threads| measured(song, threads)).into_iter().chain(simulated(song)).map(speed);
    println!("| {name} | {} |", columns.collect::<Vec<_>>().join(" | "));
}

fn main() {
    if !std::env::args().any(|argument| argument == "--bench") {
        // Among the tests: that it runs.
        return print_row("an empty song", &Song { seconds: 0.1, ..Song::default() });
    }
    println!(
        "| song | 1 thread | 2 threads | scheduled on 1 core | 2 | 4 | 8 | 16 |\n|---|---|---|---|---|---|---|---|"
    );
    for name in ["groove", "kits", "suite"] {
        print_row(name, &song(name));
        print_row(&format!("{name}, its busiest channel"), &busiest_channel(song(name)));
    }
}
