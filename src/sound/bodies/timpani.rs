//! A kettledrum: a membrane that moves the air on both sides, above a kettle that encloses some of it.

use super::membrane::Mode;
use super::partial::{Pair, Partial, Point};
use super::roots;
use libm::jn;
use std::f64::consts::PI;

/// Density of air in kg/m³ and speed of sound in m/s, at 20 °C.
const AIR: f64 = 1.204;
const SOUND: f64 = 343.2;

/// Number of modes without nodal diameters that the kettle's air couples. It hardly affects higher ones.
const ROUND: usize = 24;

/// The dimensions of a kettledrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drum {
    /// Radius of the head in metres.
    pub radius: f64,
    /// Mass of the head per area, in kg/m².
    pub density: f64,
    /// Volume of the kettle in m³.
    pub volume: f64,
}

impl Drum {
    /// The 65 cm drum with a Mylar head that Rossing (1982) and Christian et al. (1984) measured.
    pub(crate) const DEFAULT: Drum = Drum { radius: 0.328, density: 0.262, volume: 0.14 };
}

/// One mode during the computation: its `ω²` in 1/s², and the membrane modes it consists of, with their shares.
struct Loaded {
    omega2: f64,
    parts: Vec<(f64, Mode)>,
}

/// The drum whose mode (1,1), which is heard as its pitch, has this frequency in Hz.
///
/// Air that moves with a mode adds mass. With `Φ(κ)` as the mode's spectrum over wave numbers κ, each side adds `ρ
/// ∫|Φ|² dκ` to the head's `σ ∫|Φ|² κ dκ` (a baffled head whose waves are slower than sound; Morse and Ingard,
/// "Theoretical Acoustics" (1968), by Parseval's theorem). For a mode `(m,n)`, `Φ` is `k J_{m+1}(k) J_m(κ)/(k² − κ²)`.
/// The kettle's air is a spring `ρ c²/V` against changes of volume. It couples all modes without nodal diameters: an
/// equation of rank one, solved exactly. Inside the kettle this spring replaces the air's mass for these modes, so they
/// carry the mass of one side only.
/// The part of `Φ` below `ω/c` leaves as sound: it damps (0,1) within a tenth of a second, while (3,1) keeps ringing.
/// At 150 Hz the ratios are 0.90 : 1 : 1.46 : 1.90 : 2.34 : 2.76; measured are 0.85 : 1 : 1.51 : 1.99 : 2.44 : 2.89
/// (Rossing 1982). The difference comes from the head's stiffness and from a rim without a baffle (Christian, Davis,
/// Tubis, Anderson, Mills and Rossing 1984, who solve the full drum): an inharmonicity of 0.02 moves (2,1) to (4,1) to
/// 1.48 : 1.95 : 2.44.
pub(super) fn partials(drum: &Drum, frequency: f64, count: usize) -> Vec<Partial> {
    let load = AIR * drum.radius / drum.density;
    let mut modes = Mode::lowest(count.max(2));
    modes.truncate(count);
    let mut masses = Masses::default();
    let mut mass = |mode: Mode| 1.0 + load * masses.air(mode) * if mode.m == 0 { 1.0 } else { 2.0 };
    // The square of (wave speed over radius) that gives (1,1) its frequency.
    let pitch = Mode { m: 1, k: J_11 };
    let omega = 2.0 * PI * frequency;
    let speed2 = omega * omega * mass(pitch) / (J_11 * J_11);

    let (round, others): (Vec<Mode>, Vec<Mode>) = modes.into_iter().partition(|mode| mode.m == 0);
    let mut free = |mode: Mode| {
        let mass = mass(mode);
        Loaded { omega2: speed2 * mode.k * mode.k / mass, parts: vec![(1.0 / mass.sqrt(), mode)] }
    };
    let mut loaded: Vec<Loaded> = others.into_iter().map(&mut free).collect();
    let round: Vec<Loaded> = round.into_iter().map(free).collect();
    let stiffness = AIR * SOUND * SOUND * PI * drum.radius * drum.radius / (drum.volume * drum.density);
    loaded.extend(on_a_spring(round, stiffness));

    let mut partials: Vec<Partial> = loaded
        .into_iter()
        .map(|mode| {
            let own = mode.omega2.sqrt();
            let radiation = 0.5 * load * own * radiated(&mode.parts, own * drum.radius / SOUND);
            Partial { radiation, ..partial(own / omega, mode.parts) }
        })
        .collect();
    partials.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    partials
}

/// The first zero of `J_1`.
const J_11: f64 = 3.831_705_970_207_512;

fn partial(ratio: f64, parts: Vec<(f64, Mode)>) -> Partial {
    let pair = parts.first().map_or(Pair::Single, |(_, mode)| mode.pair());
    let shapes: Vec<_> = parts.into_iter().map(|(share, mode)| (share, mode.shape())).collect();
    Partial::new(ratio, pair, move |at: Point| shapes.iter().map(|(share, shape)| share * shape(at)).sum())
}

/// Mass of the air that moves with modes: `2k² ∫ J_m(κ)²/(k² − κ²)² dκ`, in units of ρ · radius / σ for each side.
///
/// The integrand is even, entire and of exponential type 2, so its sum over integer κ is exactly the integral
/// (Poisson's summation formula: the other terms are zero for steps below π).
#[derive(Default)]
struct Masses {
    /// `J_m(κ)²` at κ = 0, 1, 2 …, for each m used so far.
    squares: Vec<Vec<f64>>,
}

