//! `cargo xtask callgrind`: counts instructions of kernels and of silence with valgrind; compares with kept counts.
//!
//! The counts do not depend on how busy the machine is. Valgrind does not support AVX-512.

#[path = "../../../benches/struck/mod.rs"]
mod struck;

use crate::shell::root;
use sprung::dsp::MAX_MODES;
use sprung::engine::{Ensemble, Synth};
use sprung::internals::{CONTROL_FRAMES, Level};
use sprung::patch::Patch;
use std::fmt::Write as _;
use std::process::Command;
use struck::{StruckBank, Work};

/// The last accepted counts: instructions per mode and frame for each level and kind of work, and per silent block.
const KEPT: &str = "benches/instructions.txt";

/// The share by which a count may grow. The library is compiled as one unit here: where the compiler divides it into several, it
/// does so in another way after any change, and counts of work that did not change move by up to 13 %.
const ALLOWANCE: f64 = 0.05;

const LEVELS: [Level; 3] = [Level::Scalar, Level::Sse2, Level::Avx2];

/// Frames of a silent block.
const FRAMES: usize = 64;

/// Number of counted rounds, a multiple of the modulation's period. A tenth as many run before and are not counted.
const ROUNDS: usize = 210;

/// Work whose instructions are counted.
#[derive(Clone, Copy)]
enum Subject {
    Bank(Level, Work),
    IdleSynth,
    IdleEnsemble,
}

impl Subject {
    /// All work that this CPU can do.
    fn all() -> impl Iterator<Item = Subject> {
        let levels = LEVELS.into_iter().filter(|level| level.is_available());
        let banks = levels.flat_map(|level| Work::ALL.map(|work| Subject::Bank(level, work)));
        banks.chain([Subject::IdleSynth, Subject::IdleEnsemble])
    }

    /// Its name in [`KEPT`].
    fn name(self) -> String {
        match self {
            Subject::Bank(level, work) => format!("{} {}", level.name(), work.name()),
            Subject::IdleSynth => "silent synth".to_owned(),
            Subject::IdleEnsemble => "silent ensemble".to_owned(),
        }
    }

    /// Divisor of the instructions per round: modes × frames of a bank; 1 for a silent block.
    fn unit(self) -> usize {
        if matches!(self, Subject::Bank(..)) { MAX_MODES * CONTROL_FRAMES } else { 1 }
    }

    /// Does this many rounds of work: a control tick or a block each.
    fn work(self, rounds: usize) {
        let [mut left, mut right] = [[0.0; FRAMES]; 2];
        match self {
            Subject::Bank(level, work) => {
                level.force();
                let mut banks = StruckBank::many(MAX_MODES, work);
                (0..rounds).for_each(|_| banks.iter_mut().for_each(|bank| _ = std::hint::black_box(bank.tick())));
            }
            Subject::IdleSynth => {
                let mut synth = Synth::new(48_000.0, 1);
                (0..rounds).for_each(|_| synth.process(&[], &mut left, &mut right));
            }
            Subject::IdleEnsemble => {
                let mut ensemble = Ensemble::new(48_000.0, 1, &Patch::default(), &[]);
                (0..rounds).for_each(|_| ensemble.process(&[], &mut left, &mut right));
            }
        }
    }
}

/// Counts, and compares with the kept counts, or with `accept` keeps the new ones. The last lines are those of a test
/// harness, so that the suite reads them like any others.
pub(crate) fn run(accept: bool) -> Result<(), String> {
    let mut counts = String::new();
    for subject in Subject::all() {
        let name = subject.name();
        // The difference between two runs does not include the start-up.
        let (few, many) = (count(&name, ROUNDS / 10)?, count(&name, ROUNDS / 10 + ROUNDS)?);
        let _ = writeln!(counts, "{name} {:.3}", (many - few) / (ROUNDS * subject.unit()) as f64);
    }
    print!("{counts}");
    let found = parse(&counts);
    let path = root().join(KEPT);
    let at = |error| format!("{}: {error}", path.display());
    if accept {
        return std::fs::write(&path, counts).map_err(at);
    }
    let grown = grown(&parse(&std::fs::read_to_string(&path).map_err(at)?), &found);
    let missing: Vec<Level> = LEVELS.into_iter().filter(|level| !level.is_available()).collect();
    missing.iter().for_each(|level| println!("test level::{} ... ignored", level.name()));
    let (passed, failed, ignored) = (found.len() - grown.len(), grown.len(), missing.len());
    let verdict = if grown.is_empty() { "ok" } else { "FAILED" };
    println!("test result: {verdict}. {passed} passed; {failed} failed; {ignored} ignored");
    if grown.is_empty() {
        return Ok(());
    }
    Err(format!("{}\naccept with: cargo xtask callgrind --accept", grown.join("\n")))
}

/// A line for each count that has grown by more than the allowance, or that has no kept count.
fn grown(kept: &[(String, f64)], found: &[(String, f64)]) -> Vec<String> {
    let line = |(name, now): &(String, f64)| {
        let before = kept.iter().find(|(kept, _)| kept == name).map(|(_, count)| *count);
        let fine = before.is_some_and(|before| *now <= before * (1.0 + ALLOWANCE));
        let before = before.map_or("none".to_owned(), |before| before.to_string());
        (!fine).then(|| format!("{name}: {now} instructions, {before} kept"))
    };
    found.iter().filter_map(line).collect()
}

fn parse(counts: &str) -> Vec<(String, f64)> {
    let line = |line: &str| {
        let (name, count) = line.rsplit_once(' ')?;
        Some((name.to_owned(), count.parse().ok()?))
    };
    counts.lines().filter_map(line).collect()
}

/// Instructions of a whole process that runs [`work`].
fn count(name: &str, rounds: usize) -> Result<f64, String> {
    let program = std::env::current_exe().map_err(|error| format!("this program: {error}"))?;
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program);
    command.args(["callgrind-work", name, &rounds.to_string()]);
    let output = command.output().map_err(|error| format!("valgrind: {error}; is it installed?"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    let collected = text.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    collected.filter(|_| output.status.success()).ok_or_else(|| format!("valgrind counted nothing:\n{text}"))
}

/// Runs the work that is counted.
pub(crate) fn work(name: &str, rounds: usize) -> Result<(), String> {
    let subject = Subject::all().find(|subject| subject.name() == name);
    subject.ok_or_else(|| format!("there is no ‘{name}’ to count on this CPU"))?.work(rounds);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_growth_beyond_the_allowance_is_told() {
        let kept = parse("avx2 ringing 1.0\nsilent synth 1000");
        assert_eq!(kept[1], ("silent synth".to_owned(), 1000.0));
        for (found, lines) in [
            ("avx2 ringing 1.04\nsilent synth 400", 0),
            ("avx2 ringing 1.06\nsilent synth 1051", 2),
            ("avx2 driven 0.1", 1),
        ] {
            assert_eq!(grown(&kept, &parse(found)).len(), lines, "{found}");
        }
    }
}
