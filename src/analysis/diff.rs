//! Finds where two renders first differ, and by how much.

use super::level::dbfs;
use crate::text::counted;
use libm::sqrt;

/// The difference between two renders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// First frame whose bits differ in any channel, or the end of the shorter render if only the lengths differ.
    pub first_frame: usize,
    /// Frame of the largest difference.
    pub worst_frame: usize,
    /// Largest difference, in dBFS; the shorter render is continued with silence.
    pub worst_dbfs: f64,
    /// Root of the mean square of the difference over the longer render and all channels, in dBFS.
    pub rms_dbfs: f64,
    /// Frames of the expected and of the actual render.
    pub frames: [usize; 2],
}

/// Compares two renders bit by bit, channel by channel; `None` if they are the same. A channel that only one of them has
/// is compared with silence.
pub fn compare<E: AsRef<[f32]>, A: AsRef<[f32]>>(expected: &[E], actual: &[A]) -> Option<Difference> {
    let length = |len: usize, most: usize| most.max(len);
    let frames = [
        expected.iter().map(|channel| channel.as_ref().len()).fold(0, length),
        actual.iter().map(|channel| channel.as_ref().len()).fold(0, length),
    ];
    let channels = expected.len().max(actual.len());
    let mut first_frame = None;
    let (mut worst, mut energy) = ((0.0, 0), 0.0);
    for frame in 0..frames[0].max(frames[1]) {
        for channel in 0..channels {
            let pair = (
                expected.get(channel).and_then(|channel| channel.as_ref().get(frame)),
                actual.get(channel).and_then(|channel| channel.as_ref().get(frame)),
            );
            if pair.0.map(|sample| sample.to_bits()) == pair.1.map(|sample| sample.to_bits()) {
                continue;
            }
            first_frame.get_or_insert(frame);
            let value = |sample: Option<&f32>| f64::from(sample.copied().unwrap_or(0.0));
            let error = (value(pair.1) - value(pair.0)).abs();
            // A difference to NaN counts as infinite.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            energy += error * error;
            if error > worst.0 {
                worst = (error, frame);
            }
        }
    }
    let first_frame = first_frame?;
    let worst_frame = if worst.0 > 0.0 { worst.1 } else { first_frame };
    let rms = sqrt(energy / (frames[0].max(frames[1]) * channels) as f64);
    Some(Difference { first_frame, worst_frame, worst_dbfs: dbfs(worst.0), rms_dbfs: dbfs(rms), frames })
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { first_frame, worst_frame, worst_dbfs, rms_dbfs, frames: [expected, actual] } = self;
        write!(
            f,
            "first differing frame {first_frame}, worst error {worst_dbfs:.1} dBFS at frame {worst_frame}, \
             RMS error {rms_dbfs:.1} dBFS"
        )?;
        if expected != actual {
            write!(f, ", {} in place of {expected}", counted(*actual, "frame"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_found_where_they_are() {
        let (zeros, mut other) = ([0.0; 10], [0.0; 10]);
        assert_eq!(compare(&[zeros, zeros], &[other, other]), None);
        other[3] = 0.001;
        other[7] = -0.1;
        let found = compare(&[zeros, zeros], &[zeros, other]).unwrap();
        assert_eq!((found.first_frame, found.worst_frame), (3, 7));
        assert!((found.worst_dbfs + 20.0).abs() < 1e-6);
        // One sample in twenty of 0.1.
        assert!((found.rms_dbfs + 33.01).abs() < 0.01, "{found}");
    }

    #[test]
    fn length_sign_of_zero_and_nan_count() {
        let short = compare(&[[0.5; 4], [0.5; 4]], &[[0.5; 2], [0.5; 2]]).unwrap();
        assert_eq!((short.first_frame, short.frames), (2, [4, 2]));
        assert!(compare(&[[0.0], [0.0]], &[[-0.0], [0.0]]).is_some());
        assert_eq!(compare(&[[0.0], [0.0]], &[[f32::NAN], [0.0]]).unwrap().worst_dbfs, f64::INFINITY);
        assert_eq!(compare(&[[f32::NAN], [0.0]], &[[f32::NAN], [0.0]]), None);
        assert_eq!(compare(&[[0.5; 4]], &[[0.5; 4], [0.1; 4]]).unwrap().first_frame, 0);
    }
}
