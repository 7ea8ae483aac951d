//! Converts ticks of a MIDI file to seconds, using its tempo changes.

use midly::{Fps, Timing};

/// Microseconds per quarter note before any tempo event (Standard MIDI Files 1.0: 120 beats per minute).
const DEFAULT_TEMPO: u32 = 500_000;

/// The start of each tempo. Sums are integers, so that each time is rounded only once, at the end.
pub(super) struct TempoMap {
    /// (first tick, sum of tick × tempo over all ticks before it, tempo), in order of ticks.
    segments: Vec<(u64, u128, u32)>,
    /// Dividing a sum by this number gives seconds.
    divisor: u64,
}

impl TempoMap {
    /// A map of `changes`: (tick, microseconds per quarter note), in order of ticks. Of several changes at one tick,
    /// the last is used. With an SMPTE division, all ticks have the same length, independent of tempo, as the standard
    /// says.
    ///
    /// Errors: the division is zero.
    pub(super) fn new(timing: Timing, changes: &[(u64, u32)]) -> Result<Self, String> {
        match timing {
            Timing::Metrical(ticks) if ticks.as_int() == 0 => {
                Err("the division is 0 ticks per quarter note: expected at least 1".to_owned())
            }
            Timing::Timecode(_, 0) => Err("the division is 0 ticks per SMPTE frame: expected at least 1".to_owned()),
            Timing::Metrical(ticks) => {
                let divisor = u64::from(ticks.as_int()) * 1_000_000;
                let mut segments = vec![(0, 0, DEFAULT_TEMPO)];
                for &(tick, tempo) in changes {
                    let sum = sum_at(&segments, tick);
                    segments.push((tick, sum, tempo));
                }
                Ok(Self { segments, divisor })
            }
            Timing::Timecode(fps, ticks) => {
                // 29.97 frames per second are exactly 30000/1001.
                let (frames, per_seconds) = match fps {
                    Fps::Fps24 => (24, 1),
                    Fps::Fps25 => (25, 1),
                    Fps::Fps29 => (30_000, 1001),
                    Fps::Fps30 => (30, 1),
                };
                Ok(Self { segments: vec![(0, 0, per_seconds)], divisor: frames * u64::from(ticks) })
            }
        }
    }

    /// Seconds from the start to a tick.
    pub(super) fn seconds(&self, tick: u64) -> f64 {
        sum_at(&self.segments, tick) as f64 / self.divisor as f64
    }
}

fn sum_at(segments: &[(u64, u128, u32)], tick: u64) -> u128 {
    // The first segment starts at tick 0, so a segment is always found.
    let index = segments.partition_point(|(start, ..)| *start <= tick) - 1;
    let (start, sum, tempo) = segments[index];
    sum + u128::from(tick - start) * u128::from(tempo)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metrical(ticks: u16, changes: &[(u64, u32)]) -> TempoMap {
        TempoMap::new(Timing::Metrical(ticks.into()), changes).unwrap()
    }

    #[test]
    fn ticks_become_seconds_through_every_tempo() {
        let map = metrical(480, &[]);
        assert_eq!([0, 480, 960].map(|tick| map.seconds(tick)), [0.0, 0.5, 1.0]);
        let map = metrical(96, &[(0, 1_000_000), (96, 250_000), (192, 999), (192, 2_000_000)]);
        assert_eq!([48, 96, 192, 240].map(|tick| map.seconds(tick)), [0.5, 1.0, 1.25, 2.25]);
    }

    #[test]
    fn a_long_song_loses_nothing_to_rounding() {
        // 1/3 s per beat is not a whole number of µs. The errors of a million tempo changes must not add up.
        let changes: Vec<(u64, u32)> = (0..1_000_000).map(|tick| (tick, 333_333 + (tick % 3 == 0) as u32)).collect();
        let map = metrical(1, &changes);
        assert_eq!(map.seconds(999_999), (333_333.0 * 999_999.0 + 333_333.0) / 1e6);
        assert_eq!(metrical(1, &[]).seconds(u64::MAX), u64::MAX as f64 * 0.5);
    }

    #[test]
    fn smpte_ticks_ignore_tempo() {
        for (fps, ticks, tick, seconds) in [
            (Fps::Fps24, 4, 96, 1.0),
            (Fps::Fps25, 40, 1000, 1.0),
            (Fps::Fps29, 100, 30_000, 10.01),
            (Fps::Fps30, 80, 1200, 0.5),
        ] {
            let map = TempoMap::new(Timing::Timecode(fps, ticks), &[(0, 1)]).unwrap();
            assert_eq!(map.seconds(tick), seconds, "{fps:?}");
        }
    }

    #[test]
    fn a_division_of_zero_is_an_error() {
        assert!(TempoMap::new(Timing::Metrical(0.into()), &[]).is_err());
        assert!(TempoMap::new(Timing::Timecode(Fps::Fps25, 0), &[]).is_err());
    }
}
