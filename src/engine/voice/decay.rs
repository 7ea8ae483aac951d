//! How long the modes of a note ring: their decay and the damper.

use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::engine::controls::Controls;
use crate::engine::damping::Damping;
use crate::params::{NoteOff, Param};
use crate::patch::Mode;
use libm::pow;

/// The decay of a voice. Real-time safe.
pub(super) struct Decay {
    /// How higher modes decay faster.
    tilt: f64,
    pub(super) damping: Damping,
    /// A release changes nothing.
    rings_on: bool,
    released: bool,
    /// The bank has the decay of the last controls.
    settled: bool,
}

impl Decay {
    /// Of a voice that has had no note.
    pub(super) fn new() -> Self {
        let damping = Damping { decay: 1.0, release: 1.0, amount: 0.0 };
        Self { tilt: 0.0, damping, rings_on: false, released: false, settled: false }
    }

    /// Reads how the patch's modes ring.
    pub(super) fn read(&mut self, values: &StruckValues, controls: &Controls, bank: &mut Cells) {
        let tilt = values.moved(Param::DecayTilt, controls.decay_tilt);
        self.set_tilt(tilt, values.instrument.sound.patch().modes.as_slice(), bank);
        self.press(values.moved(Param::Decay, controls.decay));
    }

    /// Each mode's T60 as a multiple of the decay: the higher, the shorter.
    fn set_tilt(&mut self, tilt: f64, modes: &[Mode], bank: &mut Cells) {
        self.tilt = tilt;
        for (scale, mode) in bank.t60_scales_mut().zip(modes) {
            let tilted = if tilt == 0.0 { 1.0 } else { pow(mode.ratio.into(), -tilt) };
            *scale = f64::from(mode.decay) * tilted;
        }
    }

    /// A key goes down, with a T60 in seconds.
    pub(super) fn press(&mut self, decay: f64) {
        self.damping = Damping { decay, release: 0.0, amount: 0.0 };
        (self.released, self.settled) = (false, false);
    }

    /// Reads what a strike says of the release.
    pub(super) fn strike(&mut self, values: &StruckValues) {
        self.rings_on = values.instrument.modulated.choice::<NoteOff>(Param::NoteOff) == NoteOff::Ring;
    }

    /// The key comes up.
    pub(super) fn release(&mut self) {
        (self.released, self.settled) = (!self.rings_on, false);
    }

    /// The controls have moved since the bank was given their decay: the next control looks at them again.
    pub(super) fn unsettle(&mut self) {
        self.settled = false;
    }

    /// Sets the T60s of the bank if they have changed; `is_new` says whether the controls may have. A voice of the present
    /// patch has its `modes` to tilt anew. Returns whether anything has changed.
    pub(super) fn control(
        &mut self,
        controls: &Controls,
        is_new: bool,
        modes: Option<&[Mode]>,
        bank: &mut Cells,
    ) -> bool {
        if self.settled && !is_new {
            return false;
        }
        self.settled = true;
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
