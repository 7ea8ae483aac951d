//! Vector instructions: detects which levels the CPU has, and runs kernels, written once, with the best of them.
//!
//! `vector` defines the operations that kernels may use; `sse2`, `x86`, `neon` and `wasm` implement them and contain the only
//! unsafe code of the crate. `fused` emulates fused multiplication for CPUs without an instruction for it.
//!
//! **All levels give the same bits.** `tests/levels/` compares every factory preset, and random patches and events,
//! with scalar code. `SPRUNG_SIMD=scalar|sse2|avx2|avx512|neon|simd128` and [`Level::force`] choose another level than
//! the best one. A WebAssembly module is compiled either for simd128 or not, so it has that level or scalar code.
//!
//! **CPU instructions need a proof.** A vector can only be made from a value that detection returns if the CPU has the
//! instructions. So operations on vectors are safe functions that cannot be misused. A kernel is one generic function
//! (`Kernel`). `Instructions::run` is the only place that calls a function compiled for instructions that not every
//! CPU has.
//!
//! What did not work: closures inside kernels. They are not inlined into the function of a level, so they are compiled
//! without its instructions; stepping the bank ran at 3 instead of 18 G (10⁹ modes × frames per second, measured once).

mod fused;
#[cfg(target_arch = "aarch64")]
#[allow(unsafe_code)]
mod neon;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod sse2;
#[allow(clippy::needless_range_loop, reason = "several arrays are indexed in step")]
pub(super) mod vector;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
#[allow(unsafe_code)]
mod wasm;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod x86;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};
use vector::{Scalar, Vector};

#[cfg(target_arch = "aarch64")]
use neon::Neon;
#[cfg(target_arch = "x86_64")]
use sse2::Sse2;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use wasm::Simd128;
#[cfg(target_arch = "x86_64")]
use x86::{Avx2, Avx512, HasAvx2, HasAvx512};

/// A level of vector instructions. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Plain Rust without vector instructions, on any CPU.
    Scalar,
    /// x86-64: four numbers, fused multiplication emulated.
    Sse2,
    /// x86-64 since 2013: eight numbers, fused multiplication.
    Avx2,
    /// x86-64 servers since 2017 and some desktops: sixteen numbers.
    Avx512,
    /// AArch64: four numbers, fused multiplication.
    Neon,
    /// WebAssembly compiled for vectors: four numbers, fused multiplication emulated.
    Simd128,
}

impl Level {
    /// Every level; those of one CPU, slowest first.
    pub const ALL: [Level; 6] = [Level::Scalar, Level::Sse2, Level::Avx2, Level::Avx512, Level::Neon, Level::Simd128];

    /// The level's name, as in the environment variable `SPRUNG_SIMD`.
    pub fn name(self) -> &'static str {
        match self {
            Level::Scalar => "scalar",
            Level::Sse2 => "sse2",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
            Level::Neon => "neon",
            Level::Simd128 => "simd128",
        }
    }

    /// Whether this CPU has the level.
    pub fn is_available(self) -> bool {
        Instructions::detect(self).is_some()
    }

    /// The level that new banks use: the one that was forced last; else the one that `SPRUNG_SIMD` named when this was first
    /// called; else the fastest that the CPU has. The first call is not real-time safe.
    pub fn current() -> Level {
        static DETECTED: OnceLock<Level> = OnceLock::new();
        let forced = FORCED.load(Ordering::Relaxed);
        Level::ALL.get(usize::from(forced)).copied().unwrap_or_else(|| {
            *DETECTED.get_or_init(|| {
                let asked = std::env::var("SPRUNG_SIMD").ok();
                let named = Level::ALL.into_iter().find(|level| asked.as_deref() == Some(level.name()));
                let fastest = Level::ALL.into_iter().rev().find(|level| level.is_available());
                named.filter(|level| level.is_available()).or(fastest).unwrap_or(Level::Scalar)
            })
        })
    }

    /// Makes new banks use this level, and returns whether the CPU has it. For tests and measurements: the sound is the
    /// same.
    pub fn force(self) -> bool {
        let available = self.is_available();
        if available {
            FORCED.store(self as u8, Ordering::Relaxed);
        }
        available
    }
}

/// Index in [`Level::ALL`] of the level that [`Level::force`] set; `u8::MAX` if none was set.
static FORCED: AtomicU8 = AtomicU8::new(u8::MAX);

/// Work that is written once for all vector types.
pub(in crate::dsp) trait Kernel {
    /// The result of the work.
    type Output;

    /// Does the work. Implementations, and all functions that they call, are `#[inline(always)]`: a function that is not inlined
    /// into a function of `Instructions::run` is compiled without the level's instructions, and is several times
    /// slower.
    fn run<V: Vector>(self, proof: V::Proof) -> Self::Output;
}

/// A level that this CPU has, with the proof that it has it.
#[derive(Clone, Copy, Debug)]
pub(in crate::dsp) enum Instructions {
    Scalar,
    #[cfg(target_arch = "x86_64")]
    Sse2,
    #[cfg(target_arch = "x86_64")]
    Avx2(HasAvx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(HasAvx512),
    #[cfg(target_arch = "aarch64")]
    Neon,
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128,
}

impl Instructions {
    /// The instructions of [`Level::current`].
    pub(in crate::dsp) fn current() -> Self {
        Self::detect(Level::current()).unwrap_or(Self::Scalar)
    }

    /// The instructions of a level, if the CPU has it.
    fn detect(level: Level) -> Option<Self> {
        match level {
            Level::Scalar => Some(Self::Scalar),
            #[cfg(target_arch = "x86_64")]
            Level::Sse2 => Some(Self::Sse2),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => HasAvx2::detect().map(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => HasAvx512::detect().map(Self::Avx512),
            #[cfg(target_arch = "aarch64")]
            Level::Neon => Some(Self::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Level::Simd128 => Some(Self::Simd128),
            #[cfg(target_arch = "x86_64")]
            Level::Neon | Level::Simd128 => None,
            #[cfg(not(target_arch = "x86_64"))]
            _ => None,
        }
    }

    /// The level of these instructions.
    pub(in crate::dsp) fn level(self) -> Level {
        match self {
            Self::Scalar => Level::Scalar,
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => Level::Sse2,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => Level::Avx2,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => Level::Avx512,
            #[cfg(target_arch = "aarch64")]
            Self::Neon => Level::Neon,
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128 => Level::Simd128,
        }
    }

    /// Runs a kernel, compiled for these instructions.
    #[inline]
    pub(in crate::dsp) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Scalar => kernel.run::<Scalar>(()),
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => kernel.run::<Sse2>(()),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the proof exists only where the CPU has AVX2 and FMA.
            Self::Avx2(proof) => unsafe { run_avx2(kernel, proof) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the proof exists only where the CPU has AVX-512F, AVX2 and FMA.
            Self::Avx512(proof) => unsafe { run_avx512(kernel, proof) },
            #[cfg(target_arch = "aarch64")]
            Self::Neon => kernel.run::<Neon>(()),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128 => kernel.run::<Simd128>(()),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_avx2<K: Kernel>(kernel: K, proof: HasAvx2) -> K::Output {
    kernel.run::<Avx2>(proof)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx2,fma")]
fn run_avx512<K: Kernel>(kernel: K, proof: HasAvx512) -> K::Output {
    kernel.run::<Avx512>(proof)
}
