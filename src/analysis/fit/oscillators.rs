//! Finds the low-frequency oscillators that explain a regular movement of pitch and level, as of a telephone or a bird.

use super::draft::MOST_OSCILLATORS;
use super::movement::{Oscillator, Sweep};
use super::pitch_track::{self, Point};
use super::prepared::Prepared;
use crate::analysis::level::{dbfs, rms};
use crate::analysis::log_mel::RATE;
use crate::error::{Error, Result};
use crate::params::Shape;
use nalgebra::{DMatrix, DVector};

/// Phases per turn, and shapes that are tried with so many of them: most shapes are their own negative half a turn later.
const PHASES: f64 = 16.0;
const SHAPES: [(Shape, usize); 4] = [(Shape::Sine, 8), (Shape::Triangle, 8), (Shape::Square, 8), (Shape::Ramp, 16)];
/// Fastest oscillator of the engine in Hz, and fastest movement of tones, whose levels are measured through windows of 46 ms.
const FASTEST: f64 = 40.0;
const FASTEST_OF_TONES: f64 = 16.0;
/// Fewest cycles of the slowest oscillator, and step between rates, in cycles over the whole track.
const FEWEST_CYCLES: f64 = 1.5;
const STEP: f64 = 0.25;
/// Share of the squares left that an oscillator must explain, and that all must explain together.
const WORTH: f64 = 0.25;
const WORTH_ALL: f64 = 0.6;
/// Share of the squares below which no more oscillators are looked for.
const LITTLE: f64 = 0.01;
/// Share of an oscillator's square that must differ from what is explained already.
const DIFFERENT: f64 = 1e-3;
/// Rounds of the fine search, its first step as a share of a step of the coarse one, and its shrinkage per round.
const ROUNDS: usize = 14;
const FIRST: f64 = 0.5;
const SHRINKAGE: f64 = 0.75;
/// Added to the diagonal of the equations, so that they can be solved.
const RIDGE: f64 = 1e-9;
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

/// A track that is explained by a mean, oscillators, and perhaps a slope.
struct Track {
    points: Vec<Point>,
    has_slope: bool,
    /// Hz of the fastest oscillator.
    fastest: f64,
    oscillators: Vec<Oscillator>,
    /// The factors of the oscillators.
    factors: Vec<f64>,
    /// What is left of each value.
    rest: Vec<f64>,
    /// An orthonormal base of what is explained already.
    base: Vec<Vec<f64>>,
    /// Weighted squares of all that is not steady.
    squares: f64,
}

impl Track {
    /// A track that some oscillators move already.
    fn new(points: Vec<Point>, has_slope: bool, oscillators: Vec<Oscillator>) -> Self {
        let mut track = Self {
            points,
            has_slope,
            fastest: FASTEST,
            oscillators: Vec::new(),
            factors: Vec::new(),
            rest: Vec::new(),
            base: Vec::new(),
            squares: 0.0,
        };
        track.solve();
        track.squares = track.left();
        track.oscillators = oscillators;
        track.solve();
        track
    }

    /// Seconds from its first value to its last.
    fn seconds(&self) -> f64 {
        self.points.last().zip(self.points.first()).map_or(0.0, |(last, first)| last[0] - first[0])
    }

    /// Whether it has enough values, and these move by a least standard deviation.
    fn moves(&self, least: f64) -> bool {
        let weight: f64 = self.points.iter().map(|point| point[2]).sum();
        self.points.len() >= FEWEST && self.squares > least * least * weight
    }

