//! The host's parameters, made from the engine's table, and what a project keeps besides them.

#![allow(unsafe_code, reason = "the wrapper takes parameters as pointers and has no safe way to set several at once")]

use crate::slate::{Loaded, Slate};
use crate::state::{self, About, State};
use nice_plug::prelude::*;
use nice_plug_core::params::InternalParamMut;
use sprung::params::{Change, PARAM_COUNT, PARAMS, ParamInfo, Unit};
use std::array::from_fn;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A host's parameter.
pub(crate) enum Knob {
    /// The knob's position, 0–1: the wrapper's own curves would not give the engine's values.
    Continuous(FloatParam),
    /// A count, or the number of a choice.
    Stepped(IntParam),
}

impl Knob {
    fn new(info: &'static ParamInfo) -> Self {
        let smoothed = matches!(info.change, Change::Smoothed(_));
        if matches!(info.unit, Unit::Count | Unit::Choice) {
            let range = IntRange::Linear { min: info.min as i32, max: info.max as i32 };
            let knob = IntParam::new(info.name, info.default as i32, range)
                .with_value_to_string(Arc::new(|value| info.format(value as f32)))
                .with_string_to_value(Arc::new(|text| Some(info.parse(text).ok()? as i32)));
            return Self::Stepped(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob });
        }
        let knob =
            FloatParam::new(info.name, info.normalise(info.default) as f32, FloatRange::Linear { min: 0.0, max: 1.0 })
                .with_value_to_string(Arc::new(|position| info.format(info.denormalise(f64::from(position)))))
                .with_string_to_value(Arc::new(|text| Some(info.normalise(info.parse(text).ok()?) as f32)));
        Self::Continuous(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob })
    }

    /// How far the knob is turned, 0–1, without modulation. Real-time safe.
    pub(crate) fn position(&self) -> f32 {
        match self {
            Self::Continuous(knob) => knob.unmodulated_normalized_value(),
            Self::Stepped(knob) => knob.unmodulated_normalized_value(),
        }
    }

    /// How far modulation of the whole instrument turns it beyond that. Real-time safe.
    pub(crate) fn offset(&self) -> f32 {
        match self {
            Self::Continuous(knob) => knob.modulated_normalized_value() - knob.unmodulated_normalized_value(),
            Self::Stepped(knob) => knob.modulated_normalized_value() - knob.unmodulated_normalized_value(),
        }
    }

    /// Turns the knob without telling the host. Real-time safe.
    pub(crate) fn turn(&self, position: f32) {
        match self {
            Self::Continuous(knob) => turn(knob, position, self.offset()),
            Self::Stepped(knob) => turn(knob, position, self.offset()),
        }
    }
}

/// Turns a knob that modulation has moved by `offset`. The wrapper keeps no value that modulation leaves where it was,
/// at the end of the travel: then the knob is turned without modulation, which is put back as far as it was heard.
fn turn<P: Param + InternalParamMut>(knob: &P, position: f32, offset: f32)
where
    P::Plain: PartialEq,
{
    // SAFETY: the methods write atomics of a parameter that is borrowed here; that they are meant for wrappers only is
    // because the host hears nothing of it, which callers see to.
    unsafe {
        knob._internal_set_normalized_value(position);
        if knob.unmodulated_plain_value() != knob.preview_plain(position) {
            knob._internal_modulate_value(0.0);
            knob._internal_set_normalized_value(position);
            knob._internal_modulate_value(offset);
        }
    }
}

/// What the audio thread sees at one look.
pub(crate) struct Look {
    pub(crate) positions: [f32; PARAM_COUNT],
    /// A patch that has been loaded since, with its generation.
    pub(crate) news: Option<(u32, Loaded)>,
}

/// All that the threads of one instance share: parameters, the exact patch, and what is written beside it.
pub(crate) struct SprungParams {
    knobs: Vec<Knob>,
    slate: Slate,
    /// Held while a patch is written or its whole is read; never by the audio thread.
    about: Mutex<About>,
}

impl Default for SprungParams {
    fn default() -> Self {
        let state = State::default();
        let params = Self {
            knobs: PARAMS.iter().map(Knob::new).collect(),
            slate: Slate::new(&state.loaded),
            about: Mutex::new(state.about.clone()),
        };
        params.load(state);
        params
    }
}

impl SprungParams {
    /// The knobs in the order of the table.
    pub(crate) fn knobs(&self) -> &[Knob] {
        &self.knobs
    }

    /// What is written beside the patch. Not for the audio thread.
    pub(crate) fn about(&self) -> MutexGuard<'_, About> {
        self.about.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes over a patch, its knobs and what is written beside it, all at once. Not for the audio thread. The host
    /// does not hear of it.
    pub(crate) fn load(&self, state: State) {
        let mut about = self.about();
        *about = state.about;
        self.slate.write(&state.loaded, || {
            for (knob, position) in self.knobs.iter().zip(state.loaded.positions) {
                knob.turn(position);
            }
        });
    }

