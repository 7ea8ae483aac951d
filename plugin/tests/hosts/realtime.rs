//! Watches the audio thread: no allocation, lock or system call in `process`, whatever the other threads do.
//!
//! `probe.c` is preloaded into a separate process. On the watched thread it counts allocations and locks of the
//! system's library, and the kernel refuses every system call. (A lock made of atomic operations also needs a system
//! call to wait.)

use crate::controllers::bind;
use crate::host::{Address, Instance, Player, Sent, open};
use crate::patches::{drums, patches, state, state_of_kit};
use crate::process::{command, scratch, succeeds, wait_until};
use crate::screen::Screen;
use crate::window::{Editor, Parent};
use clack_host::events::event_types::NoteExpressionType as Kind;
use clack_host::prelude::*;
use sprung::internals::random::{key, uniform};
use std::ffi::CStr;
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// Minimum number of blocks played while the other threads work: each of the different ones twice; beside the window, ten times.
const BLOCKS: u32 = 200;
const BLOCKS_BESIDE_WINDOW: u32 = 1_000;

/// Minimum number of rounds of the main thread, which loads a state in every tenth: each of them twice.
const ROUNDS: usize = 140;

pub(crate) fn process_neither_allocates_nor_locks_nor_calls_the_system() {
    succeeds(watched("watch"));
}

pub(crate) fn nor_does_the_effect() {
    succeeds(watched("watch-effect"));
}

pub(crate) fn nor_does_it_with_the_window_open() {
    let screen = Screen::new();
    let mut command = watched("watch-window");
    command.env("DISPLAY", &screen.display);
    succeeds(command);
}

/// The probe must notice what it is meant to notice.
pub(crate) fn the_watch_bites() {
    for (sin, seen) in [("sin-malloc", "malloc"), ("sin-lock", "pthread_mutex_lock"), ("sin-call", "a system call")] {
        let output = watched(sin).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && stderr.contains(&format!("the first is {seen}")), "{sin}: {stderr}");
    }
}

/// This program with the probe preloaded, for a piece of work, which has its own folder: tests run at the same time.
fn watched(work: &str) -> Command {
    let folder = scratch(work);
    std::fs::create_dir_all(&folder).unwrap();
    let probe = folder.join("probe.so");
    let mut cc = Command::new("cc");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/probe.c");
    cc.args(["-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-O1", "-o"]).arg(&probe).arg(source);
    succeeds(cc);
    let mut command = command(work);
    command.env("LD_PRELOAD", probe);
    // One of the controllers that are played.
    bind(&mut command, &folder, "tilt = 7\n");
    command
}

/// Finds a function of the probe.
#[allow(unsafe_code)]
fn probe(name: &CStr) -> extern "C" fn() -> i32 {
    // SAFETY: the probe is preloaded; its functions have this signature.
    unsafe {
        let function = libc::dlsym(libc::RTLD_DEFAULT, name.as_ptr());
        assert!(!function.is_null(), "{name:?}: the probe is not preloaded");
        std::mem::transmute(function)
    }
}

/// Runs in the processes that are started with the probe.
pub(crate) fn work(name: &str) -> ExitCode {
    match name {
        "watch" => play_under_watch(Instance::new(), None),
        "watch-effect" => play_under_watch(Instance::resonator(&open()), None),
        "watch-window" => play_under_watch(Instance::new(), Some(Parent::new())),
        sin => commit(sin),
    }
}

/// Plays on a watched thread, while this thread does what main threads do.
fn play_under_watch(mut instance: Instance, parent: Option<Parent>) -> ExitCode {
    let is_effect = instance.parameters()[0].name == "Chord";
    let blocks = storm(&mut instance);
    let least = if parent.is_some() { BLOCKS_BESIDE_WINDOW } else { BLOCKS };
    let mut states: Vec<Vec<u8>> = patches().iter().map(|(_, patch)| state(patch)).collect();
    states.insert(1, state_of_kit(&drums()));
    let Player { mut instance, mut audio } = instance.play(48_000.0, 64);
    if is_effect {
        audio.feed_noise();
    }
    let editor = parent.as_ref().map(|parent| Editor::open(&mut instance, parent));
    let (stop, played, loudest) = (AtomicBool::new(false), AtomicU32::new(0), AtomicU32::new(0));
    let watch = probe(c"sprung_watch");
    std::thread::scope(|scope| {
        scope.spawn(|| {
            // One block without the watch, because a thread's first block may do work that `process` does not cause.
            audio.process(&EventBuffer::new(), 64);
            assert_eq!(watch(), 0, "the kernel cannot refuse system calls");
            while !stop.load(Ordering::Relaxed) {
                let n = played.load(Ordering::Relaxed);
                audio.process(&blocks[n as usize % blocks.len()], 64);
                let peak = audio.outputs()[0].iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
                loudest.fetch_max(peak.to_bits(), Ordering::Relaxed);
                played.store(n + 1, Ordering::Relaxed);
            }
            loop {
                std::hint::spin_loop();
            }
        });
        let start = Instant::now();
        let mut round = 0;
        while played.load(Ordering::Relaxed) < least || round < ROUNDS {
            if seen() || start.elapsed() > Duration::from_secs(300) {
                break;
            }
            instance.run_callbacks();
            if round % 10 == 0 {
                instance.load(&states[round / 10 % states.len()]);
                instance.save();
            }
            if let Some(editor) = &editor {
                editor.touch(round);
            }
            round += 1;
            std::thread::sleep(Duration::from_millis(3));
        }
        let played = played.load(Ordering::Relaxed);
        let peak = f32::from_bits(loudest.load(Ordering::Relaxed));
        eprintln!("{played} blocks, {round} rounds of the main thread, a peak of {peak}");
        // The watched thread cannot even end normally, so the whole process exits.
        std::process::exit(i32::from(seen() || played < least || round < ROUNDS || peak < 1e-3));
    })
}

