//! The kernels compiled for each level of instructions, and the choice of one when the first bank is made.

use super::control::{Pitch, Wide};
use super::kernel::{Form, Modes, Output, State, ring};
use super::step::step;
use super::table::{Table, Turn};
use super::vector::Scalar;
use crate::dsp::exciter::Drive;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};

/// A level of vector instructions. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One number at a time, on any CPU.
    Scalar,
    /// x86-64, four numbers, fused multiplication emulated.
    Sse2,
    /// x86-64 since 2013: eight numbers, fused.
    Avx2,
    /// x86-64 servers since 2017, some desktops: sixteen numbers.
    Avx512,
    /// AArch64: four numbers, fused.
    Neon,
}

impl Level {
    /// Every level, slowest first.
    pub const ALL: [Level; 5] = [Level::Scalar, Level::Sse2, Level::Avx2, Level::Avx512, Level::Neon];

    /// The name by which the environment variable `SPRUNG_SIMD` asks for the level.
    pub fn name(self) -> &'static str {
        match self {
            Level::Scalar => "scalar",
            Level::Sse2 => "sse2",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
            Level::Neon => "neon",
        }
    }

    /// Whether this CPU has the level.
    pub fn is_available(self) -> bool {
        self.kernels().is_some()
    }

    /// The level that banks made from now on use: the one last forced, else the one that `SPRUNG_SIMD` named when
    /// this was first asked, else the fastest that the CPU has. Not for the audio thread, when first asked.
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

    /// Makes banks made from now on use this level; returns whether the CPU has it. For tests and measurements: the
    /// sound is the same.
    pub fn force(self) -> bool {
        let available = self.is_available();
        if available {
            FORCED.store(self as u8, Ordering::Relaxed);
        }
        available
    }

    /// The kernels of the level, only where the CPU can run them.
    pub(super) fn kernels(self) -> Option<&'static Kernels> {
        match self {
            Level::Scalar => Some(&scalar::KERNELS),
            #[cfg(target_arch = "x86_64")]
            Level::Sse2 => Some(&sse2::KERNELS),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => {
                let has = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
                has.then_some(&avx2::KERNELS)
            }
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => {
                let has = is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("fma");
                has.then_some(&avx512::KERNELS)
            }
            #[cfg(target_arch = "aarch64")]
            Level::Neon => Some(&neon::KERNELS),
            #[cfg(target_arch = "x86_64")]
            Level::Neon => None,
            #[cfg(not(target_arch = "x86_64"))]
            _ => None,
        }
    }
}

/// Index in [`Level::ALL`] of the level that [`Level::force`] set; beyond it if none was.
static FORCED: AtomicU8 = AtomicU8::new(u8::MAX);

/// The entry points of one level. Only [`Level::kernels`] hands them out, where the CPU has the level: that is what
/// makes calling them safe.
#[derive(Debug)]
pub(super) struct Kernels {
    level: Level,
    step: unsafe fn(Form, &mut Modes, &mut State, &Drive, &mut Output),
    ring: unsafe fn(Form, &mut Table, &Modes, &State, &mut State, &mut Output),
    build: unsafe fn(&mut Table, &Modes, usize),
    tune: unsafe fn(&mut Pitch, &mut Modes, &Wide, &Wide, usize),
    aim: unsafe fn(&Pitch, &mut Modes, f32, f32, bool, usize),
    take_stock: unsafe fn(&Pitch, &Modes, &mut State, bool, usize) -> f32,
    convert: unsafe fn(&Turn, &mut State, bool, usize),
}

