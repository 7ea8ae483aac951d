//! Parameter rows of the pitch wheel.

macro_rules! control {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Control" {
        BendRange "bend_range" "Bend range", Semitones 0.0..48.0 = 2.0, Linear, Smoothed(0), [],
            "Pitch-bend range, unless the channel has set its own (RPN 0).";
    }
        } $($rest)* }
    };
}

pub(super) use control;
