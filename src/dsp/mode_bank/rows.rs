//! The data of a bank: one row of numbers per quantity, so that vectors of modes are contiguous.

use super::MAX_MODES;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::simd::vector::Vector;

/// One number for each mode.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [f32; MAX_MODES]);

impl Row {
    pub(super) const ZERO: Row = Row([0.0; MAX_MODES]);
    pub(super) const ONE: Row = Row([1.0; MAX_MODES]);

    /// The numbers of the modes from `at` on. (A method, because closures would not be inlined here, and functions that are not
    /// inlined are compiled without the level's instructions.)
    #[inline(always)]
    pub(super) fn at<V: Vector>(&self, proof: V::Proof, at: usize) -> V {
        V::load(proof, &self.0[at..])
    }
}

/// One double-precision number for each mode.
pub(super) type Wide = [f64; MAX_MODES];

/// The state of each mass: its displacement, and the displacement a quarter period later.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) x: Row,
    pub(super) y: Row,
}

impl State {
    pub(super) const REST: State = State { x: Row::ZERO, y: Row::ZERO };
}

/// The data of each mode for stepping: one frame turns the state by `z = r e^(iθ)`.
///
/// A moving quantity is stored as its value at the start of a straight line and its change per frame: after `i` frames
/// it is `value + i · step`, rounded once. (Adding `step` in every frame would add up rounding errors of the same
/// sign.)
#[derive(Clone, Debug)]
pub(super) struct Modes {
    /// `α = 1 − r cos θ`: the difference from 1, so that long decays keep all their digits.
    pub(super) alpha: Row,
    /// `β = r sin θ`.
    pub(super) beta: Row,
    pub(super) alpha_step: Row,
    pub(super) beta_step: Row,
    /// Output gains, left and right.
    pub(super) left: Row,
    pub(super) right: Row,
    pub(super) left_step: Row,
    pub(super) right_step: Row,
    /// Change of both coordinates for one unit of push, of pull and of noise.
    pub(super) push_x: Row,
    pub(super) push_y: Row,
    pub(super) pull_x: Row,
    pub(super) pull_y: Row,
    pub(super) noise_x: Row,
    pub(super) noise: Row,
    /// What each mode takes of a player's force, and what it gives of its displacement. Only a hammer's force acts on `y` too.
    pub(super) take: Row,
    pub(super) take_y: Row,
    pub(super) give: Row,
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
        push_x: Row::ZERO,
        push_y: Row::ZERO,
        pull_x: Row::ZERO,
        pull_y: Row::ZERO,
        noise_x: Row::ZERO,
        noise: Row::ZERO,
        take: Row::ZERO,
        take_y: Row::ZERO,
        give: Row::ZERO,
    };
}

/// The quantities that change while frames are rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moving {
    /// Only the masses.
    Nothing,
    /// The pitches as well: `α` and `β`.
    Pitch,
    /// Pitches and gains, because modes fade at the top of the spectrum.
    PitchAndGain,
}

/// The computations that the next frames need. Multiplications by 1 and additions of 0 are left out where possible, which
/// changes no bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) moving: Moving,
    pub(super) driven: bool,
    /// Whether noise acts on `x` as well as on `y`.
    pub(super) turned_noise: bool,
    /// Whether the gains are not all 1.
    pub(super) stereo: bool,
    /// Number of modes, from the first, that may be ringing.
    pub(super) live: usize,
    /// Number of frames, at most [`CONTROL_FRAMES`].
    pub(super) frames: usize,
    /// Length of the ramp in frames, and the number of its frames that have been rendered before.
    pub(super) line: usize,
    pub(super) passed: usize,
}

/// Output of up to one control tick, left and right; the right side is written only in stereo.
pub(super) type Output = [[f32; CONTROL_FRAMES]; 2];
