//! Brings a draft nearer to its recording by listening: it is played, compared band by band, and corrected.

use super::audition::Audition;
use super::draft::{Draft, Noise, T60};
use super::simplex;
use super::take::Prepared;
use crate::analysis::log_mel::{BANDS, HOP, LogMel, MelBands, RATE, SPAN_DB, weights};
use crate::params::NoiseDecay;
use crate::units::key_from_frequency;
use libm::pow;

/// Hardnesses that are tried.
const HARDNESSES: [f64; 10] = [0.95, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15, 0.05];
/// Lengths and rises in seconds of the noise that are tried.
const LENGTHS: [f64; 8] = [0.002, 0.006, 0.015, 0.04, 0.1, 0.23, 0.5, 1.0];
/// A longer burst takes part in the decay.
const SHORT: f64 = 0.02;
const RISES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// Time in which an exponential burst falls by 60 dB over that of a parabola with the same energy: these are the sixth part of
/// the one over ln 10, and the fifth of the other.
const EXPONENTIAL: f64 = 2.76;
/// Bursts that follow each other, and seconds between them, that are tried.
const HITS: [u8; 3] = [2, 3, 4];
const SPACINGS: [f64; 4] = [0.008, 0.0105, 0.0135, 0.018];
/// What several bursts have to gain in dB over the attack.
const WORTH_HITS: f64 = 0.3;
/// Windows of the attack: 150 ms.
const ATTACK: usize = 26;
/// Steps of the search for a sweep.
const SIMPLEX_STEPS: usize = 36;
/// Largest correction of a level in dB and of a decay in dB/s at a time, as a share of its own.
const MOST_DB: f64 = 12.0;
const MOST_SHARE: f64 = 0.6;

/// Plays drafts and measures how far they are from a recording.
pub(super) struct Listener<'a> {
    audition: Audition,
    bands: MelBands,
    take: &'a Prepared,
    pub(super) target: LogMel,
}

impl<'a> Listener<'a> {
    pub(super) fn new(take: &'a Prepared) -> Self {
        let mut bands = MelBands::new();
        let target = bands.measure(&take.mean);
        Self { audition: Audition::new(), bands, take, target }
    }

    /// The bands of a draft over the first windows.
    fn listen(&mut self, draft: &Draft, windows: usize) -> LogMel {
        let frames = self.take.mean.len().min(windows.saturating_mul(HOP));
        let key = key_from_frequency(draft.note, 440.0);
        let sound = self.audition.mean(&draft.patch(), key, draft.velocity, frames + 1024);
        let sound = crate::analysis::log_mel::from_onset(&sound);
        self.bands.measure(&sound[..sound.len().min(frames)])
    }

    /// All of a draft's bands.
    pub(super) fn hear(&mut self, draft: &Draft) -> LogMel {
        self.listen(draft, usize::MAX)
    }

    /// Distance of a draft over the first windows, in dB.
    pub(super) fn distance(&mut self, draft: &Draft, windows: usize) -> f64 {
        let heard = self.listen(draft, windows);
        if windows >= self.target.columns.len() {
            return heard.distance(&self.target);
        }
        let start = LogMel { columns: self.target.columns[..windows].to_vec() };
        heard.distance(&start)
    }

