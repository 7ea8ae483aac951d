//! Finds the sweep of a recording's pitch: the change of reading speed that makes its partials constant in frequency.
//!
//! A sweep changes the frequencies of all modes by the same factor. If the recording is read at a speed that follows
//! its pitch, the frequencies are constant, and the spectrum has the highest peaks.

use super::layers::slope;
use super::movement::Sweep;
use super::pitch_track;
use super::simplex;
use crate::analysis::level::rms;
use crate::analysis::log_mel::RATE;
use crate::error::Result;
use libm::{cos, exp, log, pow, sqrt};
use sprung_fourier::Forward;
use std::f64::consts::PI;

/// Seconds of the sound that the coarse and the fine search use.
const STRETCHES: (f64, f64) = (0.45, 1.2);
/// Points of the transform.
const POINTS: usize = 1 << 17;
/// Factor by which a sweep must raise the peaks.
const CLEARLY: f64 = 1.08;
/// The same for the movement of the strongest partial, which is more certain. It may be below 1, since a sound that
/// decays before its pitch settles has broad peaks.
const HARDLY: f64 = 0.5;
/// Steps of the coarse search.
const SEMITONES: [f64; 17] =
    [-18.0, -12.0, -5.0, -2.0, -0.5, 0.4, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 18.0, 24.0, 32.0, 44.0, 60.0];
const SECONDS: [f64; 9] = [0.02, 0.04, 0.07, 0.11, 0.16, 0.25, 0.4, 0.7, 1.4];
const CURVES: [f64; 3] = [-0.3, 0.2, 0.6];
/// Coarse sweeps that are refined.
const REFINED: usize = 4;
/// Blocks per second whose levels show the decay, and their range below the loudest, as a logarithm: 40 dB.
const BLOCKS: usize = 100;
const HEARD: f64 = 4.6;
/// Steps of the fine search, and times that sweep and vibrato are searched for in turn.
const STEPS: usize = 40;
const ROUNDS: usize = 3;

/// Measures how high the peaks of a sound's spectrum are.
struct Peaks<'a> {
    samples: &'a [f32],
    /// Seconds of the sound that are used.
    stretch: f64,
    fft: Forward,
    input: Vec<f64>,
    /// Reports that the search goes on; an error ends it.
    tell: &'a mut dyn FnMut() -> Result<()>,
}

impl Peaks<'_> {
    /// Integral of the squared density of power over the logarithm of frequency. The width of a peak relative to its
    /// frequency depends on its number of cycles, and so not on the reading speed.
    fn height(&mut self, sweep: &Sweep) -> Result<f64> {
        (self.tell)()?;
        let len = ((self.stretch * f64::from(RATE)) as usize).min(self.samples.len());
        self.input.fill(0.0);
        let mut end = 0;
        for (sample, speed) in Clock::new(&self.samples[..len], sweep) {
            if end == POINTS {
                break;
            }
            // Division by the root of the speed keeps the energy.
            self.input[end] = f64::from(sample) / sqrt(speed);
            end += 1;
        }
        // A falling window, which ends with the sound.
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
        Ok(if sum > 0.0 { squares / (sum * sum) } else { 0.0 })
    }
}

/// Reads a sound at a speed that follows its pitch.
struct Clock<'a> {
    samples: &'a [f32],
    sweep: &'a Sweep,
    envelope: crate::dsp::pitch::SweepEnvelope,
    /// Place in the sound, in samples.
    time: f64,
}

impl<'a> Clock<'a> {
    fn new(samples: &'a [f32], sweep: &'a Sweep) -> Self {
        Self { samples, sweep, envelope: sweep.envelope(), time: 0.0 }
    }
}

