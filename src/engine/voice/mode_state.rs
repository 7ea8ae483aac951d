//! The current state of a voice for displays, and that of its modes for labels.

use super::SynthVoice;
use crate::params::Param;

/// A mode of a sounding voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeState {
    /// Frequency at rest in Hz: without sweep, glide, vibrato, wheels and tension.
    pub frequency: f64,
    /// Present T60 in seconds, with damper and touch.
    pub t60: f64,
    /// Present amplitude at the voice's output, with the root mean square of both sides' gains: before the pan of single modes,
    /// effects, mix and limiter.
    pub amplitude: f64,
}

impl SynthVoice {
    /// The voice's index among the unison voices of its note.
    pub(crate) fn unison_index(&self) -> usize {
        self.unison.index
    }

    /// Seconds since its last strike.
    pub(crate) fn age(&self) -> f64 {
        self.clock.seconds(self.clock.age)
    }

    /// The current pitch in semitones on the MIDI scale, with all offsets.
    pub(crate) fn sounding_pitch(&self) -> f64 {
        self.pitch.sounding()
    }

    /// Calls `tell` with each parameter that the voice's routes or its own offsets modulate, and its current value. If both
    /// modulate a parameter, there are two calls; the value of the first, from the routes, includes the offset.
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
