//! The Fourier transforms with which sounds are measured, in double precision, and the resampler made of them.
//!
//! A crate of its own, since their generic code would be compiled again with each library and test program that uses it.
//! Nothing here is real-time safe.

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rubato::audioadapter::Adapter;
use rubato::audioadapter_buffers::direct::SequentialSliceOfVecs;
use rubato::{Fft, FixedSync, Resampler};
use std::cell::RefCell;
use std::sync::Arc;

pub use realfft::num_complex::Complex;

/// A transform from samples to half a spectrum.
pub type Forward = Arc<dyn RealToComplex<f64>>;

/// A transform from half a spectrum to samples, times their number.
pub type Inverse = Arc<dyn ComplexToReal<f64>>;

/// Frames per conversion step of [`resampled`]; a power of two above the length of the longest filter.
const CHUNK: usize = 4096;

/// Plans transforms, each length only once.
pub struct Planner(RefCell<RealFftPlanner<f64>>);

impl Default for Planner {
    // Derived, it would be inlined, and with it all planners into each crate that calls it.
    #[inline(never)]
    fn default() -> Self {
        Self(RefCell::new(RealFftPlanner::new()))
    }
}

impl Planner {
    /// The transform of `length` samples.
    pub fn forward(&self, length: usize) -> Forward {
        self.0.borrow_mut().plan_fft_forward(length)
    }

    /// The transform back to `length` samples.
    pub fn inverse(&self, length: usize) -> Inverse {
        self.0.borrow_mut().plan_fft_inverse(length)
    }
}

/// The transform of `length` samples.
pub fn forward(length: usize) -> Forward {
    Planner::default().forward(length)
}

/// Channels converted from one sample rate in Hz to another, band-limited to the lower of both. Double precision as in all
/// transforms here, so that a program contains only one kind.
///
/// # Errors
/// What cannot be converted, in words.
pub fn resampled(channels: &[Vec<f32>], from: u32, to: u32) -> Result<Vec<Vec<f32>>, String> {
    let [from, to] = [from, to].map(|rate| rate as usize);
    // One channel after the other: if the rates have no common divisor, the filter has as many taps as the rate has Hz, for
    // each channel.
    let mut resampler = Fft::<f64>::new(from, to, CHUNK, 1, FixedSync::Both).map_err(|error| error.to_string())?;
    let mut convert = |channel: &Vec<f32>| {
        let frames = channel.len();
        // The last block may contain a frame beyond the end of the sound.
        let len = (frames as f64 * to as f64 / from as f64).round() as usize;
        let precise = [channel.iter().map(|sample| f64::from(*sample)).collect::<Vec<f64>>()];
        let input = SequentialSliceOfVecs::new(&precise, 1, frames).map_err(|error| error.to_string())?;
        let output = resampler.process_all(&input, frames, None).map_err(|error| error.to_string())?;
        Ok((0..len).map(|frame| output.read_sample(0, frame).unwrap_or(0.0) as f32).collect())
    };
    channels.iter().map(&mut convert).collect()
}
