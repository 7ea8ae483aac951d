//! Follows the pitch of a sound over time, and finds the sweep and vibrato that explain it.
//!
//! The strongest partial is followed from moment to moment through spectra whose windows have the same number of cycles
//! at all frequencies. Its frequency is the rate at which its phase turns (reassignment: Auger & Flandrin 1995), which
//! is far more exact than the bandwidth of the window.

use super::movement::{Sweep, Vibrato};
use crate::analysis::log_mel::RATE;
use crate::dsp::pitch::SweepEnvelope;
use libm::{cos, exp, fabs, log2, pow, sin, sqrt};
use nalgebra::{Cholesky, SMatrix, SVector};
use std::f64::consts::{PI, TAU};

/// Seconds of the sound in which a sweep or vibrato is looked for, those for a regular movement, and samples from one moment to
/// the next.
const LONGEST: f64 = 2.0;
const LONGEST_REGULAR: f64 = 4.0;
const HOP: usize = 110;
/// Lowest frequency in Hz, number of bins per octave, and number of bins: eight octaves.
const LOWEST: f64 = 40.0;
const OCTAVE: usize = 24;
const BINS: usize = 8 * OCTAVE;
/// Standard deviation of the window in cycles, and where it is cut off in standard deviations.
const CYCLES: f64 = 1.2;
const CUT: f64 = 3.0;
/// Largest move of a partial from one moment to the next, in bins (130 octaves per second), and the cost of that move
/// as a share of the amplitude.
const FARTHEST: usize = 8;
const COST: f64 = 0.3;
/// Amplitude, relative to the greatest, below which the partial is ignored: −46 dB.
const FAINT: f64 = 5e-3;
/// Least number of moments in which the pitch must be known.
const FEWEST: usize = 12;
/// Sweeps that are tried: shortest time in seconds, factor from each time to the next, and longest time; number of curves.
const SECONDS: (f64, f64, f64) = (0.015, 1.2, 1.6);
const CURVES: usize = 17;
/// Vibratos that are tried: lowest rate in Hz, step, and highest rate; delays in seconds.
const RATES: (f64, f64, f64) = (2.5, 0.25, Vibrato::FASTEST);
const DELAYS: [f64; 6] = [0.0, 0.3, 0.6, 0.9, 1.3, 2.0];
/// Fewest cycles of a vibrato: a part of one fits any bend.
const LEAST_CYCLES: f64 = 2.0;
/// Rounds of the fine search.
const ROUNDS: usize = 12;
/// Added to the diagonal of the equations, so that they can be solved.
const RIDGE: f64 = 1e-9;
/// Share of the squared error that a sweep, and also a vibrato, must remove to be kept.
const WORTH: f64 = 0.4;
/// Least depths in semitones.
const LEAST_SWEEP: f64 = 0.15;
const LEAST_VIBRATO: f64 = 0.02;

/// The pitch at a moment.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// Seconds.
    time: f64,
    /// Semitones above 1 Hz.
    pitch: f64,
    weight: f64,
}

/// A window of one frequency: the two quadratures.
struct Window {
    frequency: f64,
    values: Vec<[f64; 2]>,
}

impl Window {
    fn new(bin: usize) -> Self {
        let frequency = LOWEST * pow(2.0, bin as f64 / OCTAVE as f64);
        let deviation = CYCLES / frequency * f64::from(RATE);
        let half = (CUT * deviation) as isize;
        let value = |n: isize| {
            let (u, phase) = (n as f64 / deviation, TAU * frequency * n as f64 / f64::from(RATE));
            let weight = exp(-0.5 * u * u) / (deviation * sqrt(PI / 2.0));
            [weight * cos(phase), -weight * sin(phase)]
        };
        Self { frequency, values: (-half..=half).map(value).collect() }
    }

    /// Amplitude, frequency in Hz and centre in samples of the sound under the window, which is centred on sample `middle`.
    fn see(&self, samples: &[f32], middle: usize) -> [f64; 3] {
        let half = self.values.len() / 2;
        let first = half.saturating_sub(middle);
        let last = (samples.len() + half - middle).min(self.values.len());
        // The sum, and that of the products with the time from the middle.
        let (mut sum, mut moment) = ([0.0; 2], [0.0; 2]);
        for (n, value) in self.values[first..last].iter().enumerate() {
            let sample = f64::from(samples[middle + first + n - half]);
            let time = (first + n) as f64 - half as f64;
            for part in 0..2 {
                sum[part] += sample * value[part];
                moment[part] += sample * value[part] * time;
            }
        }
        let power = (sum[0] * sum[0] + sum[1] * sum[1]).max(1e-30);
        let along = (moment[0] * sum[0] + moment[1] * sum[1]) / power;
        let across = (moment[1] * sum[0] - moment[0] * sum[1]) / power;
        // The derivative of a Gaussian is, but for the sign, the Gaussian times the time over the variance.
        let deviation = CYCLES / self.frequency * f64::from(RATE);
        let turn = across / (deviation * deviation) * f64::from(RATE) / TAU;
        [sqrt(power), self.frequency + turn, middle as f64 + along]
    }
}

