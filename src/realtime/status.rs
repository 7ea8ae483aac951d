//! What the audio thread tells, and is told, without locks.

use crate::engine::note::{nearest_channel, nearest_key};
use crate::engine::{EventKind, Snapshot};
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64};
use std::time::Duration;

/// A program that no program change has chosen.
const NO_PROGRAM: u8 = 255;

/// Numbers that the audio thread keeps up to date. Writing and reading are real-time safe.
pub struct Status {
    frames: AtomicU64,
    callbacks: AtomicU64,
    late_callbacks: AtomicU64,
    xruns: AtomicU64,
    busy_nanos: AtomicU64,
    period_nanos: AtomicU64,
    /// Bits of non-negative floats, which are in the order of the floats.
    worst_share: AtomicU32,
    recent_share: AtomicU32,
    peaks: [AtomicU32; 2],
    delay: AtomicU32,
    voices: AtomicU32,
    masses: [[AtomicU32; 2]; 64],
    keys: [[AtomicU64; 2]; 16],
    programs: [AtomicU8; 16],
    song_over: AtomicBool,
    silent: AtomicBool,
    watched: AtomicBool,
    song_halted: AtomicBool,
}

impl Default for Status {
    fn default() -> Self {
        let zero = || AtomicU32::new(0);
        Self {
            frames: AtomicU64::new(0),
            callbacks: AtomicU64::new(0),
            late_callbacks: AtomicU64::new(0),
            xruns: AtomicU64::new(0),
            busy_nanos: AtomicU64::new(0),
            period_nanos: AtomicU64::new(0),
            worst_share: zero(),
            recent_share: zero(),
            peaks: [zero(), zero()],
            delay: zero(),
            voices: zero(),
            masses: std::array::from_fn(|_| [zero(), zero()]),
            keys: std::array::from_fn(|_| [AtomicU64::new(0), AtomicU64::new(0)]),
            programs: std::array::from_fn(|_| AtomicU8::new(NO_PROGRAM)),
            song_over: AtomicBool::new(false),
            silent: AtomicBool::new(true),
            watched: AtomicBool::new(false),
            song_halted: AtomicBool::new(false),
        }
    }
}

/// How the audio thread has kept up so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Frames played.
    pub frames: u64,
    /// Blocks that the device asked for.
    pub callbacks: u64,
    /// Blocks that took longer than they last.
    pub late_callbacks: u64,
    /// Times that the device says it ran dry.
    pub xruns: u64,
    /// Share of the time that was spent in the callback.
    pub mean_share: f64,
    /// The largest share of its own time that one block took.
    pub worst_share: f64,
    /// The largest share since this was last asked.
    pub recent_share: f64,
    /// Seconds from an event's time stamp to the frame in which it is heard.
    pub delay: f64,
}

impl Status {
    /// How the audio thread has kept up.
    pub fn load(&self) -> Load {
        let (busy, period) = (self.busy_nanos.load(Relaxed), self.period_nanos.load(Relaxed));
        Load {
            frames: self.frames.load(Relaxed),
            callbacks: self.callbacks.load(Relaxed),
            late_callbacks: self.late_callbacks.load(Relaxed),
            xruns: self.xruns.load(Relaxed),
            mean_share: busy as f64 / period.max(1) as f64,
            worst_share: f32::from_bits(self.worst_share.load(Relaxed)).into(),
            recent_share: f32::from_bits(self.recent_share.swap(0, Relaxed)).into(),
            delay: f32::from_bits(self.delay.load(Relaxed)).into(),
        }
    }

    /// Frames played.
    pub fn frames(&self) -> u64 {
        self.frames.load(Relaxed)
    }

    /// The largest samples, left and right, since this was last asked.
    pub fn take_peaks(&self) -> [f32; 2] {
        [0, 1].map(|side| f32::from_bits(self.peaks[side].swap(0, Relaxed)))
    }

    /// What sounds. From the first call on, the audio thread keeps it up to date.
    pub fn snapshot(&self) -> Snapshot {
        self.watched.store(true, Relaxed);
        let mut snapshot = Snapshot { voices: self.voices.load(Relaxed), ..Snapshot::default() };
        for (mass, [displacement, energy]) in snapshot.masses.iter_mut().zip(&self.masses) {
            mass.displacement = f32::from_bits(displacement.load(Relaxed));
            mass.energy = f32::from_bits(energy.load(Relaxed));
        }
        snapshot
    }

    /// The keys that are down on a channel, a bit each.
    pub fn keys(&self, channel: u8) -> u128 {
        let [low, high] = &self.keys[usize::from(nearest_channel(channel))];
        u128::from(low.load(Relaxed)) | u128::from(high.load(Relaxed)) << 64
    }

