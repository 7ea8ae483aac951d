//! A valve between a mouth and a tube: a reed that the breath closes, or lips that it opens.

use crate::dsp::random::uniform;
use libm::{cos, exp, sin, sqrt, sqrtf};
use std::f64::consts::TAU;

/// How far a valve opens at most, as a multiple of its opening at rest: a limit against absurd settings, five times what lips
/// do at full breath.
const WIDEST: f32 = 64.0;

/// The highest frequency of a valve, as a share of the sample rate.
const FASTEST: f64 = 0.4;

/// Above this frequency in Hz, turbulence falls by 6 dB an octave: white noise would make a hiss of the highest modes, which
/// recordings of winds do not have.
const EDDIES: f64 = 400.0;

/// What a valve is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveLaw {
    /// The valve's own frequency in Hz.
    pub frequency: f64,
    /// Its quality.
    pub quality: f64,
    /// How far a steady pressure difference of 1 moves it, as a multiple of its opening at rest: −1 for a reed, which it closes,
    /// positive for lips.
    pub reach: f64,
}

impl ValveLaw {
    /// The flow at a steady pressure difference, through a valve that lets a flow of `opening` through at a difference of 1 if it
    /// does not move.
    pub(crate) fn steady_flow(&self, opening: f64, difference: f64) -> f64 {
        opening * (1.0 + self.reach * difference).clamp(0.0, WIDEST.into()) * sqrt(difference.max(0.0))
    }
}

/// The breath of some frames, and the tube that it meets.
#[derive(Clone, Copy, Debug)]
pub struct Breath {
    /// Pressure in the mouth, `γ`, at the start of the ramp, and its change per frame.
    pub pressure: [f32; 2],
    /// Frames of the ramp that have passed.
    pub passed: u32,
    /// Turbulence: the deviation by chance of the pressure behind the flow, as a share of it.
    pub noise: f32,
    /// Flow at a difference of 1 through the valve at rest, `β`.
    pub opening: f32,
    /// The note's frequency over the sample rate, `q`.
    pub per_frame: f32,
    /// The sum of the modes' shares of the flow, `S`.
    pub shares: f32,
}

impl Breath {
    /// No breath, and no tube.
    pub const NONE: Self =
        Self { pressure: [0.0; 2], passed: 0, noise: 0.0, opening: 0.0, per_frame: 0.0, shares: 0.0 };
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
pub struct Valve {
    /// The breath that it meets in the next frames.
    pub breath: Breath,
    /// The stream of the turbulence.
    pub key: u64,
    drawn: u64,
    /// The turbulence now, how far it follows the random numbers in a frame, and the factor that makes its variance 1.
    eddy: f32,
    follow: f32,
    whole: f32,
    /// Place and velocity of the valve in the coordinates of a mode, as multiples of its opening at rest.
    x: f32,
    y: f32,
    turn: [f32; 2],
    /// Damping over angular frequency, and the velocity by coordinate for half a frame.
    lag: f32,
    ahead: [f32; 2],
    law: ValveLaw,
}

impl Valve {
    /// A valve at rest without breath.
    pub const REST: Self = Self {
        breath: Breath::NONE,
        key: 0,
        drawn: 0,
        eddy: 0.0,
        follow: 0.0,
        whole: 0.0,
        x: 0.0,
        y: 0.0,
        turn: [0.0; 2],
        lag: 0.0,
        ahead: [0.0; 2],
        law: ValveLaw { frequency: 0.0, quality: 1.0, reach: 0.0 },
    };

    /// Gives the valve a law. It goes on from where it is.
    pub fn set(&mut self, law: ValveLaw, sample_rate: f64) {
        if law == self.law {
            return;
        }
        let omega = TAU * law.frequency.min(FASTEST * sample_rate) / sample_rate;
        let damping = omega / (2.0 * law.quality);
        let angle = sqrt((omega * omega - damping * damping).max(1e-12));
        let radius = exp(-damping);
        self.turn = [(radius * cos(angle)) as f32, (radius * sin(angle)) as f32];
        self.lag = (damping / angle) as f32;
        self.ahead = [(-0.5 * damping) as f32, (0.5 * angle) as f32];
        self.law = law;
        let follow = 1.0 - exp(-TAU * EDDIES / sample_rate);
        // The numbers have a variance of 1/3.
        (self.follow, self.whole) = (follow as f32, sqrt(3.0 * (2.0 - follow) / follow) as f32);
    }

    /// The flow in the frame that is `frame` frames after the next one, times `q`, into a tube at pressure `p`.
    pub(crate) fn flow(&mut self, frame: usize, p: f32) -> f32 {
        let Breath { pressure, passed, noise, opening, per_frame, shares } = self.breath;
        let mut mouth = (pressure[0] + (passed as f32 + (frame + 1) as f32) * pressure[1]).max(0.0);
        if noise > 0.0 {
            self.eddy += self.follow * (uniform(self.key, self.drawn) - self.eddy);
            self.drawn += 1;
            mouth = (mouth * (1.0 + noise * self.whole * self.eddy)).max(0.0);
        }
        let place = self.x + (self.ahead[0] * self.x + self.ahead[1] * self.y);
        let gain = opening * (1.0 + place).clamp(0.0, WIDEST);
        let (left, half) = (mouth - p, 0.5 * shares * per_frame * gain);
        let root = 2.0 * left.abs() / (half + sqrtf(half * half + 4.0 * left.abs()) + f32::MIN_POSITIVE);
        // The place where this difference would hold the valve; in these coordinates, a place at rest has a `y` of its own.
        let (held, [cos, sin]) = (self.law.reach as f32 * (root * root).copysign(left), self.turn);
        let (x, y) = (self.x - held, self.y - self.lag * held);
        (self.x, self.y) = (cos * x + sin * y + held, cos * y - sin * x + self.lag * held);
        per_frame * gain * root.copysign(left)
    }
}