    /// The patch as it is now, and what is written beside it. Not for the audio thread.
    pub(crate) fn state(&self) -> State {
        let about = self.about();
        let mut loaded = self.slate.get();
        let positions: [f32; PARAM_COUNT] = from_fn(|index| self.knobs[index].position());
        let values: [f32; PARAM_COUNT] = from_fn(|index| loaded.value(index, positions[index]));
        for (info, value) in PARAMS.iter().zip(values) {
            loaded.patch.set(info.param, value);
        }
        loaded.positions = positions;
        State { loaded, about: about.clone() }
    }

    /// Where the knobs stand and, unless `known` is still the generation of the loaded patch, that patch with its new
    /// generation. `None` while another thread writes. Real-time safe.
    pub(crate) fn look(&self, known: Option<u32>) -> Option<Look> {
        self.slate.read(|generation| Look {
            positions: from_fn(|index| self.knobs[index].position()),
            news: (known != Some(generation)).then(|| (generation, self.slate.get())),
        })
    }
}

// SAFETY: the pointers are to knobs in a vector that is neither changed nor moved out of while `self` lives.
unsafe impl Params for SprungParams {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        let pointer = |knob: &Knob| match knob {
            Knob::Continuous(knob) => knob.as_ptr(),
            Knob::Stepped(knob) => knob.as_ptr(),
        };
        let entry = |(info, knob): (&ParamInfo, &Knob)| (info.id.to_owned(), pointer(knob), info.section.to_owned());
        PARAMS.iter().zip(&self.knobs).map(entry).collect()
    }

    fn serialize_fields(&self) -> BTreeMap<String, String> {
        BTreeMap::from([(state::FIELD.to_owned(), self.state().to_json())])
    }

    fn deserialize_fields(&self, fields: &BTreeMap<String, String>) {
        // What cannot be read has been taken out before.
        if let Some(Ok(state)) = fields.get(state::FIELD).map(|json| State::parse(json)) {
            self.load(state);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param as Row;

    #[test]
    fn the_host_sees_the_table() {
        let params = SprungParams::default();
        assert_eq!((params.knobs().len(), params.param_map().len()), (PARAM_COUNT, PARAM_COUNT));
        for ((info, knob), (id, _, section)) in PARAMS.iter().zip(params.knobs()).zip(params.param_map()) {
            assert_eq!((id.as_str(), section.as_str()), (info.id, info.section));
            let (name, steps, modulated) = match knob {
                Knob::Continuous(knob) => (knob.name(), knob.step_count(), knob.poly_modulation_id()),
                Knob::Stepped(knob) => (knob.name(), knob.step_count(), knob.poly_modulation_id()),
            };
            assert_eq!(name, info.name);
            let stepped = matches!(info.unit, Unit::Count | Unit::Choice);
            assert_eq!(steps, stepped.then_some((info.max - info.min) as usize), "{id}");
            let smoothed = matches!(info.change, Change::Smoothed(_));
            assert_eq!(modulated, smoothed.then_some(info.param as u32), "{id}");
            assert_eq!(knob.position(), info.normalise(info.default) as f32, "{id}");
        }
    }

    #[test]
    fn a_knob_is_turned_whatever_modulates_it() {
        let params = SprungParams::default();
        for row in [Row::Gain, Row::VibratoSync] {
            let knob = &params.knobs()[row as usize];
            for (offset, position) in [(1.0, 1.0), (1.0, 0.0), (-1.0, 1.0), (0.5, 0.0), (0.0, 1.0)] {
                // SAFETY: as the wrapper does while a host modulates.
                unsafe {
                    match knob {
                        Knob::Continuous(knob) => knob._internal_modulate_value(offset),
                        Knob::Stepped(knob) => knob._internal_modulate_value(offset),
                    }
                };
                knob.turn(position);
                assert_eq!(knob.position(), position, "{row:?} modulated by {offset}");
            }
        }
    }

    #[test]
    fn text_is_read_and_written_as_everywhere() {
        let params = SprungParams::default();
        for (row, text, shown) in [
            (Row::Decay, "250 ms", "250 ms"),
            (Row::Decay, "1.5", "1.5 s"),
            (Row::Tuning, "A4", "440 Hz"),
            (Row::Gain, "-12 dB", "-12 dB"),
            (Row::Exciter, "Pluck", "pluck"),
            (Row::Voices, "8", "8"),
        ] {
            let position = match &params.knobs()[row as usize] {
                Knob::Continuous(knob) => knob.string_to_normalized_value(text).unwrap(),
                Knob::Stepped(knob) => knob.string_to_normalized_value(text).unwrap(),
            };
            let written = match &params.knobs()[row as usize] {
                Knob::Continuous(knob) => knob.normalized_value_to_string(position, true),
                Knob::Stepped(knob) => knob.normalized_value_to_string(position, true),
            };
            assert_eq!(written, shown, "{text}");
            params.knobs()[row as usize].turn(position);
            assert_eq!(params.state().loaded.patch.get(row), row.info().parse(text).unwrap(), "{text}");
        }
        let Knob::Continuous(gain) = &params.knobs()[Row::Gain as usize] else { panic!("gain is continuous") };
        assert_eq!(gain.string_to_normalized_value("loud"), None);
        assert_eq!(gain.string_to_normalized_value("99 dB"), None);
    }
}
