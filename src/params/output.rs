//! Parameter rows of the output.

macro_rules! output {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Output" {
        Gain "gain" "Gain", Decibels -60.0..12.0 = -6.0, Linear, Smoothed(20), [],
            "Output level.";
        Pan "pan" "Pan", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Output position, left to right.";
        Limiter "limiter" "Limiter", Choice 0.0..1.0 = 1.0, Linear, AtOnce, [Limiter],
            "Brings loud chords below −0.3 dBFS true peak, without latency; what stays below −1 dBFS passes unchanged.";
    }
        } $($rest)* }
    };
}

pub(super) use output;
