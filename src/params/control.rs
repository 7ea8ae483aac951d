//! Rows of what wheels and pressure do.

macro_rules! control {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
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
        } $($rest)* }
    };
}

pub(super) use control;
