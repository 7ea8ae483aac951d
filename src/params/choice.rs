//! The choices of the parameters that have them, each list an enum.

/// One of the choices of a parameter; its value is its place among them.
pub trait Choice: Copy + Eq + Sized + 'static {
    /// All of them, in order.
    const ALL: &'static [Self];
    /// Their names, in the same order.
    const NAMES: &'static [&'static str];

    /// The choice that a parameter's value is: the nearest. Real-time safe.
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

            impl $name {
                /// Names of the choices, in order.
                pub const NAMES: &'static [&'static str] = &[$($text),*];
            }

            impl Choice for $name {
                const ALL: &'static [Self] = &[$($name::$variant),*];
                const NAMES: &'static [&'static str] = $name::NAMES;

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
    }

    /// How a burst of noise falls.
    NoiseDecay {
        /// By the square of what is left of its time.
        Quadratic "quadratic",
        /// By 60 dB in its time.
        Exponential "exponential",
    }

    /// What a release does.
    NoteOff {
        /// The damper comes down.
        Damp "damp",
        /// Nothing.
        Ring "ring",
    }

    /// The formulas behind pitch and decay.
    Coefficients {
        /// Exact tuning and decay.
        Exact "exact",
        /// The original ones.
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

    /// Which of the held keys sounds where notes share one voice.
    Priority {
        /// The one that went down last.
        Last "last",
        /// The lowest.
        Low "low",
        /// The highest.
        High "high",
    }

    /// Which notes slide from the one before.
    GlideWhen {
        /// All.
        Always "always",
        /// Those that start while another key is down.
        Legato "legato",
    }

    /// What the time of a glide counts for.
    GlideBy {
        /// Every slide.
        Time "time",
        /// Each octave of it.
        Rate "rate",
    }

    /// What sympathetic strings are tuned to.
    StringsTuning {
        /// Each key of two octaves.
        Chromatic "chromatic",
        /// A major chord over three octaves.
        Major "major",
        /// A minor chord over three octaves.
        Minor "minor",
        /// Fifths, one upon the other.
        Fifths "fifths",
    }

    /// The body that reverberates.
    Space {
        /// Nothing.
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
        /// Cold-rolled.
        Steel "steel",
        /// Aluminium.
        Aluminium "aluminium",
        /// Gold foil.
        Gold "gold",
        /// With a fifth of tin.
        Bronze "bronze",
        /// Window glass.
        Glass "glass",
    }

    /// Whether the limiter works.
    Limiter {
        /// What is loud stays loud.
        Off "off",
        /// Peaks are brought down.
        On "on",
    }

    /// How a slow oscillator moves.
    Shape {
        /// A sine.
        Sine "sine",
        /// Straight up and straight down.
        Triangle "triangle",
        /// Straight up, then from the bottom again.
        Ramp "ramp",
        /// Up for half of the round, down for the other.
        Square "square",
        /// A new random number each round.
        Steps "steps",
        /// From one random number to the next.
        Drift "drift",
    }

    /// Whose a slow oscillator is.
    Scope {
        /// Each note has one.
        Voice "voice",
        /// All notes follow the same.
        Shared "shared",
    }

    /// The note value that one round of an oscillator lasts.
    NoteValue {
        /// None: it has its own rate.
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
        check::<NoiseDecay>();
        check::<NoteOff>();
        check::<Coefficients>();
        check::<PlayMode>();
        check::<Priority>();
        check::<GlideWhen>();
        check::<GlideBy>();
        check::<StringsTuning>();
        check::<Space>();
        check::<SpaceMaterial>();
        check::<Limiter>();
        check::<Shape>();
        check::<Scope>();
        check::<NoteValue>();
        let lists = [
            MalletPulse::NAMES,
            NoiseDecay::NAMES,
            NoteOff::NAMES,
            Coefficients::NAMES,
            PlayMode::NAMES,
            Priority::NAMES,
            GlideWhen::NAMES,
            GlideBy::NAMES,
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
