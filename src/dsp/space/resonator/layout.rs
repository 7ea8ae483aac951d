//! How modes are laid out in blocks and groups of masses at a pitch, and their coefficients at a pitch and a decay.

use super::super::decay::{Decay, height_of_way, shift};
use super::super::modes::ModeSet;
use super::fourier::Pair;
use super::masses::{Block, Group, MOST_BLOCKS, Row};
use super::taps::{DAMPINGS, FRACTIONS};
use crate::dsp::power_of_two;
use crate::dsp::simd::vector::{LANES, Vector};
use crate::dsp::simd::{Instructions, Kernel};
use libm::{floor, round};
use std::f64::consts::PI;

/// Largest distance in grid steps between two modes of a group, and of a group that needs most terms for its damping. With
/// larger ones, the taps would need more terms.
const SPANS: [f64; 2] = [0.8, 0.5];

/// Modes above this fraction of half the sample rate are left out.
const TOP: f64 = 0.98;

/// Points of a grid below the lowest frequency: taps reach three of them.
pub(super) const MARGIN: usize = 4;

/// Number of points of a grid for blocks of some frames.
pub(super) fn grid_points(frames: usize) -> usize {
    frames + 4 * MARGIN
}

/// What the coefficients depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tuning {
    sample_rate: f64,
    /// Ratio of the frequencies to those of the modes.
    pub(super) pitch: f64,
    /// Change of the modes' position between low and high frequencies.
    pub(super) shift: f32,
    /// Base-2 logarithms of the decay rate per frame at low frequencies, and of its increase at high ones.
    pub(super) rates: [f32; 2],
    /// Number of audible modes.
    pub(super) heard: usize,
    /// The middle of the decay rates of the audible modes. All of them have it in common, so taps need only the differences.
    pub(super) middle: f64,
}

impl Tuning {
    pub(super) fn new(pitch: f64, decay: Decay, sample_rate: f64, modes: &ModeSet) -> Self {
        let rates = decay.log_rates(sample_rate).map(|rate| rate as f32);
        let is_heard = |frequency: &f64| frequency / sample_rate * pitch < 0.5 * TOP;
        let heard = modes.frequencies[..modes.len()].partition_point(is_heard);
        let mut tuning = Self { sample_rate, pitch, shift: shift(pitch) as f32, rates, heard, middle: 0.0 };
        if tuning.heard > 0 {
            // The rate is monotone over frequency.
            let [first, last] = [0, tuning.heard - 1].map(|mode| f64::from(tuning.rate(modes.ways[mode])));
            tuning.middle = 0.5 * (first + last);
        }
        tuning
    }

    /// Decay rate per frame of a mode.
    #[inline(always)]
    fn rate(&self, way: f32) -> f32 {
        power_of_two(self.rates[0] + self.rates[1] * height_of_way(way + self.shift))
    }
}

/// Blocks and groups of masses.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Frames through which a mass turns at once.
    frames: usize,
    pub(super) blocks: Vec<Block>,
    /// `λ^(B/2)` of each mass.
    halves: Vec<[Row; 2]>,
    /// The first mode of each block, and at the end the number of modes.
    pub(super) starts: Vec<usize>,
    pub(super) groups: Vec<Group>,
}

impl Layout {
    /// An empty layout with room for some modes at every pitch.
    pub(super) fn with_room(modes: usize, frames: usize) -> Self {
        // Where fewer modes than fill a block are within a span, a block ends with the span: at most two for each grid step.
        let blocks = (modes / LANES + 2 * frames + 2).min(modes);
        let mut starts = Vec::with_capacity(blocks + 1);
        starts.push(0);
        let groups = Vec::with_capacity(blocks);
        Self { frames, blocks: Vec::with_capacity(blocks), halves: Vec::with_capacity(blocks), starts, groups }
    }

    pub(super) fn clear(&mut self) {
        self.blocks.clear();
        self.halves.clear();
        self.starts.truncate(1);
        self.groups.clear();
    }

    /// Number of modes that are in blocks.
    pub(super) fn covered(&self) -> usize {
        self.starts[self.blocks.len()]
    }

    /// The modes before the end of a group.
    pub(super) fn covered_by(&self, groups: usize) -> usize {
        self.groups[..groups].last().map_or(0, |group| self.starts[group.end as usize])
    }

