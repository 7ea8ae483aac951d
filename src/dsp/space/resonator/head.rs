//! The youngest part of the response, by convolution: sample by sample within a control tick, by Fourier transforms before it.
//!
//! The response of both sides is one complex number a frame, so two sides cost no more products than one. The transforms of
//! ticks of input are kept, and multiplied with those of the response at each tick (uniformly partitioned convolution:
//! T. G. Stockham, 1966). Nothing is late: a frame's own tick is summed directly.

use super::super::ticks::BODY_TICK;
use super::fourier::{Fourier, Pair, Transform};
use crate::dsp::simd::vector::Vector;
use crate::dsp::simd::{Instructions, Kernel};

/// Frames of a control tick.
const TICK: usize = BODY_TICK;

/// Numbers of a transform.
const SIZE: usize = 2 * TICK;

/// The input of a control tick, and transforms of the ticks before.
#[derive(Clone, Debug)]
pub(super) struct Past {
    /// A ring of transforms, real and imaginary parts, and the index of the newest.
    spectra: Vec<f32>,
    newest: usize,
    /// Ticks since the last that was not silent, as far as `spectra` reaches.
    silent: usize,
    /// Input of the present tick.
    pub(super) now: [f32; TICK],
    fourier: &'static Fourier,
    work: Pair,
    spare: Pair,
}

impl Past {
    /// Silence, for responses of some ticks.
    pub(super) fn new(ticks: usize) -> Self {
        let pair = || [vec![0.0; SIZE], vec![0.0; SIZE]];
        let (spectra, fourier) = (vec![0.0; ticks * 2 * SIZE], Fourier::of(SIZE));
        Self { spectra, newest: 0, silent: ticks, now: [0.0; TICK], fourier, work: pair(), spare: pair() }
    }

    fn ticks(&self) -> usize {
        self.spectra.len() / (2 * SIZE)
    }

    fn transform(&mut self, instructions: Instructions) {
        instructions.run(Transform { fourier: self.fourier, values: &mut self.work, spare: &mut self.spare });
    }

    /// Whether all that a response reaches is silent.
    pub(super) fn is_silent(&self) -> bool {
        self.silent >= self.ticks()
    }

    /// Forgets all input.
    pub(super) fn clear(&mut self) {
        self.spectra.fill(0.0);
        self.now.fill(0.0);
        self.silent = self.ticks();
    }

    /// Ends the present tick.
    pub(super) fn end_tick(&mut self, instructions: Instructions) {
        self.newest = (self.newest + 1) % self.ticks();
        if self.now.iter().all(|sample| *sample == 0.0) {
            self.silent = (self.silent + 1).min(self.ticks());
            self.spectra[self.newest * 2 * SIZE..][..2 * SIZE].fill(0.0);
            return;
        }
        self.silent = 0;
        self.work[0][..TICK].copy_from_slice(&self.now);
        self.work[0][TICK..].fill(0.0);
        self.work[1].fill(0.0);
        self.now.fill(0.0);
        self.transform(instructions);
        let place = &mut self.spectra[self.newest * 2 * SIZE..][..2 * SIZE];
        place[..SIZE].copy_from_slice(&self.work[0]);
        place[SIZE..].copy_from_slice(&self.work[1]);
    }
}

/// The head of a response.
#[derive(Clone, Debug)]
pub(super) struct Head {
    /// For each side, a tick of zeros and the first tick of the response.
    near: [[f32; SIZE]; 2],
    /// Transforms of the ticks that follow, each with the tick before it.
    spectra: Vec<f32>,
    /// What the ticks before the present one add to it.
    carry: [[f32; TICK]; 2],
}

impl Head {
    /// No response, with room for some ticks.
    pub(super) fn new(ticks: usize) -> Self {
        Self { near: [[0.0; SIZE]; 2], spectra: vec![0.0; ticks * 2 * SIZE], carry: [[0.0; TICK]; 2] }
    }

    pub(super) fn clear(&mut self) {
        self.carry = [[0.0; TICK]; 2];
    }

    /// Sets the response to none.
    pub(super) fn forget(&mut self) {
        self.near = [[0.0; SIZE]; 2];
        self.spectra.fill(0.0);
    }

    /// Sets the response, in two parts of the same length.
    pub(super) fn set(&mut self, instructions: Instructions, parts: &[Pair; 2], past: &mut Past) {
        let half = parts[0][0].len();
        for (side, near) in self.near.iter_mut().enumerate() {
            near[TICK..].copy_from_slice(&parts[0][side][..TICK]);
        }
        for (tick, place) in self.spectra.chunks_exact_mut(2 * SIZE).enumerate().skip(1) {
            for (side, values) in past.work.iter_mut().enumerate() {
                for (n, value) in values.iter_mut().enumerate() {
                    let frame = (tick - 1) * TICK + n;
                    *value = parts[frame / half][side][frame % half] * (1.0 / SIZE as f32);
                }
            }
            past.transform(instructions);
            place[..SIZE].copy_from_slice(&past.work[0]);
            place[SIZE..].copy_from_slice(&past.work[1]);
        }
    }

