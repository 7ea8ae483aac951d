//! Converts time stamps to frames: computes each block's time, and the frame in the block at which an event sounds.

use std::time::{Duration, Instant};

/// A greater change of the clocks' difference, in seconds, means that the stream is new and has another clock. A
/// smaller one is jitter.
const ANOTHER_CLOCK: f64 = 0.05;

/// Time constant in seconds with which the longest latency decays, and with which the clock follows a drift between the
/// device's clock and the system's.
const SHRINK_SECONDS: f64 = 30.0;

/// The times of a block: when it was requested, and when it will be heard.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Time of the callback, on the system's clock.
    pub now: Instant,
    /// Time of the callback, on the device's clock.
    pub called: Duration,
    /// Time at which the block's first frame will be heard, on the device's clock.
    pub heard: Duration,
}

/// The time at which an event arrived.
#[derive(Clone, Copy, Debug)]
pub enum Stamp {
    /// On the system's clock.
    System(Instant),
    /// On the device's clock.
    Device(Duration),
}

/// Places events inside blocks by their time stamps.
///
/// An event that arrives a third of the way from one block's time to the next one's sounds a third of the way into the
/// next block: exactly one block late. A block's time is the time at which it is heard, as reported by the device,
/// minus a constant; it is not the time of the callback. So notes have no jitter, even if the callbacks have, or if the
/// device's clock runs unevenly. Real-time safe.
#[derive(Clone, Debug)]
pub struct BlockClock {
    sample_rate: f64,
    epoch: Instant,
    /// Seconds since the epoch at which the device's clock was 0. A callback may read the system's clock too late but
    /// never too early, so the smallest difference is the most accurate.
    offset: Option<f64>,
    /// Longest time from a callback to the sound, in seconds: that of a callback without delay.
    ahead: f64,
    /// Times of the previous block and of this one, in seconds on the device's clock.
    times: [f64; 2],
    frames: u32,
}

impl BlockClock {
    /// A clock before the first block.
    pub fn new(sample_rate: f64) -> Self {
        Self { sample_rate, epoch: Instant::now(), offset: None, ahead: 0.0, times: [0.0; 2], frames: 0 }
    }

    /// Begins a block of `frames` frames.
    pub fn begin(&mut self, moment: Moment, frames: u32) {
        let length = f64::from(frames) / self.sample_rate;
        let follow = (length / SHRINK_SECONDS).min(1.0);
        let (called, heard) = (moment.called.as_secs_f64(), moment.heard.as_secs_f64());
        let offset = self.seconds(moment.now) - called;
        let known = self.offset.filter(|known| (offset - known).abs() < ANOTHER_CLOCK);
        self.offset = Some(known.map_or(offset, |known| known + (offset - known).min((offset - known) * follow)));
        let ahead = heard - called;
        self.ahead = match known {
            Some(_) => self.ahead + (ahead - self.ahead).max((ahead - self.ahead) * follow),
            None => ahead,
        };
        let time = heard - self.ahead;
        self.times = [if known.is_some() { self.times[1] } else { time - length }, time];
        self.frames = frames;
    }

    /// The frame of this block at which an event with this time stamp sounds: the first frame if the event is late,
    /// none if it belongs to a later block.
    pub(crate) fn frame_of(&self, stamp: Stamp) -> Option<u32> {
        let [before, time] = self.times;
        let at = match stamp {
            Stamp::System(instant) => self.seconds(instant) - self.offset.unwrap_or(0.0),
            Stamp::Device(time) => time.as_secs_f64(),
        };
        if at >= time {
            return None;
        }
        let frame = ((at - before) / (time - before) * f64::from(self.frames)).round().max(0.0);
        Some((frame as u32).min(self.frames.saturating_sub(1)))
    }

    /// Seconds from the time stamp of an event to the time at which it is heard.
    pub fn delay(&self) -> f64 {
        self.ahead + f64::from(self.frames) / self.sample_rate
    }

