//! Parameter rows of the voices: polyphony, play mode, unison and choke groups.

macro_rules! voices {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Voices" {
        Voices "voices" "Voices", Count 1.0..64.0 = 16.0, Linear, NextNote, [],
            "How many notes sound at once.";
        Mode "mode" "Mode", Choice 0.0..2.0 = 0.0, Linear, NextNote, [PlayMode],
            "Many notes, one note struck each time, or one note struck only after a rest.";
        Priority "priority" "Priority", Choice 0.0..2.0 = 0.0, Linear, NextNote, [Priority],
            "Which of the held keys sounds in mono and legato; the others wait.";
        Unison "unison" "Unison", Count 1.0..8.0 = 1.0, Linear, NextNote, [],
            "How many voices play each note, together as loud as one.";
        UnisonDetune "unison_detune" "Unison detune", Cents 0.0..100.0 = 10.0, Linear, NextNote, [],
            "How far the outermost unison voices lie from the note, each way; the others lie evenly between them.";
        UnisonSpread "unison_spread" "Unison spread", Percent 0.0..100.0 = 50.0, Linear, NextNote, [],
            "How much of the stereo field unison voices take, the lowest on the left.";
        UnisonPhase "unison_phase" "Unison phase", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How much the phases at which unison voices start differ; 0 % starts them all alike.";
        Choke "choke" "Choke group", Count 0.0..16.0 = 0.0, Linear, NextNote, [],
            "Notes of a choke group silence each other; 0 is none.";
    }
        } $($rest)* }
    };
}

pub(super) use voices;
