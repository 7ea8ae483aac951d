//! Builds the Python package, and runs its tests in the virtual environment under the target directory.

use crate::shell::{cargo, root, run_and_read, succeeds};
use std::path::PathBuf;
use std::process::Command;

/// The environment's interpreter, if it has what the tests need.
fn python() -> Option<PathBuf> {
    let python = root().join("target/python/bin/python");
    let modules = "import mypy, numpy, pytest";
    succeeds(&python.to_string_lossy(), &["-c", modules]).then_some(python)
}

/// The result of the package's tests.
pub(crate) enum Tested {
    /// They cannot run here.
    Skipped,
    /// How many have passed and failed; the check of types counts as one.
    Ran { passed: usize, failed: usize },
}

/// Builds the package into its folder and runs its tests, with a command that is built from the same sources.
pub(crate) fn test() -> Result<Tested, String> {
    let Some(python) = python() else { return Ok(Tested::Skipped) };
    let built = |arguments: &str| match run_and_read(cargo(arguments))? {
        (true, _) => Ok(()),
        (false, _) => Err(format!("‘cargo {arguments}’ failed")),
    };
    // As the suite's own step has built it already: without the tests, crates of both would get fewer features, and all be
    // compiled again.
    built("test --workspace --all-features --test cli --no-run")?;
    built("build --manifest-path src/python/Cargo.toml --features pyo3/extension-module")?;
    let folder = root().join("src/python");
    let (library, module) = (root().join("target/debug/lib_sprung.so"), folder.join("sprung/_sprung.abi3.so"));
    std::fs::copy(&library, &module).map_err(|error| format!("{}: {error}", library.display()))?;

    let run = |arguments: &[&str]| {
        let mut command = Command::new(&python);
        command.args(arguments).current_dir(&folder);
        command.env("PYTHONPATH", &folder).env("SPRUNG_COMMAND", root().join("target/debug/sprung"));
        run_and_read(command)
    };
    let (typed, _) = run(&["-m", "mypy"])?;
    let (succeeded, lines) = run(&["-m", "pytest", "-q", "-p", "no:cacheprovider"])?;
    let (mut passed, mut failed) = lines.last().map_or((0, 0), |line| counts(line));
    failed += usize::from(!succeeded && failed == 0) + usize::from(!typed);
    passed += usize::from(typed);
    Ok(Tested::Ran { passed, failed })
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
