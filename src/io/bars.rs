//! Converts a tick of a song to bar and beat, using its time signatures.

use super::tempo::TempoMap;
use midly::Timing;

/// Maximum number of time signatures. The others are ignored, which only makes places in messages wrong.
const MOST_SIGNATURES: usize = 4096;

/// The bars of a song, as far as it has been read. Used for messages only.
pub(super) struct Bars {
    timing: Timing,
    /// For each signature: its first tick, the beats in a bar, and the beat's note value as a power of two.
    signatures: Vec<(u64, u8, u8)>,
}

impl Bars {
    /// Bars of four quarter notes, which hold until the first time signature (Standard MIDI Files 1.0).
    pub(super) fn new(timing: Timing) -> Self {
        Self { timing, signatures: vec![(0, 4, 2)] }
    }

    /// Adds a time signature. Ignores one that is not valid.
    pub(super) fn change(&mut self, tick: u64, beats: u8, note: u8) {
        // A beat shorter than 1/128 is shorter than a tick in most files.
        if beats > 0 && note <= 7 && self.signatures.len() < MOST_SIGNATURES {
            self.signatures.push((tick, beats, note));
        }
    }

    /// The tick nearest to a beat of a bar, both from 1. The message says why there is none.
    fn tick(&self, bar: u32, beat: f64) -> Result<u64, String> {
        let Timing::Metrical(division) = self.timing else {
            return Err("the song counts seconds, not bars: expected a time in seconds".to_owned());
        };
        let whole_note = 4.0 * f64::from(division.as_int().max(1));
        let mut signatures = self.signatures.clone();
        signatures.sort_by_key(|(start, ..)| *start);
        let mut first = 1.0;
        for (index, (start, beats, note)) in signatures.iter().enumerate() {
            let length = whole_note / f64::from(1_u32 << note);
            let next = signatures.get(index + 1).map(|(next, ..)| *next);
            // A change inside a bar starts a new bar.
            let bars = next.map_or(f64::INFINITY, |next| ((next - start) as f64 / (length * f64::from(*beats))).ceil());
            if f64::from(bar) < first + bars {
                if beat >= 1.0 + f64::from(*beats) {
                    return Err(format!("bar {bar} has {beats} beats: expected 1 to {beats}"));
                }
                let beats_before = (f64::from(bar) - first) * f64::from(*beats) + (beat - 1.0);
                let tick = start + (beats_before * length).round() as u64;
                return Ok(next.map_or(tick, |next| tick.min(next)));
            }
            first += bars;
        }
        Err(format!("there is no bar {bar}"))
    }

    /// The place of a tick, such as `bar 3, beat 2`, counted from 1; or `2.5 s` if ticks are parts of a second.
    pub(super) fn place(&self, tick: u64) -> String {
        let Timing::Metrical(division) = self.timing else {
            let seconds = TempoMap::new(self.timing, &[]).map_or(0.0, |map| map.seconds(tick));
            return format!("{seconds:.3} s");
        };
        let mut signatures = self.signatures.clone();
        signatures.sort_by_key(|(start, ..)| *start);
        signatures.retain(|(start, ..)| *start <= tick);
        // The division is the number of ticks per quarter note.
        let whole_note = 4 * u128::from(division.as_int().max(1));
        let (mut bars, mut beat) = (0, 0);
        for (index, (start, beats, note)) in signatures.iter().enumerate() {
            let end = signatures.get(index + 1).map_or(tick, |(next, ..)| *next);
            let passed = u128::from(end - start) << note;
            let bar = whole_note * u128::from(*beats);
            beat = passed % bar / whole_note;
            // A change inside a bar starts a new bar.
            bars += if index + 1 < signatures.len() { passed.div_ceil(bar) } else { passed / bar };
        }
        format!("bar {}, beat {}", bars + 1, beat + 1)
    }
}

/// A time in a song, as people name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SongTime {
    /// Seconds from the start.
    Seconds(f64),
    /// A bar and a beat in it, both from 1.
    Bar {
        /// The bar.
        bar: u32,
        /// The beat, which can be a fraction.
        beat: f64,
    },
}

/// The bars of a whole song, and the times of its ticks.
pub(crate) struct Places {
    pub(super) bars: Bars,
    pub(super) tempos: TempoMap,
}

impl Places {
    /// Seconds from the start of the song. The message says why there is no such time.
    pub(crate) fn seconds(&self, time: SongTime) -> Result<f64, String> {
        match time {
            SongTime::Seconds(seconds) => Ok(seconds),
            SongTime::Bar { bar, beat } => self.bars.tick(bar, beat).map(|tick| self.tempos.seconds(tick)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use midly::Fps;

    #[test]
    fn ticks_become_bars_and_beats_through_every_signature() {
        let mut bars = Bars::new(Timing::Metrical(96.into()));
        for (tick, place) in
            [(0, "bar 1, beat 1"), (95, "bar 1, beat 1"), (96, "bar 1, beat 2"), (384, "bar 2, beat 1")]
        {
            assert_eq!(bars.place(tick), place);
        }
        // The order of the signatures is not that of their ticks, as with several tracks: 3/4 from bar 5, 6/8 from bar
        // 3, and 5/4 in the middle of a bar.
        bars.change(768 + 2 * 288, 3, 2);
        bars.change(768, 6, 3);
        bars.change(768 + 2 * 288 + 100, 5, 2);
        for (tick, place) in [
            (767, "bar 2, beat 4"),
            (768, "bar 3, beat 1"),
            (768 + 5 * 48, "bar 3, beat 6"),
            (768 + 288, "bar 4, beat 1"),
            (768 + 2 * 288, "bar 5, beat 1"),
            (768 + 2 * 288 + 99, "bar 5, beat 2"),
            (768 + 2 * 288 + 100, "bar 6, beat 1"),
            (768 + 2 * 288 + 100 + 480, "bar 7, beat 1"),
        ] {
            assert_eq!(bars.place(tick), place, "{tick}");
        }
    }

    #[test]
    fn bars_and_beats_become_the_ticks_that_they_come_from() {
        let mut bars = Bars::new(Timing::Metrical(96.into()));
        bars.change(768, 6, 3);
        bars.change(768 + 2 * 288 + 100, 5, 2);
        for (bar, beat, tick) in
            [(1, 1.0, 0), (2, 4.5, 720), (3, 1.0, 768), (4, 6.0, 768 + 288 + 240), (5, 3.0, 1440), (6, 2.0, 1540)]
        {
            assert_eq!(bars.tick(bar, beat), Ok(tick), "bar {bar}, beat {beat}");
            let place = format!("bar {bar}, beat {}", beat.floor());
            assert!(bars.place(tick) == place || beat == 3.0, "{place}");
        }
        assert_eq!(bars.tick(2, 5.0), Err("bar 2 has 4 beats: expected 1 to 4".to_owned()));
        assert!(Bars::new(Timing::Timecode(Fps::Fps25, 40)).tick(1, 1.0).is_err());
    }

    #[test]
    fn impossible_signatures_and_huge_ticks_do_no_harm() {
        let mut bars = Bars::new(Timing::Metrical(0.into()));
        bars.change(0, 0, 2);
        bars.change(0, 4, 200);
        assert_eq!(bars.place(8), "bar 3, beat 1");
        assert_eq!(bars.place(u64::MAX), "bar 4611686018427387904, beat 4");
        assert_eq!(Bars::new(Timing::Timecode(Fps::Fps25, 40)).place(2500), "2.500 s");
        assert_eq!(Bars::new(Timing::Timecode(Fps::Fps25, 0)).place(2500), "0.000 s");
    }
}
