//! Fills the residual of the modes with a bed: modes that noise excites.
//!
//! In each mel band, a decay is fitted to the level by which the recording exceeds the draft, and a few modes get that
//! level and that decay. Their frequencies are where the band's spectrum is highest, since the noise may excite a body
//! with modes of its own.

use super::draft::Partial;
use super::movement::{Sweep, speed};
use crate::analysis::line::Line;
use crate::analysis::log_mel::{BANDS, LogMel, RATE, SPAN_DB, centre, time};
use crate::dsp::random::{key, uniform};
use libm::{log10, pow, sqrt};
use sprung_fourier::forward;

/// Smallest excess of the recording over the draft, in dB, that is filled up.
const EXCESS_DB: f64 = 1.5;
/// Shortest and longest T60 of the bed in seconds.
const T60: (f64, f64) = (0.01, 20.0);
/// Fewest windows whose decay is measured, and T60 in seconds of a band that is heard in fewer of them.
const FEWEST_WINDOWS: usize = 4;
const BRIEF_T60: f64 = 0.03;
/// Range in dB, down from its loudest window, in which the decay of a band is measured.
const FOLLOWED_DB: f64 = 45.0;
/// Number of windows among which the loudest of a band is searched for: 1.2 s.
const RISE: usize = 207;
/// Largest RMS deviation of a band's level from a line at which its decay counts as smooth.
const SMOOTH_DB: f64 = 2.0;
/// Fewest and most modes of a band whose decay is not smooth.
const FEWEST: f64 = 2.0;
const MOST: usize = 6;
/// Power, relative to the strongest line of its band, below which a line is left out: −13 dB.
const FAINT: f64 = 0.05;
/// Bandwidth in Hz of a mode with a T60 of 1 s.
const BANDWIDTH: f64 = 2.2;

/// The bed that fills `draft` up to `target`: at most `most` modes, where `lines` are strong. `seed` sets their pans.
pub(super) fn bed([target, draft]: [&LogMel; 2], lines: &Lines, sweep: &Sweep, most: usize, seed: u64) -> Vec<Partial> {
    let floor = target.loudest() - SPAN_DB - 6.0;
    let bands = (0..BANDS).filter_map(|band| Some((band, missing([target, draft], band, floor)?))).collect();
    // The sweep changes the frequencies by this factor, so divide by it.
    let lower = |partial: Partial| Partial { frequency: partial.frequency / speed(sweep, partial.t60), ..partial };
    of_bands(bands, lines, most, seed).into_iter().map(lower).collect()
}

/// The modes of bands: at most `most`. If all bands together need more, each gets fewer: a band that is empty is further from the
/// recording than one whose modes are few.
fn of_bands(mut bands: Vec<(usize, Decay)>, lines: &Lines, most: usize, seed: u64) -> Vec<Partial> {
    bands.sort_by(|a, b| b.1.energy().total_cmp(&a.1.energy()));
    let places: Vec<Vec<(f64, f64)>> = bands.iter().map(|(band, decay)| places(decay, lines, *band)).collect();
    let count = |limit: &usize| places.iter().map(|places| places.len().min(*limit)).sum::<usize>();
    let limit = (1..=MOST).rev().find(|limit| count(limit) <= most).unwrap_or(1);
    let of_band = |((band, decay), places): (&(usize, Decay), &Vec<(f64, f64)>)| {
        partials(decay, &places[..places.len().min(limit)], *band, seed)
    };
    bands.iter().zip(&places).flat_map(of_band).take(most).collect()
}

/// Gives modes that noise moves alternating signs, in the order of their frequencies. The same noise moves all of them: with one sign
/// they add up below the lowest and above the highest one, and cancel each other halfway between two.
pub(super) fn alternate(partials: &mut [Partial]) {
    let mut driven: Vec<&mut Partial> = partials.iter_mut().filter(|partial| !partial.struck).collect();
    driven.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    for (n, partial) in driven.into_iter().enumerate() {
        partial.amplitude = if n % 2 == 0 { 1.0 } else { -1.0 } * partial.amplitude.abs();
    }
}

