//! The running state of a resonant body: all of its masses, one drive and two pick-ups.

mod fourier;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod head;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod layout;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod masses;
mod process;
mod sums;
mod tail;
#[allow(clippy::needless_range_loop, reason = "several arrays are indexed in step")]
mod taps;
#[cfg(test)]
mod tests;

use super::bands::Bands;
use super::decay::Decay;
use super::modes::ModeSet;
use super::ticks::BODY_TICK;
use crate::dsp::simd::{Instructions, Level};
use fourier::Pair;
use head::{Head, Past};
use layout::Tuning;
use libm::{exp2, floor, log2};
use tail::Tail;

/// Slices in which the masses of a body at rest are laid out ahead: some 4 µs each for 13,000, since all channels of an ensemble may
/// be at it.
const SLICES: usize = 128;

/// Smallest and largest pitch ratio of a body to its reference pitch.
const PITCHES: [f64; 2] = [1.0 / 64.0, 64.0];

/// A body whose every mode is a mass on a spring. Creating one allocates and dropping one frees memory, so do neither on the
/// audio thread; everything else is meant for it. [`super::ModalReverb`] plays it.
///
/// **Passive.** A block turns and shrinks each mass; only input adds energy. So without input the energy falls with every
/// block, for all changes of pitch and decay, and its square root never rises by more than the input's magnitude times the
/// square root of the number of masses. (A mass's amplitude is in units of its response to a sample of 1.)
#[derive(Clone, Debug)]
pub struct Resonator {
    instructions: Instructions,
    sample_rate: f64,
    /// Frames of a block, and frames of the present block that are over.
    block: usize,
    frame: usize,
    pitch: f64,
    decay: Decay,
    /// The coefficients that are wanted, and those that the masses have or are given in this block.
    wanted: Tuning,
    given: Option<Tuning>,
    /// For which coefficients masses at rest are laid out ahead, and the slices of that which are done. Nothing else follows from it.
    ahead: Option<(Tuning, usize)>,
    /// Whether the masses are given other coefficients in this block, and whether this happened in the block before: then the
    /// output fades from the former response to the present one.
    is_changing: bool,
    fades: bool,
    /// Gains for noise: of the coefficients that are heard, and of those of the change.
    gains: [f32; 2],
    bands: Bands,
    /// Input of the block.
    input: Vec<f32>,
    tail: Tail,
    /// Output of the masses in this block, and in the next.
    tails: [Pair; 2],
    past: Past,
    /// The head of the response: the present one, the former, and room for the next.
    heads: [Head; 3],
    /// During a change: the tail with the former coefficients, and the head as frames.
    former: Pair,
    parts: [Pair; 2],
    out: [[f32; BODY_TICK]; 2],
}

impl Resonator {
    /// A body at rest. Modes above 98 % of half the sample rate are silent.
    pub fn new(modes: &'static ModeSet, decay: Decay, sample_rate: f64) -> Self {
        let mut body = Self::with_room(modes.len(), decay, sample_rate);
        body.load(modes);
        body.prepare();
        body
    }

    /// A body without masses, with room for `masses`.
    pub fn with_room(masses: usize, decay: Decay, sample_rate: f64) -> Self {
        let (instructions, block) = (Instructions::current(), block_frames(sample_rate));
        let pair = || [vec![0.0; block], vec![0.0; block]];
        let (tail, ticks) = (Tail::with_room(instructions, masses, block), 2 * block / BODY_TICK);
        Self {
            instructions,
            sample_rate,
            block,
            frame: 0,
            pitch: 1.0,
            decay,
            wanted: Tuning::new(1.0, decay, sample_rate, tail.modes()),
            given: None,
            ahead: None,
            is_changing: false,
            fades: false,
            gains: [0.0; 2],
            bands: Bands::new(),
            input: vec![0.0; block],
            tail,
            tails: [pair(), pair()],
            past: Past::new(ticks),
            heads: std::array::from_fn(|_| Head::new(ticks)),
            former: pair(),
            parts: [pair(), pair()],
            out: [[0.0; BODY_TICK]; 2],
        }
    }

    /// Loads other modes, at rest and at the same pitch. Follow with [`Resonator::prepare`] or [`Resonator::begin`]. Real-time safe if
    /// there is room for as many.
    pub(super) fn load(&mut self, modes: &'static ModeSet) {
        self.reset();
        self.tail.load(modes);
        self.bands.load(modes);
        (self.given, self.ahead) = (None, None);
        self.change();
    }

    /// Sets the ratio of all frequencies to those of the body's modes. The masses have it from the next block but one on.
    /// Real-time safe.
    pub(super) fn tune(&mut self, pitch: f64) {
        let [least, greatest] = PITCHES;
        self.pitch = if pitch.is_nan() { 1.0 } else { pitch.clamp(least, greatest) };
        self.change();
    }

    /// Sets another decay, in the same way. Real-time safe.
    pub(super) fn set_decay(&mut self, decay: Decay) {
        self.decay = decay;
        self.change();
    }

