//! State that the audio thread publishes for a display: voices, levels, keys, and the processing load.

use super::atomic::AtomicF32;
use super::midi::controller::{ALL_NOTES_OFF, ALL_SOUND_OFF};
use super::note::{nearest_channel, nearest_key};
use super::scope::Scope;
use super::{Event, EventKind, Notes, Snapshot};
use crate::dsp::mode_bank::MAX_MODES;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU16, AtomicU32, AtomicU64};
use std::time::Duration;

/// How often per second the masses are published.
const SNAPSHOT_RATE: f64 = 40.0;

/// How many snapshots are published after somebody has looked, if nobody looks again: those of a second.
const SNAPSHOTS_PER_LOOK: u32 = 40;

/// State that the audio thread publishes through a [`TelemetryWriter`]. Any thread may read it at any time without
/// waiting. Each number is consistent, but two numbers may come from different blocks.
#[derive(Default)]
pub struct Telemetry {
    frames: AtomicU64,
    blocks: AtomicU64,
    late_blocks: AtomicU64,
    busy_nanos: AtomicU64,
    period_nanos: AtomicU64,
    worst_share: AtomicF32,
    recent_share: AtomicF32,
    peaks: [AtomicF32; 2],
    voices: AtomicU32,
    masses: Masses,
    keys: [[AtomicU64; 2]; 16],
    /// Number of the selected program plus 1; 0 for none.
    programs: [AtomicU16; 16],
    sounding: AtomicBool,
    scope: Scope,
    /// How many snapshots to publish before somebody looks again.
    wanted: AtomicU32,
}

/// The processing load of the audio thread so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Frames played.
    pub frames: u64,
    /// Blocks that the host or device asked for.
    pub blocks: u64,
    /// Blocks whose processing took longer than their duration.
    pub late_blocks: u64,
    /// Mean processing time as a fraction of the blocks' duration.
    pub mean_share: f64,
    /// The largest fraction of its duration that one block took.
    pub worst_share: f64,
    /// The largest such fraction since the last call of [`Telemetry::load`].
    pub recent_share: f64,
}

impl Telemetry {
    /// The processing load of the audio thread. Meant for one reader, since it resets the recent share.
    pub fn load(&self) -> Load {
        let (busy, period) = (self.busy_nanos.load(Relaxed), self.period_nanos.load(Relaxed));
        Load {
            frames: self.frames(),
            blocks: self.blocks.load(Relaxed),
            late_blocks: self.late_blocks.load(Relaxed),
            mean_share: busy as f64 / period.max(1) as f64,
            worst_share: self.worst_share.load().into(),
            recent_share: self.recent_share.take().into(),
        }
    }

    /// Frames played.
    pub fn frames(&self) -> u64 {
        self.frames.load(Relaxed)
    }

    /// The largest absolute samples, left and right, since the last call; 1 is full scale. Meant for one reader.
    pub fn take_peaks(&self) -> [f32; 2] {
        self.peaks.each_ref().map(AtomicF32::take)
    }

    /// The voices and masses that sound. The audio thread publishes them, and the [`Telemetry::scope`], only for a second
    /// after each call.
    pub fn snapshot(&self) -> Snapshot {
        self.wanted.store(SNAPSHOTS_PER_LOOK, Relaxed);
        let mut snapshot = Snapshot { voices: self.voices.load(Relaxed), ..Snapshot::default() };
        for (mass, [displacement, energy]) in snapshot.masses.iter_mut().zip(&self.masses.0) {
            (mass.displacement, mass.energy) = (displacement.load(), energy.load());
        }
        snapshot
    }

    /// The keys that are down on a MIDI channel, one bit each.
    pub fn keys(&self, channel: u8) -> u128 {
        let [low, high] = &self.keys[usize::from(nearest_channel(channel))];
        u128::from(low.load(Relaxed)) | u128::from(high.load(Relaxed)) << 64
    }

    /// The program that was last selected on a MIDI channel; none if there was no program change.
    pub fn program(&self, channel: u8) -> Option<u8> {
        let stored = self.programs[usize::from(nearest_channel(channel))].load(Relaxed);
        stored.checked_sub(1).map(|program| program as u8)
    }

    /// The last frames of the sound.
    pub fn scope(&self) -> &Scope {
        &self.scope
    }

    /// Whether nothing sounds.
    pub fn is_silent(&self) -> bool {
        !self.sounding.load(Relaxed)
    }
}

