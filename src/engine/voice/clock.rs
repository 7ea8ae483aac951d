//! How long a voice has played, in frames.

/// Frames since the start, the last strike and the last control tick of a voice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// Duration of a frame in seconds.
    period: f64,
    /// Frames since the start.
    pub(super) total: u64,
    /// Frames since the last strike, and, in the next field, their number at the last control tick.
    pub(super) age: u64,
    controlled: u64,
}

impl Clock {
    /// A clock at 0.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { period: 1.0 / sample_rate, total: 0, age: 0, controlled: 0 }
    }

    /// Duration of `frames` frames in seconds.
    pub(super) fn seconds(&self, frames: u64) -> f64 {
        // A division would take four times as long, and there are several in each control tick.
        frames as f64 * self.period
    }

    /// Seconds since the last control tick.
    pub(super) fn since_control(&self) -> f64 {
        self.seconds(self.age - self.controlled)
    }

    /// Marks a control tick at the present frame.
    pub(super) fn control(&mut self) {
        self.controlled = self.age;
    }

    /// Marks a strike at the present frame. It counts as a control tick.
    pub(super) fn strike(&mut self) {
        (self.age, self.controlled) = (0, 0);
    }

    /// Advances by `frames` frames.
    pub(super) fn advance(&mut self, frames: u64) {
        self.age += frames;
        self.total += frames;
    }
}
