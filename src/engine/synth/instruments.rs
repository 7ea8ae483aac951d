//! The instruments of a kit, one for each sound, and their common parameters, host modulation and tuning.

use crate::engine::instrument::Instrument;
use crate::engine::modulation::modulated;
use crate::engine::note::Note;
use crate::engine::portamento::NoteGlide;
use crate::engine::voice::{SynthVoice, footprint};
use crate::engine::voice_manager::{Footprint, Voice};
use crate::params::{PARAM_COUNT, Param, Values};
use crate::sound::tuning::Pitch;
use crate::sound::{Kit, Sound, Tuning};
use crate::units::gain_from_db;
use std::sync::Arc;

/// Tempo before it is set, in beats per second: MIDI's 120 beats per minute.
pub(super) const DEFAULT_BEAT_RATE: f64 = 2.0;

/// The kit that a synth plays. Real-time safe once made, except where noted.
pub(super) struct Instruments {
    /// One for each sound of the kit. This field must be dropped before the kit, which also holds each sound.
    instruments: Vec<Instrument>,
    kit: Arc<Kit>,
    /// The parameters of the whole kit as they were set.
    values: Values,
    /// Offsets of the parameters by the host's modulation, in knob travel.
    offsets: [f32; PARAM_COUNT],
    /// Used for sounds without a tuning of their own.
    tuning: Tuning,
    sample_rate: f64,
    seed: u64,
    /// Serial number of the first instrument's patch; the others have the numbers after it.
    first_patch: u32,
    /// Number of bodies so far.
    bodies: u32,
}

impl Instruments {
    /// The instruments of a kit. Allocates.
    pub(super) fn new(sample_rate: f64, seed: u64, kit: Arc<Kit>) -> Self {
        let (rates, offsets) = ([sample_rate, DEFAULT_BEAT_RATE], [0.0; PARAM_COUNT]);
        let instrument = |sound: &Arc<Sound>| Instrument::new(sound.clone(), rates, seed, &offsets, 0);
        let mut instruments = Self {
            instruments: kit.sounds().iter().map(instrument).collect(),
            values: *kit.values(),
            kit,
            offsets,
            tuning: Tuning::EQUAL,
            sample_rate,
            seed,
            first_patch: 0,
            bodies: 0,
        };
        instruments.number();
        instruments
    }

    /// The same kit at another sample rate, with its parameters, tuning and reserved room. Allocates.
    pub(super) fn at_rate(&self, sample_rate: f64) -> Self {
        let mut other = Self::new(sample_rate, self.seed, self.kit.clone());
        (other.values, other.tuning) = (self.values, self.tuning);
        other.reserve(self.instruments.capacity());
        other.reset();
        other
    }

    /// Makes room for kits of up to `sounds` sounds. Allocates.
    pub(super) fn reserve(&mut self, sounds: usize) {
        self.instruments.reserve(sounds.saturating_sub(self.instruments.len()));
    }

    /// Resets modulation and tempo. The kit, its parameters and the tuning stay.
    pub(super) fn reset(&mut self) {
        self.offsets = [0.0; PARAM_COUNT];
        let rates = [self.sample_rate, DEFAULT_BEAT_RATE];
        for (instrument, sound) in self.instruments.iter_mut().zip(self.kit.sounds()) {
            *instrument = Instrument::new(sound.clone(), rates, self.seed, &self.offsets, 0);
            instrument.begin_at(value_of_sound(&self.kit, &self.values), &self.offsets);
        }
        (self.first_patch, self.bodies) = (0, 0);
        self.number();
    }

