//! State that the audio thread publishes for a display: voices, levels, keys, and the processing load.

mod moved;
mod sounding;

use super::atomic::AtomicF32;
use super::event::{finite, unit};
use super::midi::controller::{ALL_NOTES_OFF, ALL_SOUND_OFF, RESET, WHEEL};
use super::note::{NoteId, nearest_channel, nearest_key};
use super::scope::Scope;
use super::{Event, EventKind, Notes, Snapshot};
use crate::dsp::mode_bank::MAX_MODES;
use moved::LastMoved;
pub use moved::Moved;
use sounding::Sounding;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU16, AtomicU32, AtomicU64};
use std::time::Duration;

/// How often per second the masses are published.
const SNAPSHOT_RATE: f64 = 40.0;

/// Number of snapshots that are published after the last call of [`Telemetry::snapshot`]: those of one second.
const SNAPSHOTS_PER_LOOK: u32 = 40;

/// State that the audio thread publishes through a [`TelemetryWriter`]. Any thread may read it at any time without
/// waiting. Each number is consistent, but two numbers may come from different blocks. All values of the sounding notes
/// come from the same block.
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
    lowered: AtomicF32,
    masses: Masses,
    sounding_notes: Sounding,
    keys: [[AtomicU64; 2]; 16],
    /// Number of the selected program plus 1; 0 for none.
    programs: [AtomicU16; 16],
    sounding: AtomicBool,
    moved: LastMoved,
    /// Where the pitch wheel and the modulation wheel of each channel stand.
    wheels: [[AtomicF32; 2]; 16],
    scope: Scope,
    /// Number of snapshots still to publish before the next call of [`Telemetry::snapshot`].
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
    pub(crate) fn frames(&self) -> u64 {
        self.frames.load(Relaxed)
    }

    /// The largest absolute samples, left and right, since the last call; 1 is full scale. Meant for one reader.
    pub fn take_peaks(&self) -> [f32; 2] {
        self.peaks.each_ref().map(AtomicF32::take)
    }

    /// The voices and masses that sound. The audio thread publishes them, and the [`Telemetry::scope`], only for one second
    /// after each call of this function.
    pub fn snapshot(&self) -> Snapshot {
        self.wanted.store(SNAPSHOTS_PER_LOOK, Relaxed);
        let (voices, notes) = (self.voices.load(Relaxed), self.sounding_notes.read());
        let lowered = self.lowered.load();
        let mut snapshot = Snapshot { voices, lowered, notes, ..Snapshot::default() };
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

    /// Number of movements of controllers, pitch wheel and pressure so far, and the last of them.
    pub fn moved(&self) -> (u64, Option<Moved>) {
        self.moved.read()
    }

    /// Where the pitch wheel (−1 to 1) and the modulation wheel (0–1) of a MIDI channel stand.
    pub fn wheels(&self, channel: u8) -> [f32; 2] {
        self.wheels[usize::from(nearest_channel(channel))].each_ref().map(AtomicF32::load)
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

/// The audio thread's side of a [`Telemetry`], which should have only one. All but [`TelemetryWriter::new`] is real-time safe.
pub struct TelemetryWriter {
    telemetry: Arc<Telemetry>,
    sample_rate: f64,
    frames_to_snapshot: f64,
    /// For each channel and key, the identifier of the note that last began there.
    ids: Box<[[Option<NoteId>; 128]; 16]>,
}

impl TelemetryWriter {
    /// A writer to `telemetry`, at a sample rate in Hz.
    pub fn new(telemetry: Arc<Telemetry>, sample_rate: f64) -> Self {
        Self { telemetry, sample_rate, frames_to_snapshot: 0.0, ids: Box::new([[None; 128]; 16]) }
    }

    /// Records an event that the engine receives: keys that go down and up, controllers that move, and program changes.
    pub fn note_event(&mut self, event: &Event) {
        self.telemetry.moved.note(&event.kind);
        let channel = usize::from(nearest_channel(event.channel));
        let (keys, wheels) = (&self.telemetry.keys[channel], &self.telemetry.wheels[channel]);
        let mut press = |key: u8, id: Option<NoteId>| {
            let key = nearest_key(key);
            keys[usize::from(key >> 6)].fetch_or(1 << (key & 63), Relaxed);
            self.ids[channel][usize::from(key)] = id;
        };
        match event.kind {
            EventKind::NoteOn { key, id, .. } => press(key, id),
            EventKind::Strike { key, .. } => press(key, None),
            EventKind::NoteOff { key, id, .. } => {
                self.lift(Notes { id, channel: Some(channel as u8), key: Some(key) });
            }
            EventKind::Release { notes, .. } | EventKind::Silence { notes } => self.lift(notes),
            EventKind::Control { controller: ALL_SOUND_OFF | ALL_NOTES_OFF..=127, .. } => {
                keys.iter().for_each(|half| half.store(0, Relaxed));
            }
            EventKind::PitchBend(bend) => wheels[0].store(finite(bend).clamp(-1.0, 1.0)),
            EventKind::Control { controller: WHEEL, value } => wheels[1].store(unit(value)),
            EventKind::Control { controller: RESET, .. } => rest(wheels),
            EventKind::Program(number) => self.telemetry.programs[channel].store(u16::from(number) + 1, Relaxed),
            _ => {}
        }
    }

    /// Records that no key is down and no wheel is moved, as after a reset.
    pub fn reset(&self) {
        self.lift(Notes::default());
        self.telemetry.wheels.iter().for_each(rest);
    }

    /// Marks the keys of these notes as up. With an identifier, a key stays down if another note has begun on it since.
    fn lift(&self, Notes { id, channel, key }: Notes) {
        let all = self.telemetry.keys.iter().zip(&*self.ids).enumerate();
        for (_, (keys, ids)) in all.filter(|(number, _)| channel.is_none_or(|channel| usize::from(channel) == *number))
        {
            match (key, id) {
                (Some(key), Some(_)) => {
                    let held = ids[usize::from(nearest_key(key))];
                    if held.is_none() || held == id {
                        lift_key(keys, key);
                    }
                }
                (Some(key), None) => lift_key(keys, key),
                (None, Some(_)) => {
                    (0..128).filter(|key| ids[usize::from(*key)] == id).for_each(|key| lift_key(keys, key));
                }
                (None, None) => keys.iter().for_each(|half| half.store(0, Relaxed)),
            }
        }
    }

    /// Whether a snapshot was read during the last second. If not, [`TelemetryWriter::note_sound`] need not be called.
    pub fn is_watched(&self) -> bool {
        self.telemetry.wanted.load(Relaxed) > 0
    }

    /// Records the peaks of rendered frames, and whether the engine is silent after them. While snapshots are being read, it
    /// also records the frames for the scope, and calls `snapshot` 40 times a second.
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
        telemetry.lowered.store(snapshot.lowered);
        telemetry.sounding_notes.write(&snapshot.notes);
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

/// Marks the wheels of a channel as not moved.
fn rest(wheels: &[AtomicF32; 2]) {
    wheels.iter().for_each(|wheel| wheel.store(0.0));
}

/// Marks a key of a channel as up.
fn lift_key(keys: &[AtomicU64; 2], key: u8) {
    let key = nearest_key(key);
    keys[usize::from(key >> 6)].fetch_and(!(1 << (key & 63)), Relaxed);
}

impl Default for Masses {
    /// At rest.
    fn default() -> Self {
        Self(std::array::from_fn(|_| Default::default()))
    }
}

#[cfg(test)]
mod tests;
