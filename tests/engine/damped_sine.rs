//! Least-squares fit of one damped sinusoid, which gives the frequency and the T60 of a recording.
//!
//! The model is `A·rⁿ·sin(nθ + φ)`. It is linear in `A sin φ` and `A cos φ`, which are eliminated at each step
//! (variable projection, Golub & Pereyra 1973), and nonlinear in `θ` and `ln r`, which Gauss–Newton improves.

use libm::{acos, atan2, exp, hypot, log, sincos, sqrt};
use std::f64::consts::PI;

/// ln 1000: the decay exponent of 60 dB.
pub(crate) const LN_60_DB: f64 = 6.907_755_278_982_137;
/// Samples after which the recurrence for `zⁿ` starts from an exact power again.
const ANCHOR: usize = 1024;
/// Samples from which a start is found without a guess: seven cycles of 20 Hz at 192 kHz.
const START_LENGTH: usize = 65_536;

/// `amplitude · 0.001^(t / t60) · sin(2π · frequency · t + phase)`, with `t` in seconds from the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DampedSine {
    /// Hz.
    pub(crate) frequency: f64,
    /// Seconds in which the amplitude falls by 60 dB; infinite if it does not fall.
    pub(crate) t60: f64,
    /// At the first sample.
    pub(crate) amplitude: f64,
    /// Radians at the first sample, −π to π.
    pub(crate) phase: f64,
    /// Level of the residual, in dB relative to the signal's RMS.
    pub(crate) residual_db: f64,
}

/// Fits a damped sinusoid to all of `samples`, from a start within a few per cent of the truth.
///
/// The fit begins with some twenty cycles and doubles the stretch until it covers everything, since the phase of the
/// guess would be wrong after more cycles. Clean data of at least one cycle resolves frequency to 10⁻⁶ cents and T60 to
/// 10⁻⁸. `None` for fewer than eight samples, silence, samples that are not finite and fits that do not converge.
pub(crate) fn fit<T: Copy + Into<f64>>(
    samples: &[T],
    sample_rate: f64,
    frequency_guess: f64,
    t60_guess: f64,
) -> Option<DampedSine> {
    let usable = frequency_guess > 0.0 && t60_guess > 0.0 && sample_rate > 0.0;
    let start = Pole {
        log_radius: -LN_60_DB / (t60_guess * sample_rate),
        theta: (2.0 * PI * frequency_guess / sample_rate).min(PI),
    };
    if usable { refine(samples, sample_rate, start) } else { None }
}

/// Fits a damped sinusoid of unknown frequency and T60 to all of `samples`; `None` as for [`fit`].
pub(crate) fn fit_unknown<T: Copy + Into<f64>>(samples: &[T], sample_rate: f64) -> Option<DampedSine> {
    refine(samples, sample_rate, linear_prediction(&samples[..samples.len().min(START_LENGTH)])?)
}

/// `ln z` of a pole `z = r·e^(iθ)`, per sample.
#[derive(Clone, Copy)]
struct Pole {
    log_radius: f64,
    theta: f64,
}

impl Pole {
    /// Calls `visit(n, Re zⁿ, Im zⁿ)` for every `n` below `len`.
    fn for_each_power(self, len: usize, mut visit: impl FnMut(usize, f64, f64)) {
        let power = |n: usize| {
            let radius = exp(self.log_radius * n as f64);
            let (sin, cos) = sincos(self.theta * n as f64);
            (radius * cos, radius * sin)
        };
        let (step_re, step_im) = power(1);
        for base in (0..len).step_by(ANCHOR) {
            let (mut re, mut im) = power(base);
            for n in base..len.min(base + ANCHOR) {
                visit(n, re, im);
                (re, im) = (re * step_re - im * step_im, re * step_im + im * step_re);
            }
        }
    }
}

/// The sums over the data that a Gauss–Newton step needs at one pole, gathered in one pass. With `u`, `w` the real and
/// imaginary part of `zⁿ` and `τ = n / len`: sums of `τᵏ(u², uw, w²)` and of `τᵏ(yu, yw)`.
#[derive(Default)]
struct Moments {
    basis: [[f64; 3]; 3],
    data: [[f64; 2]; 2],
    energy: f64,
}

