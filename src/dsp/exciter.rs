//! What moves the masses: a force pulse whose length is the mallet's hardness, and a burst of noise.

use super::CONTROL_FRAMES;
use super::random::uniform;

/// The force of one stretch of frames, of at most [`CONTROL_FRAMES`].
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// The mallet's pulse: sums to the force of the strike.
    pub pulse: [f32; CONTROL_FRAMES],
    /// The noise burst: its expected energy in a mode is that of a strike of the same force.
    pub noise: [f32; CONTROL_FRAMES],
}

impl Drive {
    /// No force.
    pub const NONE: Drive = Drive { pulse: [0.0; CONTROL_FRAMES], noise: [0.0; CONTROL_FRAMES] };
}

/// Strikes that are told apart while they overlap; one more takes the place of the oldest.
const OVERLAPPING: usize = 4;

/// The strikes in progress on one voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Exciter {
    blows: [Blow; OVERLAPPING],
    next: usize,
}

impl Exciter {
    /// An exciter at rest.
    pub const REST: Exciter = Exciter { blows: [Blow::REST; OVERLAPPING], next: 0 };

    /// Starts a strike, beside what may be left of those before.
    ///
    /// The pulse is the bell `u² (1−u)²` over `pulse_frames` (at least one), with the area `force`: like the raised
    /// cosine it is continuous in slope, so its spectrum falls by 18 dB per octave above `1/duration`, and it needs no
    /// transcendental function per sample. One frame is a bare impulse of exactly `force`. The burst is white noise
    /// (stream `noise_key`) under `(1−u)²` over `noise_frames`; `noise_force` 0 is none.
    pub fn strike(&mut self, force: f32, pulse_frames: u32, noise_force: f32, noise_frames: u32, noise_key: u64) {
        self.blows[self.next] = Blow::new(force, pulse_frames, noise_force, noise_frames, noise_key);
        self.next = (self.next + 1) % OVERLAPPING;
    }

    /// Whether any force is still to come.
    pub fn is_active(&self) -> bool {
        self.blows.iter().any(Blow::is_active)
    }

    /// Frames until it is not.
    pub fn frames_left(&self) -> u32 {
        self.blows.iter().map(Blow::frames_left).max().unwrap_or(0)
    }

    /// Writes the force of the next `frames` frames, at most [`CONTROL_FRAMES`], and moves on.
    pub fn fill(&mut self, frames: usize, drive: &mut Drive) {
        drive.pulse[..frames].fill(0.0);
        drive.noise[..frames].fill(0.0);
        for blow in self.blows.iter_mut().filter(|blow| blow.is_active()) {
            blow.add_to(frames, drive);
        }
    }
}

/// One strike: a pulse, a burst, or both.
#[derive(Clone, Copy, Debug)]
struct Blow {
    pulse_frames: u32,
    pulse_scale: f32,
    noise_frames: u32,
    noise_scale: f32,
    noise_key: u64,
    frame: u32,
}

impl Blow {
    const REST: Blow =
        Blow { pulse_frames: 0, pulse_scale: 0.0, noise_frames: 0, noise_scale: 0.0, noise_key: 0, frame: 0 };

    fn new(force: f32, pulse_frames: u32, noise_force: f32, noise_frames: u32, noise_key: u64) -> Self {
        let length = f64::from(pulse_frames.max(1));
        // Euler–Maclaurin: the midpoint sum of u²(1−u)² over L points is exactly L/30 + 7/(240 L³).
        let area = length * (1.0 / 30.0) + 7.0 / 240.0 / (length * length * length);
        // Σ (1−u)⁴ ≈ L/5 and the noise has variance 1/3.
        let noise_energy = f64::from(noise_frames.max(1)) / 15.0;
        Self {
            pulse_frames: pulse_frames.max(1),
            pulse_scale: (f64::from(force) / area) as f32,
            noise_frames: if noise_force > 0.0 { noise_frames } else { 0 },
            noise_scale: (f64::from(noise_force) / libm::sqrt(noise_energy)) as f32,
            noise_key,
            frame: 0,
        }
    }

    fn is_active(&self) -> bool {
        self.frames_left() > 0
    }

    fn frames_left(&self) -> u32 {
        self.pulse_frames.max(self.noise_frames).saturating_sub(self.frame)
    }

    fn add_to(&mut self, frames: usize, drive: &mut Drive) {
        for i in 0..frames {
            let frame = self.frame + i as u32;
            if frame < self.pulse_frames {
                let u = (frame as f32 + 0.5) / self.pulse_frames as f32;
                let bell = u * (1.0 - u);
                drive.pulse[i] += bell * bell * self.pulse_scale;
            }
            if frame < self.noise_frames {
                let envelope = 1.0 - frame as f32 / self.noise_frames as f32;
                drive.noise[i] += uniform(self.noise_key, u64::from(frame)) * (envelope * envelope * self.noise_scale);
            }
        }
        self.frame = self.frame.saturating_add(frames as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn collect(exciter: &mut Exciter) -> (Vec<f32>, Vec<f32>) {
        let (mut pulse, mut noise, mut drive) = (vec![], vec![], Drive::NONE);
        while exciter.is_active() {
            exciter.fill(7, &mut drive);
            pulse.extend_from_slice(&drive.pulse[..7]);
            noise.extend_from_slice(&drive.noise[..7]);
        }
        (pulse, noise)
    }

    #[test]
    fn a_pulse_of_any_length_has_the_area_of_its_force() {
        for frames in [1, 2, 3, 5, 48, 481, 7680] {
            let mut exciter = Exciter::REST;
            exciter.strike(0.7, frames, 0.0, 100, 1);
            let (pulse, noise) = collect(&mut exciter);
            let area: f64 = pulse.iter().map(|f| f64::from(*f)).sum();
            assert!((area / 0.7 - 1.0).abs() < 1e-6, "{frames}: {area}");
            assert!(noise.iter().all(|n| *n == 0.0));
        }
    }

    #[test]
    fn one_frame_is_exactly_the_force() {
        for force in [1.0, 0.25, 0.617] {
            let mut exciter = Exciter::REST;
            exciter.strike(force, 1, 0.0, 0, 0);
            assert_eq!(collect(&mut exciter).0[0], force);
        }
    }

    #[test]
    fn strikes_add_up_while_they_overlap() {
        let mut exciter = Exciter::REST;
        exciter.strike(0.5, 100, 0.0, 0, 0);
        exciter.fill(20, &mut Drive::NONE.clone());
        exciter.strike(0.25, 50, 0.0, 0, 0);
        let area: f32 = collect(&mut exciter).0.iter().sum();
        let mut first = Exciter::REST;
        first.strike(0.5, 100, 0.0, 0, 0);
        let before: f32 = collect(&mut first).0[..20].iter().sum();
        assert!((area + before - 0.75).abs() < 1e-6, "{area} {before}");
    }

    #[test]
    fn bursts_carry_the_energy_of_their_force_and_repeat_by_key() {
        let burst = |key| {
            let mut exciter = Exciter::REST;
            exciter.strike(0.0, 1, 0.5, 1000, key);
            collect(&mut exciter).1
        };
        let mean_energy: f64 =
            (0..200).map(|key| burst(key).iter().map(|n| f64::from(n * n)).sum::<f64>()).sum::<f64>() / 200.0;
        assert!((mean_energy / 0.25 - 1.0).abs() < 0.02, "{mean_energy}");
        assert_eq!(burst(3), burst(3));
        assert_ne!(burst(3), burst(4));
    }
}
