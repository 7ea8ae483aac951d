//! CPU time of the current thread.

use std::time::Instant;

/// Measures the CPU seconds of this thread, which are far fewer than the elapsed seconds on a busy machine.
pub(crate) struct Clock {
    started: Instant,
    worked: Option<f64>,
}

impl Clock {
    pub(crate) fn start() -> Self {
        Self { started: Instant::now(), worked: Self::worked() }
    }

    /// CPU seconds so far, from Linux's nanoseconds; `None` on other systems.
    fn worked() -> Option<f64> {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        text.split(' ').next()?.parse().ok().map(|nanoseconds: f64| 1e-9 * nanoseconds)
    }

    pub(crate) fn seconds(&self) -> f64 {
        let worked = self.worked.and_then(|before| Some(Self::worked()? - before));
        worked.unwrap_or_else(|| self.started.elapsed().as_secs_f64())
    }
}
