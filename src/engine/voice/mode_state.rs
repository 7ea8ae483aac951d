//! The state of a voice as it is now, for displays; and of its modes, for labels.

use super::SynthVoice;
use crate::params::Param;

/// A mode of a sounding voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeState {
    /// Hz, at rest: without what bends it for a while, as sweep, glide, vibrato, wheels and tension do.
    pub frequency: f64,
    /// Present T60 in seconds, with damper and touch.
    pub t60: f64,
    /// Present amplitude at the voice's output, the root mean square of both sides' gains: before pan of single modes,
    /// effects, mix and limiter.
    pub amplitude: f64,
}

impl SynthVoice {
    /// Which of its note's unison voices it is.
    pub(crate) fn unison_index(&self) -> usize {
        self.unison.index
    }

    /// Seconds since its last strike.
    pub(crate) fn age(&self) -> f64 {
        self.clock.seconds(self.clock.age)
    }

    /// Its pitch in semitones on the MIDI scale, with all that bends it.
    pub(crate) fn sounding_pitch(&self) -> f64 {
        self.pitch.sounding()
    }

    /// Calls `tell` with each parameter that its routes or its own offsets modulate, and the value now. One that both
    /// modulate is told twice: first as the routes have it, which includes the offset.
    pub(crate) fn each_moved(&self, mut tell: impl FnMut(Param, f32)) {
        self.modulators.each_value(&mut tell);
        self.modulation.each_value(tell);
    }

    /// Whether mallet, pluck or noise still act.
    pub(crate) fn is_being_struck(&self) -> bool {
        self.strike.is_active()
    }

    /// Its modes as they are now.
    pub(crate) fn mode_states(&self) -> impl Iterator<Item = ModeState> {
        let (frequency, damping) = (self.pitch.frequency(), self.decay.damping);
        let [left, right] = self.fader.now().map(f64::from);
        let power = 0.5 * (left * left + right * right);
        self.bank.modes().map(move |(ratio, scale, touched, energy)| ModeState {
            frequency: frequency * ratio,
            t60: damping.t60(scale, touched),
            amplitude: libm::sqrt(power * energy),
        })
    }
}
