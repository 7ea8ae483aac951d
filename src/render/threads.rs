//! How many threads share a rendering.

use crate::error::{Error, Result};
use std::ops::RangeInclusive;

/// Numbers of threads that can be asked for.
pub const THREADS: RangeInclusive<u16> = 1..=256;

/// Does `work` on a pool of so many threads, which end with it; by default one a core, or as many as the environment's
/// `RAYON_NUM_THREADS` says. For [`Job::render`](super::Job::render) and [`to_wav`](super::to_wav).
///
/// # Errors
/// [`Error::Value`] if the number is not within [`THREADS`], or the system has no such number of threads to give.
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
