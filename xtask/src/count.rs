//! What a step has run, counted from its output.

use std::fmt;

/// How to count what a step has run, from its output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shows {
    /// Only success or failure, which counts as one check.
    OneCheck,
    /// The summary of a test harness, or of nextest.
    Tests,
    /// Criterion's `Success` lines.
    Benches,
}

/// How many checks ran, and with which results. Skipped are tests that are left to the longer suite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Count {
    pub(crate) passed: usize,
    pub(crate) failed: usize,
    pub(crate) skipped: usize,
}

impl Count {
    pub(crate) const ONE: Count = Count { passed: 1, failed: 0, skipped: 0 };
    pub(crate) const FAILED: Count = Count { passed: 0, failed: 1, skipped: 0 };

    pub(crate) fn add(&mut self, other: Count) {
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

impl Shows {
    /// Counts what a command ran, from its output. One whose filter matched nothing, or that failed before it could count,
    /// counts as one failure.
    pub(crate) fn judge(self, succeeded: bool, lines: &[String]) -> Count {
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
