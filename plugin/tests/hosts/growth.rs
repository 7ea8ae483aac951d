//! Creates and destroys hundreds of instances, and checks that no memory, file or thread is left.

use crate::host::{Address, Instance, Sent, open};
use crate::patches::{patches, state};
use crate::process::{command, succeeds};
use std::process::ExitCode;
use std::thread::sleep;
use std::time::Duration;

pub(crate) fn hundreds_of_instances_leave_nothing_behind() {
    succeeds(command("growth"));
}

pub(crate) fn the_library_can_be_opened_and_closed_again() {
    succeeds(command("reopen"));
}

/// Resources of this process: bytes and counts.
#[derive(Debug)]
struct Held {
    allocated: usize,
    resident: usize,
    files: usize,
    threads: usize,
}

impl Held {
    #[allow(unsafe_code)]
    fn now() -> Self {
        let statm = std::fs::read_to_string("/proc/self/statm").unwrap();
        let pages: usize = statm.split(' ').nth(1).unwrap().parse().unwrap();
        let count = |folder: &str| std::fs::read_dir(folder).unwrap().count();
        // SAFETY: the function has no conditions.
        let heap = unsafe { libc::mallinfo2() };
        Self {
            allocated: heap.uordblks + heap.hblkhd,
            resident: pages * 4096,
            files: count("/proc/self/fd"),
            threads: count("/proc/self/task"),
        }
    }
}

/// A whole life of an instance: loads a patch, plays a note, saves.
fn live(instance: Instance, state: &[u8]) {
    let mut instance = instance;
    assert!(instance.load(state));
    let mut player = instance.play(48_000.0, 64);
    player.render(&[Sent::On(Address::note(0, 60, 1), 0.5).at(0)], 128, || 64);
    let mut instance = player.stop();
    assert!(!instance.save().is_empty());
}

/// Runs in the processes that these tests start.
pub(crate) fn work(name: &str) -> ExitCode {
    let state = state(&patches()[2].1);
    if name == "reopen" {
        for _ in 0..50 {
            live(Instance::new(), &state);
        }
        return ExitCode::SUCCESS;
    }
    let entry = open();
    let cycles = |count: usize| (0..count).for_each(|_| live(Instance::of(&entry, true), &state));
    cycles(100);
    let before = Held::now();
    cycles(300);
    let mut after = Held::now();
    // On a busy machine, a thread that has been told to end may take its time.
    for _ in 0..1000 {
        if after.threads <= before.threads {
            break;
        }
        sleep(Duration::from_millis(10));
        after = Held::now();
    }
    println!("before: {before:?}, after: {after:?}");
    // Allocated bytes are exact: a hundred per instance would be 30,000. Pages change in larger steps.
    let grown = after.allocated > before.allocated + 30_000
        || after.resident > before.resident + 2_400_000
        || after.files > before.files
        || after.threads > before.threads;
    ExitCode::from(u8::from(grown))
}
