//! Prepares a take: from its onset to its end or to where its key is let go, and what it is like.

use super::draft::longest_t60;
use super::release::Release;
use super::take::{BLOCK, LONGEST, Take};
use crate::analysis::level::{dbfs, mono, peak, rms};
use crate::analysis::log_mel::{RATE, onset};
use crate::error::{Error, Result};
use crate::io::sound_file::{Recording, resampled};

/// Shortest stretch in seconds that is fitted.
const SHORTEST: f64 = 0.03;
/// Lowest peak of a sound that is not silent: −80 dBFS.
const SILENCE: f64 = 1e-4;
/// Level relative to the loudest below which the sound is over: −64 dB.
const OVER: f64 = 6e-4;
/// Level relative to the loudest at which a sound has risen: −3 dB.
const RISEN: f64 = 0.7;
/// Rise in seconds above which a sound is not a stroke.
pub(super) const SLOW: f64 = 0.05;
/// Level relative to the loudest below which a sound is silent (−26 dB), and the number of blocks for which it must be
/// so. Beats fall as low, but not for as long.
const SILENT: f64 = 0.05;
const SILENT_BLOCKS: usize = 2;
/// Level relative to the loudest at which a sound begins again: −14 dB, since vowels differ by as much.
const AS_LOUD: f64 = 0.2;
/// Energy of the last third of a sound relative to the first, above which the sound does not decay: −3 dB, and −7 dB if it is
/// heard that its key is let go, since beats lower it.
const STEADY: f64 = 0.5;
const STEADY_IF_LET_GO: f64 = 0.2;
/// Seconds before a key is let go at which the part ends that is fitted.
const GUARD: f64 = 0.03;

const DOES_NOT_DECAY: &str =
    "the sound does not decay: expected something that is struck and rings; its slow movements are left out";
/// Seconds after the end of a sound in which a draft is heard, too.
const SILENCE_HEARD: f64 = 0.5;

/// Frames whose RMS is the level of a take: 50 ms.
pub(super) const LEVEL_FRAMES: usize = RATE as usize / 20;

/// A take with what follows after the part that is fitted.
pub(super) struct Ending {
    pub(super) channels: Vec<Vec<f32>>,
    /// The mean of the channels.
    pub(super) mean: Vec<f32>,
    pub(super) release: Release,
    /// As of [`Prepared`].
    silence: Vec<f32>,
}

/// A take at [`RATE`], from its onset to its end, or to where its key is let go.
pub(super) struct Prepared {
    pub(super) channels: Vec<Vec<f32>>,
    /// The mean of the channels.
    pub(super) mean: Vec<f32>,
    /// The mean of what is recorded after that, of a sound that ends by itself: silence, in which no draft should ring.
    pub(super) silence: Vec<f32>,
    pub(super) key: Option<f64>,
    /// 0–1.
    pub(super) velocity: f64,
    /// Rise time in seconds: about 0 for a struck sound.
    pub(super) rise: f64,
    /// Whether it sounds for as long as it is played.
    pub(super) is_held: bool,
    /// The end of the sound, if its key is let go in it.
    pub(super) ending: Option<Ending>,
    /// Doubts about it.
    pub(super) warnings: Vec<String>,
}