    fn change(&mut self) {
        self.wanted = Tuning::new(self.pitch, self.decay, self.sample_rate, self.tail.modes());
        self.bands.change(self.wanted.shift, self.wanted.heard, self.decay.log_rates(self.sample_rate));
    }

    /// Gives all masses the wanted coefficients at once, if they have others. For masses at rest. Real-time safe; takes up to half a
    /// millisecond for 13,000, less what [`Resonator::prepare_ahead`] has done of it.
    pub(super) fn prepare(&mut self) {
        if self.given != Some(self.wanted) {
            self.prepare_ahead(SLICES);
            (self.given, self.ahead) = (Some(self.wanted), None);
            self.tail.finish(&mut self.tails[1], Some((&mut self.former, &mut self.parts)));
            self.heads[0].set(self.instructions, &self.parts, &mut self.past);
        }
        self.bands.settle();
        self.gains = [self.noise_gain(); 2];
    }

    /// Does some slices of what [`Resonator::prepare`] has to do. For masses at rest. How many slices are done makes no difference to what
    /// is heard. Real-time safe.
    pub(super) fn prepare_ahead(&mut self, slices: usize) {
        if self.given == Some(self.wanted) {
            return;
        }
        let done = match self.ahead {
            Some((tuning, done)) if tuning == self.wanted => done,
            _ => {
                self.tail.begin(&[], Some(self.wanted));
                0
            }
        };
        let next = SLICES.min(done + slices);
        if done < next {
            self.tail.work(next, SLICES);
            self.ahead = Some((self.wanted, next));
        }
    }

    /// Begins with the wanted coefficients. If the masses, which are at rest, have others, they are given these in the first block, slice
    /// by slice, and the block is silent. Real-time safe.
    pub(super) fn begin(&mut self) {
        self.ahead = None;
        if self.given != Some(self.wanted) {
            // The masses have coefficients, but no head any more, should they be set to rest before that block.
            self.given = None;
            self.heads[0].forget();
            self.gains = [self.noise_gain(); 2];
        }
    }

    /// Whether a change of the coefficients is not heard yet.
    pub(super) fn is_changing(&self) -> bool {
        self.is_changing || self.given != Some(self.wanted)
    }

    /// Number of audible masses.
    pub fn len(&self) -> usize {
        self.wanted.heard
    }

    /// Whether there are no audible masses.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The sample rate in Hz.
    pub(crate) fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// Number of frames through which the masses turn at once.
    pub fn block_frames(&self) -> usize {
        self.block
    }

    /// The instruction level in use.
    pub fn instructions(&self) -> Level {
        self.instructions.level()
    }

    /// The decay, or its target during a change.
    pub(crate) fn decay(&self) -> Decay {
        self.decay
    }

    /// Sum of the squared amplitudes of the masses, in double precision. Input reaches them when its block is over, and some of
    /// them a block later. For inspection: takes microseconds.
    pub fn energy(&self) -> f64 {
        self.tail.energy()
    }

    /// Gain at which the output is as loud as the input for white noise, with the coefficients that are heard.
    pub(super) fn heard_noise_gain(&self) -> f32 {
        self.gains[0]
    }

    /// The same with the coefficients that are wanted.
    pub(super) fn noise_gain(&self) -> f32 {
        self.bands.noise_gain(self.decay.log_rates(self.sample_rate)) as f32
    }

    /// The greatest of the gains that are not heard yet: with the coefficients of a change under way, and with the wanted ones.
    pub(super) fn coming_noise_gain(&self) -> f32 {
        self.gains[1].max(self.noise_gain())
    }

    /// Handles a control tick. `input` is the sum of the input's magnitudes since the last tick.
    pub(super) fn tick(&mut self, input: f64) {
        self.bands.tick(input);
    }

    /// Measures the energy, and sets masses that have nearly stopped to rest. Call it at the beginning of a block, before
    /// [`Resonator::work`], if the body had no input in the block before.
    pub(super) fn measure(&mut self) {
        let mut last = 0;
        for index in 0..self.bands.len() {
            let modes = self.bands.modes(index);
            let energy = self.tail.measure(modes.clone());
            if energy > 0.0 {
                last = modes.end;
            }
            self.bands.measured(index, energy);
        }
        self.tail.rest_from(last);
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
        self.tail.rest();
        self.past.clear();
        self.tails.iter_mut().flatten().for_each(|side| side.fill(0.0));
        self.heads.iter_mut().for_each(Head::clear);
        self.input.fill(0.0);
        self.frame = 0;
        if self.is_changing {
            self.given = None;
        }
        (self.is_changing, self.fades, self.ahead) = (false, false, None);
        self.bands.rest();
    }
}

/// Frames of a block: 6 to 12 ms from 5.5 kHz on. Shorter ones turn the masses more often, longer ones have a longer head, and their taps have to
/// reach further if the decay is short.
fn block_frames(sample_rate: f64) -> usize {
    let octaves = floor(log2(sample_rate / 44_100.0)).clamp(-3.0, 4.0);
    (512.0 * exp2(octaves)) as usize
}