/// The decay of the level that the draft lacks in a band.
fn missing([target, draft]: [&LogMel; 2], band: usize, floor: f64) -> Option<Decay> {
    let level = |n: usize| {
        let wanted = target.columns[n][band];
        let has = draft.columns.get(n).map_or(-300.0, |column| column[band]);
        let missing = pow(10.0, 0.1 * wanted) - pow(10.0, 0.1 * has);
        (wanted > floor && wanted > has + EXCESS_DB).then(|| 10.0 * log10(missing))
    };
    let levels: Vec<Option<f64>> = (0..target.columns.len()).map(level).collect();
    Decay::of(&levels)
}

/// How a band decays.
struct Decay {
    /// Level in dB at the onset.
    at_onset: f64,
    /// Seconds.
    t60: f64,
    /// Whether the level is a line, as that of one mode.
    is_smooth: bool,
}

impl Decay {
    /// Proportional to the energy of the whole decay.
    fn energy(&self) -> f64 {
        pow(10.0, 0.1 * self.at_onset) * self.t60
    }

    /// A line through the levels in dB of all windows, from the loudest on; none where the band has no level.
    fn of(levels: &[Option<f64>]) -> Option<Self> {
        let start = (0..levels.len().min(RISE)).filter(|n| levels[*n].is_some()).max_by(|a, b| {
            levels[*a].unwrap_or(f64::NEG_INFINITY).total_cmp(&levels[*b].unwrap_or(f64::NEG_INFINITY))
        })?;
        let top = levels[start]?;
        let points: Vec<(f64, f64)> = (start..levels.len())
            .map_while(|n| {
                // A gap of less than twelve windows, where the draft is louder by chance, does not end the decay.
                let near = &levels[n..(n + 12).min(levels.len())];
                near.iter().any(Option::is_some).then_some((n, levels[n]))
            })
            .filter_map(|(n, level)| Some((time(n), level?)))
            .take_while(|(_, level)| *level > top - FOLLOWED_DB)
            .collect();
        let line = Line::through(points.iter().map(|(t, level)| [*t, *level, 1.0]))?;
        let is_known = points.len() >= FEWEST_WINDOWS;
        let line = Line { slope: if is_known { line.slope.min(-60.0 / T60.1) } else { -60.0 / BRIEF_T60 }, ..line };
        let off = points.iter().map(|(t, level)| level - line.at(*t)).map(|off| off * off).sum::<f64>();
        Some(Self {
            at_onset: if is_known { line.at(0.0).min(top + 6.0) } else { top },
            t60: (-60.0 / line.slope).clamp(T60.0, T60.1),
            is_smooth: is_known && off < SMOOTH_DB * SMOOTH_DB * line.weight,
        })
    }
}

/// Hz from half-way below a band to half-way above it.
fn width(band: usize) -> f64 {
    0.5 * (centre((band + 1).min(BANDS - 1)) - centre(band.saturating_sub(1)))
}

/// The places of the modes of a band that decays so, strongest first, each with its power. A smooth decay gets one mode, since
/// several would beat. Noise gets enough modes for their resonances to overlap.
fn places(Decay { t60, is_smooth, .. }: &Decay, lines: &Lines, band: usize) -> Vec<(f64, f64)> {
    let width = width(band);
    let most = if *is_smooth { 1.0 } else { (0.5 * width * t60 / BANDWIDTH).clamp(FEWEST, MOST as f64).round() };
    lines.highest((centre(band) - 0.5 * width, centre(band) + 0.5 * width), BANDWIDTH / t60, most as usize)
}

/// The modes at these places.
fn partials(decay: &Decay, places: &[(f64, f64)], band: usize, seed: u64) -> Vec<Partial> {
    let all: f64 = places.iter().map(|(_, power)| power).sum();
    let partial = |(n, (frequency, power)): (usize, &(f64, f64))| {
        // The main lobe of a Hann window has 3/2 of a sine's power, of which a triangular band has 2/3 on average.
        let amplitude = sqrt(pow(10.0, 0.1 * decay.at_onset) * power / all);
        let pan = 0.4 * f64::from(uniform(key(seed, band as u64), n as u64));
        Partial { frequency: *frequency, t60: decay.t60, amplitude, phase: 0.0, pan, struck: false }
    };
    places.iter().enumerate().map(partial).collect()
}

