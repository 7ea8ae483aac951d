//! The modes of a voice as they are now, for labels.

use super::SynthVoice;

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
