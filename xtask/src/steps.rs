//! The suites of `cargo xtask test`, and their steps that are commands of cargo.

use crate::count::Shows;

/// What is run.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Suite {
    /// What protects every commit, in minutes and however busy the machine is.
    Commit,
    /// Everything, also what takes long or waits for time to pass.
    All,
}

/// Commands of cargo, and how to judge them.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) commands: &'static [&'static str],
    pub(crate) environment: &'static [(&'static str, &'static str)],
    pub(crate) shows: Shows,
}

/// A step that counts as one check, and needs nothing of the environment.
const fn check(name: &'static str, commands: &'static [&'static str]) -> Step {
    Step { name, commands, environment: &[], shows: Shows::OneCheck }
}

/// A step that runs tests.
const fn tests(name: &'static str, commands: &'static [&'static str]) -> Step {
    Step { name, commands, environment: &[], shows: Shows::Tests }
}

/// What every commit is checked for before its tests run.
pub(crate) const CHECKS: &[Step] = &[
    check("format", &["fmt --all --check"]),
    check("lint", &["clippy --workspace --all-targets --all-features -- -D warnings"]),
];

/// What is built for the tests, at once and with all features, so that nothing is compiled a second time with others.
pub(crate) const TESTED: &str = "--workspace --all-features --lib --bins --tests";

/// The examples in the documentation, which [`TESTED`] leaves out.
pub(crate) const EXAMPLES: Step = tests("examples", &["test --doc --workspace --all-features"]);

/// What takes longer than a commit should wait for.
pub(crate) const LONG: &[Step] = &[
    check(
        "features",
        &[
            "hack clippy --package sprung --package sprung-cli --each-feature --all-targets -- -D warnings",
            "clippy --package xtask --all-targets -- -D warnings",
            "clippy --package sprung-plugin -- -D warnings",
        ],
    ),
    Step {
        name: "documentation",
        commands: &["doc --workspace --no-deps --all-features"],
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
        shows: Shows::OneCheck,
    },
    tests(
        "golden, not optimised",
        &["test --config profile.dev.opt-level=0 --config profile.dev.package.sprung.opt-level=0 --package sprung \
           --no-default-features --features analysis --test golden --target-dir target/plain"],
    ),
    tests(
        "golden, release",
        &["test --release --package sprung --no-default-features --features analysis --test golden"],
    ),
    Step {
        name: "golden, this CPU",
        commands: &["test --release --package sprung --no-default-features --features analysis --test golden \
                     --target-dir target/native"],
        environment: &[("RUSTFLAGS", "-C target-cpu=native")],
        shows: Shows::Tests,
    },
    Step {
        name: "benches run",
        commands: &["test --package sprung --all-features --benches"],
        environment: &[],
        shows: Shows::Benches,
    },
    tests("instructions", &["xtask callgrind"]),
];

/// The tests that need nothing of Linux: of samples and command, and of the plugin in hosts. They are all that runs elsewhere.
pub(crate) const ELSEWHERE: [&str; 2] = [
    "test --package sprung --package sprung-cli --features sprung/batch,sprung/lab --no-fail-fast \
     --test golden --test cli",
    "test --package sprung-plugin --no-fail-fast --test hosts",
];

/// Systems on which nothing can be run here: the types of all parts are checked for them, by the compiler's names.
pub(crate) const CHECKED: [&str; 3] = ["aarch64-apple-darwin", "x86_64-apple-darwin", "x86_64-pc-windows-msvc"];
