//! When each block is heard, and where in it an event belongs that came at a given time.

use std::time::{Duration, Instant};

/// A difference beyond this many seconds is another clock (the stream is a new one), not jitter.
const ANOTHER_CLOCK: f64 = 0.05;

/// Time in which the longest time to the sound is forgotten, and in which a drift of the device's clock against the
/// system's is followed, in seconds.
const SHRINK_SECONDS: f64 = 30.0;

/// When a block was asked for and when it is heard.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The time of the call.
    pub now: Instant,
    /// The same on the device's clock.
    pub called: Duration,
    /// When the block's first frame is heard, on the device's clock.
    pub heard: Duration,
}

/// When an event came.
#[derive(Clone, Copy, Debug)]
pub enum Stamp {
    /// On the system's clock.
    System(Instant),
    /// On the device's clock.
    Device(Duration),
}

/// Places events inside blocks by their time stamps.
///
/// An event that came a third of the way from one block's time to the next one's sounds a third of the way into the
/// latter: one block late, to the frame. A block's time is when it is heard, which the device knows, less a constant; not
/// when it is asked for. So neither jitter of the callback nor a device's clock that runs unevenly becomes jitter of the
/// notes. Real-time safe.
#[derive(Clone, Debug)]
pub struct BlockClock {
    sample_rate: f64,
    epoch: Instant,
    /// Seconds since the epoch at which the device's clock read 0. A callback can look at the system's clock late, but
    /// never early: the least difference counts.
    offset: Option<f64>,
    /// Longest time from the call to the sound, in seconds: that of a callback that is called without delay.
    ahead: f64,
    /// Times of the block before this one and of this one, in seconds on the device's clock.
    times: [f64; 2],
    frames: u32,
}

impl BlockClock {
    /// A clock that has seen no block yet.
    pub fn new(sample_rate: f64) -> Self {
        Self { sample_rate, epoch: Instant::now(), offset: None, ahead: 0.0, times: [0.0; 2], frames: 0 }
    }

    /// A block of `frames` is asked for.
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

    /// The frame of this block at which an event with this time stamp sounds: the first if it should have sounded
    /// earlier, none if it belongs to a later block.
    pub fn frame_of(&self, stamp: Stamp) -> Option<u32> {
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

    /// Seconds from the time stamp of an event to the frame in which it is heard.
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

    /// Sends an event every `interval` frames through blocks whose callbacks are late by up to `jitter` seconds, and
    /// returns how many frames after its time stamp each sounds, after a second to settle.
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