    fn seconds(&self, at: Instant) -> f64 {
        match at.checked_duration_since(self.epoch) {
            Some(since) => since.as_secs_f64(),
            None => -self.epoch.duration_since(at).as_secs_f64(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random;

    const RATE: f64 = 48_000.0;
    const BLOCK: u32 = 480;

    fn moment(epoch: Instant, called: f64, heard: f64) -> Moment {
        let device = |seconds: f64| Duration::from_secs_f64(seconds + 7.0);
        Moment { now: epoch + Duration::from_secs_f64(called), called: device(called), heard: device(heard) }
    }

    /// Sends an event every `interval` frames through blocks whose callbacks are up to `jitter` seconds late. Returns
    /// for each event after the first second the number of frames from its time stamp to its sound.
    fn delays(jitter: f64, interval: f64) -> Vec<f64> {
        let mut clock = BlockClock::new(RATE);
        let epoch = Instant::now();
        let length = f64::from(BLOCK) / RATE;
        let mut waiting: std::collections::VecDeque<f64> = Default::default();
        let (mut sent, mut delays) = (0.0, Vec::new());
        for block in 0..500_u32 {
            let late = jitter * f64::from(random::uniform(1, block.into()).abs());
            let due = f64::from(block) * length;
            while sent <= due + late {
                waiting.push_back(sent);
                sent += interval / RATE;
            }
            clock.begin(moment(epoch, due + late, due + length), BLOCK);
            while let Some(&stamp) = waiting.front() {
                let Some(frame) = clock.frame_of(Stamp::System(epoch + Duration::from_secs_f64(stamp))) else { break };
                waiting.pop_front();
                if block > 100 {
                    delays.push(f64::from(block * BLOCK + frame) - stamp * RATE);
                }
            }
        }
        delays
    }

    #[test]
    fn events_keep_their_distances_whatever_the_callback_does() {
        for jitter in [0.0, 0.001, 0.009] {
            let delays = delays(jitter, 77.0);
            assert!(delays.len() > 1000);
            let (least, most) = delays.iter().fold((f64::MAX, f64::MIN), |(a, b), d| (a.min(*d), b.max(*d)));
            assert!(most - least <= 1.0 + 0.05 * jitter * RATE, "jitter {jitter}: {least} to {most} frames");
        }
    }

    #[test]
    fn late_events_sound_at_once_and_early_ones_wait() {
        let mut clock = BlockClock::new(RATE);
        let epoch = Instant::now() + Duration::from_secs(1);
        let at = |ms: f64| {
            if ms < 0.0 {
                epoch - Duration::from_secs_f64(-ms / 1e3)
            } else {
                epoch + Duration::from_secs_f64(ms / 1e3)
            }
        };
        clock.begin(moment(epoch, 0.0, 0.0), BLOCK);
        assert_eq!(clock.frame_of(Stamp::System(at(-500.0))), Some(0));
        assert_eq!(clock.frame_of(Stamp::System(at(-5.0))), Some(240));
        assert_eq!(clock.frame_of(Stamp::System(at(0.0))), None, "an event of now belongs to the next block");
        assert_eq!(clock.frame_of(Stamp::Device(Duration::from_millis(6_995))), Some(240));
        clock.begin(moment(epoch, 0.01, 0.01), BLOCK);
        assert_eq!(clock.frame_of(Stamp::System(at(0.0))), Some(0));
    }

    #[test]
    fn a_new_stream_has_a_new_clock() {
        let mut clock = BlockClock::new(RATE);
        let epoch = Instant::now();
        clock.begin(moment(epoch, 0.0, 0.0), BLOCK);
        let later = epoch + Duration::from_secs(60);
        clock.begin(Moment { now: later, called: Duration::ZERO, heard: Duration::ZERO }, BLOCK);
        assert_eq!(clock.frame_of(Stamp::System(later - Duration::from_millis(5))), Some(240));
    }
}
