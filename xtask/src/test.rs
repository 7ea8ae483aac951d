//! `cargo xtask test`: runs a suite, step by step, and counts what was really run.

use crate::shell::{cargo, has_standard_library, run_and_read};
use crate::steps::{CHECKS, EXAMPLES, LONG, Shows, Step};
use crate::{bundle, package, patch, setup};
use std::fmt;
use std::process::Command;
use std::time::{Duration, Instant};

/// What is run.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Suite {
    /// What protects every commit, in minutes and however busy the machine is.
    Commit,
    /// Everything, also what takes long or waits for time to pass.
    All,
}

/// How many checks ran, and with which results. Skipped are tests that are left to the longer suite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Count {
    pub(crate) passed: usize,
    pub(crate) failed: usize,
    pub(crate) skipped: usize,
}

impl Count {
    const ONE: Count = Count { passed: 1, failed: 0, skipped: 0 };
    const FAILED: Count = Count { passed: 0, failed: 1, skipped: 0 };

    fn add(&mut self, other: Count) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed, {} skipped", self.passed, self.failed, self.skipped)
    }
}

/// A line of the summary.
struct Outcome {
    name: &'static str,
    count: Count,
    time: Duration,
}

/// Runs all steps, even after failures, and prints a summary.
pub(crate) fn run(suite: Suite) -> Result<(), String> {
    let mut outcomes = vec![
        timed("setup", || setup::run(suite).map(|()| Count::ONE)),
        timed("plugin's wrapper", || patch::run().map(|_| Count::ONE)),
    ];
    outcomes.extend(CHECKS.iter().map(|step| timed(step.name, || step.run())));
    outcomes.push(timed("tests", || tests(suite)));
    outcomes.push(timed(EXAMPLES.name, || EXAMPLES.run()));
    outcomes.push(timed("plugin, as bundled", || plugin(suite)));
    outcomes.push(timed("Python package", package::test));
    if suite == Suite::All {
        outcomes.extend(LONG.iter().map(|step| timed(step.name, || step.run())));
        outcomes.push(timed("corrections for Windows", corrections_for_windows));
    }

    println!("\n{:<24} {:<8} {:>9}  ran", "step", "result", "time");
    let mut total = Count::default();
    for Outcome { name, count, time } in outcomes {
        let result = if count.failed == 0 { "ok" } else { "FAILED" };
        println!("{name:<24} {result:<8} {:>7.1} s  {count}", time.as_secs_f64());
        total.add(count);
    }
    println!("\n{total}");
    if total.failed == 0 { Ok(()) } else { Err("the suite failed".to_owned()) }
}

/// Runs the tests of all packages but the plugin: with nextest, which needs no program to end before the next begins, or with the
/// harness where it is missing.
fn tests(suite: Suite) -> Result<Count, String> {
    let has_nextest = crate::shell::succeeds("cargo", &["nextest", "--version"]);
    let command = match (has_nextest, suite) {
        (true, Suite::Commit) => "nextest run --workspace --all-features --no-fail-fast --status-level fail",
        (true, Suite::All) => {
            "nextest run --workspace --all-features --no-fail-fast --status-level slow --run-ignored all"
        }
        (false, Suite::Commit) => "test --workspace --all-features --no-fail-fast --lib --bins --tests",
        (false, Suite::All) => {
            "test --workspace --all-features --no-fail-fast --lib --bins --tests -- --include-ignored"
        }
    };
    count(cargo(command), Shows::Tests)
}

/// Runs the plugin's own tests and those of the program, and tests the bundles that musicians install in real hosts.
fn plugin(suite: Suite) -> Result<Count, String> {
    let folder = bundle::run(suite == Suite::All)?;
    let mut command = cargo("test --manifest-path plugin/Cargo.toml --features standalone --no-fail-fast");
    command.env("SPRUNG_BUNDLES", folder);
    if suite == Suite::All {
        command.args(["--", "--include-ignored"]);
    }
    count(command, Shows::Tests)
}