impl Masses {
    fn air(&mut self, Mode { m, k }: Mode) -> f64 {
        let last = 100 + 4 * k as usize;
        if self.squares.len() <= m as usize {
            self.squares.resize(m as usize + 1, Vec::new());
        }
        let row = &mut self.squares[m as usize];
        for kappa in row.len()..=last {
            let value = jn(m as i32, kappa as f64);
            row.push(value * value);
        }
        let term = |kappa: usize| {
            let kappa_f = kappa as f64;
            let gap = k * k - kappa_f * kappa_f;
            row[kappa] / (gap * gap) * if kappa == 0 { 0.5 } else { 1.0 }
        };
        2.0 * k * k * (0..=last).map(term).sum::<f64>()
    }
}

/// Couples modes by one spring that acts on their volume: `1 = γ Σ b_i² / (ω² − ω_i²)`, with one root above each
/// `ω_i²`.
fn on_a_spring(modes: Vec<Loaded>, stiffness: f64) -> Vec<Loaded> {
    let (joined, mut out): (Vec<_>, Vec<_>) = {
        let mut modes = modes;
        let rest = modes.split_off(modes.len().min(ROUND));
        (modes, rest)
    };
    // The mean displacement of a shape with mean square 1 is ±2/k; each part of a mode contributes its share of this.
    let volume = |mode: &Loaded| mode.parts.iter().map(|(share, part)| share * sign(*part) * 2.0 / part.k).sum::<f64>();
    let b: Vec<f64> = joined.iter().map(volume).collect();
    let highest = stiffness * b.iter().map(|b| b * b).sum::<f64>();
    for i in 0..joined.len() {
        let low = joined[i].omega2;
        let high = joined.get(i + 1).map_or(low + highest, |next| next.omega2);
        // Multiplied by the distances to both neighbouring poles, the equation is finite at the ends of the bracket.
        let equation = |omega2: f64| {
            let mut others = 1.0;
            let (mut own, mut next) = (0.0, if i + 1 < joined.len() { 0.0 } else { 1.0 });
            for (j, mode) in joined.iter().enumerate() {
                let part = stiffness * b[j] * b[j];
                if j == i {
                    own = part;
                } else if j == i + 1 {
                    next = part;
                } else {
                    others -= part / (omega2 - mode.omega2);
                }
            }
            let (above, below) = (omega2 - low, omega2 - high);
            if i + 1 < joined.len() {
                others * above * below - own * below - next * above
            } else {
                others * above - own
            }
        };
        let omega2 = roots::between(equation, low, high);
        let weights: Vec<f64> = joined.iter().zip(&b).map(|(mode, b)| b / (omega2 - mode.omega2)).collect();
        let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let part = |(mode, weight): (&Loaded, f64)| (mode.parts[0].0 * weight / norm, mode.parts[0].1);
        if norm.is_finite() {
            out.push(Loaded { omega2, parts: joined.iter().zip(weights).map(part).collect() });
        } else {
            out.push(Loaded { omega2, parts: joined[i].parts.clone() });
        }
    }
    out
}

/// The sign of `J_{m+1}(k)`, which is the sign of the shape's mean and of its spectrum at κ = 0.
fn sign(mode: Mode) -> f64 {
    if jn(mode.m as i32 + 1, mode.k) < 0.0 { -1.0 } else { 1.0 }
}

/// The radiated sound: `2 ∫ |Φ|² κ dκ / √(u² − κ²)` from 0 to `u = ω·radius/c`, which equals `2 ∫ |Φ|² dz` over `z =
/// √(u² − κ²)`, by Simpson's rule.
fn radiated(parts: &[(f64, Mode)], u: f64) -> f64 {
    let Some((_, Mode { m, .. })) = parts.first() else { return 0.0 };
    let spectrum = |kappa: f64| -> f64 {
        let j = jn(*m as i32, kappa);
        parts.iter().map(|(share, mode)| share * sign(*mode) * mode.k * over_gap(j, *mode, kappa)).sum()
    };
    let steps = 16 + 4 * (u as usize);
    let term = |i: usize| {
        let z = u * i as f64 / steps as f64;
        let value = spectrum((u * u - z * z).max(0.0).sqrt());
        value * value * if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 }
    };
    2.0 * u / (3.0 * steps as f64) * (0..=steps).map(term).sum::<f64>()
}

/// `J_m(κ) / (k² − κ²)`, where `j` is `J_m(κ)`; also correct where both are zero.
fn over_gap(j: f64, Mode { m, k }: Mode, kappa: f64) -> f64 {
    let gap = k * k - kappa * kappa;
    if gap.abs() < 1e-6 * k * k { jn(m as i32 + 1, k) / (2.0 * k) } else { j / gap }
}

/// Frequency in Hz of the mode (1,1) of a drum with this tension in N/m.
pub(super) fn frequency(drum: &Drum, tension: f64) -> f64 {
    let mass = 1.0 + 2.0 * AIR * drum.radius / drum.density * Masses::default().air(Mode { m: 1, k: J_11 });
    J_11 / (2.0 * PI * drum.radius) * (tension / (drum.density * mass)).sqrt()
}
