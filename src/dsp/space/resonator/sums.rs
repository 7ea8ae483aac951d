//! Blocks of input on a grid of frequencies, and what masses add to a grid as frames.

use super::fourier::{Fourier, Pair, Transform};
use super::layout::MARGIN;
use super::masses::Spectra;
use super::taps::kernel_transform;
use crate::dsp::simd::Instructions;
use libm::exp;

/// Transforms between the frames of a block and a grid of twice as many points. Frames are counted from the middle of the
/// block: the first is frame `1 − B/2`.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    instructions: Instructions,
    fourier: &'static Fourier,
    /// By frame, the inverse of the kernel's transform.
    kernel: Vec<f64>,
    /// The same, times the decay that all masses have in common: the present one, and the former.
    weights: [Vec<f32>; 2],
    work: Pair,
    spare: Pair,
}

impl Sums {
    /// Transforms for blocks of some frames. Allocates.
    pub(super) fn new(instructions: Instructions, frames: usize) -> Self {
        let size = 2 * frames;
        let middle = (frames / 2) as f64;
        let kernel = (0..frames).map(|j| 1.0 / kernel_transform(j as f64 + 1.0 - middle, size)).collect();
        let pair = || [vec![0.0; size], vec![0.0; size]];
        let weights = [vec![0.0; frames], vec![0.0; frames]];
        Self { instructions, fourier: Fourier::of(size), kernel, weights, work: pair(), spare: pair() }
    }

    /// Sets the decay rate per frame that all masses have in common.
    pub(super) fn damp(&mut self, rate: f64) {
        self.weights.swap(0, 1);
        let (mut level, per_frame) = (exp(rate * (self.kernel.len() as f64 / 2.0 - 1.0)), exp(-rate));
        for (weight, kernel) in self.weights[0].iter_mut().zip(&self.kernel) {
            *weight = (kernel * level) as f32;
            level *= per_frame;
        }
    }

    /// Where a frame of a block is among the numbers of a transform.
    fn frame(&self, j: usize) -> usize {
        let size = self.fourier.size();
        (j + 1).wrapping_sub(size / 4) & (size - 1)
    }

    fn transform(&mut self) {
        let (values, spare) = (&mut self.work, &mut self.spare);
        self.instructions.run(Transform { fourier: self.fourier, values, spare });
    }

    /// Writes a block of input, its last frame first, to a grid.
    pub(super) fn spread(&mut self, input: &[f32], grid: &mut Pair) {
        self.work.iter_mut().for_each(|row| row.fill(0.0));
        for (j, sample) in input.iter().rev().enumerate() {
            let frame = self.frame(j);
            self.work[0][frame] = sample * self.weights[0][j];
        }
        self.transform();
        let mask = self.fourier.size() - 1;
        let [grid_re, grid_im] = grid;
        for (k, (re, im)) in grid_re.iter_mut().zip(grid_im).enumerate() {
            let place = self.fourier.place(k.wrapping_sub(MARGIN) & mask);
            (*re, *im) = (self.work[0][place], self.work[1][place]);
        }
    }

    /// Writes the frames of a block of output, from the grid of both sides: the imaginary part of each side's sum. With the
    /// present decay, or the former.
    pub(super) fn collect(&mut self, grid: &Spectra, is_former: bool, [left, right]: &mut Pair) {
        self.work.iter_mut().for_each(|row| row.fill(0.0));
        let [left_re, left_im, right_re, right_im] = grid;
        let size = self.fourier.size();
        // Left and right are the real and the imaginary part of one transform: a point of the grid is heard at its frequency,
        // and conjugated at the negative one.
        let [re, im] = &mut self.work;
        let up = |k: usize| (0.5 * (left_im[k] + right_re[k]), 0.5 * (right_im[k] - left_re[k]));
        let down = |k: usize| (0.5 * (left_im[k] - right_re[k]), 0.5 * (left_re[k] + right_im[k]));
        for (k, (re, im)) in re.iter_mut().zip(&mut *im).take(left_re.len() - MARGIN).enumerate() {
            (*re, *im) = up(MARGIN + k);
        }
        for (k, (re, im)) in re.iter_mut().zip(&mut *im).rev().take(left_re.len() - MARGIN - 1).enumerate() {
            let (more_re, more_im) = down(MARGIN + 1 + k);
            (*re, *im) = (*re + more_re, *im + more_im);
        }
        for k in 0..=MARGIN {
            let (more_re, more_im) = down(k);
            (re[MARGIN - k], im[MARGIN - k]) = (re[MARGIN - k] + more_re, im[MARGIN - k] + more_im);
        }
        for k in 0..MARGIN {
            let (place, (more_re, more_im)) = (size - MARGIN + k, up(k));
            (re[place], im[place]) = (re[place] + more_re, im[place] + more_im);
        }
        self.transform();
        let weights = &self.weights[usize::from(is_former)];
        for j in 0..left.len() {
            let place = self.fourier.place(self.frame(j));
            left[j] = self.work[0][place] * weights[j];
            right[j] = self.work[1][place] * weights[j];
        }
    }
}
