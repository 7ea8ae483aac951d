//! Brings a draft nearer to its recording by listening: it is played, compared band by band, and corrected.

use super::audition::Audition;
use super::draft::{Draft, Noise, Sweep, T60};
use super::take::Prepared;
use crate::analysis::log_mel::{BANDS, HOP, LogMel, MelBands, RATE, SPAN_DB, weights};
use crate::units::key_from_frequency;
use libm::{exp, pow};

/// Hardnesses that are tried.
const HARDNESSES: [f64; 10] = [0.95, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15, 0.05];
/// Lengths and rises in seconds of the noise that are tried.
const LENGTHS: [f64; 7] = [0.002, 0.006, 0.015, 0.04, 0.1, 0.23, 0.5];
/// A longer burst takes part in the decay.
const SHORT: f64 = 0.02;
const RISES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
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
        let mut found = draft.clone();
        let mut least = self.distance(draft, usize::MAX);
        for seconds in LENGTHS {
            let mut other = with(draft, Noise { seconds, ..noise });
            if seconds > SHORT {
                self.correct(&mut other, 2);
            }
            let distance = self.distance(&other, usize::MAX);
            if distance < least {
                (found, least) = (other, distance);
            }
        }
        *draft = found;
        let noise = draft.noise;
        let rises: Vec<Draft> = RISES.map(|attack| with(draft, Noise { attack, ..noise })).into();
        self.best(draft, usize::MAX, rises);
    }

    /// Moves the sweep to where the distance is least (downhill simplex, Nelder & Mead 1965).
    pub(super) fn choose_sweep(&mut self, draft: &mut Draft) {
        if draft.sweep.semitones == 0.0 {
            return;
        }
        let start = draft.sweep;
        let sweep = |[semitones, seconds, curve]: [f64; 3]| Sweep {
            semitones: (start.semitones * (1.0 + semitones)).clamp(-60.0, 60.0),
            seconds: (start.seconds * exp(seconds)).clamp(0.002, 5.0),
            curve: (start.curve + curve).clamp(-1.0, 1.0),
        };
        let mut distance = |place: [f64; 3]| self.distance(&Draft { sweep: sweep(place), ..draft.clone() }, usize::MAX);
        let mut simplex: Vec<([f64; 3], f64)> = vec![([0.0; 3], distance([0.0; 3]))];
        for number in 0..3 {
            let mut place = [0.0; 3];
            place[number] = 0.2;
            simplex.push((place, distance(place)));
        }
        for _ in 0..SIMPLEX_STEPS {
            simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
            let middle: [f64; 3] =
                std::array::from_fn(|n| simplex[..3].iter().map(|(place, _)| place[n]).sum::<f64>() / 3.0);
            let worst = simplex[3];
            let along =
                |share: f64| -> [f64; 3] { std::array::from_fn(|n| middle[n] + share * (worst.0[n] - middle[n])) };
            let mirrored = (along(-1.0), distance(along(-1.0)));
            simplex[3] = if mirrored.1 < simplex[0].1 {
                let further = (along(-2.0), distance(along(-2.0)));
                if further.1 < mirrored.1 { further } else { mirrored }
            } else if mirrored.1 < simplex[2].1 {
                mirrored
            } else {
                let nearer = (along(0.5), distance(along(0.5)));
                if nearer.1 >= worst.1 {
                    let best = simplex[0].0;
                    for corner in &mut simplex[1..3] {
                        let place: [f64; 3] = std::array::from_fn(|n| 0.5 * (best[n] + corner.0[n]));
                        *corner = (place, distance(place));
                    }
                }
                nearer
            };
        }
        if let Some((place, _)) = simplex.iter().min_by(|a, b| a.1.total_cmp(&b.1)) {
            draft.sweep = sweep(*place);
        }
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
