//! How long a voice has sounded.

/// Frames since the start, the last strike and the last control of a voice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// Seconds a frame.
    period: f64,
    /// Frames since the start.
    pub(super) total: u64,
    /// Frames since the last strike, now and at the last control.
    pub(super) age: u64,
    controlled: u64,
}

impl Clock {
    /// At the start.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { period: 1.0 / sample_rate, total: 0, age: 0, controlled: 0 }
    }

    /// Seconds that so many frames last.
    pub(super) fn seconds(&self, frames: u64) -> f64 {
        // A division takes four times as long, and there are a handful a tick.
        frames as f64 * self.period
    }

    /// Seconds since the last control.
    pub(super) fn since_control(&self) -> f64 {
        self.seconds(self.age - self.controlled)
    }

    /// A control happens now.
    pub(super) fn control(&mut self) {
        self.controlled = self.age;
    }

    /// A strike happens now, and counts as a control.
    pub(super) fn strike(&mut self) {
        (self.age, self.controlled) = (0, 0);
    }

    /// Lets `frames` frames pass.
    pub(super) fn advance(&mut self, frames: u64) {
        self.age += frames;
        self.total += frames;
    }
}
