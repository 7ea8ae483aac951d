//! Measures a preset, from notes that it plays, and compares the values with wanted ranges.

use super::held;
use super::octaves::{CENTRES, octaves};
use super::recordings::{self, Recording};
use super::{
    DRUMS, TUNED, attack_flatness, difference, from_onset, high_share, motion, partials, samples, timbre_change,
};
use crate::analysis::level::mono;
use crate::analysis::log_mel::RATE;
use crate::engine::{Event, EventKind, Notes, Synth};
use crate::error::{Error, Result};
use crate::params::Param;
use crate::preset::{Family, Preset};
use crate::sound::Kit;
use crate::units::{db_from_gain, frequency_from_key, note_name};
use ebur128::{EbuR128, Mode};
use libm::{fabs, log};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// The name of [`high_share`] among the figures.
const HIGH_SHARE: &str = "energy above 2 kHz";

/// Tag of sounds that are no acoustic instrument: noise, motion and several partials are not required of them.
pub const SYNTHESIS: &str = "synthesis";

/// Tags of sounds that last as long as their key is held. All bowed and blown sounds, leads, pads and drones do so
/// without a tag.
const SUSTAINED: [&str; 4] = ["organ", "reed", "voice", "bow"];

/// Largest distance from the values of recordings: of a T60, as a factor, and of the high share, in dB.
const T60_FACTOR: f64 = 1.6;
const HIGH_SHARE_DB: f64 = 10.0;

/// Octaves fainter than this, in dB, are not compared, since in recordings they contain room and hum.
const FAINT_DB: f64 = -30.0;

/// A sound in stereo at [`RATE`].
pub(crate) type Stereo = [Vec<f32>; 2];

/// One measure of a preset.
#[derive(Clone, Debug)]
pub struct Measure {
    /// What is measured.
    pub name: &'static str,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    /// The value; none if the sound is too short for it.
    pub value: Option<f64>,
    /// The wanted range; none if any value is right.
    pub wanted: Option<RangeInclusive<f64>>,
    /// Where it was measured, or with what it was compared; may be empty.
    pub note: String,
}

impl Measure {
    /// Whether the value is in the wanted range.
    pub fn is_kept(&self) -> bool {
        self.value.zip(self.wanted.as_ref()).is_none_or(|(value, wanted)| wanted.contains(&value))
    }
}

/// Plays the notes of a preset that are measured.
struct Player {
    kit: Arc<Kit>,
}

impl Player {
    /// Plays notes that begin after `start` seconds and are held for `held` seconds; the sound lasts `seconds` in all.
    /// With `before`, another note is played and silenced first, so that the notes get other random numbers.
    fn play(&self, keys: &[u8], velocity: u8, [start, held, seconds]: [f64; 3], before: bool) -> Stereo {
        let mut synth = Synth::new(RATE.into(), 0);
        synth.set_kit(&self.kit);
        synth.reset();
        let frame = |seconds: f64| samples(seconds) as u32;
        let on = |seconds, key, velocity: u8| Event::note_on(frame(seconds), key, f32::from(velocity) / 127.0);
        let mut events = Vec::new();
        if before {
            let key = keys.first().map_or(60, |key| if *key < 120 { key + 6 } else { key - 6 });
            let silence = EventKind::Silence { notes: Notes::default() };
            events.extend([on(0.0, key, 1), Event { frame: frame(0.01), channel: 0, kind: silence }]);
        }
        events.extend(keys.iter().map(|key| on(start, *key, velocity)));
        let off = |key: &u8| Event::note_off(frame(start + held), *key);
        events.extend(keys.iter().map(off).filter(|off| (off.frame as usize) < samples(seconds)));
        let [mut left, mut right] = [0, 1].map(|_| vec![0.0; samples(seconds)]);
        synth.process(&events, &mut left, &mut right);
        [left, right]
    }

    fn note(&self, key: u8, velocity: u8, held: f64, seconds: f64) -> Stereo {
        self.play(&[key], velocity, [0.0, held, seconds], false)
    }
}