/// Compiles the packages with corrections that no other system compiles.
fn corrections_for_windows() -> Result<Count, String> {
    let target = setup::WINDOWS;
    if !has_standard_library(target, None) {
        return Err(format!("Rust’s standard library for {target} is missing: rustup target add {target}"));
    }
    let check = "check --manifest-path plugin/Cargo.toml --package baseview --package egui-baseview --target";
    let mut command = cargo(check);
    command.arg(target);
    count(command, Shows::OneCheck)
}

fn count(command: Command, shows: Shows) -> Result<Count, String> {
    run_and_read(command).map(|(succeeded, lines)| shows.judge(succeeded, &lines))
}

/// Runs a step; an error is printed, and counts as a failure.
fn timed(name: &'static str, work: impl FnOnce() -> Result<Count, String>) -> Outcome {
    println!("\n── {name}");
    let start = Instant::now();
    let count = work().unwrap_or_else(|message| {
        eprintln!("{message}");
        Count::FAILED
    });
    Outcome { name, count, time: start.elapsed() }
}

impl Step {
    fn run(&self) -> Result<Count, String> {
        let mut total = Count::default();
        for command in self.commands {
            let mut command = cargo(command);
            command.envs(self.environment.iter().copied());
            total.add(count(command, self.shows)?);
        }
        Ok(total)
    }
}

impl Shows {
    /// Counts what a command ran, from its output. One whose filter matched nothing, or that failed before it could count,
    /// counts as one failure.
    fn judge(self, succeeded: bool, lines: &[String]) -> Count {
        let mut count = match self {
            Shows::OneCheck => Count { passed: usize::from(succeeded), ..Count::default() },
            Shows::Benches => {
                Count { passed: lines.iter().filter(|line| line.trim() == "Success").count(), ..Count::default() }
            }
            Shows::Tests => count_tests(lines),
        };
        if count.failed == 0 && (!succeeded || count == Count::default()) {
            count.failed = 1;
        }
        count
    }
}

/// The sum over lines of the harness, `test result: ok. 3 passed; 0 failed; 1 ignored; …`, and of nextest,
/// `Summary [ 5.0s] 4 tests run: 3 passed (1 slow), 1 failed, 2 skipped`.
fn count_tests(lines: &[String]) -> Count {
    let mut count = Count::default();
    for line in lines {
        let harness = line.strip_prefix("test result: ");
        let nextest = line.trim_start().strip_prefix("Summary [").and_then(|line| line.split_once("run: "));
        let Some(results) = harness.or(nextest.map(|(_, results)| results)) else { continue };
        for (number, what) in results.split(['.', ';', ',', '(']).filter_map(|part| part.trim().split_once(' ')) {
            let Ok(number) = number.parse::<usize>() else { continue };
            match what {
                "passed" => count.passed += number,
                "failed" | "timed out" => count.failed += number,
                "ignored" | "skipped" => count.skipped += number,
                _ => {}
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn results_are_summed() {
        let output = lines(
            "running 4 tests\ntest a ... ok\ntest b ... ignored\n\
            test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 9 filtered out; finished in 0.00s\n\
            test result: FAILED. 2 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.50s",
        );
        assert_eq!(Shows::Tests.judge(false, &output), Count { passed: 5, failed: 1, skipped: 1 });
        let output =
            lines("     Summary [ 600.123s] 9 tests run: 6 passed (2 slow, 1 leaky), 2 failed, 1 timed out, 4 skipped");
        assert_eq!(Shows::Tests.judge(false, &output), Count { passed: 6, failed: 3, skipped: 4 });
    }

    #[test]
    fn a_step_that_ran_nothing_has_failed() {
        let nothing = lines("test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 5 filtered out");
        assert_eq!(Shows::Tests.judge(true, &nothing), Count::FAILED);
        assert_eq!(Shows::Benches.judge(true, &[]), Count::FAILED);
        assert_eq!(Shows::Tests.judge(false, &[]), Count::FAILED);
        assert_eq!(Shows::OneCheck.judge(false, &[]), Count::FAILED);
        assert_eq!(Shows::OneCheck.judge(true, &[]), Count::ONE);
    }

    #[test]
    fn benches_are_counted() {
        let output = lines("Testing oscillator\nSuccess\n\nTesting bank\nSuccess");
        assert_eq!(Shows::Benches.judge(true, &output).passed, 2);
    }
}
