//! Enums of the parameters whose value is one of a list of choices.

/// A choice of a parameter. The parameter's value is the index of the choice in the list.
pub trait Choice: Copy + Eq + Sized + 'static {
    /// All of them, in order.
    const ALL: &'static [Self];
    /// Their names, in the same order.
    const NAMES: &'static [&'static str];

    /// The choice nearest to a parameter's value. Real-time safe.
    fn from_value(value: f32) -> Self {
        // A negative number and NaN become 0.
        Self::ALL[(libm::roundf(value) as usize).min(Self::ALL.len() - 1)]
    }

    /// The parameter's value for this choice. Real-time safe.
    fn value(self) -> f32;
}

macro_rules! choices {
    ($($(#[$about:meta])* $name:ident { $($(#[$help:meta])* $variant:ident $text:literal,)* })*) => {
        $(
            $(#[$about])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            pub enum $name {
                $($(#[$help])* $variant,)*
            }

            impl Choice for $name {
                const ALL: &'static [Self] = &[$($name::$variant),*];
                const NAMES: &'static [&'static str] = &[$($text),*];

                fn value(self) -> f32 {
                    self as u8 as f32
                }
            }
        )*
    };
}

choices! {
    /// How long a mallet's force lasts.
    MalletPulse {
        /// One sample.
        Impulse "impulse",
        /// As long as the mallet touches the body.
        Contact "contact",
        /// The body pushes the mallet back through its felt.
        Felt "felt",
    }

    /// What a body hits as it swings.
    Rattle {
        /// Nothing.
        Off "off",
        /// An edge that does not move.
        Edge "edge",
        /// A mass that lies on the body.
        Loose "loose",
    }

    /// How breath gets into a tube.
    Valve {
        /// A reed, which the breath closes.
        Reed "reed",
        /// Lips, which the breath opens.
        Lips "lips",
        /// A jet across the mouth of the tube, which blows into it or past its edge.
        Jet "jet",
    }

    /// How a noise burst decays.
    NoiseDecay {
        /// With the square of the remaining noise time.
        Quadratic "quadratic",
        /// By 60 dB in the noise time.
        Exponential "exponential",
    }

    /// What happens when a note is released.
    NoteOff {
        /// The modes are damped.
        Damp "damp",
        /// The note rings on undamped.
        Ring "ring",
    }

    /// The formulas that turn pitch and decay into the coefficients of a mode.
    Coefficients {
        /// Exact tuning and decay.
        Exact "exact",
        /// The original formulas, with their drift.
        Classic "classic",
    }

    /// How notes share voices.
    PlayMode {
        /// A voice for every note.
        Poly "poly",
        /// One voice, struck by every note.
        Mono "mono",
        /// One voice, struck by the first note and retuned by those that overlap it.
        Legato "legato",
    }

    /// Which of the held keys sounds when notes share one voice.
    Priority {
        /// The key pressed last.
        Last "last",
        /// The lowest key.
        Low "low",
        /// The highest key.
        High "high",
    }

    /// Which notes glide from the pitch of the previous note.
    GlideWhen {
        /// All notes.
        Always "always",
        /// Notes that start while another key is held.
        Legato "legato",
    }

    /// Whether the glide time is the time of the whole glide or of one octave.
    GlideBy {
        /// The time of the whole glide, whatever its interval.
        Time "time",
        /// The time of each octave of the glide.
        Rate "rate",
    }

    /// Kind of the body behind the voices.
    Soundbox {
        /// None.
        None "none",
        /// A violin's body; larger ones are those of viola, cello and bass.
        Violin "violin",
        /// A classical guitar's body.
        Guitar "guitar",
        /// The soundboard of a grand piano.
        Soundboard "soundboard",
        /// A vocal tract.
        Voice "voice",
        /// The bell of a trumpet; larger ones are those of trombone, horn and tuba.
        Horn "horn",
    }

    /// What sympathetic strings are tuned to.
    StringsTuning {
        /// Each key of two octaves.
        Chromatic "chromatic",
        /// A major chord over three octaves.
        Major "major",
        /// A minor chord over three octaves.
        Minor "minor",
        /// Stacked fifths.
        Fifths "fifths",
    }

    /// Kind of the reverberating body.
    Space {
        /// No reverberation.
        None "none",
        /// A sheet of metal.
        Plate "plate",
        /// A tank of springs.
        Spring "spring",
        /// A small room.
        Room "room",
    }

    /// What plates and springs are made of.
    SpaceMaterial {
        /// Cold-rolled steel.
        Steel "steel",
        /// Aluminium.
        Aluminium "aluminium",
        /// Gold foil.
        Gold "gold",
        /// Bronze with one fifth of tin.
        Bronze "bronze",
        /// Window glass.
        Glass "glass",
    }

    /// Whether the limiter is on.
    Limiter {
        /// Peaks pass unchanged.
        Off "off",
        /// Peaks are reduced.
        On "on",
    }

    /// Waveform of a low-frequency oscillator.
    Shape {
        /// A sine.
        Sine "sine",
        /// Rises and falls in straight lines.
        Triangle "triangle",
        /// Rises in a straight line, then jumps back to the bottom.
        Ramp "ramp",
        /// High for half of the cycle, low for the other half.
        Square "square",
        /// A new random number each cycle.
        Steps "steps",
        /// Moves smoothly from one random number to the next.
        Drift "drift",
    }

    /// Whether each note has its own low-frequency oscillator.
    Scope {
        /// Each note has its own.
        Voice "voice",
        /// All notes share one.
        Shared "shared",
    }

    /// The note value that one cycle of an oscillator lasts.
    NoteValue {
        /// None: the oscillator has its own rate.
        Off "off",
        /// A whole note.
        Whole "1/1",
        /// A half note.
        Half "1/2",
        /// A dotted quarter.
        DottedQuarter "1/4.",
        /// A quarter.
        Quarter "1/4",
        /// A quarter triplet.
        QuarterTriplet "1/4T",
        /// A dotted eighth.
        DottedEighth "1/8.",
        /// An eighth.
        Eighth "1/8",
        /// An eighth triplet.
        EighthTriplet "1/8T",
        /// A sixteenth.
        Sixteenth "1/16",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{PARAMS, Unit};
    use std::fmt::Debug;

    fn check<T: Choice + Debug>() {
        assert_eq!(T::ALL.len(), T::NAMES.len());
        let rows: Vec<_> = PARAMS.iter().filter(|info| info.choices == T::NAMES).collect();
        assert!(!rows.is_empty(), "{:?} are no parameter's choices", T::NAMES);
        for (choice, name) in T::ALL.iter().zip(T::NAMES) {
            assert_eq!(T::from_value(choice.value()), *choice);
            assert!(rows.iter().all(|info| info.parse(name) == Ok(choice.value())), "{choice:?}");
        }
        assert_eq!([-1.0, f32::NAN, 99.0].map(T::from_value), [T::ALL[0], T::ALL[0], T::ALL[T::ALL.len() - 1]]);
    }

    #[test]
    fn every_choice_is_its_value_and_its_name() {
        check::<MalletPulse>();
        check::<Rattle>();
        check::<Valve>();
        check::<NoiseDecay>();
        check::<NoteOff>();
        check::<Coefficients>();
        check::<PlayMode>();
        check::<Priority>();
        check::<GlideWhen>();
        check::<GlideBy>();
        check::<Soundbox>();
        check::<StringsTuning>();
        check::<Space>();
        check::<SpaceMaterial>();
        check::<Limiter>();
        check::<Shape>();
        check::<Scope>();
        check::<NoteValue>();
        let lists = [
            MalletPulse::NAMES,
            Valve::NAMES,
            Rattle::NAMES,
            NoiseDecay::NAMES,
            NoteOff::NAMES,
            Coefficients::NAMES,
            PlayMode::NAMES,
            Priority::NAMES,
            GlideWhen::NAMES,
            GlideBy::NAMES,
            Soundbox::NAMES,
            StringsTuning::NAMES,
            Space::NAMES,
            SpaceMaterial::NAMES,
            Limiter::NAMES,
            Shape::NAMES,
            Scope::NAMES,
            NoteValue::NAMES,
        ];
        assert!(PARAMS.iter().all(|info| (info.unit == Unit::Choice) == lists.contains(&info.choices)));
    }
}
