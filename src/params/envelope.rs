//! Parameter rows of the two envelopes.

macro_rules! envelope {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        envelope! { @ { $($before)* } [$next $($rest)*]
            "Envelope 1" Envelope1Delay "envelope1_delay" "Envelope 1 delay" Envelope1Attack
                "envelope1_attack" "Envelope 1 attack" Envelope1Hold "envelope1_hold" "Envelope 1 hold"
                Envelope1Decay "envelope1_decay" "Envelope 1 decay" Envelope1Sustain "envelope1_sustain"
                "Envelope 1 sustain" Envelope1Release "envelope1_release" "Envelope 1 release"
                Envelope1Curve "envelope1_curve" "Envelope 1 curve";
            "Envelope 2" Envelope2Delay "envelope2_delay" "Envelope 2 delay" Envelope2Attack
                "envelope2_attack" "Envelope 2 attack" Envelope2Hold "envelope2_hold" "Envelope 2 hold"
                Envelope2Decay "envelope2_decay" "Envelope 2 decay" Envelope2Sustain "envelope2_sustain"
                "Envelope 2 sustain" Envelope2Release "envelope2_release" "Envelope 2 release"
                Envelope2Curve "envelope2_curve" "Envelope 2 curve";
        }
    };
    (@ { $($before:tt)* } [$next:ident $($rest:ident)*]
        $($section:literal $Delay:ident $delay:literal $delay_name:literal $Attack:ident $attack:literal
            $attack_name:literal $Hold:ident $hold:literal $hold_name:literal $Decay:ident
            $decay:literal $decay_name:literal $Sustain:ident $sustain:literal $sustain_name:literal
            $Release:ident $release:literal $release_name:literal $Curve:ident $curve:literal
            $curve_name:literal;)*
    ) => {
        $next! { { $($before)* $(
    $section {
        $Delay $delay $delay_name, Seconds 0.0..10.0 = 0.0, Linear, NextNote, [],
            "Time from the strike before it rises.";
        $Attack $attack $attack_name, Seconds 0.0005..20.0 = 0.005, Logarithmic, NextNote, [],
            "Time in which it rises to the top.";
        $Hold $hold $hold_name, Seconds 0.0..10.0 = 0.0, Linear, NextNote, [],
            "Time that it stays there.";
        $Decay $decay $decay_name, Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote, [],
            "Time in which it falls to the sustain level.";
        $Sustain $sustain $sustain_name, Percent 0.0..100.0 = 50.0, Linear, NextNote, [],
            "Where it stays until the note is released.";
        $Release $release $release_name, Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote, [],
            "Time in which it falls to nothing after that.";
        $Curve $curve $curve_name, Percent -100.0..100.0 = 50.0, Linear, NextNote, [],
            "0 % is straight lines; above, it moves fast and settles slowly; below, the reverse.";
    })*
        } $($rest)* }
    };
}

pub(super) use envelope;
