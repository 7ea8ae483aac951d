//! The steps of `cargo xtask test` that are commands of cargo.

/// How to count what a step has run, from its output.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Shows {
    /// Only success or failure, which counts as one check.
    OneCheck,
    /// The test harness's `test result:` lines.
    Tests,
    /// Criterion's `Success` lines.
    Benches,
}

/// A command of cargo, and how to judge it.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) arguments: &'static str,
    pub(crate) environment: &'static [(&'static str, &'static str)],
    pub(crate) shows: Shows,
}

const DENY: (&str, &str) = ("RUSTDOCFLAGS", "-D warnings");

pub(crate) const STEPS: &[Step] = &[
    Step { name: "format", arguments: "fmt --all --check", environment: &[], shows: Shows::OneCheck },
    Step {
        name: "lint, all features",
        arguments: "clippy --workspace --all-targets --all-features -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "lint, default features",
        arguments: "clippy --package sprung --all-targets -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "lint, no features",
        arguments: "clippy --package sprung --all-targets --no-default-features -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "lint, chores",
        arguments: "clippy --package xtask --all-targets -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "tests",
        arguments: "test --workspace --all-features --no-fail-fast",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "golden, release",
        arguments: "test --release --package sprung --no-default-features --features analysis --test golden",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "golden, this CPU",
        arguments: "test --release --package sprung --no-default-features --features analysis --test golden \
            --target-dir target/native",
        environment: &[("RUSTFLAGS", "-C target-cpu=native")],
        shows: Shows::Tests,
    },
    Step {
        name: "storms, release",
        arguments: "test --release --package sprung --no-default-features --features analysis --test storm",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "fit, release",
        arguments: "test --release --package sprung --no-default-features --features analysis --test fit",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "bank, release",
        arguments: "test --release --package sprung --no-default-features --features analysis --test bank",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "documentation",
        arguments: "doc --workspace --no-deps --all-features",
        environment: &[DENY],
        shows: Shows::OneCheck,
    },
    Step {
        name: "benches run",
        arguments: "test --package sprung --all-features --benches",
        environment: &[],
        shows: Shows::Benches,
    },
    Step {
        name: "plugin, format",
        arguments: "fmt --manifest-path plugin/Cargo.toml --check",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "plugin, lint",
        arguments: "clippy --manifest-path plugin/Cargo.toml --all-targets --all-features -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "plugin, lint as bundled",
        arguments: "clippy --manifest-path plugin/Cargo.toml -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "Python, format",
        arguments: "fmt --manifest-path src/python/Cargo.toml --check",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "Python, lint",
        arguments: "clippy --manifest-path src/python/Cargo.toml -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "browser, format",
        arguments: "fmt --manifest-path src/web/Cargo.toml --check",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "browser, lint",
        arguments: "clippy --manifest-path src/web/Cargo.toml --all-targets -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "browser, tests",
        arguments: "test --manifest-path src/web/Cargo.toml",
        environment: &[],
        shows: Shows::Tests,
    },
    Step {
        name: "other CPUs, format",
        arguments: "fmt --manifest-path tests/cross/Cargo.toml --check",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "other CPUs, lint",
        arguments: "clippy --manifest-path tests/cross/Cargo.toml --all-targets -- -D warnings",
        environment: &[],
        shows: Shows::OneCheck,
    },
    Step {
        name: "plugin, documentation",
        arguments: "doc --manifest-path plugin/Cargo.toml --no-deps --all-features",
        environment: &[DENY],
        shows: Shows::OneCheck,
    },
    Step {
        name: "instructions",
        arguments: "run --release --package xtask --features engine -- callgrind",
        environment: &[],
        shows: Shows::Tests,
    },
];
