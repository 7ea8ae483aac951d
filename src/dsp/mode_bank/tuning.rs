//! The work of a bank at control ticks, for all modes at once: tuning, pitch ramps, and the remaining energy.

use super::MAX_MODES;
use super::rows::{Modes, Row, State, Wide};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::series::{expm1_of_radius, sin_to_right_angle};
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{LANES, Partial, Vector};
use std::f64::consts::PI;

/// Modes up to this angle per sample have full gain. From here to π they fade out; above π they are silent.
pub(super) const TOP_ANGLE: f64 = 0.98 * PI;

/// The data from which the coefficients of each mode are computed.
#[derive(Clone, Debug)]
pub(super) struct Tuning {
    /// Half the angle per sample at a pitch ratio of 1. It may be too high to be audible.
    half_angle: Row,
    /// The largest of these.
    highest: f32,
    /// `1 − r`.
    loss: Row,
    /// `r`, and the `r` of the present coefficients. They differ between a change of damping and the next ramp.
    radius: Wide,
    damped_radius: Wide,
    /// `1 − radius / damped_radius`.
    pub(super) shrink: Row,
    /// The state of unit amplitude in which the mass is displaced and at rest; see [`Displace`].
    pub(super) pull_x: Row,
    pub(super) pull_y: Row,
}

impl Tuning {
    pub(super) const UNSET: Tuning = Tuning {
        half_angle: Row::ZERO,
        highest: 0.0,
        loss: Row::ZERO,
        radius: [1.0; MAX_MODES],
        damped_radius: [1.0; MAX_MODES],
        shrink: Row::ZERO,
        pull_x: Row::ZERO,
        pull_y: Row::ZERO,
    };

    /// Whether a pitch ratio makes any mode so high that its gain is reduced.
    pub(super) fn fades(&self, ratio: f64) -> bool {
        self.highest * ratio as f32 > (0.5 * TOP_ANGLE) as f32
    }
}

/// Computes the tuning from the logarithm of each mode's radius (at least [`super::LEAST_LN_RADIUS`]) and half its angle.
///
/// Plain double precision without branches, vectorised by the compiler. The error is within 1e−12, in a fifth of the
/// time of `libm`'s exponential and sine.
pub(super) struct Tune<'a> {
    pub(super) tuning: &'a mut Tuning,
    pub(super) ln_radius: &'a Wide,
    pub(super) half_angle: &'a Wide,
    pub(super) len: usize,
}

impl Kernel for Tune<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { tuning, ln_radius, half_angle, len } = self;
        tuning.highest = half_angle[..len.min(MAX_MODES)].iter().fold(0.0, |highest, half| half.max(highest)) as f32;
        for m in 0..len.min(MAX_MODES) {
            let loss = -expm1_of_radius(ln_radius[m]);
            let radius = 1.0 - loss;
            tuning.radius[m] = radius;
            tuning.shrink.0[m] = (1.0 - radius / tuning.damped_radius[m]) as f32;
            tuning.loss.0[m] = loss as f32;
            tuning.half_angle.0[m] = half_angle[m] as f32;
        }
    }
}

/// Computes the state of unit amplitude in which each mass is displaced and at rest. Only plucks need it, so it is no part of
/// [`Tune`].
pub(super) struct Displace<'a> {
    pub(super) tuning: &'a mut Tuning,
    pub(super) ln_radius: &'a Wide,
    pub(super) half_angle: &'a Wide,
    pub(super) len: usize,
}

impl Kernel for Displace<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { tuning, ln_radius, half_angle, len } = self;
        for m in 0..len.min(MAX_MODES) {
            let loss = -expm1_of_radius(ln_radius[m]);
            let radius = 1.0 - loss;
            // A mass displaced by sin θ / ω has unit amplitude; see `Coefficients::energy`. Its displacement one frame
            // later is x (1 − ω²) and also Re z · x + Im z · y, which gives y.
            let half_chord = sin_to_right_angle(below_top(half_angle[m]));
            let chord2 = half_chord * half_chord;
            let zeta = loss * (2.0 - loss);
            let omega2 = loss * loss + 4.0 * radius * chord2;
            let omega = omega2.sqrt();
            tuning.pull_x.0[m] = (2.0 * half_chord * (1.0 - chord2).sqrt() / omega) as f32;
            tuning.pull_y.0[m] = (0.5 * (zeta - omega2) / (radius * omega)) as f32;
        }
    }
}

