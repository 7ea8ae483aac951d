//! Rows of the macros: knobs that mean what routes make of them.

macro_rules! macros {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Macros" {
        Macro1 "macro1" "Macro 1", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro2 "macro2" "Macro 2", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro3 "macro3" "Macro 3", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro4 "macro4" "Macro 4", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro5 "macro5" "Macro 5", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro6 "macro6" "Macro 6", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro7 "macro7" "Macro 7", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
        Macro8 "macro8" "Macro 8", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "A knob that moves whatever its routes lead to.";
    }
        } $($rest)* }
    };
}

pub(super) use macros;
