//! How a voice takes notes: starts, strikes, slides, releases.

use super::SynthVoice;
use super::clock::Clock;
use super::energy::Energy;
use super::values::{StruckValues, strike_modulators};
use crate::dsp::bank::{Bank, Law};
use crate::dsp::mode_bank::ModeSetup;
use crate::engine::expression::Expressions;
use crate::engine::fader::Fader;
use crate::engine::gain::pan_gains;
use crate::engine::instrument::Instrument;
use crate::engine::modulation::NoteModulation;
use crate::engine::note::Note;
use crate::engine::voice_manager::Voice;
use crate::params::{Coefficients, Param};

/// The time in which a stolen or choked voice is faded out.
const FADE_SECONDS: f64 = 0.012;

impl SynthVoice {
    /// Strikes with what the patch says of it.
    fn excite(&mut self, instrument: &Instrument, note: &Note) {
        let values = StruckValues { instrument, modulators: &self.modulators };
        self.energy.expect(self.strike.strike(&values, note, &mut self.bank));
        self.energy.forget_end();
        self.pitch.strike(&values);
        self.decay.strike(&values);
    }

    /// The note that the voice had hands over to `note`, which is told what it is told anew. A gain that the last one
    /// was told fades to this one's.
    fn take_over(&mut self, note: &Note) {
        // A MIDI controller that has not let go of the key still presses it.
        let pressure = if note.key == self.key && note.id == -1 { self.expressions.pressure } else { 0.0 };
        self.expressions.begin(note.gain, note.pan);
        self.expressions.pressure = pressure;
        self.modulation.let_go();
        self.key = note.key;
        self.brightness = note.brightness.into();
    }
}

impl Voice for SynthVoice {
    type Context = Instrument;

    /// Only what the note before may have left is reset: a voice is too large to be made anew.
    fn start(&mut self, instrument: &Instrument, note: &Note) {
        self.clock = Clock::new(self.sample_rate);
        self.energy = Energy::NONE;
        self.fader = Fader::CLOSED;
        self.controls = instrument.controls;
        (self.key, self.brightness) = (note.key, note.brightness.into());
        self.expressions = Expressions::new(self.sample_rate);
        self.expressions.begin(note.gain, note.pan);
        if !self.modulation.is_none() {
            self.modulation = NoteModulation::NONE;
        }
        (self.let_go, self.fresh) = (None, true);
        self.modulators.load(&instrument.bus);
        if !self.modulators.are_idle() {
            strike_modulators(instrument, &mut self.modulators, note, true);
        }
        let values = StruckValues { instrument, modulators: &self.modulators };
        self.strike.start();
        self.pitch.read(&values);
        self.pitch.start(note, &self.controls, instrument.last_pitch);
        self.decay.read(&values, &self.controls);

        let law = match instrument.modulated.choice::<Coefficients>(Param::Coefficients) {
            Coefficients::Exact => Law::Exact,
            Coefficients::Classic => Law::Classic,
        };
        if !self.bank.is_of(law) {
            self.bank = Bank::of(law, self.sample_rate);
        }
        let (width, frequency) = (values.share(Param::Width), self.pitch.frequency());
        let tuning = self.pitch.ratios.iter().zip(self.decay.t60s());
        let setup = tuning.zip(instrument.sound.patch().modes.as_slice()).map(|((ratio, t60), mode)| {
            let (left, right) = pan_gains((f64::from(mode.pan) * width * 0.5 + 0.5) as f32);
            ModeSetup { frequency: frequency * ratio, t60, left, right }
        });
        self.bank.load(setup);
        self.excite(instrument, note);
    }

    fn restrike(&mut self, instrument: &Instrument, note: &Note) {
        let passed = self.clock.since_control();
        if !self.modulators.are_idle() {
            self.modulators.advance(passed);
            self.let_go = None;
            strike_modulators(instrument, &mut self.modulators, note, false);
        }
        self.retune(Some(instrument), note);
        self.excite(instrument, note);
        self.pitch.restart(self.controls.vibrato_rate, passed);
        self.clock.strike();
    }

    /// Slides from where the pitch is. Without an instrument, the voice goes by what it has read of its own.
    fn retune(&mut self, instrument: Option<&Instrument>, note: &Note) {
        self.take_over(note);
        self.energy.forget_end();
        instrument.into_iter().for_each(|instrument| self.follow(instrument));
        let modulators = &self.modulators;
        let values = instrument.map(|instrument| StruckValues { instrument, modulators });
        let controls = instrument.map_or(self.controls, |instrument| instrument.controls);
        self.pitch.slide(note, &controls, values.as_ref(), &self.clock);
        match &values {
            Some(values) => self.decay.read(values, &controls),
            None => self.decay.press(controls.decay),
        }
        self.modulators.set_pitch(self.pitch.note());
        let frequency = self.pitch.frequency();
        self.bank.retune(self.pitch.ratios.iter().map(|ratio| frequency * ratio).zip(self.decay.t60s()));
    }

    fn release(&mut self, velocity: f32) {
        self.let_go = Some(velocity);
        self.decay.release();
    }

    fn fade(&mut self) {
        self.fader.fade((FADE_SECONDS * self.sample_rate) as u32);
    }

    fn energy(&self) -> f64 {
        self.energy.rank(&self.fader)
    }

    fn is_over(&self) -> bool {
        self.energy.is_over(&self.bank, &self.fader)
    }
}