    /// Weighted squares of what is left.
    fn left(&self) -> f64 {
        self.rest.iter().zip(&self.points).map(|(rest, point)| point[2] * rest * rest).sum()
    }

    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).zip(&self.points).map(|((a, b), point)| point[2] * a * b).sum()
    }

    fn values(&self, oscillator: &Oscillator) -> Vec<f64> {
        self.points.iter().map(|[time, ..]| oscillator.at(*time)).collect()
    }

    /// Solves for mean, slope and factors together.
    fn solve(&mut self) {
        let mut functions = vec![vec![1.0; self.points.len()]];
        if self.has_slope {
            functions.push(self.points.iter().map(|[time, ..]| *time).collect());
        }
        let steady = functions.len();
        functions.extend(self.oscillators.iter().map(|oscillator| self.values(oscillator)));
        let values: Vec<f64> = self.points.iter().map(|[_, value, _]| *value).collect();
        let matrix = DMatrix::from_fn(functions.len(), functions.len(), |row, column| {
            self.product(&functions[row], &functions[column]) + if row == column { RIDGE } else { 0.0 }
        });
        let right =
            DVector::from_iterator(functions.len(), functions.iter().map(|function| self.product(function, &values)));
        let factors = matrix.cholesky().map_or(DVector::zeros(functions.len()), |factors| factors.solve(&right));
        let explained =
            |n: usize| functions.iter().zip(factors.iter()).map(|(function, factor)| factor * function[n]).sum::<f64>();
        self.rest = (0..values.len()).map(|n| values[n] - explained(n)).collect();
        self.factors = factors.iter().skip(steady).copied().collect();
        self.base.clear();
        for mut function in functions {
            for base in &self.base {
                let share = self.product(&function, base);
                function.iter_mut().zip(base).for_each(|(value, base)| *value -= share * base);
            }
            let norm = libm::sqrt(self.product(&function, &function));
            if norm > RIDGE {
                function.iter_mut().for_each(|value| *value /= norm);
                self.base.push(function);
            }
        }
    }

    /// The squares that one more oscillator would explain.
    fn gain(&self, oscillator: &Oscillator) -> f64 {
        let values = self.values(oscillator);
        let along = self.product(&values, &self.rest);
        let known: f64 = self.base.iter().map(|base| self.product(&values, base)).map(|share| share * share).sum();
        let own = self.product(&values, &values) - known;
        if own > DIFFERENT * (own + known) { along * along / own } else { 0.0 }
    }

    /// Adds the oscillator that explains most of the rest, if that is worth it.
    fn add(&mut self, tell: &mut dyn FnMut() -> bool) -> Result<bool> {
        let seconds = self.seconds();
        let count = ((self.fastest * seconds - FEWEST_CYCLES) / STEP).max(0.0) as usize;
        let mut best: (f64, Option<Oscillator>) = (0.0, None);
        for rate in (0..count).map(|n| (FEWEST_CYCLES + STEP * n as f64) / seconds) {
            if !tell() {
                return Err(Error::Interrupted);
            }
            for (shape, phases) in SHAPES {
                for phase in (0..phases).map(|n| n as f64 / PHASES) {
                    let oscillator = Oscillator { shape, rate, phase, semitones: 0.0, db: 0.0 };
                    let gain = self.gain(&oscillator);
                    if gain > best.0 {
                        best = (gain, Some(oscillator));
                    }
                }
            }
        }
        let (mut gain, Some(mut oscillator)) = best else { return Ok(false) };
        let mut step = FIRST;
        for _ in 0..ROUNDS {
            for (faster, later) in [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step), (step, -step), (-step, step)]
            {
                let rate = (oscillator.rate + STEP * faster / seconds).min(self.fastest);
                let moved = Oscillator { rate, phase: oscillator.phase + 2.0 * later / PHASES, ..oscillator };
                let gained = self.gain(&moved);
                if gained > gain {
                    (gain, oscillator) = (gained, moved);
                }
            }
            step *= SHRINKAGE;
        }
        let is_worth = gain > WORTH * self.left();
        if is_worth {
            oscillator.phase -= libm::floor(oscillator.phase);
            self.oscillators.push(oscillator);
            self.solve();
        }
        Ok(is_worth)
    }

    /// Adds oscillators, and tells whether all of them explain most of the track.
    fn explain(&mut self, tell: &mut dyn FnMut() -> bool) -> Result<bool> {
        while self.oscillators.len() < MOST_OSCILLATORS && self.left() > LITTLE * self.squares && self.add(tell)? {}
        Ok(self.left() < (1.0 - WORTH_ALL) * self.squares)
    }
}

