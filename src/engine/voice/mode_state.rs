//! The current state of a voice for displays, and that of its modes for labels.

use super::SynthVoice;
use super::separation::{SeparateStrike, Separation};
use crate::dsp::cells::Cells;
use crate::engine::note::Note;
use crate::params::Param;
use crate::patch::routes::Source;

/// A mode of a sounding voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModeState {
    /// Frequency at rest in Hz: without sweep, glide, vibrato, wheels and tension.
    pub frequency: f64,
    /// Present T60 in seconds, with damper and touch.
    pub t60: f64,
    /// Present amplitude at the voice's output, with the root mean square of both sides' gains: before the pan of single modes,
    /// effects, mix and limiter.
    pub amplitude: f64,
}

/// A strike that overlaps with others, or was made while its voice rang.
pub(crate) struct StrikeState<'a> {
    voice: &'a SynthVoice,
    share: &'a SeparateStrike,
}

impl StrikeState<'_> {
    /// Its note.
    pub(crate) fn note(&self) -> &Note {
        &self.share.note
    }

    /// Whether its mallet, pluck or noise still act.
    pub(crate) fn is_acting(&self) -> bool {
        self.share.is_acting(&self.voice.strike)
    }

    /// The voice's modes, with the amplitudes that this strike alone has given them.
    pub(crate) fn modes(&self) -> impl Iterator<Item = ModeState> {
        self.voice.states_of(&self.share.modes)
    }
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

    /// The values of the sources of its routes, as of [`SoundingNote::sources`].
    pub(crate) fn sources(&self) -> [f32; Source::ALL.len()] {
        self.modulators.sources()
    }

    /// How far its oscillators and envelopes are, as of [`SoundingNote::progress`].
    pub(crate) fn progress(&self) -> [f32; 5] {
        self.modulators.progress()
    }

    /// Whether mallet, pluck or noise still act.
    pub(crate) fn is_being_struck(&self) -> bool {
        self.strike.is_active()
    }

    /// Its modes as they are now.
    pub(crate) fn mode_states(&self) -> impl Iterator<Item = ModeState> {
        self.states_of(&self.bank)
    }

    /// The voice's modes as they would be with the amplitudes of `modes`.
    fn states_of<'a>(&self, modes: &'a Cells) -> impl Iterator<Item = ModeState> + use<'a> {
        let (frequency, damping) = (self.pitch.frequency(), self.decay.damping);
        let [left, right] = self.fader.now().map(f64::from);
        let power = 0.5 * (left * left + right * right);
        modes.modes().map(move |(ratio, scale, touched, energy)| ModeState {
            frequency: frequency * ratio,
            t60: damping.t60(scale, touched),
            amplitude: libm::sqrt(power * energy),
        })
    }

    /// From now on, tells strikes apart. Then strikes on sounding notes allocate, and so does rendering while they act.
    pub(crate) fn separate_strikes(&mut self) {
        self.separation = Some(Box::new(Separation::NONE));
    }

    /// The strikes that have modes of their own, in their order.
    pub(crate) fn strikes(&self) -> impl Iterator<Item = StrikeState<'_>> {
        let shares = self.separation.iter().flat_map(|separation| &separation.strikes);
        shares.map(|share| StrikeState { voice: self, share })
    }

    /// Forgets the strikes that no longer act.
    pub(crate) fn forget_ended_strikes(&mut self) {
        let Self { separation, strike, .. } = self;
        separation.iter_mut().for_each(|separation| separation.strikes.retain(|share| share.is_acting(strike)));
    }
}
