//! What something hard or soft does to a sound where it hits it: three numbers, as a physics engine has them.

use super::Sound;
use crate::params::Param;
use libm::{pow, sqrt};

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// Contact lasts as the mass of the mallet to the first of these powers and as its speed to the second: Hertz's law, as
/// in Chaigne and Doutaut, "Numerical simulations of xylophones", J. Acoust. Soc. Am. 101 (1997).
const MASS_POWER: f64 = 0.4;
const SPEED_POWER: f64 = -0.2;
/// The slowest mallet: contact is at most four times that of full speed.
const LEAST_SPEED: f64 = 1e-3;

/// A hit by a body of the outer world, for [`EventKind::Strike`](crate::engine::EventKind::Strike). Made by
/// [`Sound::strike`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// 0–1: the area of the force, 1 being a strike of full velocity.
    pub(crate) impulse: f32,
    /// How long it touches, in seconds.
    pub(crate) seconds: f32,
    /// How far from its place the sound is hit, as a share of the body's length.
    pub(crate) place: f32,
}

impl Sound {
    /// The hit of another body on an object that makes this sound. Allocates nothing, so that it can be called wherever
    /// collisions are told of. Numbers out of range count as the nearest in it, NaN as 0.
    ///
    /// - `material`: how hard the other body is, from 0 (felt, flesh: in touch for 10 ms) to 1 (steel: 0.05 ms), at full
    ///   force and a [`Param::MalletMass`] of 1. Contact is shorter the harder the hit (Hertz).
    /// - `position`: where, from 0 (where the sound was made to be struck) to 1 (where a string or bar ends): modes are
    ///   weaker there as those of a string are off their crest, `cos(π/2 · position · ratio)`.
    /// - `impulse`: its impulse as a share of the hardest hit that the object is to sound like: what a physics engine says in
    ///   N s, divided by that of the hardest. Amplitude is proportional to it.
    ///
    /// An object keeps its key: hits while it rings add to what rings, in the phase that it has.
    ///
    /// ```
    /// use sprung::engine::{Event, EventKind, Synth};
    /// use sprung::preset::Preset;
    ///
    /// # fn main() -> sprung::Result<()> {
    /// // Once, for each object: a bottle.
    /// let bottle = Preset::find("Wine Glass")?;
    /// let (sound, mut synth) = (bottle.sound(), Synth::new(48_000.0, 0));
    /// synth.set_kit(&bottle.kit());
    ///
    /// // In the callback of the physics engine: a collision with stone, off the middle, of 0.02 N s where 0.1 is the most.
    /// let contact = sound.strike(0.8, 0.1, 0.02 / 0.1);
    /// let hit = Event { frame: 0, channel: 0, kind: EventKind::Strike { key: 72, contact } };
    ///
    /// // In the audio callback: 512 frames, with what has hit since the last ones.
    /// let (mut left, mut right) = ([0.0; 512], [0.0; 512]);
    /// synth.process(&[hit], &mut left, &mut right);
    /// assert!(left.iter().any(|sample| sample.abs() > 1e-3));
    /// # Ok(())
    /// # }
    /// ```
    pub fn strike(&self, material: f32, position: f32, impulse: f32) -> Contact {
        let [material, position, impulse] =
            [material, position, impulse].map(|number| if number.is_nan() { 0.0 } else { number.clamp(0.0, 1.0) });
        let mass = f64::from(self.patch().get(Param::MalletMass));
        let seconds = contact_time(material.into()) * hertz(mass, impulse.into(), 1.0);
        Contact { impulse, seconds: seconds as f32, place: 0.5 * position }
    }
}

/// How long a mallet of a hardness from 0 to 1 touches what it strikes, in seconds, at full speed and a mass of 1. Real-time
/// safe.
pub fn contact_time(hardness: f64) -> f64 {
    SOFTEST_CONTACT * pow(HARDEST_CONTACT / SOFTEST_CONTACT, hardness)
}

/// How much longer a mallet of a mass and a speed from 0 to 1 touches; `law` is how far the speed counts.
pub(crate) fn hertz(mass: f64, speed: f64, law: f64) -> f64 {
    let by_mass = if mass == 1.0 { 1.0 } else { pow(mass, MASS_POWER) };
    let by_speed = if law == 0.0 { 1.0 } else { pow(speed.max(LEAST_SPEED), SPEED_POWER * law) };
    by_mass * by_speed
}

/// The velocity whose square is an impulse.
pub(crate) fn velocity_of(impulse: f32) -> f32 {
    sqrt(f64::from(impulse)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    #[test]
    fn contact_follows_the_law_of_hertz() {
        let sound = |mass| Sound::new(Patch::default().with(Param::MalletMass, mass));
        let seconds = |mass, material, impulse| f64::from(sound(mass).strike(material, 0.0, impulse).seconds);
        assert!((seconds(1.0, 0.0, 1.0) / 0.01 - 1.0).abs() < 1e-6);
        assert!((seconds(1.0, 1.0, 1.0) / 0.000_05 - 1.0).abs() < 1e-6);
        // v^(−1/5) and m^(2/5).
        assert!((seconds(1.0, 0.5, 1.0 / 32.0) / seconds(1.0, 0.5, 1.0) - 2.0).abs() < 1e-5);
        assert!((seconds(4.0, 0.5, 1.0) / seconds(1.0, 0.5, 1.0) / 1.741_101 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn nonsense_counts_as_the_nearest_number() {
        let sound = Sound::new(Patch::default());
        assert_eq!(sound.strike(f32::NAN, -3.0, f32::INFINITY), sound.strike(0.0, 0.0, 1.0));
    }
}