impl Kernels {
    /// Those of [`Level::current`].
    pub(super) fn current() -> &'static Kernels {
        Level::current().kernels().unwrap_or(&scalar::KERNELS)
    }

    pub(super) fn level(&self) -> Level {
        self.level
    }

    /// See [`step`].
    pub(super) fn step(&self, form: Form, modes: &mut Modes, state: &mut State, drive: &Drive, out: &mut Output) {
        // SAFETY: see `Kernels`.
        unsafe { (self.step)(form, modes, state, drive, out) }
    }

    /// See [`ring`].
    pub(super) fn ring(
        &self,
        form: Form,
        table: &mut Table,
        modes: &Modes,
        start: &State,
        end: &mut State,
        out: &mut Output,
    ) {
        // SAFETY: see `Kernels`.
        unsafe { (self.ring)(form, table, modes, start, end, out) }
    }

    /// See [`Table::build`].
    pub(super) fn build(&self, table: &mut Table, modes: &Modes, len: usize) {
        // SAFETY: see `Kernels`.
        unsafe { (self.build)(table, modes, len) }
    }

    /// See [`Pitch::tune`].
    pub(super) fn tune(&self, pitch: &mut Pitch, modes: &mut Modes, ln_radius: &Wide, half_angle: &Wide, len: usize) {
        // SAFETY: see `Kernels`.
        unsafe { (self.tune)(pitch, modes, ln_radius, half_angle, len) }
    }

    /// See [`Pitch::aim`].
    pub(super) fn aim(&self, pitch: &Pitch, modes: &mut Modes, ratio: f32, per_frame: f32, jump: bool, len: usize) {
        // SAFETY: see `Kernels`.
        unsafe { (self.aim)(pitch, modes, ratio, per_frame, jump, len) }
    }

    /// See [`Pitch::take_stock`].
    pub(super) fn take_stock(&self, pitch: &Pitch, modes: &Modes, state: &mut State, ahead: bool, len: usize) -> f32 {
        // SAFETY: see `Kernels`.
        unsafe { (self.take_stock)(pitch, modes, state, ahead, len) }
    }

    /// See [`Turn::convert`].
    pub(super) fn convert(&self, turn: &Turn, state: &mut State, ahead: bool, live: usize) {
        // SAFETY: see `Kernels`.
        unsafe { (self.convert)(turn, state, ahead, live) }
    }
}

/// The generic kernels compiled with a level's instructions.
macro_rules! level {
    ($module:ident, $level:ident, $vector:ty $(, $features:literal)?) => {
        mod $module {
            use super::*;

            $(#[target_feature(enable = $features)])?
            fn step_here(form: Form, modes: &mut Modes, state: &mut State, drive: &Drive, out: &mut Output) {
                step::<$vector>(form, modes, state, drive, out);
            }

            $(#[target_feature(enable = $features)])?
            fn ring_here(
                form: Form,
                table: &mut Table,
                modes: &Modes,
                start: &State,
                end: &mut State,
                out: &mut Output,
            ) {
                ring::<$vector>(form, table, modes, start, end, out);
            }

            $(#[target_feature(enable = $features)])?
            fn build_here(table: &mut Table, modes: &Modes, len: usize) {
                table.build(modes, len);
            }

            $(#[target_feature(enable = $features)])?
            fn tune_here(pitch: &mut Pitch, modes: &mut Modes, ln_radius: &Wide, half_angle: &Wide, len: usize) {
                pitch.tune(modes, ln_radius, half_angle, len);
            }

            $(#[target_feature(enable = $features)])?
            fn aim_here(pitch: &Pitch, modes: &mut Modes, ratio: f32, per_frame: f32, jump: bool, len: usize) {
                pitch.aim::<$vector>(modes, ratio, per_frame, jump, len);
            }

            $(#[target_feature(enable = $features)])?
            fn take_stock_here(pitch: &Pitch, modes: &Modes, state: &mut State, ahead: bool, len: usize) -> f32 {
                pitch.take_stock::<$vector>(modes, state, ahead, len)
            }

            $(#[target_feature(enable = $features)])?
            fn convert_here(turn: &Turn, state: &mut State, ahead: bool, live: usize) {
                turn.convert::<$vector>(state, ahead, live);
            }

            pub(super) static KERNELS: Kernels = Kernels {
                level: Level::$level,
                step: step_here,
                ring: ring_here,
                build: build_here,
                tune: tune_here,
                aim: aim_here,
                take_stock: take_stock_here,
                convert: convert_here,
            };
        }
    };
}

level!(scalar, Scalar, Scalar);
#[cfg(target_arch = "x86_64")]
level!(sse2, Sse2, super::super::x86::Sse2, "sse2");
#[cfg(target_arch = "x86_64")]
level!(avx2, Avx2, super::super::x86::Avx2, "avx2,fma");
#[cfg(target_arch = "x86_64")]
level!(avx512, Avx512, super::super::x86::Avx512, "avx512f,avx2,fma");
#[cfg(target_arch = "aarch64")]
level!(neon, Neon, super::super::neon::Neon, "neon");
