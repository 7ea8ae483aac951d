//! `cargo xtask test`: runs the whole suite, step by step, and counts what was really run.

use crate::package::Tested;
use crate::shell::{cargo, has_standard_library, run_and_read};
use crate::steps::{STEPS, Shows, Step};
use crate::{bundle, package, patch, setup, skipped};
use std::fmt;
use std::process::Command;
use std::time::{Duration, Instant};

/// How many checks ran, and with which results.
#[derive(Clone, Debug, Default, PartialEq)]
struct Count {
    passed: usize,
    failed: usize,
    /// The names of skipped tests.
    skipped: Vec<String>,
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed, {} skipped", self.passed, self.failed, self.skipped.len())
    }
}

/// A line of the summary.
struct Outcome {
    name: &'static str,
    count: Count,
    remark: &'static str,
    time: Duration,
}

/// Runs all steps, even after failures, and prints a summary. If `strict`, tests skipped without an excuse are
/// failures.
pub(crate) fn run(strict: bool) -> Result<(), String> {
    let mut outcomes = vec![timed("setup", || match setup::run() {
        Ok(()) => (Count { passed: 1, ..Count::default() }, ""),
        Err(message) => failed(&message),
    })];
    outcomes.push(timed("plugin's wrapper", || match patch::run() {
        Ok(_) => (Count { passed: 1, ..Count::default() }, ""),
        Err(message) => failed(&message),
    }));
    outcomes.extend(STEPS.iter().map(|step| timed(step.name, || step.run())));
    outcomes.push(timed(WINDOWS_STEP, corrections_for_windows));
    outcomes.push(timed("plugin, as bundled", plugin));
    outcomes.push(timed("Python package", python_package));

    println!("\n{:<24} {:<8} {:>9}  ran", "step", "result", "time");
    let mut total = Count::default();
    for Outcome { name, count, remark, time } in outcomes {
        let result = if count.is_good(strict) { "ok" } else { "FAILED" };
        println!("{name:<24} {result:<8} {:>7.1} s  {count}{remark}", time.as_secs_f64());
        total.passed += count.passed;
        total.failed += count.failed;
        total.skipped.extend(count.skipped);
    }
    let (lines, without_excuse) = skipped::report(&total.skipped);
    print!("\n{lines}{total}");
    println!("{}", if strict { ", strict" } else { "" });
    match (total.failed, total.is_good(strict)) {
        (0, true) => Ok(()),
        (0, false) => Err(format!("the suite failed: it is strict, and {without_excuse} tests were skipped")),
        _ => Err("the suite failed".to_owned()),
    }
}

impl Count {
    /// Whether nothing failed and, if `strict`, nothing was skipped without an excuse.
    fn is_good(&self, strict: bool) -> bool {
        self.failed == 0 && (!strict || skipped::report(&self.skipped).1 == 0)
    }
}

/// Runs the plugin's own tests and those of the program, and tests the bundles that musicians install in real hosts.
fn plugin() -> (Count, &'static str) {
    match bundle::run(false) {
        Ok(folder) => {
            let mut command = cargo("test --manifest-path plugin/Cargo.toml --features standalone --no-fail-fast");
            command.env("SPRUNG_BUNDLES", folder);
            run_command(command, Shows::Tests)
        }
        Err(message) => failed(&message),
    }
}

/// The step that compiles the corrections for Windows.
const WINDOWS_STEP: &str = "corrections for Windows";

/// Compiles the packages with corrections that no other system compiles.
fn corrections_for_windows() -> (Count, &'static str) {
    let target = setup::WINDOWS;
    if !has_standard_library(target, None) {
        let skipped = vec![WINDOWS_STEP.to_owned()];
        return (Count { skipped, ..Count::default() }, " (no standard library for it)");
    }
    let check = "check --manifest-path plugin/Cargo.toml --package baseview --package egui-baseview --target";
    let mut command = cargo(check);
    command.arg(target);
    run_command(command, Shows::OneCheck)
}

/// Runs the tests of the Python package.
fn python_package() -> (Count, &'static str) {
    match package::test() {
        Ok(Tested::Ran { passed, failed }) => (Count { passed, failed, skipped: Vec::new() }, ""),
        Ok(Tested::Skipped) => {
            (Count { skipped: vec!["Python package".to_owned()], ..Count::default() }, " (no pytest)")
        }
        Err(message) => failed(&message),
    }
}

