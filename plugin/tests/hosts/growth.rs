//! A thousand instances come and go, and nothing is left of them.

use crate::host::{Address, Instance, Sent, open};
use crate::patches::{patches, state};
use crate::process::{command, succeeds};
use std::process::ExitCode;

pub(crate) fn a_thousand_instances_leave_nothing_behind() {
    succeeds(command("growth"));
}

pub(crate) fn the_library_can_be_opened_and_closed_again() {
    succeeds(command("reopen"));
}

/// What this process holds: resident memory in bytes, open files, threads.
fn held() -> (usize, usize, usize) {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap();
    let pages: usize = statm.split(' ').nth(1).unwrap().parse().unwrap();
    let count = |folder: &str| std::fs::read_dir(folder).unwrap().count();
    (pages * 4096, count("/proc/self/fd"), count("/proc/self/task"))
}

/// A whole life, with a patch loaded, saved, and a note played.
fn live(instance: Instance, state: &[u8]) {
    let mut instance = instance;
    assert!(instance.load(state));
    let mut player = instance.play(48_000.0, 64);
    player.render(&[Sent::On(Address::note(0, 60, 1), 0.5).at(0)], 128, || 64);
    let mut instance = player.stop();
    assert!(!instance.save().is_empty());
}

/// What the processes that these tests start do.
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
    cycles(200);
    let (memory, files, threads) = held();
    cycles(1_000);
    let (memory_after, files_after, threads_after) = held();
    println!("{memory} → {memory_after} bytes, {files} → {files_after} files, {threads} → {threads_after} threads");
    let grown = memory_after.saturating_sub(memory);
    // A thousand times a leak of one kilobyte would show.
    let kept = grown > 1_000_000 || files_after > files || threads_after > threads;
    ExitCode::from(u8::from(kept))
}