    /// Adds the next group, unless it needs modes from `ready` on. Its masses are what a sample of 1 makes of them in half a
    /// block.
    pub(super) fn add_group(
        &mut self,
        instructions: Instructions,
        modes: &ModeSet,
        tuning: &Tuning,
        ready: usize,
    ) -> bool {
        let start = self.covered();
        let steps = 2.0 * self.frames as f64 * tuning.pitch;
        let place = |mode: usize| modes.frequencies[mode] / tuning.sample_rate * steps;
        let (first, mut ends, mut count) = (start, [start; MOST_BLOCKS], 0);
        let mut end = start;
        // The imaginary distance of a mode from its centre.
        let damping =
            |mode: usize| (f64::from(tuning.rate(modes.ways[mode])) - tuning.middle) * self.frames as f64 / PI;
        let span = SPANS[usize::from(start < tuning.heard && damping(start).abs() > DAMPINGS[1])];
        while count < MOST_BLOCKS && end < tuning.heard {
            let limit = (end + LANES).min(tuning.heard);
            let fits = |mode: usize| place(mode) - place(first) <= span;
            let whole = fits(limit - 1);
            if !whole && count > 0 {
                break;
            }
            end = if whole { limit } else { (end..limit).find(|mode| !fits(*mode)).unwrap_or(limit) };
            ends[count] = end;
            count += 1;
            if !whole {
                break;
            }
        }
        if end == start || end > ready {
            return false;
        }
        let middle = 0.5 * (place(first) + place(end - 1));
        let centre = round(middle * FRACTIONS as f64) / FRACTIONS as f64;
        let point = floor(centre);
        let reach = damping(first).abs().max(damping(end - 1).abs());
        let blocks = self.blocks.len();
        self.groups.push(Group {
            start: blocks as u32,
            end: (blocks + count) as u32,
            tap: (point as i64 - 3 + MARGIN as i64) as u16,
            fraction: ((centre - point) * FRACTIONS as f64) as u8,
            order: DAMPINGS.iter().filter(|damping| reach > **damping).count() as u8,
        });
        self.blocks.resize(blocks + count, Block::REST);
        self.halves.resize(blocks + count, [[0.0; LANES]; 2]);
        self.starts.extend(&ends[..count]);
        instructions.run(Tune {
            blocks: &mut self.blocks[blocks..],
            halves: &mut self.halves[blocks..],
            starts: &self.starts[blocks..],
            modes,
            tuning,
            frames: self.frames as f64,
            centre,
        });
        true
    }

    /// Writes the amplitudes of the masses of some groups at the beginning of the block, mode by mode.
    pub(super) fn hand_over(&self, groups: &[Group], held: &mut Pair) {
        let (Some(first), Some(last)) = (groups.first(), groups.last()) else { return };
        for b in first.start as usize..last.end as usize {
            let (Block { state: [re, im], .. }, [half_re, half_im], start) =
                (&self.blocks[b], &self.halves[b], self.starts[b]);
            let count = self.starts[b + 1] - start;
            for lane in 0..count {
                let square = half_re[lane] * half_re[lane] + half_im[lane] * half_im[lane];
                held[0][start + lane] = (re[lane] * half_re[lane] + im[lane] * half_im[lane]) / square;
                held[1][start + lane] = (im[lane] * half_re[lane] - re[lane] * half_im[lane]) / square;
            }
        }
    }

    /// Gives the masses of the groups from `first` on the amplitudes that were handed over.
    pub(super) fn take_over(&mut self, first: usize, held: &Pair) {
        let Some(group) = self.groups.get(first) else { return };
        for b in group.start as usize..self.blocks.len() {
            let ([half_re, half_im], start) = (&self.halves[b], self.starts[b]);
            let [re, im] = &mut self.blocks[b].state;
            let (held_re, held_im) = (&held[0][start..start + LANES], &held[1][start..start + LANES]);
            for lane in 0..LANES {
                re[lane] = held_re[lane] * half_re[lane] - held_im[lane] * half_im[lane];
                im[lane] = held_re[lane] * half_im[lane] + held_im[lane] * half_re[lane];
            }
        }
    }

    /// The blocks that have any of some modes.
    pub(super) fn blocks_of(&self, modes: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let count = self.blocks.len();
        let first = self.starts[1..].partition_point(|end| *end <= modes.start).min(count);
        let last = self.starts[..count].partition_point(|start| *start < modes.end);
        first..last.max(first)
    }

