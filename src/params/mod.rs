//! The parameter table: every parameter's id, name, unit, range, curve, default and smoothing, defined once.
//!
//! The engine, the command, preset files, the documentation and any plugin shell derive from [`PARAMS`].
//! Ids are part of every saved preset and song: a test pins them.

/// The unit of a parameter's value.
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

/// When a change of a parameter takes effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// In the notes that start after the change.
    NextNote,
    /// At once, smoothed over this many milliseconds.
    Smoothed(u16),
    /// At once, on the output as a whole. Routes move quantities among these for all notes, but not by oscillators, envelopes or
    /// the release.
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
    /// Unit of the value.
    pub unit: Unit,
    /// Smallest value.
    pub min: f32,
    /// Largest value.
    pub max: f32,
    /// Value of a new patch.
    pub default: f32,
    /// Knob mapping.
    pub curve: Curve,
    /// When a change takes effect.
    pub change: Change,
    /// Whether it cannot be modulated, although it is a quantity.
    is_fixed: bool,
    /// Names of the values when `unit` is [`Unit::Choice`].
    pub choices: &'static [&'static str],
    /// One sentence for tooltips and tables.
    pub help: &'static str,
}

mod choice;
mod knob;
pub(crate) mod learned;
mod table;
mod text;
mod values;

pub use choice::{
    Choice, Coefficients, GlideBy, GlideWhen, Limiter, MalletPulse, NoiseDecay, NoteOff, NoteValue, PlayMode, Priority,
    Rattle, Scope, Shape, Soundbox, Space, SpaceMaterial, StringsTuning, Valve,
};
pub use table::{PARAM_COUNT, PARAMS, Param};
pub use values::Values;

impl Param {
    /// This parameter's row of the table.
    pub fn info(self) -> &'static ParamInfo {
        &PARAMS[self as usize]
    }

    /// Whether it belongs to the effects behind the voices, which all sounds of a kit share: soundbox, strings, tremolo,
    /// drive, tone, space, stereo width. Real-time safe.
    pub const fn is_behind_voices(self) -> bool {
        Self::Soundbox as usize <= self as usize && self as usize <= Self::StereoWidth as usize
    }

    /// Whether it is of a kit as a whole, and not of each of its sounds. Real-time safe.
    pub const fn is_of_kit(self) -> bool {
        matches!(self, Self::Voices | Self::Mode | Self::Priority | Self::Choke | Self::Limiter)
    }

    /// Whether it belongs to the space, the reverberating body behind the voices. Real-time safe.
    pub(crate) const fn is_of_space(self) -> bool {
        Self::Space as usize <= self as usize && self as usize <= Self::SpaceMix as usize
    }

    /// The parameter with this id.
    pub fn from_id(id: &str) -> Option<Param> {
        PARAMS.iter().find(|info| info.id == id).map(|info| info.param)
    }
}

impl ParamInfo {
    /// The nearest value that the parameter can take: in range, and whole for counts and choices. NaN becomes the
    /// default. Real-time safe.
    pub fn clamp(&self, value: f32) -> f32 {
        let value = if value.is_nan() { self.default } else { value.clamp(self.min, self.max) };
        if matches!(self.unit, Unit::Count | Unit::Choice) { libm::roundf(value) } else { value }
    }

    /// The value itself if the parameter can take it, otherwise a message with the range.
    pub fn check(&self, value: f32) -> Result<f32, String> {
        if value == self.clamp(value) {
            return Ok(value);
        }
        if self.unit == Unit::Choice {
            return Err(format!("‘{value}’ is not one of {}", self.choices.join(", ")));
        }
        Err(format!("{value} is out of range: expected {}", self.range()))
    }

    /// The range as text, such as `from -60 dB to 12 dB`.
    fn range(&self) -> String {
        let whole = if self.unit == Unit::Count { "a whole number " } else { "" };
        format!("{whole}from {} to {}", self.format(self.min), self.format(self.max))
    }

    /// Whether routes can modulate it: it is a quantity and is not fixed.
    pub const fn is_modulatable(&self) -> bool {
        !matches!(self.unit, Unit::Count | Unit::Choice) && !self.is_fixed
    }

    /// Smoothing time in frames of a change during a note; none if a sounding note does not follow the parameter.
    pub(crate) fn smoothing_frames(&self, sample_rate: f64) -> Option<u32> {
        match self.change {
            Change::NextNote | Change::AtOnce => None,
            Change::Smoothed(milliseconds) => Some((f64::from(milliseconds) * 1e-3 * sample_rate) as u32),
        }
    }
}

#[cfg(test)]
mod tests;
