//! The parameter table: every parameter's id, name, unit, range, curve, default and smoothing, defined once.
//!
//! The engine, the command, preset files, the documentation and any plugin shell derive from [`PARAMS`].
//! Ids are part of every saved preset and song: a test pins them, and an id that goes is kept in [`retired`] and never
//! used again.

use libm::{exp10, floor, log, log10, pow, round};

/// What a parameter's number counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A plain number.
    Number,
    /// A whole number.
    Count,
    /// An index into [`ParamInfo::choices`].
    Choice,
    /// Decibels.
    Decibels,
    /// Decibels per octave.
    DecibelsPerOctave,
    /// Seconds; written in milliseconds below 1 s.
    Seconds,
    /// Hertz.
    Hertz,
    /// Per cent.
    Percent,
    /// Semitones.
    Semitones,
    /// Cents.
    Cents,
}

/// How a knob's travel maps to the parameter's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// Equal steps.
    Linear,
    /// Equal ratios; the range must be positive.
    Logarithmic,
}

/// When a change is heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// By the notes that start after it.
    NextNote,
    /// At once, reaching its new value over this many milliseconds.
    Smoothed(u16),
    /// At once, by the output as a whole: it can be modulated neither for single notes nor for all.
    AtOnce,
}

/// One row of the parameter table.
#[derive(Debug)]
pub struct ParamInfo {
    /// The parameter that this row describes.
    pub param: Param,
    /// Stable identifier in presets, on the command line and in plugin state.
    pub id: &'static str,
    /// Name shown to people.
    pub name: &'static str,
    /// Group that it is shown in.
    pub section: &'static str,
    /// What the number counts.
    pub unit: Unit,
    /// Smallest value.
    pub min: f32,
    /// Largest value.
    pub max: f32,
    /// Value of a new patch.
    pub default: f32,
    /// Knob mapping.
    pub curve: Curve,
    /// When a change is heard.
    pub change: Change,
    /// Whether nothing can modulate it although it is a quantity.
    is_fixed: bool,
    /// Names of the values when `unit` is [`Unit::Choice`].
    pub choices: &'static [&'static str],
    /// One sentence for tooltips and tables.
    pub help: &'static str,
}

mod body;
mod choice;
mod control;
mod envelope;
mod exciter;
mod lfo;
mod macros;
mod output;
mod pitch;
pub mod retired;
mod routes;
mod text;
mod values;
mod voices;

pub use choice::{
    Choice, Coefficients, Exciter, GlideBy, GlideWhen, Limiter, NoteOff, NoteValue, PlayMode, Priority, Scope, Shape,
};
pub use values::Values;

/// The names of the choices of a row.
macro_rules! choice_names {
    () => {
        &[]
    };
    ($choices:ident) => {
        $choices::NAMES
    };
}

/// Makes [`Param`] and [`PARAMS`] of the rows of all modules.
macro_rules! table {
    ({ $($section:literal {
        $($param:ident $id:literal $name:literal, $unit:ident $min:literal..$max:literal = $default:literal,
          $curve:ident, $change:expr, $($fixed:ident)? [$($choices:ident)?], $help:literal;)*
    })* }) => {
        /// A parameter, in table order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Param {
            $($(#[doc = $help] $param,)*)*
        }

        /// The parameter table, indexed by `Param as usize`.
        pub static PARAMS: &[ParamInfo] = &[
            $($(ParamInfo {
                param: Param::$param, id: $id, name: $name, section: $section, unit: Unit::$unit,
                min: $min, max: $max, default: $default, curve: Curve::$curve, change: $change,
                is_fixed: { const FIXED: &[&str] = &[$(stringify!($fixed))?]; !FIXED.is_empty() },
                choices: choice_names!($($choices)?), help: $help,
            },)*)*
        ];

        /// Number of parameters.
        pub const PARAM_COUNT: usize = [$($(Param::$param,)*)*].len();
    };
}

use Change::{AtOnce, NextNote, Smoothed};
use {
    body::body, control::control, envelope::envelope, exciter::exciter, lfo::lfo, macros::macros, output::output,
    pitch::pitch, routes::routes, voices::voices,
};

// Each adds its rows to those before it and hands them on.
exciter! { {} body pitch control lfo envelope macros routes voices output table }

impl Param {
    /// This parameter's row of the table.
    pub fn info(self) -> &'static ParamInfo {
        &PARAMS[self as usize]
    }

    /// The parameter with this id.
    pub fn from_id(id: &str) -> Option<Param> {
        PARAMS.iter().find(|info| info.id == id).map(|info| info.param)
    }
}

impl ParamInfo {
    /// The nearest value that the parameter can take: in range, whole where it must be; the default for NaN.
    /// Real-time safe.
    pub fn clamp(&self, value: f32) -> f32 {
        let value = if value.is_nan() { self.default } else { value.clamp(self.min, self.max) };
        if matches!(self.unit, Unit::Count | Unit::Choice) { libm::roundf(value) } else { value }
    }

    /// The value itself if the parameter can take it, else a message that says the range.
    pub fn check(&self, value: f32) -> Result<f32, String> {
        if value == self.clamp(value) {
            return Ok(value);
        }
        if self.unit == Unit::Choice {
            return Err(format!("‘{value}’ is not one of {}", self.choices.join(", ")));
        }
        Err(format!("{value} is out of range: expected {}", self.range()))
    }