    /// Sum of the squared amplitudes at the beginning of the block, of some blocks. Sets masses that have nearly stopped to rest.
    pub(super) fn measure(&mut self, blocks: std::ops::Range<usize>) -> f64 {
        let mut sums = [0.0; LANES];
        for (block, [half_re, half_im]) in self.blocks[blocks.clone()].iter_mut().zip(&self.halves[blocks]) {
            let [re, im] = &mut block.state;
            for lane in 0..LANES {
                let square = half_re[lane] * half_re[lane] + half_im[lane] * half_im[lane];
                let energy = (re[lane] * re[lane] + im[lane] * im[lane]) / square.max(f32::MIN_POSITIVE);
                let kept = if energy < REST * REST { 0.0 } else { 1.0 };
                (re[lane], im[lane]) = (re[lane] * kept, im[lane] * kept);
                sums[lane] += energy;
            }
        }
        sums.iter().map(|sum| f64::from(*sum)).sum()
    }

    /// The same sum for all blocks, in double precision.
    pub(super) fn energy(&self) -> f64 {
        let blocks = self.blocks.iter().zip(&self.halves);
        let lanes = blocks.flat_map(|(block, half)| (0..LANES).map(move |lane| (block, half, lane)));
        let square = |[re, im]: &[Row; 2], lane: usize| {
            f64::from(re[lane]) * f64::from(re[lane]) + f64::from(im[lane]) * f64::from(im[lane])
        };
        lanes.map(|(block, half, lane)| square(&block.state, lane) / square(half, lane).max(f64::MIN_POSITIVE)).sum()
    }
}

/// Smaller amplitudes are set to rest, since products with powers of their distances would be subnormal numbers, with which
/// calculations take a hundred times as long.
const REST: f32 = 1e-16;

/// Computes the coefficients of the blocks of a group.
struct Tune<'a> {
    blocks: &'a mut [Block],
    halves: &'a mut [[Row; 2]],
    starts: &'a [usize],
    modes: &'a ModeSet,
    tuning: &'a Tuning,
    frames: f64,
    centre: f64,
}

impl Kernel for Tune<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { blocks, halves, starts, modes, tuning, frames, centre } = self;
        let (half, steps) = (0.5 * frames, 2.0 * frames);
        for b in 0..blocks.len() {
            let (start, count) = (starts[b], starts[b + 1] - starts[b]);
            let (block, to_half) = (&mut blocks[b], &mut halves[b]);
            let frequencies = &modes.frequencies[start..start + LANES];
            let ways = &modes.ways[start..start + LANES];
            let gains = [&modes.gains[0][start..start + LANES], &modes.gains[1][start..start + LANES]];
            for lane in 0..LANES {
                let on = if lane < count { 1.0 } else { 0.0 };
                let (cycle, rate) =
                    (frequencies[lane] / tuning.sample_rate * tuning.pitch, f64::from(tuning.rate(ways[lane])));
                // Adding and subtracting this number rounds to a whole number.
                let (turns, whole) = (cycle * half, 1.5 * (1_u64 << 52) as f64);
                let angle = PI * (turns - ((turns + whole) - whole));
                let (sine, cosine) = sine_and_cosine(angle);
                let radius = exponential(-rate * half) * on;
                let (re, im) = (radius * (1.0 - 2.0 * sine * sine), radius * 2.0 * sine * cosine);
                (to_half[0][lane], to_half[1][lane]) = (re as f32, im as f32);
                (block.turn[0][lane], block.turn[1][lane]) = ((re * re - im * im) as f32, (2.0 * re * im) as f32);
                block.distance[0][lane] = ((cycle * steps - centre) * on) as f32;
                block.distance[1][lane] = ((rate - tuning.middle) * frames / PI * on) as f32;
                block.gains[0][lane] = gains[0][lane] * on as f32;
                block.gains[1][lane] = gains[1][lane] * on as f32;
            }
            block.state = *to_half;
        }
    }
}

/// Sine and cosine of an angle up to a quarter turn, by their series: within 1e−11, and without branches.
#[inline(always)]
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let square = angle * angle;
    let (mut sine, mut cosine) = (1.0, 1.0);
    for n in [7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        sine = 1.0 - sine * square * (1.0 / (2.0 * n * (2.0 * n + 1.0)));
        cosine = 1.0 - cosine * square * (1.0 / (2.0 * n * (2.0 * n - 1.0)));
    }
    (angle * sine, cosine)
}

/// `e^x` for −1.1 to 0, by its series: within 1e−9.
#[inline(always)]
fn exponential(x: f64) -> f64 {
    let mut sum = 1.0;
    for n in [12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        sum = 1.0 + sum * x * (1.0 / n);
    }
    sum
}
