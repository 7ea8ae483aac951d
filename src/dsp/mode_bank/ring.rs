//! Renders with tables: freely ringing modes, sixteen frames at a time.
//!
//! Sixteen frames of a mode are `P·x + Q·y`. Lanes are frames and not modes, so a frame does not wait for the one
//! before, and the lanes need not be added up. Loads from memory limit the speed, and two measures double it. First, each
//! table is read once for both windows of a tick. Second, even lanes sum `P·x` and odd lanes sum `Q·y`, so that a state is
//! loaded once, as a pair, for all of its frames. The order of every sum must not change: even and odd modes separately,
//! the parts of both coordinates separately; then the modes are added, then the parts. Modes at rest add `+0`, so
//! leaving them out changes no bit.

use super::MAX_MODES;
use super::rows::{Form, Modes, Output, Row, State};
use super::table::{Pairs, Table, Taps, Turn, WINDOW};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::Vector;

/// The output of the live modes over one control tick, from their tables. Writes the state after the tick to `end`.
pub(super) struct Ring<'a> {
    pub(super) form: Form,
    pub(super) table: &'a mut Table,
    pub(super) modes: &'a Modes,
    pub(super) start: &'a State,
    pub(super) end: &'a mut State,
    pub(super) out: &'a mut Output,
}

impl Kernel for Ring<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let Self { form, table, modes, start, end, out } = self;
        let (live, stereo) = (form.live.min(MAX_MODES), form.stereo);
        let Table { taps, turn, pairs } = table;
        let mut at = 0;
        while at < live {
            let state: (V, V) = (start.x.at(proof, at), start.y.at(proof, at));
            let middle = turn.apply(proof, at, state);
            let (x, y) = turn.apply(proof, at, middle);
            x.store(&mut end.x.0[at..]);
            y.store(&mut end.y.0[at..]);
            store_pairs(proof, &mut pairs[0], at, state, middle, stereo.then_some(&modes.left));
            if stereo {
                store_pairs(proof, &mut pairs[1], at, state, middle, Some(&modes.right));
            }
            at += V::WIDTH;
        }
        let twos = live.div_ceil(2);
        sum_windows::<V>(proof, taps, &pairs[0], twos, &mut out[0]);
        if stereo {
            sum_windows::<V>(proof, taps, &pairs[1], twos, &mut out[1]);
        }
    }
}

#[inline(always)]
fn store_pairs<V: Vector>(
    proof: V::Proof,
    pairs: &mut Pairs,
    at: usize,
    start: (V, V),
    middle: (V, V),
    gain: Option<&Row>,
) {
    let (mut start, mut middle) = (start, middle);
    if let Some(gain) = gain {
        let gain = gain.at::<V>(proof, at);
        start = (start.0.mul(gain), start.1.mul(gain));
        middle = (middle.0.mul(gain), middle.1.mul(gain));
    }
    start.0.store_pairs(start.1, pairs.0[0][at..].as_flattened_mut());
    middle.0.store_pairs(middle.1, pairs.0[1][at..].as_flattened_mut());
}

impl Turn {
    /// The state of one vector of modes after a window.
    #[inline(always)]
    fn apply<V: Vector>(&self, proof: V::Proof, at: usize, (x, y): (V, V)) -> (V, V) {
        let (real, real_rest): (V, V) = (self.real.at(proof, at), self.real_rest.at(proof, at));
        let (imaginary, imaginary_rest): (V, V) = (self.imaginary.at(proof, at), self.imaginary_rest.at(proof, at));
        let x_rest = x.mul_add(real_rest, y.mul(imaginary_rest));
        let y_rest = x.neg_mul_add(imaginary_rest, y.mul(real_rest));
        (x.mul_add(real, y.mul_add(imaginary, x_rest)), y.mul_add(real, x.neg_mul_add(imaginary, y_rest)))
    }
}

/// The sum of the first `2 · twos` modes over both windows.
#[inline(always)]
fn sum_windows<V: Vector>(
    proof: V::Proof,
    taps: &[Taps; MAX_MODES],
    pairs: &Pairs,
    twos: usize,
    out: &mut [f32; CONTROL_FRAMES],
) {
    let (taps, twos) = (taps.as_chunks::<2>().0, twos.min(MAX_MODES / 2));
    let (first, second) = (pairs.0[0].as_chunks::<2>().0, pairs.0[1].as_chunks::<2>().0);
    // A vector holds half as many frames as it has lanes; two vectors at a time.
    let mut lane = 0;
    while lane < 2 * WINDOW {
        let mut sums = [[[V::splat(proof, 0.0); 2]; 2]; 2];
        for i in 0..twos {
            for k in 0..2 {
                let (state0, state1) = (V::splat_pair(proof, &first[i][k]), V::splat_pair(proof, &second[i][k]));
                for half in 0..2 {
                    let tap = V::load(proof, &taps[i][k].0[lane + half * V::WIDTH..]);
                    sums[0][half][k] = tap.mul_add(state0, sums[0][half][k]);
                    sums[1][half][k] = tap.mul_add(state1, sums[1][half][k]);
                }
            }
        }
        for window in 0..2 {
            let [[a, b], [c, d]] = sums[window];
            a.add(b).add_pairs(c.add(d)).store(&mut out[window * WINDOW + lane / 2..]);
        }
        lane += 2 * V::WIDTH;
    }
}
