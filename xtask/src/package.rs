//! Builds the Python package, and runs its tests in the virtual environment under the target directory.

use crate::count::Count;
use crate::python;
use crate::shell::{cargo, root, run_and_read, run_to_end};
use crate::steps::TESTED;
use crate::system::System;
use std::process::Command;

/// Builds the package into its folder and runs its tests, with a command that is built from the same sources. The check of types
/// counts as one.
pub(crate) fn test() -> Result<Count, String> {
    let python = python::of(&root().join("target/python"), "python");
    let folder = root().join("src/python");
    // With the features that the tests of the other packages have, and those of what they alone need, so that nothing is compiled
    // again.
    run_to_end(&mut cargo(&format!("build {TESTED}")), "the package does not build")?;
    let system = System::own();
    // As Python calls modules in a library of the system's.
    let module = folder.join("sprung").join(if cfg!(windows) { "_sprung.pyd" } else { "_sprung.abi3.so" });
    let library = root().join("target/debug").join(system.library("_sprung"));
    std::fs::copy(&library, &module).map_err(|error| format!("{}: {error}", library.display()))?;

    let run = |arguments: &[&str]| {
        let mut command = Command::new(&python);
        command.args(arguments).current_dir(&folder);
        command
            .env("PYTHONPATH", &folder)
            .env("SPRUNG_COMMAND", root().join("target/debug").join(system.program("sprung")));
        run_and_read(command)
    };
    let (typed, _) = run(&["-m", "mypy"])?;
    let (succeeded, lines) = run(&["-m", "pytest", "-q", "-p", "no:cacheprovider"])?;
    let (passed, failed) = lines.last().map_or((0, 0), |line| counts(line));
    let failed = failed + usize::from(!succeeded && failed == 0) + usize::from(!typed);
    Ok(Count { passed: passed + usize::from(typed), failed, skipped: 0 })
}

/// The tests that passed, and those that failed or could not start, in the last line of pytest.
fn counts(line: &str) -> (usize, usize) {
    let words: Vec<&str> = line.split([' ', ',', '=']).filter(|word| !word.is_empty()).collect();
    let number = |what: &[&str]| -> usize {
        let pairs = words.windows(2).filter(|pair| what.contains(&pair[1]));
        pairs.filter_map(|pair| pair[0].parse::<usize>().ok()).sum()
    };
    (number(&["passed"]), number(&["failed", "error", "errors"]))
}

#[cfg(test)]
mod tests {
    use super::counts;

    #[test]
    fn results_of_pytest_are_read() {
        for (line, expected) in [
            ("22 passed in 8.31s", (22, 0)),
            ("==== 2 failed, 20 passed, 1 error in 1.2s ====", (20, 3)),
            ("no tests ran in 0.01s", (0, 0)),
        ] {
            assert_eq!(counts(line), expected);
        }
    }
}
