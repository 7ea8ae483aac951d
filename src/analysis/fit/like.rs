//! Finds the presets that sound most like a recording, by the distance with which a fit is judged.

use super::audition::{Audition, Played};
use super::draft::Partial;
use super::pitch;
use crate::analysis::level::mono;
use crate::analysis::log_mel::{HOP, LogMel, MelBands, RATE, onset};
use crate::analysis::modes::{self, modes};
use crate::error::{Error, Result};
use crate::io::sound_file::{Recording, resampled};
use crate::params::Param;
use crate::preset::Preset;
use crate::units::{gain_from_db, key_from_frequency};

/// How many presets are worth a second look ([`Model::nearness`]), of those that are nearest at the first.
pub const LOOKED_AT: usize = 40;

/// Most seconds that are compared, and those of the first look.
const LONGEST: f64 = 3.0;
const FIRST_LOOK: f64 = 0.4;
/// Frames in which a played note begins.
const LATE: usize = RATE as usize / 10;
/// A4 in Hz with which a frequency becomes a key.
const A4: f64 = 440.0;
/// Velocity of the notes that are compared, as a fit has it for recordings that name none.
const VELOCITY: f64 = super::take::VELOCITY / 127.0;

/// A recording to compare presets with.
pub struct Model {
    bands: LogMel,
    frames: usize,
    /// The key that was recorded, as a fractional MIDI key; C4 if no pitch was found.
    pub key: f64,
    /// Whether a key was given or found.
    pub is_pitched: bool,
    /// Whether the key was estimated. Then it can be an octave off.
    is_estimated: bool,
}

/// How near a preset is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearness {
    /// Distance in dB ([`crate::analysis::log_mel::distance`]), after both were made equally loud.
    pub distance: f64,
    /// The key that it was played on.
    pub key: f64,
}

impl Model {
    /// A recording of a note of a key; if none is given, it is estimated from the modes of its first strike. `name` is used in errors.
    ///
    /// # Errors
    /// [`Error::Format`] for a recording that is silent or not finite.
    pub fn new(recording: &Recording, name: &str, key: Option<f64>) -> Result<Self> {
        recording.check_finite(name)?;
        let sound = mono(&resampled(recording, RATE)?.channels);
        let mut sound = sound[onset(&sound)..].to_vec();
        if sound.iter().all(|sample| *sample == 0.0) {
            return Err(Error::format(name, "it is silent: expected a sound"));
        }
        sound.truncate((LONGEST * f64::from(RATE)) as usize);
        let (is_estimated, key) = (key.is_none(), key.or_else(|| estimated(&sound)));
        let (is_pitched, key) = (key.is_some(), key.unwrap_or(60.0));
        Ok(Self { bands: MelBands::new().measure(&sound), frames: sound.len(), key, is_pitched, is_estimated })
    }

    /// The sound of a preset itself, on its home key.
    ///
    /// # Errors
    /// [`Error::Format`] for a preset that is silent there.
    pub fn of_preset(preset: &Preset) -> Result<Self> {
        let (key, frames) = (f64::from(preset.guide.home), (LONGEST * f64::from(RATE)) as usize);
        let note = Played { key, velocity: VELOCITY, frames: frames + LATE, let_go: None };
        let channels = vec![Audition::with_limiter().mean(&preset.patch, note)];
        let sound = Recording { sample_rate: RATE, channels, encoding: String::new(), warnings: Vec::new() };
        Self::new(&sound, &preset.name, Some(key))
    }

