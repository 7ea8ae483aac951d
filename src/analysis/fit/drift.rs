//! The drift of a held sound: what the tracks of its tones have in common, in pitch and in level.
//!
//! Players and slow oscillators move all tones of a sound alike, while beats move each tone in its own way. So each
//! tone's track is measured, and what is common to all is their mean, in which a tone counts the less, the more it
//! differs from the others. Without the drift, the sound is a sum of modes.

use super::movement::Oscillator;
use super::oscillators;
use super::pitch_track::Point;
use super::prepared::SLOW;
use super::resample::Reader;
use super::tones::{HOP, Tone, tones};
use crate::analysis::line::Line;
use crate::analysis::log_mel::RATE;
use crate::dsp::pitch::SweepEnvelope;
use crate::error::Result;
use libm::exp;
use std::f64::consts::{LN_2, LN_10};

/// Times that the drift is measured. What the first one leaves is smaller, so that higher tones can be followed.
const ROUNDS: usize = 3;
/// Times that the weights of the tones are estimated.
const WEIGHINGS: usize = 8;
/// Fewest tones among which one can be told to differ from the others.
const FEWEST: usize = 3;
/// Seconds at the beginning in which the tones of a sound that starts at once may rise, each in its own way.
const ATTACK: f64 = 0.12;
/// Weight of the moments in which a sound rises, so that they do not affect what is measured after them.
const RISING: f64 = 1e-4;
/// Largest logarithm by which the level of a rising sound is raised: 20 dB.
const MOST_RAISED: f64 = 2.3;

/// How many times as long a sound may become without its drift.
const MOST_LONGER: usize = 2;
/// Least depth of a tremolo in dB.
const LEAST_TREMOLO_DB: f64 = 0.2;

/// The drift at moments that are [`HOP`] samples apart.
#[derive(Debug)]
pub(super) struct Drift {
    /// Logarithm of the pitch relative to its mean.
    pitch: Vec<f64>,
    /// Logarithm of the level relative to a steady decay.
    level: Vec<f64>,
    /// Number of moments in which the sound comes to its level, and whether all tones do so together.
    rise: usize,
    rises: bool,
}

impl Drift {
    /// The drift of samples at [`RATE`] from their onset on, which come to their level in `rise` seconds; none if they have no
    /// tones.
    pub(super) fn of(samples: &[f32], rise: f64) -> Option<Self> {
        let moments = samples.len() / HOP + 1;
        let attack = rise.max(ATTACK) * f64::from(RATE) / HOP as f64;
        let still = vec![0.0; moments];
        let mut drift = Self { pitch: still.clone(), level: still, rise: attack as usize, rises: rise > SLOW };
        for _ in 0..ROUNDS {
            let still = drift.removed_from(samples);
            let tones = tones(&still);
            if tones.is_empty() {
                return None;
            }
            drift.add(&tones);
        }
        Some(drift)
    }

    /// The pitch in semitones relative to its mean.
    pub(super) fn pitches(&self) -> Vec<Point> {
        let time = |n: usize| (n * HOP) as f64 / f64::from(RATE);
        self.pitch.iter().enumerate().map(|(n, pitch)| [time(n), 12.0 / LN_2 * pitch, 1.0]).collect()
    }

    /// The tremolo that explains the level best, if it explains most of it.
    pub(super) fn tremolo(&self, tell: &mut dyn FnMut() -> bool) -> Result<Option<Oscillator>> {
        let point = |n: usize| [(n * HOP) as f64 / f64::from(RATE), 20.0 / LN_10 * self.level[n], 1.0];
        let found = oscillators::tremolo((self.rise..self.level.len()).map(point).collect(), tell)?;
        Ok(found.filter(|tremolo| tremolo.db.abs() > LEAST_TREMOLO_DB))
    }

    /// The drift of a sound of some samples that oscillators and a sweep move.
    pub(super) fn by(oscillators: &[Oscillator], envelope: SweepEnvelope, samples: usize) -> Self {
        let sum = |n: usize, depth: fn(&Oscillator) -> f64| {
            let time = (n * HOP) as f64 / f64::from(RATE);
            oscillators.iter().map(|oscillator| depth(oscillator) * oscillator.at(time)).sum::<f64>()
        };
        let swept = |n: usize| envelope.at((n * HOP) as f64 / f64::from(RATE));
        let moments = 0..samples / HOP + 1;
        Self {
            pitch: moments
                .clone()
                .map(|n| LN_2 / 12.0 * (sum(n, |oscillator| oscillator.semitones) + swept(n)))
                .collect(),
            level: moments.map(|n| LN_10 / 20.0 * sum(n, |oscillator| oscillator.db)).collect(),
            rise: 0,
            rises: false,
        }
    }

