//! Renders notes of presets and measures them.

use sprung::engine::{Event, Synth};
use sprung::internals::measures::spectrum::{Spectrum, peaks, spectrum};
use sprung::preset::Preset;
use sprung::sound::Kit;
use sprung::units::mono_from_stereo;
use std::sync::Arc;

pub(crate) const RATE: f64 = 48_000.0;

/// A note-on with this velocity, from 1 to 127, or a note-off if there is none.
pub(crate) fn event(seconds: f64, key: u8, velocity: Option<f32>) -> Event {
    let frame = (seconds * RATE) as u32;
    match velocity {
        Some(velocity) => Event::note_on(frame, key, velocity / 127.0),
        None => Event::note_off(frame, key),
    }
}

/// The mean of both channels of a note struck with `velocity`, 1–127, and held for `held` seconds.
pub(crate) fn note(preset: &Preset, key: u8, velocity: f32, held: f64, seconds: f64) -> Vec<f32> {
    note_of(&preset.kit(), key, velocity, held, seconds)
}

/// The same of a kit, which takes a while to make if it is blown.
pub(crate) fn note_of(kit: &Arc<Kit>, key: u8, velocity: f32, held: f64, seconds: f64) -> Vec<f32> {
    let mut synth = Synth::new(RATE, 1);
    synth.set_kit(kit);
    synth.reset();
    let [mut left, mut right] = [0, 1].map(|_| vec![0.0; (seconds * RATE) as usize]);
    let events = [event(0.0, key, Some(velocity)), event(held, key, None)];
    synth.process(&events[..if held < seconds { 2 } else { 1 }], &mut left, &mut right);
    left.iter().zip(&right).map(|(left, right)| mono_from_stereo(*left, *right)).collect()
}

/// The spectrum of half a second from `start` seconds on, under a window that is highest at its start.
pub(crate) fn spectrum_from(sound: &[f32], start: f64) -> Spectrum {
    let (start, half) = ((start * RATE) as usize, (0.5 * RATE) as usize);
    let mut samples = vec![0.0; half];
    samples.extend_from_slice(&sound[start.min(sound.len())..(start + half).min(sound.len())]);
    samples.resize(2 * half, 0.0);
    spectrum(&samples, RATE)
}

/// The strongest partial within a ratio of a frequency in Hz.
pub(crate) fn partial_near(spectrum: &Spectrum, frequency: f64, ratio: f64) -> Option<f64> {
    let found = peaks(spectrum, -110.0);
    found.iter().map(|peak| peak.frequency).find(|found| *found < frequency * ratio && *found > frequency / ratio)
}

/// Seconds until the remaining energy (backward integration, Schroeder 1965) has fallen by `db`, and the T60 measured from −5 to
/// −25 dB.
pub(crate) fn decay(sound: &[f32], db: f64) -> (f64, f64) {
    let mut left: Vec<f64> = sound.iter().map(|sample| f64::from(*sample) * f64::from(*sample)).collect();
    for n in (0..left.len() - 1).rev() {
        left[n] += left[n + 1];
    }
    let falls_to = |db: f64| left.partition_point(|energy| *energy > left[0] * libm::exp10(db / 10.0)) as f64 / RATE;
    (falls_to(-db), 3.0 * (falls_to(-25.0) - falls_to(-5.0)))
}

/// Energy from one time in seconds to another.
pub(crate) fn energy(sound: &[f32], from: f64, to: f64) -> f64 {
    let place = |seconds: f64| ((seconds * RATE) as usize).min(sound.len());
    sound[place(from)..place(to)].iter().map(|sample| f64::from(*sample) * f64::from(*sample)).sum()
}
