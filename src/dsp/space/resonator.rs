//! A resonant body at work: all of its masses, driven by every sample and heard by two pick-ups.

use super::bands::{BANDS, Band, Bands};
use super::decay::{Decay, height};
use super::kernel::{Block, Damp, FRAMES, GROUP, Measure, Output, Step, Turn};
use super::modes::{BodyMode, ModeSet};
use crate::dsp::coefficients::angle_from_frequency;
use crate::dsp::simd::vector::LANES;
use crate::dsp::simd::{Instructions, Level};
use libm::{cos, floor, log2, sin};

/// Modes nearer to half the sample rate than this share of it are left out.
const TOP: f64 = 0.98;

/// Blocks that a control tick gives another decay: 1,024 masses, in about a microsecond.
const DAMPED_PER_TICK: usize = 64;

/// A body whose every mode is a mass on a spring. Making and dropping one (de)allocates: not for the audio thread, but for
/// all else it is made to be used there. See [`super::ModalReverb`], which plays it.
///
/// **Passive.** A frame turns each mass and shrinks it; only input adds to it. So without input the energy falls with every
/// frame whatever happens to the decay; and its root never rises by more than the input's magnitude times the root of the
/// number of masses. (A mass's amplitude counts in units of what a sample of 1 gives it.)
#[derive(Clone, Debug)]
pub struct Resonator {
    instructions: Instructions,
    sample_rate: f64,
    len: usize,
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
    /// A body at rest. Modes above 98 % of half the sample rate are left out.
    pub fn new(modes: &ModeSet, decay: Decay, sample_rate: f64) -> Self {
        let top = 0.5 * TOP * sample_rate;
        let modes: Vec<_> = modes.modes().iter().filter(|mode| mode.frequency < top).copied().collect();
        let groups = modes.len().div_ceil(GROUP * LANES);
        let (mut blocks, mut turns) = (vec![Block::REST; groups * GROUP], vec![Turn::NONE; groups * GROUP]);
        for (m, mode) in modes.iter().enumerate() {
            let (block, turn, lane) = (&mut blocks[m / LANES], &mut turns[m / LANES], m % LANES);
            let angle = angle_from_frequency(mode.frequency, sample_rate);
            let half_chord = sin(0.5 * angle);
            block.left[lane] = gain(mode.drive * mode.left);
            block.right[lane] = gain(mode.drive * mode.right);
            turn.versine[lane] = (2.0 * half_chord * half_chord) as f32;
            turn.cosine[lane] = cos(angle) as f32;
            turn.sine[lane] = sin(angle) as f32;
            turn.height[lane] = height(mode.frequency) as f32;
        }
        let rates = decay.log_rates(sample_rate);
        let mut body = Self {
            instructions: Instructions::current(),
            sample_rate,
            len: modes.len(),
            turns,
            bands: bands(&modes, &blocks),
            live: 0,
            blocks,
            decay,
            rates: [rates; 2],
            next_damped: 0,
            to_damp: 0,
            out: [[0.0; FRAMES]; 2],
        };
        body.damp(0..body.blocks.len());
        body.bands.damp(body.rates);
        body
    }

    /// Number of masses.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has none, and so is never heard.
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
        (self.decay, self.rates, self.to_damp) = (decay, [rates, slowest], self.blocks.len());
        self.bands.damp(self.rates);
    }

    fn damp(&mut self, range: std::ops::Range<usize>) {
        let [low, span] = self.rates[0].map(|rate| rate as f32);
        let (blocks, turns) = (&mut self.blocks[range.clone()], &self.turns[range]);
        self.instructions.run(Damp { blocks, turns, low, span });
    }

    /// Gain by which white noise comes out as loud as it went in.
    pub(super) fn noise_gain(&self) -> f32 {
        self.bands.noise_gain(self.rates[0]) as f32
    }

    /// A control tick: `input` is the sum of the magnitudes of what has come in since the last.
    pub(super) fn tick(&mut self, input: f64) {
        self.bands.tick(input);
        if self.to_damp > 0 {
            let end = self.blocks.len().min(self.next_damped + DAMPED_PER_TICK.min(self.to_damp));
            self.damp(self.next_damped..end);
            self.to_damp -= end - self.next_damped;
            self.next_damped = end % self.blocks.len();
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
            self.live = self.blocks.len();
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
        for block in &mut self.blocks[..self.live] {
            (block.x, block.y) = ([0.0; LANES], [0.0; LANES]);
        }
        self.live = 0;
        self.bands.rest();
    }

    /// Sends masses at rest to the decay that they are on their way to, all at once.
    pub(super) fn finish_damping(&mut self) {
        if self.to_damp > 0 {
            self.damp(0..self.blocks.len());
            (self.to_damp, self.next_damped, self.rates[1]) = (0, 0, self.rates[0]);
            self.bands.damp(self.rates);
        }
    }
}

/// A gain in single precision; next to a node, none: products with it would leave the normal numbers.
fn gain(value: f64) -> f32 {
    if value.abs() < 1e-9 { 0.0 } else { value.clamp(-1e6, 1e6) as f32 }
}

/// The bands of a body.
fn bands(modes: &[BodyMode], blocks: &[Block]) -> Bands {
    let of_block = |block: usize| {
        // Blocks that only fill up the last group belong to the last band.
        let first = block.min((modes.len() - 1) / LANES) * LANES;
        let frequency = modes[first].frequency;
        floor((3.0 * log2(frequency / 31.25)).clamp(0.0, (BANDS - 1) as f64)) as usize
    };
    let mut bands = Vec::new();
    let mut start = 0;
    while start < blocks.len() {
        let band = of_block(start);
        let end = (start..blocks.len()).find(|block| of_block(*block) != band).unwrap_or(blocks.len());
        let members = &modes[start * LANES..(end * LANES).min(modes.len()).max(start * LANES)];
        let of_rows = |norm: &dyn Fn(&Block, usize) -> f64| -> f64 {
            let all = blocks[start..end].iter().flat_map(|block| (0..LANES).map(move |lane| (block, lane)));
            all.map(|(block, lane)| norm(block, lane)).sum()
        };
        let square = |value: f32| f64::from(value) * f64::from(value);
        let left = of_rows(&|block, lane| square(block.left[lane]));
        let right = of_rows(&|block, lane| square(block.right[lane]));
        let edge = |mode: Option<&BodyMode>| mode.map_or(0.0, |mode| height(mode.frequency));
        let heights = [edge(members.first()), edge(members.last())];
        bands.push(Band::new(start..end, heights, members.len(), [left, right]));
        start = end;
    }
    Bands::new(bands)
}