impl Prepared {
    /// Prepares a take, of which `excerpt` is the part to fit, times a gain.
    ///
    /// # Errors
    /// [`Error::Format`] for silence and sounds that are too short.
    pub(super) fn new(take: &Take, excerpt: &Recording, gain: f64) -> Result<Self> {
        let wrong = |message: &str| Err(Error::format(&take.name, message));
        let mut channels = resampled(excerpt, RATE)?.channels;
        channels.iter_mut().flatten().for_each(|sample| *sample *= gain as f32);
        let middle = mono(&channels);
        if peak(&middle) < SILENCE * gain {
            return wrong("it is silent, or a constant: expected a strike above −80 dBFS");
        }
        let onset = onset(&middle);
        let block = (BLOCK * f64::from(RATE)) as usize;
        let levels: Vec<f64> = middle[onset..].chunks(block).map(rms).collect();
        let loudest = levels.iter().copied().fold(0.0, f64::max);
        let blocks = levels.iter().rposition(|level| *level > OVER * loudest).map_or(0, |last| last + 1);
        let (over, longest) =
            ((onset + blocks * block).min(middle.len()), onset + (LONGEST * f64::from(RATE)) as usize);
        let end = over.min(longest);
        if ((end - onset) as f64) < SHORTEST * f64::from(RATE) {
            return wrong("it is shorter than 30 ms: expected a strike that rings");
        }
        let release = Release::of_held(&middle[onset..end]);
        let played = release.map_or(blocks, |release| release.frames() / block);
        let third = (played / 3).max(1);
        let energy = |levels: &[f64]| levels.iter().map(|level| level * level).sum::<f64>();
        let share = if release.is_some() { STEADY_IF_LET_GO } else { STEADY };
        let is_steady = played >= 9 && energy(&levels[played - third..played]) > share * energy(&levels[..third]);
        let rise = levels.iter().position(|level| *level > RISEN * loudest).unwrap_or(0) as f64 * BLOCK;
        let mut warnings = Vec::from_iter(is_steady.then(|| format!("{}: {DOES_NOT_DECAY}", take.name)));
        if let Some(time) = again(&levels, loudest) {
            let message = "it falls silent and sounds again";
            warnings.push(format!("{}: {message} {time:.2} s after its onset: expected a single stroke", take.name));
        } else if rise > SLOW {
            warnings
                .push(format!("{}: it comes to its level over {rise:.2} s: expected a stroke that rings", take.name));
        }
        if over > longest {
            warnings
                .push(format!("{}: it sounds for longer: the first {LONGEST} s from its onset are fitted", take.name));
        }
        let silent = (over + (SILENCE_HEARD * f64::from(RATE)) as usize).min(middle.len()).min(longest);
        let silence = middle[end..silent].to_vec();
        let channels: Vec<Vec<f32>> = channels.iter().map(|channel| channel[onset..end].to_vec()).collect();
        let mut prepared = Self {
            mean: mono(&channels),
            channels,
            silence,
            key: take.key,
            velocity: (take.velocity / 127.0).clamp(1.0 / 127.0, 1.0),
            rise,
            is_held: is_steady,
            ending: None,
            warnings,
        };
        if let Some(release) = release {
            prepared.end(release, release.seconds - GUARD);
        }
        Ok(prepared)
    }

    /// Ends the part that is fitted where the sound is damped, if its level shows a damper, and unless the part already ends where
    /// its key is let go.
    pub(super) fn end_at(&mut self, seconds: f64) {
        if let (None, Some(release)) = (&self.ending, Release::of_damped(&self.mean, seconds)) {
            self.end(release, seconds);
        }
    }

    /// The same take with other samples.
    pub(super) fn replaced(&self, channels: Vec<Vec<f32>>) -> Self {
        Self { mean: mono(&channels), channels, silence: Vec::new(), ending: None, warnings: Vec::new(), ..*self }
    }

    fn end(&mut self, release: Release, seconds: f64) {
        let len = ((seconds * f64::from(RATE)) as usize).min(self.mean.len());
        let head = |samples: &[f32]| samples[..len].to_vec();
        let channels = self.channels.iter().map(|channel| head(channel)).collect();
        let channels = std::mem::replace(&mut self.channels, channels);
        let head = head(&self.mean);
        let (mean, silence) = (std::mem::replace(&mut self.mean, head), std::mem::take(&mut self.silence));
        self.ending = Some(Ending { channels, mean, release, silence });
    }

    /// The same take as a sound that ends by itself, and not when its key is let go.
    pub(super) fn not_let_go(&self) -> Self {
        let silence = self.ending.as_ref().map_or(&self.silence, |ending| &ending.silence).clone();
        let says = |warning: &&String| !warning.ends_with(DOES_NOT_DECAY);
        let warnings = self.warnings.iter().filter(says).cloned().collect();
        Self { silence, is_held: false, warnings, ..self.replaced(self.whole().0.to_vec()) }
    }

    /// All of it, with what comes after its key is let go: its channels and their mean.
    pub(super) fn whole(&self) -> (&[Vec<f32>], &[f32]) {
        self.ending.as_ref().map_or((&self.channels, &self.mean), |ending| (&ending.channels, &ending.mean))
    }

