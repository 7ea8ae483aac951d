//! Reports skipped tests, and the few that may be skipped even where no others may.

/// Tests that some machines cannot run whatever is installed on them, and why.
const EXCUSED: &[(&str, &str)] = &[
    ("level::sse2", "x86-64 CPUs have SSE2"),
    ("level::avx2", "x86-64 CPUs since 2013 have AVX2"),
    ("level::avx512", "some x86-64 CPUs have AVX-512"),
    ("level::neon", "AArch64 CPUs have NEON"),
    ("level::simd128", "WebAssembly has it"),
    ("round_trip_of_every_preset", "it takes minutes: ‘cargo test --release --test fit -- --include-ignored’ runs it"),
    (
        "sixty_modes_in_three_seconds",
        "a debug build is too slow: ‘cargo test --release --test fit -- --include-ignored’ runs it",
    ),
    ("corrections for Windows", "not every toolchain offers Rust’s standard library for Windows"),
    ("recordings", RECORDINGS),
    ("layers_of_recordings", RECORDINGS),
    (
        "batches_at_scale::killed_ten_times_or_in_four_shards_it_is_the_same",
        "it takes minutes: ‘cargo test --release --test cli -- --ignored at_scale’ runs it",
    ),
];

const RECORDINGS: &str =
    "it takes minutes of a release build, and Debian’s fluid-soundfont-gm, fluidsynth and hydrogen-drumkits";

/// Stands for a test that a harness counted as ignored without printing its name.
const NAMELESS: &str = "a test whose name was not shown";

/// Whether this runs in a continuous integration service: all of them set this variable.
pub(crate) fn in_ci() -> bool {
    std::env::var_os("CI").is_some_and(|value| !value.is_empty())
}

/// Why a test may be skipped even where no others may; `None` if it may not.
pub(crate) fn excuse(name: &str) -> Option<&'static str> {
    EXCUSED.iter().find(|(excused, _)| *excused == name).map(|(_, why)| *why)
}

/// The names of the `count` tests that a test harness has reported as ignored.
pub(crate) fn names(lines: &[String], count: usize) -> Vec<String> {
    let name = |line: &String| {
        let (name, result) = line.strip_prefix("test ")?.split_once(" ... ")?;
        let is_ignored = result == "ignored" || result.starts_with("ignored, ");
        is_ignored.then(|| name.trim_end().to_owned())
    };
    let mut names: Vec<String> = lines.iter().filter_map(name).collect();
    names.resize(count.max(names.len()), NAMELESS.to_owned());
    names
}

/// A line for each skipped test, and the number of those without an excuse.
pub(crate) fn report(skipped: &[String]) -> (String, usize) {
    let line = |name: &String| match excuse(name) {
        Some(why) => format!("skipped: {name}; this machine cannot run it: {why}\n"),
        None => format!("skipped: {name}; `cargo xtask setup` says what it needs\n"),
    };
    (skipped.iter().map(line).collect(), skipped.iter().filter(|name| excuse(name).is_none()).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_tests_are_named() {
        let output = "running 4 tests\ntest a::b ... ok\ntest level::neon ... ignored\n\
            test c ... ignored, takes an hour\ntest d ... FAILED\n\
            test ignored ... ok\nit is said that test e ... ignored";
        let lines: Vec<String> = output.lines().map(str::to_owned).collect();
        assert_eq!(names(&lines, 2), ["level::neon", "c"]);
        assert_eq!(names(&lines, 3), ["level::neon", "c", NAMELESS]);
    }

    #[test]
    fn only_what_the_machine_cannot_do_is_excused() {
        let skipped = ["level::neon", "jack::live_notes_are_in_time_and_in_tune", NAMELESS].map(str::to_owned);
        let (text, without_excuse) = report(&skipped);
        assert_eq!(without_excuse, 2, "{text}");
        assert_eq!(text.lines().count(), 3);
        assert!(text.starts_with("skipped: level::neon; this machine cannot run it: AArch64 CPUs have NEON\n"));
        assert_eq!(report(&[]), (String::new(), 0));
    }
}
