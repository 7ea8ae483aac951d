//! No events during a note can make it explode.
//!
//! Every sample stays within the sum over all strikes (`bound`), for all events (`case`): random ones (`chance`), those
//! in the fuzzer's kept corpus, and the cases that once exploded (`known`).
//!
//! A failing case is made smaller (`shrink`) and printed as bytes, which can be kept in `fuzz/corpus/events`.
//! `SPRUNG_STORM_CASES` sets the number of many random cases.

mod bound;
mod case;
mod chance;
mod check;
mod gains;
mod heard_by;
mod known;
mod noise;
mod reach;
mod shrink;

use case::{PARAM_IDS, decode};
use sprung::params::PARAMS;
use std::fmt::Write;
use std::panic::catch_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Numbers of random cases, always the same ones.
const FEW: u64 = 500;
const MANY: u64 = 100_000;
const SEED: u64 = 10;
/// Maximum number of failing cases that are made smaller and printed.
const SHOWN: usize = 5;

/// The share of its bound that a case reaches, or the error. A panic counts as an error.
fn try_bytes(bytes: &[u8]) -> Result<Option<f64>, String> {
    let failure = |panic: Box<dyn std::any::Any + Send>| {
        let message = panic.downcast_ref::<String>().cloned();
        message.or_else(|| panic.downcast_ref().map(|text: &&str| (*text).to_owned())).unwrap_or_default()
    };
    catch_unwind(|| check::check(&decode(bytes))).unwrap_or_else(|panic| Err(format!("panic: {}", failure(panic))))
}

/// Describes a failing case, made smaller: readable text, and the bytes of a corpus file.
fn describe(bytes: &[u8]) -> String {
    let bytes = shrink::shrink(bytes.to_vec(), |bytes| try_bytes(bytes).is_err());
    let (case, hex) = (decode(&bytes), bytes.iter().fold(String::new(), |hex, byte| format!("{hex}{byte:02x}")));
    let mut text = format!("{}\n", try_bytes(&bytes).unwrap_err());
    let _ = writeln!(text, "  keep it: echo {hex} | xxd -r -p > fuzz/corpus/events/NAME");
    let place = match (case.ensemble, case.outputs) {
        (true, _) => "an ensemble",
        (_, true) => "a synth with many outputs",
        _ => "a synth",
    };
    let _ = writeln!(text, "  {place} at {} Hz, {} frames in blocks of {}", case.sample_rate, case.frames, case.block);
    for info in PARAMS.iter().filter(|info| case.patch.get(info.param) != info.default) {
        let _ = write!(text, "  {} = {}", info.id, info.format(case.patch.get(info.param)));
    }
    let _ =
        writeln!(text, "\n  {} modes, first {:?}", case.patch.modes.as_slice().len(), case.patch.modes.as_slice()[0]);
    for event in case.events.iter().take(12) {
        let _ = writeln!(text, "  {event:?}");
    }
    text
}

#[test]
fn no_storm_exceeds_what_its_strikes_bring() {
    storms(FEW);
}

#[test]
#[ignore = "takes minutes"]
fn no_storm_of_many_exceeds_what_its_strikes_bring() {
    storms(std::env::var("SPRUNG_STORM_CASES").map_or(MANY, |cases| cases.parse().expect("a number of cases")));
}

fn storms(cases: u64) {
    let (next, failed, reached) = (AtomicU64::new(0), Mutex::new(vec![]), Mutex::new(vec![]));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let serial = next.fetch_add(1, Ordering::Relaxed);
                    if serial >= cases {
                        return;
                    }
                    match try_bytes(&chance::case(SEED, serial)) {
                        Ok(share) => reached.lock().unwrap().extend(share),
                        Err(_) => failed.lock().unwrap().push(serial),
                    }
                }
            });
        }
    });
    let (mut failed, mut reached) = (failed.into_inner().unwrap(), reached.into_inner().unwrap());
    failed.sort_unstable();
    reached.sort_by(f64::total_cmp);
    let share = |part: f64| reached.get((reached.len() as f64 * part) as usize).copied().unwrap_or(0.0);
    println!(
        "{cases} cases; they reach of their bound: at most {:.6}, one in ten {:.3}, half {:.3}",
        reached.last().copied().unwrap_or(0.0),
        share(0.9),
        share(0.5)
    );
    let shown: Vec<String> = failed.iter().take(SHOWN).map(|serial| describe(&chance::case(SEED, *serial))).collect();
    assert!(failed.is_empty(), "{} of {cases} cases fail, the first:\n{}", failed.len(), shown.join("\n"));
    // The bound adds up the peaks of all modes of all strikes, at the largest gain of the case. A single mode comes near it, many modes
    // and strikes do not: half of the cases reach 0.004 of it, one in ten 0.12.
    assert!(share(0.5) > 0.003 && share(0.9) > 0.1, "something sounded");
}

/// The fuzzer's kept cases. Each reached new code when it was kept.
#[test]
fn kept_cases_stay_within_what_their_strikes_bring() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus/events");
    let mut replayed = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        if let Err(failure) = try_bytes(&bytes) {
            panic!("{}: {failure}\n{}", path.display(), describe(&bytes));
        }
        replayed += 1;
    }
    assert!(replayed > 10, "{folder} has the kept cases");
}

#[test]
fn every_parameter_can_move() {
    // The bound covers voices only; `behind_voices` and `space` test the effects behind them.
    let known: Vec<&str> = PARAM_IDS.split_whitespace().chain(["limiter"]).collect();
    let voices = PARAMS.iter().filter(|info| !info.param.is_behind_voices());
    let missing: Vec<&str> = voices.map(|info| info.id).filter(|id| !known.contains(id)).collect();
    assert!(missing.is_empty(), "add to the end of PARAM_IDS: {missing:?}");
}