/// The power spectrum of a whole sound.
pub(super) struct Lines {
    /// Hz from one value to the next.
    step: f64,
    /// The power up to each frequency. The power of a range is the difference of two values.
    sums: Vec<f64>,
}

impl Lines {
    /// Of samples at [`RATE`].
    pub(super) fn new(samples: &[f32]) -> Self {
        let points = (2 * samples.len()).next_power_of_two();
        let transform = forward(points);
        let mut input = transform.make_input_vec();
        input.iter_mut().zip(samples).for_each(|(input, sample)| *input = f64::from(*sample));
        let mut output = transform.make_output_vec();
        transform.process(&mut input, &mut output).expect("the buffers are the transform's own");
        let sums = output.iter().scan(0.0, |sum, bin| {
            *sum += bin.norm_sqr();
            Some(*sum)
        });
        Self { step: f64::from(RATE) / points as f64, sums: sums.collect() }
    }

    /// Power within half a width of a frequency.
    fn power(&self, frequency: f64, width: f64) -> f64 {
        let at = |frequency: f64| self.sums[((frequency / self.step).max(0.0) as usize).min(self.sums.len() - 1)];
        at(frequency + 0.5 * width) - at(frequency - 0.5 * width - self.step)
    }

    /// The frequencies with the most power within `width` around them, with that power: at most `most` in the range,
    /// and no two closer than `width`.
    fn highest(&self, range: (f64, f64), width: f64, most: usize) -> Vec<(f64, f64)> {
        let step = (0.25 * width).max(self.step);
        let count = ((range.1 - range.0) / step) as usize + 1;
        let frequency = |n: usize| range.0 + (n as f64 + 0.5) * (range.1 - range.0) / count as f64;
        let mut all: Vec<(f64, f64)> =
            (0..count).map(frequency).map(|frequency| (frequency, self.power(frequency, width))).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut kept: Vec<(f64, f64)> = Vec::new();
        for (frequency, power) in all {
            if kept.len() == most || kept.first().is_some_and(|first| power < FAINT * first.1) {
                break;
            }
            if kept.iter().all(|other| (other.0 - frequency).abs() >= width) {
                kept.push((frequency, power.max(1e-30)));
            }
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise whose high frequencies are 30 dB fainter than its low ones.
    fn noise() -> Vec<f32> {
        let (key, mut low) = (key(7, 0), 0.0);
        let sample = |n: u64| {
            low += 0.03 * (uniform(key, n) - low);
            low
        };
        (0..u64::from(RATE) / 2).map(sample).collect()
    }

    #[test]
    fn every_band_of_noise_gets_modes() {
        let samples = noise();
        let (target, lines) = (crate::analysis::log_mel::MelBands::new().measure(&samples), Lines::new(&samples));
        let silence = LogMel { columns: Vec::new() };
        for most in [60, 100, 192] {
            let partials = bed([&target, &silence], &lines, &Sweep::NONE, most, 1);
            assert!(partials.len() <= most && partials.len() > most / 2, "{} of {most}", partials.len());
            let within =
                |band: usize, partial: &Partial| (partial.frequency - centre(band)).abs() <= 0.52 * width(band);
            let empty = |band: &usize| !partials.iter().any(|partial| within(*band, partial));
            assert_eq!((0..BANDS).find(empty), None, "of {most}");
        }
        // With room for a few only, the loudest bands get them.
        let few = bed([&target, &silence], &lines, &Sweep::NONE, 5, 1);
        assert!(few.len() == 5 && few.iter().all(|partial| partial.frequency < 1500.0), "{few:?}");
    }

    #[test]
    fn signs_alternate_in_the_order_of_frequencies_and_struck_modes_keep_theirs() {
        let partial =
            |(frequency, struck)| Partial { frequency, t60: 0.1, amplitude: 0.5, phase: 0.0, pan: 0.0, struck };
        let mut partials = [(300.0, false), (100.0, false), (150.0, true), (200.0, false)].map(partial);
        alternate(&mut partials);
        assert_eq!(partials.map(|partial| partial.amplitude), [0.5, 0.5, 0.5, -0.5]);
    }
}
