//! Golden audio: the engine's renders are, bit for bit, the ones that were last accepted.
//!
//! A case is one score played with one patch. Its digest is stored next to this file; a few cases also keep the
//! beginning of their audio. `cargo xtask bless [CASE]` accepts the present renders.

mod cases;
mod check;
mod perturbed;
mod score;
mod songs;

use check::{Store, bless, check};
use score::Score;
use std::collections::BTreeSet;
use std::sync::Mutex;

/// Environment variable that accepts the present render of the case with this name, or of `all`.
const BLESS: &str = "SPRUNG_BLESS";

/// Runs `job` for every case on all cores and returns the results in the order of the cases.
fn for_all<T: Send>(cases: &[Score], job: impl Fn(&Score) -> T + Sync) -> Vec<T> {
    let queue = Mutex::new(cases.iter().enumerate());
    let results = Mutex::new(Vec::new());
    let work = || {
        loop {
            let next = queue.lock().expect("no worker panics with the queue").next();
            let Some((index, case)) = next else { break };
            let result = job(case);
            results.lock().expect("no worker panics with the results").push((index, result));
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        (0..cores).for_each(|_| {
            scope.spawn(work);
        });
    });
    let mut results = results.into_inner().expect("the workers are done");
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[test]
fn every_case_sounds_as_accepted_in_blocks() {
    if let Ok(wanted) = std::env::var(BLESS) {
        panic!("{}", bless_cases(&Store::of_the_project(), &cases::all(), &wanted));
    }
    // Blocks of a few frames take most of the time.
    sound_as_accepted(|case| !songs::is_long(case), |case| vec![case.blocks[0].max(64)]);
}

#[test]
#[ignore = "takes minutes"]
fn every_case_sounds_as_accepted_at_every_block_size() {
    sound_as_accepted(|_| true, |case| [&[score::WHOLE], case.blocks].concat());
}

/// Checks that every kept file belongs to a case, and the cases that are wanted at the block sizes that are asked for.
fn sound_as_accepted(is_wanted: impl Fn(&Score) -> bool, sizes: impl Fn(&Score) -> Vec<usize> + Sync) {
    let (store, mut cases) = (Store::of_the_project(), cases::all());
    assert_eq!(names(&cases).len(), cases.len(), "two cases have the same name");
    let stale = store.stale(&names(&cases));
    assert!(stale.is_empty(), "no case has these files any more: {stale:?}; `cargo xtask bless` removes them");
    cases.retain(is_wanted);
    let failures: Vec<String> =
        for_all(&cases, |case| check(&store, case, &sizes(case))).into_iter().filter_map(Result::err).collect();
    let (failed, count) = (failures.len(), cases.len());
    assert!(failures.is_empty(), "{failed} of {count} golden cases failed\n\n{}\n", failures.join("\n\n"));
}

/// Accepts the present sound of the selected cases, and returns a message about it.
fn bless_cases(store: &Store, cases: &[Score], wanted: &str) -> String {
    if !cfg!(debug_assertions) {
        return "only the debug build, the reference, may bless: run without --release".to_owned();
    }
    let chosen: Vec<Score> = cases.iter().filter(|case| wanted == "all" || wanted == case.name).cloned().collect();
    if chosen.is_empty() {
        let names: Vec<_> = cases.iter().map(|case| case.name.as_str()).collect();
        return format!("there is no golden case ‘{wanted}’; there are: {}", names.join(", "));
    }
    if wanted == "all" {
        store.remove_stale(&names(cases));
    }
    for_all(&chosen, |case| bless(store, case));
    format!("blessed {} cases; run again to verify", chosen.len())
}

fn names(cases: &[Score]) -> BTreeSet<String> {
    cases.iter().map(|case| case.name.clone()).collect()
}