/// The audio thread's side of a [`Telemetry`]: there should be one. All but [`TelemetryWriter::new`] is real-time safe.
pub struct TelemetryWriter {
    telemetry: Arc<Telemetry>,
    sample_rate: f64,
    frames_to_snapshot: f64,
}

impl TelemetryWriter {
    /// A writer to `telemetry`, at a sample rate in Hz.
    pub fn new(telemetry: Arc<Telemetry>, sample_rate: f64) -> Self {
        Self { telemetry, sample_rate, frames_to_snapshot: 0.0 }
    }

    /// Records an event that the engine receives: keys that go down and up, and program changes.
    pub fn note_event(&self, event: &Event) {
        let channel = usize::from(nearest_channel(event.channel));
        let keys = &self.telemetry.keys[channel];
        match event.kind {
            EventKind::NoteOn { key, .. } | EventKind::Strike { key, .. } => {
                let key = nearest_key(key);
                keys[usize::from(key >> 6)].fetch_or(1 << (key & 63), Relaxed);
            }
            EventKind::NoteOff { key, .. } => {
                let key = nearest_key(key);
                keys[usize::from(key >> 6)].fetch_and(!(1 << (key & 63)), Relaxed);
            }
            EventKind::Release { notes, .. } | EventKind::Silence { notes } => self.lift(notes),
            EventKind::Control { controller: ALL_SOUND_OFF | ALL_NOTES_OFF..=127, .. } => {
                keys.iter().for_each(|half| half.store(0, Relaxed));
            }
            EventKind::Program(number) => self.telemetry.programs[channel].store(u16::from(number) + 1, Relaxed),
            _ => {}
        }
    }

    /// Records that no key is down, as after a reset.
    pub fn release_keys(&self) {
        self.lift(Notes::default());
    }

    /// The keys of these notes are up.
    fn lift(&self, Notes { id, channel, key }: Notes) {
        if id.is_some() && key.is_none() {
            return;
        }
        let all = self.telemetry.keys.iter().enumerate();
        for (_, keys) in all.filter(|(number, _)| channel.is_none_or(|channel| usize::from(channel) == *number)) {
            match key.map(nearest_key) {
                Some(key) => drop(keys[usize::from(key >> 6)].fetch_and(!(1 << (key & 63)), Relaxed)),
                None => keys.iter().for_each(|half| half.store(0, Relaxed)),
            }
        }
    }

    /// Whether somebody has looked during the last second. If not, [`TelemetryWriter::note_sound`] need not be called.
    pub fn is_watched(&self) -> bool {
        self.telemetry.wanted.load(Relaxed) > 0
    }

    /// Records the peaks of rendered frames, and whether the engine is silent after them. While somebody looks, it records
    /// the frames for the scope too, and calls `snapshot` 40 times a second.
    pub fn note_sound(&mut self, left: &[f32], right: &[f32], is_silent: bool, snapshot: impl FnOnce() -> Snapshot) {
        let telemetry = &*self.telemetry;
        for (kept, samples) in telemetry.peaks.iter().zip([left, right]) {
            kept.raise_to(samples.iter().fold(0.0, |peak, sample| peak.max(sample.abs())));
        }
        telemetry.sounding.store(!is_silent, Relaxed);
        self.frames_to_snapshot -= left.len() as f64;
        let wanted = telemetry.wanted.load(Relaxed);
        if wanted == 0 {
            return;
        }
        telemetry.scope.write(left, right);
        if self.frames_to_snapshot > 0.0 {
            return;
        }
        telemetry.wanted.store(wanted - 1, Relaxed);
        self.frames_to_snapshot = self.sample_rate / SNAPSHOT_RATE;
        let snapshot = snapshot();
        telemetry.voices.store(snapshot.voices, Relaxed);
        for (mass, [displacement, energy]) in snapshot.masses.iter().zip(&telemetry.masses.0) {
            displacement.store(mass.displacement);
            energy.store(mass.energy);
        }
    }

