//! The notes of a voice: starts, strikes, glides and releases.

use super::SynthVoice;
use super::bloom::Bloom;
use super::clock::Clock;
use super::colour::Colour;
use super::drift::Drift;
use super::energy::Energy;
use super::pitch::Pitch;
use super::tension::Tension;
use super::values::{StruckValues, strike_modulators};
use crate::dsp::bank::Recurrence;
use crate::dsp::cells::Cell;
use crate::dsp::fader::Fader;
use crate::dsp::mode_bank::{MAX_MODES, ModeRows};
use crate::engine::expression::Expressions;
use crate::engine::gain::pan_gains;
use crate::engine::instrument::Instrument;
use crate::engine::modulation::NoteModulation;
use crate::engine::note::Note;
use crate::engine::voice_manager::{Footprint, Unison, Voice};
use crate::params::{Coefficients, Param};
use crate::patch::Mode;

/// Fade-out time of a stolen or choked voice.
const FADE_SECONDS: f64 = 0.012;

/// For this many seconds, a note that is played counts as loud as full scale where notes are stolen: it has yet to swing in.
const SWINGS_IN: f64 = 0.3;

impl SynthVoice {
    /// Strikes the modes with the patch's exciter.
    fn excite(&mut self, instrument: &Instrument, note: &Note) {
        let values = StruckValues { instrument, modulators: &self.modulators, table: self.table };
        let frequency = self.pitch.frequency();
        self.energy.expect(self.strike.strike(&values, note, frequency, self.unison, &mut self.bank));
        self.energy.forget_end();
        self.bloom.strike(self.strike.key());
        self.pitch.strike(&values);
        self.decay.strike(&values);
    }

    /// Replaces the voice's note by `note`: note expressions and offsets become neutral again. The gain changes smoothly.
    fn take_over(&mut self, note: &Note) {
        self.is_held = true;
        // If the same key is still down on a MIDI controller, its pressure continues.
        let pressure = if note.key == self.key && note.id.is_none() { self.expressions.pressure } else { 0.0 };
        self.expressions.begin(note.gain, note.pan);
        self.expressions.pressure = pressure;
        self.modulation.let_go();
        self.key = note.key;
        self.brightness = note.brightness.into();
    }

    /// Changes the sounding voice to `note`, with a glide from its present pitch. `is_legato` says that another key is
    /// down. `instrument` is none if the patch was replaced: the voice then uses its own copies of the patch's values.
    fn slide(&mut self, instrument: Option<&Instrument>, note: &Note, is_legato: bool) {
        self.take_over(note);
        self.energy.forget_end();
        instrument.into_iter().for_each(|instrument| self.follow(instrument));
        let from = self.pitch.now(&self.clock);
        let controls = instrument.map_or(self.controls, |instrument| instrument.controls);
        let Self { modulators, table, .. } = self;
        let mut values = instrument.map(|instrument| StruckValues { instrument, modulators, table: *table });
        values.iter().for_each(|values| self.pitch.read(values, self.unison));
        self.pitch.slide(from, note, &controls, is_legato, &self.clock);
        match &mut values {
            Some(values) => {
                *table = values.instrument.sound.patch().modes.place(self.pitch.frequency());
                values.table = *table;
                Pitch::set_ratios(values, &mut self.bank);
                self.colour.change_modes(values.get(Param::Stretch));
                self.decay.read(values, &controls, &mut self.bank);
                self.pitch.correct(values.instrument.sound.correction());
                self.strike.blowing.lift();
                self.strike.bowing.lift();
            }
            None => self.decay.press(controls.decay, self.decay.damping.touch),
        }
        self.modulators.set_pitch(self.pitch.note());
        let (frequency, damping) = (self.pitch.frequency(), self.decay.damping);
        self.bank.retune(|ratio, scale, touched| (frequency * ratio, damping.t60(scale, touched)));
        self.bloom.forget_bands();
    }
}

impl Voice for SynthVoice {
    type Context = Instrument;
    type Cell = Cell;

    fn footprint(instrument: &Instrument) -> Footprint {
        super::footprint(&instrument.sound.patch().modes, instrument.knobs.modulated(Param::Unison))
    }

    fn add_cell(&mut self, cell: Box<Cell>) {
        // The number of cells comes from `footprint`, so the bank has room for each.
        let surplus = self.bank.add(cell);
        debug_assert!(surplus.is_none());
    }

    fn take_cell(&mut self) -> Option<Box<Cell>> {
        self.bank.take()
    }

