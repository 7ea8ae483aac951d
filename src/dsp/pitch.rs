//! The movements of a voice's pitch over time: the sweep envelope and the glide.

use libm::exp;

/// A pitch sweep that starts some semitones away and reaches 0 after some time, as a function of time. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepEnvelope {
    semitones: f64,
    seconds: f64,
    steepness: f64,
    /// `e^−steepness`.
    end: f64,
}

impl SweepEnvelope {
    /// A sweep from `semitones` to 0 in `seconds`. `curve` is −1 to 1: 0 is a straight line; above 0 the sweep starts
    /// fast and ends slowly, below 0 the reverse.
    pub(crate) fn new(semitones: f64, seconds: f64, curve: f64) -> Self {
        let steepness = 8.0 * curve;
        Self { semitones, seconds, steepness, end: exp(-steepness) }
    }

    /// Semitones, `time` seconds after the start; exactly 0 from `seconds` on.
    pub(crate) fn at(&self, time: f64) -> f64 {
        if time >= self.seconds || self.semitones == 0.0 {
            return 0.0;
        }
        let progress = time / self.seconds;
        let k = self.steepness;
        let remaining = if k == 0.0 { 1.0 - progress } else { (exp(-k * progress) - self.end) / (1.0 - self.end) };
        self.semitones * remaining
    }
}

/// A glide in semitones at constant speed, as a function of time. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glide {
    from: f64,
    to: f64,
    seconds: f64,
}

impl Glide {
    /// A glide from `from` to `to` in `seconds`; 0 is a jump.
    pub(crate) fn new(from: f64, to: f64, seconds: f64) -> Self {
        Self { from, to, seconds }
    }

    /// Semitones, `time` seconds after the start.
    pub(crate) fn at(&self, time: f64) -> f64 {
        if time >= self.seconds { self.to } else { self.from + (self.to - self.from) * (time / self.seconds) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_start_at_their_depth_and_end_at_zero() {
        for curve in [-1.0, -0.3, 0.0, 0.5, 1.0] {
            let sweep = SweepEnvelope::new(24.0, 0.1, curve);
            assert!((sweep.at(0.0) - 24.0).abs() < 1e-12, "{curve}");
            assert!(sweep.at(0.0999).abs() < 0.5, "{curve}");
            assert_eq!(sweep.at(0.1), 0.0);
            let half = sweep.at(0.05) / 24.0;
            assert!(if curve > 0.0 {
                half < 0.4
            } else if curve < 0.0 {
                half > 0.6
            } else {
                (half - 0.5).abs() < 1e-12
            });
        }
    }

    #[test]
    fn glides_move_evenly_and_stay() {
        let glide = Glide::new(-12.0, 2.0, 0.5);
        assert_eq!([glide.at(0.0), glide.at(0.25), glide.at(0.5), glide.at(9.0)], [-12.0, -5.0, 2.0, 2.0]);
        assert_eq!(Glide::new(3.0, 5.0, 0.0).at(0.0), 5.0);
    }
}
