//! Stereo outputs beside the main one: the notes of a pad, or of a channel, by themselves.

use crate::sound::kit::OUTPUTS;
use std::ops::Range;

/// Left and right of each output beside the main one. Notes of an output whose slices are empty go to the main output.
/// Real-time safe.
#[derive(Default)]
pub struct Outputs<'a> {
    sides: [[&'a mut [f32]; 2]; OUTPUTS],
    /// The outputs that notes have sounded on, one bit each.
    used: u16,
}

impl<'a> Outputs<'a> {
    /// The outputs from the first on; those that are missing are empty.
    pub fn new(outputs: impl IntoIterator<Item = [&'a mut [f32]; 2]>) -> Self {
        let mut all = Self::default();
        all.sides.iter_mut().zip(outputs).for_each(|(sides, output)| *sides = output);
        all
    }

    /// A range of the frames of each output; of an output that ends earlier, nothing.
    pub fn cut(&mut self, frames: Range<usize>) -> Outputs<'_> {
        let sides = self.sides.each_mut();
        Outputs {
            sides: sides.map(|sides| sides.each_mut().map(|side| side.get_mut(frames.clone()).unwrap_or_default())),
            used: 0,
        }
    }

    /// Fills all of them with silence.
    pub(super) fn silence(&mut self) {
        self.sides.iter_mut().flatten().for_each(|side| side.fill(0.0));
    }

    /// Where a note of an output adds its sound: nowhere here if it belongs to the main output.
    pub(super) fn of(&mut self, output: u8, frames: Range<usize>) -> Option<[&mut [f32]; 2]> {
        let index = usize::from(output).checked_sub(1)?;
        let [left, right] = self.sides.get_mut(index)?;
        let sides = [left.get_mut(frames.clone())?, right.get_mut(frames)?];
        self.used |= 1 << index;
        Some(sides)
    }

    /// Calls `visit` with each output that notes have sounded on.
    pub(super) fn each_used(&mut self, mut visit: impl FnMut(&mut [f32], &mut [f32])) {
        for (index, [left, right]) in self.sides.iter_mut().enumerate() {
            if self.used >> index & 1 == 1 {
                visit(left, right);
            }
        }
    }

    /// Adds what is on them to the main output, times `sign`.
    pub(super) fn add_to(&mut self, main: [&mut [f32]; 2], sign: f32) {
        let [main_left, main_right] = main;
        self.each_used(|left, right| {
            for (main, own) in [(&mut *main_left, left), (&mut *main_right, right)] {
                main.iter_mut().zip(own).for_each(|(main, own)| *main += sign * *own);
            }
        });
    }
}