    /// How near a preset is at a first look: on the key that comes nearest of the recording's, that an octave higher or lower if it was
    /// estimated, and the preset's home. Not real-time safe.
    pub fn first_look(&self, preset: &Preset) -> Nearness {
        let home = f64::from(preset.guide.home);
        let octaves: &[f64] = if self.is_estimated { &[0.0, 12.0, -12.0] } else { &[0.0] };
        let follows = preset.patch.get(Param::KeyTrack) > 0.0;
        let own = octaves.iter().map(|octave| self.key + octave).filter(|key| follows && *key != home);
        let frames = self.frames.min((FIRST_LOOK * f64::from(RATE)) as usize);
        let all = own.chain([home]).map(|key| self.at(preset, key, frames));
        let none = Nearness { distance: f64::INFINITY, key: home };
        all.fold(none, |best, other| if other.distance < best.distance { other } else { best })
    }

    /// How near a preset is on a key, over all that is compared. Not real-time safe.
    pub fn nearness(&self, preset: &Preset, key: f64) -> Nearness {
        self.at(preset, key, self.frames)
    }

    fn at(&self, preset: &Preset, key: f64, frames: usize) -> Nearness {
        let count = frames.div_ceil(HOP).min(self.bands.columns.len());
        let wanted = LogMel { columns: self.bands.columns[..count].to_vec() };
        let note = Played { key, velocity: VELOCITY, frames: frames + LATE, let_go: None };
        let played = Audition::with_limiter().mean(&preset.patch, note);
        let start = onset(&played);
        let mut found = MelBands::new().measure(&played[start..(start + frames).min(played.len())]);
        let louder = wanted.loudest() - found.loudest();
        found.columns.iter_mut().flatten().for_each(|level| *level += louder);
        Nearness { distance: wanted.distance(&found), key }
    }
}

/// The key of a sound by its modes, if it has any.
fn estimated(sound: &[f32]) -> Option<f64> {
    let settings = modes::Settings { most_modes: 24, longest: 1.0, all_strikes: false };
    let found = modes(&[sound.to_vec()], RATE.into(), &settings, &mut |_| true);
    let strikes = found.map(|found| found.strikes).unwrap_or_default();
    let partial = |mode: &modes::Mode| {
        let amplitude = gain_from_db(mode.level_db);
        Partial { frequency: mode.frequency, t60: mode.t60, amplitude, phase: 0.0, pan: 0.0, struck: true }
    };
    let partials: Vec<Partial> =
        strikes.iter().flat_map(|strike| strike.modes.iter().chain(&strike.steady)).map(partial).collect();
    (!partials.is_empty()).then(|| key_from_frequency(pitch::estimate(&partials), A4))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(name: &str, key: f64, gain: f32) -> Recording {
        let patch = &Preset::find(name).unwrap().patch;
        let note = Played { key, velocity: 0.8, frames: RATE as usize, let_go: None };
        let mut sound = Audition::with_limiter().play(patch, note);
        sound.iter_mut().flatten().for_each(|sample| *sample *= gain);
        Recording { sample_rate: RATE, channels: sound.to_vec(), encoding: String::new(), warnings: vec![] }
    }

    #[test]
    fn a_preset_is_nearest_to_its_own_sound_however_loud() {
        for (name, key) in [("Marimba", 60.0), ("Church Bell", 55.0), ("Steel Guitar", 52.0)] {
            let model = Model::new(&recorded(name, key, 0.1), "sound", Some(key)).unwrap();
            let own = model.nearness(Preset::find(name).unwrap(), key);
            for other in ["Marimba", "Church Bell", "Steel Guitar", "Kick"].into_iter().filter(|other| *other != name) {
                let other = model.first_look(Preset::find(other).unwrap());
                assert!(
                    own.distance + 2.0 < other.distance && own.distance < 2.0,
                    "{name}: {} and {}",
                    own.distance,
                    other.distance
                );
            }
        }
        let marimba = Preset::find("Marimba").unwrap();
        let itself = Model::of_preset(marimba).unwrap().nearness(marimba, marimba.guide.home.into());
        assert!(itself.distance < 0.1, "{}", itself.distance);
        let guessed = Model::new(&recorded("Marimba", 60.0, 1.0), "sound", None).unwrap();
        assert!((guessed.key - 60.0).abs() < 0.1, "{}", guessed.key);
    }
}
