//! The running state of a resonant body: all of its masses, one drive and two pick-ups.

use super::bands::{BANDS, Band, Bands};
use super::decay::{Decay, shift};
use super::kernel::{Block, Damp, FRAMES, GROUP, Measure, Output, Step, Turn};
use super::modes::ModeSet;
use crate::dsp::coefficients::angle_from_frequency;
use crate::dsp::simd::vector::LANES;
use crate::dsp::simd::{Instructions, Level};
use libm::{floor, log2};
use std::f64::consts::PI;

/// Modes above this fraction of half the sample rate are left out.
const TOP: f64 = 0.98;

/// Number of blocks that get a new decay in one control tick: 1,024 masses, in about a microsecond.
const DAMPED_PER_TICK: usize = 64;

/// Smallest and largest pitch ratio of a body to its reference pitch.
const PITCHES: [f64; 2] = [1.0 / 64.0, 64.0];

/// A body whose every mode is a mass on a spring. Creating one allocates and dropping one frees memory, so do neither on the
/// audio thread; everything else is meant for it. [`super::ModalReverb`] plays it.
///
/// **Passive.** A frame turns and shrinks each mass; only input adds energy. So without input the energy falls with every
/// frame, for all changes of pitch and decay, and its square root never rises by more than the input's magnitude times the
/// square root of the number of masses. (A mass's amplitude is in units of its response to a sample of 1.)
#[derive(Clone, Debug)]
pub struct Resonator {
    instructions: Instructions,
    sample_rate: f64,
    /// Ratio of the frequencies to those of the modes.
    pitch: f64,
    /// Number of audible masses at this pitch, and number of the blocks (in whole groups) that contain them.
    len: usize,
    heard: usize,
    blocks: Vec<Block>,
    turns: Vec<Turn>,
    bands: Bands,
    /// Blocks from this index on are at rest. A whole number of groups.
    live: usize,
    decay: Decay,
    /// Logarithms of the rates of the decay and, while some blocks still have it, of the previous decay.
    rates: [[f64; 2]; 2],
    /// Next block that gets the new decay, and number of blocks that still have the old one.
    next_damped: usize,
    to_damp: usize,
    out: Output,
}

impl Resonator {
    /// A body at rest. Modes above 98 % of half the sample rate are silent.
    pub fn new(modes: &ModeSet, decay: Decay, sample_rate: f64) -> Self {
        let mut body = Self::with_room(modes.len(), decay, sample_rate);
        body.load(modes);
        body
    }

    /// A body without masses, with room for `masses`.
    pub fn with_room(masses: usize, decay: Decay, sample_rate: f64) -> Self {
        let blocks = blocks_of(masses);
        Self {
            instructions: Instructions::current(),
            sample_rate,
            pitch: 1.0,
            len: 0,
            heard: 0,
            blocks: Vec::with_capacity(blocks),
            turns: Vec::with_capacity(blocks),
            bands: Bands::new(),
            live: 0,
            decay,
            rates: [decay.log_rates(sample_rate); 2],
            next_damped: 0,
            to_damp: 0,
            out: [[0.0; FRAMES]; 2],
        }
    }

    /// Loads other modes, at rest and at the same pitch. Real-time safe if there is room for as many; takes some 100 µs for
    /// 13,000.
    pub(super) fn load(&mut self, modes: &ModeSet) {
        let count = blocks_of(modes.len());
        self.blocks.clear();
        self.turns.clear();
        self.blocks.resize(count, Block::REST);
        self.turns.resize(count, Turn::NONE);
        for (m, (mode, way)) in modes.modes().iter().zip(modes.ways()).enumerate() {
            let (block, turn, lane) = (&mut self.blocks[m / LANES], &mut self.turns[m / LANES], m % LANES);
            block.left[lane] = gain(mode.drive * mode.left);
            block.right[lane] = gain(mode.drive * mode.right);
            turn.angle[lane] = angle_from_frequency(mode.frequency, self.sample_rate) as f32;
            turn.way[lane] = *way;
        }
        self.live = 0;
        self.find_bands(modes);
        self.tune(self.pitch);
    }

