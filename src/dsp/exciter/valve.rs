//! A valve between a mouth and a tube: a reed that the breath closes, or lips that it opens.

use super::breath::Breath;
use libm::{cos, exp, sin, sqrt, sqrtf};
use std::f64::consts::TAU;

/// How far a valve opens at most, as a multiple of its opening at rest: a limit against absurd settings, five times what lips
/// do at full breath.
const WIDEST: f32 = 64.0;

/// The highest frequency of a valve, as a share of the sample rate.
const FASTEST: f64 = 0.4;

/// What a valve is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveLaw {
    /// The valve's own frequency in Hz.
    pub(crate) frequency: f64,
    /// Its quality.
    pub(crate) quality: f64,
    /// How far a steady pressure difference of 1 moves it, as a multiple of its opening at rest: −1 for a reed, which it closes,
    /// positive for lips.
    pub(crate) reach: f64,
}

impl ValveLaw {
    /// The flow at a steady pressure difference, through a valve that lets a flow of `opening` through at a difference of 1 if it
    /// does not move.
    pub(crate) fn steady_flow(&self, opening: f64, difference: f64) -> f64 {
        opening * (1.0 + self.reach * difference).clamp(0.0, WIDEST.into()) * sqrt(difference.max(0.0))
    }
}

/// The valve of a voice: a mass on a spring that the breath moves, and the flow that it lets through. Real-time safe.
///
/// Pressures are multiples of the one that closes a reed. The flow through the opening `h` follows Bernoulli's law, `U = β h
/// √|Δ|` in the direction of the difference `Δ = γ − p̄` between mouth and tube. It enters the tube at once: mode `m` gets
/// `κ_m V`, where `V = U q` and `q` is the note's frequency over the sample rate. So the tube's pressure rises by `S V`, where
/// `S` is the sum of all `κ_m`, and `p̄ = p + S V/2` is its mean while it does. This makes one quadratic equation for `√|Δ|`,
/// with one root that is not negative: no iteration.
///
/// The tube's energy `Σ p_m²/κ_m` changes by exactly `2 V p̄`. If `p̄` is above `γ`, air flows out, and if it is below 0, air
/// flows in against it: both only take energy. So a frame adds at most `2 q β h √(γ − p̄) p̄ ≤ 0.77 q β h γ^1.5`, the work of the
/// mouth, at any rate and for any settings (`mode_bank/played_tests` tries 10,000).
///
/// The valve turns exactly, as a mode does, about the place where the present difference would hold it. The flow uses its place
/// half a frame ahead: with that, a note has the same pitch within a cent at 44.1 and at 192 kHz. That the moving valve itself
/// pumps air is left out.
///
/// The model is that of McIntyre, Schumacher and Woodhouse, "On the oscillations of musical instruments", JASA 74 (1983), with
/// a valve that has a mass (Fletcher, "Autonomous vibration of simple pressure-controlled valves in gas flows", JASA 93,
/// 1993), and with the tube as a sum of modes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Valve {
    /// Place and velocity of the valve in the coordinates of a mode, as multiples of its opening at rest.
    x: f32,
    y: f32,
    turn: [f32; 2],
    /// Damping over angular frequency, and the velocity by coordinate for half a frame.
    lag: f32,
    ahead: [f32; 2],
    reach: f32,
}

impl Valve {
    /// A valve at rest without breath.
    pub(super) const REST: Self = Self { x: 0.0, y: 0.0, turn: [0.0; 2], lag: 0.0, ahead: [0.0; 2], reach: 0.0 };

    /// The valve with a law, from where it is.
    pub(super) fn with(self, law: ValveLaw, sample_rate: f64) -> Self {
        let omega = TAU * law.frequency.min(FASTEST * sample_rate) / sample_rate;
        let damping = omega / (2.0 * law.quality);
        let angle = sqrt((omega * omega - damping * damping).max(1e-12));
        let radius = exp(-damping);
        Self {
            turn: [(radius * cos(angle)) as f32, (radius * sin(angle)) as f32],
            lag: (damping / angle) as f32,
            ahead: [(-0.5 * damping) as f32, (0.5 * angle) as f32],
            reach: law.reach as f32,
            ..self
        }
    }

    /// The flow in the next frame, times `q`, from a mouth into a tube at pressure `p`.
    pub(super) fn flow(&mut self, breath: &Breath, mouth: f32, p: f32) -> f32 {
        let Breath { opening, per_frame, shares, .. } = *breath;
        let place = self.x + (self.ahead[0] * self.x + self.ahead[1] * self.y);
        let gain = opening * (1.0 + place).clamp(0.0, WIDEST);
        let (left, half) = (mouth - p, 0.5 * shares * per_frame * gain);
        let root = 2.0 * left.abs() / (half + sqrtf(half * half + 4.0 * left.abs()) + f32::MIN_POSITIVE);
        // The place where this difference would hold the valve; in these coordinates, a place at rest has a `y` of its own.
        let (held, [cos, sin]) = (self.reach * (root * root).copysign(left), self.turn);
        let (x, y) = (self.x - held, self.y - self.lag * held);
        (self.x, self.y) = (cos * x + sin * y + held, cos * y - sin * x + self.lag * held);
        per_frame * gain * root.copysign(left)
    }
}
