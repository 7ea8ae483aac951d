//! What a bank keeps of its modes: a row of numbers each, so that vectors of modes lie side by side.

use super::MAX_MODES;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::simd::vector::Vector;

/// A number for each mode.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [f32; MAX_MODES]);

impl Row {
    pub(super) const ZERO: Row = Row([0.0; MAX_MODES]);
    pub(super) const ONE: Row = Row([1.0; MAX_MODES]);

    /// The numbers of the modes from `at` on. (A method and not a closure where it is used: closures are not inlined,
    /// and what is not inlined is compiled without the level's instructions.)
    #[inline(always)]
    pub(super) fn at<V: Vector>(&self, proof: V::Proof, at: usize) -> V {
        V::load(proof, &self.0[at..])
    }
}

/// A double-precision number for each mode.
pub(super) type Wide = [f64; MAX_MODES];

/// Where each mass is: its displacement, and the displacement that it will have a quarter turn ahead.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) x: Row,
    pub(super) y: Row,
}

impl State {
    pub(super) const REST: State = State { x: Row::ZERO, y: Row::ZERO };
}

/// What the register form reads of each mode: one frame turns the state by `z = r e^(iθ)`.
///
/// What moves has its value at the start of a straight line, and how much it changes a frame: after `i` frames it is
/// `value + i · step`, rounded once. (Adding the step frame by frame would round each time the same way.)
#[derive(Clone, Debug)]
pub(super) struct Modes {
    /// `α = 1 − r cos θ`. The difference from 1, so that no digit of a long decay is lost.
    pub(super) alpha: Row,
    /// `β = r sin θ`.
    pub(super) beta: Row,
    pub(super) alpha_step: Row,
    pub(super) beta_step: Row,
    /// Gains to the left and to the right.
    pub(super) left: Row,
    pub(super) right: Row,
    pub(super) left_step: Row,
    pub(super) right_step: Row,
    /// What a unit of pulse adds to both coordinates, and a unit of noise to `y`.
    pub(super) pulse_x: Row,
    pub(super) pulse_y: Row,
    pub(super) noise: Row,
}

impl Modes {
    pub(super) const UNSET: Modes = Modes {
        alpha: Row::ZERO,
        beta: Row::ZERO,
        alpha_step: Row::ZERO,
        beta_step: Row::ZERO,
        left: Row::ONE,
        right: Row::ONE,
        left_step: Row::ZERO,
        right_step: Row::ZERO,
        pulse_x: Row::ZERO,
        pulse_y: Row::ZERO,
        noise: Row::ZERO,
    };
}

/// How much moves while frames are rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moving {
    /// Nothing but the masses.
    Nothing,
    /// Pitches: `α` and `β`.
    Pitch,
    /// Pitches and gains, because modes pass the top of the spectrum.
    PitchAndGain,
}

/// What the next frames need. Multiplications by 1 and additions of 0 are left out where they can be, which changes
/// no bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) moving: Moving,
    pub(super) driven: bool,
    /// Gains are not all 1.
    pub(super) stereo: bool,
    /// Modes that may be ringing, from the first.
    pub(super) live: usize,
    /// How many, at most [`CONTROL_FRAMES`].
    pub(super) frames: usize,
    /// Frames of the line, and how many of them have passed before these.
    pub(super) line: usize,
    pub(super) passed: usize,
}

/// Output of up to a control tick, left and right; the right side is written only in stereo.
pub(super) type Output = [[f32; CONTROL_FRAMES]; 2];
