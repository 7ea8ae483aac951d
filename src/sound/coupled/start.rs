//! First guesses of the poles: the poles of a joint without losses, with damping to first order.

use super::complex::Complex;
use super::system::{Place, System};

/// A guess for each pair of poles. The guesses interlace with the undamped frequencies, so no two are equal. `ease` is
/// the factor by which the joint is softer for the guesses.
pub(super) fn guesses(system: &System, ease: f64) -> Vec<Place> {
    let gaps = system.len().saturating_sub(1);
    let within = (0..gaps).map(|j| {
        let gap = square_gap(system, j + 1, j);
        guess(system, j, root_in_gap(system, ease, j, gap), gap)
    });
    // A rigid joint removes one degree of freedom.
    let last = (!system.coupling.rigid && !system.frequency.is_empty())
        .then(|| guess(system, gaps, root_above(system, ease), f64::INFINITY));
    within.chain(last).collect()
}

fn square(system: &System, k: usize) -> f64 {
    system.pole(k).norm2()
}

/// The difference of the squares of two undamped frequencies.
fn square_gap(system: &System, j: usize, k: usize) -> f64 {
    let (frequency, rate) = (&system.frequency, &system.rate);
    (frequency[j] - frequency[k]) * (frequency[j] + frequency[k]) + (rate[j] - rate[k]) * (rate[j] + rate[k])
}

/// The inverse of the joint's stiffness at an undamped frequency with this square; its damping counts as stiffness.
fn compliance(system: &System, square: f64) -> f64 {
    let coupling = &system.coupling;
    if coupling.rigid {
        0.0
    } else {
        1.0 / (coupling.stiffness * coupling.stiffness + coupling.damping * coupling.damping * square).sqrt()
    }
}

/// The root between two neighbouring frequencies, as a distance above the lower one. The contributions of all other
/// modes are taken in the middle of the gap (Li, "Solving secular equations stably and efficiently", LAPACK Working
/// Note 89, 1994).
fn root_in_gap(system: &System, ease: f64, j: usize, gap: f64) -> f64 {
    let middle = 0.5 * gap;
    let mut rest = ease * compliance(system, square(system, j) + middle);
    for k in (0..j).chain(j + 2..system.len()) {
        rest += system.weight[k] / (square_gap(system, k, j) - middle);
    }
    let (below, above) = (system.weight[j], system.weight[j + 1]);
    let sum = rest * gap + below + above;
    let difference = rest * gap - below + above;
    let root = (difference * difference + 4.0 * below * above).sqrt();
    let found = if sum > 0.0 { 2.0 * below * gap / (sum + root) } else { (sum - root) / (2.0 * rest) };
    if (0.0..=gap).contains(&found) { found } else { middle }
}

/// The root above all frequencies, as a distance from the highest, by bisection.
fn root_above(system: &System, ease: f64) -> f64 {
    let top = system.len() - 1;
    let is_below = |above: f64| {
        let mut sum = ease * compliance(system, square(system, top) + above);
        for k in 0..system.len() {
            sum -= system.weight[k] / (above - square_gap(system, k, top));
        }
        sum < 0.0
    };
    let stiffness = 1.0 / (ease * compliance(system, square(system, top)));
    let (mut low, mut high) = (0.0, system.weight.iter().sum::<f64>() * stiffness);
    while is_below(high) && high < 1e280 {
        (low, high) = (high, 4.0 * high);
    }
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The place of an undamped root whose square is larger than that of frequency `j` by `above`.
fn guess(system: &System, j: usize, above: f64, gap: f64) -> Place {
    let (origin, shift) = if above <= 0.5 * gap { (j, above) } else { (j + 1, above - gap) };
    let frequency = system.frequency[origin];
    let square = frequency * frequency + shift;
    let rise =
        if square > 0.01 * frequency * frequency { shift / (square.sqrt() + frequency) } else { -0.9 * frequency };
    // The damping of each mode, weighted by its share in the motion at the joint, and the damping of the joint itself.
    let (mut mass, mut damping) = (0.0, 0.0);
    for k in 0..system.len() {
        // Measured from the nearer end of the gap; otherwise the difference of two close frequencies would lose its
        // digits.
        let distance = square_gap(system, k, origin) - shift;
        let share = system.weight[k] / (distance * distance);
        if share.is_finite() {
            mass += share;
            damping += share * (system.rate[k] - system.rate[origin]);
        }
    }
    let compliance = compliance(system, self::square(system, origin) + shift);
    damping += 0.5 * system.coupling.damping * compliance * compliance;
    let more = if mass > 0.0 { damping / mass } else { 0.0 };
    system.place(origin, Complex::new(-more, rise))
}
