//! Reads criterion's results: the fastest sample of each bench, as elements per second.
//!
//! Other work on the machine can only make a sample slower, so the fastest sample is closest to the true cost.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Elements per second, by the full name of the bench.
pub(super) struct Measured(BTreeMap<String, f64>);

impl Measured {
    /// Reads all results in criterion's folder.
    pub(super) fn read(folder: &Path) -> Result<Self, String> {
        let mut rates = BTreeMap::new();
        gather(folder, &mut rates)?;
        Ok(Self(rates))
    }

    /// Elements per second of a bench; `None` if it did not run.
    pub(super) fn rate(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }
}

fn gather(folder: &Path, rates: &mut BTreeMap<String, f64>) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.join("benchmark.json").is_file() {
            // `base` contains the results of the run before.
            if path.ends_with("new") {
                let read = |name: &str| fs::read_to_string(path.join(name)).map_err(failed);
                let result = result(&read("benchmark.json")?, &read("sample.json")?);
                let (name, rate) = result.ok_or_else(|| format!("{}: not criterion's format", path.display()))?;
                rates.insert(name, rate);
            }
        } else if path.is_dir() {
            gather(&path, rates)?;
        }
    }
    Ok(())
}

/// The name of a bench and its fastest rate, from two of criterion's files.
fn result(benchmark: &str, sample: &str) -> Option<(String, f64)> {
    let (benchmark, sample): (Value, Value) =
        (serde_json::from_str(benchmark).ok()?, serde_json::from_str(sample).ok()?);
    let elements = benchmark["throughput"]["Elements"].as_f64()?;
    let numbers = |key: &str| sample[key].as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>();
    let (times, iterations) = (numbers("times")?, numbers("iters")?);
    let nanoseconds = times.iter().zip(iterations).map(|(time, iterations)| time / iterations).reduce(f64::min)?;
    Some((benchmark["full_id"].as_str()?.to_owned(), elements / nanoseconds * 1e9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_sample_counts() {
        let benchmark = r#"{"full_id":"ringing/avx2/64","throughput":{"Elements":100}}"#;
        let sample = r#"{"iters":[10.0,20.0],"times":[1000.0,1000.0]}"#;
        assert_eq!(result(benchmark, sample), Some(("ringing/avx2/64".to_owned(), 2e9)));
        assert_eq!(result(r#"{"full_id":"a","throughput":null}"#, sample), None);
        assert_eq!(result(benchmark, r#"{"iters":[],"times":[]}"#), None);
    }
}