    /// Sets the ratio of all frequencies to those of the body's modes. Real-time safe; takes some 100 µs for 13,000.
    pub(super) fn tune(&mut self, pitch: f64) {
        let [least, greatest] = PITCHES;
        self.pitch = if pitch.is_nan() { 1.0 } else { pitch.clamp(least, greatest) };
        let (pitch, highest, shift) = (self.pitch, PI * TOP, shift(self.pitch) as f32);
        // The modes are sorted by frequency.
        let is_heard = |angle: f32| f64::from(angle) * pitch < highest;
        let whole = self.turns.partition_point(|turn| is_heard(turn.angle[LANES - 1]));
        let rest = self.turns.get(whole).map_or(0, |turn| turn.angle.partition_point(|angle| is_heard(*angle)));
        self.len = whole * LANES + rest;
        self.heard = blocks_of(self.len);
        for turn in &mut self.turns[..self.heard] {
            turn.tune(pitch, shift, highest);
        }
        // Masses that have become too high are set to rest, so that they are silent if they become audible again.
        let live = self.live.min(self.heard);
        rest_all(&mut self.blocks[live..self.live]);
        self.live = live;
        self.bands.tune(shift, self.heard);
        self.damp_all();
    }

    /// Groups the blocks into bands by the frequencies of their modes.
    fn find_bands(&mut self, modes: &ModeSet) {
        self.bands.clear();
        let (blocks, modes, ways) = (&self.blocks, modes.modes(), modes.ways());
        let of_block = |block: usize| {
            // Blocks that only fill up the last group belong to the last band.
            let first = block.min((modes.len() - 1) / LANES) * LANES;
            let frequency = modes[first].frequency;
            floor((3.0 * log2(frequency / 31.25)).clamp(0.0, (BANDS - 1) as f64)) as usize
        };
        let mut start = 0;
        while start < blocks.len() {
            let band = of_block(start);
            let end = (start..blocks.len()).find(|block| of_block(*block) != band).unwrap_or(blocks.len());
            let members = start * LANES..(end * LANES).min(modes.len()).max(start * LANES);
            let sum = |side: fn(&Block) -> &[f32; LANES]| -> f64 {
                let gains = blocks[start..end].iter().flat_map(|block| side(block).iter());
                gains.map(|gain| f64::from(*gain) * f64::from(*gain)).sum()
            };
            let gains = [sum(|block| &block.left), sum(|block| &block.right)];
            let ways = &ways[members.clone()];
            let edges = [ways.first(), ways.last()].map(|way| way.copied().unwrap_or(0.0));
            self.bands.push(Band::new(start..end, edges, members.len(), gains));
            start = end;
        }
    }

    /// Number of audible masses.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no audible masses.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The sample rate in Hz.
    pub fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// The instruction level in use.
    pub fn instructions(&self) -> Level {
        self.instructions.level()
    }

    /// The decay, or its target during a change.
    pub fn decay(&self) -> Decay {
        self.decay
    }

    /// Sum of the squared amplitudes of the masses, in double precision. For inspection: takes microseconds.
    pub fn energy(&self) -> f64 {
        let lanes = self.blocks.iter().flat_map(|block| block.x.iter().zip(&block.y));
        lanes.map(|(x, y)| f64::from(*x) * f64::from(*x) + f64::from(*y) * f64::from(*y)).sum()
    }

    /// Sets another decay: for some masses at each of the next control ticks, for all within 25 ms at 48 kHz. Real-time safe.
    pub(super) fn set_decay(&mut self, decay: Decay) {
        if decay == self.decay {
            return;
        }
        let rates = decay.log_rates(self.sample_rate);
        // Some blocks may still have an even older decay: the bound uses the slower one at either end.
        let [old, older] = self.rates;
        let ends = |[low, span]: [f64; 2]| [low, low + span];
        let slowest = match self.to_damp {
            0 => old,
            _ => {
                let (a, b) = (ends(old), ends(older));
                let [low, high] = [a[0].min(b[0]), a[1].min(b[1])];
                [low, high - low]
            }
        };
        (self.decay, self.rates, self.to_damp) = (decay, [rates, slowest], self.heard);
        self.bands.damp(self.rates);
    }

