//! Exchange of energy between the modes of a bank at a control tick, by bands.

use super::rows::{Row, State, Wide};
use super::{MAX_MODES, ModeBank};
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{LANES, Vector};
use libm::sqrt;

/// Maximum number of bands.
pub(in crate::dsp) const BANDS: usize = 32;

/// The modes of a band: the sum of their squared amplitudes, and their number.
#[derive(Clone, Copy, Debug)]
pub(in crate::dsp) struct Band {
    pub(in crate::dsp) energy: f64,
    pub(in crate::dsp) modes: u32,
}

impl Band {
    /// A band without modes.
    pub(in crate::dsp) const EMPTY: Self = Self { energy: 0.0, modes: 0 };
}

/// The change of each mode of a band.
#[derive(Clone, Copy, Debug)]
pub(in crate::dsp) struct Exchange {
    /// The fraction of its energy that it keeps, 0–1.
    pub(in crate::dsp) kept: f64,
    /// The energy that it receives.
    pub(in crate::dsp) received: f64,
}

impl Exchange {
    /// No change.
    pub(in crate::dsp) const NONE: Self = Self { kept: 1.0, received: 0.0 };
}

/// Factors are rounded down by this: more than the rounding errors of the factor and of its product with the state. So the
/// energy of all modes together never rises.
const ROUNDED_DOWN: f32 = 1.0 - 4.0 * (0.5 * f32::EPSILON);

/// A mode at rest that would receive less than this stays at rest. A smaller amplitude would soon be set to rest again.
const LEAST_RECEIVED: f64 = 1e-36;

impl ModeBank {
    /// Adds the energies of the modes to those of their bands.
    pub(in crate::dsp) fn add_energies(&self, bands: &[u8; MAX_MODES], sums: &mut [Band; BANDS]) {
        let state = &self.states[self.current];
        // Most modes belong to the same band as the mode before; so the sum stays in a register until the band changes.
        let (mut place, mut sum) = (0, sums[0]);
        for (m, band) in bands[..self.len].iter().enumerate() {
            let band = usize::from(*band) % BANDS;
            if band != place {
                sums[place] = sum;
                (place, sum) = (band, sums[band]);
            }
            let (x, y) = (f64::from(state.x.0[m]), f64::from(state.y.0[m]));
            sum.energy += x * x + y * y;
            sum.modes += 1;
        }
        sums[place] = sum;
    }

    /// The squared amplitude of each mode, without rounding errors of single precision.
    #[cfg(test)]
    pub(in crate::dsp) fn squared_amplitudes(&self) -> impl Iterator<Item = f64> {
        let state = &self.states[self.current];
        let square = |number: &f32| f64::from(*number) * f64::from(*number);
        (0..self.len).map(move |m| square(&state.x.0[m]) + square(&state.y.0[m]))
    }

    /// Changes the energies of the modes by their bands. A mode keeps its phase. A mode at rest starts with a displacement of
    /// 0, in the direction that `sign` gives for its number. Must be called at control ticks only.
    pub(in crate::dsp) fn exchange(
        &mut self,
        bands: &[u8; MAX_MODES],
        exchange: &[Exchange; BANDS],
        sign: impl Fn(usize) -> f32,
    ) {
        debug_assert!(self.frames_since() == 0);
        let (mut kept, mut received) = ([1.0; MAX_MODES], [0.0; MAX_MODES]);
        for (m, band) in bands[..self.len].iter().enumerate() {
            let Exchange { kept: its_kept, received: its_received } = exchange[usize::from(*band) % BANDS];
            (kept[m], received[m]) = (its_kept, its_received);
        }
        let state = &mut self.states[self.current];
        for m in 0..self.len {
            if received[m] > LEAST_RECEIVED && state.x.0[m] == 0.0 && state.y.0[m] == 0.0 {
                state.y.0[m] = (sqrt(received[m]) as f32 * ROUNDED_DOWN).copysign(sign(m));
                // That is all of its change. Modes from `live` on are at rest, with coefficients at the end of the ramp: they
                // can start at once.
                (kept[m], received[m]) = (1.0, 0.0);
                self.live = self.live.max((m + 1).next_multiple_of(LANES).min(self.len));
            }
        }
        self.instructions.run(Scale { state, kept: &kept, received: &received });
    }
}

/// Scales the states of all modes by the square root of the change of their energies.
struct Scale<'a> {
    state: &'a mut State,
    kept: &'a Wide,
    received: &'a Wide,
}

impl Kernel for Scale<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { state: State { x: Row(x), y: Row(y) }, kept, received } = self;
        for m in 0..MAX_MODES {
            let (wide_x, wide_y) = (f64::from(x[m]), f64::from(y[m]));
            let energy = wide_x * wide_x + wide_y * wide_y;
            let factor = (kept[m] + received[m] / energy).sqrt() as f32 * ROUNDED_DOWN;
            let factor = if energy > 0.0 && (kept[m] < 1.0 || received[m] > 0.0) { factor } else { 1.0 };
            (x[m], y[m]) = (x[m] * factor, y[m] * factor);
        }
    }
}
