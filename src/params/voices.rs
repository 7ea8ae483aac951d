//! Rows of how notes share voices.

macro_rules! voices {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Voices" {
        Voices "voices" "Voices", Count 1.0..64.0 = 16.0, Linear, NextNote, [],
            "How many notes sound at once.";
        Mode "mode" "Mode", Choice 0.0..2.0 = 0.0, Linear, NextNote, [PlayMode],
            "Many notes, one note struck each time, or one note struck only after a rest.";
        Choke "choke" "Choke group", Count 0.0..16.0 = 0.0, Linear, NextNote, [],
            "Notes of a choke group silence each other; 0 is none.";
    }
        } $($rest)* }
    };
}

pub(super) use voices;
