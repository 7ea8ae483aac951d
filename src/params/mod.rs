//! The parameter table: every parameter's id, name, unit, range, curve, default and smoothing, defined once.
//!
//! The engine, the command, preset files, the documentation and any plugin shell derive from [`PARAMS`].
//! Ids are part of every saved preset and song: a test pins them, and an id that goes is never used again.

mod text;

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
    /// Names of the values when `unit` is [`Unit::Choice`].
    pub choices: &'static [&'static str],
    /// One sentence for tooltips and tables.
    pub help: &'static str,
}

macro_rules! params {
    ($($section:literal {
        $($param:ident $id:literal $name:literal, $unit:ident $min:literal..$max:literal = $default:literal,
          $curve:ident, $change:expr, [$($choice:literal),*], $help:literal;)*
    })*) => {
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
                choices: &[$($choice),*], help: $help,
            },)*)*
        ];

        /// Number of parameters.
        pub const PARAM_COUNT: usize = [$($(Param::$param,)*)*].len();
    };
}

use Change::{AtOnce, NextNote, Smoothed};

params! {
    "Exciter" {
        Exciter "exciter" "Exciter", Choice 0.0..3.0 = 0.0, Linear, NextNote, ["impulse", "strike", "pluck", "noise"],
            "What moves the masses: a one-sample impulse, a mallet's force pulse, a pulled-and-released displacement, or a noise burst.";
        Hardness "hardness" "Hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote, [],
            "Mallet or plectrum hardness: contact time from 10 ms (0 %) to 0.05 ms (100 %).";
        HardnessVelocity "hardness_velocity" "Velocity to hardness", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "How much softer quiet notes strike.";
        Position "position" "Pluck position", Percent 1.0..50.0 = 50.0, Linear, NextNote, [],
            "Where along the string it is plucked; 50 % is the middle and silences even harmonics.";
        NoiseLevel "noise_level" "Noise level", Decibels -60.0..24.0 = 0.0, Linear, NextNote, [],
            "Strength of the noise burst against a strike of the same velocity.";
        NoiseTime "noise_time" "Noise time", Seconds 0.001..1.0 = 0.02, Logarithmic, NextNote, [],
            "Length of the noise burst.";
        Velocity "velocity" "Velocity to force", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How much velocity sets the force: 100 % is the square of velocity, 0 % is full force always.";
    }
    "Body" {
        Decay "decay" "Decay", Seconds 0.005..60.0 = 1.0, Logarithmic, Smoothed(20), [],
            "Time in which a held note falls by 60 dB (T60).";
        Release "release" "Release", Seconds 0.005..60.0 = 0.3, Logarithmic, Smoothed(20), [],
            "Longest T60 once the note is released: the damper.";
        NoteOff "note_off" "Note off", Choice 0.0..1.0 = 0.0, Linear, NextNote, ["damp", "ring"],
            "Whether a released note is damped or rings on as a drum does.";
        DecayKey "decay_key" "Decay by key", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "How higher keys decay faster: at 100 % the T60 halves per octave above C4.";
        DecayTilt "decay_tilt" "Decay by mode", Number 0.0..2.0 = 0.0, Linear, NextNote, [],
            "How higher modes decay faster: the T60 of a mode is divided by its ratio to this power.";
        Tilt "tilt" "Brightness", DecibelsPerOctave -24.0..24.0 = 0.0, Linear, NextNote, [],
            "Tilts the levels of the modes by their ratio.";
        Stretch "stretch" "Stretch", Number 0.5..2.0 = 1.0, Linear, NextNote, [],
            "Raises the ratios of the modes to this power: spreads or squeezes the spectrum.";
        Width "width" "Width", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How far apart the modes are panned.";
        Coefficients "coefficients" "Coefficients", Choice 0.0..1.0 = 0.0, Linear, NextNote, ["exact", "classic"],
            "Exact tuning and decay, or the original formulas with their drift, clamped short of exploding.";
    }
    "Pitch" {
        Tune "tune" "Tune", Semitones -48.0..48.0 = 0.0, Linear, Smoothed(10), [],
            "Transposition.";
        Fine "fine" "Fine tune", Cents -100.0..100.0 = 0.0, Linear, Smoothed(10), [],
            "Fine transposition.";
        Tuning "tuning" "Tuning A4", Hertz 400.0..480.0 = 440.0, Linear, NextNote, [],
            "Frequency of A4.";
        KeyTrack "key_track" "Key tracking", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How far pitch follows the key, about C4; 0 % gives every key the pitch of C4.";
        Sweep "sweep" "Sweep", Semitones -60.0..60.0 = 0.0, Linear, NextNote, [],
            "Where the pitch starts, above or below the note.";
        SweepTime "sweep_time" "Sweep time", Seconds 0.001..10.0 = 0.1, Logarithmic, NextNote, [],
            "Time until the sweep has arrived at the note.";
        SweepCurve "sweep_curve" "Sweep curve", Percent -100.0..100.0 = 50.0, Linear, NextNote, [],
            "0 % is a straight line; above, the sweep falls fast and settles slowly; below, the reverse.";
        SweepVelocity "sweep_velocity" "Velocity to sweep", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "How much velocity scales the depth of the sweep.";
        Vibrato "vibrato" "Vibrato", Cents 0.0..1200.0 = 0.0, Linear, Smoothed(20), [],
            "Vibrato depth, each way.";
        VibratoRate "vibrato_rate" "Vibrato rate", Hertz 0.05..20.0 = 5.0, Logarithmic, Smoothed(20), [],
            "Vibrato frequency.";
        VibratoDelay "vibrato_delay" "Vibrato delay", Seconds 0.0..5.0 = 0.0, Linear, NextNote, [],
            "Time over which the patch's own vibrato fades in; wheel and pressure act at once.";
        VibratoSync "vibrato_sync" "Vibrato sync", Choice 0.0..9.0 = 0.0, Linear, Smoothed(0),
            ["off", "1/1", "1/2", "1/4.", "1/4", "1/4T", "1/8.", "1/8", "1/8T", "1/16"],
            "Note value that one vibrato lasts at the song's tempo, in place of the vibrato rate.";
        Glide "glide" "Glide", Seconds 0.0..10.0 = 0.0, Linear, NextNote, [],
            "Time to slide from the note before; 0 is off.";
    }
    "Control" {
        BendRange "bend_range" "Bend range", Semitones 0.0..48.0 = 2.0, Linear, Smoothed(0), [],
            "Pitch-bend range, unless the channel has set its own (RPN 0).";
        WheelVibrato "wheel_vibrato" "Wheel to vibrato", Cents 0.0..1200.0 = 50.0, Linear, Smoothed(20), [],
            "Vibrato that the modulation wheel adds.";
        PressureVibrato "pressure_vibrato" "Pressure to vibrato", Cents 0.0..1200.0 = 0.0, Linear, Smoothed(20), [],
            "Vibrato that pressure adds.";
        PressureDamping "pressure_damping" "Pressure to damping", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far pressure damps the note: at 100 % full pressure damps as a release does.";
        ReleaseVelocity "release_velocity" "Release velocity", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "How much a quick release shortens, and a slow one lengthens, the release time.";
    }
    "Voices" {
        Voices "voices" "Voices", Count 1.0..64.0 = 16.0, Linear, NextNote, [],
            "How many notes sound at once.";
        Mode "mode" "Mode", Choice 0.0..2.0 = 0.0, Linear, NextNote, ["poly", "mono", "legato"],
            "Many notes, one note struck each time, or one note struck only after a rest.";
        Choke "choke" "Choke group", Count 0.0..16.0 = 0.0, Linear, NextNote, [],
            "Notes of a choke group silence each other; 0 is none.";
    }
    "Output" {
        Gain "gain" "Gain", Decibels -60.0..12.0 = -6.0, Linear, Smoothed(20), [],
            "Output level.";
        Pan "pan" "Pan", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Output position, left to right.";
        Limiter "limiter" "Limiter", Choice 0.0..1.0 = 1.0, Linear, AtOnce, ["off", "on"],
            "Brings loud chords below −0.3 dBFS true peak, without latency; what stays below −1 dBFS passes unchanged.";
    }
}

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
        let pinned = "exciter hardness hardness_velocity position noise_level noise_time velocity \
            decay release note_off decay_key decay_tilt tilt stretch width coefficients \
            tune fine tuning key_track sweep sweep_time sweep_curve sweep_velocity \
            vibrato vibrato_rate vibrato_delay vibrato_sync glide \
            bend_range wheel_vibrato pressure_vibrato pressure_damping release_velocity \
            voices mode choke gain pan limiter";
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
                assert_eq!(info.max as usize + 1, info.choices.len(), "{}", info.id);
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