fn seen() -> bool {
    static REPORTED: AtomicBool = AtomicBool::new(false);
    let seen = !REPORTED.load(Ordering::Relaxed) && probe(c"sprung_watch_offences")() > 0;
    REPORTED.fetch_or(seen, Ordering::Relaxed);
    REPORTED.load(Ordering::Relaxed)
}

/// Blocks with every kind of event: stealing, re-striking, expressions, automation, modulation, MIDI, tempo.
fn storm(instance: &mut Instance) -> Vec<EventBuffer> {
    let parameters = instance.parameters();
    let stream = key(1, 1);
    let mut n = 0;
    let mut unit = || {
        n += 1;
        f64::from(uniform(stream, n) + 1.0) / 2.0
    };
    (0..97_i32)
        .map(|block| {
            let mut buffer = EventBuffer::new();
            for time in 0..16 {
                let id = block * 16 + time;
                let note = Address::note((id % 16) as i16, 30 + (id % 60) as i16, id);
                let parameter = &parameters[id as usize % parameters.len()];
                let value = (unit() * parameter.max).round().max(unit().min(parameter.max));
                let sent = [
                    Sent::On(note, unit()),
                    Sent::Value(parameter.id, value.min(parameter.max)),
                    Sent::Off(Address::note(note.channel, note.key, id - 3), 0.5),
                    Sent::Modulate(parameter.id, Address::id(id - 2), unit() - 0.5),
                    Sent::Express(note, [Kind::Tuning, Kind::Pan, Kind::Pressure, Kind::Volume][id as usize % 4], 0.3),
                    Sent::Modulate(parameter.id, Address::id(-1), (unit() - 0.5) * 0.2),
                    Sent::Modulate(parameter.id, Address::key((id % 17) as i16 - 1, note.key), unit() - 0.5),
                    Sent::Midi([0xE0 | (id % 16) as u8, 0, (unit() * 127.0) as u8]),
                    Sent::Midi([0xB0 | (id % 16) as u8, [1, 7, 64, 66, 74, 121, 123][id as usize % 7], 100]),
                    Sent::Choke(Address::id(id - 5)),
                    Sent::Tempo(60.0 + 100.0 * unit()),
                ];
                for kind in sent.iter().skip((id % 2) as usize).step_by(1 + (id % 3) as usize) {
                    kind.push(time as u32 * 4, &mut buffer);
                }
            }
            buffer
        })
        .collect()
}

/// Does something on a watched thread that the audio thread must not do.
fn commit(sin: &str) -> ExitCode {
    let lock = std::sync::atomic::AtomicPtr::new(std::ptr::null_mut::<libc::pthread_mutex_t>());
    lock.store(Box::into_raw(Box::new(libc::PTHREAD_MUTEX_INITIALIZER)), Ordering::Relaxed);
    let watch = probe(c"sprung_watch");
    std::thread::scope(|scope| {
        scope.spawn(|| {
            assert_eq!(watch(), 0, "the kernel cannot refuse system calls");
            match sin {
                "sin-malloc" => drop(std::hint::black_box(Vec::<u8>::with_capacity(100))),
                "sin-lock" => lock_and_keep(lock.load(Ordering::Relaxed)),
                _ => std::thread::yield_now(),
            }
            loop {
                std::hint::spin_loop();
            }
        });
        wait_until("an offence", seen);
        std::process::exit(1)
    })
}

#[allow(unsafe_code)]
fn lock_and_keep(lock: *mut libc::pthread_mutex_t) {
    // SAFETY: the lock was created for this and is never freed.
    unsafe { libc::pthread_mutex_lock(lock) };
}
