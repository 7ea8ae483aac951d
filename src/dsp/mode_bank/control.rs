//! What a bank does now and then, for all modes at once: coefficients when decay changes, sweeps at control ticks,
//! and taking stock of what still rings.

use super::MAX_MODES;
use super::kernel::{Modes, Row, State};
use super::vector::{LANES, Partial, Vector};
use super::{HIGHEST_LEVEL, TOP_ANGLE};
use std::f64::consts::PI;

/// A double-precision number for each mode.
pub(super) type Wide = [f64; MAX_MODES];

/// The exact law's view of each mode: what its coefficients and its sweep are made from.
#[derive(Clone, Debug)]
pub(super) struct Pitch {
    /// Half the angle per sample at a pitch ratio of 1, which may be beyond what can sound.
    pub(super) half_angle: Row,
    /// `(1−r)²`, `4r` and `1/ω²`.
    pub(super) loss2: Row,
    pub(super) four_radius: Row,
    pub(super) compliance: Row,
    /// Level at a pitch ratio of 1.
    pub(super) rest_level: Row,
    /// `1/√cos(θ/2)` at a pitch ratio of 1.
    pub(super) inverse_bow: Row,
    /// Velocity and displacement that ring with unit amplitude.
    pub(super) unit_push: Row,
    pub(super) unit_pull: Row,
}

impl Pitch {
    pub(super) const UNSET: Pitch = Pitch {
        half_angle: Row::ZERO,
        loss2: Row::ZERO,
        four_radius: Row::ONE,
        compliance: Row::ZERO,
        rest_level: Row::ONE,
        inverse_bow: Row::ONE,
        unit_push: Row::ZERO,
        unit_pull: Row::ZERO,
    };

    /// The coefficients of [`crate::dsp::Coefficients::exact`] for the first `len` modes, from the logarithm of each
    /// one's radius (at least −1.8) and half its angle. Plain double precision without a branch: vectorised by the
    /// compiler, 1e−12 from the exact values. A fifth of the time of `libm`'s exponential and sine.
    #[inline(always)]
    pub(super) fn tune(&mut self, modes: &mut Modes, ln_radius: &Wide, half_angle: &Wide, len: usize) {
        let top = 0.5 * TOP_ANGLE;
        for m in 0..len.min(MAX_MODES) {
            let half = if half_angle[m] < top { half_angle[m] } else { top };
            // r − 1 and r² − 1, each from the last by (1+u)² − 1 = u (2+u): no digit is lost for r close to 1.
            let u = expm1_near_zero(0.25 * ln_radius[m]);
            let u = u * (2.0 + u);
            let less = u * (2.0 + u);
            let zeta = -(less * (2.0 + less));
            let radius = 1.0 + less;
            let half_chord = sin_to_right_angle(half);
            let chord2 = half_chord * half_chord;
            let omega2 = less * less + 4.0 * radius * chord2;
            let bow = (1.0 - chord2).sqrt();
            let edge = ((PI - 2.0 * half_angle[m]) * (1.0 / (PI - TOP_ANGLE))).clamp(0.0, 1.0);
            // sin θ / r, and the displacement of the same energy.
            let unit_push = 2.0 * half_chord * bow / radius;
            modes.zeta.0[m] = zeta as f32;
            modes.omega2.0[m] = omega2 as f32;
            self.half_angle.0[m] = half_angle[m] as f32;
            self.loss2.0[m] = (less * less) as f32;
            self.four_radius.0[m] = (4.0 * radius) as f32;
            self.compliance.0[m] = (1.0 / omega2) as f32;
            self.rest_level.0[m] = edge as f32;
            self.inverse_bow.0[m] = (1.0 / bow.sqrt()) as f32;
            // Modes that are beyond the spectrum at a ratio of 1 are struck only while they are swept into it.
            let within = half_angle[m] < 0.5 * PI;
            modes.least.0[m] = if within { LEAST_LEVEL / bow.sqrt() } else { 0.0 } as f32;
            self.unit_push.0[m] = unit_push as f32;
            self.unit_pull.0[m] = (unit_push * radius / omega2.sqrt()) as f32;
        }
    }

    /// Sends sweep and level of the first `len` modes on straight lines to where a pitch `ratio` other than 1 wants
    /// them, at `1/frames = per_frame` of the way a frame; puts them there at once if `jump`.
    #[inline(always)]
    pub(super) fn aim<V: Vector>(&self, modes: &mut Modes, ratio: f32, per_frame: f32, jump: bool, len: usize) {
        let (one, zero) = (V::splat(1.0), V::splat(0.0));
        let per_frame = V::splat(per_frame);
        let mut at = 0;
        while at < len {
            let wanted = self.half_angle.at::<V>(at).mul(V::splat(ratio));
            let half = wanted.min(V::splat((0.5 * TOP_ANGLE) as f32));
            let half_chord = sine::<V>(half);
            let stiffness = self.four_radius.at::<V>(at).mul_add(half_chord.mul(half_chord), self.loss2.at(at));
            let sweep = stiffness.mul(self.compliance.at(at)).sqrt();
            let bow = cosine::<V>(half).sqrt().mul(self.inverse_bow.at(at));
            let edge = V::splat((0.5 * PI) as f32).sub(wanted).mul(V::splat((2.0 / (PI - TOP_ANGLE)) as f32));
            let level = edge.max(zero).min(one).mul(bow.min(V::splat(HIGHEST_LEVEL)));
            if jump {
                sweep.store(&mut modes.sweep.0[at..]);
                level.store(&mut modes.level.0[at..]);
            }
            sweep.sub(modes.sweep.at::<V>(at)).mul(per_frame).store(&mut modes.sweep_step.0[at..]);
            level.sub(modes.level.at::<V>(at)).mul(per_frame).store(&mut modes.level_step.0[at..]);
            at += V::WIDTH;
        }
    }