impl Moments {
    fn gather<T: Copy + Into<f64>>(samples: &[T], pole: Pole) -> Self {
        let mut sums = Self::default();
        let scale = 1.0 / samples.len() as f64;
        pole.for_each_power(samples.len(), |n, u, w| {
            let y: f64 = samples[n].into();
            let tau = n as f64 * scale;
            sums.energy += y * y;
            let mut weight = 1.0;
            for k in 0..3 {
                let (wu, ww) = (weight * u, weight * w);
                sums.basis[k][0] += wu * u;
                sums.basis[k][1] += wu * w;
                sums.basis[k][2] += ww * w;
                if k < 2 {
                    sums.data[k][0] += wu * y;
                    sums.data[k][1] += ww * y;
                }
                weight *= tau;
            }
        });
        sums
    }

    /// The best `(A sin φ, A cos φ)` at this pole.
    fn amplitudes(&self) -> Option<[f64; 2]> {
        let [uu, uw, ww] = self.basis[0];
        let [yu, yw] = self.data[0];
        solve([[uu, uw], [uw, ww]], [yu, yw])
    }

    /// Unexplained share of the energy with these amplitudes; good to about 10⁻¹⁵.
    fn unexplained(&self, [a, b]: [f64; 2]) -> f64 {
        1.0 - (a * self.data[0][0] + b * self.data[0][1]) / self.energy
    }

    /// Change of `(ln r, θ)` that Gauss–Newton proposes, over the whole length (so `τ`, not `n`, multiplies it).
    fn step(&self, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
        // The model's derivatives are u, w, τ(au + bw) and τ(bu − aw): all products of two are sums of the moments.
        let directions = [(0, 1.0, 0.0), (0, 0.0, 1.0), (1, a, b), (1, b, -a)];
        let product = |(i, p, q): (usize, f64, f64), (j, s, t): (usize, f64, f64)| {
            let [uu, uw, ww] = self.basis[i + j];
            p * s * uu + (p * t + q * s) * uw + q * t * ww
        };
        let normal = directions.map(|row| directions.map(|column| product(row, column)));
        let gradient = directions.map(|direction| {
            let (k, p, q) = direction;
            p * self.data[k][0] + q * self.data[k][1] - product(direction, (0, a, b))
        });
        let [_, _, log_radius, theta] = solve(normal, gradient)?;
        Some([log_radius, theta])
    }
}