/// The loudest 400 ms in LUFS (ITU-R BS.1770); none if it is silent.
///
/// # Errors
/// [`Error::Value`] if the loudness meter fails.
pub(crate) fn loudest(sound: &Stereo) -> Result<Option<f64>> {
    let failed = |error: ebur128::Error| Error::value("loudness", error.to_string());
    let mut meter = EbuR128::new(2, RATE, Mode::M).map_err(failed)?;
    let (mut loudest, silence) = (f64::NEG_INFINITY, vec![0.0; samples(0.4)]);
    let step = samples(0.01);
    for (left, right) in sound[0].chunks(step).zip(sound[1].chunks(step)) {
        meter.add_frames_planar_f32(&[left, right]).map_err(failed)?;
        loudest = loudest.max(meter.loudness_momentary().map_err(failed)?);
    }
    // The meter covers a sound of less than 400 ms only once silence follows.
    if sound[0].len() < silence.len() {
        meter.add_frames_planar_f32(&[&silence[sound[0].len()..]; 2]).map_err(failed)?;
        loudest = loudest.max(meter.loudness_momentary().map_err(failed)?);
    }
    Ok(Some(loudest).filter(|loudest| loudest.is_finite()))
}

/// The true peak of a sound in dBFS.
fn true_peak(sound: &Stereo) -> Result<f64> {
    let failed = |error: ebur128::Error| Error::value("true peak", error.to_string());
    let mut meter = EbuR128::new(2, RATE, Mode::TRUE_PEAK).map_err(failed)?;
    meter.add_frames_planar_f32(&[&sound[0], &sound[1]]).map_err(failed)?;
    let peak = (0..2).map(|side| meter.true_peak(side)).collect::<std::result::Result<Vec<_>, _>>().map_err(failed)?;
    Ok(db_from_gain(peak.into_iter().fold(0.0, f64::max)))
}

/// Tag of drums that are played in tune, and measured like mallets.
const IN_TUNE: &str = "tuned";

/// Whether a preset is a drum or other percussion without a melody.
fn is_drum(preset: &Preset) -> bool {
    use Family::{Cymbal, HandDrum, Hat, Kick, Percussion, Snare, Tom};
    matches!(preset.guide.family, Some(Kick | Snare | Tom | Hat | Cymbal | HandDrum | Percussion))
        && preset.tags.iter().all(|tag| tag != IN_TUNE)
}

/// The wanted loudness of a preset in LUFS.
pub fn wanted_loudness(preset: &Preset) -> RangeInclusive<f64> {
    match preset.guide.family {
        Some(Family::Hat) => -30.5..=-26.5,
        // A click is shorter than the 400 ms over which loudness is measured.
        Some(Family::Percussion | Family::Effect) => -29.0..=-19.0,
        _ => -25.0..=-19.0,
    }
}

/// Whether a sound lasts as long as its key is held. Then it has neither contact nor decay that could be measured.
pub fn is_sustained(preset: &Preset) -> bool {
    use Family::{Bowed, Drone, Lead, Pad, Wind};
    matches!(preset.guide.family, Some(Bowed | Drone | Lead | Pad | Wind))
        || preset.tags.iter().any(|tag| SUSTAINED.contains(&tag.as_str()))
}

/// Seconds for which a sound is held to measure its loudness: some sounds swell.
fn seconds_held(preset: &Preset) -> f64 {
    use Family::{Drone, Effect, Pad};
    if matches!(preset.guide.family, Some(Drone | Effect | Pad)) { 4.0 } else { 1.0 }
}

/// The loudness of a preset: its loudest 400 ms at its home key and velocity 100, in LUFS.
///
/// # Errors
/// [`Error::Value`] if the loudness meter fails.
pub fn loudness(preset: &Preset) -> Result<Option<f64>> {
    let held = seconds_held(preset);
    loudest(&Player { kit: preset.kit() }.note(preset.guide.home, 100, held, held + 1.0))
}

