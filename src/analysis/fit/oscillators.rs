//! Finds the low-frequency oscillators that explain a regular movement of pitch and level, as of a telephone or a bird.

use super::draft::MOST_OSCILLATORS;
use super::movement::{Oscillator, Sweep};
use super::pitch_track::{self, Point};
use super::prepared::Prepared;
use super::simplex;
use crate::analysis::level::{dbfs, rms};
use crate::analysis::line::Line;
use crate::analysis::log_mel::RATE;
use crate::error::{Error, Result};
use crate::params::Shape;

/// Phases per turn, and shapes that are tried with so many of them: most shapes are their own negative half a turn later.
const PHASES: f64 = 16.0;
const SHAPES: [(Shape, usize); 4] = [(Shape::Sine, 8), (Shape::Triangle, 8), (Shape::Square, 8), (Shape::Ramp, 16)];
/// Fastest oscillator of the engine in Hz, and fastest movement of tones, whose levels are measured through windows of 46 ms.
const FASTEST: f64 = 40.0;
const FASTEST_OF_TONES: f64 = 16.0;
/// Fewest cycles of the slowest oscillator, and step between rates, in cycles over the whole track.
const FEWEST_CYCLES: f64 = 1.5;
const STEP: f64 = 0.25;
/// Steps of the fine search.
const STEPS: usize = 30;
/// Share of the squares left that an oscillator must explain, that all must explain together, and below which no more are looked for.
const WORTH: f64 = 0.25;
const WORTH_ALL: f64 = 0.6;
const LITTLE: f64 = 0.01;
/// Share of an oscillator's square that must differ from its mean.
const DIFFERENT: f64 = 1e-3;
/// Samples from one level to the next, and range of levels in dB.
const HOP: usize = 128;
const RANGE_DB: f64 = 45.0;
/// Least standard deviations of the level in dB and of the pitch in semitones at which they move, and fewest values of a track.
const LEAST_DB: f64 = 1.0;
const LEAST_SEMITONES: f64 = 0.02;
const FEWEST: usize = 100;
/// Largest sum of the depths in semitones and in dB that the engine plays: the range of its tune, and half that of its gain.
const MOST_SEMITONES: f64 = 48.0;
const MOST_DB: f64 = 36.0;

/// A track that is explained by its mean, or a line if it may fall, and by oscillators, each found in what the earlier ones leave.
struct Track {
    /// What is left of each value.
    rest: Vec<Point>,
    /// Oscillators, each with its depth in the track's unit.
    found: Vec<(Oscillator, f64)>,
    /// Weighted squares of all that is not steady.
    squares: f64,
}

impl Track {
    /// Values without their mean, or the line through them if they may fall.
    fn new(mut points: Vec<Point>, falls: bool) -> Self {
        if let Some(line) = Line::through(points.iter().copied()) {
            let line = if falls { line } else { Line { slope: 0.0, ..line } };
            points.iter_mut().for_each(|[time, value, _]| *value -= line.at(*time));
        }
        let mut track = Self { rest: points, found: Vec::new(), squares: 0.0 };
        track.squares = track.left();
        track
    }

    /// Whether it has enough values, and these move by a least standard deviation.
    fn moves(&self, least: f64) -> bool {
        let weight: f64 = self.rest.iter().map(|point| point[2]).sum();
        self.rest.len() >= FEWEST && self.squares > least * least * weight
    }

    /// Weighted squares of what is left.
    fn left(&self) -> f64 {
        self.rest.iter().map(|[_, rest, weight]| weight * rest * rest).sum()
    }