/// Solves a symmetric positive system by elimination with row pivoting, scaled to a unit diagonal beforehand.
fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    let mut scale = [0.0; N];
    for i in 0..N {
        if !(matrix[i][i] > 0.0 && matrix[i][i].is_finite()) {
            return None;
        }
        scale[i] = 1.0 / sqrt(matrix[i][i]);
    }
    for i in 0..N {
        right[i] *= scale[i];
        for j in 0..N {
            matrix[i][j] *= scale[i] * scale[j];
        }
    }
    for column in 0..N {
        let pivot = (column..N).max_by(|i, j| matrix[*i][column].abs().total_cmp(&matrix[*j][column].abs()))?;
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        if matrix[column][column].abs() < 1e-14 {
            return None;
        }
        for row in column + 1..N {
            let factor = matrix[row][column] / matrix[column][column];
            let pivot_row = matrix[column];
            matrix[row].iter_mut().zip(pivot_row).for_each(|(entry, above)| *entry -= factor * above);
            right[row] -= factor * right[column];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|k| matrix[row][k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    (0..N).for_each(|i| right[i] *= scale[i]);
    Some(right)
}

/// Improves `pole` on stretches that double from twenty cycles to everything.
fn refine<T: Copy + Into<f64>>(samples: &[T], sample_rate: f64, mut pole: Pole) -> Option<DampedSine> {
    if samples.len() < 8 || samples.iter().any(|sample| !(*sample).into().is_finite()) {
        return None;
    }
    let mut len = ((20.0 * 2.0 * PI / pole.theta) as usize).clamp(64, usize::MAX / 4);
    while len < samples.len() {
        pole = gauss_newton(&samples[..len], pole, 1e-3)?;
        len *= 2;
    }
    pole = gauss_newton(samples, pole, 1e-9)?;
    finish(samples, sample_rate, pole)
}

/// Gauss–Newton with step halving until a step turns the end of the stretch by less than `tolerance` radians.
fn gauss_newton<T: Copy + Into<f64>>(samples: &[T], mut pole: Pole, tolerance: f64) -> Option<Pole> {
    let len = samples.len() as f64;
    let mut moments = Moments::gather(samples, pole);
    let mut amplitudes = moments.amplitudes()?;
    for _ in 0..60 {
        let mut step = moments.step(amplitudes)?;
        let before = moments.unexplained(amplitudes);
        loop {
            let turned = Pole {
                // No oscillator here grows by more than e³⁰ over the stretch, and more would overflow.
                log_radius: (pole.log_radius + step[0] / len).min(30.0 / len),
                theta: (pole.theta + step[1] / len).clamp(1e-9, PI),
            };
            let small = step[0].abs() < tolerance && step[1].abs() < tolerance;
            let gathered = Moments::gather(samples, turned);
            let fitted = gathered.amplitudes();
            // Close to the optimum, `unexplained` consists of rounding errors and cannot judge a small step: accept it.
            match fitted.filter(|fitted| small || gathered.unexplained(*fitted) <= before + 1e-13) {
                Some(fitted) => (pole, moments, amplitudes) = (turned, gathered, fitted),
                None if small => return Some(pole),
                None => {
                    step = step.map(|component| component / 2.0);
                    continue;
                }
            }
            if small {
                return Some(pole);
            }
            break;
        }
    }
    None
}

/// The fit at its final pole, with the residual measured sample by sample.
fn finish<T: Copy + Into<f64>>(samples: &[T], sample_rate: f64, pole: Pole) -> Option<DampedSine> {
    let moments = Moments::gather(samples, pole);
    let [a, b] = moments.amplitudes()?;
    let mut residual = 0.0;
    pole.for_each_power(samples.len(), |n, u, w| {
        let y: f64 = samples[n].into();
        let left = y - a * u - b * w;
        residual += left * left;
    });
    let t60 = if pole.log_radius < 0.0 { -LN_60_DB / (pole.log_radius * sample_rate) } else { f64::INFINITY };
    Some(DampedSine {
        frequency: pole.theta * sample_rate / (2.0 * PI),
        t60,
        amplitude: hypot(a, b),
        phase: atan2(a, b),
        residual_db: 10.0 * libm::log10(residual / moments.energy),
    })
}

/// A start without a guess: the two-term linear prediction `y[n+k] = 2 rᵏ cos(kθ) y[n] − r²ᵏ y[n−k]` (Prony 1795) by
/// least squares, for strides `k` of 1, 2, 4, …; the stride that explains most of the data is used. A stride of about a
/// quarter cycle is well conditioned at any frequency; longer ones alias and explain nothing.
fn linear_prediction<T: Copy + Into<f64>>(samples: &[T]) -> Option<Pole> {
    let mut best: Option<(f64, Pole)> = None;
    for stride in (0..).map(|power| 1_usize << power).take_while(|stride| 4 * stride <= samples.len()) {
        let (mut aa, mut ab, mut bb, mut ya, mut yb) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for n in 0..samples.len() - 2 * stride {
            let (b, a, y): (f64, f64, f64) =
                (samples[n].into(), samples[n + stride].into(), samples[n + 2 * stride].into());
            (aa, ab, bb) = (aa + a * a, ab + a * b, bb + b * b);
            (ya, yb) = (ya + y * a, yb + y * b);
        }
        let Some([p, q]) = solve([[aa, ab], [ab, bb]], [ya, yb]) else { continue };
        let radius = sqrt((-q).max(0.0));
        let cosine = p / (2.0 * radius);
        if !(radius > 0.0 && cosine.abs() < 1.0) {
            continue;
        }
        let pole = Pole { log_radius: log(radius) / stride as f64, theta: acos(cosine) / stride as f64 };
        let moments = Moments::gather(samples, pole);
        let Some(amplitudes) = moments.amplitudes() else { continue };
        let unexplained = moments.unexplained(amplitudes);
        if best.is_none_or(|(least, _)| unexplained < least) {
            best = Some((unexplained, pole));
        }
    }
    best.map(|(_, pole)| pole)
}
