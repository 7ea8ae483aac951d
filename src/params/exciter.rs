//! Rows of what moves the masses.

macro_rules! exciter {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Exciter" {
        Exciter "exciter" "Exciter", Choice 0.0..3.0 = 0.0, Linear, NextNote, [Exciter],
            "What moves the masses: a one-sample impulse, a mallet's force pulse, a pulled-and-released displacement, or a noise burst.";
        Hardness "hardness" "Hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote, [],
            "Mallet or plectrum hardness: contact time from 10 ms (0 %) to 0.05 ms (100 %).";
        Position "position" "Pluck position", Percent 1.0..50.0 = 50.0, Linear, NextNote, [],
            "Where along the string it is plucked; 50 % is the middle and silences even harmonics.";
        NoiseLevel "noise_level" "Noise level", Decibels -60.0..24.0 = 0.0, Linear, NextNote, [],
            "Strength of the noise burst against a strike of the same velocity.";
        NoiseTime "noise_time" "Noise time", Seconds 0.001..1.0 = 0.02, Logarithmic, NextNote, [],
            "Length of the noise burst.";
        Velocity "velocity" "Velocity to force", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How much velocity sets the force: 100 % is the square of velocity, 0 % is full force always.";
    }
        } $($rest)* }
    };
}

pub(super) use exciter;