    /// Adds up the squared amplitudes at which the first `len` modes ring, as heard, and sets to rest those below
    /// [`REST`]. Returns the sum in units of [`UNIT`]².
    ///
    /// An amplitude follows from `A² sin²θ = ω²x² + (ζ−ω²)xv + (1−ζ)v²` ([`crate::dsp::Coefficients::energy`]) with
    /// the sweep taken in (`ω² → s²ω²`, `v → s v`); `sin²θ = 4q(1−q)` with `q = sin²(θ/2)`.
    ///
    /// If `ahead`, the state is that of the tables, `x = A sin φ` and `A cos φ`.
    #[inline(always)]
    pub(super) fn take_stock<V: Vector>(&self, modes: &Modes, state: &mut State, ahead: bool, len: usize) -> f32 {
        let one = V::splat(1.0);
        let mut total = Partial([0.0; LANES]);
        let mut at = 0;
        while at < len {
            let x = state.x.at::<V>(at).mul(V::splat(1.0 / UNIT));
            let v = state.v.at::<V>(at).mul(V::splat(1.0 / UNIT));
            // One that a sweep holds above the spectrum is silent but not at rest.
            let level = modes.level.at::<V>(at).max(modes.least.at(at));
            let energy = if ahead { x.mul(x).add(v.mul(v)) } else { self.energy(modes, at, x, v) };
            let lane = &mut total.0[at % LANES..];
            V::load(lane).add(energy.mul(level).mul(level)).store(lane);
            // 1 for a mode that rings and 0 for one that does not.
            let rings = energy.mul(V::splat(1e30)).sub(V::splat(1e30 * (REST / UNIT) * (REST / UNIT)));
            let rings = rings.max(V::splat(0.0)).mul(V::splat(1e30)).min(one);
            state.x.at::<V>(at).mul(rings).store(&mut state.x.0[at..]);
            state.v.at::<V>(at).mul(rings).store(&mut state.v.0[at..]);
            at += V::WIDTH;
        }
        let mut sum = [0.0];
        V::sum_lanes(&[total], &mut sum);
        sum[0]
    }

    #[inline(always)]
    fn energy<V: Vector>(&self, modes: &Modes, at: usize, x: V, v: V) -> V {
        let (one, zeta, sweep) = (V::splat(1.0), modes.zeta.at::<V>(at), modes.sweep.at::<V>(at));
        let omega2 = modes.omega2.at::<V>(at).mul(sweep).mul(sweep);
        let chord2 = omega2.sub(self.loss2.at(at)).div(self.four_radius.at(at)).max(V::splat(1e-12));
        let sin2 = V::splat(4.0).mul(chord2).mul(one.sub(chord2).max(V::splat(1e-6)));
        let v = v.mul(sweep);
        let form = omega2.mul(x).mul(x).add(zeta.sub(omega2).mul(x).mul(v)).add(one.sub(zeta).mul(v).mul(v));
        form.max(V::splat(0.0)).div(sin2)
    }
}

/// `√cos(θ/2)` at the top of the spectrum, `θ =` [`TOP_ANGLE`].
const LEAST_LEVEL: f64 = 0.177_230_806_5;

/// Amplitudes are counted in units of this, so that the squares of the smallest that matter are normal numbers.
pub(super) const UNIT: f32 = 1.0 / (1_u64 << 40) as f32;

/// A mode with less amplitude than this is set to rest before it can become denormal.
const REST: f32 = 1e-20;

/// `e^y − 1` for −0.45 ≤ y ≤ 0, by its series.
#[inline(always)]
fn expm1_near_zero(y: f64) -> f64 {
    // The first term left out is below 1e−16 of the sum.
    let mut sum = 1.0;
    for n in [13.0, 12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0] {
        sum = 1.0 + sum * y * (1.0 / n);
    }
    sum * y
}

/// `sin x` for 0 ≤ x ≤ π/2, by its series, within 5e−15.
#[inline(always)]
fn sin_to_right_angle(x: f64) -> f64 {
    let x2 = x * x;
    let mut sum = 1.0;
    for n in [18.0_f64, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0, 2.0] {
        sum = 1.0 - sum * x2 * (1.0 / (n * (n + 1.0)));
    }
    sum * x
}

/// `sin x` for 0 ≤ x ≤ π/2 in single precision: the series to x¹¹, within 1.3e−7.
#[inline(always)]
fn sine<V: Vector>(x: V) -> V {
    let x2 = x.mul(x);
    let mut sum = V::splat(-1.0 / 39_916_800.0);
    for term in [1.0 / 362_880.0, -1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0] {
        sum = sum.mul_add(x2, V::splat(term));
    }
    sum.mul(x2).mul_add(x, x)
}

/// `cos x` for 0 ≤ x < π/2 in single precision: the series to x¹², within 1.3e−7. (`√(1 − sin²)` costs more: a vector
/// square root takes as long as twenty multiplications.)
#[inline(always)]
fn cosine<V: Vector>(x: V) -> V {
    let x2 = x.mul(x);
    let mut sum = V::splat(1.0 / 479_001_600.0);
    for term in [-1.0 / 3_628_800.0, 1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0] {
        sum = sum.mul_add(x2, V::splat(term));
    }
    sum
}
