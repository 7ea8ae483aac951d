//! How a body renders: the work of each control tick, and the output of its frames.

use super::super::ticks::BODY_TICK;
use super::Resonator;

impl Resonator {
    /// Does the work of a control tick. Call it before the tick's first frame.
    pub(in crate::dsp::space) fn work(&mut self) {
        let (slice, slices) = (self.frame / BODY_TICK, self.block / BODY_TICK);
        if slice == 0 {
            self.begin_block();
        }
        // The transforms of the first and the last slice take about as long as the masses in one of the others; during a change,
        // those of the first take little, and the last has more of them.
        let is_last = slice + 1 == slices;
        let (part, parts) = if self.is_changing { (slice + 1, slices - 1) } else { (slice, slices.saturating_sub(2)) };
        let parts = parts.max(1);
        self.tail.work(if is_last { parts } else { part.min(parts) }, parts);
        if is_last {
            self.finish_block();
        }
        let ticks = slices + slice;
        let tail = [0, 1].map(|side: usize| &self.tails[0][side][self.frame..]);
        self.heads[0].begin_tick(self.instructions, &mut self.past, ticks, tail);
        if self.fades {
            self.heads[1].begin_tick(self.instructions, &mut self.past, ticks, tail);
        }
    }

    fn begin_block(&mut self) {
        self.tails.swap(0, 1);
        self.fades = self.is_changing;
        if self.fades {
            self.heads.rotate_right(1);
            self.gains[0] = self.gains[1];
        }
        let next = Some(self.wanted).filter(|wanted| self.given != Some(*wanted));
        self.is_changing = next.is_some();
        if self.is_changing {
            (self.given, self.gains[1]) = (next, self.noise_gain());
        } else if !self.fades {
            self.bands.settle();
        }
        self.tail.begin(&self.input, next);
    }

    fn finish_block(&mut self) {
        let Self { tail, tails: [_, next], former, parts, .. } = self;
        if !self.is_changing {
            return tail.finish(next, None);
        }
        tail.finish(next, Some((former, parts)));
        for (next, former) in next.iter_mut().zip(former) {
            for (n, (next, former)) in next.iter_mut().zip(former).take(SMOOTH).enumerate() {
                *next = *former + (*next - *former) * smooth(n, SMOOTH);
            }
        }
        self.heads[2].set(self.instructions, parts, &mut self.past);
    }

    /// Renders some frames of a control tick, and returns the outputs of the pick-ups.
    pub(in crate::dsp::space) fn render(&mut self, input: &[f32]) -> [&[f32]; 2] {
        let from = self.frame % BODY_TICK;
        let to = (from + input.len()).min(BODY_TICK);
        let input = &input[..to - from];
        self.past.now[from..to].copy_from_slice(input);
        self.input[self.frame..][..input.len()].copy_from_slice(input);
        self.heads[0].render(self.instructions, &self.past, from, to, &mut self.out);
        if self.fades {
            let mut former = [[0.0; BODY_TICK]; 2];
            self.heads[1].render(self.instructions, &self.past, from, to, &mut former);
            for (out, former) in self.out.iter_mut().zip(&former) {
                for n in from..to {
                    out[n] = former[n] + (out[n] - former[n]) * smooth(self.frame + n - from, self.block);
                }
            }
        }
        self.frame += input.len();
        if to == BODY_TICK {
            self.past.end_tick(self.instructions);
            self.frame %= self.block;
        }
        let [left, right] = &self.out;
        [&left[from..to], &right[from..to]]
    }
}

/// Frames in which the tail fades over to its new pitch: they make a bend of what would be a kink. Half as many let 10 dB more
/// through above 15 kHz.
const SMOOTH: usize = 64;

/// A fade from 0 to 1 over some frames, whose slope has no jumps.
fn smooth(frame: usize, frames: usize) -> f32 {
    let share = frame as f32 / frames as f32;
    share * share * (3.0 - 2.0 * share)
}
