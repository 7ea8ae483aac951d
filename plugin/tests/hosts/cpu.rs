//! CPU time of the open window's threads, while nothing moves and while everything moves.
//!
//! The test asserts only whether pictures are drawn. Times depend on the machine, so they are only printed.

use crate::host::{Address, Instance, Player, Sent};
use crate::patches::enclosed;
use crate::process::{Stops, wait_until};
use crate::window::{Editor, Parent, on_a_screen};
use clack_host::prelude::*;
use sprung::preset::Preset;
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Duration of each measurement.
const MEASURED: Duration = Duration::from_secs(10);

pub(crate) fn a_silent_window_draws_nothing() {
    print!("{}", on_a_screen("window-cpu"));
}

/// Runs in the process that the test starts.
pub(crate) fn work() -> ExitCode {
    let parent = Parent::new();
    parent.onlooker.point([1_279, 799]);
    let mut instance = Instance::new();
    let preset = Preset::find("Church Bell").unwrap().to_toml();
    let own = serde_json::json!({ "format": 1, "preset": preset, "seed": 0, "window": [1_100, 700] });
    assert!(instance.load(&enclosed(&own.to_string())));
    let Player { mut instance, mut audio } = instance.play(48_000.0, 480);
    let (stop, strike) = (AtomicBool::new(false), AtomicBool::new(false));
    let [silent, sounding] = std::thread::scope(|scope| {
        let stops = Stops(&stop);
        scope.spawn(|| {
            let mut events = EventBuffer::new();
            let (mut at, mut block) = (Instant::now(), 0_u32);
            while !stop.load(Ordering::Relaxed) {
                events.clear();
                if strike.load(Ordering::Relaxed) && block % 100 == 0 {
                    let note = (block / 100) as i32;
                    Sent::On(Address::note(0, 55 + (note % 12) as i16, note), 0.8).push(0, &mut events);
                }
                block += 1;
                audio.process(&events, 480);
                at += Duration::from_millis(10);
                std::thread::sleep(at.saturating_duration_since(Instant::now()));
            }
        });
        std::thread::sleep(Duration::from_millis(100));
        let before = tasks();
        let editor = Editor::open(&mut instance, &parent);
        wait_until("a picture", || {
            instance.run_callbacks();
            parent.onlooker.sees_a_picture(1_100, 700)
        });
        wait_for_rest(&mut instance, &parent);
        let silent = measure("silent", &before, &mut instance, &parent);
        strike.store(true, Ordering::Relaxed);
        std::thread::sleep(Duration::from_secs(1));
        let sounding = measure("sounding", &before, &mut instance, &parent);
        editor.close(&mut instance);
        drop(stops);
        [silent, sounding]
    });
    Player { instance, audio }.stop();
    assert!(sounding > 0, "no picture was seen of a window in which modes ring down");
    assert_eq!(silent, 0, "nothing moves in the silent window, and yet it is drawn");
    ExitCode::SUCCESS
}

/// Waits until nothing has been drawn for a second: a slow machine takes long for the first pictures.
fn wait_for_rest(instance: &mut Instance, parent: &Parent) {
    let pictures = parent.onlooker.watch(parent.window);
    let mut last = Instant::now();
    wait_until("rest", || {
        instance.run_callbacks();
        if parent.onlooker.pictures_since() > 0 {
            last = Instant::now();
        }
        last.elapsed() > Duration::from_secs(1)
    });
    parent.onlooker.unwatch(pictures);
}

/// Measures the threads that did not exist `before` and prints their CPU time. Returns the number of pictures drawn.
fn measure(name: &str, before: &BTreeMap<u32, f64>, instance: &mut Instance, parent: &Parent) -> u32 {
    let (start, began) = (tasks(), Instant::now());
    let pictures = parent.onlooker.watch(parent.window);
    let mut drawn = 0;
    while began.elapsed() < MEASURED {
        instance.run_callbacks();
        drawn += parent.onlooker.pictures_since();
        std::thread::sleep(Duration::from_millis(10));
    }
    parent.onlooker.unwatch(pictures);
    let seconds = began.elapsed().as_secs_f64();
    let now = tasks();
    let new = now.iter().filter(|(task, _)| !before.contains_key(task));
    let took = new.map(|(task, took)| (took - start.get(task).unwrap_or(&0.0)) / seconds * 100.0);
    let took: Vec<f64> = took.collect();
    let sum: f64 = took.iter().sum();
    println!(
        "{name}: {sum:.2} % of a core, {:.1} pictures a second; by thread: {took:.2?}",
        f64::from(drawn) / seconds
    );
    drawn
}

/// The CPU time in seconds of each thread of this process.
fn tasks() -> BTreeMap<u32, f64> {
    let folder = std::fs::read_dir("/proc/self/task").expect("this is Linux");
    let task = |entry: std::fs::DirEntry| {
        // Threads may end meanwhile.
        let text = std::fs::read_to_string(entry.path().join("schedstat")).ok()?;
        let nanos: f64 = text.split_whitespace().next()?.parse().ok()?;
        Some((entry.file_name().to_str()?.parse().ok()?, nanos / 1e9))
    };
    folder.filter_map(|entry| task(entry.ok()?)).collect()
}