    /// Records that a block of `frames` frames was processed, and how long that took.
    pub fn note_block(&self, frames: usize, busy: Duration) {
        let telemetry = &*self.telemetry;
        let period = Duration::from_secs_f64(frames as f64 / self.sample_rate);
        telemetry.frames.fetch_add(frames as u64, Relaxed);
        telemetry.blocks.fetch_add(1, Relaxed);
        telemetry.busy_nanos.fetch_add(busy.as_nanos() as u64, Relaxed);
        telemetry.period_nanos.fetch_add(period.as_nanos() as u64, Relaxed);
        telemetry.late_blocks.fetch_add((busy > period).into(), Relaxed);
        let share = (busy.as_secs_f64() / period.as_secs_f64().max(1e-9)) as f32;
        telemetry.worst_share.raise_to(share);
        telemetry.recent_share.raise_to(share);
    }
}

/// Displacement and energy of each mass.
struct Masses([[AtomicF32; 2]; MAX_MODES]);

impl Default for Masses {
    /// At rest.
    fn default() -> Self {
        Self(std::array::from_fn(|_| Default::default()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn telemetry(sample_rate: f64) -> (Arc<Telemetry>, TelemetryWriter) {
        let telemetry = Arc::new(Telemetry::default());
        (telemetry.clone(), TelemetryWriter::new(telemetry, sample_rate))
    }

    #[test]
    fn load_is_a_share_of_the_period() {
        let (telemetry, writer) = telemetry(48_000.0);
        let ms = Duration::from_millis;
        [1, 12, 2].into_iter().for_each(|busy| writer.note_block(480, ms(busy)));
        let load = telemetry.load();
        assert_eq!((load.frames, load.blocks, load.late_blocks), (1440, 3, 1));
        assert!((load.mean_share - 0.5).abs() < 1e-6 && (load.worst_share - 1.2).abs() < 1e-6, "{load:?}");
        writer.note_block(480, ms(2));
        assert!((telemetry.load().recent_share - 0.2).abs() < 1e-6, "the recent worst is forgotten once it was told");
    }

    #[test]
    fn keys_and_programs_are_kept_by_channel() {
        let (telemetry, writer) = telemetry(48_000.0);
        let tell = |kind| writer.note_event(&Event { frame: 0, channel: 3, kind });
        [0, 63, 64, 127]
            .into_iter()
            .for_each(|key| tell(EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None }));
        tell(EventKind::NoteOff { key: 63, velocity: 0.5, id: None });
        assert_eq!(telemetry.keys(3), 1 | 1 << 64 | 1 << 127);
        assert_eq!((telemetry.keys(2), telemetry.program(3)), (0, None));
        for number in [7, 0, 255] {
            tell(EventKind::Program(number));
            assert_eq!(telemetry.program(3), Some(number));
        }
        let notes = Notes { id: None, channel: Some(3), key: Some(64) };
        tell(EventKind::Release { notes, velocity: 0.5 });
        assert_eq!(telemetry.keys(3), 1 | 1 << 127);
        tell(EventKind::Silence { notes: Notes { key: Some(0), channel: Some(4), id: None } });
        assert_eq!(telemetry.keys(3), 1 | 1 << 127, "of another channel");
        tell(EventKind::Control { controller: ALL_NOTES_OFF, value: 0.0 });
        assert_eq!(telemetry.keys(3), 0);
        tell(EventKind::NoteOn { key: 5, detune: 0.0, velocity: 1.0, id: None });
        writer.release_keys();
        assert_eq!(telemetry.keys(3), 0);
    }

    #[test]
    fn peaks_and_masses_are_those_of_the_sound_and_only_while_somebody_looks() {
        let (telemetry, mut writer) = telemetry(4_000.0);
        assert!(telemetry.is_silent());
        let mut moved = Snapshot { voices: 2, ..Snapshot::default() };
        moved.masses[63].displacement = -0.5;
        moved.masses[63].energy = 0.25;
        writer.note_sound(&[0.25, -0.5], &[0.0, 0.125], false, || unreachable!("nobody looks"));
        assert_eq!((telemetry.take_peaks(), telemetry.take_peaks()), ([0.5, 0.125], [0.0, 0.0]));
        assert_eq!((telemetry.snapshot(), telemetry.is_silent()), (Snapshot::default(), false));
        writer.note_sound(&[0.0; 2], &[0.0; 2], false, || moved);
        assert_eq!(telemetry.snapshot(), moved);
        writer.note_sound(&[0.0; 99], &[0.0; 99], true, || unreachable!("within a fortieth of a second"));
        assert!(telemetry.is_silent());
        writer.note_sound(&[0.0; 1], &[0.0; 1], true, Snapshot::default);
        assert_eq!(telemetry.snapshot(), Snapshot::default());
    }
}