    pub(super) fn peak(&self) -> f64 {
        peak(&self.mean)
    }

    /// Its length.
    pub(super) fn seconds(&self) -> f64 {
        self.mean.len() as f64 / f64::from(RATE)
    }

    /// The T60 in seconds with which it loses its first 20 dB, or as much of them as it does.
    pub(super) fn t60(&self) -> f64 {
        let levels: Vec<f64> = self.mean.chunks((BLOCK * f64::from(RATE)) as usize).map(rms).map(dbfs).collect();
        let first = (0..levels.len()).max_by(|a, b| levels[*a].total_cmp(&levels[*b])).unwrap_or(0);
        let falls = |n: usize| levels[first] - levels[n];
        let last = (first..levels.len()).find(|n| falls(*n) >= 20.0).unwrap_or(levels.len() - 1);
        // A sound that does not fall has the longest that a mode may have.
        (60.0 * BLOCK * (last - first).max(1) as f64 / falls(last).max(0.1)).min(longest_t60(false))
    }

    /// RMS of its first 50 ms.
    pub(super) fn level(&self) -> f64 {
        rms(&self.mean[..self.mean.len().min(LEVEL_FRAMES)])
    }
}

/// Seconds from the first level to where the sound begins again after a silence.
fn again(levels: &[f64], loudest: f64) -> Option<f64> {
    let first = levels.iter().position(|level| *level > AS_LOUD * loudest)?;
    let silent = |levels: &[f64]| levels.iter().all(|level| *level < SILENT * loudest);
    let gap = first + levels[first..].windows(SILENT_BLOCKS).position(silent)?;
    let next = gap + levels[gap..].iter().position(|level| *level > AS_LOUD * loudest)?;
    Some(next as f64 * BLOCK)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::take::{VELOCITY, excerpts};
    use super::*;
    use std::f64::consts::TAU;

    /// The take of a recording with one channel.
    pub(crate) fn prepared(samples: Vec<f32>, sample_rate: u32) -> Prepared {
        let recording =
            Recording { sample_rate, channels: vec![samples], encoding: String::new(), warnings: Vec::new() };
        let takes = [Take { name: "a.wav".to_owned(), recording, key: None, velocity: VELOCITY }];
        let (excerpts, gain) = excerpts(&takes).unwrap();
        Prepared::new(&takes[0], &excerpts[0], gain).unwrap()
    }

    fn samples(seconds: f64, rate: u32, at: impl Fn(f64) -> f64) -> Vec<f32> {
        (0..(seconds * f64::from(rate)) as usize).map(|n| at(n as f64 / f64::from(rate)) as f32).collect()
    }

    #[test]
    fn of_ten_minutes_no_more_is_kept_than_is_fitted() {
        const RATE_OF_FILE: u32 = 8000;
        let ringing = |t60: f64| move |t: f64| 0.1 + 0.5 * libm::exp(-6.9 * t / t60) * libm::sin(TAU * 440.0 * t);
        let long = prepared(samples(600.0, RATE_OF_FILE, ringing(100.0)), RATE_OF_FILE);
        assert_eq!(long.channels[0].len(), 12 * RATE as usize);
        assert_eq!(long.warnings, ["a.wav: it sounds for longer: the first 12 s from its onset are fitted"]);
        // Of a short strike followed by silence, only the strike is kept.
        let short = prepared(samples(600.0, RATE_OF_FILE, ringing(0.5)), RATE_OF_FILE);
        assert!((0.4..0.7).contains(&short.seconds()) && short.warnings.is_empty(), "{:?}", short.warnings);
    }

    #[test]
    fn the_first_twenty_decibels_tell_how_long_a_take_rings() {
        let of = |at: &dyn Fn(f64) -> f64| prepared(samples(2.0, RATE, at), RATE).t60();
        let ringing = |t: f64, t60: f64| libm::exp(-6.907_755 * t / t60) * libm::sin(TAU * 440.0 * t);
        let clear = of(&|t| 0.5 * ringing(t, 1.2));
        assert!((clear / 1.2 - 1.0).abs() < 0.1, "{clear}");
        // Neither a knock nor a hum changes that much.
        let mixed = of(&|t| 0.5 * ringing(t, 1.2) + 0.3 * ringing(1.7 * t, 0.05) + 0.005 * ringing(2.3 * t, 60.0));
        assert!((mixed / 1.2 - 1.0).abs() < 0.2, "{mixed}");
        assert!(of(&|t| 0.5 * libm::sin(TAU * 440.0 * t)) > 30.0);
    }

    #[test]
    fn silence_after_a_sound_is_kept_but_not_as_a_part_of_it() {
        let strike = |t: f64| if t < 0.4 { 0.5 * libm::exp(-6.9 * t / 0.3) * libm::sin(TAU * 440.0 * t) } else { 0.0 };
        let take = prepared(samples(2.0, RATE, strike), RATE);
        assert!((0.3..0.45).contains(&take.seconds()) && take.silence.len() == RATE as usize / 2, "{}", take.seconds());
        // A file that ends with its sound says nothing of what follows.
        assert!(prepared(samples(0.3, RATE, strike), RATE).silence.len() < RATE as usize / 50);
        let held =
            prepared(samples(2.0, RATE, |t| libm::exp(-69.0 * (t - 1.0).max(0.0)) * libm::sin(TAU * 440.0 * t)), RATE);
        assert!(held.ending.is_some() && held.silence.is_empty());
        let whole = held.not_let_go();
        assert!(whole.ending.is_none() && whole.mean == held.whole().1 && whole.mean.len() > held.mean.len());
        assert!(!whole.is_held && !whole.silence.is_empty() && held.warnings.len() == 1 && whole.warnings.is_empty());
    }

    /// Pulses of a voice through its first three formants (Peterson & Barney 1952), two vowels with a stop between them.
    fn speech() -> Vec<f32> {
        let vowels = [(0.0, [730.0, 1090.0, 2440.0]), (0.35, [270.0, 2290.0, 3010.0])];
        let mut sound = vec![0.0; (0.7 * f64::from(RATE)) as usize];
        for (start, formants) in vowels {
            let (mut phase, mut state) = (0.0, [[0.0; 2]; 3]);
            for n in 0..(0.25 * f64::from(RATE)) as usize {
                let t = n as f64 / f64::from(RATE);
                phase += (120.0 + 10.0 * libm::sin(TAU * 3.0 * t)) / f64::from(RATE);
                let envelope = libm::sin(0.5 * TAU * t / 0.25);
                let pulse = if phase >= 1.0 { envelope } else { 0.0 };
                phase = phase.fract();
                for (state, formant) in state.iter_mut().zip(formants) {
                    let radius = libm::exp(-0.5 * TAU * 80.0 / f64::from(RATE));
                    let turn = libm::cos(TAU * formant / f64::from(RATE));
                    let next = pulse + 2.0 * radius * turn * state[0] - radius * radius * state[1];
                    // The mouth radiates changes of the flow.
                    sound[(start * f64::from(RATE)) as usize + n] += 0.1 * (next - state[0]);
                    *state = [next, state[0]];
                }
            }
        }
        sound.into_iter().map(|sample: f64| sample as f32).collect()
    }

    #[test]
    fn speech_is_no_stroke_and_beats_are_one() {
        let warnings = prepared(speech(), RATE).warnings;
        let says = |warnings: &[String], words: &str| warnings.iter().any(|warning| warning.contains(words));
        assert!(says(&warnings, "s after its onset: expected a single stroke"), "{warnings:?}");
        let vowel = speech()[..(0.25 * f64::from(RATE)) as usize].to_vec();
        let warnings = prepared(vowel, RATE).warnings;
        assert!(says(&warnings, "it comes to its level over "), "{warnings:?}");
        let beats = samples(2.0, RATE, |t| {
            let pair = libm::sin(TAU * 440.0 * t) + libm::sin(TAU * 442.0 * t);
            0.2 * libm::exp(-6.9 * t / 3.0) * pair
        });
        assert_eq!(prepared(beats, RATE).warnings, [""; 0]);
    }
}