/// Follows the strongest partial of samples at [`RATE`] for some seconds from their onset on.
fn follow(samples: &[f32], longest: f64) -> Vec<Point> {
    let windows: Vec<Window> = (0..BINS).map(Window::new).collect();
    let len = samples.len().min((longest * f64::from(RATE)) as usize);
    let seen: Vec<Vec<[f64; 3]>> = (0..len)
        .step_by(HOP)
        .map(|middle| windows.iter().map(|window| window.see(samples, middle)).collect())
        .collect();
    // The path through all moments with the largest sum of amplitudes (Viterbi 1967).
    let mut sums = vec![0.0; BINS];
    let mut ways: Vec<[usize; BINS]> = Vec::with_capacity(seen.len());
    for column in &seen {
        let mut way = [0; BINS];
        let mut next = vec![0.0; BINS];
        for (bin, [amplitude, ..]) in column.iter().enumerate() {
            let cost = |from: usize| {
                let far = from.abs_diff(bin) as f64 / FARTHEST as f64;
                sums[from] - COST * amplitude * far * far
            };
            let near = bin.saturating_sub(FARTHEST)..(bin + FARTHEST + 1).min(BINS);
            let from = near.max_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(bin);
            (way[bin], next[bin]) = (from, cost(from) + amplitude);
        }
        ways.push(way);
        sums = next;
    }
    let mut bin = (0..BINS).max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    let mut path: Vec<[f64; 3]> = Vec::with_capacity(seen.len());
    for (column, way) in seen.iter().zip(&ways).rev() {
        path.push(column[bin]);
        bin = way[bin];
    }
    let loudest = path.iter().map(|[amplitude, ..]| *amplitude).fold(0.0, f64::max);
    let heard = path.iter().rev().filter(|[amplitude, frequency, middle]| {
        *amplitude > FAINT * loudest && *frequency > 0.5 * LOWEST && *middle >= 0.0
    });
    heard
        .map(|[amplitude, frequency, middle]| Point {
            time: middle / f64::from(RATE),
            pitch: 12.0 * log2(*frequency),
            weight: sqrt(amplitude / loudest),
        })
        .collect()
}

/// A weighted least-squares fit of the pitch by functions of time: their factors and the squared error. A function that
/// is always 0 gets the factor 0.
fn solve<const N: usize>(points: &[Point], functions: impl Fn(f64) -> [f64; N]) -> ([f64; N], f64) {
    let mut matrix = SMatrix::<f64, N, N>::identity() * RIDGE;
    let (mut right, mut square) = (SVector::<f64, N>::zeros(), 0.0);
    for point in points {
        let values = SVector::from(functions(point.time));
        matrix += point.weight * values * values.transpose();
        right += point.weight * point.pitch * values;
        square += point.weight * point.pitch * point.pitch;
    }
    let factors = Cholesky::new(matrix).map_or(SVector::zeros(), |factors| factors.solve(&right));
    (factors.into(), (square - factors.dot(&right)).max(0.0))
}

/// The times and shapes of a sweep and a vibrato, without their depths.
#[derive(Clone, Copy, Debug)]
struct Movement {
    seconds: f64,
    curve: f64,
    rate: f64,
    delay: f64,
}

impl Movement {
    /// The sweep and vibrato of these times that explain the points best, and the squared error.
    fn explain(&self, points: &[Point], sweeps: bool, trembles: bool) -> (Sweep, f64) {
        let envelope = SweepEnvelope::new(1.0, self.seconds, self.curve);
        let vibrato = Vibrato { semitones: 1.0, rate: self.rate, delay: self.delay };
        let falls = |t: f64| if sweeps { envelope.at(t) } else { 0.0 };
        let ([_, semitones, depth], error) = if trembles {
            solve(points, |t| [1.0, falls(t), vibrato.at(t)])
        } else {
            let ([pitch, semitones], error) = solve(points, |t| [1.0, falls(t)]);
            ([pitch, semitones, 0.0], error)
        };
        let sweep = Sweep {
            semitones,
            seconds: self.seconds,
            curve: self.curve,
            vibrato: Vibrato { semitones: depth, ..vibrato },
        };
        // The engine's vibrato begins upwards.
        let is_playable = (0.0..=Vibrato::DEEPEST).contains(&depth) && fabs(semitones) <= Sweep::LARGEST;
        (sweep, if is_playable { error } else { f64::INFINITY })
    }