    /// The mean of an oscillator, its depth that explains most of what is left, and how much of the squares that is.
    fn depth(&self, oscillator: &Oscillator) -> [f64; 3] {
        let mut sums = [0.0; 5];
        for [time, rest, weight] in &self.rest {
            let value = oscillator.at(*time);
            let more = [1.0, value, value * value, *rest, value * rest];
            sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += weight * more);
        }
        let [all, value, square, rest, product] = sums;
        let (along, own) = (product - value * rest / all, square - value * value / all);
        // Where a square is heard in one half of its cycles only, it is constant, and what is left of it are errors of rounding.
        if own.is_nan() || own <= DIFFERENT * square {
            return [0.0; 3];
        }
        [value / all, along / own, along * along / own]
    }

    /// Takes an oscillator out of what is left.
    fn take(&mut self, mut oscillator: Oscillator) {
        let [mean, depth, _] = self.depth(&oscillator);
        self.rest.iter_mut().for_each(|[time, rest, _]| *rest -= depth * (oscillator.at(*time) - mean));
        oscillator.phase -= libm::floor(oscillator.phase);
        self.found.push((oscillator, depth));
    }

    /// Adds the oscillator that explains most of the rest, if that is worth it.
    fn add(&mut self, fastest: f64, tell: &mut dyn FnMut() -> bool) -> Result<bool> {
        let Some(seconds) = self.rest.last().zip(self.rest.first()).map(|(last, first)| last[0] - first[0]) else {
            return Ok(false);
        };
        let count = ((fastest * seconds - FEWEST_CYCLES) / STEP).max(0.0) as usize;
        let mut best: (f64, Option<Oscillator>) = (0.0, None);
        for rate in (0..count).map(|n| (FEWEST_CYCLES + STEP * n as f64) / seconds) {
            if !tell() {
                return Err(Error::Interrupted);
            }
            for (shape, phases) in SHAPES {
                for phase in (0..phases).map(|n| n as f64 / PHASES) {
                    let oscillator = Oscillator { shape, rate, phase, semitones: 0.0, db: 0.0 };
                    let [.., gain] = self.depth(&oscillator);
                    if gain > best.0 {
                        best = (gain, Some(oscillator));
                    }
                }
            }
        }
        let (_, Some(coarse)) = best else { return Ok(false) };
        let moved = |[faster, later]: [f64; 2]| Oscillator {
            rate: (coarse.rate + 2.0 * STEP * faster / seconds).clamp(FEWEST_CYCLES / seconds, fastest),
            phase: coarse.phase + 2.0 * later / PHASES,
            ..coarse
        };
        let (place, gain) = simplex::least(STEPS, |place| Ok(-self.depth(&moved(place))[2]))?;
        let is_worth = -gain > WORTH * self.left();
        if is_worth {
            self.take(moved(place));
        }
        Ok(is_worth)
    }

    /// Takes out what is `known`, adds oscillators, and tells whether all of them explain most of the track.
    fn explain(&mut self, known: &[(Oscillator, f64)], tell: &mut dyn FnMut() -> bool) -> Result<bool> {
        known.iter().for_each(|(oscillator, _)| self.take(*oscillator));
        while self.found.len() < MOST_OSCILLATORS && self.left() > LITTLE * self.squares && self.add(FASTEST, tell)? {}
        Ok(self.left() < (1.0 - WORTH_ALL) * self.squares)
    }
}

/// The oscillators that move a sound, and the sweep of its pitch beside them; none if they do not explain most of its movement.
/// `tell` is called often, and ends the search by returning `false`.
pub(super) fn find(take: &Prepared, tell: &mut dyn FnMut() -> bool) -> Result<(Vec<Oscillator>, Sweep)> {
    let pitches = pitch_track::pitches(&take.mean);
    let mut pitch = Track::new(pitches.clone(), false);
    let mut swept = Sweep::NONE;
    if pitch.moves(LEAST_SEMITONES) && pitch.explain(&[], tell)? {
        let left: Vec<Point> = pitch.rest.iter().map(|[time, rest, _]| [*time, *rest, 1.0]).collect();
        let (sweep, _) = pitch_track::of_pitch(&left);
        if sweep.semitones != 0.0 {
            let envelope = sweep.envelope();
            let without = pitches.into_iter().map(|[time, pitch, weight]| [time, pitch - envelope.at(time), weight]);
            let mut again = Track::new(without.collect(), false);
            if again.explain(&[], tell)? && again.left() < pitch.left() {
                (pitch, swept) = (again, Sweep { vibrato: Sweep::NONE.vibrato, ..sweep });
            }
        }
    } else {
        pitch.found.clear();
    }
    let mut level = Track::new(levels(&take.mean), true);
    if !level.moves(LEAST_DB) || !level.explain(&pitch.found, tell)? {
        level.found.clear();
    }
    // The level's begin with the pitch's, if there are any.
    let all = if level.found.is_empty() { &pitch.found } else { &level.found };
    let depth = |track: &Track, n: usize| track.found.get(n).map_or(0.0, |(_, depth)| *depth);
    let oscillator = |(n, (oscillator, _)): (usize, &(Oscillator, f64))| Oscillator {
        semitones: depth(&pitch, n),
        db: depth(&level, n),
        ..*oscillator
    };
    let found: Vec<Oscillator> = all.iter().enumerate().map(oscillator).collect();
    let sum = |depth: fn(&Oscillator) -> f64| found.iter().map(depth).map(f64::abs).sum::<f64>();
    let is_playable = sum(|found| found.semitones) < MOST_SEMITONES && sum(|found| found.db) < MOST_DB;
    Ok(if is_playable { (found, swept) } else { (Vec::new(), Sweep::NONE) })
}