/// Starts linear ramps of the coefficients, from their present values to those of a pitch ratio.
///
/// A straight line between two points of the unit disk stays inside it, so no mass gains energy from changes of its pitch.
/// But the chord is shorter than the arc: at the fraction `t` of a ramp that turns by `Δθ` in total, the amplitude after a
/// frame is `√(1 − 4 t (1−t) sin²(Δθ/2))` times that on the arc. The loss of the previous ramp is compensated here, by the
/// first terms of a series whose terms are all positive: always slightly less than the loss.
///
/// Damping acts at once: the coefficients are multiplied by the ratio of the new radius to the old one, which does not change
/// the angle.
pub(super) struct Aim<'a> {
    pub(super) tuning: &'a mut Tuning,
    pub(super) modes: &'a mut Modes,
    pub(super) state: &'a mut State,
    pub(super) ratio: f32,
    /// Frames of the previous ramp that have been rendered, and frames that remain of it.
    pub(super) passed: usize,
    pub(super) left: usize,
    /// The loss in the rendered frames, if it must be compensated.
    pub(super) lost: Option<ChordLoss>,
    /// Whether damping has changed.
    pub(super) damped: bool,
    /// The fraction of the ramp that each frame advances, or `None` to jump to its end.
    pub(super) per_frame: Option<f32>,
    /// Gains without the fade, left and right, if some modes fade at the top of the spectrum or have just stopped fading.
    pub(super) fade: Option<&'a [Row; 2]>,
    /// Modes from this index on are at rest: their coefficients are set to the end of the ramp.
    pub(super) live: usize,
    pub(super) len: usize,
}

/// Number of frames for which the coefficients on a ramp stay the same: this saves two operations per mode in three frames of
/// four. Must not change: the accepted bits depend on it.
pub(super) const STAIR: usize = 4;

/// The position of the next frame's coefficients on a ramp of `frames` frames after `passed` frames: the middle of the
/// frame's stair (the last stair ends with the ramp). Also returns how many frames, this one included, have these
/// coefficients.
#[inline(always)]
pub(super) const fn stair(passed: usize, frames: usize) -> (f32, usize) {
    // After the end of the ramp nothing moves.
    let passed = if passed < frames { passed } else { frames - 1 };
    let first = passed - passed % STAIR;
    let last = if first + STAIR < frames { first + STAIR } else { frames };
    (0.5 * (first + 1 + last) as f32, last - passed)
}

/// The logarithm of the loss on a part of a ramp compared with the arc, as a polynomial in the squared step `q` of the
/// ramp: `first · q + second · q²`.
///
/// For frames at position `v` of the `K` frames of the ramp, with `t = v/K` and `|Δz|² = K² q = 4 r² sin²(Δθ/2)`, the
/// sum of `−½ ln(1 − 4 t (1−t) sin²(Δθ/2))` begins with `½ q Σ v (K−v) + ¼ q² Σ v² (K−v)²`. Because of the omitted terms,
/// and of `r² < 1`, the true loss is larger.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChordLoss {
    first: f32,
    second: f32,
}

impl ChordLoss {
    /// The loss over the first `passed` of the `frames` frames of a ramp.
    pub(super) fn new(passed: usize, frames: usize) -> Self {
        const TICK: ChordLoss = ChordLoss::over(CONTROL_FRAMES, CONTROL_FRAMES);
        if (passed, frames) == (CONTROL_FRAMES, CONTROL_FRAMES) { TICK } else { Self::over(passed, frames) }
    }

    const fn over(passed: usize, frames: usize) -> Self {
        let (mut first, mut second, mut done) = (0.0, 0.0, 0);
        while done < passed {
            let (v, left) = stair(done, frames);
            let run = if left < passed - done { left } else { passed - done };
            let product = v * (frames as f32 - v);
            first += 0.5 * run as f32 * product;
            second += 0.25 * run as f32 * product * product;
            done += run;
        }
        Self { first, second }
    }
}