/// Figures of one note of any sound, from its onset on: their names, units and values. Of a sound that lasts as long as its key is held,
/// with its pitch in hertz, also those of [`held`].
pub fn of_sound(sound: &[f32], held_at: Option<f64>) -> Vec<(&'static str, &'static str, Option<f64>)> {
    let mut figures = vec![
        ("attack flatness", "dB", Some(attack_flatness(sound))),
        (HIGH_SHARE, "dB", Some(high_share(sound))),
        ("motion", "dB", motion(sound)),
        ("partials", "", Some(partials(sound) as f64)),
    ];
    if let Some(pitch) = held_at {
        figures.extend([
            ("valleys between partials", "dB", held::valleys(sound, pitch)),
            ("entry of partials", "ms", held::entry(sound, pitch)),
            ("wobble at one rate", "times", held::regularity(sound, pitch)),
            ("change of colour", "octaves", held::colour(sound)),
        ]);
    }
    figures
}

/// Measures a preset. It takes about half a second.
///
/// # Errors
/// [`Error::Value`] if the loudness meter fails.
pub fn measure(preset: &Preset) -> Result<Vec<Measure>> {
    let player = Player { kit: preset.kit() };
    let (guide, recording) = (&preset.guide, recordings::of(&preset.name));
    let (drum, home) = (is_drum(preset), guide.home);
    let least = if drum { DRUMS } else { TUNED };
    let (is_free, sustained) = (preset.tags.iter().any(|tag| tag == SYNTHESIS), is_sustained(preset));
    let acoustic = |wanted: RangeInclusive<f64>| (!is_free).then_some(wanted);
    let struck = |wanted: RangeInclusive<f64>| (!is_free && !sustained).then_some(wanted);
    let new = |name, unit, value, wanted| Measure { name, unit, value, wanted, note: String::new() };
    let note = |velocity, seconds| mono(&player.note(home, velocity, seconds, seconds));

    let long = note(100, 4.0);
    let sound = from_onset(&long);
    let wanted = |name: &str| match name {
        "attack flatness" => struck(least.attack_flatness..=0.0),
        HIGH_SHARE => acoustic(least.high_share..=0.0),
        "motion" => struck(least.motion..=f64::INFINITY),
        "partials" => struck(least.partials as f64..=f64::INFINITY),
        _ => None,
    };
    let figures = of_sound(sound, sustained.then(|| frequency_from_key(home.into(), 440.0)));
    let mut all: Vec<Measure> =
        figures.into_iter().map(|(name, unit, value)| new(name, unit, value, wanted(name))).collect();
    if let Some(recording) = recording {
        let (from, to) = (recording.high_share.start() - HIGH_SHARE_DB, recording.high_share.end() + HIGH_SHARE_DB);
        for measure in all.iter_mut().filter(|measure| measure.name == HIGH_SHARE) {
            (measure.wanted, measure.note) = (Some(from..=to), recording.name.clone());
        }
        if !sustained {
            all.push(decay(sound, recording, (!drum).then_some(home)));
        }
    }
    let [soft, hard] = [40, 120].map(|velocity| note(velocity, 0.25));
    let change = timbre_change(from_onset(&soft), from_onset(&hard));
    all.push(new("timbre by velocity", "dB", Some(change), acoustic(1.8..=f64::INFINITY)));
    // Two strikes of noise differ completely, which is right for drums, and so do two during which a loose mass or an edge is met in
    // other phases. Only tuned sounds without them can differ too much.
    let differs = drum || preset.patch.get(Param::Rattle) > 0.0;
    let strikes = [false, true].map(|before| mono(&player.play(&[home], 100, [1.0, 0.5, 1.5], before)));
    let [first, second] = strikes.each_ref().map(|strike| &strike[samples(1.0)..]);
    let other = difference(first, second);
    all.push(new("repeated strike", "dB", Some(other), struck(-30.0..=if differs { 1.0 } else { -10.0 })));

    let held = seconds_held(preset);
    let loudness = loudest(&player.note(home, 100, held, held + 1.0))?;
    all.push(new("loudness", "LUFS", loudness, Some(wanted_loudness(preset))));
    all.push(range(&player, preset, loudness)?);
    let [limited, free] = chord_peaks(preset)?;
    all.push(new("chord’s true peak", "dBFS", Some(limited), Some(f64::NEG_INFINITY..=-0.2)));
    all.push(new("limiter on a chord", "dB", Some((free - limited).max(0.0)), Some(0.0..=6.0)));
    Ok(all)
}

