//! The decay of a note's modes, and the damper.

use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::engine::controls::Controls;
use crate::engine::damping::Damping;
use crate::params::{NoteOff, Param};
use crate::patch::Mode;
use libm::pow;

/// The decay of a voice. Real-time safe.
pub(super) struct Decay {
    /// Tilt of the decay: the T60 of a mode of ratio r is multiplied by r^−tilt.
    tilt: f64,
    pub(super) damping: Damping,
    /// The patch lets notes ring on after their release: a release does not damp them.
    rings_on: bool,
    released: bool,
}

impl Decay {
    /// The decay of a voice before its first note.
    pub(super) fn new() -> Self {
        let damping = Damping { decay: 1.0, release: 1.0, amount: 0.0 };
        Self { tilt: 0.0, damping, rings_on: false, released: false }
    }

    /// Reads the decay and its tilt from the patch, as modulated at the strike.
    pub(super) fn read(&mut self, values: &StruckValues, controls: &Controls, bank: &mut Cells) {
        let tilt = values.moved(Param::DecayTilt, controls.decay_tilt);
        self.set_tilt(tilt, values.modes().as_slice(), bank);
        self.press(values.moved(Param::Decay, controls.decay));
    }

    /// Sets each mode's T60 as a multiple of the decay. With a positive tilt, higher modes decay faster.
    fn set_tilt(&mut self, tilt: f64, modes: &[Mode], bank: &mut Cells) {
        self.tilt = tilt;
        for (scale, mode) in bank.t60_scales_mut().zip(modes) {
            let tilted = if tilt == 0.0 { 1.0 } else { pow(mode.ratio.into(), -tilt) };
            *scale = f64::from(mode.decay) * tilted;
        }
    }

    /// The key was pressed: the note is not damped, and decays with a T60 in seconds.
    pub(super) fn press(&mut self, decay: f64) {
        self.damping = Damping { decay, release: 0.0, amount: 0.0 };
        self.released = false;
    }

    /// Reads from the patch whether the note rings on after its release.
    pub(super) fn strike(&mut self, values: &StruckValues) {
        self.rings_on = values.instrument.modulated.choice::<NoteOff>(Param::NoteOff) == NoteOff::Ring;
    }

    /// The key was released.
    pub(super) fn release(&mut self) {
        self.released = !self.rings_on;
    }

    /// Sets the T60s of the bank if they have changed. `modes` are the patch's, for a new tilt; none if the patch was
    /// replaced. Returns whether anything has changed.
    pub(super) fn control(&mut self, controls: &Controls, modes: Option<&[Mode]>, bank: &mut Cells) -> bool {
        let tilted = modes.filter(|_| controls.decay_tilt != self.tilt);
        tilted.into_iter().for_each(|modes| self.set_tilt(controls.decay_tilt, modes, bank));
        let amount = if self.released { 1.0 } else { controls.damper };
        let release = if amount == 0.0 { 0.0 } else { controls.release };
        let damping = Damping { decay: controls.decay, release, amount };
        let changes = tilted.is_some() || damping != self.damping;
        if changes {
            self.damping = damping;
            bank.damp(|scale| damping.t60(scale));
        }
        changes
    }
}