    /// Resets only what the last note may have changed, since a voice is too large to be built again.
    fn start(&mut self, instrument: &Instrument, note: &Note, unison: Unison) {
        self.unison = unison;
        self.clock = Clock::new(self.sample_rate);
        (self.energy, self.tension, self.bloom) = (Energy::NONE, Tension::NONE, Bloom::NONE);
        self.fader = Fader::closed();
        (self.controls, self.serial) = (instrument.controls, None);
        (self.key, self.brightness) = (note.key, note.brightness.into());
        self.expressions = Expressions::new(self.sample_rate);
        self.expressions.begin(note.gain, note.pan);
        if !self.modulation.is_none() {
            self.modulation = NoteModulation::NONE;
        }
        (self.let_go, self.fresh, self.is_held) = (None, true, true);
        self.may_move = [Param::Tension, Param::Bloom].iter().any(|param| instrument.bus.leads_to(*param));
        let driving = [Param::BowLevel, Param::NoiseHeld, Param::InputLevel];
        self.may_be_driven = driving.iter().any(|level| instrument.bus.leads_to(*level));
        self.modulators.load(&instrument.bus);
        if !self.modulators.are_idle() {
            strike_modulators(instrument, &mut self.modulators, note, true);
        }
        let mut values = StruckValues { instrument, modulators: &self.modulators, table: 0 };
        self.strike.start();
        self.pitch.read(&values, unison);
        self.pitch.start(note, &self.controls, instrument.last_pitch);
        self.pitch.correct(instrument.sound.correction());
        self.table = instrument.sound.patch().modes.place(self.pitch.frequency());
        values.table = self.table;
        Pitch::set_ratios(&values, &mut self.bank);
        self.colour = Colour::full(values.get(Param::Stretch));
        self.decay.read(&values, &self.controls, &mut self.bank);

        let recurrence = match instrument.knobs.choice::<Coefficients>(Param::Coefficients) {
            Coefficients::Exact => Recurrence::Exact,
            Coefficients::Classic => Recurrence::Classic,
        };
        let (width, spread) = (values.share(Param::Width), unison.position() * values.share(Param::UnisonSpread));
        let (frequency, damping) = (self.pitch.frequency(), self.decay.damping);
        let setup = |modes: &[Mode], [ratios, scales, touched]: [&[f64; MAX_MODES]; 3]| {
            let frequency = ratios.map(|ratio| frequency * ratio);
            let t60 = std::array::from_fn(|m| damping.t60(scales[m], touched[m]));
            let (mut left, mut right) = ([1.0; MAX_MODES], [1.0; MAX_MODES]);
            for (m, mode) in modes.iter().enumerate() {
                let pan = (f64::from(mode.pan) * width + spread).clamp(-1.0, 1.0);
                (left[m], right[m]) = pan_gains((pan * 0.5 + 0.5) as f32);
            }
            ModeRows { frequency, t60, left, right, len: modes.len() }
        };
        self.bank.load(recurrence, self.sample_rate, values.modes().as_slice(), setup);
        self.excite(instrument, note);
        self.drift = Drift::new(self.strike.key());
        self.separation.iter_mut().for_each(|separation| separation.begin(note));
    }

    fn restrike(&mut self, instrument: &Instrument, note: &Note) {
        self.separation.iter_mut().for_each(|separation| separation.separate(&self.strike, &self.bank));
        let passed = self.clock.since_control();
        if !self.modulators.are_idle() {
            self.modulators.advance(passed);
            self.let_go = None;
            strike_modulators(instrument, &mut self.modulators, note, false);
        }
        self.slide(Some(instrument), note, note.is_legato);
        self.excite(instrument, note);
        // In the frame of the first strike the modes have no pitch yet, and the hammer waits for it.
        if !self.fresh {
            self.begin_hammer(instrument);
        }
        self.separation.iter_mut().for_each(|separation| separation.add(note, &self.strike, &self.bank));
        self.pitch.restart(self.controls.vibrato_rate, passed);
        self.clock.strike();
    }

    fn retune(&mut self, instrument: Option<&Instrument>, note: &Note) {
        self.separation.iter_mut().for_each(|separation| separation.separate(&self.strike, &self.bank));
        self.slide(instrument, note, true);
    }

    fn damp(&mut self, share: f32) {
        self.decay.lower(share.into());
    }

    fn release(&mut self, velocity: f32) {
        (self.let_go, self.is_held) = (Some(velocity), false);
        self.decay.release();
    }

    fn fade(&mut self) {
        self.is_held = false;
        self.fader.fade((FADE_SECONDS * self.sample_rate) as u32);
    }

    fn energy(&self) -> f64 {
        let swings_in = self.is_played() && self.clock.seconds(self.clock.age) < SWINGS_IN;
        let least = if swings_in { 1.0 / self.unison.count as f64 } else { 0.0 };
        self.energy.rank(least, &self.fader)
    }

    fn is_over(&self) -> bool {
        self.fader.is_closed() || (!self.is_driven() && self.energy.is_over(&self.bank, &self.fader))
    }
}