/// The true peaks in dBFS of C4, E4, G4 and C5 struck together at full velocity: with the limiter, and without it.
///
/// # Errors
/// [`Error::Value`] if the meter fails.
pub fn chord_peaks(preset: &Preset) -> Result<[f64; 2]> {
    let peak = |limiter| {
        let patch = preset.patch.clone().with(Param::Limiter, limiter);
        let player = Player { kit: Preset { patch, ..preset.clone() }.kit() };
        true_peak(&player.play(&[60, 64, 67, 72], 127, [0.0, 1.0, 1.3], false))
    };
    Ok([peak(1.0)?, peak(0.0)?])
}

/// The spread of loudness over the range of keys.
fn range(player: &Player, preset: &Preset, home: Option<f64>) -> Result<Measure> {
    const STEPS: u8 = 4;
    let held = seconds_held(preset);
    let (lowest, highest) = (preset.guide.lowest, preset.guide.highest);
    let mut heard: Vec<(u8, f64)> = home.map(|loudness| (preset.guide.home, loudness)).into_iter().collect();
    for step in 0..=STEPS {
        let key = lowest + ((u16::from(highest - lowest) * u16::from(step)) / u16::from(STEPS)) as u8;
        heard.extend(loudest(&player.note(key, 100, held, held + 0.4))?.map(|loudness| (key, loudness)));
    }
    heard.sort_by(|a, b| a.1.total_cmp(&b.1));
    let ends = heard.first().zip(heard.last());
    let is_bar = preset.guide.family == Some(Family::Mallet);
    Ok(Measure {
        name: "loudness over keys",
        unit: "LU",
        value: ends.map(|(quietest, loudest)| loudest.1 - quietest.1),
        wanted: Some(0.0..=if is_bar { 6.0 } else { 12.0 }),
        note: ends.map_or(String::new(), |(quietest, loudest)| {
            format!("{} quietest, {} loudest", note_name(quietest.0), note_name(loudest.0))
        }),
    })
}

/// The T60 of the octave that differs most from a recording's, as a factor. `key` is the key of a tuned sound, whose
/// octaves below its pitch do not count.
fn decay(sound: &[f32], recording: &Recording, key: Option<u8>) -> Measure {
    let mut furthest = (1.0, 0);
    for (place, (octave, wanted)) in octaves(sound).iter().zip(&recording.t60).enumerate() {
        let is_below = key.is_some_and(|key| 1.42 * CENTRES[place] < 0.8 * frequency_from_key(f64::from(key), 440.0));
        let Some((t60, wanted)) = octave.t60.zip(wanted.as_ref()) else { continue };
        if octave.level < FAINT_DB || is_below {
            continue;
        }
        let factor = t60 / t60.clamp(*wanted.start(), *wanted.end());
        if fabs(log(factor)) > fabs(log(furthest.0)) {
            furthest = (factor, place);
        }
    }
    Measure {
        name: "T60 against a recording",
        unit: "times",
        value: Some(furthest.0),
        wanted: Some(1.0 / T60_FACTOR..=T60_FACTOR),
        note: format!("{} at {} Hz", recording.name, CENTRES[furthest.1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn init_is_pure_and_fails_where_it_should() {
        let measures = measure(Preset::find("init").unwrap()).unwrap();
        let of = |name: &str| measures.iter().find(|measure| measure.name == name).unwrap();
        assert!(of("partials").value == Some(1.0) && !of("partials").is_kept());
        assert!(of("repeated strike").value.unwrap() < -90.0 && !of("repeated strike").is_kept());
        assert!(of("loudness over keys").value.unwrap() > 0.0);
    }

    #[test]
    fn loudness_is_that_of_a_sine() {
        let sine = |n: usize| (libm::sin(2.0 * std::f64::consts::PI * 997.0 * n as f64 / f64::from(RATE))) as f32;
        let side: Vec<f32> = (0..samples(1.0)).map(|n| 0.1 * sine(n)).collect();
        // A sine of 0 dBFS in one channel is -3.01 LUFS, and in both 0 (ITU-R BS.1770).
        let loudness = loudest(&[side.clone(), side]).unwrap().unwrap();
        assert!((loudness + 20.0).abs() < 0.1, "{loudness}");
        assert_eq!(loudest(&[vec![0.0; 100], vec![0.0; 100]]).unwrap(), None);
    }
}
