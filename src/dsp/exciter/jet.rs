//! The jet of a flute: a sheet of air that the sound bends, so that it blows into the tube or past its edge.

use super::breath::Breath;
use libm::{exp, sqrt, sqrtf};
use std::f64::consts::{SQRT_2, TAU};

/// How far the jet is bent at the edge by air that moves as fast as the jet, as a multiple of its half width. The waves of a
/// jet that is 1 mm thick grow by `e^1.6` on 4 mm from the lips to the edge, and its half width is 0.4 mm: that would be
/// twelve. Nine has the loudness of partials that recorded flutes have.
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
    /// How much of a jet blows into the tube, if it is bent at the edge by so many half widths: from 0 to 2, which is all of it.
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
/// The speed bends the jet where it leaves the lips. The bend grows as it travels, and comes to the edge late: four lags, each
/// a sixteenth of a turn late at [`JetLaw::frequency`], are its travel, and they take from fast bends as a jet does, which is
/// too wide to follow them. A jet of mouth pressure `γ` has the speed `√γ`, so it arrives bent by `η = 9 v/√γ − 0.3` half
/// widths, and `Q = γ (1 + η/√(1 + η²))` enters the tube. As that changes it pushes air before it, and turbulence by the share
/// `g` pushes too: the pressure is `D = 0.016 β (dQ/dt + 6 γ g)`, with time in periods of the note. (Verge, Hirschberg and
/// Caussé, "Sound production in recorderlike instruments. II", JASA 101, 1997; Auvray, Fabre and Lagrée, "Regime change and
/// oscillation thresholds in recorder-like instruments", JASA 131, 2012.)
///
/// Eddies at the edge take the pressure `2 v̄ |v̄|`, where `v̄ = v + S V/2` is the mean speed in the frame and `V = q (D − 2 v̄ |v̄|)`
/// what mode `m` gets `κ_m` times, as of a valve's flow. This makes one quadratic equation for `|v̄|` with one root that is not
/// negative. The energy `Σ v_m²/κ_m` changes by exactly `2 V v̄`, which is at most `0.55 q |D|^1.5`, however fast the
/// air moves: the more it swings, the less a jet of a given strength can add.
///
/// [`Valve`]: super::valve::Valve
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// The bend at four places on the way to the edge, as speeds of the air.
    bends: [f32; 4],
    /// How far each follows the one before in a frame.
    follow: f32,
    /// `Q` in the last frame, if there was one.
    last: Option<f32>,
}

impl Jet {
    /// No jet.
    pub(super) const REST: Self = Self { bends: [0.0; 4], follow: 0.0, last: None };

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
        let change = inside - self.last.replace(inside).unwrap_or(inside);
        let driven = PUSH * opening * (change + per_frame * ROUGH * mouth * gust);
        let half = 0.5 * shares;
        let free = v + half * driven;
        let mean = 2.0 * free / (1.0 + sqrtf(1.0 + 4.0 * half * per_frame * SHED * free.abs()));
        driven - per_frame * SHED * mean * mean.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::{key, uniform};

    /// In any frame, for any breath that comes and goes, any tube, rate and speed of the air, the tube gets no more than the
    /// pressure of the jet can give; and nothing once the breath is gone.
    #[test]
    fn a_jet_gives_no_more_than_its_pressure_can() {
        let mut gained = 0;
        for seed in 0..1000 {
            let mut drawn = 0;
            let mut decade = |from: f64, to: f64| {
                drawn += 1;
                let share = 0.5 + 0.5 * f64::from(uniform(key(81, seed), drawn));
                libm::pow(10.0, from + (to - from) * share) as f32
            };
            let (opening, per_frame, shares) = (decade(-2.0, 1.0), decade(-4.0, -0.7), decade(-2.0, 2.0));
            let breath = Breath { opening, per_frame, shares, ..Breath::NONE };
            let mut jet = Jet::REST.with(JetLaw { frequency: decade(1.0, 4.3).into() }, 48_000.0);
            for frame in 0..100 {
                let mouth = if frame < 80 { decade(-4.0, 1.0) } else { 0.0 };
                let (gust, v) = (decade(-3.0, 0.0) - 0.1, decade(-4.0, 1.0) * if frame % 3 == 0 { -1.0 } else { 1.0 });
                let before = jet.last;
                let force = f64::from(jet.pressure(&breath, [mouth, gust], v));
                let change = before.map_or(0.0, |before| f64::from(jet.last.unwrap()) - f64::from(before));
                let q = f64::from(per_frame);
                let driven = f64::from(PUSH * opening) * (change + q * f64::from(ROUGH * mouth * gust)) / q;
                let mean = f64::from(v) + 0.5 * f64::from(shares) * force;
                let most = 0.545 * q * libm::pow(driven.abs(), 1.5);
                // What rounding leaves of a change and of a speed that nearly stops.
                let rounding = 1e-5 * q * f64::from(v * v * v).abs() + 1e-6 * f64::from(mouth) * f64::from(v).abs();
                assert!(2.0 * force * mean <= most * (1.0 + 1e-3) + rounding, "{seed} {frame}: {force} {mean} {most}");
                gained += u32::from(force * mean > 0.0);
                assert!(frame <= 80 || force * mean <= 0.0, "{seed} {frame}: without breath the edge only takes");
            }
        }
        assert!(gained > 10_000, "{gained}");
    }
}