    /// The program that the last program change chose on a channel, once one has.
    pub fn program(&self, channel: u8) -> Option<u8> {
        Some(self.programs[usize::from(nearest_channel(channel))].load(Relaxed))
            .filter(|program| *program != NO_PROGRAM)
    }

    /// Whether the song, if there is one, has come to its end.
    pub fn is_song_over(&self) -> bool {
        self.song_over.load(Relaxed)
    }

    /// Whether nothing sounds.
    pub fn is_silent(&self) -> bool {
        self.silent.load(Relaxed)
    }

    /// Stops the song where it is.
    pub fn halt_song(&self) {
        self.song_halted.store(true, Relaxed);
    }

    pub(super) fn is_song_halted(&self) -> bool {
        self.song_halted.load(Relaxed)
    }

    pub(super) fn is_watched(&self) -> bool {
        self.watched.load(Relaxed)
    }

    pub(super) fn count_xrun(&self) {
        self.xruns.fetch_add(1, Relaxed);
    }

    pub(super) fn note_event(&self, channel: u8, kind: EventKind) {
        let channel = usize::from(nearest_channel(channel));
        match kind {
            EventKind::NoteOn { key, .. } => {
                let key = nearest_key(key);
                self.keys[channel][usize::from(key >> 6)].fetch_or(1 << (key & 63), Relaxed);
            }
            EventKind::NoteOff { key, .. } => {
                let key = nearest_key(key);
                self.keys[channel][usize::from(key >> 6)].fetch_and(!(1 << (key & 63)), Relaxed);
            }
            EventKind::Control { controller: 120 | 123..=127, .. } => {
                self.keys[channel].iter().for_each(|half| half.store(0, Relaxed));
            }
            EventKind::Program(number) => self.programs[channel].store(number, Relaxed),
            _ => {}
        }
    }

    pub(super) fn note_sound(&self, peaks: [f32; 2], song_over: bool, silent: bool) {
        for (kept, peak) in self.peaks.iter().zip(peaks) {
            kept.fetch_max(peak.abs().to_bits(), Relaxed);
        }
        self.song_over.store(song_over, Relaxed);
        self.silent.store(silent, Relaxed);
    }

    pub(super) fn note_snapshot(&self, snapshot: &Snapshot) {
        self.voices.store(snapshot.voices, Relaxed);
        for (mass, [displacement, energy]) in snapshot.masses.iter().zip(&self.masses) {
            displacement.store(mass.displacement.to_bits(), Relaxed);
            energy.store(mass.energy.to_bits(), Relaxed);
        }
    }

    pub(super) fn note_callback(&self, frames: u64, busy: Duration, period: Duration, delay: f64) {
        self.frames.fetch_add(frames, Relaxed);
        self.callbacks.fetch_add(1, Relaxed);
        self.busy_nanos.fetch_add(busy.as_nanos() as u64, Relaxed);
        self.period_nanos.fetch_add(period.as_nanos() as u64, Relaxed);
        self.late_callbacks.fetch_add((busy > period).into(), Relaxed);
        let share = (busy.as_secs_f64() / period.as_secs_f64().max(1e-9)) as f32;
        self.worst_share.fetch_max(share.to_bits(), Relaxed);
        self.recent_share.fetch_max(share.to_bits(), Relaxed);
        self.delay.store((delay.max(0.0) as f32).to_bits(), Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn load_is_a_share_of_the_period() {
        let status = Status::default();
        let ms = Duration::from_millis;
        status.note_callback(480, ms(1), ms(10), 0.02);
        status.note_callback(480, ms(12), ms(10), 0.02);
        status.note_callback(480, ms(2), ms(10), 0.02);
        let load = status.load();
        assert_eq!((load.frames, load.callbacks, load.late_callbacks, load.xruns), (1440, 3, 1, 0));
        assert!((load.mean_share - 0.5).abs() < 1e-6 && (load.worst_share - 1.2).abs() < 1e-6, "{load:?}");
        status.note_callback(480, ms(2), ms(10), 0.02);
        assert!((status.load().recent_share - 0.2).abs() < 1e-6, "the recent worst is forgotten once it was told");
    }

    #[test]
    fn keys_and_programs_are_kept_by_channel() {
        let status = Status::default();
        let on = |key| EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: -1 };
        [0, 63, 64, 127].into_iter().for_each(|key| status.note_event(3, on(key)));
        status.note_event(3, EventKind::NoteOff { key: 63, velocity: 0.5, id: -1 });
        assert_eq!(status.keys(3), 1 | 1 << 64 | 1 << 127);
        assert_eq!((status.keys(2), status.program(3)), (0, None));
        status.note_event(3, EventKind::Program(7));
        assert_eq!(status.program(3), Some(7));
        status.note_event(3, EventKind::Control { controller: 123, value: 0.0 });
        assert_eq!(status.keys(3), 0);
    }
}