    /// The movement with one number changed: up or down by a step of at most 1.
    fn moved(&self, number: usize, step: f64) -> Self {
        let mut moved = *self;
        match number {
            0 => moved.seconds = (self.seconds * exp(0.5 * step)).clamp(SECONDS.0, 5.0),
            1 => moved.curve = (self.curve + 0.3 * step).clamp(-1.0, 1.0),
            2 => moved.rate = (self.rate * exp(0.1 * step)).clamp(RATES.0, RATES.2),
            _ => moved.delay = (self.delay + 0.3 * step).clamp(0.0, 5.0),
        }
        moved
    }
}

/// The pitch of the strongest partial of samples at [`RATE`], from their onset on: seconds, semitones and a weight each.
pub(super) fn pitches(samples: &[f32]) -> Vec<[f64; 3]> {
    follow(samples, LONGEST_REGULAR).into_iter().map(|point| [point.time, point.pitch, point.weight]).collect()
}

/// The movement of the pitch of samples at [`RATE`], from their onset on; [`Sweep::NONE`] if the pitch is constant.
pub(super) fn find(samples: &[f32]) -> Sweep {
    explain(&follow(samples, LONGEST))
}

/// The movement that explains a measured pitch, as times in seconds and semitones, and its mean in semitones.
pub(super) fn of_pitch(pitches: &[(f64, f64)]) -> (Sweep, f64) {
    let points: Vec<Point> =
        pitches.iter().map(|(time, pitch)| Point { time: *time, pitch: *pitch, weight: 1.0 }).collect();
    let sweep = explain(&points);
    let envelope = sweep.envelope();
    let at = |(time, _): &(f64, f64)| {
        sweep.vibrato.at(*time) + if sweep.semitones == 0.0 { 0.0 } else { envelope.at(*time) }
    };
    (sweep, pitches.iter().map(at).sum::<f64>() / pitches.len().max(1) as f64)
}

/// The movement that explains the points; [`Sweep::NONE`] if none does.
fn explain(points: &[Point]) -> Sweep {
    if points.len() < FEWEST {
        return Sweep::NONE;
    }
    let still = Movement { seconds: 0.1, curve: 0.5, rate: 5.0, delay: 0.0 };
    let end = points.last().map_or(0.0, |point| point.time);
    let seconds = std::iter::successors(Some(SECONDS.0), |seconds| Some(SECONDS.1 * seconds));
    let seconds: Vec<f64> = seconds.take_while(|seconds| *seconds < SECONDS.2).collect();
    let curves = (0..CURVES).map(|n| 2.0 * n as f64 / (CURVES - 1) as f64 - 1.0);
    let swept =
        curves.flat_map(|curve| seconds.iter().map(move |seconds| Movement { seconds: *seconds, curve, ..still }));
    let swept: Vec<Movement> = swept.collect();
    let least = |movements: &mut dyn Iterator<Item = Movement>, sweeps: bool, trembles: bool| {
        let error = |movement: &Movement| movement.explain(points, sweeps, trembles).1;
        movements.min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or(still)
    };
    let rates = ((RATES.2 - RATES.0) / RATES.1) as usize;
    let trembling = |movement: Movement| {
        let rate = |n: usize| RATES.0 + RATES.1 * n as f64;
        let rates = (0..=rates).map(rate).filter(|rate| rate * end > LEAST_CYCLES);
        rates.flat_map(|rate| DELAYS.map(|delay| Movement { rate, delay, ..movement })).collect::<Vec<_>>().into_iter()
    };
    let refined = |mut best: Movement, sweeps: bool, trembles: bool| {
        let (mut sweep, mut error) = best.explain(points, sweeps, trembles);
        let mut step = 0.5;
        for _ in 0..ROUNDS {
            for number in if sweeps { 0 } else { 2 }..if trembles { 4 } else { 2 } {
                for signed in [-step, step] {
                    let other = best.moved(number, signed);
                    let (found, least) = other.explain(points, sweeps, trembles);
                    if least < error {
                        (best, sweep, error) = (other, found, least);
                    }
                }
            }
            step *= 0.7;
        }
        (best, sweep, error)
    };
    let alone = solve(points, |_| [1.0]).1;
    let (fall, sweep, of_sweep) = refined(least(&mut swept.into_iter(), true, false), true, false);
    let sweeps = of_sweep < (1.0 - WORTH) * alone && fabs(sweep.semitones) > LEAST_SWEEP;
    let (fall, without) = if sweeps { (fall, of_sweep) } else { (still, alone) };
    let start = least(&mut trembling(fall), sweeps, true);
    let (_, both, of_both) = refined(start, sweeps, true);
    if of_both < (1.0 - WORTH) * without && both.vibrato.semitones > LEAST_VIBRATO {
        return both;
    }
    if sweeps { sweep } else { Sweep::NONE }
}
