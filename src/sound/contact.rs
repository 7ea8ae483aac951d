//! The effect of a hit by another body on a sound, from three numbers that a physics engine provides.

use super::Sound;
use crate::params::Param;
use libm::{pow, sqrt};

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// The contact time is proportional to the mallet's mass to the first of these powers and to its speed to the second:
/// Hertz's law, as in Chaigne and Doutaut, "Numerical simulations of xylophones", J. Acoust. Soc. Am. 101 (1997).
const MASS_POWER: f64 = 0.4;
const SPEED_POWER: f64 = -0.2;
/// The lowest speed in Hertz's law: contact is at most four times as long as at full speed.
const LEAST_SPEED: f64 = 1e-3;

/// A hit by another body, for [`EventKind::Strike`](crate::engine::EventKind::Strike). Made by
/// [`Sound::strike`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// 0–1: the area of the force; 1 is a strike at full velocity.
    pub(crate) impulse: f32,
    /// Contact time in seconds.
    pub(crate) seconds: f32,
    /// Distance of the hit from the sound's own point of strike, as a fraction of the body's length.
    pub(crate) place: f32,
}

impl Sound {
    /// The hit of another body on an object that makes this sound. Allocates nothing, so it can be called in the collision
    /// callback of a physics engine. Numbers out of range are clamped; NaN counts as 0.
    ///
    /// - `material`: hardness of the other body, from 0 (felt, flesh: a contact of 10 ms) to 1 (steel: 0.05 ms), at full
    ///   force and a [`Param::MalletMass`] of 1. The harder the hit, the shorter the contact (Hertz).
    /// - `position`: point of the hit, from 0 (the point of strike for which the sound was made) to 1 (the end of a string or
    ///   bar). Modes are weaker away from 0, like those of a string around their maximum: `cos(π/2 · position · ratio)`.
    /// - `impulse`: impulse as a fraction of the hardest hit for this object: the impulse that a physics engine reports in N s,
    ///   divided by that of the hardest hit. The amplitude is proportional to it.
    ///
    /// An object keeps its key: a hit while it rings adds to the sound, with the present phase of each mode.
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

/// Contact time in seconds of a mallet with a hardness from 0 to 1, at full speed and a mass of 1. Real-time safe.
pub fn contact_time(hardness: f64) -> f64 {
    SOFTEST_CONTACT * pow(HARDEST_CONTACT / SOFTEST_CONTACT, hardness)
}

/// Factor of the contact time for a mallet's mass and its speed from 0 to 1. `law` is the influence of the speed, 0–1.
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
