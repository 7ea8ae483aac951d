//! The bow of a voice: its speed and force, updated at each control tick.

use super::line::Line;
use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::Bow;
use crate::engine::controls::Controls;
use crate::params::Param;
use libm::{fabs, sin, sqrt};
use std::f64::consts::{PI, TAU};

/// Friction at full bow pressure, as a multiple of the friction that brings a mass to the bow's speed within one radian of
/// the note's cycle, so that the same pressure suits low and high notes. It is limited to the friction that does so within
/// one frame.
const MOST_PRESSURE: f64 = 4.0;

/// The bow of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bowing {
    /// Bow speed from the strike's velocity, at a level of 0 dB; and how gradually friction falls with slip.
    speed: f64,
    width: f32,
    /// Whether the modes have their bow weights.
    is_placed: bool,
    bow_speed: Line,
    bow_force: Line,
}

impl Bowing {
    /// No bow.
    pub(super) const OFF: Self =
        Self { speed: 0.0, width: 1.0, is_placed: false, bow_speed: Line::ZERO, bow_force: Line::ZERO };

    /// Reads the bow's parameters at a strike. `speed` follows from the velocity.
    pub(super) fn strike(&mut self, values: &StruckValues, speed: f64) {
        (self.speed, self.width, self.is_placed) = (speed, values.share(Param::BowSlip) as f32, false);
    }

    /// The modes have got other contacts: they need the bow's weights again.
    pub(super) fn lift(&mut self) {
        self.is_placed = false;
    }

    /// Whether the bow moves or is about to.
    pub(super) fn is_on(&self) -> bool {
        !self.bow_speed.is_zero()
    }

    /// Starts ramps of speed and force that end in `frames` frames. `note` returns the note's frequency and the sample rate in
    /// Hz; it is called only if the bow is on. Without `values`, a bow that has no weights does not start, or ends. While breath has the modes'
    /// contacts (`is_blown`), the bow only moves. Returns whether the modes have got its weights.
    pub(super) fn control(
        &mut self,
        controls: &Controls,
        [is_held, is_blown]: [bool; 2],
        values: Option<&StruckValues>,
        note: impl FnOnce() -> [f64; 2],
        bank: &mut Cells,
        frames: usize,
    ) -> bool {
        let wanted = if is_held { f64::from(controls.bow_speed) * self.speed } else { 0.0 };
        if wanted == 0.0 && !self.is_on() {
            return false;
        }
        let places = !self.is_placed && !is_blown;
        if places {
            let Some(values) = values else {
                // Its sound is gone, and nobody would end its ramps.
                (self.bow_speed, self.bow_force) = (Line::ZERO, Line::ZERO);
                return false;
            };
            self.place(values, bank);
        }
        let (pressure, [frequency, sample_rate]) = (f64::from(controls.bow_force), note());
        let force = wanted * (MOST_PRESSURE * pressure * pressure * TAU * frequency / sample_rate).min(1.0);
        self.bow_speed.aim(wanted as f32, frames);
        self.bow_force.aim(force as f32, frames);
        places
    }

    /// Sets the modes' weights at the point of the bow.
    fn place(&mut self, values: &StruckValues, bank: &mut Cells) {
        self.is_placed = true;
        let modes = values.modes().as_slice();
        let place = values.share(Param::BowPosition);
        let [mut weights, ..] = values.tilted_levels();
        for (weight, mode) in weights.iter_mut().zip(modes) {
            *weight = fabs(*weight) * sin(PI * place * f64::from(mode.ratio));
        }
        // The squares of the weights that are played add up to 1.
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let scale = if squares > 0.0 { 1.0 / sqrt(squares) } else { 0.0 };
        bank.set_contacts(|m| [(weights[m] * scale) as f32; 2]);
    }

    /// The bow of the next frames, if it is on.
    pub(super) fn stroke(&mut self, frames: usize) -> Option<Bow> {
        if !self.is_on() {
            return None;
        }
        let ((speed, passed), (force, _)) = (self.bow_speed.parts(), self.bow_force.parts());
        self.bow_speed.advance(frames);
        self.bow_force.advance(frames);
        Some(Bow { speed, force, passed, width: self.width })
    }
}
