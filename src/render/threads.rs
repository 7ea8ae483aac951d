//! Sets how many threads share a rendering.

use crate::error::{Error, Result};
use std::ops::RangeInclusive;

/// Range of the number of threads.
pub const THREADS: RangeInclusive<u16> = 1..=256;

/// Runs `work` on a pool of this many threads, which end afterwards. The default is one thread per core, or the number
/// in the environment variable `RAYON_NUM_THREADS`. Use it for [`Job::render`](super::Job::render) and
/// [`to_wav`](super::wav::to_wav).
///
/// # Errors
/// [`Error::Value`] if the number is not within [`THREADS`], or if the system cannot create so many threads.
pub fn on_threads<R: Send>(threads: Option<u16>, work: impl FnOnce() -> R + Send) -> Result<R> {
    if let Some(wanted) = threads.filter(|threads| !THREADS.contains(threads)) {
        let (low, high) = THREADS.into_inner();
        return Err(Error::value("threads", format!("{wanted} is out of range: expected {low} to {high}")));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .thread_name(|index| format!("render {index}"))
        .build()
        .map_err(|error| Error::value("threads", error.to_string()))?;
    Ok(pool.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_done_on_as_many_threads_as_wanted() {
        for threads in [1, 2, 3] {
            assert_eq!(on_threads(Some(threads), rayon::current_num_threads).unwrap(), usize::from(threads));
        }
        assert!(on_threads(None, rayon::current_num_threads).unwrap() >= 1);
        for threads in [0, 257] {
            assert!(matches!(on_threads(Some(threads), || ()), Err(Error::Value { .. })));
        }
    }
}