    fn damp(&mut self, range: std::ops::Range<usize>) {
        let [low, span] = self.rates[0].map(|rate| rate as f32);
        let (blocks, turns) = (&mut self.blocks[range.clone()], &self.turns[range]);
        self.instructions.run(Damp { blocks, turns, low, span });
    }

    /// Sets the target decay of all masses at once.
    fn damp_all(&mut self) {
        self.damp(0..self.heard);
        (self.to_damp, self.next_damped, self.rates[1]) = (0, 0, self.rates[0]);
        self.bands.damp(self.rates);
    }

    /// Gain at which the output is as loud as the input for white noise.
    pub(super) fn noise_gain(&self) -> f32 {
        self.bands.noise_gain(self.rates[0]) as f32
    }

    /// Handles a control tick. `input` is the sum of the input's magnitudes since the last tick.
    pub(super) fn tick(&mut self, input: f64) {
        self.bands.tick(input);
        if self.to_damp > 0 {
            let end = self.heard.min(self.next_damped + DAMPED_PER_TICK.min(self.to_damp));
            self.damp(self.next_damped..end);
            self.to_damp -= end - self.next_damped;
            self.next_damped = end % self.heard;
            if self.to_damp == 0 {
                self.rates[1] = self.rates[0];
                self.bands.damp(self.rates);
            }
        }
    }

    /// Measures the energy, and sets masses that have nearly stopped to rest. `is_all` says that all input that was reported to
    /// [`Resonator::tick`] has reached the body. Call it at control ticks.
    pub(super) fn measure(&mut self, is_all: bool) {
        let mut last = 0;
        for index in 0..self.bands.len() {
            let range = self.bands.blocks(index);
            let live = range.start..range.end.min(self.live.max(range.start));
            let energy = self.instructions.run(Measure { blocks: &mut self.blocks[live] });
            if energy > 0.0 {
                last = range.end;
            }
            if is_all {
                self.bands.measured(index, energy);
            }
        }
        self.live = self.live.min(last.next_multiple_of(GROUP));
    }

    /// Steps the masses through some frames, at most [`FRAMES`], and returns the outputs of the pick-ups.
    pub(super) fn render(&mut self, input: &[f32]) -> &Output {
        let driven = input.iter().any(|sample| *sample != 0.0);
        if driven {
            self.live = self.heard;
        }
        let Self { blocks, live, out, .. } = self;
        self.instructions.run(Step { blocks: &mut blocks[..*live], input, driven, out });
        out
    }

    /// Upper bound of the output of either pick-up, after further input whose magnitudes sum to `input`.
    pub(super) fn peak(&self, input: f64) -> f64 {
        self.bands.peak(input)
    }

    /// Upper bound of the frames until that has fallen to `peak`.
    pub(super) fn frames_until(&self, peak: f64, input: f64) -> u64 {
        self.bands.frames_until(peak, input)
    }

    /// Sets all masses to rest.
    pub(super) fn reset(&mut self) {
        rest_all(&mut self.blocks[..self.live]);
        self.live = 0;
        self.bands.rest();
    }

    /// Sets the target decay of all masses at once, if a change is running. For masses at rest.
    pub(super) fn finish_damping(&mut self) {
        if self.to_damp > 0 {
            self.damp_all();
        }
    }
}

/// Number of blocks for some masses, in whole groups.
fn blocks_of(masses: usize) -> usize {
    masses.div_ceil(GROUP * LANES) * GROUP
}

fn rest_all(blocks: &mut [Block]) {
    for block in blocks {
        (block.x, block.y) = ([0.0; LANES], [0.0; LANES]);
    }
}

/// A gain in single precision. Near a node it is 0, since products with tiny gains would be subnormal.
fn gain(value: f64) -> f32 {
    if value.abs() < 1e-9 { 0.0 } else { value.clamp(-1e6, 1e6) as f32 }
}
