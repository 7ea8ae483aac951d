//! A parameter of the host's: a knob's position, or the number of a step.

#![allow(unsafe_code, reason = "the wrapper has no safe way to set several parameters at once")]

use nice_plug::prelude::*;
use nice_plug_core::params::InternalParamMut;
use sprung::params::{Change, ParamInfo, Unit};
use std::sync::Arc;

/// A host's parameter.
pub(crate) enum Knob {
    /// The knob's position, 0–1. The wrapper's own curves would not give the engine's values.
    Continuous(FloatParam),
    /// A count, or the index of a choice.
    Stepped(IntParam),
}

impl Knob {
    /// With a position that is also the host’s default; the window resets to the table’s.
    pub(super) fn new(info: &'static ParamInfo, position: f32) -> Self {
        let smoothed = matches!(info.change, Change::Smoothed(_));
        if matches!(info.unit, Unit::Count | Unit::Choice) {
            let range = IntRange::Linear { min: info.min as i32, max: info.max as i32 };
            let knob = IntParam::new(info.name, info.denormalise(position.into()) as i32, range)
                .with_value_to_string(Arc::new(|value| info.format(value as f32)))
                .with_string_to_value(Arc::new(|text| Some(info.parse(text).ok()? as i32)));
            return Self::Stepped(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob });
        }
        let knob = FloatParam::new(info.name, position, FloatRange::Linear { min: 0.0, max: 1.0 })
            .with_value_to_string(Arc::new(|position| info.format(info.denormalise(f64::from(position)))))
            .with_string_to_value(Arc::new(|text| Some(info.normalise(info.parse(text).ok()?) as f32)));
        Self::Continuous(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob })
    }

    /// The knob's position 0–1, without modulation. Real-time safe.
    pub(crate) fn position(&self) -> f32 {
        match self {
            Self::Continuous(knob) => knob.unmodulated_normalized_value(),
            Self::Stepped(knob) => knob.unmodulated_normalized_value(),
        }
    }

    /// Offset of the knob by modulation of the whole instrument. Real-time safe.
    pub(crate) fn offset(&self) -> f32 {
        // Read the position first, since the wrapper writes it last. If it changes in between, position plus offset is
        // still the new modulated position.
        let position = self.position();
        match self {
            Self::Continuous(knob) => knob.modulated_normalized_value() - position,
            Self::Stepped(knob) => knob.modulated_normalized_value() - position,
        }
    }

    /// The wrapper's name for the parameter.
    pub(crate) fn as_ptr(&self) -> ParamPtr {
        match self {
            Self::Continuous(knob) => knob.as_ptr(),
            Self::Stepped(knob) => knob.as_ptr(),
        }
    }

    /// Sets the knob without telling the host. Real-time safe.
    pub(crate) fn turn(&self, position: f32) {
        match self {
            Self::Continuous(knob) => turn(knob, position, self.offset()),
            Self::Stepped(knob) => turn(knob, position, self.offset()),
        }
    }
}

/// Sets a knob that modulation has moved by `offset`. At the end of the range, the wrapper ignores a new value because
/// the modulated value does not change: then the knob is set without modulation, and the modulation is applied again.
fn turn<P: Param + InternalParamMut>(knob: &P, position: f32, offset: f32)
where
    P::Plain: PartialEq,
{
    // SAFETY: the methods only write atomics of a parameter that is borrowed here. They are marked unsafe because they do
    // not notify the host; callers do that where it is needed.
    unsafe {
        knob._internal_set_normalized_value(position);
        if knob.unmodulated_plain_value() != knob.preview_plain(position) {
            knob._internal_modulate_value(0.0);
            knob._internal_set_normalized_value(position);
            knob._internal_modulate_value(offset);
        }
    }
}
