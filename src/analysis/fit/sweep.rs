//! The sweep of a recording's pitch: found as the change of time that makes its partials stand still.
//!
//! A sweep moves all modes alike. Played against a clock that runs as their pitch does, their frequencies are constant, and the
//! spectrum has the tallest peaks.

use super::draft::Sweep;
use crate::analysis::log_mel::RATE;
use libm::{cos, pow, sqrt};
use realfft::{RealFftPlanner, RealToComplex};
use std::f64::consts::PI;
use std::sync::Arc;

/// Seconds of the sound that are looked at.
const STRETCH: f64 = 0.45;
/// Points of the transform.
const POINTS: usize = 1 << 16;
/// How much taller the peaks must be than without a sweep.
const CLEARLY: f64 = 1.25;
/// Steps of the coarse search.
const SEMITONES: [f64; 15] = [-18.0, -12.0, -5.0, -2.0, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 18.0, 24.0, 32.0, 44.0, 60.0];
const SECONDS: [f64; 8] = [0.02, 0.04, 0.07, 0.11, 0.16, 0.25, 0.4, 0.7];
const CURVES: [f64; 4] = [-0.3, 0.2, 0.5, 0.8];
/// Coarse sweeps that are refined, and the shortest time in seconds of what is a sweep and no attack.
const REFINED: usize = 5;
const SHORTEST: f64 = 0.015;
/// Rounds of the fine search.
const ROUNDS: usize = 7;

/// Measures how tall the peaks of a sound are.
struct Peaks<'a> {
    samples: &'a [f32],
    fft: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
}

impl Peaks<'_> {
    /// Integral of the squared density of power over the logarithm of frequency. How narrow a peak is against its frequency
    /// depends on the number of its cycles, and so not on how fast the clock runs.
    fn height(&mut self, sweep: &Sweep) -> f64 {
        let len = ((STRETCH * f64::from(RATE)) as usize).min(self.samples.len());
        self.input.fill(0.0);
        let mut end = 0;
        for (sample, speed) in Clock::new(&self.samples[..len], sweep) {
            if end == POINTS {
                return 0.0;
            }
            // The root of the speed keeps the energy.
            self.input[end] = f64::from(sample) / sqrt(speed);
            end += 1;
        }
        // The window ends where the stretch does.
        for (n, sample) in self.input[..end].iter_mut().enumerate() {
            *sample *= 0.5 + 0.5 * cos(PI * n as f64 / end as f64);
        }
        let mut output = self.fft.make_output_vec();
        self.fft.process(&mut self.input, &mut output).expect("the buffers are the transform's own");
        let (mut squares, mut sum) = (0.0, 0.0);
        for (bin, value) in output.iter().enumerate() {
            let power = value.norm_sqr();
            squares += bin as f64 * power * power;
            sum += power;
        }
        if sum > 0.0 { squares / (sum * sum) } else { 0.0 }
    }
}

/// Reads a sound at the speed of its pitch.
struct Clock<'a> {
    samples: &'a [f32],
    sweep: &'a Sweep,
    envelope: crate::dsp::pitch::SweepEnvelope,
    /// In samples.
    time: f64,
}

impl<'a> Clock<'a> {
    fn new(samples: &'a [f32], sweep: &'a Sweep) -> Self {
        Self { samples, sweep, envelope: sweep.envelope(), time: 0.0 }
    }
}

impl Iterator for Clock<'_> {
    /// The sample, and how fast the pitch is there against where it ends.
    type Item = (f32, f64);

    fn next(&mut self) -> Option<(f32, f64)> {
        let at = self.time as usize;
        if at >= self.samples.len() {
            return None;
        }
        let seconds = self.time / f64::from(RATE);
        let speed = if seconds < self.sweep.seconds { pow(2.0, self.envelope.at(seconds) / 12.0) } else { 1.0 };
        let sample = |index: usize| f64::from(self.samples.get(index).copied().unwrap_or(0.0));
        let u = self.time - at as f64;
        let (before, a, b, after) =
            (if at > 0 { sample(at - 1) } else { 0.0 }, sample(at), sample(at + 1), sample(at + 2));
        // Catmull–Rom.
        let slope = [0.5 * (b - before), 0.5 * (after - a)];
        let (square, cube) = (u * u, u * u * u);
        let value = (2.0 * cube - 3.0 * square + 1.0) * a
            + (cube - 2.0 * square + u) * slope[0]
            + (3.0 * square - 2.0 * cube) * b
            + (cube - square) * slope[1];
        self.time += 1.0 / speed;
        Some((value as f32, speed))
    }
}