    /// Plays another kit from frame `clock` on. Real-time safe if there is room for its sounds and someone else holds
    /// the previous kit.
    pub(super) fn set_kit(&mut self, kit: &Arc<Kit>, clock: u64) {
        let (sounds, before) = (kit.sounds(), self.instruments.len());
        let keeps_last_pitch = kit.is_single() && self.kit.is_single();
        let rates = [self.sample_rate, self.instruments[0].beat_rate];
        self.instruments.truncate(sounds.len());
        for (instrument, sound) in self.instruments.iter_mut().zip(sounds) {
            instrument.play(sound, &self.offsets);
            instrument.last_pitch.take_if(|_| !keeps_last_pitch);
        }
        for sound in sounds.iter().skip(self.instruments.len()) {
            let instrument = Instrument::new(sound.clone(), rates, self.seed, &self.offsets, clock);
            self.instruments.push(instrument);
        }
        // Last, since the previous kit has to hold the sounds that were dropped above: nothing may be freed here.
        self.kit = kit.clone();
        self.values = *kit.values();
        self.first_patch = self.first_patch.wrapping_add(before as u32);
        self.number();
    }

    /// Gives each instrument new serial numbers, which the notes of its sound will carry.
    fn number(&mut self) {
        for (instrument, patch) in self.instruments.iter_mut().zip(0_u32..) {
            self.bodies = self.bodies.wrapping_add(1);
            (instrument.patch_serial, instrument.body_serial) = (self.first_patch.wrapping_add(patch), self.bodies);
        }
    }

    pub(super) fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    pub(super) fn set_seed(&mut self, seed: u64) {
        self.seed = seed;
        self.instruments.iter_mut().for_each(|instrument| instrument.seed = seed);
    }

    pub(super) fn set_tuning(&mut self, tuning: &Tuning) {
        self.tuning = *tuning;
    }

    /// Gives a key another pitch, from the next note on.
    pub(super) fn tune(&mut self, key: u8, pitch: Pitch) {
        self.tuning.set(key, pitch);
    }

    pub(super) fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    pub(super) fn kit(&self) -> &Arc<Kit> {
        &self.kit
    }

    /// The parameters of the kit as they were set.
    pub(super) fn values(&self) -> &Values {
        &self.values
    }

    /// The value of a kit's parameter, with the host's modulation.
    pub(super) fn modulated(&self, param: Param) -> f32 {
        modulated(&self.values, param, self.offsets[param as usize])
    }

    pub(super) fn first_patch(&self) -> u32 {
        self.first_patch
    }

    /// The first instrument, which is the only one if the kit has one sound.
    pub(super) fn first(&self) -> &Instrument {
        &self.instruments[0]
    }

    /// The instrument that a note was started with; none if its sound was replaced.
    pub(super) fn of_note(&self, note: &Note) -> Option<&Instrument> {
        self.instruments.get(note.patch.wrapping_sub(self.first_patch) as usize)
    }

    /// The instrument of a key's pad; none if the key is silent.
    pub(super) fn of_key(&self, key: u8) -> Option<&Instrument> {
        let (pad, ..) = self.kit.tuned_pad(key, &self.tuning)?;
        self.instruments.get(pad.sound)
    }

    /// Completes a note that starts at frame `clock` with the values of its pad and sound. Returns its instrument, with
    /// the parameters of this frame; none if the key is silent.
    pub(super) fn start(&mut self, note: &mut Note, clock: u64) -> Option<&mut Instrument> {
        let choke = self.modulated(Param::Choke);
        let (pad, pitch, detune) = self.kit.tuned_pad(note.key, &self.tuning)?;
        let instrument = self.instruments.get_mut(pad.sound)?;
        instrument.look_ahead(clock, 0);
        instrument.controls = instrument.next_controls;
        note.pitch = pitch;
        note.detune += detune;
        (note.patch, note.body) = (instrument.patch_serial, instrument.body_serial);
        note.choke = self.kit.choke(pad, choke);
        let pitch_of = |key| self.kit.tuned_pad(key, &self.tuning).map(|(_, pitch, detune)| (pitch, detune));
        note.glide = note.glide.filter(|_| self.kit.is_single()).map(|glide| NoteGlide {
            from: glide
                .from_key
                .and_then(pitch_of)
                .map(|(pitch, detune)| instrument.pitch(&Note { pitch, detune, ..*note })),
            ..glide
        });
        (note.gain, note.pan) = (gain_from_db(pad.gain_db.into()) as f32, pad.pan);
        Some(instrument)
    }