fn failed(message: &str) -> (Count, &'static str) {
    eprintln!("{message}");
    (Count { failed: 1, ..Count::default() }, "")
}

fn run_command(command: Command, shows: Shows) -> (Count, &'static str) {
    match run_and_read(command) {
        Ok((succeeded, lines)) => shows.judge(succeeded, &lines),
        Err(message) => {
            eprintln!("{message}");
            (Count { failed: 1, ..Count::default() }, " (did not start)")
        }
    }
}

fn timed(name: &'static str, work: impl FnOnce() -> (Count, &'static str)) -> Outcome {
    println!("\n── {name}");
    let start = Instant::now();
    let (count, remark) = work();
    Outcome { name, count, remark, time: start.elapsed() }
}

impl Step {
    fn run(&self) -> (Count, &'static str) {
        let mut command = cargo(self.arguments);
        command.envs(self.environment.iter().copied());
        run_command(command, self.shows)
    }
}

impl Shows {
    /// Counts what a step ran, from its output. A step whose filter matched nothing, or that failed before it could
    /// count, counts as one failure.
    fn judge(self, succeeded: bool, lines: &[String]) -> (Count, &'static str) {
        let mut count = match self {
            Shows::OneCheck => Count { passed: usize::from(succeeded), ..Count::default() },
            Shows::Benches => {
                Count { passed: lines.iter().filter(|line| line.trim() == "Success").count(), ..Count::default() }
            }
            Shows::Tests => count_tests(lines),
        };
        let mut remark = "";
        if count.passed + count.failed + count.skipped.len() == 0 && succeeded {
            remark = " (nothing ran)";
            count.failed = 1;
        } else if !succeeded && count.failed == 0 {
            if self != Shows::OneCheck {
                remark = " (broke off)";
            }
            count.failed = 1;
        }
        (count, remark)
    }
}

/// The sum over the harness's lines of the form `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
fn count_tests(lines: &[String]) -> Count {
    let (mut count, mut ignored) = (Count::default(), 0);
    for result in lines.iter().filter_map(|line| line.strip_prefix("test result: ")) {
        let numbers = result.split(['.', ';']).filter_map(|part| part.trim().split_once(' '));
        for (number, what) in numbers {
            let Ok(number) = number.parse::<usize>() else { continue };
            match what {
                "passed" => count.passed += number,
                "failed" => count.failed += number,
                "ignored" => ignored += number,
                _ => {}
            }
        }
    }
    count.skipped = skipped::names(lines, ignored);
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
        assert_eq!(
            Shows::Tests.judge(false, &output),
            (Count { passed: 5, failed: 1, skipped: vec!["b".to_owned()] }, "")
        );
    }

    #[test]
    fn a_skipped_test_is_a_failure_where_it_is_strict() {
        let skipping = |name: &str| Count { passed: 3, failed: 0, skipped: vec![name.to_owned()] };
        for (count, lenient, strict) in [
            (skipping("level::neon"), true, true),
            (skipping("jack::live_notes_are_in_time_and_in_tune"), true, false),
            (Count { failed: 1, ..Count::default() }, false, false),
            (Count::default(), true, true),
        ] {
            assert_eq!((count.is_good(false), count.is_good(true)), (lenient, strict), "{count:?}");
        }
    }

    #[test]
    fn a_step_that_ran_nothing_has_failed() {
        let nothing = lines("test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 5 filtered out");
        let failed_once = Count { failed: 1, ..Count::default() };
        assert_eq!(Shows::Tests.judge(true, &nothing), (failed_once.clone(), " (nothing ran)"));
        assert_eq!(Shows::Benches.judge(true, &[]), (failed_once.clone(), " (nothing ran)"));
        assert_eq!(Shows::Tests.judge(false, &[]), (failed_once.clone(), " (broke off)"));
        assert_eq!(Shows::OneCheck.judge(false, &[]), (failed_once, ""));
        assert_eq!(Shows::OneCheck.judge(true, &[]).0.passed, 1);
    }

    #[test]
    fn benches_are_counted() {
        let output = lines("Testing oscillator\nSuccess\n\nTesting bank\nSuccess");
        assert_eq!(Shows::Benches.judge(true, &output).0.passed, 2);
    }
}