/// The sound as if its pitch had stood still.
pub(super) fn stilled(samples: &[f32], sweep: &Sweep) -> Vec<f32> {
    if sweep.semitones == 0.0 {
        samples.to_vec()
    } else {
        Clock::new(samples, sweep).map(|(sample, _)| sample).collect()
    }
}

/// Finds the sweep of samples at [`RATE`], from their onset on; [`Sweep::NONE`] if none makes them clearly stiller.
pub(super) fn find(samples: &[f32]) -> Sweep {
    let fft = RealFftPlanner::new().plan_fft_forward(POINTS);
    let mut peaks = Peaks { samples, input: fft.make_input_vec(), fft };
    let still = peaks.height(&Sweep::NONE);
    let mut coarse = Vec::new();
    for semitones in SEMITONES {
        for seconds in SECONDS {
            // The best curve of each is enough.
            let curved =
                CURVES.map(|curve| Sweep { semitones, seconds, curve }).map(|sweep| (peaks.height(&sweep), sweep));
            coarse.extend(curved.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)));
        }
    }
    coarse.sort_by(|a, b| b.0.total_cmp(&a.0));
    coarse.truncate(REFINED);
    let refined = coarse.into_iter().map(|(height, sweep)| refine(&mut peaks, sweep, height));
    match refined.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((height, sweep)) if height > CLEARLY * still => sweep,
        _ => Sweep::NONE,
    }
}

/// Moves a sweep to where the peaks are tallest. Gives their height, too.
fn refine(peaks: &mut Peaks, mut best: Sweep, mut height: f64) -> (f64, Sweep) {
    let mut step = 0.5;
    for _ in 0..ROUNDS {
        for number in 0..3 {
            for sign in [-1.0, 1.0] {
                let mut sweep = best;
                match number {
                    0 => sweep.semitones = (best.semitones * (1.0 + 0.4 * sign * step)).clamp(-60.0, 60.0),
                    1 => sweep.seconds = (best.seconds * (1.0 + 0.6 * sign * step)).clamp(SHORTEST, 2.0),
                    _ => sweep.curve = (best.curve + 0.3 * sign * step).clamp(-1.0, 1.0),
                }
                let found = peaks.height(&sweep);
                if found > height {
                    (best, height) = (sweep, found);
                }
            }
        }
        step *= 0.65;
    }
    (height, best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::{exp, sin};

    fn swept(sweep: &Sweep) -> Vec<f32> {
        let (mut phases, envelope) = ([0.0; 2], sweep.envelope());
        (0..30_000)
            .map(|n| {
                let t = n as f64 / f64::from(RATE);
                let speed = pow(2.0, envelope.at(t) / 12.0);
                phases[0] += 2.0 * PI * 80.0 * speed / f64::from(RATE);
                phases[1] += 2.0 * PI * 130.0 * speed / f64::from(RATE);
                (exp(-8.0 * t) * (0.5 * sin(phases[0]) + 0.2 * sin(phases[1]))) as f32
            })
            .collect()
    }

    #[test]
    fn a_sweep_is_found_and_a_still_sound_has_none() {
        let sweep = Sweep { semitones: 15.0, seconds: 0.09, curve: 0.6 };
        let found = find(&swept(&sweep));
        // The same fall can be had from slightly different numbers: what counts is where the pitch is.
        for t in [0.0, 0.02, 0.05] {
            let off = (found.envelope().at(t) - sweep.envelope().at(t)).abs();
            assert!(off < 1.5, "{found:?} at {t} s: {off} semitones off");
        }
        assert_eq!(find(&swept(&Sweep::NONE)), Sweep::NONE);
    }
}
