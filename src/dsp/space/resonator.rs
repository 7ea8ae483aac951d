//! A resonant body at work: all of its masses, driven by every sample and heard by two pick-ups.

use super::bands::{BANDS, Band, Bands};
use super::decay::{Decay, shift};
use super::kernel::{Block, Damp, FRAMES, GROUP, Measure, Output, Step, Turn};
use super::modes::ModeSet;
use crate::dsp::coefficients::angle_from_frequency;
use crate::dsp::simd::vector::LANES;
use crate::dsp::simd::{Instructions, Level};
use libm::{floor, log2};
use std::f64::consts::PI;

/// Modes nearer to half the sample rate than this share of it are left out.
const TOP: f64 = 0.98;

/// Blocks that a control tick gives another decay: 1,024 masses, in about a microsecond.
const DAMPED_PER_TICK: usize = 64;

/// Least and greatest pitch of a body against its own.
const PITCHES: [f64; 2] = [1.0 / 64.0, 64.0];

/// A body whose every mode is a mass on a spring. Making and dropping one (de)allocates: not for the audio thread, but for
/// all else it is made to be used there. See [`super::ModalReverb`], which plays it.
///
/// **Passive.** A frame turns each mass and shrinks it; only input adds to it. So without input the energy falls with every
/// frame whatever happens to pitch and decay; and its root never rises by more than the input's magnitude times the root of
/// the number of masses. (A mass's amplitude counts in units of what a sample of 1 gives it.)
#[derive(Clone, Debug)]
pub struct Resonator {
    instructions: Instructions,
    sample_rate: f64,
    /// The frequencies are so many times those of the modes.
    pitch: f64,
    /// How many masses are heard at this pitch, and the groups' blocks that they are in.
    len: usize,
    heard: usize,
    blocks: Vec<Block>,
    turns: Vec<Turn>,
    bands: Bands,
    /// Blocks from here on are at rest; a whole number of groups.
    live: usize,
    decay: Decay,
    /// Logarithms of the rates of the decay, and of the one before while there are blocks that still have it.
    rates: [[f64; 2]; 2],
    /// Next block to get the decay, and how many are still to get it.
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

    /// A body without masses, with room for so many.
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

    /// Becomes the body of other modes, at rest and at the same pitch. Real-time safe if it has had room for as many;
    /// some 100 µs for 13,000.
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

    /// Sends all masses to frequencies of so many times those of the body's modes. Real-time safe; some 100 µs for 13,000.
    pub(super) fn tune(&mut self, pitch: f64) {
        let [least, greatest] = PITCHES;
        self.pitch = if pitch.is_nan() { 1.0 } else { pitch.clamp(least, greatest) };
        let (pitch, highest, shift) = (self.pitch, PI * TOP, shift(self.pitch) as f32);
        // By ascending frequency.
        let is_heard = |angle: f32| f64::from(angle) * pitch < highest;
        let whole = self.turns.partition_point(|turn| is_heard(turn.angle[LANES - 1]));
        let rest = self.turns.get(whole).map_or(0, |turn| turn.angle.partition_point(|angle| is_heard(*angle)));
        self.len = whole * LANES + rest;
        self.heard = blocks_of(self.len);
        for turn in &mut self.turns[..self.heard] {
            turn.tune(pitch, shift, highest);
        }
        // What is too high to be heard has no motion that could come back.
        let live = self.live.min(self.heard);
        rest_all(&mut self.blocks[live..self.live]);
        self.live = live;
        self.bands.tune(shift, self.heard);
        self.damp_all();
    }

    /// Finds the bands of the modes, which lie in the blocks.
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

    /// Number of masses that are heard.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The sample rate in Hz.
    pub fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// The level of instructions that it uses.
    pub fn instructions(&self) -> Level {
        self.instructions.level()
    }

    /// The decay that it has, or that it is on the way to.
    pub fn decay(&self) -> Decay {
        self.decay
    }

    /// Sum of the squared amplitudes of the masses, in double precision. To look at: takes microseconds.
    pub fn energy(&self) -> f64 {
        let lanes = self.blocks.iter().flat_map(|block| block.x.iter().zip(&block.y));
        lanes.map(|(x, y)| f64::from(*x) * f64::from(*x) + f64::from(*y) * f64::from(*y)).sum()
    }

    /// Sends all masses to another decay: some at each of the next control ticks, within 25 ms at 48 kHz. Real-time safe.
    pub(super) fn set_decay(&mut self, decay: Decay) {
        if decay == self.decay {
            return;
        }
        let rates = decay.log_rates(self.sample_rate);
        // Some blocks may still have an even older decay: the bound goes by whichever is slower at either end.
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

    /// Sends all masses to the decay that they are to have, at once.
    fn damp_all(&mut self) {
        self.damp(0..self.heard);
        (self.to_damp, self.next_damped, self.rates[1]) = (0, 0, self.rates[0]);
        self.bands.damp(self.rates);
    }

    /// Gain by which white noise comes out as loud as it went in.
    pub(super) fn noise_gain(&self) -> f32 {
        self.bands.noise_gain(self.rates[0]) as f32
    }

    /// A control tick: `input` is the sum of the magnitudes of what has come in since the last.
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

    /// Measures the energy, and sets to rest what has all but stopped. `is_all`: no input is still to come that
    /// [`Resonator::tick`] has been told of. To be called at control ticks.
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

    /// Turns the masses through some frames, at most [`FRAMES`], and gives what the pick-ups hear.
    pub(super) fn render(&mut self, input: &[f32]) -> &Output {
        let driven = input.iter().any(|sample| *sample != 0.0);
        if driven {
            self.live = self.heard;
        }
        let Self { blocks, live, out, .. } = self;
        self.instructions.run(Step { blocks: &mut blocks[..*live], input, driven, out });
        out
    }

    /// At most what either pick-up hears, once input whose magnitudes add up to `input` has come as well.
    pub(super) fn peak(&self, input: f64) -> f64 {
        self.bands.peak(input)
    }

    /// At most how many frames it takes until that has fallen to `peak`.
    pub(super) fn frames_until(&self, peak: f64, input: f64) -> u64 {
        self.bands.frames_until(peak, input)
    }

    /// Sets all masses to rest.
    pub(super) fn reset(&mut self) {
        rest_all(&mut self.blocks[..self.live]);
        self.live = 0;
        self.bands.rest();
    }

    /// Sends masses at rest to the decay that they are on their way to, all at once.
    pub(super) fn finish_damping(&mut self) {
        if self.to_damp > 0 {
            self.damp_all();
        }
    }
}

/// Blocks of so many masses: whole groups.
fn blocks_of(masses: usize) -> usize {
    masses.div_ceil(GROUP * LANES) * GROUP
}

fn rest_all(blocks: &mut [Block]) {
    for block in blocks {
        (block.x, block.y) = ([0.0; LANES], [0.0; LANES]);
    }
}

/// A gain in single precision; next to a node, none: products with it would leave the normal numbers.
fn gain(value: f64) -> f32 {
    if value.abs() < 1e-9 { 0.0 } else { value.clamp(-1e6, 1e6) as f32 }
}
