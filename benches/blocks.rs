//! How evenly the work of songs is spread over blocks of 64 frames at 48 kHz, the time in which a host wants each of them.
//!
//! The work of a block is the same in every run, and other programs only ever add to its time; so the time of a block is the
//! least of [`RUNS`] runs. Prints a table: of the blocks of a song, the median, the 99th and the 99.99th percentile and the
//! worst, in % of a block's duration.

mod song;

use song::{RATE, Sounds, song};
use sprung::engine::EventKind;
use sprung::internals::threads::on_threads;
use sprung::io::{Song, SongEvent};
use sprung::params::{Choice, Param, Space};
use sprung::preset::Preset;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

const FRAMES: usize = 64;
const RUNS: usize = 5;

/// The song, but once a second one of the first five channels, which have most of its notes, changes to another space.
fn with_spaces_switched(mut song: Song) -> Song {
    let count = Space::ALL.len() as u32;
    let kind = |second: u32| EventKind::Param { param: Param::Space, value: (second % count) as f32 };
    let switch = |second| SongEvent { seconds: f64::from(second), channel: (second % 5) as u8, kind: kind(second) };
    song.events.extend((0..song.seconds as u32).map(switch));
    song.events.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    song
}

/// The time of each block in seconds: the least of some runs.
fn block_times(song: &Song) -> Vec<f64> {
    let sounds = Sounds::new();
    let job = sounds.job(song, FRAMES);
    let mut least = vec![f64::INFINITY; (job.song_frames() as usize).div_ceil(FRAMES)];
    for _ in 0..RUNS {
        let (mut block, mut before) = (0, None::<Instant>);
        let timed = on_threads(Some(1), || {
            job.render(|_, _| {
                if let Some(before) = before {
                    least[block] = f64::min(least[block], before.elapsed().as_secs_f64());
                }
                (block, before) = (block + 1, Some(Instant::now()));
                Ok(())
            })
        });
        timed.unwrap().unwrap();
    }
    // No block is before the first, whose time includes that of the preparation.
    least.remove(0);
    least
}

fn print_row(name: &str, song: &Song) {
    let mut times = block_times(song);
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize];
    let [median, most, nearly_all, worst] = [0.5, 0.99, 0.9999, 1.0].map(at);
    let percent = |time: f64| 100.0 * time * f64::from(RATE) / FRAMES as f64;
    println!(
        "| {name} | {} | {:.1} | {:.1} | {:.1} ({:.1} medians) | {:.1} |",
        times.len(),
        percent(median),
        percent(most),
        percent(nearly_all),
        nearly_all / median,
        percent(worst),
    );
}

fn main() {
    if !std::env::args().any(|argument| argument == "--bench") {
        // Among the tests: that it runs.
        return print_row("an empty song", &Song { seconds: 1.0, ..Song::default() });
    }
    println!("| song | blocks | median | 99 % | 99.99 % | worst |\n|---|---|---|---|---|---|");
    for name in ["groove", "kits", "suite"] {
        print_row(name, &song(name));
    }
    print_row("suite, spaces switched", &with_spaces_switched(song("suite")));
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                Preset::factory().iter().for_each(|preset| _ = std::hint::black_box(preset.kit()));
            }
        });
        print_row("suite, spaces switched, presets loaded meanwhile", &with_spaces_switched(song("suite")));
        is_over.store(true, Ordering::Relaxed);
    });
}
