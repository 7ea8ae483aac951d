//! Parameter rows of the macros: knobs that act only through routes.

macro_rules! macros {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Macros" {
        Macro1 "macro1" "Macro 1", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro2 "macro2" "Macro 2", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro3 "macro3" "Macro 3", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro4 "macro4" "Macro 4", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro5 "macro5" "Macro 5", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro6 "macro6" "Macro 6", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro7 "macro7" "Macro 7", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
        Macro8 "macro8" "Macro 8", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "Has no effect by itself: routes lead it to other parameters.";
    }
        } $($rest)* }
    };
}

pub(super) use macros;