/// The oscillators that move a sound, and the sweep of its pitch beside them; none if they do not explain most of its movement.
/// `tell` is called often, and ends the search by returning `false`.
pub(super) fn find(take: &Prepared, tell: &mut dyn FnMut() -> bool) -> Result<(Vec<Oscillator>, Sweep)> {
    let pitches = pitch_track::pitches(&take.mean);
    let mut pitch = Track::new(pitches.clone(), false, Vec::new());
    let mut swept = Sweep::NONE;
    let of_pitch = if pitch.moves(LEAST_SEMITONES) && pitch.explain(tell)? {
        let left: Vec<Point> = pitches.iter().zip(&pitch.rest).map(|([time, ..], rest)| [*time, *rest, 1.0]).collect();
        let (sweep, _) = pitch_track::of_pitch(&left);
        if sweep.semitones != 0.0 {
            let envelope = sweep.envelope();
            let without = pitches.into_iter().map(|[time, pitch, weight]| [time, pitch - envelope.at(time), weight]);
            let mut again = Track::new(without.collect(), false, Vec::new());
            if again.explain(tell)? && again.left() < pitch.left() {
                (pitch, swept) = (again, Sweep { vibrato: Sweep::NONE.vibrato, ..sweep });
            }
        }
        pitch.oscillators.clone()
    } else {
        Vec::new()
    };
    let mut level = Track::new(levels(&take.mean), true, of_pitch.clone());
    let explained = level.moves(LEAST_DB) && level.explain(tell)?;
    let oscillators = if explained { level.oscillators.clone() } else { of_pitch.clone() };
    let oscillator = |(n, oscillator): (usize, Oscillator)| Oscillator {
        semitones: if n < of_pitch.len() { pitch.factors[n] } else { 0.0 },
        db: if explained { level.factors[n] } else { 0.0 },
        ..oscillator
    };
    let found: Vec<Oscillator> = oscillators.into_iter().enumerate().map(oscillator).collect();
    let sum = |depth: fn(&Oscillator) -> f64| found.iter().map(depth).map(f64::abs).sum::<f64>();
    let is_playable = sum(|found| found.semitones) < MOST_SEMITONES && sum(|found| found.db) < MOST_DB;
    Ok(if is_playable { (found, swept) } else { (Vec::new(), Sweep::NONE) })
}

/// The tremolo that explains a track of levels of tones in dB best, if it explains most of it. `tell` is called often, and ends the
/// search by returning `false`.
pub(super) fn tremolo(levels: Vec<Point>, tell: &mut dyn FnMut() -> bool) -> Result<Option<Oscillator>> {
    let mut level = Track { fastest: FASTEST_OF_TONES, ..Track::new(levels, true, Vec::new()) };
    let is_found = level.points.len() >= FEWEST && level.add(tell)? && level.left() < (1.0 - WORTH_ALL) * level.squares;
    let tremolo = level.oscillators.first().zip(level.factors.first());
    Ok(tremolo.filter(|_| is_found).map(|(oscillator, db)| Oscillator { db: *db, ..*oscillator }))
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
        let mut track = Track::new(points, true, Vec::new());
        assert!(track.explain(&mut || true).unwrap());
        assert_eq!(track.oscillators.len(), 2);
        for ((found, factor), known) in track.oscillators.iter().zip(&track.factors).zip(&known) {
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
    fn a_steady_fall_has_no_oscillator() {
        let points = (0..300).map(|n| [0.003 * f64::from(n), -0.1 * f64::from(n), 1.0]).collect();
        assert_eq!(tremolo(points, &mut || true).unwrap(), None);
    }
}
