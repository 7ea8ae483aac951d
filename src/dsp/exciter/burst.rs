//! A burst of noise: one hit or several, their envelope, and their colour.

use crate::dsp::coefficients::LN_MINUS_60_DB;
use crate::dsp::random::uniform;
use libm::{exp, pow, sqrt};
use std::f64::consts::TAU;

/// Range of the filter's corner frequency in Hz. The darkest colour is a low-pass at the lowest corner, and the brightest a
/// high-pass at the highest corner. Towards white, the corner moves to the other end.
const LOWEST_CORNER: f64 = 100.0;
const HIGHEST_CORNER: f64 = 16_000.0;

/// The form of a burst's decay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decay {
    /// As `(1−u)²`, to 0 at its end.
    Quadratic,
    /// Exponential, by 60 dB until its end.
    Exponential,
}

/// The parameters of a burst of noise.
#[derive(Clone, Copy, Debug)]
pub struct BurstSetup {
    /// Force of the strike that would give a mode the burst's expected energy, if the noise is white; 0 for no burst.
    pub force: f32,
    /// Decay time of a hit in frames.
    pub frames: u32,
    /// Attack time of a hit in frames, before the decay. The attack is linear.
    pub attack: u32,
    /// The form of the decay.
    pub decay: Decay,
    /// Number of hits, at least one. Each ends the previous one. All hits together have the energy of one.
    pub hits: u32,
    /// Frames between two hits.
    pub spacing: u32,
    /// From −1 (dark: the noise is low-passed by an over-damped mass) to 1 (bright: the noise minus the low-passed noise). 0 is
    /// white.
    pub colour: f64,
    /// The stream of random numbers.
    pub key: u64,
}

impl BurstSetup {
    /// No noise.
    pub const NONE: BurstSetup = BurstSetup {
        force: 0.0,
        frames: 0,
        attack: 0,
        decay: Decay::Quadratic,
        hits: 1,
        spacing: 0,
        colour: 0.0,
        key: 0,
    };

    /// Exponent of the exponential decay per frame, positive.
    fn rate(&self) -> f64 {
        -LN_MINUS_60_DB / f64::from(self.frames.max(1))
    }

    /// The sum of the squared envelope over the first `frames` frames of a hit.
    fn squares(&self, frames: u32) -> f64 {
        let (attack, frames) = (f64::from(self.attack), f64::from(frames.min(self.attack + self.frames)));
        if frames < attack {
            return frames * frames * frames / (3.0 * attack * attack);
        }
        let (falling, length) = (frames - attack, f64::from(self.frames.max(1)));
        let fallen = match self.decay {
            Decay::Quadratic => 0.2 * length * (1.0 - pow(1.0 - falling / length, 5.0)),
            Decay::Exponential => (1.0 - exp(-2.0 * self.rate() * falling)) / (2.0 * self.rate()),
        };
        attack / 3.0 + fallen
    }

    /// The expected energy of the burst at an envelope of 1: the noise has variance 1/3.
    fn energy(&self) -> f64 {
        if self.hits <= 1 && self.attack == 0 && self.decay == Decay::Quadratic {
            return f64::from(self.frames.max(1)) / 15.0;
        }
        let cut_off = f64::from(self.hits.max(1) - 1) * self.squares(self.spacing);
        (cut_off + self.squares(u32::MAX >> 1)) / 3.0
    }
}

/// A filter of noise: an over-damped mass that follows it. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Colour {
    colour: f64,
    /// Fraction of its distance from the noise that the mass moves in a frame, and its position.
    follow: f32,
    mass: f32,
}

impl Colour {
    /// No filter.
    pub(crate) const WHITE: Self = Self { colour: 0.0, follow: 1.0, mass: 0.0 };

    /// The filter of a [`BurstSetup::colour`].
    pub(crate) fn new(colour: f64, sample_rate: f64) -> Self {
        let share = if colour < 0.0 { 1.0 + colour } else { colour };
        let corner = LOWEST_CORNER * pow(HIGHEST_CORNER / LOWEST_CORNER, share);
        Self { colour, follow: (1.0 - exp(-TAU * corner / sample_rate)) as f32, mass: 0.0 }
    }

    /// The next frame of some noise.
    pub(crate) fn filter(&mut self, noise: f32) -> f32 {
        if self.colour == 0.0 {
            return noise;
        }
        self.mass += self.follow * (noise - self.mass);
        if self.colour < 0.0 { self.mass } else { noise - self.mass }
    }
}

/// A burst in progress. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Burst {
    setup: BurstSetup,
    frames: u32,
    scale: f32,
    /// Factor of the exponential envelope per frame, and its present value.
    keep: f32,
    level: f32,
    colour: Colour,
}

impl Burst {
    pub(super) const NONE: Burst =
        Burst { setup: BurstSetup::NONE, frames: 0, scale: 0.0, keep: 1.0, level: 1.0, colour: Colour::WHITE };

    pub(super) fn new(setup: BurstSetup, sample_rate: f64) -> Self {
        if setup.force <= 0.0 || setup.frames == 0 {
            return Self::NONE;
        }
        let spaced = (setup.hits.max(1) - 1).saturating_mul(setup.spacing);
        Self {
            frames: spaced.saturating_add(setup.attack).saturating_add(setup.frames),
            scale: (f64::from(setup.force) / sqrt(setup.energy())) as f32,
            keep: exp(-setup.rate()) as f32,
            level: 1.0,
            colour: Colour::new(setup.colour, sample_rate),
            setup,
        }
    }

    pub(super) fn frames(&self) -> u32 {
        self.frames
    }

    /// Adds the frames from `frame` on. Must be called with consecutive frames.
    pub(super) fn add_to(&mut self, frame: u32, force: &mut [f32]) {
        let left = self.frames.saturating_sub(frame) as usize;
        for (frame, force) in (frame..).zip(force.iter_mut().take(left)) {
            let noise = self.colour.filter(uniform(self.setup.key, u64::from(frame)));
            *force += noise * self.envelope(frame);
        }
    }

    /// The envelope at a frame, including the scale.
    fn envelope(&mut self, frame: u32) -> f32 {
        let BurstSetup { frames, attack, decay, hits, spacing, .. } = self.setup;
        let hit = if hits > 1 { frame.checked_div(spacing).unwrap_or(hits).min(hits - 1) } else { 0 };
        let frame = frame - hit * spacing;
        if frame < attack {
            return (frame as f32 + 0.5) / attack as f32 * self.scale;
        }
        match decay {
            _ if frame >= attack + frames => 0.0,
            Decay::Quadratic => {
                let envelope = 1.0 - (frame - attack) as f32 / frames as f32;
                envelope * envelope * self.scale
            }
            Decay::Exponential => {
                let level = if frame == attack { 1.0 } else { self.level };
                self.level = level * self.keep;
                level * self.scale
            }
        }
    }
}
