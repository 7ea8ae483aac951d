//! The cascade of energy: higher modes receive the energy that low modes of a strongly struck body lose.
//!
//! In a gong or a cymbal that is struck hard, the modes are not independent: they pass energy on to higher ones, so that
//! the sound brightens for some tenths of a second (Legge and Fletcher 1989, Nonlinearity, chaos, and the sound of shallow
//! gongs; Touzé, Bilbao and Cadot 2012, Transition scenario to turbulence in thin vibrating plates). This is a model of
//! that effect and not of the equations behind it: modes are sorted into bands of half an octave, and at each control tick
//! each band passes a part of its energy to the next band that has modes. The part grows with the energy of all modes
//! together, so a soft sound keeps its spectrum.
//!
//! A band receives exactly the energy that the band below has lost, and the factor for a mode's state is rounded down. So
//! the energy of all modes together never rises.
//!
//! The cascade ends where the next band has its share (`bloom`) of the energy of the band below: at 100 % all energies
//! are equal, at 50 % the spectrum falls by 6 dB per octave. Factors are computed in scalar double precision between
//! ticks, so that the kernels and their tables do not know of the cascade, and all levels have the same bits. Factors
//! are not smoothed, because their steps are small: a gain that changes by 0.3 % at each tick has sidebands below −55
//! dB. The sum of all amplitudes can rise, since energy that more modes share is louder if they are in phase. While
//! energy moves up, tails are computed as if all modes decayed like the slowest one. `cascade_tests` compares the
//! energies before and after each of 144,000 ticks of random bodies.

use super::Cells;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::mode_bank::exchange::{BANDS, Band, Exchange};
use crate::dsp::random;
use std::f64::consts::SQRT_2;

/// Strength and speed of the cascade.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Climb {
    /// Upper limit of a band's energy, as a fraction of the energy of the band half an octave below, 0–1.
    pub share: f64,
    /// Fraction of the missing energy that the lowest band passes on in a control tick, at full energy. Each band is faster
    /// than the one below by the ratio of their frequencies.
    pub speed: f64,
    /// Full energy: the sum of the squared amplitudes of all modes after a full strike.
    pub full: f64,
    /// Stream of random numbers for the signs of modes that receive their first energy.
    pub key: u64,
}

/// The largest fraction of the missing energy that a band passes on in a control tick.
const MOST: f64 = 0.25;

/// Upper limit of the energy, in full energies.
const MOST_ENERGY: f64 = 4.0;

impl Climb {
    /// Below this fraction of full energy, no energy is passed on.
    pub(crate) const LEAST_ENERGY: f64 = 1e-4;
}

/// In a control tick, a band at most doubles its energy, plus this fraction of the total for each mode. So no mode starts
/// with a click.
const SEED: f64 = 1e-8;

impl Cells {
    /// Sorts the modes into bands of half an octave by their ratios, the lowest first. Call it before [`Cells::climb`],
    /// after [`Cells::load`] and whenever ratios have changed. Real-time safe.
    pub(crate) fn sort_into_bands(&mut self) {
        // Several minima side by side, so that none waits for the one before.
        let mut lowest = [f64::INFINITY; 8];
        for cell in self.iter() {
            for ratios in cell.ratios[..cell.bank.len()].chunks(lowest.len()) {
                lowest.iter_mut().zip(ratios).for_each(|(lowest, ratio)| *lowest = lowest.min(*ratio));
            }
        }
        let per_lowest = 1.0 / lowest.into_iter().fold(f64::INFINITY, f64::min);
        for cell in self.iter_mut() {
            let len = cell.bank.len();
            for (band, ratio) in cell.bands.iter_mut().zip(&cell.ratios[..len]) {
                *band = half_octaves((ratio * per_lowest).max(1.0)).min(BANDS as u64 - 1) as u8;
            }
        }
    }

    /// Passes energy on to higher modes for one control tick. Must be called at control ticks only. The modes keep their phases;
    /// a mode at rest starts without displacement, up or down by a random sign. Does nothing with the original formulas.
    /// Real-time safe.
    pub(crate) fn climb(&mut self, climb: &Climb) {
        let mut bands = [Band::EMPTY; BANDS];
        self.iter().for_each(|cell| cell.bank.add_energies(&cell.bands, &mut bands));
        let total: f64 = bands.iter().map(|band| band.energy).sum();
        let energy = (total / climb.full).min(MOST_ENERGY);
        if energy < Climb::LEAST_ENERGY || energy.is_nan() {
            return;
        }
        let exchange = exchange(&bands, total, Climb { speed: climb.speed * energy, ..*climb });
        for (n, cell) in self.iter_mut().enumerate() {
            let sign = |m: usize| random::uniform(climb.key, (n * MAX_MODES + m) as u64);
            cell.bank.exchange(&cell.bands, &exchange, sign);
        }
    }
}

/// The whole number of half octaves of a ratio of at least 1. Rounding up or down at the edge of a band does not matter.
fn half_octaves(ratio: f64) -> u64 {
    const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;
    let octaves = (ratio.to_bits() >> MANTISSA_BITS) - (1.0_f64.to_bits() >> MANTISSA_BITS);
    // Of numbers of one octave, the greater one has the greater bits.
    let is_upper_half = ratio.to_bits() << 12 >= SQRT_2.to_bits() << 12;
    2 * octaves + u64::from(is_upper_half)
}

/// Computes the fraction that each band keeps, and the energy that each of its modes receives.
fn exchange(bands: &[Band; BANDS], total: f64, climb: Climb) -> [Exchange; BANDS] {
    let mut exchange = [Exchange::NONE; BANDS];
    let (mut speed, mut share) = (climb.speed, 1.0);
    let mut below: Option<(usize, f64)> = None;
    for (place, band) in bands.iter().enumerate() {
        share *= climb.share;
        if band.modes > 0 {
            if let Some((from, its_speed)) = below {
                let lower = bands[from].energy;
                let missing = share * lower - band.energy;
                let room = band.energy + f64::from(band.modes) * SEED * total;
                let flow = (f64::min(its_speed, MOST) * missing).min(room);
                if flow > 0.0 {
                    exchange[from].kept = 1.0 - flow / lower;
                    exchange[place].received = flow / f64::from(band.modes);
                }
            }
            (below, share) = (Some((place, speed)), 1.0);
        }
        speed *= SQRT_2;
    }
    exchange
}

#[cfg(test)]
#[path = "cascade_tests.rs"]
mod tests;
