//! The decay of a note's modes, with the damper and a touch of the body.

use super::values::{StruckValues, ratios};
use crate::dsp::cells::Cells;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::series::{powers, sines};
use crate::engine::controls::Controls;
use crate::engine::damping::Damping;
use crate::params::{NoteOff, Param};
use crate::patch::ModeTable;

/// T60 in seconds under the firmest touch, for a mode whose motion is largest at the point of touch.
const FIRMEST_TOUCH: f64 = 0.02;

/// The decay of a voice. Real-time safe.
pub(super) struct Decay {
    /// Tilt of the decay: the T60 of a mode of ratio r is multiplied by r^−tilt.
    tilt: f64,
    pub(super) damping: Damping,
    /// The point of touch, as a fraction of the body's length, if the mode shapes there have been computed.
    place: Option<f64>,
    /// Whether the patch lets notes ring on after their release, undamped.
    rings_on: bool,
    released: bool,
    /// How far the damper has come down since the key went up, 0–1.
    fallen: f64,
}

impl Decay {
    /// The decay of a voice before its first note.
    pub(super) fn new() -> Self {
        let damping = Damping { decay: 1.0, release: 1.0, amount: 0.0, touch: 0.0 };
        Self { tilt: 0.0, damping, place: None, rings_on: false, released: false, fallen: 0.0 }
    }

    /// Reads decay, tilt and touch from the patch, as modulated at the strike.
    pub(super) fn read(&mut self, values: &StruckValues, controls: &Controls, bank: &mut Cells) {
        let tilt = values.moved(Param::DecayTilt, controls.decay_tilt);
        let modes = values.modes();
        self.set_tilt(tilt, modes, bank);
        let touch = touch_rate(0.01 * values.moved(Param::Touch, 100.0 * controls.touch));
        self.place = None;
        if touch > 0.0 {
            self.set_place(0.01 * values.moved(Param::TouchPosition, 100.0 * controls.touch_position), modes, bank);
        }
        self.press(values.moved(Param::Decay, controls.decay), touch);
    }

    /// Sets each mode's T60 as a multiple of the decay. With a positive tilt, higher modes decay faster.
    fn set_tilt(&mut self, tilt: f64, modes: &ModeTable, bank: &mut Cells) {
        self.tilt = tilt;
        let rows = modes.as_slice().chunks(MAX_MODES).zip(modes.octaves().chunks(MAX_MODES));
        for (scales, (modes, octaves)) in bank.t60_scales_mut().zip(rows) {
            if tilt == 0.0 {
                scales.fill(1.0);
            } else {
                powers(octaves, -tilt, scales);
            }
            scales.iter_mut().zip(modes).for_each(|(scale, mode)| *scale *= f64::from(mode.decay));
        }
    }

    /// Sets the squared mode shapes at a point, which is a fraction of the body's length. The shape is a standing wave, as for
    /// pluck and bow.
    fn set_place(&mut self, place: f64, modes: &ModeTable, bank: &mut Cells) {
        self.place = Some(place);
        for (touched, modes) in bank.touched_mut().zip(modes.as_slice().chunks(MAX_MODES)) {
            let mut shapes = [0.0; MAX_MODES];
            sines(&ratios(modes), place, 0.0, &mut shapes);
            touched.iter_mut().zip(shapes).for_each(|(touched, shape)| *touched = (shape * shape) as f32);
        }
    }

    /// Handles the press of a key: the note is not damped. `decay` is its T60 in seconds, `touch` as in [`Damping`].
    pub(super) fn press(&mut self, decay: f64, touch: f64) {
        self.damping = Damping { decay, release: 0.0, amount: 0.0, touch };
        (self.released, self.fallen) = (false, 0.0);
    }

    /// Reads from the patch whether the note rings on after its release.
    pub(super) fn strike(&mut self, values: &StruckValues) {
        self.rings_on = values.instrument.knobs.choice::<NoteOff>(Param::NoteOff) == NoteOff::Ring;
    }

    /// Handles the release of the note.
    pub(super) fn release(&mut self) {
        self.released = true;
    }

    /// Lets the damper down by a share 0–1. It does not rise again from what was released.
    pub(super) fn lower(&mut self, share: f64) {
        if !self.rings_on {
            self.fallen = if self.released { self.fallen.max(share) } else { share };
        }
    }

    /// Sets the T60s of the bank if they have changed. `modes` returns the patch's modes, or none if the patch was replaced; it
    /// is called only for a new tilt or a new point of touch. Returns whether anything has changed.
    pub(super) fn control<'a>(
        &mut self,
        controls: &Controls,
        modes: impl Fn() -> Option<&'a ModeTable>,
        bank: &mut Cells,
    ) -> bool {
        let tilted = if controls.decay_tilt == self.tilt { None } else { modes() };
        tilted.into_iter().for_each(|modes| self.set_tilt(controls.decay_tilt, modes, bank));
        let amount = self.fallen.max(controls.damper);
        let release = if amount == 0.0 { 0.0 } else { controls.release };
        let (mut touch, mut moved) = (0.0, None);
        if controls.touch > 0.0 {
            moved = if self.place == Some(controls.touch_position) { None } else { modes() };
            moved.into_iter().for_each(|modes| self.set_place(controls.touch_position, modes, bank));
            // If there is no place, the mode shapes are unknown.
            touch = self.place.map_or(0.0, |_| touch_rate(controls.touch));
        }
        let damping = Damping { decay: controls.decay, release, amount, touch };
        let changes = tilted.is_some() || moved.is_some() || damping != self.damping;
        if changes {
            self.damping = damping;
            bank.damp(|scale, touched| damping.t60(scale, touched));
        }
        changes
    }
}

/// The value of [`Damping::touch`] for a touch, 0–1. It grows with the square, for a finer control of light touches.
fn touch_rate(touch: f64) -> f64 {
    touch * touch / FIRMEST_TOUCH
}
