//! The jet of a flute: a sheet of air that the sound bends, so that it blows into the tube or past its edge.

use super::breath::Breath;
use libm::{exp, sqrt, sqrtf};
use std::f64::consts::{SQRT_2, TAU};

/// How far the jet is bent at the edge by air that moves as fast as the jet, as a multiple of its half width. A jet of 1 mm grows
/// its waves by `e^1.6` over a lip's distance of 4 mm; that is twelve, with what the hole's sides hold back.
const GROWTH: f32 = 9.0;

/// How far the jet aims beside the edge, as a multiple of its half width. Without, there would be no even harmonics.
const ASIDE: f32 = 0.3;

/// The pressure that the jet gives as it swings, per opening: the air between mouth and edge that it has to push. From this on a
/// note speaks within 12 to 20 periods, as flutes do.
const PUSH: f32 = 0.016;

/// What turbulence gives, in that pressure, for a deviation of the mouth's pressure by 1: about the greatest `dQ/dt`, so that a
/// turbulence of 100 % is as strong as the tone. It acts at the edge and does not swing the jet, which would make it hiss.
const ROUGH: f32 = 6.0;

/// The pressure that is lost where the air of the tube sheds eddies at the edge, at a speed of 1 and per share of a mode
/// (Fabre, Hirschberg and Wijnands, "Vortex shedding in steady oscillation of a flue organ pipe", Acustica 82, 1996). It is
/// what limits the swing.
const SHED: f32 = 2.0;

/// What a jet is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JetLaw {
    /// The frequency in Hz at which its wave comes to the edge a quarter of a period late. There it drives a tube best.
    pub(crate) frequency: f64,
}

impl JetLaw {
    /// The share of a jet that blows into the tube, if it is bent at the edge by so many half widths: 0–2.
    pub(crate) fn into_tube(bend: f64) -> f64 {
        let bend = bend - f64::from(ASIDE);
        1.0 + bend / sqrt(1.0 + bend * bend)
    }
}

/// The jet of a voice. Real-time safe.
///
/// A tube that is open at its mouth has speeds there as a tube with a reed has pressures, so speed and pressure change places
/// against [`Valve`]: its modes' sum is the speed `v` of the air at the edge, and they get a pressure.
///
/// The speed bends the jet where it leaves the lips. The bend grows as it travels, and comes to the edge late: four lags, each an
/// sixteenth of a turn late at [`JetLaw::frequency`], are its travel, and they take from fast bends as a jet does, which is too
/// wide to follow them. A jet of mouth pressure `γ` has the speed `√γ`, so it arrives bent by `η = 9 v/√γ` half widths, of which the
/// share `1 + η/√(1 + η²)` enters the tube. As it swings it pushes air before it: the pressure is `D = 0.016 β γ dQ/dt`, in periods of the
/// note. (Verge, Hirschberg and Caussé, "Sound production in recorderlike instruments. II", JASA 101, 1997; Auvray, Fabre
/// and Lagrée, "Regime change and oscillation thresholds in recorder-like instruments", JASA 131, 2012.)
///
/// Eddies at the edge take the pressure `2 v̄ |v̄|`, where `v̄ = v + S V/2` is the mean speed in the frame and `V = q (D − 2 v̄ |v̄|)`
/// what mode `m` gets `κ_m` times, as of a valve's flow. This makes one quadratic equation for `|v̄|` with one root that is not
/// negative. The energy `Σ v_m²/κ_m` changes by exactly `2 V v̄`, which is at most `0.55 q |D|^1.5`: what the jet gives, however the air
/// moves, at any rate and for any settings (`mode_bank/played_tests` tries 10,000).
///
/// [`Valve`]: super::valve::Valve
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// The bend at four places on the way to the edge, as speeds of the air.
    bends: [f32; 4],
    /// How far each follows the one before in a frame.
    follow: f32,
    /// What blew into the tube in the last frame, times the pressure in the mouth.
    last: f32,
}

impl Jet {
    /// No jet.
    pub(super) const REST: Self = Self { bends: [0.0; 4], follow: 0.0, last: 0.0 };

    /// The jet with a law, from where it is.
    pub(super) fn with(self, law: JetLaw, sample_rate: f64) -> Self {
        /// The cotangent of an eighth of half a turn.
        const COTANGENT: f64 = 1.0 + SQRT_2;
        Self { follow: (1.0 - exp(-TAU * COTANGENT * law.frequency / sample_rate)) as f32, ..self }
    }

    /// The pressure in the next frame, times `q`, on the air of a tube that moves at speed `v` at its mouth, from the
    /// pressure in the mouth and the share by which turbulence deviates from it.
    pub(super) fn pressure(&mut self, breath: &Breath, [mouth, gust]: [f32; 2], v: f32) -> f32 {
        let Breath { opening, per_frame, shares, .. } = *breath;
        // The first place is passed on a frame late. That takes back what the others come early, since each follows the present
        // frame: so a note has the same pitch within two cents at 44.1 and at 192 kHz.
        let first = self.bends[0];
        self.bends[0] += self.follow * (v - first);
        let mut before = first;
        for bend in &mut self.bends[1..] {
            *bend += self.follow * (before - *bend);
            before = *bend;
        }
        let speed = sqrtf(mouth);
        let bend = GROWTH * before - ASIDE * speed;
        let inside = mouth * (1.0 + bend / (sqrtf(mouth + bend * bend) + f32::MIN_POSITIVE));
        let driven = PUSH * opening * (inside - self.last + per_frame * ROUGH * mouth * gust);
        self.last = inside;
        let half = 0.5 * shares;
        let free = v + half * driven;
        let mean = 2.0 * free / (1.0 + sqrtf(1.0 + 4.0 * half * per_frame * SHED * free.abs()));
        driven - per_frame * SHED * mean * mean.abs()
    }
}