impl Iterator for Clock<'_> {
    /// The sample, and the pitch there relative to the final pitch.
    type Item = (f32, f64);

    fn next(&mut self) -> Option<(f32, f64)> {
        let at = self.time as usize;
        if at >= self.samples.len() {
            return None;
        }
        let seconds = self.time / f64::from(RATE);
        let semitones = self.envelope.at(seconds) + self.sweep.vibrato.at(seconds);
        let speed = if semitones == 0.0 { 1.0 } else { pow(2.0, semitones / 12.0) };
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

/// The sound with a constant pitch. Reading at the speed of the pitch also stretches the decay, which does not follow
/// the pitch. This is undone with `decay`, the decay of the whole sound in 1/s ([`decay`]).
pub(super) fn stilled(samples: &[f32], sweep: &Sweep, decay: f64) -> Vec<f32> {
    if sweep.is_none() {
        return samples.to_vec();
    }
    let mut clock = Clock::new(samples, sweep);
    let mut still = Vec::new();
    while let Some((time, (sample, _))) = Some(clock.time).zip(clock.next()) {
        let late = (still.len() as f64 - time) / f64::from(RATE);
        still.push((f64::from(sample) * exp(-decay * late)) as f32);
    }
    still
}

/// How fast the amplitude of a sound falls, in 1/s: a line through the logarithm of its level.
pub(super) fn decay(samples: &[f32]) -> f64 {
    let levels: Vec<f64> = samples.chunks(RATE as usize / BLOCKS).map(|block| log(rms(block).max(1e-9))).collect();
    let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let heard = levels.iter().rposition(|level| *level > loudest - HEARD).map_or(0, |last| last + 1);
    let points = levels[..heard].iter().enumerate().map(|(n, level)| (n as f64 / BLOCKS as f64, *level));
    slope(points).map_or(0.0, |slope| (-slope).max(0.0))
}

/// The possible movements of the pitch of samples at [`RATE`], from their onset on; empty if the pitch is constant.
/// `tell` is called often, and ends the search by an error.
pub(super) fn find(samples: &[f32], tell: &mut dyn FnMut() -> Result<()>) -> Result<Vec<Sweep>> {
    let fft = sprung_fourier::forward(POINTS);
    let mut peaks = Peaks { samples, stretch: STRETCHES.0, input: fft.make_input_vec(), fft, tell };
    let mut coarse = Vec::new();
    for semitones in SEMITONES {
        for seconds in SECONDS {
            // The best curve of each is enough.
            let curved = CURVES.map(|curve| Sweep { semitones, seconds, curve, ..Sweep::NONE });
            let curved: Vec<(f64, Sweep)> =
                curved.into_iter().map(|sweep| Ok((peaks.height(&sweep)?, sweep))).collect::<Result<_>>()?;
            coarse.extend(curved.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)));
        }
    }
    coarse.sort_by(|a, b| b.0.total_cmp(&a.0));
    coarse.truncate(REFINED);
    peaks.stretch = STRETCHES.1;
    let still = peaks.height(&Sweep::NONE)?;
    let refined: Vec<(f64, Sweep)> =
        coarse.into_iter().map(|(_, sweep)| refine(&mut peaks, sweep)).collect::<Result<_>>()?;
    let mut found: Vec<Sweep> = refined
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(height, _)| *height > CLEARLY * still)
        .map(|(_, sweep)| sweep)
        .into_iter()
        .collect();
    // Keep the movement of the strongest partial if it makes the other partials constant, too.
    let followed = pitch_track::find(samples);
    if !followed.is_none() && peaks.height(&followed)? > HARDLY * still {
        found.push(refine(&mut peaks, followed)?.1);
    }
    Ok(found)
}

/// Changes a sweep until the peaks are highest. Returns their height and the sweep.
fn refine(peaks: &mut Peaks, start: Sweep) -> Result<(f64, Sweep)> {
    let (mut best, mut height) = (start, f64::NEG_INFINITY);
    // A sweep makes up for the faults of its vibrato, so each is found again once the other is better.
    for _ in 0..ROUNDS {
        let (place, least) = simplex::least(STEPS, |place| Ok(-peaks.height(&best.moved(place))?))?;
        (best, height) = (best.moved(place), -least);
        if best.vibrato.semitones == 0.0 {
            break;
        }
        let (place, least) = simplex::least(STEPS, |place| Ok(-peaks.height(&best.with_vibrato_moved(place))?))?;
        (best, height) = (best.with_vibrato_moved(place), -least);
    }
    Ok((height, best))
}

#[cfg(test)]
mod tests {
    use super::super::movement::Vibrato;
    use super::*;
    use libm::sin;

    fn swept(sweep: &Sweep) -> Vec<f32> {
        let (mut phases, envelope) = ([0.0; 2], sweep.envelope());
        (0..30_000)
            .map(|n| {
                let t = n as f64 / f64::from(RATE);
                let speed = pow(2.0, (envelope.at(t) + sweep.vibrato.at(t)) / 12.0);
                phases[0] += 2.0 * PI * 80.0 * speed / f64::from(RATE);
                phases[1] += 2.0 * PI * 130.0 * speed / f64::from(RATE);
                (exp(-8.0 * t) * (0.5 * sin(phases[0]) + 0.2 * sin(phases[1]))) as f32
            })
            .collect()
    }

    #[test]
    fn a_sweep_is_found_and_a_still_sound_has_hardly_any() {
        let sweep = Sweep { semitones: 15.0, seconds: 0.09, curve: 0.6, ..Sweep::NONE };
        let found = *find(&swept(&sweep), &mut || Ok(())).unwrap().last().unwrap();
        // Slightly different numbers give the same fall, so compare the pitches.
        for t in [0.0, 0.02, 0.05] {
            let off = (found.envelope().at(t) - sweep.envelope().at(t)).abs();
            assert!(off < 1.5, "{found:?} at {t} s: {off} semitones off");
        }
        // A sweep may be proposed here: the caller compares it with no sweep.
        let still = find(&swept(&Sweep::NONE), &mut || Ok(())).unwrap();
        assert!(still.iter().all(|sweep| sweep.semitones.abs() < 2.0));
    }

    #[test]
    #[ignore = "takes seconds"]
    fn a_sweep_and_its_vibrato_are_found_together() {
        let vibrato = Vibrato { semitones: 0.8, rate: 17.0, delay: 0.0 };
        let sweep = Sweep { semitones: 40.0, seconds: 0.45, curve: 0.0, vibrato };
        let found = *find(&swept(&sweep), &mut || Ok(())).unwrap().last().unwrap();
        let (rate, depth) = (found.vibrato.rate, found.vibrato.semitones);
        assert!((rate - 17.0).abs() < 0.3 && (depth - 0.8).abs() < 0.06, "{found:?}");
        // The sound is over before its pitch settles, so compare how far it falls.
        let falls = |sweep: &Sweep, t: f64| sweep.envelope().at(0.0) - sweep.envelope().at(t);
        for t in [0.05, 0.1, 0.2] {
            let off = (falls(&found, t) - falls(&sweep, t)).abs();
            assert!(off < 0.4, "{found:?} at {t} s: {off} semitones off");
        }
    }
}
