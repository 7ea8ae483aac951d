//! Sounds to fit: presets that are played, and the fit itself.

use sprung::analysis::fit::{Family, Fitted, Settings, Take, VELOCITY, fit};
use sprung::analysis::log_mel::{RATE, distance};
use sprung::engine::{Event, EventKind, Synth};
use sprung::io::sound_file::Recording;
use sprung::preset::Preset;
use sprung::units::mono_from_stereo;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The result of a test: any error fails it.
pub(crate) type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Left and right.
pub(crate) type Stereo = [Vec<f32>; 2];

/// Seconds of a preset's note, which is held.
const SECONDS: usize = 4;

/// A note of a preset at the velocity that takes have by default.
pub(crate) fn preset_at(preset: &Preset, key: u8) -> Stereo {
    preset_struck(preset, key, VELOCITY as u8)
}

/// As [`preset_at`], with the noise of another seed.
pub(crate) fn preset_of_seed(preset: &Preset, key: u8, seed: u64) -> Stereo {
    played(preset, key, VELOCITY as u8, seed)
}

/// A note of a preset.
pub(crate) fn preset_struck(preset: &Preset, key: u8, velocity: u8) -> Stereo {
    played(preset, key, velocity, 0)
}

fn played(preset: &Preset, key: u8, velocity: u8, seed: u64) -> Stereo {
    played_until(preset, key, velocity, seed, None, SECONDS as f64)
}

/// `seconds` of a note of a preset whose key is let go after some seconds, or is held.
pub(crate) fn preset_let_go(preset: &Preset, key: u8, let_go: Option<f64>, seconds: f64) -> Stereo {
    played_until(preset, key, VELOCITY as u8, 0, let_go, seconds)
}

fn played_until(preset: &Preset, key: u8, velocity: u8, seed: u64, let_go: Option<f64>, seconds: f64) -> Stereo {
    let mut synth = Synth::new(RATE.into(), seed);
    synth.set_kit(&preset.kit());
    synth.reset();
    let [mut left, mut right] = [0, 1].map(|_| vec![0.0; (seconds * f64::from(RATE)) as usize]);
    let kind = EventKind::NoteOn { key, detune: 0.0, velocity: f32::from(velocity) / 127.0, id: None };
    let off = EventKind::NoteOff { key, velocity: 0.5, id: None };
    let event = |frame: u32, kind| Event { frame, channel: 0, kind };
    let let_go = let_go.map(|seconds| event((seconds * f64::from(RATE)) as u32, off));
    let events: Vec<Event> = std::iter::once(event(0, kind)).chain(let_go).collect();
    synth.process(&events, &mut left, &mut right);
    [left, right]
}

fn recording(sound: &Stereo) -> Recording {
    Recording { sample_rate: RATE, channels: sound.to_vec(), encoding: String::new(), warnings: Vec::new() }
}

/// The fit of a sound at [`RATE`].
pub(crate) fn fitted(sound: &Stereo, key: f64) -> sprung::Result<Fitted> {
    fitted_while(sound, key, &mut |_| true)
}

/// The fit of a sound at [`RATE`], unless `progress` ends it.
pub(crate) fn fitted_while(sound: &Stereo, key: f64, progress: &mut dyn FnMut(f64) -> bool) -> sprung::Result<Fitted> {
    fitted_by(sound, key, Family::Table, progress)
}

/// The fit of a sound at [`RATE`] by a body, unless `progress` ends it.
pub(crate) fn fitted_by(
    sound: &Stereo,
    key: f64,
    family: Family,
    progress: &mut dyn FnMut(f64) -> bool,
) -> sprung::Result<Fitted> {
    fit(&[take(sound, key)], &Settings { family, ..Settings::default() }, progress)
}

fn take(sound: &Stereo, key: f64) -> Take {
    Take { name: "sound".to_owned(), recording: recording(sound), key: Some(key), velocity: VELOCITY }
}

/// A note of an instrument.
pub(crate) struct Played {
    pub(crate) sound: Stereo,
    pub(crate) key: u8,
    pub(crate) velocity: u8,
}

/// The fit of several notes of an instrument.
pub(crate) fn fitted_to(notes: &[Played]) -> sprung::Result<Fitted> {
    let take = |Played { sound, key, velocity }: &Played| Take {
        name: format!("key {key}, velocity {velocity}"),
        recording: recording(sound),
        key: Some((*key).into()),
        velocity: (*velocity).into(),
    };
    fit(&notes.iter().map(take).collect::<Vec<_>>(), &Settings::default(), &mut |_| true)
}

/// The mean of both channels.
pub(crate) fn mean([left, right]: &Stereo) -> Vec<f32> {
    left.iter().zip(right).map(|(left, right)| mono_from_stereo(*left, *right)).collect()
}

/// Distance of the means of two sounds in dB.
pub(crate) fn log_mel_distance(first: &Stereo, second: &Stereo) -> f64 {
    distance(&mean(first), &mean(second))
}

/// Applies a function to each item, on all processors, and returns the results in the order of the items.
pub(crate) fn in_parallel<'a, T: Sync, R: Send>(items: &'a [T], make: impl Fn(&'a T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut made = Vec::new();
        while let Some((index, item)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|n| Some((n, items.get(n)?)))
        {
            made.push((index, make(item)));
        }
        made
    };
    let mut all: Vec<(usize, R)> = std::thread::scope(|scope| {
        let count = std::thread::available_parallelism().map_or(1, usize::from);
        let threads: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    all.sort_by_key(|(index, _)| *index);
    all.into_iter().map(|(_, made)| made).collect()
}
