//! `cargo xtask test`: runs a suite, step by step, and counts what was really run.

use crate::count::{Count, Shows};
use crate::shell::{cargo, root, run_and_read, succeeds};
use crate::steps::{CHECKED, CHECKS, ELSEWHERE, EXAMPLES, LONG, Step, Suite, TESTED};
use crate::system::{Profile, System};
use crate::wine::{self, Prefix};
use crate::{bundle, package, patch, setup};
use std::process::Command;
use std::time::{Duration, Instant};

/// A line of the summary.
struct Outcome {
    name: &'static str,
    count: Count,
    time: Duration,
}

/// Runs all steps whose name contains a text, even after failures, and prints a summary.
pub(crate) fn run(suite: Suite, only: &str) -> Result<(), String> {
    // What needs it finds it, also if nothing else is asked for.
    let wrapper = timed("plugin's wrapper", &|| patch::run().map(|()| Count::ONE));
    let mut outcomes = vec![];
    let mut run = |name: &'static str, work: &dyn Fn() -> Result<Count, String>| {
        if name.contains(only) {
            outcomes.push(timed(name, work));
        }
    };
    run("setup", &|| setup::run(suite).map(|()| Count::ONE));
    CHECKS.iter().for_each(|step| run(step.name, &|| step.run()));
    run("tests", &|| tests(suite));
    run(EXAMPLES.name, &|| EXAMPLES.run());
    run("Python package", &package::test);
    if suite == Suite::All {
        LONG.iter().for_each(|step| run(step.name, &|| step.run()));
        run("Windows, by Wine", &windows);
        run("other systems' types", &types);
    }
    if outcomes.is_empty() {
        return Err(format!("no step of this suite contains ‘{only}’ in its name"));
    }

    println!("\n{:<24} {:<8} {:>9}  ran", "step", "result", "time");
    let mut total = Count::default();
    for Outcome { name, count, time } in std::iter::once(wrapper).chain(outcomes) {
        let result = if count.failed == 0 { "ok" } else { "FAILED" };
        println!("{name:<24} {result:<8} {:>7.1} s  {count}", time.as_secs_f64());
        total.add(count);
    }
    println!("\n{total}");
    if total.failed == 0 { Ok(()) } else { Err("the suite failed".to_owned()) }
}

/// Runs the tests of all packages, the plugin as bundled in real hosts among them. A commit's run with the harness, so that those of
/// a program share the bank and the fonts. All tests run with nextest where it is installed, since it alone can keep those that
/// watch a screen from running beside others.
fn tests(suite: Suite) -> Result<Count, String> {
    if !cfg!(target_os = "linux") {
        let mut total = count(cargo(ELSEWHERE[0]), Shows::Tests)?;
        let mut hosts = cargo(ELSEWHERE[1]);
        hosts.env("SPRUNG_BUNDLES", bundle::run(&System::own(), Profile::Debug)?);
        total.add(count(hosts, Shows::Tests)?);
        return Ok(total);
    }
    let folder =
        if suite == Suite::All { bundle::run(&System::own(), Profile::Release) } else { bundle::of_the_tests() }?;
    let harness = format!("test {TESTED} --no-fail-fast -- --quiet");
    let mut command = match suite {
        Suite::Commit => cargo(&harness),
        Suite::All if succeeds("cargo", &["nextest", "--version"]) => {
            // One more than cores, because some wait for files, devices and other programs.
            let threads = std::thread::available_parallelism().map_or(1, usize::from) + 1;
            let shown = "--status-level slow --run-ignored all";
            cargo(&format!("nextest run {TESTED} --no-fail-fast --test-threads {threads} {shown}"))
        }
        Suite::All => cargo(&format!("{harness} --include-ignored")),
    };
    command.env("SPRUNG_BUNDLES", folder);
    count(command, Shows::Tests)
}

/// Builds the command and the plugin for Windows, and runs the golden tests, those of the command and those of the plugin in hosts
/// and in its window.
fn windows() -> Result<Count, String> {
    let wine = Prefix::of_tests()?;
    let mut total = Count::default();
    for tests in ELSEWHERE {
        let mut command = cargo(tests);
        command.args(["--target", wine::TARGET]);
        wine.lend_to_cargo(&mut command);
        total.add(count(command, Shows::Tests)?);
    }
    total.add(count(Command::new(root().join("plugin/tests/windows.sh")), Shows::OneCheck)?);
    Ok(total)
}

/// Checks the types of all parts for systems on which nothing can be run here.
fn types() -> Result<Count, String> {
    let mut total = Count::default();
    for system in CHECKED {
        let mut command = cargo("check --workspace --all-features");
        command.args(["--target", system]);
        total.add(count(command, Shows::OneCheck)?);
    }
    Ok(total)
}

fn count(command: Command, shows: Shows) -> Result<Count, String> {
    run_and_read(command).map(|(succeeded, lines)| shows.judge(succeeded, &lines))
}

/// Runs a step; an error is printed, and counts as a failure.
fn timed(name: &'static str, work: &dyn Fn() -> Result<Count, String>) -> Outcome {
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