    /// Begins a tick: computes what the `ticks` ticks before it and `tail` add to it.
    pub(super) fn begin_tick(&mut self, instructions: Instructions, past: &mut Past, ticks: usize, tail: [&[f32]; 2]) {
        if past.is_silent() {
            for (carry, tail) in self.carry.iter_mut().zip(tail) {
                carry.copy_from_slice(&tail[..TICK]);
            }
            return;
        }
        instructions.run(Products {
            past: &past.spectra,
            newest: past.newest,
            ticks,
            head: &self.spectra,
            out: &mut past.spare,
        });
        // The inverse transform: that of the conjugate, conjugated.
        for i in 0..SIZE {
            let place = past.fourier.place(i);
            (past.work[0][i], past.work[1][i]) = (past.spare[0][place], -past.spare[1][place]);
        }
        past.transform(instructions);
        for n in 0..TICK {
            let place = past.fourier.place(TICK + n);
            self.carry[0][n] = past.work[0][place] + tail[0][n];
            self.carry[1][n] = tail[1][n] - past.work[1][place];
        }
    }

    /// The output of the frames `from` to before `to` of the present tick. (`out` has room for a whole tick.)
    pub(super) fn render(
        &self,
        instructions: Instructions,
        past: &Past,
        from: usize,
        to: usize,
        out: &mut [[f32; TICK]; 2],
    ) {
        instructions.run(Near { now: &past.now, near: &self.near, carry: &self.carry, from, to, out });
    }
}

/// Sums the products of the transforms of input and response.
struct Products<'a> {
    past: &'a [f32],
    newest: usize,
    ticks: usize,
    head: &'a [f32],
    out: &'a mut Pair,
}

impl Kernel for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let Self { past, newest, ticks, head, out: [out_re, out_im] } = self;
        let count = past.len() / (2 * SIZE);
        let mut i = 0;
        while i < SIZE {
            // Two vectors at a time use the time in which each sum waits for the one before.
            let mut sums = [[V::splat(proof, 0.0); 4]; 2];
            for tick in 1..=ticks {
                let place = (newest + 1 + count - tick) % count;
                let (x, h) = (&past[place * 2 * SIZE..][..2 * SIZE], &head[tick * 2 * SIZE..][..2 * SIZE]);
                for j in 0..2 {
                    let n = i + j * V::WIDTH;
                    let (x_re, x_im) = (V::load(proof, &x[n..]), V::load(proof, &x[SIZE + n..]));
                    let (h_re, h_im) = (V::load(proof, &h[n..]), V::load(proof, &h[SIZE + n..]));
                    sums[j][0] = x_re.mul_add(h_re, sums[j][0]);
                    sums[j][1] = x_im.mul_add(h_im, sums[j][1]);
                    sums[j][2] = x_re.mul_add(h_im, sums[j][2]);
                    sums[j][3] = x_im.mul_add(h_re, sums[j][3]);
                }
            }
            for j in 0..2 {
                let n = i + j * V::WIDTH;
                sums[j][0].sub(sums[j][1]).store(&mut out_re[n..]);
                sums[j][2].add(sums[j][3]).store(&mut out_im[n..]);
            }
            i += 2 * V::WIDTH;
        }
    }
}

/// Adds what the frames of the present tick do in it. However a tick is divided, a frame of the output is the same: later frames of
/// the input add zeros, and the last addition gives all zeros the same sign.
struct Near<'a> {
    now: &'a [f32; TICK],
    near: &'a [[f32; SIZE]; 2],
    carry: &'a [[f32; TICK]; 2],
    from: usize,
    to: usize,
    out: &'a mut [[f32; TICK]; 2],
}

impl Kernel for Near<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let Self { now, near, carry, from, to, out } = self;
        let step = 4 * V::WIDTH;
        let mut first = from / step * step;
        while first < to {
            let mut sums = [[V::splat(proof, 0.0); 4]; 2];
            for side in 0..2 {
                for i in 0..4 {
                    sums[side][i] = V::load(proof, &carry[side][first + i * V::WIDTH..]);
                }
            }
            for k in 0..(first + step).min(to) {
                let force = V::splat(proof, now[k]);
                for side in 0..2 {
                    let response = &near[side][TICK + first - k..][..step];
                    for i in 0..4 {
                        sums[side][i] = V::load(proof, &response[i * V::WIDTH..]).mul_add(force, sums[side][i]);
                    }
                }
            }
            for side in 0..2 {
                for i in 0..4 {
                    sums[side][i].add(V::splat(proof, 0.0)).store(&mut out[side][first + i * V::WIDTH..]);
                }
            }
            first += step;
        }
    }
}
