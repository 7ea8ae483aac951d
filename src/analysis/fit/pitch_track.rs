//! Follows the pitch of a sound over time, and finds the sweep and vibrato that explain it.
//!
//! The strongest partial is followed from moment to moment through spectra whose windows have the same number of cycles
//! at all frequencies. Its frequency is the rate at which its phase turns (reassignment: Auger & Flandrin 1995), which
//! is far more exact than the bandwidth of the window.

use super::movement::{Sweep, Vibrato};
use super::simplex;
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
/// Steps of the fine search.
const STEPS: usize = 60;
/// Added to the diagonal of the equations, so that they can be solved.
const RIDGE: f64 = 1e-9;
/// Share of the squared error that a sweep, and also a vibrato, must remove to be kept.
const WORTH: f64 = 0.4;
/// Least depths in semitones.
const LEAST_SWEEP: f64 = 0.15;
const LEAST_VIBRATO: f64 = 0.02;

/// The pitch at a moment: seconds, semitones above 1 Hz, and a weight.
pub(super) type Point = [f64; 3];

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
    let point = |[amplitude, frequency, middle]: &[f64; 3]| {
        [middle / f64::from(RATE), 12.0 * log2(*frequency), sqrt(amplitude / loudest)]
    };
    heard.map(point).collect()
}

/// A weighted least-squares fit of the pitch by a constant and two functions of time: the factors of these and the squared error. A
/// function that is always 0 gets the factor 0.
fn solve(points: &[Point], functions: impl Fn(f64) -> [f64; 2]) -> ([f64; 2], f64) {
    let mut matrix = SMatrix::<f64, 3, 3>::identity() * RIDGE;
    let (mut right, mut square) = (SVector::<f64, 3>::zeros(), 0.0);
    for [time, pitch, weight] in points {
        let [first, second] = functions(*time);
        let values = SVector::from([1.0, first, second]);
        matrix += *weight * values * values.transpose();
        right += weight * pitch * values;
        square += weight * pitch * pitch;
    }
    let factors = Cholesky::new(matrix).map_or(SVector::zeros(), |factors| factors.solve(&right));
    ([factors[1], factors[2]], (square - factors.dot(&right)).max(0.0))
}

/// The sweep and vibrato with the times, curve and rate of `times` that explain the points best, and the squared error.
fn best_depths(times: &Sweep, points: &[Point], sweeps: bool, trembles: bool) -> (Sweep, f64) {
    let envelope = SweepEnvelope::new(1.0, times.seconds, times.curve);
    let vibrato = Vibrato { semitones: 1.0, ..times.vibrato };
    let falls = |t: f64| if sweeps { envelope.at(t) } else { 0.0 };
    let trembling = |t: f64| if trembles { vibrato.at(t) } else { 0.0 };
    let ([semitones, depth], error) = solve(points, |t| [falls(t), trembling(t)]);
    // The engine's vibrato begins upwards.
    let is_playable = (0.0..=Vibrato::DEEPEST).contains(&depth) && fabs(semitones) <= Sweep::LARGEST;
    let sweep = Sweep { semitones, vibrato: Vibrato { semitones: depth, ..vibrato }, ..*times };
    (sweep, if is_playable { error } else { f64::INFINITY })
}

/// A sweep with changed numbers: the times and the rate by powers of e, curve and delay by sums.
fn moved(sweep: &Sweep, [seconds, curve, rate, delay]: [f64; 4]) -> Sweep {
    Sweep {
        seconds: (sweep.seconds * exp(seconds)).clamp(SECONDS.0, 5.0),
        curve: (sweep.curve + curve).clamp(-1.0, 1.0),
        vibrato: Vibrato {
            rate: (sweep.vibrato.rate * exp(0.2 * rate)).clamp(RATES.0, RATES.2),
            delay: (sweep.vibrato.delay + delay).clamp(0.0, 5.0),
            ..sweep.vibrato
        },
        ..*sweep
    }
}

/// The pitch of the strongest partial of samples at [`RATE`], from their onset on.
pub(super) fn pitches(samples: &[f32]) -> Vec<Point> {
    follow(samples, LONGEST_REGULAR)
}

/// The movement of the pitch of samples at [`RATE`], from their onset on; [`Sweep::NONE`] if the pitch is constant.
pub(super) fn find(samples: &[f32]) -> Sweep {
    explain(&follow(samples, LONGEST))
}

/// The movement that explains a measured pitch, and its mean in semitones.
pub(super) fn of_pitch(points: &[Point]) -> (Sweep, f64) {
    let sweep = explain(points);
    let envelope = sweep.envelope();
    let at =
        |[time, ..]: &Point| sweep.vibrato.at(*time) + if sweep.semitones == 0.0 { 0.0 } else { envelope.at(*time) };
    (sweep, points.iter().map(at).sum::<f64>() / points.len().max(1) as f64)
}

/// The movement that explains the points; [`Sweep::NONE`] if none does.
fn explain(points: &[Point]) -> Sweep {
    if points.len() < FEWEST {
        return Sweep::NONE;
    }
    let end = points.last().map_or(0.0, |[time, ..]| *time);
    let least = |tried: &mut dyn Iterator<Item = Sweep>, sweeps: bool, trembles: bool| {
        let error = |sweep: &Sweep| best_depths(sweep, points, sweeps, trembles).1;
        let start = tried.min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or(Sweep::NONE);
        let near = |place| best_depths(&moved(&start, place), points, sweeps, trembles);
        near(simplex::least(STEPS, |place| Ok(near(place).1)).map_or([0.0; 4], |(place, _)| place))
    };
    let seconds = std::iter::successors(Some(SECONDS.0), |seconds| Some(SECONDS.1 * seconds));
    let seconds = seconds.take_while(|seconds| *seconds < SECONDS.2);
    let curve = |n: usize| 2.0 * n as f64 / (CURVES - 1) as f64 - 1.0;
    let mut swept = seconds
        .flat_map(|seconds| (0..CURVES).map(move |n| (seconds, curve(n))))
        .map(|(seconds, curve)| Sweep { seconds, curve, ..Sweep::NONE });
    let alone = solve(points, |_| [0.0; 2]).1;
    let (sweep, of_sweep) = least(&mut swept, true, false);
    let sweeps = of_sweep < (1.0 - WORTH) * alone && fabs(sweep.semitones) > LEAST_SWEEP;
    let (sweep, without) = if sweeps { (sweep, of_sweep) } else { (Sweep::NONE, alone) };
    let rates = (0..=((RATES.2 - RATES.0) / RATES.1) as usize).map(|n| RATES.0 + RATES.1 * n as f64);
    let mut trembling = rates
        .filter(|rate| rate * end > LEAST_CYCLES)
        .flat_map(|rate| DELAYS.map(|delay| Vibrato { rate, delay, ..Sweep::NONE.vibrato }))
        .map(|vibrato| Sweep { vibrato, ..sweep });
    let (both, of_both) = least(&mut trembling, sweeps, true);
    if of_both < (1.0 - WORTH) * without && both.vibrato.semitones > LEAST_VIBRATO { both } else { sweep }
}