    /// The best of some drafts over the first windows, and the present one.
    fn best(&mut self, draft: &mut Draft, windows: usize, others: impl IntoIterator<Item = Draft>) {
        let mut least = self.distance(draft, windows);
        for other in others {
            let distance = self.distance(&other, windows);
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
    }

    /// Chooses the hardness of the mallet by the attack.
    pub(super) fn choose_hardness(&mut self, draft: &mut Draft) {
        let with = |draft: &Draft, hardness| Draft { hardness, ..draft.clone() };
        let coarse: Vec<Draft> = HARDNESSES.iter().map(|hardness| with(draft, Some(*hardness))).collect();
        self.best(draft, ATTACK, coarse);
        for step in [0.05, 0.025, 0.012] {
            if let Some(hardness) = draft.hardness {
                let near = [-step, step].map(|by| with(draft, Some((hardness + by).clamp(0.0, 1.0))));
                self.best(draft, ATTACK, near);
            }
        }
    }

    /// Chooses length and rise of the noise burst.
    pub(super) fn choose_noise(&mut self, draft: &mut Draft) {
        if draft.partials.iter().all(|partial| partial.struck) {
            return;
        }
        let with = |draft: &Draft, noise| Draft { noise, ..draft.clone() };
        let noise = draft.noise;
        // Decays of the modes were measured on the whole: what the burst takes is to be left out of them.
        let bursts = LENGTHS.map(|seconds| Noise { seconds, ..noise });
        self.best_corrected(draft, bursts);
        let noise = draft.noise;
        self.best_corrected(
            draft,
            [Noise { seconds: (EXPONENTIAL * noise.seconds).min(1.0), decay: NoiseDecay::Exponential, ..noise }],
        );
        let noise = draft.noise;
        let rises: Vec<Draft> = RISES.map(|attack| with(draft, Noise { attack, ..noise })).into();
        self.best(draft, usize::MAX, rises);
        let noise = draft.noise;
        let several = HITS.map(|hits| SPACINGS.map(|spacing| with(draft, Noise { hits, spacing, ..noise })));
        let mut other = draft.clone();
        self.best(&mut other, ATTACK, several.into_iter().flatten());
        if self.distance(&other, ATTACK) < self.distance(draft, ATTACK) - WORTH_HITS {
            *draft = other;
        }
    }

    /// The best of some bursts of noise, each with the levels and decays that it asks for, and the present one.
    fn best_corrected(&mut self, draft: &mut Draft, bursts: impl IntoIterator<Item = Noise>) {
        let mut least = self.distance(draft, usize::MAX);
        let before = draft.clone();
        for noise in bursts {
            let mut other = Draft { noise, ..before.clone() };
            if noise.seconds > SHORT {
                self.correct(&mut other, 2);
            }
            let distance = self.distance(&other, usize::MAX);
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
    }

    /// Moves the sweep to where the distance is least.
    pub(super) fn choose_sweep(&mut self, draft: &mut Draft) {
        if draft.sweep.semitones == 0.0 {
            return;
        }
        let start = draft.sweep;
        let (place, _) = simplex::least(SIMPLEX_STEPS, |place| {
            self.distance(&Draft { sweep: start.moved(place), ..draft.clone() }, usize::MAX)
        });
        draft.sweep = start.moved(place);
    }

    /// Corrects level and decay of the modes by their bands, as long as the distance falls.
    pub(super) fn correct(&mut self, draft: &mut Draft, rounds: usize) {
        let mut heard = self.hear(draft);
        let (mut least, mut share) = (heard.distance(&self.target), 0.8);
        for _ in 0..rounds {
            let corrections = corrections(&self.target, &heard);
            let other = corrected(draft, &corrections, share);
            let other_heard = self.hear(&other);
            let distance = other_heard.distance(&self.target);
            if distance < least {
                if distance > least - 0.005 {
                    *draft = other;
                    return;
                }
                (*draft, heard, least) = (other, other_heard, distance);
            } else {
                share *= 0.5;
                if share < 0.15 {
                    return;
                }
            }
        }
    }
}

/// By how many dB a band is too soft at the onset, and by how many more in each second.
type Correction = (f64, f64);

fn corrections(target: &LogMel, heard: &LogMel) -> [Correction; BANDS] {
    let floor = target.loudest().max(heard.loudest()) - SPAN_DB;
    std::array::from_fn(|band| {
        let mut points = Vec::new();
        for (n, wanted) in target.columns.iter().enumerate() {
            let has = heard.columns.get(n).map_or(floor, |column| column[band]);
            if wanted[band].max(has) > floor {
                let t = n as f64 * HOP as f64 / f64::from(RATE);
                points.push((t, (wanted[band].max(floor) - has.max(floor)).clamp(-20.0, 20.0)));
            }
        }
        line(&points)
    })
}

/// The line through some points, by least squares.
fn line(points: &[(f64, f64)]) -> Correction {
    let count = points.len() as f64;
    if points.is_empty() {
        return (0.0, 0.0);
    }
    let (t, y) = points.iter().fold((0.0, 0.0), |(t, y), point| (t + point.0 / count, y + point.1 / count));
    let (product, square) = points.iter().fold((0.0, 0.0), |(product, square), point| {
        (product + (point.0 - t) * (point.1 - y), square + (point.0 - t) * (point.0 - t))
    });
    if points.len() < 8 || square == 0.0 {
        return (y, 0.0);
    }
    let slope = product / square;
    (y - slope * t, slope)
}

fn corrected(draft: &Draft, corrections: &[Correction; BANDS], share: f64) -> Draft {
    let mut draft = draft.clone();
    let sweep = draft.sweep;
    for partial in &mut draft.partials {
        let weights = weights(partial.heard_at(&sweep));
        let (mut level, mut slope) = (0.0, 0.0);
        for (weight, correction) in weights.iter().zip(corrections) {
            level += weight * correction.0;
            slope += weight * correction.1;
        }
        partial.amplitude *= pow(10.0, (share * level).clamp(-MOST_DB, MOST_DB) / 20.0);
        // A T60 of 1 s falls by 60 dB in a second.
        let falls = 60.0 / partial.t60;
        let change = (share * slope).clamp(-MOST_SHARE * falls, MOST_SHARE * falls);
        partial.t60 = (60.0 / (falls - change)).clamp(T60.0, T60.1);
    }
    draft
}
