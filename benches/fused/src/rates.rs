//! Steps a bank with each emulation in turn, and prints how many modes × frames a second it does.

use super::{rounded_to_odd, vector};
use crate::host;
use std::hint::black_box;

const MODES: usize = 64;
const FRAMES: usize = 64;

/// Vectors that are stepped side by side, as in the engine.
const SIDE_BY_SIDE: usize = 4;

/// Short measurements, of which the fastest counts: other work on the machine only adds to a time.
const ROUNDS: usize = 2000;
const BLOCKS: usize = 16;

/// The operations of the bank on a vector of four numbers.
trait Fused: Copy {
    fn load(from: &[f32]) -> Self;
    fn store(self, to: &mut [f32]);
    fn mul_add(self, factor: Self, term: Self) -> Self;
    fn neg_mul_add(self, factor: Self, term: Self) -> Self;
}

macro_rules! fused {
    ($type:ty, $load:expr, $store:expr) => {
        impl Fused for $type {
            #[inline(always)]
            fn load(from: &[f32]) -> Self {
                $load(from)
            }
            #[inline(always)]
            fn store(self, to: &mut [f32]) {
                $store(self, to);
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                self.mul_add(factor, term)
            }
            #[inline(always)]
            fn neg_mul_add(self, factor: Self, term: Self) -> Self {
                self.neg_mul_add(factor, term)
            }
        }
    };
}

/// The engine's vectors.
#[derive(Clone, Copy)]
struct Now<V>(V);

impl<V: vector::Vector<Proof = ()>> Now<V> {
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.mul_add(factor.0, term.0))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.neg_mul_add(factor.0, term.0))
    }
}

macro_rules! now {
    ($type:ty) => {
        fused!(Now<$type>, |from| Now(<$type as vector::Vector>::load((), from)), |this: Self, to| {
            vector::Vector::store(this.0, to)
        });
    };
}

now!(vector::Scalar);
fused!(
    rounded_to_odd::Scalar,
    |from: &[f32]| Self([from[0], from[1], from[2], from[3]]),
    |this: Self, to: &mut [f32]| to[..4].copy_from_slice(&this.0)
);

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
now!(super::wasm::Simd128);

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use std::arch::x86_64::{_mm_loadu_ps, _mm_storeu_ps};

    now!(crate::dsp::simd::sse2::Sse2);
    fused!(
        rounded_to_odd::Sse2,
        // SAFETY: every x86-64 CPU has SSE2, and the slice has four numbers.
        |from: &[f32]| Self(unsafe { _mm_loadu_ps(from[..4].as_ptr()) }),
        // SAFETY: as above.
        |this: Self, to: &mut [f32]| unsafe { _mm_storeu_ps(to[..4].as_mut_ptr(), this.0) }
    );
}

/// A bank of modes that ring.
#[derive(Clone)]
struct Bank {
    alpha: [f32; MODES],
    beta: [f32; MODES],
    gain: [f32; MODES],
    x: [f32; MODES],
    y: [f32; MODES],
    out: [f32; 4 * FRAMES],
}

impl Bank {
    fn new() -> Self {
        // Partials of 55 Hz at 48 kHz that lose a little in each frame.
        let step = |m: usize| 0.0072 * (m + 1) as f32;
        let alpha = std::array::from_fn(|m| 0.5 * step(m) * step(m) + 1e-6);
        let beta = std::array::from_fn(|m| step(m) * (1.0 - step(m) * step(m) / 6.0));
        let gain = std::array::from_fn(|m| 1.0 / (m + 3) as f32);
        Self { alpha, beta, gain, x: [0.0; MODES], y: [1.0; MODES], out: [0.0; 4 * FRAMES] }
    }

    /// Steps all modes by a block of frames, and adds up their outputs: five fused operations for each mode and frame.
    #[inline(never)]
    fn step<V: Fused>(&mut self) {
        self.out.fill(0.0);
        for group in (0..MODES).step_by(4 * SIDE_BY_SIDE) {
            let load =
                |from: &[f32; MODES]| -> [V; SIDE_BY_SIDE] { std::array::from_fn(|n| V::load(&from[group + 4 * n..])) };
            let (alpha, beta, gain) = (load(&self.alpha), load(&self.beta), load(&self.gain));
            let (mut x, mut y) = (load(&self.x), load(&self.y));
            for row in self.out.chunks_exact_mut(4) {
                let mut sum = V::load(row);
                for n in 0..SIDE_BY_SIDE {
                    let (to_x, to_y) = (y[n].mul_add(beta[n], x[n]), x[n].neg_mul_add(beta[n], y[n]));
                    (x[n], y[n]) = (x[n].neg_mul_add(alpha[n], to_x), y[n].neg_mul_add(alpha[n], to_y));
                    sum = x[n].mul_add(gain[n], sum);
                }
                sum.store(row);
            }
            for n in 0..SIDE_BY_SIDE {
                x[n].store(&mut self.x[group + 4 * n..]);
                y[n].store(&mut self.y[group + 4 * n..]);
            }
        }
    }
}

/// Seconds that [`BLOCKS`] blocks take from the bank's initial state, and the bank afterwards.
fn seconds<V: Fused>() -> (f64, Bank) {
    let mut bank = black_box(Bank::new());
    let start = host::now();
    for _ in 0..BLOCKS {
        black_box(&mut bank).step::<V>();
    }
    (host::now() - start, bank)
}

/// Prints a row: the name, 10⁹ modes × frames a second of both, and their ratio.
fn compare<Before: Fused, Now: Fused>(name: &str) {
    let mut fastest = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        let ((before, former), (now, present)) = (seconds::<Before>(), seconds::<Now>());
        let bits = |bank: &Bank| bank.out.map(f32::to_bits);
        assert!(bits(&former) == bits(&present), "{name}: both emulations give the same bits");
        fastest = [fastest[0].min(before), fastest[1].min(now)];
    }
    let [before, now] = fastest.map(|seconds| (MODES * FRAMES * BLOCKS) as f64 / seconds / 1e9);
    host::print(&format!("| {name} | {before:.3} | {now:.3} | {:.2}× |", now / before));
}

/// Prints the rows of this target.
pub(crate) fn print() {
    let name = match (cfg!(target_family = "wasm"), cfg!(target_feature = "simd128")) {
        (false, _) => std::env::consts::ARCH.to_owned() + " scalar",
        (true, false) => "wasm32 scalar".to_owned(),
        (true, true) => "wasm32 simd128, scalar code".to_owned(),
    };
    compare::<rounded_to_odd::Scalar, Now<vector::Scalar>>(&name);
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    compare::<rounded_to_odd::Scalar, Now<super::wasm::Simd128>>("wasm32 simd128, own kernel");
    #[cfg(target_arch = "x86_64")]
    compare::<rounded_to_odd::Sse2, Now<super::sse2::Sse2>>("x86_64 sse2");
}
