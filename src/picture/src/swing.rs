//! The slow motion in which a body is seen to swing.

use crate::shape::BodyShape;
use emath::{Rect, Vec2};
use std::f32::consts::TAU;

/// Turns of the lowest mode in a second: the true motion is too fast to be seen.
const TURNS: f32 = 0.8;

/// The slow motion of a body's modes.
#[derive(Debug, Default)]
pub struct Swing {
    /// Phase of each mode, in radians.
    angles: Vec<f32>,
    /// The greatest amplitude since the body was at rest.
    greatest: f32,
}

impl Swing {
    /// Goes on by some seconds; without them, all modes stay at their greatest bend. Returns the displacement of each point in a picture
    /// of this size, in its unit, for the energies of the modes, which are squared amplitudes: each moves as far as it does in truth, as
    /// a share of the greatest since the body was at rest. Allocates.
    pub fn advance(&mut self, seconds: Option<f32>, shape: &BodyShape, energies: &[f32], rect: Rect) -> Vec<f32> {
        let amplitudes = self.amplitudes(seconds, shape, energies);
        let reach = shape.figure.form.reach(shape.place(rect));
        let soft = |value: f32| reach * value / (1.0 + value * value).sqrt();
        shape.displacements(&amplitudes).into_iter().map(soft).collect()
    }

    fn amplitudes(&mut self, seconds: Option<f32>, shape: &BodyShape, energies: &[f32]) -> Vec<f32> {
        let total = energies.iter().sum::<f32>().sqrt();
        if total <= 1e-6 {
            self.greatest = 0.0;
            self.angles.clear();
            return vec![0.0; shape.speeds.len()];
        }
        self.greatest = self.greatest.max(total);
        self.angles.resize(shape.speeds.len(), 0.0);
        for (angle, speed) in self.angles.iter_mut().zip(&shape.speeds) {
            *angle = seconds.map_or(TAU / 4.0, |seconds| (*angle + TAU * TURNS * seconds * speed) % TAU);
        }
        let share = |energy: &f32| energy.max(0.0).sqrt() / self.greatest;
        // The sine starts at 0: a strike starts from rest.
        self.angles.iter().zip(energies).map(|(angle, energy)| share(energy) * Vec2::angled(*angle).y).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use emath::{Pos2, vec2};
    use sprung::preset::Preset;

    #[test]
    fn without_time_a_body_stays_at_its_greatest_bend() {
        let preset = Preset::find("Gong").unwrap();
        let shape = BodyShape::of(&preset.patch.modes, preset.guide.family, &preset.tags);
        let (rect, energies) = (Rect::from_min_size(Pos2::ZERO, vec2(300.0, 200.0)), [0.5, 0.2, 0.1]);
        let (mut swing, mut still) = (Swing::default(), Swing::default());
        let bent = still.advance(None, &shape, &energies, rect);
        assert!(bent.iter().any(|moved| moved.abs() > 0.1));
        assert_eq!(still.advance(None, &shape, &energies, rect), bent);
        let moving = [0.1, 0.3].map(|seconds| swing.advance(Some(seconds), &shape, &energies, rect));
        assert_ne!(moving[0], moving[1]);
        assert!(still.advance(None, &shape, &[0.0; 3], rect).iter().all(|moved| *moved == 0.0));
    }
}
