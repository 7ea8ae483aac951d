//! A force pulse: a mallet's contact, or the release of a plucked string.

/// The bell `u² (1−u)²` over some frames, of a given area.
///
/// Like the raised cosine it is continuous in slope, so its spectrum falls by 18 dB per octave above `1/duration`. It needs
/// no transcendental function per sample. A pulse of one frame is an impulse of exactly the area. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulse {
    frames: u32,
    scale: f32,
}

impl Pulse {
    pub(super) const NONE: Pulse = Pulse { frames: 0, scale: 0.0 };

    /// A pulse of an area, over `frames` frames (at least one); no pulse if the area is 0.
    pub(super) fn new(area: f32, frames: u32) -> Self {
        if area == 0.0 {
            return Self::NONE;
        }
        let length = f64::from(frames.max(1));
        // Euler–Maclaurin: the midpoint sum of u²(1−u)² over L points is exactly L/30 + 7/(240 L³).
        let unit = length * (1.0 / 30.0) + 7.0 / 240.0 / (length * length * length);
        Self { frames: frames.max(1), scale: (f64::from(area) / unit) as f32 }
    }

    pub(super) fn frames(&self) -> u32 {
        self.frames
    }

    /// Adds the frames from `frame` on.
    pub(super) fn add_to(&self, frame: u32, force: &mut [f32]) {
        let left = self.frames.saturating_sub(frame) as usize;
        for (frame, force) in (frame..).zip(force.iter_mut().take(left)) {
            let u = (frame as f32 + 0.5) / self.frames as f32;
            let bell = u * (1.0 - u);
            *force += bell * bell * self.scale;
        }
    }
}
