//! Sounds to fit: presets that are played, and the fit itself.

use sprung::analysis::fit::{Fitted, Settings, Take, VELOCITY, fit};
use sprung::analysis::log_mel::{RATE, distance};
use sprung::engine::{Event, EventKind, Synth};
use sprung::io::sound_file::Recording;
use sprung::preset::Preset;
use sprung::units::mono_from_stereo;

/// Left and right.
pub(crate) type Stereo = [Vec<f32>; 2];

/// Seconds of a preset's note, which is held.
const SECONDS: usize = 4;

/// A note of a preset.
pub(crate) fn preset_at(preset: &Preset, key: u8) -> Stereo {
    let mut synth = Synth::new(RATE.into(), 0);
    synth.set_kit(&preset.kit());
    synth.reset();
    let [mut left, mut right] = [0, 1].map(|_| vec![0.0; SECONDS * RATE as usize]);
    let kind = EventKind::NoteOn { key, detune: 0.0, velocity: (VELOCITY / 127.0) as f32, id: None };
    synth.process(&[Event { frame: 0, channel: 0, kind }], &mut left, &mut right);
    [left, right]
}

/// The fit of a sound at [`RATE`].
pub(crate) fn fitted(sound: &Stereo, key: f64) -> sprung::Result<Fitted> {
    let recording =
        Recording { sample_rate: RATE, channels: sound.to_vec(), encoding: String::new(), warnings: Vec::new() };
    let take = Take { name: "sound".to_owned(), recording, key: Some(key), velocity: VELOCITY };
    fit(&[take], &Settings::default(), &mut |_| true)
}

/// Distance of the means of two sounds in dB.
pub(crate) fn log_mel_distance(first: &Stereo, second: &Stereo) -> f64 {
    let mean = |[left, right]: &Stereo| -> Vec<f32> {
        left.iter().zip(right).map(|(left, right)| mono_from_stereo(*left, *right)).collect()
    };
    distance(&mean(first), &mean(second))
}
