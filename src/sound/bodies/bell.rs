//! Bells: a church bell, a hand bell, a tubular bell.

use super::bar::{self, Ends};
use super::bowl;
use super::material::Material;
use super::partial::{Pair, Partial};
use super::size::Size;
use libm::pow;
use std::f64::consts::SQRT_2;

/// Partials of a church bell, from the hum to (9,1), as measured: ratios to the prime, and numbers of nodal diameters
/// (Rossing and Perrin 1987; Fletcher and Rossing, "The Physics of Musical Instruments", table 21.1).
const CHURCH: [(f64, u32); 12] = [
    (0.5, 2),
    (1.0, 2),
    (1.183, 3),
    (1.506, 3),
    (2.0, 4),
    (2.514, 4),
    (2.662, 2),
    (3.011, 5),
    (4.166, 6),
    (5.433, 7),
    (6.796, 8),
    (8.215, 9),
];

/// A church bell: the measured partials and, above them, two series by Chladni's law `f = c (m + b)^p`, which bells
/// follow (Perrin, Charnley, Banu and Rossing 1985). The first continues the group of the nominal, `0.3831 (m −
/// 0.920)^1.468` from `m = 10` on, fitted to the measured partials. The second goes through 2.514 with the same law and
/// `(m − 0.398)`. All shapes are `cos m θ` round the bell, with the same height at the sound bow, the point where clappers
/// strike.
pub(super) fn church(count: usize) -> Vec<Partial> {
    const POWER: f64 = 1.468;
    let ring = |ratio: f64, m: u32| Partial::new(ratio, Pair::Diameters(m), |_| SQRT_2);
    let measured = CHURCH.iter().map(|(ratio, m)| ring(*ratio, *m));
    let first = (10..).map(|m| ring(0.383_1 * pow(f64::from(m) - 0.92, POWER), m));
    let second = (5..).map(|m| ring(2.514 * pow((f64::from(m) - 0.398) / (4.0 - 0.398), POWER), m));
    let above = count.saturating_sub(CHURCH.len());
    let mut all: Vec<Partial> = measured.chain(first.take(above)).chain(second.take(above)).collect();
    all.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    all.truncate(count);
    all
}

/// A hand bell: the ratios of a ring, except that founders tune the second mode to the twelfth, 1 : 3. Higher modes
/// keep their ratios to the second (Rossing and Sathoff 1980; Fletcher and Rossing, chapter 21).
pub(super) fn hand(count: usize) -> Vec<Partial> {
    let above = 3.0 / bowl::ring_ratio(3);
    let ratio = |m: u32| if m == 2 { 1.0 } else { above * bowl::ring_ratio(m) };
    (2..2 + count as u32).map(|m| Partial::new(ratio(m), Pair::Diameters(m), |_| SQRT_2)).collect()
}

/// A tubular bell: a free bar. Its fourth, fifth and sixth modes are near 2 : 3 : 4 and are heard as a tone an octave
/// below the fourth (Rossing 1976; Fletcher and Rossing, chapter 19). That tone is the pitch here.
pub(super) fn tubular(count: usize) -> Vec<Partial> {
    let fourth = bar::wave_number(Ends::Free, 4);
    (1..=count)
        .map(|k| bar::wave_number(Ends::Free, k))
        .map(|beta| {
            let ratio = 2.0 * beta * beta / (fourth * fourth);
            Partial::new(ratio, Pair::Directions, move |at| bar::shape(Ends::Free, beta, at.x))
        })
        .collect()
}

/// Pitch in Hz of a tubular bell with a thin wall and the diameter `d = thickness`: its radius of gyration is `d/√8`.
pub(super) fn frequency(size: &Size, material: &Material) -> f64 {
    0.5 * bar::bending(bar::wave_number(Ends::Free, 4), size, material, size.thickness / 8.0_f64.sqrt())
}