    /// `from -60 dB to 12 dB`.
    fn range(&self) -> String {
        let whole = if self.unit == Unit::Count { "a whole number " } else { "" };
        format!("{whole}from {} to {}", self.format(self.min), self.format(self.max))
    }

    /// Whether routes can move it: it is a quantity, and belongs to the notes and not to the output as a whole.
    pub const fn is_modulatable(&self) -> bool {
        !matches!(self.unit, Unit::Count | Unit::Choice) && !matches!(self.change, Change::AtOnce) && !self.is_fixed
    }

    /// Frames that a sounding note takes to follow a change; none if it does not follow at all.
    pub(crate) fn smoothing_frames(&self, sample_rate: f64) -> Option<u32> {
        match self.change {
            Change::NextNote | Change::AtOnce => None,
            Change::Smoothed(milliseconds) => Some((f64::from(milliseconds) * 1e-3 * sample_rate) as u32),
        }
    }

    /// Knob position 0–1 of a value.
    pub fn normalise(&self, value: f32) -> f64 {
        let (value, min, max) = (f64::from(self.clamp(value)), f64::from(self.min), f64::from(self.max));
        match self.curve {
            Curve::Linear => (value - min) / (max - min),
            Curve::Logarithmic => log(value / min) / log(max / min),
        }
    }

    /// Value of a knob position 0–1, out of a grid of short decimal numbers: five significant digits of the value where
    /// steps are of equal ratio, of the range where they are equal. So a number that a person has set comes back as
    /// that very number from a position in single precision, which is what plugin hosts keep.
    pub fn denormalise(&self, position: f64) -> f32 {
        let (min, max) = (f64::from(self.min), f64::from(self.max));
        let position = position.clamp(0.0, 1.0);
        let (value, size) = match self.curve {
            Curve::Linear => (min + position * (max - min), max - min),
            Curve::Logarithmic => {
                let value = min * pow(max / min, position);
                (value, value)
            }
        };
        // 10^(4 − ⌊log₁₀ size⌋): steps of 1/10,000 to 1/100,000.
        let steps_per_unit = exp10(4.0 - floor(log10(size)));
        self.clamp((round(value * steps_per_unit) / steps_per_unit) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Ids are in people's presets: this list only grows.
    #[test]
    fn ids_are_pinned() {
        let ids: Vec<_> = PARAMS.iter().map(|info| info.id).collect();
        let pinned = "exciter hardness position noise_level noise_time velocity \
            decay release damper note_off decay_tilt tilt stretch width coefficients \
            tune fine tuning key_track sweep sweep_time sweep_curve \
            vibrato vibrato_rate vibrato_delay vibrato_sync glide glide_when glide_by \
            bend_range \
            lfo1_rate lfo1_sync lfo1_shape lfo1_phase lfo1_fade lfo1_scope \
            lfo2_rate lfo2_sync lfo2_shape lfo2_phase lfo2_fade lfo2_scope \
            lfo3_rate lfo3_sync lfo3_shape lfo3_phase lfo3_fade lfo3_scope \
            envelope1_delay envelope1_attack envelope1_hold envelope1_decay envelope1_sustain envelope1_release \
            envelope1_curve \
            envelope2_delay envelope2_attack envelope2_hold envelope2_decay envelope2_sustain envelope2_release \
            envelope2_curve \
            macro1 macro2 macro3 macro4 macro5 macro6 macro7 macro8 \
            route1 route2 route3 route4 route5 route6 route7 route8 \
            route9 route10 route11 route12 route13 route14 route15 route16 \
            voices mode priority unison unison_detune unison_spread unison_phase choke gain pan limiter";
        assert_eq!(ids, pinned.split_whitespace().collect::<Vec<_>>());
    }

    #[test]
    fn the_table_is_consistent() {
        for (index, info) in PARAMS.iter().enumerate() {
            assert_eq!(info.param as usize, index, "{}", info.id);
            assert_eq!(Param::from_id(info.id), Some(info.param));
            assert!(info.min < info.max && (info.min..=info.max).contains(&info.default), "{}", info.id);
            assert!(info.curve == Curve::Linear || info.min > 0.0, "{}", info.id);
            assert_eq!(info.unit == Unit::Choice, !info.choices.is_empty(), "{}", info.id);
            if info.unit == Unit::Choice {
                assert_eq!((info.min, info.max as usize + 1), (0.0, info.choices.len()), "{}", info.id);
            }
        }
        assert_eq!(PARAMS.len(), PARAM_COUNT);
    }

    proptest! {
        #[test]
        fn text_and_knob_go_both_ways(index in 0..PARAM_COUNT, position in 0.0..=1.0f64) {
            let info = &PARAMS[index];
            let value = info.denormalise(position);
            prop_assert!(info.check(value).is_ok());
            let text = info.format(value);
            let read = info.parse(&text).map_err(TestCaseError::fail)?;
            prop_assert_eq!(info.format(read), text);
            let single = info.normalise(value) as f32;
            prop_assert_eq!(info.denormalise(single.into()), value, "{} through {}", info.id, single);
        }
    }
}