    /// Adds the drift of tones.
    fn add(&mut self, tones: &[Tone]) {
        let [pitch, level] = self.left_in(tones);
        // Moments of the still sound are a little off those of the sound, but the drift is slow.
        let add = |sum: &mut [f64], more: &[f64]| {
            sum.iter_mut().enumerate().for_each(|(n, sum)| *sum += more[n.min(more.len() - 1)]);
        };
        add(&mut self.pitch, &pitch);
        add(&mut self.level, &level);
        let mean = self.pitch.iter().sum::<f64>() / self.pitch.len() as f64;
        self.pitch.iter_mut().for_each(|pitch| *pitch -= mean);
    }

    /// The pitch and the level that tones have in common.
    fn left_in(&self, tones: &[Tone]) -> [Vec<f64>; 2] {
        let rise = self.rise;
        let rising = |mut track: Vec<[f64; 2]>| {
            track.iter_mut().take(rise).for_each(|[_, weight]| *weight *= RISING);
            track
        };
        let [pitches, levels] =
            [Tone::pitches, Tone::levels].map(|of| tones.iter().map(of).map(rising).collect::<Vec<_>>());
        let (mut pitch, mut level) = (common(&pitches, rise, false), common(&levels, rise, true));
        let hold = |track: &mut [f64], until: usize| {
            let value = track.get(until).copied().unwrap_or(0.0);
            track.iter_mut().take(until).for_each(|before| *before = value);
        };
        hold(&mut pitch, rise);
        let quiet = level.iter().take(rise).rposition(|level| *level < -MOST_RAISED).map_or(0, |last| last + 1);
        hold(&mut level, if self.rises { quiet } else { rise });
        [pitch, level]
    }

    /// The value of a track, `time` samples after the onset.
    fn at(track: &[f64], time: f64) -> f64 {
        let place = (time / HOP as f64).clamp(0.0, (track.len() - 1) as f64);
        let (before, part) = (place as usize, place.fract());
        let after = (before + 1).min(track.len() - 1);
        track[before] + part * (track[after] - track[before])
    }

    /// Samples at [`RATE`] without the drift.
    pub(super) fn removed_from(&self, samples: &[f32]) -> Vec<f32> {
        let reader = Reader::new(samples);
        let (mut time, mut still) = (0.0, Vec::with_capacity(samples.len()));
        // A deep fall of the pitch would make it far longer.
        while time < samples.len() as f64 && still.len() < MOST_LONGER * samples.len() {
            still.push((reader.at(time) * exp(-Self::at(&self.level, time))) as f32);
            time += exp(-Self::at(&self.pitch, time));
        }
        still
    }
}

/// What tracks have in common: each is a list of values with weights, and apart from what is common has a constant value,
/// or if they `fall`, a line. In the first moments, until `rise`, more than that may be common.
fn common(tracks: &[Vec<[f64; 2]>], rise: usize, fall: bool) -> Vec<f64> {
    let moments = tracks.iter().map(Vec::len).min().unwrap_or(0);
    let mut common = vec![0.0; moments];
    // The mean square of what each track has of its own, without the influence of the track on the mean.
    let mut own = vec![1.0; tracks.len()];
    let mut own_lines = vec![[0.0; 2]; tracks.len()];
    for round in 0..WEIGHINGS {
        for (track, line) in tracks.iter().zip(&mut own_lines) {
            *line = line_through(track, &common, fall);
        }
        let off = |track: &[[f64; 2]], line: &[f64; 2], n: usize| track[n][0] - line[0] - line[1] * n as f64;
        let mut squares = vec![[0.0, 1e-30]; tracks.len()];
        for n in 0..moments {
            let weigh = |tone: usize| {
                let rest = off(&tracks[tone], &own_lines[tone], n) - common[n];
                let far = if round == 0 { 0.0 } else { rest * rest / (4.0 * own[tone]) };
                tracks[tone][n][1] / (own[tone] * (1.0 + far))
            };
            let weights: Vec<f64> = (0..tracks.len()).map(weigh).collect();
            let (sum, all) = weights.iter().enumerate().fold((0.0, 1e-12), |(sum, all), (tone, weight)| {
                (sum + weight * off(&tracks[tone], &own_lines[tone], n), all + weight)
            });
            common[n] = sum / all;
            for (tone, weight) in weights.iter().enumerate() {
                let value = off(&tracks[tone], &own_lines[tone], n);
                let others = if all - weight > 1e-9 * all { (sum - weight * value) / (all - weight) } else { value };
                squares[tone][0] += tracks[tone][n][1] * (value - others) * (value - others);
                squares[tone][1] += tracks[tone][n][1];
            }
        }
        if tracks.len() >= FEWEST {
            own = squares.iter().map(|[square, weight]| (square / weight).max(1e-14)).collect();
        }
    }
    // The mean of what each track has of its own is not 0. Keep the share that is more than that (Wiener 1949).
    let by_chance = if tracks.len() >= FEWEST { 1.0 / own.iter().map(|own| 1.0 / own).sum::<f64>() } else { 0.0 };
    // What is constant, or falls steadily, belongs to the tracks.
    let points: Vec<[f64; 2]> =
        common.iter().enumerate().map(|(n, value)| [*value, if n < rise { RISING } else { 1.0 }]).collect();
    let line = line_through(&points, &vec![0.0; moments], fall);
    common.iter_mut().enumerate().for_each(|(n, value)| *value -= line[0] + line[1] * n as f64);
    let later = &common[rise.min(moments)..];
    let square = later.iter().map(|value| value * value).sum::<f64>() / later.len().max(1) as f64;
    let share = (1.0 - by_chance / square.max(1e-30)).max(0.0);
    common.iter_mut().skip(rise).for_each(|value| *value *= share);
    common
}

