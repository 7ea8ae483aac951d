//! What lets breath into a tube: its turbulence, and the valve or the jet that it meets.

use super::breath::Breath;
use super::jet::{Jet, JetLaw};
use super::valve::{Valve, ValveLaw};
use crate::dsp::random::uniform;
use libm::{exp, sqrt};
use std::f64::consts::TAU;

/// Above this frequency in Hz, turbulence falls by 6 dB an octave: white noise would make a hiss of the highest modes, which
/// recordings of winds do not have.
const EDDIES: f64 = 400.0;

/// What a mouthpiece is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MouthpieceLaw {
    /// A reed, or lips.
    Valve(ValveLaw),
    /// The jet of a flute.
    Jet(JetLaw),
}

/// What of a mouthpiece moves.
#[derive(Clone, Copy, Debug)]
enum Part {
    Valve(Valve),
    Jet(Jet),
}

/// The mouthpiece of a voice: what the breath meets before the tube. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Mouthpiece {
    /// The breath that it meets in the next frames.
    pub(crate) breath: Breath,
    /// The stream of the turbulence.
    pub(crate) key: u64,
    drawn: u64,
    /// The turbulence now, how far it follows the random numbers in a frame, and the factor that makes its variance 1.
    eddy: f32,
    follow: f32,
    whole: f32,
    part: Part,
    law: Option<MouthpieceLaw>,
}

impl Mouthpiece {
    /// At rest, without breath.
    pub(crate) const REST: Self = Self {
        breath: Breath::NONE,
        key: 0,
        drawn: 0,
        eddy: 0.0,
        follow: 0.0,
        whole: 0.0,
        part: Part::Valve(Valve::REST),
        law: None,
    };

    /// Gives the mouthpiece a law. One of the same kind goes on from where it is.
    pub(crate) fn set(&mut self, law: MouthpieceLaw, sample_rate: f64) {
        if Some(law) == self.law {
            return;
        }
        self.part = match (self.part, law) {
            (Part::Valve(valve), MouthpieceLaw::Valve(law)) => Part::Valve(valve.with(law, sample_rate)),
            (Part::Jet(jet), MouthpieceLaw::Jet(law)) => Part::Jet(jet.with(law, sample_rate)),
            (_, MouthpieceLaw::Valve(law)) => Part::Valve(Valve::REST.with(law, sample_rate)),
            (_, MouthpieceLaw::Jet(law)) => Part::Jet(Jet::REST.with(law, sample_rate)),
        };
        self.law = Some(law);
        let follow = 1.0 - exp(-TAU * EDDIES / sample_rate);
        // The numbers have a variance of 1/3.
        (self.follow, self.whole) = (follow as f32, sqrt(3.0 * (2.0 - follow) / follow) as f32);
    }

    /// What the tube gets in the frame that is `frame` frames after the next one, times `q`: flow, if `motion` is the pressure
    /// behind a valve, or pressure, if it is the speed of the air at the edge of a jet.
    pub(crate) fn force_on(&mut self, frame: usize, motion: f32) -> f32 {
        let mouth = self.breath.at(frame);
        let mut gust = 0.0;
        if self.breath.noise > 0.0 {
            self.eddy += self.follow * (uniform(self.key, self.drawn) - self.eddy);
            self.drawn += 1;
            gust = self.breath.noise * self.whole * self.eddy;
        }
        match &mut self.part {
            Part::Valve(valve) => valve.flow(&self.breath, (mouth * (1.0 + gust)).max(0.0), motion),
            Part::Jet(jet) => jet.pressure(&self.breath, [mouth, gust], motion),
        }
    }
}