    /// Sets a parameter of the kit at frame `clock`.
    pub(super) fn set(&mut self, param: Param, value: f32, clock: u64) {
        self.values.set(param, value);
        self.update(param, clock);
    }

    /// Sets all parameters of the kit at once, without smoothing, at frame `clock`. Modulation stays.
    pub(super) fn set_values(&mut self, values: &Values, clock: u64) {
        self.values = *values;
        for instrument in &mut self.instruments {
            // Shared oscillators must first advance to this frame with the old rate.
            instrument.look_ahead(clock, 0);
            instrument.begin_at(value_of_sound(&self.kit, values), &self.offsets);
        }
        self.number();
    }

    /// The modulation offset of a kit's parameter in knob travel.
    pub(super) fn offset(&self, param: Param) -> f32 {
        self.offsets[param as usize]
    }

    /// Sets the modulation offset of a kit's parameter in knob travel, at frame `clock`.
    pub(super) fn modulate(&mut self, param: Param, offset: f32, clock: u64) {
        self.offsets[param as usize] = offset;
        self.update(param, clock);
    }

    /// Passes a parameter whose value or offset has changed on to the instruments.
    fn update(&mut self, param: Param, clock: u64) {
        let value_of_sound = value_of_sound(&self.kit, &self.values);
        for instrument in &mut self.instruments {
            let value = value_of_sound(param, instrument.sound.patch().get(param));
            let before = instrument.knobs.modulated(param);
            instrument.set(param, value, self.offsets[param as usize], clock);
            // A sounding voice cannot change these without a click, so later notes have new bodies and never share its
            // voice.
            if matches!(param, Param::Coefficients | Param::Width) && instrument.knobs.modulated(param) != before {
                self.bodies = self.bodies.wrapping_add(1);
                instrument.body_serial = self.bodies;
            }
        }
    }

    /// Changes the tempo at frame `clock`, in beats per second.
    pub(super) fn set_tempo(&mut self, beat_rate: f64, clock: u64) {
        self.instruments.iter_mut().for_each(|instrument| instrument.set_tempo(beat_rate, clock));
    }

    /// Computes at frame `clock` the values that voices use until the next control tick, `to_tick` frames later.
    pub(super) fn control(&mut self, clock: u64, to_tick: u32) {
        for instrument in &mut self.instruments {
            instrument.look_ahead(clock, to_tick);
        }
    }

    /// Advances parameter smoothing by `frames` frames.
    pub(super) fn advance(&mut self, frames: u32) {
        self.instruments.iter_mut().for_each(|instrument| instrument.knobs.advance(frames));
    }

    /// The most that a note of any sound of the kit takes from the pool.
    pub(super) fn footprint(&self) -> Footprint {
        self.instruments.iter().map(SynthVoice::footprint).fold(Footprint::NONE, Footprint::max)
    }

    /// The most that a note of any sound of another kit would take from the pool.
    pub(super) fn footprint_of(&self, kit: &Kit) -> Footprint {
        let offset = self.offsets[Param::Unison as usize];
        let footprints = kit.sounds().iter().map(|sound| {
            let patch = sound.patch();
            footprint(&patch.modes, modulated(&patch.values, Param::Unison, offset))
        });
        footprints.fold(Footprint::NONE, Footprint::max)
    }
}

/// Returns a function from a parameter and a sound's own value to the sound's value while the kit's parameters have
/// `values`. A single sound has the kit's value. With several sounds, each is as far from its own value, in knob
/// travel, as the kit's value is from the default.
fn value_of_sound<'a>(kit: &'a Kit, values: &'a Values) -> impl Fn(Param, f32) -> f32 + 'a {
    move |param, own| {
        let (info, value) = (param.info(), values.get(param));
        match kit.is_single() {
            true => value,
            false if param.is_of_kit() => own,
            false => info.moved(own, info.travel(value)),
        }
    }
}