/// The line through a track without what is common, as its value at the first moment and its change per moment.
fn line_through(track: &[[f64; 2]], common: &[f64], fall: bool) -> [f64; 2] {
    let points = track.iter().zip(common).enumerate();
    let line = Line::through(points.map(|(n, ([value, weight], common))| [n as f64, value - common, *weight]));
    line.map_or([0.0; 2], |line| if fall { [line.at(0.0), line.slope] } else { [line.y, 0.0] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::uniform;
    use libm::{sin, sqrt};
    use std::f64::consts::TAU;

    const SECONDS: f64 = 3.0;

    /// Semitones and the logarithm of the level at a time.
    fn moved(t: f64) -> [f64; 2] {
        [0.03 * sin(TAU * 4.0 * t) + 0.02 * sin(TAU * 1.3 * t), 0.2 * sin(TAU * 6.0 * t + 1.0)]
    }

    /// Eight harmonics of pairs, which beat at rates of their own, with the drift of [`moved`].
    fn sound() -> Vec<f32> {
        let mut turn = 0.0;
        let mut sample = |n: usize| {
            let t = n as f64 / f64::from(RATE);
            let [pitch, level] = moved(t);
            turn += TAU * 200.0 * libm::exp2(pitch / 12.0) / f64::from(RATE);
            let harmonic = |h: f64| (sin(h * turn) + 0.1 * sin(h * turn + TAU * (0.5 + 0.37 * h) * t + h)) / h;
            (0.1 * exp(level) * (1..=8).map(|h| harmonic(f64::from(h))).sum::<f64>()) as f32
        };
        (0..(SECONDS * f64::from(RATE)) as usize).map(&mut sample).collect()
    }

    #[test]
    fn the_drift_of_beating_tones_is_what_they_have_in_common() {
        let drift = Drift::of(&sound(), 0.0).unwrap();
        let places: Vec<usize> = (drift.rise..drift.pitch.len() - drift.rise).collect();
        let rms = |value: &dyn Fn(usize) -> f64| {
            sqrt(places.iter().map(|n| value(*n) * value(*n)).sum::<f64>() / places.len() as f64)
        };
        let at = |n: usize| moved((n * HOP) as f64 / f64::from(RATE));
        let pitches = drift.pitches();
        let (moves, off) = (rms(&|n| at(n)[0]), rms(&|n| pitches[n][1] - at(n)[0]));
        assert!(off < 0.2 * moves, "{off} of {moves} semitones");
        let tremolo = drift.tremolo(&mut || true).unwrap().unwrap();
        let depth = 20.0 / LN_10 * 0.2;
        let is_found = (tremolo.rate - 6.0).abs() < 0.1
            && (tremolo.db - depth).abs() < 0.25 * depth
            && (tremolo.phase - 1.0 / TAU).abs() < 0.08;
        assert!(is_found, "{tremolo:?}");
    }

    #[test]
    fn noise_has_no_tones_and_so_no_drift() {
        let noise: Vec<f32> = (0..RATE.into()).map(|n| 0.5 * uniform(1, n)).collect();
        assert!(Drift::of(&noise, 0.0).is_none_or(|drift| drift.tremolo(&mut || true).unwrap().is_none()));
        assert!(Drift::of(&[0.0; 8192], 0.0).is_none());
    }
}