impl Kernel for Aim<'_> {
    /// Whether any gain moves.
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) -> bool {
        let Self { tuning, modes, state, ratio, passed, left, lost, damped, per_frame, fade, live, len } = self;
        let mut gain_moves = Partial([0.0; LANES]);
        let (zero, one) = (V::splat(proof, 0.0), V::splat(proof, 1.0));
        let top = V::splat(proof, (0.5 * TOP_ANGLE) as f32);
        let (broken_off, lift) = (passed * left > 0, V::splat(proof, (passed * left) as f32));
        let passed = V::splat(proof, passed as f32);
        let mut at = 0;
        while at < len.min(MAX_MODES) {
            let (alpha_step, beta_step): (V, V) = (modes.alpha_step.at(proof, at), modes.beta_step.at(proof, at));
            if let Some(ChordLoss { first, second }) = lost.filter(|_| at < live) {
                let step2 = alpha_step.mul_add(alpha_step, beta_step.mul(beta_step));
                let lost = step2.mul(step2.mul_add(V::splat(proof, second), V::splat(proof, first)));
                let series = lost.mul_add(V::splat(proof, 1.0 / 6.0), V::splat(proof, 0.5));
                let factor = lost.mul_add(lost.mul_add(series, one), one);
                state.x.at::<V>(proof, at).mul(factor).store(&mut state.x.0[at..]);
                state.y.at::<V>(proof, at).mul(factor).store(&mut state.y.0[at..]);
            }
            let loss: V = tuning.loss.at(proof, at);
            let wanted = tuning.half_angle.at::<V>(proof, at).mul(V::splat(proof, ratio));
            let half = wanted.min(top);
            let (sin, cos) = (sine::<V>(proof, half), cosine::<V>(proof, half));
            // sin² + cos² − 1: the rounding error of the turn's squared length, which would change the decay.
            let excess = sin.mul_add(sin, cos.mul_add(cos, V::splat(proof, -1.0)));
            let two_sin = sin.add(sin);
            let two_sin = two_sin.neg_mul_add(excess, two_sin);
            let two_sin = two_sin.neg_mul_add(loss, two_sin);
            let (to_alpha, to_beta) = (two_sin.mul_add(sin, loss), two_sin.mul(cos));
            let per_frame = per_frame.filter(|_| at < live);
            if let Some(full) = fade {
                let audible = audible(proof, wanted);
                let Modes { left, right, left_step, right_step, .. } = modes;
                for ((gain, step), full) in [(left, left_step), (right, right_step)].into_iter().zip(full) {
                    let target = full.at::<V>(proof, at).mul(audible);
                    let (from, new_step) = match per_frame {
                        Some(share) => {
                            let now = passed.mul_add(step.at(proof, at), gain.at(proof, at));
                            (now, target.sub(now).mul(V::splat(proof, share)))
                        }
                        None => (target, zero),
                    };
                    from.store(&mut gain.0[at..]);
                    new_step.store(&mut step.0[at..]);
                    let lane = &mut gain_moves.0[at % LANES..];
                    new_step.mul_add(new_step, V::load(proof, lane)).store(lane);
                }
            }
            match per_frame {
                Some(share) => {
                    let mut alpha: V = passed.mul_add(alpha_step, modes.alpha.at(proof, at));
                    let mut beta: V = passed.mul_add(beta_step, modes.beta.at(proof, at));
                    if broken_off {
                        // In the middle of the chord the point lies inside the circle, by the factor √(1 − p (K−p) q). The next
                        // ramp must start on the circle. This too uses the first terms of a series of positive terms.
                        let step2 = alpha_step.mul_add(alpha_step, beta_step.mul(beta_step));
                        let inside = step2.mul(lift);
                        let more = inside.mul(inside.mul_add(V::splat(proof, 0.375), V::splat(proof, 0.5)));
                        alpha = alpha.mul_add(more, alpha.sub(more));
                        beta = beta.mul_add(more, beta);
                    }
                    if damped {
                        let shrink: V = tuning.shrink.at(proof, at);
                        alpha = shrink.add(alpha.neg_mul_add(shrink, alpha));
                        beta = beta.neg_mul_add(shrink, beta);
                    }
                    let share = V::splat(proof, share);
                    alpha.store(&mut modes.alpha.0[at..]);
                    beta.store(&mut modes.beta.0[at..]);
                    to_alpha.sub(alpha).mul(share).store(&mut modes.alpha_step.0[at..]);
                    to_beta.sub(beta).mul(share).store(&mut modes.beta_step.0[at..]);
                }
                None => {
                    to_alpha.store(&mut modes.alpha.0[at..]);
                    to_beta.store(&mut modes.beta.0[at..]);
                    zero.store(&mut modes.alpha_step.0[at..]);
                    zero.store(&mut modes.beta_step.0[at..]);
                }
            }
            at += V::WIDTH;
        }
        if damped {
            tuning.damped_radius = tuning.radius;
        }
        gain_moves.0 != [0.0; LANES]
    }
}