/// The tremolo that explains a track of levels of tones in dB best, if it explains most of it. `tell` is called often, and ends the
/// search by returning `false`.
pub(super) fn tremolo(levels: Vec<Point>, tell: &mut dyn FnMut() -> bool) -> Result<Option<Oscillator>> {
    let mut level = Track::new(levels, true);
    let is_found = level.rest.len() >= FEWEST
        && level.add(FASTEST_OF_TONES, tell)?
        && level.left() < (1.0 - WORTH_ALL) * level.squares;
    Ok(level.found.pop().filter(|_| is_found).map(|(oscillator, db)| Oscillator { db, ..oscillator }))
}

/// The levels of samples in dB, from their onset on.
fn levels(samples: &[f32]) -> Vec<Point> {
    let level = |n: usize| {
        let middle = n * HOP;
        dbfs(rms(&samples[middle.saturating_sub(HOP)..(middle + HOP).min(samples.len())]))
    };
    let levels: Vec<f64> = (0..samples.len().div_ceil(HOP)).map(level).collect();
    let floor = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max) - RANGE_DB;
    let point = |(n, level): (usize, f64)| [(n * HOP) as f64 / f64::from(RATE), level.max(floor), 1.0];
    levels.into_iter().enumerate().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::super::audition::{Audition, Played};
    use super::super::correct;
    use super::super::draft::{Draft, Partial};
    use super::super::prepared::tests::prepared;
    use super::*;

    #[test]
    fn oscillators_of_all_shapes_are_found() {
        let known = [
            Oscillator { shape: Shape::Square, rate: 1.3, phase: 0.2, semitones: 0.0, db: 9.0 },
            Oscillator { shape: Shape::Ramp, rate: 11.0, phase: 0.7, semitones: 0.0, db: -5.0 },
        ];
        let value = |t: f64| -20.0 - 3.0 * t + known.iter().map(|known| known.db * known.at(t)).sum::<f64>();
        let points = (0..800).map(|n| 0.0025 * f64::from(n)).map(|t| [t, value(t), 1.0]).collect();
        let mut track = Track::new(points, true);
        assert!(track.explain(&[], &mut || true).unwrap());
        assert_eq!(track.found.len(), 2);
        for ((found, factor), known) in track.found.iter().zip(&known) {
            let off = libm::remainder(found.phase - known.phase, 1.0).abs();
            let is_near = found.shape == known.shape && (found.rate / known.rate - 1.0).abs() < 0.02 && off < 0.03;
            assert!(is_near && (factor / known.db - 1.0).abs() < 0.1, "{found:?} {factor}, {known:?}");
        }
    }

    #[test]
    fn what_a_draft_plays_is_found_again() {
        let known = [
            Oscillator { shape: Shape::Triangle, rate: 4.0, phase: 0.3, semitones: 1.5, db: 0.0 },
            Oscillator { shape: Shape::Sine, rate: 1.9, phase: 0.0, semitones: 0.0, db: 6.0 },
        ];
        let partial = Partial { frequency: 880.0, t60: 60.0, amplitude: 0.1, phase: 0.0, pan: 0.0, struck: true };
        let draft = Draft {
            partials: vec![partial],
            oscillators: known.to_vec(),
            is_held: true,
            ..correct::tests::draft([0.0; 2])
        };
        let note = Played { key: 69.0, velocity: draft.velocity, frames: 2 * RATE as usize, let_go: None };
        let samples = Audition::new().mean(&draft.patch(), note);
        let (found, _) = find(&prepared(samples, RATE), &mut || true).unwrap();
        let near = |known: &Oscillator| {
            found.iter().any(|found| {
                let off = libm::remainder(found.phase - known.phase, 1.0).abs();
                let depths = [found.semitones - known.semitones, 0.25 * (found.db - known.db)];
                let is_near = found.shape == known.shape && (found.rate / known.rate - 1.0).abs() < 0.02 && off < 0.04;
                is_near && depths.iter().all(|depth| depth.abs() < 0.15)
            })
        };
        assert!(known.iter().all(near), "{found:?}");
    }

    #[test]
    fn a_square_that_is_heard_in_half_of_its_cycles_explains_nothing() {
        let heard = (0..400).map(|n| 0.0025 * f64::from(n)).filter(|t| (10.0 * t).fract() < 0.45);
        let track = Track::new(heard.map(|t| [t, libm::sin(37.0 * t), 1.0]).collect(), false);
        let square = Oscillator { shape: Shape::Square, rate: 10.0, phase: 0.0, semitones: 0.0, db: 0.0 };
        assert_eq!(track.depth(&square), [0.0; 3]);
    }

    #[test]
    fn a_steady_fall_has_no_oscillator() {
        let points = (0..300).map(|n| [0.003 * f64::from(n), -0.1 * f64::from(n), 1.0]).collect();
        assert_eq!(tremolo(points, &mut || true).unwrap(), None);
    }
}
