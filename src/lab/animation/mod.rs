//! Animates the masses side by side with their phase planes, as SVG, HTML or GIF.

pub mod gif;
pub mod svg;

use super::comparison::Comparison;
use super::system::State;
use crate::error::{Error, Result};
use std::ops::Range;

/// Maximum number of frames of an animation.
pub(crate) const MOST_FRAMES: usize = 3000;

/// One mass.
pub struct Track {
    /// The name of the method, or of the true motion.
    pub title: &'static str,
    /// Index of its colour; `None` for the true motion.
    pub series: Option<usize>,
    /// State at each frame.
    pub frames: Vec<State>,
    /// States between the frames, for the phase plane.
    pub path: Vec<State>,
}

/// All masses; the true motion first.
pub struct Animation {
    /// The masses from top to bottom.
    pub tracks: Vec<Track>,
    /// Frames per second.
    pub rate: f64,
    /// Step in seconds.
    pub h: f64,
    /// Range of positions that fits on the page.
    pub x: Range<f64>,
    /// Range of velocities that fits on the page.
    pub v: Range<f64>,
}

impl Animation {
    /// Animates the first step size of a comparison at `rate` frames per second. Returns an error if the rate is not
    /// positive, and for more than `MOST_FRAMES`.
    pub fn new(comparison: &Comparison, rate: f64) -> Result<Self> {
        let end = comparison.setup.end;
        if !(rate > 0.0 && rate <= 50.0) {
            return Err(Error::value(
                "fps",
                format!("must be more than 0 and at most 50 frames per second, got {rate}"),
            ));
        }
        let count = (end * rate).round().max(2.0);
        if count > MOST_FRAMES as f64 {
            let message = format!("{end} s at {rate} frames per second are {count} frames; at most {MOST_FRAMES}");
            return Err(Error::value("end", message));
        }
        let times: Vec<f64> = (0..count as usize).map(|n| n as f64 / rate).collect();
        let track = |title, series, states: &[State], h: f64| {
            let frames = times.iter().map(|t| between(states, t / h)).collect();
            Track {
                title,
                series,
                frames,
                path: states.iter().step_by(states.len().div_ceil(MOST_FRAMES).max(1)).copied().collect(),
            }
        };
        let mut tracks = vec![track("truth", None, &comparison.truth, comparison.truth_step)];
        for (n, run) in comparison.runs.iter().filter_map(|runs| runs.first()).enumerate() {
            tracks.push(track(run.method.title(), Some(n), &run.states, run.h));
        }
        let range = |value: fn(&State) -> f64| {
            let values = comparison.truth.iter().map(value);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
            let margin = if high > low { 0.3 * (high - low) } else { 1.0 };
            low - margin..high + margin
        };
        let h = comparison.setup.steps.first().copied().unwrap_or_default();
        Ok(Self { tracks, rate, h, x: range(|state| state.x), v: range(|state| state.v) })
    }

    /// Number of frames of each track.
    pub fn len(&self) -> usize {
        self.tracks.first().map_or(0, |track| track.frames.len())
    }

    /// Whether there is nothing to show.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where a position lies between the edges of the page, from 0 to 1, and whether it is on the page at all.
    pub(crate) fn place(&self, x: f64) -> (f64, bool) {
        share(x, &self.x)
    }
}

/// Where a value lies in a range, from 0 to 1, and whether it is in the range at all.
fn share(value: f64, range: &Range<f64>) -> (f64, bool) {
    let share = (value - range.start) / (range.end - range.start);
    (share.clamp(0.0, 1.0), (0.0..=1.0).contains(&share))
}

/// The state at a fractional index, on the straight line between its neighbours; after the end, the last state.
fn between(states: &[State], place: f64) -> State {
    let n = place as usize;
    let (Some(a), Some(b)) = (states.get(n), states.get(n + 1)) else {
        return states.last().copied().unwrap_or_default();
    };
    let part = place - n as f64;
    State { x: a.x + part * (b.x - a.x), v: a.v + part * (b.v - a.v) }
}

/// The points of a spring's coils from 0 to `length`, around 0, with loops of size `size`.
fn coils(length: f64, size: f64) -> Vec<(f64, f64)> {
    const COILS: i32 = 14;
    let side = |n: i32| if n == 0 || n == COILS { 0.0 } else { size * f64::from(1 - 2 * (n % 2)) };
    (0..=COILS).map(|n| (length * f64::from(n) / f64::from(COILS), side(n))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::comparison::Setup;
    use crate::lab::method::Method;
    use crate::lab::system::System;

    pub(super) fn comparison() -> Comparison {
        let setup = Setup {
            system: System::linear(1.0, 50.0, 0.0).unwrap(),
            start: State { x: 0.5, v: 0.0 },
            end: 1.0,
            steps: vec![0.05],
            methods: vec![Method::ExplicitEuler, Method::SynthExact],
        };
        Comparison::new(setup).unwrap()
    }

    #[test]
    fn frames_follow_the_states() {
        let animation = Animation::new(&comparison(), 40.0).unwrap();
        assert_eq!((animation.tracks.len(), animation.len()), (3, 40));
        let exact = &animation.tracks[2];
        assert_eq!(exact.frames[2], exact.path[1]);
        assert!((exact.frames[1].x - 0.5 * (exact.path[0].x + exact.path[1].x)).abs() < 1e-15);
        assert_eq!(animation.place(9.0), (1.0, false));
        assert!(animation.place(0.5).1);
    }

    #[test]
    fn rates_that_cannot_be_are_errors() {
        for rate in [0.0, -1.0, f64::NAN, 1000.0] {
            assert!(Animation::new(&comparison(), rate).err().unwrap().to_string().starts_with("fps"));
        }
    }
}