/// Adds up the squared amplitudes of the live modes, in units of [`UNIT`]², and sets those below [`REST`] to rest.
pub(super) struct Settle<'a> {
    pub(super) state: &'a mut State,
    pub(super) live: usize,
}

impl Kernel for Settle<'_> {
    type Output = f32;

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) -> f32 {
        let Self { state, live } = self;
        let mut total = Partial([0.0; LANES]);
        let scale = V::splat(proof, 1.0 / UNIT);
        let mut at = 0;
        while at < live.min(MAX_MODES) {
            let (x, y): (V, V) = (state.x.at(proof, at), state.y.at(proof, at));
            let (scaled_x, scaled_y) = (x.mul(scale), y.mul(scale));
            let energy = scaled_x.mul(scaled_x).add(scaled_y.mul(scaled_y));
            let lane = &mut total.0[at % LANES..];
            V::load(proof, lane).add(energy).store(lane);
            // 1 for a mode that rings and 0 for one at rest.
            let above = energy.sub(V::splat(proof, (REST / UNIT) * (REST / UNIT))).mul(V::splat(proof, 1e30));
            let rings = above.max(V::splat(proof, 0.0)).mul(V::splat(proof, 1e30)).min(V::splat(proof, 1.0));
            x.mul(rings).store(&mut state.x.0[at..]);
            y.mul(rings).store(&mut state.y.0[at..]);
            at += V::WIDTH;
        }
        let mut sum = [0.0];
        V::sum_lanes(proof, &[total], &mut sum);
        sum[0]
    }
}

/// Unit of amplitudes, so that the squares of the smallest relevant ones are normal numbers.
pub(super) const UNIT: f32 = 1.0 / (1_u64 << 40) as f32;

/// A mode with a smaller amplitude is set to rest before it can become denormal.
const REST: f32 = 1e-20;

/// Half an angle, limited to that at the top of the spectrum.
#[inline(always)]
pub(super) fn below_top(half_angle: f64) -> f64 {
    let top = 0.5 * TOP_ANGLE;
    if half_angle < top { half_angle } else { top }
}

/// `sin x` for 0 ≤ x ≤ π/2 in single precision: the series up to x¹¹, with an error below 1.3e−7.
#[inline(always)]
fn sine<V: Vector>(proof: V::Proof, x: V) -> V {
    let x2 = x.mul(x);
    let mut sum = V::splat(proof, -1.0 / 39_916_800.0);
    for term in [1.0 / 362_880.0, -1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0] {
        sum = sum.mul_add(x2, V::splat(proof, term));
    }
    sum.mul(x2).mul_add(x, x)
}

/// `cos x` for 0 ≤ x < π/2 in single precision: the series up to x¹², with an error below 1.3e−7. (`√(1 − sin²)` would
/// cost more: a vector square root takes as long as twenty multiplications.)
#[inline(always)]
fn cosine<V: Vector>(proof: V::Proof, x: V) -> V {
    let x2 = x.mul(x);
    let mut sum = V::splat(proof, 1.0 / 479_001_600.0);
    for term in [-1.0 / 3_628_800.0, 1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0] {
        sum = sum.mul_add(x2, V::splat(proof, term));
    }
    sum
}

/// Gain factor of modes with these half angles: 1 up to [`TOP_ANGLE`], 0 from π on.
#[inline(always)]
fn audible<V: Vector>(proof: V::Proof, half_angle: V) -> V {
    let below = V::splat(proof, (0.5 * PI) as f32).sub(half_angle);
    below.mul(V::splat(proof, (2.0 / (PI - TOP_ANGLE)) as f32)).max(V::splat(proof, 0.0)).min(V::splat(proof, 1.0))
}
